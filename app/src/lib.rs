//! The `burnish` command line, as a function, so that tests drive it in process.
//!
//! `main` only calls [`run`]. Formulas live in `burnish-core`, GPU work in `burnish-render`; here are arguments, files,
//! messages and exit codes.

mod command;
mod failure;
pub mod interrupt;
mod number;
mod report;
mod rig;
mod source;
mod value;
pub mod window;

use std::ffi::OsString;
use std::io::Write;

use clap::Parser;

use command::Command;
use failure::{Exit, Failure};

/// A workbench for the look of metals. Without a command it opens the window.
#[derive(Parser)]
#[command(name = "burnish", version, after_help = EXIT_CODES, args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    open: command::open::Args,
}

const EXIT_CODES: &str = "Exit codes: 0 ok, 1 difference, 2 usage, 3 bad input, 4 resources, 5 cancelled";

/// Runs one command and returns its exit code: 0 ok, 1 difference, 2 usage, 3 bad input, 4 resources, 5 cancelled.
///
/// `args` are the arguments after the program's name. Results go to `out`, notices and the one-line message of a
/// failure to `err`. A reader that closes `out` early ends the command quietly.
pub fn run(args: impl IntoIterator<Item = OsString>, out: &mut dyn Write, err: &mut dyn Write) -> u8 {
    let result = parse_and_run(args, out, err).and_then(|exit| {
        out.flush()?;
        Ok(exit)
    });
    let exit = result.unwrap_or_else(|failure| {
        for message in &failure.messages {
            // Nobody is left to tell when this fails too.
            let _ = writeln!(err, "burnish: {}", failure::printable(message));
        }
        failure.exit
    });
    exit as u8
}

fn parse_and_run(
    args: impl IntoIterator<Item = OsString>,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<Exit, Failure> {
    let cli = match Cli::try_parse_from(std::iter::once("burnish".into()).chain(args)) {
        Ok(cli) => cli,
        Err(error) if error.use_stderr() => return Err(Failure::arguments(&error)),
        Err(help_or_version) => {
            write!(out, "{help_or_version}")?;
            return Ok(Exit::Ok);
        }
    };
    match cli.command {
        Some(command) => command.run(out, err),
        None => command::open::run(cli.open),
    }
}
