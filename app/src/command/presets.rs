//! `burnish presets`: the metals that come with the program.

use std::io::Write;

use burnish_core::material::preset;
use serde::Serialize;

use super::{spaced, write_json};
use crate::failure::{Exit, Failure};

#[derive(clap::Args)]
pub struct Args {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct PresetInfo<'a> {
    id: &'a str,
    name: &'a str,
    /// Reflectance at normal incidence, linear Rec.709, as it is rendered.
    f0: [f32; 3],
    /// The same before it was clamped to 0..1: a metal's colour may lie outside the gamut.
    f0_unclamped: [f32; 3],
    source: String,
}
