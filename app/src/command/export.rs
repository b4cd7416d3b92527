//! `burnish export`: a scene for another renderer.

use std::io::Write;
use std::path::PathBuf;

use burnish_core::export::mitsuba;
use burnish_core::material::preset::{self, FormChoice, Preset};
use burnish_core::param::Settings;
use burnish_core::reference;
use burnish_core::surface::fresnel::Form;

use super::stage::{self, Forms, StageArgs, Staged};
use super::write_json;
use crate::failure::{Exit, Failure, printable};

/// The renderers that scenes are written for.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Target {
    /// Mitsuba 3: scene.xml, meshes as PLY, pictures as OpenEXR and PNG
    Mitsuba,
}

#[derive(clap::Args)]
#[command(after_help = stage::help())]
pub struct Args {
    #[command(flatten)]
    stage: StageArgs,
    /// Renderer that will read it
    #[arg(long, value_enum)]
    target: Target,
    /// Folder to write into; files of an earlier export are replaced, others stay
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Paths through each pixel, 1 to 1048576
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    samples: u32,
    /// Most surfaces on the way of light, 0 to 1024 [default: that of the document, else 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1024))]
    bounces: Option<u32>,
    /// Metals with their measured n and k, for the *_spectral variants; else with one index for each of red, green and blue
    #[arg(long)]
    spectral: bool,
    /// Write the report as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let opened = args.stage.open()?;
    let form = FormChoice::Of(Form::EffectiveNk);
    let Staged { scene, camera, size, notices, document, metals } = args.stage.set(opened, form, Forms::OfAll)?;
    for notice in &notices {
        writeln!(err, "burnish: notice: {}", printable(notice))?;
    }
    let metal = |id: &str| -> Option<Preset> {
        let of_document = || document.as_ref()?.metal(id).cloned();
        metals.get(id).cloned().or_else(of_document).or_else(|| preset::find(id).ok())
    };
    let stored = document.as_ref().map(|document| document.lighting.reference_settings());
    let settings = stored.unwrap_or_else(|| Settings::new(reference::PARAMS));
    let bounces = args.bounces.unwrap_or(reference::Options::new(&settings).bounces);
    let view = mitsuba::View { camera: &camera, size, samples: args.samples, bounces };
    let options = mitsuba::Options { spectral: args.spectral, metal: &metal };
    let Target::Mitsuba = args.target;
    let report = mitsuba::export(&scene, &view, &options, &args.out).map_err(Failure::resources)?;
    if args.json {
        write_json(out, &report)?;
        return Ok(Exit::Ok);
    }
    for note in &report.notes {
        let line = format!("{}: {}: {}", note.element, note.loss.word(), note.what);
        writeln!(out, "{}", printable(&line))?;
    }
    writeln!(out, "wrote {} and {} more files", args.out.join(mitsuba::MAIN).display(), report.files.len() - 1)?;
    Ok(Exit::Ok)
}
