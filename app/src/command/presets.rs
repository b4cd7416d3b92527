//! `burnish presets`: the metals that come with the program.

use std::io::Write;

use burnish_core::material::preset::{self, Preset, Source};
use serde::Serialize;

use super::write_json;
use crate::failure::{Exit, Failure};

#[derive(clap::Args)]
pub struct Args {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Reflectances at normal incidence are linear Rec.709 under D65.
#[derive(Serialize)]
struct PresetInfo<'a> {
    id: &'a str,
    name: &'a str,
    /// As it is rendered.
    f0: [f64; 3],
    /// Before it was clamped to 0..1: a metal's colour may lie outside of the gamut.
    f0_unclamped: [f64; 3],
    source: &'a Source,
}

impl PresetInfo<'_> {
    fn of(preset: &Preset) -> PresetInfo<'_> {
        let f0_unclamped = preset.unclamped_f0().to_array();
        PresetInfo {
            id: &preset.id,
            name: &preset.name,
            f0: f0_unclamped.map(|v| v.clamp(0.0, 1.0)),
            f0_unclamped,
            source: &preset.source,
        }
    }
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let presets: Vec<PresetInfo> = preset::library().iter().map(PresetInfo::of).collect();
    if args.json {
        write_json(out, &presets)?;
        return Ok(Exit::Ok);
    }
    let id_width = presets.iter().map(|p| p.id.chars().count()).max().unwrap_or(0);
    let (id, f0, unclamped) = ("id", "F0 linear Rec.709", "unclamped");
    writeln!(out, "{id:id_width$}  {f0:17}  {unclamped:17}  name: source")?;
    for PresetInfo { id, name, f0, f0_unclamped, source } in presets {
        let [f0, unclamped] = [f0, f0_unclamped].map(|[r, g, b]| format!("{r:.3} {g:.3} {b:.3}"));
        writeln!(out, "{id:id_width$}  {f0:17}  {unclamped:17}  {name}: {}", citation(source))?;
    }
    Ok(Exit::Ok)
}

/// What is known of author, year, journal and DOI.
fn citation(source: &Source) -> String {
    let Source { author, year, journal, doi, .. } = source;
    let parts =
        [author.clone(), year.map(|y| y.to_string()), journal.clone(), doi.as_ref().map(|d| format!("doi:{d}"))];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
