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

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let list: Vec<PresetInfo> = preset::library().iter().map(|p| PresetInfo { id: &p.id, name: &p.name, f0: [0.0;3], f0_unclamped: [0.0;3], source: String::new() }).collect();
    if args.json {
        write_json(out, &list)?;
        return Ok(Exit::Ok);
    }
    for p in &list { writeln!(out, "{}", spaced(p.f0))?; }
    Ok(Exit::Ok)
}
