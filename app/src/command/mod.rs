//! The commands, one file each.

mod bake;
mod chart;
mod compare;
mod doctor;
mod environment;
mod export;
mod fit;
mod fresnel_balls;
mod fresnel_report;
mod fresnel_times;
mod gallery;
mod glb;
mod hits;
mod info;
mod lighting;
mod line;
mod map_times;
mod measure;
mod merge;
mod methods;
pub mod open;
mod presets;
mod render;
mod saving;
mod snapshot;
mod stage;

use std::io::Write;

use clap::Subcommand;
use serde::Serialize;

use crate::failure::{Exit, Failure};

/// What the program can be asked to do.
#[derive(Subcommand)]
pub enum Command {
    /// Render a scene to a picture
    Render(render::Args),
    /// Prepare a lighting method for a scene, or a part of that, and keep it in a file
    Bake(bake::Args),
    /// Join the parts of a bake, or bakes of different seeds
    Merge(merge::Args),
    /// Write a scene for another renderer or viewer, with a report of what that cannot hold
    Export(export::Args),
    /// List, render or write the built-in scenes
    Gallery(gallery::Args),
    /// Make an environment map: a sky, a studio, or a map without its sun
    Environment(environment::Args),
    /// List what a scene consists of
    Info(info::Args),
    /// List the metal presets, or the errors of their Fresnel forms
    Presets(presets::Args),
    /// Read measured optical constants and make a metal preset of them, with every form that renders it
    Fit(fit::Args),
    /// Write a page on how well Fresnel forms stand for measured metals
    FresnelReport(fresnel_report::Args),
    /// Write a picture of a document, or of the whole window with it, and compare it with an earlier one
    Snapshot(snapshot::Args),
    /// Measure how different two pictures are
    Compare(compare::Args),
    /// Chart what lighting methods cost against how wrong they are
    Chart(chart::Args),
    /// Measure how far the searches of the method impostor are off what they look for, and what they cost
    Hits(hits::Args),
    /// Measure what the parts of a frame by the method radiance-map cost, on the processor and the graphics device
    MapTimes(map_times::Args),
    /// List the lighting methods with what they cover and their settings
    Methods(methods::Args),
    /// Measure how far the classical lighting is from the integrals it stands for
    Measure(measure::Args),
    /// Render balls of metals beside one another, one row for each Fresnel form
    FresnelBalls(fresnel_balls::Args),
    /// Measure what every Fresnel form costs, beside the figures of the dissertation that proposed them
    FresnelTimes(fresnel_times::Args),
    /// Show graphics adapters and libraries, and what is missing
    Doctor,
}

impl Command {
    pub fn run(self, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
        match self {
            Command::Render(args) => render::run(args, out, err),
            Command::Bake(args) => bake::run(args, out, err),
            Command::Merge(args) => merge::run(args, out),
            Command::Export(args) => export::run(args, out, err),
            Command::Gallery(args) => gallery::run(args, out, err),
            Command::Environment(args) => environment::run(args, out),
            Command::Info(args) => info::run(args, out),
            Command::Presets(args) => presets::run(args, out),
            Command::Fit(args) => fit::run(args, out),
            Command::FresnelReport(args) => fresnel_report::run(args, out),
            Command::Snapshot(args) => snapshot::run(args, out, err),
            Command::Compare(args) => compare::run(args, out, err),
            Command::Chart(args) => chart::run(args, out, err),
            Command::Hits(args) => hits::run(args, out, err),
            Command::MapTimes(args) => map_times::run(args, out, err),
            Command::Methods(args) => methods::run(args, out),
            Command::Measure(args) => measure::run(args, out),
            Command::FresnelBalls(args) => fresnel_balls::run(args, out),
            Command::FresnelTimes(args) => fresnel_times::run(args, out),
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

/// Numbers for people with spaces between, rounded to five digits of the largest.
fn spaced(numbers: impl IntoIterator<Item = f32>) -> String {
    let numbers: Vec<f64> = numbers.into_iter().map(f64::from).collect();
    let largest = numbers.iter().fold(0.0, |largest: f64, v| largest.max(v.abs()));
    let decimals = if largest > 0.0 { (4.0 - largest.log10().floor()).clamp(0.0, 40.0) } else { 0.0 };
    // Through text and back: Display then leaves out trailing zeros.
    let rounded = numbers.iter().map(|v| format!("{v:.*}", decimals as usize).parse().unwrap_or(*v));
    rounded.map(|v| format!("{}", v + 0.0)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::spaced;

    #[test]
    fn numbers_are_rounded_by_the_largest_of_them() {
        assert_eq!(spaced([-0.258_312_3, 1e-9, -0.9]), "-0.25831 0 -0.9");
        assert_eq!(spaced([1.5e-6, 0.0]), "0.0000015 0");
        assert_eq!(spaced([123_456.7]), "123457");
        assert_eq!(spaced([0.0, -0.0]), "0 0");
    }
}
