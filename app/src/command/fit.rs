//! `burnish fit`: from measured optical constants to a metal preset with every form that renders it.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use burnish_core::color::gamut::clip;
use burnish_core::import::optical::{self, Finding, ImportReport, Options, Unit};
use burnish_core::material::preset::{self, Cheapest, Fit, Fits, Preset, PresetError, Tolerance};
use burnish_core::surface::fresnel::Form;
use glam::DVec3;
use serde::Serialize;

use super::presets::Bounds;
use super::write_json;
use crate::failure::{Exit, Failure, printable};

#[derive(clap::Args)]
pub struct Args {
    /// Tables of n and k: CSV, a refractiveindex.info file, one of a pair of .spd files, or a preset to fit anew
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Write the preset with its fits here; of one FILE
    #[arg(long, value_name = "PRESET.json")]
    out: Option<PathBuf>,
    /// Unit of the first column where the file does not say, or is wrong: nm, um, A or eV
    #[arg(long)]
    unit: Option<Unit>,
    /// Id of the preset; else it is made from the file's name
    #[arg(long)]
    id: Option<String>,
    /// Name of the preset; else the file's
    #[arg(long)]
    name: Option<String>,
    /// Take k with the other sign: for files of n - ik
    #[arg(long)]
    flip_k: bool,
    /// Print JSON, a list with one entry per file
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    bounds: Bounds,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let Args { files, out: target, unit, id, name, flip_k, json, bounds } = args;
    if files.len() > 1 && (target.is_some() || id.is_some() || name.is_some()) {
        return Err(Failure::usage("--out, --id and --name are about one file; name one, or leave them away"));
    }
    let options = Options { unit, id, name, flip_k };
    let tolerance = bounds.tolerance();
    let mut fitted = Vec::new();
    let mut messages = Vec::new();
    for file in &files {
        match Fitted::of(file, &options, tolerance, target.as_deref()) {
            Ok(one) if json => fitted.push(one),
            Ok(one) => one.write(out)?,
            Err(failure) if files.len() == 1 => return Err(failure),
            Err(failure) => messages.extend(failure.messages),
        }
    }
    if json {
        write_json(out, &fitted)?;
    }
    if messages.is_empty() { Ok(Exit::Ok) } else { Err(Failure { exit: Exit::Input, messages }) }
}

/// What came of one file. Reflectances are linear Rec.709 under D65.
#[derive(Serialize)]
struct Fitted {
    file: String,
    id: String,
    name: String,
    report: ImportReport,
    /// At normal incidence, as it is rendered.
    f0: [f64; 3],
    /// Before it was clamped to 0..1.
    f0_unclamped: [f64; 3],
    /// CIEDE2000 between the two, 0 where nothing was clamped.
    clip_delta_e: f64,
    /// The cheapest first.
    forms: Vec<FormFit>,
    cheapest: Cheapest,
    /// Where the preset was written.
    written: Option<String>,
}

#[derive(Serialize)]
struct FormFit {
    form: Form,
    #[serde(flatten)]
    fit: Fit,
}

impl Fitted {
    fn of(file: &Path, options: &Options, tolerance: Tolerance, target: Option<&Path>) -> Result<Fitted, Failure> {
        let imported = optical::read(file, options).map_err(|error| Failure::input(file, error))?;
        let (mut preset, mut report) = (imported.preset, imported.report);
        if let Some(target) = target {
            may_replace(target, file, &preset)?;
            report.warnings.extend(known_id(&preset, file));
        }
        let fits = Fits::new(&preset);
        let cheapest = fits.cheapest(tolerance);
        let f0 = DVec3::from_array(fits.f0);
        let form_fit = |form: Form| fits.forms.get(&form).map(|fit| FormFit { form, fit: fit.clone() });
        let fitted = Fitted {
            file: file.display().to_string(),
            id: preset.id.clone(),
            name: preset.name.clone(),
            report,
            f0: f0.clamp(DVec3::ZERO, DVec3::ONE).to_array(),
            f0_unclamped: fits.f0,
            clip_delta_e: clip(f0).map_or(0.0, |clip| clip.delta_e),
            forms: Form::ALL.into_iter().filter_map(form_fit).collect(),
            cheapest,
            written: target.map(|path| path.display().to_string()),
        };
        if let Some(target) = target {
            preset.fits = Some(fits);
            preset.write(target).map_err(|error| match error {
                PresetError::File(error) => Failure::resources(error),
                error => Failure::input(target, error),
            })?;
        }
        Ok(fitted)
    }

    fn write(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let Fitted { file, id, name, report, f0, f0_unclamped, clip_delta_e, forms, cheapest, written } = self;
        let (from, to) = report.range_nm;
        writeln!(out, "{}: {id}, {}", printable(file), printable(name))?;
        writeln!(out, "format    {}", report.format)?;
        writeln!(out, "unit      {}, {}", report.unit, printable(&report.unit_origin.to_string()))?;
        writeln!(out, "rows      {}, {from} to {to} nm", report.rows)?;
        writeln!(out, "points    {}, {} of them visible (380 to 780 nm)", report.points, report.visible_points)?;
        for (kind, findings) in [("warning", &report.warnings), ("note", &report.notes)] {
            for finding in findings {
                writeln!(out, "{kind:9} {}", printable(&finding.to_string()))?;
            }
        }
        let rgb = |[r, g, b]: &[f64; 3]| format!("{r:.4} {g:.4} {b:.4}");
        writeln!(out, "F0        {} linear Rec.709", rgb(f0_unclamped))?;
        if f0 != f0_unclamped {
            writeln!(out, "clamped   {} as it is rendered, ΔE2000 {clip_delta_e:.2}", rgb(f0))?;
        }
        let width = forms.iter().map(|f| f.form.id().len()).max().unwrap_or(0);
        writeln!(out, "{:width$}  largest relative error  absolute  ΔE2000 largest   mean  note", "form")?;
        for FormFit { form, fit } in forms {
            let Fit { relative, absolute, delta_e, delta_e_mean, note, .. } = fit;
            let line = format!(
                "{form:width$}  {:20.2} %  {absolute:8.4}  {delta_e:14.2}  {delta_e_mean:5.2}  {}",
                100.0 * relative,
                note.as_deref().unwrap_or_default()
            );
            writeln!(out, "{}", line.trim_end())?;
        }
        writeln!(out, "cheapest  {}", cheapest.reason)?;
        if let Some(path) = written {
            writeln!(out, "written   {}", printable(path))?;
        }
        Ok(())
    }
}

/// Refuses to write over anything but an earlier version of the same preset.
fn may_replace(target: &Path, file: &Path, preset: &Preset) -> Result<(), Failure> {
    let same = |a: &Path, b: &Path| matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b);
    if fs::metadata(target).is_err() {
        return Ok(());
    }
    match Preset::read(target) {
        Ok(there) if there.id == preset.id || same(target, file) => Ok(()),
        Ok(there) => {
            let reason = format!("holds the preset `{}`, not `{}`; name another file or --id", there.id, preset.id);
            Err(Failure::input(target, reason))
        }
        Err(_) => Err(Failure::input(target, "is no preset and is not written over; name another file")),
    }
}

/// A warning where a metal that comes with the program has the id: documents would find that one.
fn known_id(preset: &Preset, file: &Path) -> Option<Finding> {
    let known = preset::library().iter().find(|known| known.id == preset.id)?;
    let other = (&known.wavelength_nm, &known.n, &known.k) != (&preset.wavelength_nm, &preset.n, &preset.k);
    let text = format!("`{}` is the id of a metal that comes with Burnish; give another with --id", preset.id);
    other.then(|| Finding { file: file.display().to_string(), line: None, text })
}
