//! `burnish fresnel-report`: a page on how well Fresnel forms stand for measured metals.

use std::io::Write;
use std::path::PathBuf;

use burnish_core::file::write_atomic;
use burnish_core::material::preset::{self, Preset};

use super::presets::Bounds;
use super::stage::metal_failure;
use crate::failure::{Exit, Failure};
use crate::report::page;
use crate::report::study::Study;

#[derive(clap::Args)]
pub struct Args {
    /// Page to write, a single HTML file
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Metal: id, name or .json file; repeatable [default: all that come with the program]
    #[arg(long, value_name = "PRESET")]
    metal: Vec<String>,
    #[command(flatten)]
    bounds: Bounds,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let Args { out: file, metal, bounds } = args;
    let study = Study::new(metals(&metal)?, bounds.tolerance());
    let page = page(&study);
    write_atomic(&file, page.as_bytes()).map_err(Failure::resources)?;
    let megabytes = page.len() as f64 / 1e6;
    writeln!(out, "{}: {} metals, {megabytes:.1} MB", file.display(), study.entries.len())?;
    Ok(Exit::Ok)
}

/// Those that are named, each once, or all.
fn metals(names: &[String]) -> Result<Vec<Preset>, Failure> {
    if names.is_empty() {
        return Ok(preset::library().to_vec());
    }
    let mut metals: Vec<Preset> = Vec::new();
    for name in names {
        let metal = preset::find(name).map_err(|error| metal_failure(name, error))?;
        if !metals.iter().any(|known| known.id == metal.id) {
            metals.push(metal);
        }
    }
    Ok(metals)
}
