//! Why a command ends early, and the exit code that says so.

use std::fmt::Display;
use std::io;
use std::path::Path;

/// Exit codes of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Exit {
    Ok = 0,
    /// A comparison is over its threshold.
    Difference = 1,
    /// The command line makes no sense.
    Usage = 2,
    /// A file or a value in it cannot be used.
    Input = 3,
    /// The machine lacks something: an adapter, memory, room on the disk.
    Resources = 4,
    /// The user ended it before it was done.
    Cancelled = 5,
}

/// A failure with its messages: each one line that says what, why, and what to do.
#[derive(Debug, PartialEq)]
pub struct Failure {
    pub exit: Exit,
    pub messages: Vec<String>,
}

impl Failure {
    pub fn usage(message: impl Display) -> Failure {
        Failure { exit: Exit::Usage, messages: vec![one_line(&message.to_string())] }
    }

    pub fn resources(message: impl Display) -> Failure {
        Failure { exit: Exit::Resources, messages: vec![one_line(&message.to_string())] }
    }

    /// A file that cannot be used; an error of several lines holds one fault in each.
    pub fn input(file: &Path, faults: impl Display) -> Failure {
        let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
        let message = |line: &str| match line.starts_with(&*name) || line.contains(&*file.to_string_lossy()) {
            true => line.into(),
            false => format!("{}: {line}", file.display()),
        };
        Failure { exit: Exit::Input, messages: faults.to_string().lines().map(message).collect() }
    }

    /// The message of the argument parser without its usage block.
    pub fn arguments(error: &clap::Error) -> Failure {
        let text = error.render().to_string();
        let text = text.strip_prefix("error: ").unwrap_or(&text);
        let end = ["Usage:", "For more information"].iter().filter_map(|mark| text.find(mark)).min();
        let reason = one_line(&text[..end.unwrap_or(text.len())]).replace(" tip:", ";");
        Failure::usage(format!("{reason}; see `burnish help`"))
    }
}

/// Only the program's own output is written through `?` on an [`io::Error`].
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Failure {
        match error.kind() {
            // The reader has seen enough: no fault, and nobody to tell.
            io::ErrorKind::BrokenPipe => Failure { exit: Exit::Ok, messages: Vec::new() },
            _ => Failure::resources(format!("the output cannot be written: {error}; send it elsewhere")),
        }
    }
}

/// Text from a foreign file without line breaks and terminal sequences.
pub fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_pipe_is_no_failure_and_a_full_disk_is_one() {
        assert_eq!(Failure::from(io::Error::from(io::ErrorKind::BrokenPipe)).exit, Exit::Ok);
        assert_eq!(Failure::from(io::Error::from(io::ErrorKind::StorageFull)).exit, Exit::Resources);
    }

    #[test]
    fn each_fault_is_one_line_and_names_its_file_once() {
        let failure = Failure::input(Path::new("in/a.glb"), "mesh 0: empty\na.glb: mesh 1: empty");
        assert_eq!(failure.messages, ["in/a.glb: mesh 0: empty", "a.glb: mesh 1: empty"]);
        assert_eq!(Failure::resources("no\n  memory").messages, ["no memory"]);
        assert_eq!(printable("a\n\u{1b}[2Jb \u{e9}"), "a\u{fffd}\u{fffd}[2Jb \u{e9}");
    }
}
