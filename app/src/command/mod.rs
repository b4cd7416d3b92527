//! The commands, one file each.

mod compare;
mod doctor;
mod info;
mod presets;
mod render;

use std::io::Write;

use clap::Subcommand;
use serde::Serialize;

use crate::failure::{Exit, Failure};

/// What the program can be asked to do.
#[derive(Subcommand)]
pub enum Command {
    /// Render a scene to a picture
    Render(render::Args),
    /// List what a scene consists of
    Info(info::Args),
    /// List the metal presets
    Presets(presets::Args),
    /// Measure how different two pictures are
    Compare(compare::Args),
    /// Show graphics adapters and libraries, and what is missing
    Doctor,
}

impl Command {
    pub fn run(self, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
        match self {
            Command::Render(args) => render::run(args, out, err),
            Command::Info(args) => info::run(args, out),
            Command::Presets(args) => presets::run(args, out),
            Command::Compare(args) => compare::run(args, out, err),
            Command::Doctor => doctor::run(out),
        }
    }
}

/// Writes what a machine reads.
fn write_json(out: &mut dyn Write, value: &impl Serialize) -> Result<(), Failure> {
    serde_json::to_writer_pretty(&mut *out, value).map_err(std::io::Error::from)?;
    writeln!(out)?;
    Ok(())
}

/// Numbers for people, with spaces between.
fn spaced(numbers: impl IntoIterator<Item = f32>) -> String {
    numbers.into_iter().map(|v| format!("{}", (v * 1e4).round() / 1e4)).collect::<Vec<_>>().join(" ")
}
