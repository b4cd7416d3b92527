//! The user's choices on their way to the disk.

use std::path::PathBuf;

use burnish_core::job::{Job, Outcome};

use crate::window::preferences::Preferences;

/// Writes the choices when they change.
pub struct Store {
    path: PathBuf,
    /// As they are on the disk or on their way there.
    kept: Preferences,
    job: Option<Job<Result<(), String>>>,
}

impl Store {
    /// `kept` is what the file holds.
    pub fn new(path: PathBuf, kept: &Preferences) -> Store {
        Store { path, kept: kept.clone(), job: None }
    }

    /// Writes what changed, one file at a time. At the end of the program it waits for it. Returns what went wrong.
    pub fn keep(&mut self, preferences: &Preferences, at_the_end: bool) -> Option<String> {
        let mut fault = None;
        if let Some(job) = &mut self.job {
            // A thread that still wrote would end with the program, or put older choices over the newest.
            let outcome = if at_the_end { job.wait() } else { job.poll() };
            match outcome {
                Outcome::Running => return None,
                Outcome::Done(Err(reason)) => fault = Some(reason),
                Outcome::Done(Ok(())) | Outcome::Failed => {}
            }
            self.job = None;
        }
        if *preferences == self.kept {
            return fault;
        }
        self.kept = preferences.clone();
        let (path, preferences) = (self.path.clone(), preferences.clone());
        let write = move || preferences.write(&path);
        if at_the_end {
            return write().err().or(fault);
        }
        self.job = Some(Job::spawn("Keeping preferences", || {}, move |_| write()));
        fault
    }
}
