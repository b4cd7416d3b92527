//! `burnish compare`: how different two pictures are.

use std::io::Write;
use std::path::{Path, PathBuf};

use burnish_core::color::tone::ToneMap;
use burnish_core::file::{Encoding, read_picture, write_picture};
use burnish_core::measure::{PIXELS_PER_DEGREE, flip, relmse};
use burnish_core::picture::Picture;
use clap::ValueEnum;
use serde::Serialize;

use super::write_json;
use crate::failure::{Exit, Failure};
use crate::value;

#[derive(clap::Args)]
pub struct Args {
    /// Reference: .png or .exr
    #[arg(value_name = "A")]
    reference: PathBuf,
    /// Picture that is measured against it, of the same kind and size
    #[arg(value_name = "B")]
    picture: PathBuf,
    /// Exit with 1 when the error is larger
    #[arg(long, value_name = "T", value_parser = value::number(0.0, f32::MAX), allow_negative_numbers = true)]
    threshold: Option<f32>,
    /// Metric of the threshold
    #[arg(long, value_enum, default_value_t = Metric::Flip)]
    metric: Metric,
    /// Write the FLIP error of each pixel as a picture, black for none to pale yellow
    #[arg(long, value_name = "FILE", value_parser = value::picture_path)]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Ways to measure a difference.
#[derive(Clone, Copy, ValueEnum)]
enum Metric {
    /// Mean FLIP: what an observer sees when the pictures alternate on a screen, 0 to 1; .exr at exposure 0
    Flip,
    /// Relative mean squared error of linear light
    Relmse,
}

impl Metric {
    fn id(self) -> &'static str {
        match self {
            Metric::Flip => "flip",
            Metric::Relmse => "relmse",
        }
    }
}

#[derive(Serialize)]
struct Errors {
    flip: f64,
    relmse: f64,
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let (reference, reference_kind) = read(&args.reference)?;
    let (picture, kind) = read(&args.picture)?;
    let against = || format!("{} against {}", args.picture.display(), args.reference.display());
    let refuse = |reason: String| Failure::input(&args.picture, format!("{}: {reason}", against()));
    if kind != reference_kind {
        return Err(refuse(
            "one holds what a screen shows, the other radiance; compare .png with .png or .exr with .exr".into(),
        ));
    }
    let seen = flip(&reference, &picture, 0.0, PIXELS_PER_DEGREE).map_err(|e| refuse(e.to_string()))?;
    let relmse = relmse(&reference, &picture).map_err(|e| refuse(e.to_string()))?;
    if let Some(file) = &args.out {
        write_picture(&seen.picture(), file, ToneMap::None, 0.0).map_err(Failure::resources)?;
    }

    let errors = Errors { flip: seen.mean, relmse };
    if args.json {
        write_json(out, &errors)?;
    } else {
        writeln!(out, "flip    {:.6}", errors.flip)?;
        writeln!(out, "relmse  {:.6e}", errors.relmse)?;
    }
    let error = match args.metric {
        Metric::Flip => errors.flip,
        Metric::Relmse => errors.relmse,
    };
    match args.threshold {
        Some(threshold) if error > f64::from(threshold) => {
            writeln!(
                err,
                "burnish: {}: {} is {error:.6}, over the threshold {threshold}",
                against(),
                args.metric.id()
            )?;
            Ok(Exit::Difference)
        }
        _ => Ok(Exit::Ok),
    }
}

fn read(file: &Path) -> Result<(Picture, Encoding), Failure> {
    read_picture(file).map_err(|e| Failure::input(file, e))
}
