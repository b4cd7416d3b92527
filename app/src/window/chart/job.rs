//! The measurement, on a thread and a device of its own: the window's picture goes on, and nothing that fails here is
//! noticed there.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use burnish_core::job::{Handle, Job};
use burnish_core::measure::bench::{self, BenchError, Cache, Candidate, News, Record, Shot};
use burnish_core::param::Settings;
use burnish_core::reference::{self, Control};
use eframe::egui;

use crate::rig;
use crate::window::pool;

/// What is measured.
pub struct Order {
    /// What is looked at.
    pub shot: Shot,
    /// What is compared.
    pub candidates: Vec<Candidate>,
    /// Paths through a pixel of the reference.
    pub samples: u32,
    /// What is known already.
    pub cache: Cache,
}

/// Records of all candidates, or why there are none.
pub type Measured = Result<Vec<Record>, BenchError>;

/// Each record with the place of its candidate, as soon as it is there.
pub type Arrivals = Receiver<(usize, Record)>;

/// What is going on, for people.
#[derive(Clone, Default)]
pub struct Words(Arc<Mutex<String>>);

impl Words {
    /// The newest.
    pub fn get(&self) -> String {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// True where they are new.
    fn set(&self, words: String) -> bool {
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let new = *held != words;
        *held = words;
        new
    }
}

/// The ends of the wires to the window that the thread holds.
struct Desk {
    words: Words,
    records: Sender<(usize, Record)>,
    ctx: egui::Context,
}

impl Desk {
    fn tell(&self, words: String) {
        if self.words.set(words) {
            self.ctx.request_repaint();
        }
    }

    fn hand_over(&self, place: usize, record: &Record) {
        // Nobody listens after the window went away.
        let _ = self.records.send((place, record.clone()));
        self.ctx.request_repaint();
    }
}

/// Starts the thread; `ctx` is repainted whenever there is something new to tell or to show.
pub fn start(order: Order, ctx: &egui::Context) -> (Job<Measured>, Words, Arrivals) {
    let words = Words::default();
    let (records, arrivals) = channel();
    let desk = Desk { words: words.clone(), records, ctx: ctx.clone() };
    let waker = ctx.clone();
    let work = move |handle: &Handle| measure(&order, handle, &desk);
    (Job::spawn("Measuring", move || waker.request_repaint(), work), words, arrivals)
}

fn measure(order: &Order, handle: &Handle, desk: &Desk) -> Measured {
    let Order { shot, candidates, samples, cache } = order;
    let control = Control::of_job(handle);
    desk.tell("looking for a graphics device".into());
    let mut rig = rig::rig(&control, false)?;
    let truth = {
        // One core is left for the window. Timing has all: the command line measures so, and its results are shared.
        let pool = pool::builder().build().map_err(words)?;
        let settings = Settings::new(reference::PARAMS);
        let mut halves = Halves::default();
        rig::truth(shot, &settings, *samples, (cache, &control), Some(&pool), || {
            let done = halves.done(control.progress());
            desk.tell(format!("tracing the reference, {samples} paths a pixel: {:.0} %", 100.0 * done));
        })?
    };
    let name = format!("{}: ", shot.name);
    bench::measure(shot, &truth, candidates, &mut rig, cache, &mut |news| {
        if handle.is_cancelled() {
            return Err(BenchError::Cancelled);
        }
        match news {
            News::Next(text) => desk.tell(text.strip_prefix(&name).unwrap_or(text).into()),
            News::Done(place, record) => desk.hand_over(place, record),
        }
        Ok(())
    })
}

fn words(error: impl std::fmt::Display) -> BenchError {
    BenchError::Method(error.to_string())
}

/// The progress of two halves that are traced one after the other, each from 0 to 1.
#[derive(Default)]
struct Halves {
    last: f32,
    second: bool,
}

impl Halves {
    /// Fraction of both.
    fn done(&mut self, fraction: f32) -> f32 {
        self.second |= fraction + 0.5 < self.last;
        self.last = fraction;
        0.5 * (fraction + if self.second { 1.0 } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_halves_are_one_progress() {
        let mut halves = Halves::default();
        let told: Vec<f32> = [0.0, 0.4, 0.98, 0.02, 0.5, 1.0].map(|fraction| halves.done(fraction)).into();
        assert!(told.windows(2).all(|pair| pair[0] < pair[1]), "{told:?}");
        assert_eq!(told.last(), Some(&1.0));
    }

    #[test]
    fn words_are_new_once() {
        let words = Words::default();
        assert!(words.set("one".into()) && !words.set("one".into()) && words.set("two".into()));
        assert_eq!(words.get(), "two");
    }
}
