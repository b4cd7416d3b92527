//! `burnish render`: a scene to a picture.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use burnish_core::color::tone::ToneMap;
use burnish_core::document::Document;
use burnish_core::file::{PictureFormat, write_picture};
use burnish_core::lighting::classical;
use burnish_core::param::{ParamSpec, Settings};
use burnish_render::{Gpu, Renderer, View};
use glam::UVec2;

use super::stage::{self, Forms, StageArgs, Staged};
use crate::failure::{Exit, Failure, printable};
use crate::value;

#[derive(clap::Args)]
#[command(after_help = settings_help())]
pub struct Args {
    #[command(flatten)]
    stage: StageArgs,
    /// Picture to write: .png (what a screen shows) or .exr (linear radiance)
    #[arg(long, value_name = "FILE", value_parser = value::picture_path)]
    out: PathBuf,
    /// Setting of the lighting, see below; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = value::assignment)]
    set: Vec<(String, String)>,
    /// Display transform of a .png: none, neutral, agx or aces [default: the document's, else neutral]
    #[arg(long, value_parser = str::parse::<ToneMap>)]
    tone: Option<ToneMap>,
    /// Exposure of a .png in stops, -32 to 32 [default: the document's, else 0]
    #[arg(long, value_name = "EV", value_parser = value::number(-32.0, 32.0), allow_negative_numbers = true)]
    exposure: Option<f32>,
    /// Jittered frames that are averaged, 1 to 4096
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=4096))]
    spp_jitter: u32,
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let is_png = PictureFormat::of(&args.out) == Ok(PictureFormat::Png);
    if !is_png && (args.tone.is_some() || args.exposure.is_some()) {
        return Err(Failure::usage(
            "--tone and --exposure shape a .png only; leave them out, an .exr holds the radiance itself",
        ));
    }
    // Before the work, not after it.
    if let Some(folder) = args.out.parent().filter(|f| !f.as_os_str().is_empty() && !f.is_dir()) {
        let (file, folder) = (args.out.display(), folder.display());
        return Err(Failure::resources(format!(
            "{file}: there is no folder {folder}; create it or choose another --out"
        )));
    }
    let opened = args.stage.open()?;
    let settings = settings(&args.set, opened.document.as_ref())?;
    let Staged { scene, camera, size, notices, document, .. } =
        args.stage.set(opened, classical::form_choice(&settings), Forms::OfMaterials)?;
    for notice in &notices {
        writeln!(err, "burnish: notice: {}", printable(notice))?;
    }

    let start = Instant::now();
    let gpu = Gpu::new().map_err(Failure::resources)?;
    let view = View { size, camera, settings, jitter_frames: args.spp_jitter };
    let mut renderer = Renderer::new(&gpu, &scene).map_err(Failure::resources)?;
    for name in renderer.unshadowed_lights() {
        writeln!(err, "burnish: notice: light `{}` casts no shadow: the shadow maps are full", printable(name))?;
    }
    let picture = renderer.render(&view).map_err(Failure::resources)?;
    let stored = document.map(|document| document.view);
    let tone = args.tone.or_else(|| stored.as_ref()?.tone.parse().ok()).unwrap_or_default();
    let exposure_ev = args.exposure.or(stored.map(|view| view.exposure_ev as f32)).unwrap_or(0.0);
    write_picture(&picture, &args.out, tone, exposure_ev).map_err(Failure::resources)?;
    let (UVec2 { x, y }, frames) = (size, args.spp_jitter);
    let (adapter, secs) = (&gpu.report().name, start.elapsed().as_secs_f32());
    writeln!(out, "wrote {}: {x}x{y}, {frames} frames, {secs:.1} s on {adapter}", args.out.display())?;
    Ok(Exit::Ok)
}

/// The settings that `--set` takes, from their declaration, and what `--finish` and `--coat` take.
fn settings_help() -> String {
    let line = |spec: &ParamSpec| {
        let value = Settings::new(classical::PARAMS).text(spec.key).unwrap_or_default();
        format!("  {}: {} [default: {value}]\n      {}\n", spec.key, spec.kind, spec.help)
    };
    let settings: String = classical::PARAMS.iter().map(line).collect();
    format!("Settings:\n{settings}{}", stage::help())
}

/// `--set` over what the document says.
fn settings(list: &[(String, String)], document: Option<&Document>) -> Result<Settings, Failure> {
    let mut settings = document.map_or_else(|| Settings::new(classical::PARAMS), |d| d.lighting.settings());
    for (key, text) in list {
        settings.set(key, text).map_err(|e| Failure::usage(format!("--set {key}={text}: {e}")))?;
    }
    Ok(settings)
}
