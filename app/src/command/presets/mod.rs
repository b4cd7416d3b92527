//! `burnish presets`: the metals that come with the program.

mod csv;
mod table;

use std::io::Write;
use std::path::PathBuf;

use burnish_core::color::gamut::clip;
use burnish_core::color::space::Space;
use burnish_core::material::preset::{self, Preset, Source, Tolerance};
use burnish_core::surface::fresnel::Form;
use rayon::prelude::*;
use serde::Serialize;

use super::write_json;
use crate::failure::{Exit, Failure};
use crate::value;

#[derive(clap::Args)]
pub struct Args {
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// RGB space in which colours are given beside Rec.709: rec709, rec2020 or acescg
    #[arg(long, default_value = "rec709", conflicts_with = "table")]
    space: Space,
    /// Errors and times of every Fresnel form instead of the list
    #[arg(long)]
    table: bool,
    /// Also write the table to a file, one row for each preset and form
    #[arg(long, value_name = "FILE", requires = "table")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    bounds: Bounds,
}

/// Errors that a form may have to be chosen.
#[derive(clap::Args)]
pub struct Bounds {
    /// Largest relative error of a form that may be chosen, 0 to 1
    #[arg(long, value_name = "ERROR", default_value_t = 0.01, value_parser = value::number(0.0, 1.0))]
    relative: f32,
    /// Largest CIEDE2000 on a ball of a form that may be chosen, 0 to 100
    #[arg(long, value_name = "DIFFERENCE", default_value_t = 1.0, value_parser = value::number(0.0, 100.0))]
    delta_e: f32,
}

impl Bounds {
    pub fn tolerance(&self) -> Tolerance {
        // Through text: 0.01 is meant, not the nearest f32.
        let exact = |v: f32| v.to_string().parse().unwrap_or(f64::from(v));
        Tolerance { relative: exact(self.relative), delta_e: exact(self.delta_e) }
    }
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
    /// The unclamped colour in the space that was asked for.
    f0_in_space: [f64; 3],
    space: &'static str,
    /// CIEDE2000 that the clamp makes, 0 where it changes nothing.
    clip_delta_e: f64,
    /// The cheapest form within the bounds.
    form: Form,
    form_reason: String,
    warning: Option<&'a str>,
    source: &'a Source,
}

impl PresetInfo<'_> {
    fn of(preset: &Preset, space: Space, tolerance: Tolerance) -> PresetInfo<'_> {
        let unclamped = preset.unclamped_f0();
        let cheapest = preset.fits().cheapest(tolerance);
        PresetInfo {
            id: &preset.id,
            name: &preset.name,
            f0: unclamped.to_array().map(|v| v.clamp(0.0, 1.0)),
            f0_unclamped: unclamped.to_array(),
            f0_in_space: (space.space_from_rgb() * unclamped).to_array(),
            space: space.id(),
            clip_delta_e: clip(unclamped).map_or(0.0, |clip| clip.delta_e),
            form: cheapest.form,
            form_reason: cheapest.reason,
            warning: preset.warning.as_deref(),
            source: &preset.source,
        }
    }
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let Args { json, space, table, csv, bounds } = args;
    let tolerance = bounds.tolerance();
    if table {
        return table::run(json, csv.as_deref(), tolerance, out);
    }
    let presets: Vec<PresetInfo> =
        preset::library().par_iter().map(|preset| PresetInfo::of(preset, space, tolerance)).collect();
    if json {
        write_json(out, &presets)?;
    } else {
        write_list(&presets, space, out)?;
    }
    Ok(Exit::Ok)
}

fn write_list(presets: &[PresetInfo], space: Space, out: &mut dyn Write) -> Result<(), Failure> {
    let id_width = presets.iter().map(|p| p.id.chars().count()).max().unwrap_or(0);
    let (id, f0, unclamped) = ("id", "F0 linear Rec.709", format!("unclamped {}", space.title()));
    writeln!(out, "{id:id_width$}  {f0:17}  {unclamped:18}  clamp   form          name: source")?;
    for PresetInfo { id, name, f0, f0_in_space, clip_delta_e, form, warning, source, .. } in presets {
        let [f0, in_space] = [f0, f0_in_space].map(|[r, g, b]| format!("{r:.3} {g:.3} {b:.3}"));
        let clip = if *clip_delta_e > 0.0 { format!("{clip_delta_e:.2}") } else { "-".into() };
        let mark = if warning.is_some() { "!" } else { " " };
        writeln!(
            out,
            "{id:id_width$}  {f0:17}  {in_space:18}  {clip:>5}  {mark} {form:12}  {name}: {}",
            source.citation()
        )?;
    }
    writeln!(out)?;
    writeln!(
        out,
        "F0 is clamped to 0..1 as rendered; in {} it is not. clamp: CIEDE2000 that this changes.",
        space.title()
    )?;
    writeln!(out, "form: the cheapest Fresnel form within the bounds. !: a warning; `--json` has its text.")?;
    Ok(())
}
