//! How long passes are, and when a picture is done.

use super::Film;

/// Most samples of a pixel.
pub const MAX_SAMPLES: u32 = 1 << 24;

/// Samples from which the error is judged: before, too few have met what is rare.
const JUDGED_FROM: u32 = 16;

/// Most samples of a pass.
const LONGEST: u32 = 16;

/// Seconds that a pass of more than one sample should not exceed: what a cancelled one loses.
const PASS_SECS: f64 = 2.0;

/// When a picture is done: at whichever comes first. Without any it goes on to [`MAX_SAMPLES`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goal {
    /// Samples of every pixel.
    pub samples: Option<u32>,
    /// Seconds from the start, to the nearest sample; at least one is traced.
    pub secs: Option<f64>,
    /// [`Film::error`]. It is judged at 16, 20, 24, 28, 32, 40, 48 ... samples (four times between powers of two), so
    /// that the same picture has the same samples whatever passes made it.
    pub error: Option<f64>,
}

/// What to do next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Trace so many samples, 1 or more.
    Pass(u32),
    /// The picture is done.
    End(End),
}

/// Which goal was reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The samples.
    Samples,
    /// The time.
    Time,
    /// The error.
    Error,
}

/// Cuts the way to a goal into passes: 1, 1, 2, 4, 8, 16, 16 ... samples, as whole powers of two are best sampled;
/// shorter ones where a pass would take more than two seconds. Knows no clock.
#[derive(Clone, Debug)]
pub struct Pacing {
    goal: Goal,
    secs_per_sample: Option<f64>,
}

impl Pacing {
    /// A way to the goal.
    pub fn new(goal: Goal) -> Pacing {
        Pacing { goal, secs_per_sample: None }
    }

    /// What to do with a film, `elapsed` seconds from the start.
    pub fn next(&self, film: &Film, elapsed: f64) -> Step {
        let n = film.samples();
        let limit = self.goal.samples.unwrap_or(MAX_SAMPLES).min(MAX_SAMPLES);
        if n >= limit {
            return Step::End(End::Samples);
        }
        if self.goal.error.is_some_and(|goal| n >= JUDGED_FROM && is_judged(n) && film.error() <= goal) {
            return Step::End(End::Error);
        }
        let per_sample = self.secs_per_sample.unwrap_or(0.0);
        let left = self.goal.secs.map(|secs| secs - elapsed);
        // Nearer to the goal without another sample than with it.
        if n > 0 && left.is_some_and(|left| left <= 0.5 * per_sample) {
            return Step::End(End::Time);
        }
        let next = if n < LONGEST { (n + 1).next_power_of_two() } else { (n / LONGEST + 1) * LONGEST };
        let judged = if self.goal.error.is_some() { next_judged(n) } else { next };
        let in_time = |secs: f64| if per_sample > 0.0 { (secs / per_sample).max(1.0) as u32 } else { u32::MAX };
        let samples = next.min(judged).min(limit) - n;
        Step::Pass(samples.min(in_time(PASS_SECS)).min(left.map_or(u32::MAX, in_time)))
    }

    /// Tells what a pass took, which the length of the following ones is chosen by.
    pub fn took(&mut self, samples: u32, secs: f64) {
        self.secs_per_sample = Some(secs / f64::from(samples.max(1)));
    }

    /// Seconds to the goal at the pace of the last pass, `ahead` samples beyond those of the film being done (a
    /// fraction); `None` while it cannot be told. The error is taken to fall with the root of the samples.
    pub fn left(&self, samples: u32, error: f64, ahead: f64, elapsed: f64) -> Option<f64> {
        let per_sample = self.secs_per_sample?;
        let until = |n: f64| ((n - f64::from(samples) - ahead) * per_sample).max(0.0);
        let by_error = |goal: f64| {
            let needed = f64::from(samples) * (error / goal).powi(2);
            error.is_finite().then(|| until(needed.max(f64::from(JUDGED_FROM))))
        };
        let goals = [
            self.goal.samples.map(|n| until(f64::from(n))),
            self.goal.secs.map(|secs| (secs - elapsed).max(0.0)),
            self.goal.error.and_then(by_error),
        ];
        goals.into_iter().flatten().min_by(f64::total_cmp)
    }
}

/// Samples between two judgements at `n`: a quarter of the power of two below.
fn stride(n: u32) -> u32 {
    (1 << n.max(1).ilog2()) / 4
}

fn is_judged(n: u32) -> bool {
    n.is_multiple_of(stride(n).max(1))
}

fn next_judged(n: u32) -> u32 {
    let stride = stride(n).max(1);
    ((n / stride + 1) * stride).max(JUDGED_FROM)
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, UVec2};

    use super::*;
    use crate::reference::Pixel;

    /// One pixel of mean 1 whose relative error is `error`, as far as that can be with so few samples.
    fn film(samples: u32, error: f64) -> Film {
        let n = f64::from(samples);
        let deviations = DVec3::splat(error * error * 1.01 * n * (n - 1.0).max(0.0));
        let pixel = Pixel { count: samples, mean: DVec3::ONE, deviations, ..Pixel::default() };
        Film::from_parts(UVec2::ONE, samples, vec![pixel], None).unwrap()
    }

    /// Counts after each pass, each sample taking `secs`, with an error of `1 / sqrt(n)`.
    fn walk(goal: Goal, start: u32, secs: f64) -> (Vec<u32>, End) {
        let (mut pacing, mut n, mut counts) = (Pacing::new(goal), start, vec![]);
        loop {
            match pacing.next(&film(n, 1.0 / f64::from(n.max(1)).sqrt()), f64::from(n - start) * secs) {
                Step::End(end) => return (counts, end),
                Step::Pass(samples) => {
                    n += samples;
                    counts.push(n);
                    pacing.took(samples, f64::from(samples) * secs);
                }
            }
        }
    }

    #[test]
    fn passes_grow_to_whole_powers_of_two_and_end_at_the_samples() {
        let goal = Goal { samples: Some(70), ..Goal::default() };
        assert_eq!(walk(goal, 0, 1e-3), (vec![1, 2, 4, 8, 16, 32, 48, 64, 70], End::Samples));
        assert_eq!(walk(goal, 5, 1e-3).0, [8, 16, 32, 48, 64, 70]);
        assert_eq!(walk(goal, 70, 1e-3), (vec![], End::Samples));
        assert_eq!(walk(Goal { samples: Some(1), ..goal }, 0, 1e-3).0, [1]);
    }

    #[test]
    fn slow_passes_are_short() {
        let goal = Goal { samples: Some(9), ..Goal::default() };
        assert_eq!(walk(goal, 0, 1.0).0, [1, 2, 4, 6, 8, 9]);
        assert_eq!(walk(goal, 0, 60.0).0, [1, 2, 3, 4, 5, 6, 7, 8, 9]);
    }

    #[test]
    fn the_error_is_judged_at_the_same_counts_whatever_the_passes_were() {
        let goal = Goal { error: Some(0.16), ..Goal::default() };
        // 1 / sqrt(40) is the first of the judged ones below 0.16; 1 / sqrt(39.1) would be.
        let (counts, end) = walk(goal, 0, 1e-3);
        assert_eq!((counts.last(), end), (Some(&40), End::Error));
        for (start, secs) in [(0, 1.0), (0, 0.7), (3, 1e-3), (33, 1e-3), (39, 60.0)] {
            let (counts, end) = walk(goal, start, secs);
            assert_eq!((counts.last(), end), (Some(&40), End::Error), "from {start}, {secs} s a sample");
        }
        // Not before 16, however small it seems.
        assert_eq!(walk(Goal { error: Some(10.0), ..goal }, 0, 1e-3).0.last(), Some(&16));
    }

    #[test]
    fn time_ends_at_the_nearest_sample_and_after_one_at_least() {
        let goal = Goal { secs: Some(10.4), ..Goal::default() };
        assert_eq!(walk(goal, 0, 1.0), (vec![1, 2, 4, 6, 8, 10], End::Time));
        assert_eq!(walk(Goal { secs: Some(10.6), ..goal }, 0, 1.0).0.last(), Some(&11));
        assert_eq!(walk(goal, 0, 100.0).0, [1]);
        assert_eq!(walk(Goal { samples: Some(3), ..goal }, 0, 1.0), (vec![1, 2, 3], End::Samples));
    }

    #[test]
    fn the_time_left_is_that_of_the_nearest_goal() {
        let goal = Goal { samples: Some(100), secs: None, error: Some(0.1) };
        let mut pacing = Pacing::new(goal);
        assert_eq!(pacing.left(20, 0.2, 0.0, 5.0), None);
        pacing.took(4, 8.0);
        // Half the error needs four times the samples: 60 more, of which one and a half are done.
        assert_eq!(pacing.left(20, 0.2, 1.5, 5.0), Some(117.0));
        assert_eq!(pacing.left(20, f64::INFINITY, 0.0, 5.0), Some(160.0));
        let timed = Pacing { goal: Goal { secs: Some(7.0), ..goal }, ..pacing };
        assert_eq!(timed.left(20, 0.2, 0.0, 5.0), Some(2.0));
    }
}
