//! Counts of the picture's levels, as monitors of studios show them: brought to the processor when the picture rests, and
//! counted by another thread.

use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::job::{Job, Outcome};
use burnish_core::measure::view::{ClippedShares, Histogram, Waveform, clipped_shares, histogram, waveform};
use burnish_core::picture::Picture;
use eframe::egui;

use super::stage::Reading;

/// Bins of the histogram in a stop.
const PER_STOP: u32 = 6;
/// Columns and levels of the waveform.
const COLUMNS: u32 = 256;
const LEVELS: u32 = 96;
/// A traced picture is counted again when it has so many times the samples.
const AGAIN: f64 = 1.3;

/// How the picture is shown on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Display transform.
    pub tone: ToneMap,
    /// Stops.
    pub exposure_ev: f32,
}

/// A picture that can be counted.
#[derive(Clone, Debug)]
struct Source {
    picture: Arc<Picture>,
    /// Samples of each pixel where it is path-traced.
    samples: u32,
    /// Of what it is, where it is path-traced.
    subject: u64,
}

/// What was counted.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Of exposed light in stops.
    pub histogram: Histogram,
    /// Of levels of the screen by columns.
    pub waveform: Waveform,
    /// Pixels at an end of the screen's range.
    pub clipped: ClippedShares,
}

/// The counts of the picture that is shown.
#[derive(Default)]
pub struct Scope {
    reading: Option<Reading>,
    /// The live picture at rest.
    live: Option<Arc<Picture>>,
    job: Option<(Source, Exposure, Job<Counted>)>,
    done: Option<(Source, Exposure, Arc<Counted>)>,
    /// Why nothing is counted.
    fault: Option<String>,
    /// Someone looks in this frame of the window.
    asked: bool,
}

impl Scope {
    /// Ends a frame of the window. What nobody looks at is forgotten: it would be told of another picture.
    pub fn end_frame(&mut self) {
        if !std::mem::take(&mut self.asked) {
            *self = Scope::default();
        }
    }

    /// Follows the live picture, which `read` brings to the processor; it is asked only while the picture rests. Counts of
    /// the last one stay until there are new ones.
    pub fn follow_live(
        &mut self,
        ctx: &egui::Context,
        exposure: Exposure,
        settled: bool,
        read: impl FnOnce() -> Option<Reading>,
    ) {
        if !settled {
            (self.live, self.reading, self.fault) = (None, None, None);
        } else if self.live.is_none() && self.reading.is_none() && self.fault.is_none() {
            self.reading = read();
        }
        match self.reading.as_mut().map(Reading::poll) {
            Some(Ok(Some(picture))) => (self.live, self.reading) = (Some(Arc::new(picture)), None),
            Some(Err(fault)) => (self.fault, self.reading) = (Some(fault), None),
            // The device says nothing when it is done.
            Some(Ok(None)) => ctx.request_repaint(),
            None => {}
        }
        let source = self.live.clone().map(|picture| Source { picture, samples: 0, subject: 0 });
        self.update(ctx, exposure, source);
    }

    /// Follows a picture that is refined on the processor; `subject` is another number where it shows something else.
    pub fn follow_traced(
        &mut self,
        ctx: &egui::Context,
        exposure: Exposure,
        (picture, samples, subject): (&Arc<Picture>, u32, u64),
    ) {
        (self.live, self.reading, self.fault) = (None, None, None);
        self.update(ctx, exposure, Some(Source { picture: picture.clone(), samples, subject }));
    }

    /// A thread counts, or a picture is on its way.
    pub fn is_busy(&self) -> bool {
        self.job.is_some() || self.reading.is_some()
    }

    /// The newest counts.
    pub fn counted(&self) -> Option<&Arc<Counted>> {
        self.done.as_ref().map(|(_, _, counted)| counted)
    }

    /// Why there are none, in words.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Takes what a thread has counted, and lets one count this picture where that was not done.
    fn update(&mut self, ctx: &egui::Context, exposure: Exposure, source: Option<Source>) {
        self.asked = true;
        if let Some((of, at, job)) = &mut self.job {
            match job.poll() {
                Outcome::Running => return,
                Outcome::Done(counted) => self.done = Some((of.clone(), *at, Arc::new(counted))),
                Outcome::Failed => self.fault = Some("the picture could not be counted".into()),
            }
            self.job = None;
        }
        let Some(source) = source.filter(|_| self.fault.is_none()) else { return };
        let known = self.done.as_ref().is_some_and(|(of, at, _)| of.is_near(&source) && *at == exposure);
        if known {
            return;
        }
        let (picture, waker) = (source.picture.clone(), ctx.clone());
        let work = move |_: &_| count(&picture, exposure);
        self.job = Some((source, exposure, Job::spawn("Counting levels", move || waker.request_repaint(), work)));
    }
}

impl Source {
    /// Counts of this picture are nearly those of the other.
    fn is_near(&self, other: &Source) -> bool {
        let refined = self.samples > 0
            && self.subject == other.subject
            && other.samples >= self.samples
            && f64::from(other.samples) < AGAIN * f64::from(self.samples)
            && (self.picture.width, self.picture.height) == (other.picture.width, other.picture.height);
        Arc::ptr_eq(&self.picture, &other.picture) || refined
    }
}

fn count(picture: &Picture, Exposure { tone, exposure_ev }: Exposure) -> Counted {
    Counted {
        histogram: histogram(picture, exposure_ev, PER_STOP),
        waveform: waveform(picture, tone, exposure_ev, COLUMNS, LEVELS),
        clipped: clipped_shares(picture, tone, exposure_ev),
    }
}

#[cfg(test)]
mod tests {
    use glam::{UVec2, Vec4};

    use super::*;

    const PLAIN: Exposure = Exposure { tone: ToneMap::None, exposure_ev: 0.0 };

    fn until_counted(scope: &mut Scope, mut follow: impl FnMut(&mut Scope)) {
        let start = std::time::Instant::now();
        follow(scope);
        while scope.is_busy() {
            assert!(start.elapsed().as_secs() < 60);
            std::thread::sleep(std::time::Duration::from_millis(1));
            follow(scope);
        }
    }

    #[test]
    fn a_picture_at_rest_is_read_and_counted_once_and_again_at_another_exposure() {
        let (mut scope, ctx) = (Scope::default(), egui::Context::default());
        let mut reads = 0;
        let size = UVec2::new(8, 4);
        until_counted(&mut scope, |scope| {
            scope.follow_live(&ctx, PLAIN, true, || {
                reads += 1;
                Some(Reading::Flat(size))
            });
        });
        let first = scope.counted().unwrap().clone();
        assert_eq!((reads, first.histogram.pixels), (1, 32));
        let brighter = Exposure { exposure_ev: 5.0, ..PLAIN };
        until_counted(&mut scope, |scope| scope.follow_live(&ctx, brighter, true, || None));
        assert_eq!((first.clipped.over_all, scope.counted().unwrap().clipped.over_all), (0.0, 1.0));
        scope.follow_live(&ctx, brighter, false, || None);
        assert!(scope.counted().is_some(), "the last counts stay while the picture changes");
    }

    #[test]
    fn a_traced_picture_is_counted_again_with_more_samples_only() {
        let (mut scope, ctx) = (Scope::default(), egui::Context::default());
        let picture = |value: f32| Arc::new(Picture::filled(4, 4, Vec4::splat(value)));
        until_counted(&mut scope, |scope| scope.follow_traced(&ctx, PLAIN, (&picture(0.18), 10, 1)));
        let first = scope.counted().unwrap().clone();
        until_counted(&mut scope, |scope| scope.follow_traced(&ctx, PLAIN, (&picture(0.5), 12, 1)));
        assert!(Arc::ptr_eq(&first, scope.counted().unwrap()));
        until_counted(&mut scope, |scope| scope.follow_traced(&ctx, PLAIN, (&picture(0.5), 13, 1)));
        let second = scope.counted().unwrap().clone();
        assert_ne!(first.histogram, second.histogram);
        until_counted(&mut scope, |scope| scope.follow_traced(&ctx, PLAIN, (&picture(0.18), 13, 2)));
        assert_eq!(first.histogram, scope.counted().unwrap().histogram, "another subject with as many samples");
        scope.end_frame();
        assert!(scope.counted().is_some());
        scope.end_frame();
        assert!(scope.counted().is_none(), "nobody looked");
    }
}
