//! Progress on a terminal.

use std::io::{IsTerminal, Write};

use crate::failure::printable;

/// The last line of a terminal, written over and over; nothing elsewhere.
pub struct Line<'a> {
    err: &'a mut dyn Write,
    is_terminal: bool,
}

impl Line<'_> {
    /// Of the stream for messages.
    pub fn new(err: &mut dyn Write) -> Line<'_> {
        Line { err, is_terminal: std::io::stderr().is_terminal() }
    }

    /// Writes it anew.
    pub fn show(&mut self, text: impl FnOnce() -> String) {
        if self.is_terminal {
            // Progress that cannot be shown is no reason to stop.
            let _ = write!(self.err, "\r\x1b[K{}", text()).and_then(|()| self.err.flush());
        }
    }

    /// Removes it.
    pub fn clear(&mut self) {
        self.show(String::new);
    }

    /// A line that stays.
    pub fn tell(&mut self, notice: &str) {
        self.clear();
        let _ = writeln!(self.err, "burnish: notice: {}", printable(notice));
    }
}
