//! Paths in the background: passes to a goal, a line of progress, a checkpoint now and then.

use std::io::Write;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use burnish_core::file::FileError;
use burnish_core::reference::checkpoint::{self, Key};
use burnish_core::reference::{Control, End, Film, Goal, Pacing, Pass, Step, View, World, trace};
use rayon::ThreadPool;

use crate::command::line::Line;
use crate::command::saving::Saving;
use crate::failure::Failure;
use crate::interrupt;

/// How often signals and progress are looked at.
const POLL: Duration = Duration::from_millis(50);

/// What is traced, and how far.
pub struct Tracing<'a> {
    pub world: &'a World,
    pub view: &'a View,
    pub goal: Goal,
    pub pool: &'a ThreadPool,
}

/// What came of it.
pub struct Traced {
    pub film: Film,
    /// `None` when the user ended it.
    pub end: Option<End>,
    pub secs: f64,
    pub rays: u64,
    /// Why the last checkpoint could not be written.
    pub unsaved: Option<String>,
}

/// The file that keeps the samples.
pub struct Store {
    path: PathBuf,
    key: Key,
    saving: Saving,
    /// Samples that the file holds.
    held: Option<u32>,
}

impl Store {
    /// A file that is not there yet: the first pass shows whether it can be written.
    pub fn new(path: &Path, key: Key) -> Store {
        Store { path: path.into(), key, saving: Saving::due(), held: None }
    }

    /// A file that was just read.
    pub fn resumed(path: &Path, key: Key) -> Store {
        Store { saving: Saving::later(), ..Store::new(path, key) }
    }

    fn write(&mut self, film: &Film) -> Result<(), FileError> {
        // Nothing is lost with a film that holds nothing.
        if self.held == Some(film.samples()) || film.samples() == 0 {
            return Ok(());
        }
        let start = Instant::now();
        let written = checkpoint::write(&self.path, film, &self.key);
        self.saving.took(start.elapsed());
        written.map(|()| self.held = Some(film.samples()))
    }
}

/// What the thread that waits knows of the one that works.
struct Seen {
    samples: u32,
    error: f64,
    pacing: Pacing,
    /// Samples of the running pass.
    ahead: u32,
}

impl Tracing<'_> {
    /// Traces until a goal is reached or a signal comes.
    pub fn run(&self, film: Film, store: Option<Store>, err: &mut dyn Write) -> Result<Traced, Failure> {
        let interrupted = interrupt::watch()
            .map_err(|e| Failure::resources(format!("signals cannot be caught: {e}; close other programs")))?;
        let start = Instant::now();
        let control = Control::default();
        let pacing = Pacing::new(self.goal);
        let seen = Mutex::new(Seen { samples: film.samples(), error: film.error(), pacing, ahead: 0 });
        let mut line = Line::new(err);
        let (film, end, unsaved) = std::thread::scope(|scope| {
            let (notices, heard) = channel();
            let (control, seen) = (&control, &seen);
            let worker = scope.spawn(move || self.work(film, store, start, control, seen, notices));
            loop {
                match heard.recv_timeout(POLL) {
                    Ok(notice) => line.tell(&notice),
                    Err(RecvTimeoutError::Timeout) => line.show(|| describe(seen, control, start)),
                    Err(RecvTimeoutError::Disconnected) => break,
                }
                if interrupted.load(Ordering::Relaxed) {
                    control.cancel();
                }
            }
            worker.join().unwrap_or_else(|panic| resume_unwind(panic))
        });
        line.clear();
        Ok(Traced { film, end, secs: start.elapsed().as_secs_f64(), rays: control.rays(), unsaved })
    }

    /// Passes until the end, with a checkpoint where one is due and at the end.
    fn work(
        &self,
        mut film: Film,
        mut store: Option<Store>,
        start: Instant,
        control: &Control,
        seen: &Mutex<Seen>,
        notices: Sender<String>,
    ) -> (Film, Option<End>, Option<String>) {
        let lock = || seen.lock().unwrap_or_else(PoisonError::into_inner);
        let end = loop {
            let step = lock().pacing.next(&film, start.elapsed().as_secs_f64());
            let samples = match step {
                Step::End(end) => break Some(end),
                Step::Pass(samples) => samples,
            };
            lock().ahead = samples;
            let began = Instant::now();
            if self.pool.install(|| trace(self.world, self.view, &mut film, samples, control)) == Pass::Cancelled {
                break None;
            }
            let (took, error) = (began.elapsed().as_secs_f64(), film.error());
            let mut seen = lock();
            seen.pacing.took(samples, took);
            (seen.samples, seen.error, seen.ahead) = (film.samples(), error, 0);
            drop(seen);
            if let Some(store) = store.as_mut().filter(|store| store.saving.is_due())
                && let Err(error) = store.write(&film)
            {
                // The picture is worth more than its checkpoint; nobody listens when all is over.
                let _ = notices.send(format!("{error}; the picture goes on without"));
            }
        };
        let unsaved = store.and_then(|mut store| store.write(&film).err()).map(|e| e.to_string());
        (film, end, unsaved)
    }
}

/// Where the work stands, for people.
fn describe(seen: &Mutex<Seen>, control: &Control, start: Instant) -> String {
    let Seen { samples, error, pacing, ahead } = &*seen.lock().unwrap_or_else(PoisonError::into_inner);
    let elapsed = start.elapsed().as_secs_f64();
    let ahead = f64::from(*ahead) * f64::from(control.progress());
    let mut text = format!("{:.1} samples", f64::from(*samples) + ahead);
    if error.is_finite() {
        text += &format!(", error {error:.4}");
    }
    if let Some(left) = pacing.left(*samples, *error, ahead, elapsed) {
        let left = left.round() as u64;
        text += &format!(", {}:{:02} left", left / 60, left % 60);
    }
    text + &format!(", {:.2} Mrays/s", control.rays() as f64 / elapsed.max(1e-9) / 1e6)
}
