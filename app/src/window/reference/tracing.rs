//! The thread that traces: makes the scene ready, takes first looks, then adds passes.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::{Duration, Instant};

use burnish_core::document::Curves;
use burnish_core::lighting::Drawing;
use burnish_core::reference::{Film, Options, Pass, View, World, preview_with, trace_with};
use glam::UVec2;

use super::desk::{Activity, Desk, Order};
use super::{By, Look, Subject};
use crate::window::pool;

/// Side of the blocks of which one pixel each is traced first.
const FIRST_LOOK: u32 = 8;
/// A pass of several samples is not longer than this, so that the picture refines before one's eyes.
const PASS_SECS: f64 = 0.5;
/// Two pictures are not nearer to each other than this: each is copied and summed up.
const BETWEEN: Duration = Duration::from_millis(150);
/// Samples of a pixel that are fine enough for any screen.
const MAX_SAMPLES: u32 = 1 << 14;

/// The next step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Prepare,
    /// One pixel of every block of this side.
    FirstLook(u32),
    /// So many samples more for every pixel.
    Pass(u32),
    Done,
}

/// What is being traced.
struct Tracing {
    number: u64,
    step: Step,
    curves: Curves,
    /// Also of a former subject: what is the same is not made again.
    world: Option<World>,
    film: Option<Film>,
    secs: f64,
    published: Option<Instant>,
}

/// Works until the window is gone; `wake` is called when there is something to see.
pub fn run(desk: &Desk, wake: &dyn Fn()) {
    let pool = match pool::builder().thread_name(|index| format!("reference {index}")).build() {
        Ok(pool) => pool,
        Err(error) => {
            desk.give_up(error.to_string());
            return wake();
        }
    };
    let mut tracing = Tracing::new();
    let mut done = None;
    while let Some(order) = desk.next(done) {
        if tracing.number != order.number {
            tracing.restart(order.number);
        }
        let preparing = tracing.step == Step::Prepare;
        desk.set_activity(if preparing { Activity::Preparing } else { Activity::Tracing });
        if preparing {
            wake();
        }
        match catch_unwind(AssertUnwindSafe(|| pool.install(|| tracing.advance(&order, desk)))) {
            Ok(look) => {
                done = (tracing.step == Step::Done).then_some(order.number);
                if let Some(look) = look {
                    desk.publish(order.number, look);
                    wake();
                }
            }
            Err(panic) => {
                // What it left behind is not to be trusted.
                tracing = Tracing::new();
                done = Some(order.number);
                desk.fail(order.number, text_of(&*panic).into());
                wake();
            }
        }
    }
}

fn text_of(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("it gave no reason")
}

impl Tracing {
    fn new() -> Tracing {
        Tracing {
            number: 0,
            step: Step::Prepare,
            curves: Curves::default(),
            world: None,
            film: None,
            secs: 0.0,
            published: None,
        }
    }

    fn restart(&mut self, number: u64) {
        (self.number, self.step) = (number, Step::Prepare);
        (self.film, self.secs, self.published) = (None, 0.0, None);
    }

    /// Does the next step, unless it is cancelled: then it is still the next one. Returns what there is to see.
    fn advance(&mut self, order: &Order, desk: &Desk) -> Option<Look> {
        assert!(!order.trial, "a failure, for trial");
        let start = Instant::now();
        let subject = &order.subject;
        let view = View { camera: subject.camera.clone(), size: subject.size, seed: 0 };
        let (Some(world), false) = (&self.world, self.step == Step::Prepare) else {
            self.prepare(subject);
            self.step = Step::FirstLook(FIRST_LOOK);
            return None;
        };
        let drawing = match &subject.by {
            By::Paths(_) => None,
            By::Points(layers, prepared) => Drawing::of_layers(world, layers, prepared),
        };
        let sample = |pixel: UVec2, index: u32| match &drawing {
            Some(drawing) => drawing.sample(&view, pixel, index),
            None => world.sample(&view, pixel, index),
        };
        let secs = || start.elapsed().saturating_sub(desk.rested().saturating_sub(order.rested)).as_secs_f64();
        match self.step {
            Step::FirstLook(side) => {
                let picture = preview_with(view.size, side, &order.control, sample)?;
                self.secs += secs();
                self.step = if side > 2 { Step::FirstLook(side / 2) } else { Step::Pass(1) };
                Some(Look { picture: Arc::new(picture), step: side, size: subject.size, ..Look::default() })
            }
            Step::Pass(samples) => {
                let film = self.film.get_or_insert_with(|| Film::new(subject.size));
                if trace_with(film, samples, &order.control, sample) == Pass::Cancelled {
                    return None;
                }
                let secs = secs();
                self.secs += secs;
                self.step = following(samples, secs, film.samples());
                self.look(subject)
            }
            Step::Prepare | Step::Done => None,
        }
    }

    fn prepare(&mut self, subject: &Subject) {
        let Subject { document, scene, settings, contribution, by, .. } = subject;
        // The live scene has its metals in the form that the method asks for.
        let scene = match by {
            By::Paths(form) => document.in_form(scene, *form, &mut self.curves),
            By::Points(..) => scene.clone(),
        };
        // A document holds every metal that its materials name.
        let metal = |id: &str| document.metal(id).cloned();
        let old = self.world.take();
        self.world = Some(match by {
            By::Paths(_) => World::of_settings(&scene, settings, old, metal).0.showing(*contribution),
            // Methods on the processor know colours only.
            By::Points(..) => {
                let options = Options::new(settings);
                old.map_or_else(|| World::new(&scene, options), |old| old.updated(&scene, options))
            }
        });
    }

    /// The film as a picture, if the last one is long enough ago.
    fn look(&mut self, subject: &Subject) -> Option<Look> {
        let film = self.film.as_ref()?;
        let finished = self.step == Step::Done;
        if self.published.is_some_and(|last| last.elapsed() < BETWEEN) && !finished {
            return None;
        }
        self.published = Some(Instant::now());
        Some(Look {
            picture: Arc::new(film.picture()),
            step: 1,
            size: subject.size,
            samples: film.samples(),
            error: Some(film.error()).filter(|error| error.is_finite()),
            secs: self.secs,
            rejected: film.rejected(),
            clamped: film.clamped_share(),
            finished,
        })
    }
}

/// The pass after one of `samples` in `secs` that brought the film to `sum`.
fn following(samples: u32, secs: f64, sum: u32) -> Step {
    let in_time = (PASS_SECS * f64::from(samples) / secs.max(1e-6)) as u32;
    match (2 * samples).min(in_time).clamp(1, MAX_SAMPLES).min(MAX_SAMPLES.saturating_sub(sum)) {
        0 => Step::Done,
        more => Step::Pass(more),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_double_until_they_take_their_time_and_end() {
        assert_eq!(following(1, 0.01, 1), Step::Pass(2));
        assert_eq!(following(2, 0.02, 3), Step::Pass(4));
        assert_eq!(following(64, 0.64, 127), Step::Pass(50));
        assert_eq!(following(1, 3.0, 9), Step::Pass(1), "a slow sample is a pass");
        assert_eq!(following(4, 0.0, MAX_SAMPLES - 3), Step::Pass(3));
        assert_eq!(following(4, 0.1, MAX_SAMPLES), Step::Done);
    }
}
