//! When long work writes what it has so far.

use std::time::{Duration, Instant};

/// Least time between two writings.
const INTERVAL: Duration = Duration::from_secs(10);
/// What takes long to write is written more rarely: it takes at most a part of the time.
const SHARE: u32 = 20;

/// The next writing.
pub struct Saving {
    at: Instant,
}

impl Saving {
    /// Now: the first shows whether it can be written at all.
    pub fn due() -> Saving {
        Saving { at: Instant::now() }
    }

    /// After something was written, or read, just now.
    pub fn later() -> Saving {
        Saving { at: Instant::now() + INTERVAL }
    }

    /// It is time.
    pub fn is_due(&self) -> bool {
        Instant::now() >= self.at
    }

    /// It was written, in so much time.
    pub fn took(&mut self, time: Duration) {
        self.at = Instant::now() + INTERVAL.max(SHARE * time);
    }
}
