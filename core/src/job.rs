//! Work on another thread: progress, cancel, one result.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// What the worker sees of its job.
#[derive(Clone, Debug)]
pub struct Handle {
    cancelled: Arc<AtomicBool>,
    /// Fraction done, as bits of an f32.
    progress: Arc<AtomicU32>,
    /// The part of the job that this one tells the progress of: from and to.
    part: [f32; 2],
}

impl Default for Handle {
    fn default() -> Handle {
        Handle { cancelled: Arc::default(), progress: Arc::default(), part: [0.0, 1.0] }
    }
}

impl Handle {
    /// That of a part of the job, which goes from one fraction done to another.
    #[must_use]
    pub fn part(&self, from: f32, to: f32) -> Handle {
        let [first, last] = self.part;
        Handle { part: [from, to].map(|fraction| first + fraction * (last - first)), ..self.clone() }
    }

    /// True once the result is no longer wanted; long work asks often.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Tells the worker that the result is no longer wanted.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Fraction done, 0 to 1.
    pub fn progress(&self) -> f32 {
        f32::from_bits(self.progress.load(Ordering::Relaxed))
    }

    /// Tells the fraction done, 0 to 1, of its part.
    pub fn set_progress(&self, fraction: f32) {
        let [from, to] = self.part;
        self.progress.store((from + fraction * (to - from)).to_bits(), Ordering::Relaxed);
    }
}

/// A running job. Dropping it cancels it.
#[derive(Debug)]
pub struct Job<T> {
    /// What it does, for people: `Loading chair.glb`.
    pub label: String,
    handle: Handle,
    result: Receiver<T>,
}

/// What became of a job.
#[derive(Debug, PartialEq)]
pub enum Outcome<T> {
    /// Not yet.
    Running,
    /// The result; it is given out once.
    Done(T),
    /// The thread ended without a result: it panicked, or the result was given out before.
    Failed,
}

impl<T: Send + 'static> Job<T> {
    /// Starts a thread for `work`; `wake` is called there when it is over, so that someone looks at the result.
    pub fn spawn(
        label: impl Into<String>,
        wake: impl FnOnce() + Send + 'static,
        work: impl FnOnce(&Handle) -> T + Send + 'static,
    ) -> Job<T> {
        let (sender, result) = channel();
        let handle = Handle::default();
        let seen = handle.clone();
        std::thread::spawn(move || {
            // Wakes also when the work panics.
            let _wake = Wake(Some(wake));
            // Dropped before the wake, also by a panic: whoever is woken sees the end of the job.
            let sender = sender;
            // Nobody listens after a cancel.
            let _ = sender.send(work(&seen));
        });
        Job { label: label.into(), handle, result }
    }

    /// Looks without waiting.
    pub fn poll(&mut self) -> Outcome<T> {
        match self.result.try_recv() {
            Ok(value) => Outcome::Done(value),
            Err(TryRecvError::Empty) => Outcome::Running,
            Err(TryRecvError::Disconnected) => Outcome::Failed,
        }
    }

    /// Waits for the end; never [`Outcome::Running`].
    pub fn wait(&mut self) -> Outcome<T> {
        self.result.recv().map_or(Outcome::Failed, Outcome::Done)
    }
}

impl<T> Job<T> {
    /// Fraction done, 0 to 1.
    pub fn progress(&self) -> f32 {
        self.handle.progress()
    }

    /// Tells the worker that the result is no longer wanted.
    pub fn cancel(&self) {
        self.handle.cancel();
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.cancel();
    }
}

struct Wake<F: FnOnce()>(Option<F>);

impl<F: FnOnce()> Drop for Wake<F> {
    fn drop(&mut self) {
        if let Some(wake) = self.0.take() {
            wake();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait<T: Send + 'static>(job: &mut Job<T>, woken: Receiver<()>) -> Outcome<T> {
        woken.recv().unwrap();
        // The result is sent before the call that wakes.
        job.poll()
    }

    #[test]
    fn the_result_comes_once_after_the_wake() {
        let (wake, woken) = channel();
        let mut job = Job::spawn(
            "work",
            move || wake.send(()).unwrap(),
            |handle| {
                handle.set_progress(0.5);
                7
            },
        );
        assert_eq!(wait(&mut job, woken), Outcome::Done(7));
        assert_eq!(job.progress(), 0.5);
        assert_eq!(job.poll(), Outcome::Failed);
    }

    #[test]
    fn one_can_wait_for_the_result() {
        let mut job = Job::spawn("work", || {}, |_| 7);
        assert_eq!(job.wait(), Outcome::Done(7));
        assert_eq!(job.wait(), Outcome::Failed);
    }

    #[test]
    fn a_cancelled_worker_is_told() {
        let (wake, woken) = channel();
        let mut job = Job::spawn(
            "work",
            move || wake.send(()).unwrap(),
            |handle| {
                while !handle.is_cancelled() {
                    std::thread::yield_now();
                }
                "ended"
            },
        );
        assert_eq!(job.poll(), Outcome::Running);
        job.cancel();
        assert_eq!(wait(&mut job, woken), Outcome::Done("ended"));
    }

    #[test]
    fn a_part_tells_its_share_of_the_whole() {
        let job = Handle::default();
        let half = job.part(0.5, 1.0);
        half.part(0.0, 0.5).set_progress(0.5);
        assert_eq!(job.progress(), 0.625);
        half.set_progress(1.0);
        assert_eq!(job.progress(), 1.0);
        job.cancel();
        assert!(half.is_cancelled());
    }
}
