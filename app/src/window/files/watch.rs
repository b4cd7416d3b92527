//! Files that change on disk while they are open: a thread looks at their times and sizes.

use std::collections::BTreeMap;
use std::fs;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use eframe::egui;

/// How often the files are looked at.
const PERIOD: Duration = Duration::from_secs(2);

/// When a file was written and how long it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    modified: Option<SystemTime>,
    bytes: u64,
}

impl Stamp {
    fn of(path: &str) -> Option<Stamp> {
        let about = fs::metadata(path).ok()?;
        Some(Stamp { modified: about.modified().ok(), bytes: about.len() })
    }
}

/// Stamps by path; a file that is absent has none.
pub type Stamps = BTreeMap<String, Option<Stamp>>;

/// How files look now. Best taken before they are read, so that no change goes unseen.
pub fn stamps(paths: impl IntoIterator<Item = String>) -> Stamps {
    paths.into_iter().map(|path| (path.clone(), Stamp::of(&path))).collect()
}

/// Looks at the files of the document.
#[derive(Default)]
pub struct Watch {
    shared: Arc<Shared>,
    started: bool,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    ended: Condvar,
}

#[derive(Default)]
struct State {
    /// As the files were read.
    read: Stamps,
    /// As they were at the last look.
    last: Stamps,
    changed: Vec<String>,
    end: bool,
}

impl Shared {
    /// No holder of the lock leaves the state half changed.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Watch {
    /// Looks at these files instead of the former ones.
    pub fn start(&mut self, read: Stamps) {
        let mut state = self.shared.lock();
        *state = State { read, ..State::default() };
    }

    /// Looks at these files too; those that are known were read anew.
    pub fn add(&mut self, read: Stamps) {
        let mut state = self.shared.lock();
        state.changed.retain(|path| !read.contains_key(path));
        state.last.retain(|path, _| !read.contains_key(path));
        state.read.extend(read);
    }

    /// Files that were written since they were read.
    pub fn changed(&self) -> Vec<String> {
        self.shared.lock().changed.clone()
    }

    /// Leaves a changed file as it was read, until it changes again.
    pub fn ignore(&mut self, path: &str) {
        self.add(stamps([path.into()]));
    }

    /// Starts to look, once; a change wakes the window.
    pub fn wake(&mut self, ctx: &egui::Context) {
        if self.started || self.shared.lock().read.is_empty() {
            return;
        }
        self.started = true;
        let (shared, ctx) = (self.shared.clone(), ctx.clone());
        std::thread::spawn(move || {
            while let Some(found) = wait_and_look(&shared) {
                if found {
                    ctx.request_repaint();
                }
            }
        });
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.shared.lock().end = true;
        self.shared.ended.notify_all();
    }
}

/// `None` at the end, else whether something changed.
fn wait_and_look(shared: &Shared) -> Option<bool> {
    let state = shared.lock();
    let waited = shared.ended.wait_timeout_while(state, PERIOD, |state| !state.end);
    let (state, _) = waited.unwrap_or_else(PoisonError::into_inner);
    if state.end {
        return None;
    }
    let paths: Vec<String> = state.read.keys().cloned().collect();
    // A disk may be slow; the window must not wait for the lock.
    drop(state);
    let now = stamps(paths);
    Some(shared.lock().compare(now))
}

impl State {
    /// Notes files that differ from what was read and have come to rest: one that is still written is left alone.
    fn compare(&mut self, now: Stamps) -> bool {
        let before = self.changed.len();
        for (path, stamp) in &now {
            let rests = self.last.get(path) == Some(stamp);
            let differs = stamp.is_some() && self.read.get(path).is_some_and(|read| read != stamp);
            if rests && differs && !self.changed.contains(path) {
                self.changed.push(path.clone());
            }
        }
        self.last = now;
        self.changed.len() > before
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(second: u64) -> Option<Stamp> {
        Some(Stamp { modified: Some(SystemTime::UNIX_EPOCH + Duration::from_secs(second)), bytes: 1 })
    }

    fn one(stamp: Option<Stamp>) -> Stamps {
        Stamps::from([("a".to_string(), stamp)])
    }

    #[test]
    fn a_change_is_told_once_and_only_when_the_file_rests() {
        let mut state = State { read: one(at(1)), ..State::default() };
        assert!(!state.compare(one(at(1))) && !state.compare(one(at(1))));
        assert!(!state.compare(one(at(2))), "just written");
        assert!(!state.compare(one(at(3))), "still being written");
        assert!(state.compare(one(at(3))));
        assert_eq!(state.changed, ["a"]);
        assert!(!state.compare(one(at(3))));
    }

    #[test]
    fn a_file_that_goes_is_no_change_and_one_that_comes_is() {
        let mut state = State { read: one(at(1)), ..State::default() };
        assert!(!state.compare(one(None)) && !state.compare(one(None)));
        let mut state = State { read: one(None), ..State::default() };
        assert!(!state.compare(one(at(1))) && state.compare(one(at(1))));
    }

    #[test]
    fn what_is_read_again_is_no_longer_changed() {
        let mut watch = Watch::default();
        watch.start(one(at(1)));
        let look = |watch: &Watch, stamp| watch.shared.lock().compare(one(stamp));
        assert!(!look(&watch, at(2)) && look(&watch, at(2)));
        watch.add(one(at(2)));
        assert!(watch.changed().is_empty());
        assert!(!look(&watch, at(2)) && !look(&watch, at(2)));
    }
}
