//! How often the graphics device was lost lately: a driver that fails again and again is not asked any more.

use std::fmt;
use std::time::{SystemTime, UNIX_EPOCH};

/// Seconds that are looked back on.
const WINDOW_SECS: u64 = 60;
/// Losses within them that end the drawing.
const LIMIT: usize = 3;

/// When the device was lost, in seconds since 1970: a program that starts itself again hands them on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LossLog(Vec<u64>);

impl LossLog {
    /// Variable that hands the log to the next run of the program.
    pub const VARIABLE: &str = "BURNISH_LOSSES";
    /// What the user is told at the end.
    pub const GIVEN_UP: &str = "the graphics device was lost three times within a minute; nothing is drawn any more: save \
                                the document, update the graphics driver and start Burnish again";

    /// What the last run handed on.
    pub fn from_environment() -> LossLog {
        std::env::var(LossLog::VARIABLE).map_or_else(|_| LossLog::default(), |text| LossLog::parse(&text))
    }

    fn parse(text: &str) -> LossLog {
        LossLog(text.split(',').filter_map(|part| part.trim().parse().ok()).collect())
    }

    /// Notes a loss at a time; false when it is one too many.
    pub fn note(&mut self, now_secs: u64) -> bool {
        self.0.retain(|time| now_secs.saturating_sub(*time) < WINDOW_SECS);
        self.0.push(now_secs);
        self.0.len() < LIMIT
    }

    /// Notes a loss.
    pub fn note_now(&mut self) -> bool {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        self.note(since.map_or(0, |since| since.as_secs()))
    }
}

impl fmt::Display for LossLog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let times: Vec<String> = self.0.iter().map(u64::to_string).collect();
        f.write_str(&times.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_third_loss_within_a_minute_is_one_too_many() {
        let mut log = LossLog::default();
        assert!(log.note(1000) && log.note(1030));
        assert!(!log.note(1059));
        let mut slow = LossLog::default();
        assert!(slow.note(1000) && slow.note(1030) && slow.note(1060) && slow.note(1095));
    }

    #[test]
    fn the_next_run_knows_the_losses_of_this_one() {
        let mut log = LossLog::default();
        log.note(1000);
        log.note(1030);
        let mut next = LossLog::parse(&log.to_string());
        assert_eq!(next, log);
        assert!(!next.note(1031));
        assert_eq!(LossLog::parse("nonsense, 5"), LossLog(vec![5]));
    }
}
