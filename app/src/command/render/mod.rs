//! `burnish render`: a scene to a picture.

mod classical;
mod points;
mod reference;
mod tracing;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::document::ViewEntry;
use burnish_core::file::{FileError, PictureFormat};
use burnish_core::lighting::bakes::Bake;
use burnish_core::lighting::prepared::Origin;
use burnish_core::lighting::{self, Layer, Layers, Method, Prepared, Store};
use burnish_core::param::{ParamSpec, Settings};
use burnish_core::scene::Scene;
use glam::UVec2;

use classical::ClassicalArgs;
use reference::ReferenceArgs;

pub use points::method_failure;
pub use reference::threads;

use super::stage::{self, StageArgs};
use crate::failure::{Exit, Failure, printable};
use crate::source::Opened;
use crate::value::{self, MethodChoice};
use crate::window::Folders;

const REFERENCE: &str = burnish_core::reference::ID;

#[derive(clap::Args)]
#[command(after_help = settings_help())]
pub struct Args {
    #[command(flatten)]
    stage: StageArgs,
    #[command(flatten)]
    output: Output,
    /// How light is computed: classical and impostor, by lookups on the GPU; reference, by paths on the processor; see `burnish methods`
    /// [default: as the document says, its objects that are lit otherwise included, else classical]
    #[arg(long, value_name = "METHOD", value_parser = value::method)]
    method: Option<MethodChoice>,
    /// Draw on the processor also what the graphics device could draw
    #[arg(long)]
    processor: bool,
    /// Setting of the method, see below; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = value::assignment)]
    set: Vec<(String, String)>,
    /// Folder of what methods prepare [default: the user's cache]
    #[arg(long, value_name = "FOLDER")]
    cache: Option<PathBuf>,
    /// What the method prepared, by `burnish bake`, also of another state of materials and lights
    #[arg(long, value_name = "FILE")]
    prepared: Option<PathBuf>,
    #[command(flatten, next_help_heading = "On the graphics device")]
    classical: ClassicalArgs,
    #[command(flatten, next_help_heading = "With --method reference")]
    reference: ReferenceArgs,
}

/// Where the picture goes, and how it looks there.
#[derive(clap::Args)]
struct Output {
    /// Picture to write: .png (what a screen shows) or .exr (linear radiance)
    #[arg(long, value_name = "FILE", value_parser = value::picture_path)]
    out: PathBuf,
    /// Display transform of a .png: none, neutral, agx or aces [default: the document's, else neutral]
    #[arg(long, value_parser = str::parse::<ToneMap>)]
    tone: Option<ToneMap>,
    /// Exposure of a .png in stops, -32 to 32 [default: the document's, else 0]
    #[arg(long, value_name = "EV", value_parser = value::number(-32.0, 32.0), allow_negative_numbers = true)]
    exposure: Option<f32>,
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let Args { stage, output, method, processor, set, cache, prepared, classical, reference } = args;
    output.check()?;
    // Where no method is given the document says it; else what can be refused is refused before the scene is read.
    let opened = match method {
        Some(_) => None,
        None => Some(stage.open()?),
    };
    let layers = match (&opened, method) {
        (Some(Opened { document: Some(document), object_keys, .. }), None) => document.lighting.layers(object_keys),
        _ => {
            let method = method.map_or(&lighting::classical::Classical as &'static dyn Method, |chosen| chosen.0);
            Layers::of(method, Settings::new(method.info().params))
        }
    };
    let id = layers.first().method.info().id.0;
    let on_device = burnish_render::draws(layers.first().method.info().id) && layers.is_single() && !processor;
    let (foreign, other) = match on_device {
        true => (reference.given(), REFERENCE),
        false => (classical.given(), lighting::classical::ID),
    };
    let has_pass = burnish_render::draws(layers.first().method.info().id);
    if let (Some(option), true) = (foreign, has_pass && !on_device) {
        return Err(Failure::usage(format!(
            "{option} is for pictures of the graphics device; leave it out, or give --samples for this one"
        )));
    }
    if let Some(option) = foreign {
        return Err(Failure::usage(format!(
            "{option} belongs to --method {other}; choose that, or leave {option} out"
        )));
    }
    let scene = match opened {
        Some(opened) => (&stage, opened),
        None => (&stage, stage.open()?),
    };
    if prepared.is_some() && id == REFERENCE {
        return Err(Failure::usage(
            "--prepared is for methods that prepare something, not the reference; leave it out",
        ));
    }
    let sources = Sources { cache: cache.as_deref(), prepared: prepared.as_deref() };
    match id {
        _ if on_device => classical::run(layers.first().method, (&classical, sources), scene, &set, &output, out, err),
        REFERENCE => reference::run(&reference, scene, &set, &output, out, err),
        _ => points::run(layers, (&reference, sources), scene, &set, &output, out, err),
    }
}

/// The reference's picture of a scene as it is; `file` decides the format.
pub fn reference_picture(
    scene: &str,
    size: UVec2,
    samples: u32,
    file: PathBuf,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<Exit, Failure> {
    let output = Output { out: file, tone: None, exposure: None };
    output.check()?;
    let stage = StageArgs::plain(scene, size);
    let opened = stage.open()?;
    reference::run(&ReferenceArgs::of_samples(samples), (&stage, opened), &[], &output, out, err)
}

impl Output {
    /// Refuses what could not be written, before the work and not after it.
    fn check(&self) -> Result<(), Failure> {
        let is_png = PictureFormat::of(&self.out) == Ok(PictureFormat::Png);
        if !is_png && (self.tone.is_some() || self.exposure.is_some()) {
            return Err(Failure::usage(
                "--tone and --exposure shape a .png only; leave them out, an .exr holds the radiance itself",
            ));
        }
        check_folder("--out", &self.out)
    }

    /// Display transform and exposure over what the document says.
    fn look(&self, stored: Option<&ViewEntry>) -> (ToneMap, f32) {
        let tone = self.tone.or_else(|| stored?.tone.parse().ok()).unwrap_or_default();
        (tone, self.exposure.or(stored.map(|view| view.exposure_ev as f32)).unwrap_or(0.0))
    }
}

pub fn check_folder(option: &str, file: &Path) -> Result<(), Failure> {
    match file.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
        Some(folder) => {
            let (file, folder) = (file.display(), folder.display());
            let remedy = format!("create it or choose another {option}");
            Err(Failure::resources(format!("{file}: there is no folder {folder}; {remedy}")))
        }
        None => Ok(()),
    }
}

/// Where preparations come from.
#[derive(Clone, Copy)]
struct Sources<'a> {
    /// A folder of them, see `--cache`.
    cache: Option<&'a Path>,
    /// One that was named, see `--prepared`.
    prepared: Option<&'a Path>,
}

impl Sources<'_> {
    /// In a folder that was named, else in the user's cache; with what was named for the method. Tells where that is of another state of
    /// the scene, and refuses what cannot be used.
    fn store(&self, layer: &Layer, scene: &Scene, err: &mut dyn Write) -> Result<Store, Failure> {
        let Sources { cache, prepared } = self;
        let folder = cache.map(Path::to_path_buf).or_else(|| Some(Folders::of_user()?.prepared()));
        let store = folder.map_or_else(Store::none, |folder| Store::within(&folder));
        let Some(path) = prepared else { return Ok(store) };
        let Layer { method, settings, .. } = layer;
        let prepared = prepared_in(path, (*method, settings), scene, err)?;
        Ok(store.giving(method.info().id, Arc::new(prepared)))
    }
}

/// What a bake holds for a method. Tells where that is of another state of the scene, and refuses what cannot be used.
pub fn prepared_in(
    path: &Path,
    (method, settings): (&dyn Method, &Settings),
    scene: &Scene,
    err: &mut dyn Write,
) -> Result<Prepared, Failure> {
    let refused = |error: FileError| Failure { exit: Exit::Input, messages: vec![error.to_string()] };
    let bake = Bake::read(path).map_err(refused)?;
    let notice = bake.fits(path, &Origin::of(method, settings, scene)).map_err(refused)?;
    tell(err, notice.as_slice())?;
    Ok(bake.prepared)
}

/// Applies `--set`.
pub fn assign(settings: &mut Settings, list: &[(String, String)]) -> Result<(), Failure> {
    for (key, text) in list {
        settings.set(key, text).map_err(|e| Failure::usage(format!("--set {key}={text}: {e}")))?;
    }
    Ok(())
}

pub fn tell(err: &mut dyn Write, notices: &[String]) -> Result<(), Failure> {
    for notice in notices {
        writeln!(err, "burnish: notice: {}", printable(notice))?;
    }
    Ok(())
}

/// The settings that `--set` takes, from their declaration, and what `--finish` and `--coat` take.
fn settings_help() -> String {
    let list = |specs: &'static [ParamSpec]| -> String {
        let defaults = Settings::new(specs);
        let line = |spec: &ParamSpec| {
            let value = defaults.text(spec.key).unwrap_or_default();
            format!("  {}: {} [default: {value}]\n      {}\n", spec.key, spec.kind, spec.help)
        };
        specs.iter().map(line).collect()
    };
    let of = |method: &'static dyn Method| {
        let info = method.info();
        // How many paths is another question here: see --samples.
        let specs = if info.id.0 == REFERENCE { burnish_core::reference::PARAMS } else { info.params };
        format!("Settings of --method {}:\n{}", info.id, list(specs))
    };
    let settings: String = lighting::methods().into_iter().map(of).collect();
    format!("{settings}{}", stage::help())
}
