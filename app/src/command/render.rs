//! `burnish render`: a scene to a picture.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use burnish_core::color::tone::ToneMap;
use burnish_core::document::Document;
use burnish_core::file::{PictureFormat, write_picture};
use burnish_core::lighting::classical;
use burnish_core::material::finish;
use burnish_core::material::preset::{self, PresetError};
use burnish_core::material::{Material, Reflectance};
use burnish_core::param::{ParamSpec, Settings};
use burnish_core::scene::{Camera, Scene, gallery};
use burnish_render::{Gpu, Renderer, View};
use glam::UVec2;

use crate::failure::{Exit, Failure, printable};
use crate::source::{self, Opened, SceneArg};
use crate::value::{self, CameraChoice, MetalChoice};

#[derive(clap::Args)]
#[command(after_help = settings_help())]
pub struct Args {
    #[command(flatten)]
    scene: SceneArg,
    /// Picture to write: .png (what a screen shows) or .exr (linear radiance)
    #[arg(long, value_name = "FILE", value_parser = value::picture_path)]
    out: PathBuf,
    /// Environment map, .hdr or .exr [default: that of the document or scene, else a studio]
    #[arg(long, value_name = "FILE")]
    env: Option<PathBuf>,
    /// Metal for the material SLOT, a name or #index; for all without one; repeatable
    #[arg(long, value_name = "PRESET[:SLOT]", value_parser = value::metal)]
    metal: Vec<MetalChoice>,
    /// Finish for the material SLOT, see below; for those with a --metal without one, without --metal for all; repeatable
    #[arg(long, value_name = "ID[:SLOT]", value_parser = value::metal)]
    finish: Vec<MetalChoice>,
    /// Coat for the material SLOT, see below; without one as --finish; repeatable
    #[arg(long, value_name = "ID[:SLOT]", value_parser = value::metal)]
    coat: Vec<MetalChoice>,
    /// Roughness factor, 0 to 1, of the materials that got a --metal; without --metal of all
    #[arg(long, value_name = "R", value_parser = value::number(0.0, 1.0))]
    roughness: Option<f32>,
    /// Anisotropy strength, 0 to 1, of the same materials
    #[arg(long, value_name = "A", value_parser = value::number(0.0, 1.0))]
    anisotropy: Option<f32>,
    /// Setting of the lighting, see below; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = value::assignment)]
    set: Vec<(String, String)>,
    /// Pixels of the picture
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = value::size)]
    size: UVec2,
    /// Eye and target in metres and the vertical angle in degrees [default: the document's view; of a model all; a gallery scene's first]
    #[arg(long, value_name = "NAME|#INDEX|EX,EY,EZ,TX,TY,TZ,FOV", value_parser = value::camera, allow_hyphen_values = true)]
    camera: Option<CameraChoice>,
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
    let Opened { mut scene, mut notices, from_gallery, document, .. } = args.scene.open()?.complete()?;
    let settings = settings(&args.set, document.as_ref())?;
    if let Some(file) = &args.env {
        let (environment, more) = source::environment(file)?;
        scene.environment = Some(environment);
        notices.extend(more);
    } else if scene.environment.is_none() {
        scene.environment = Some(Arc::new(gallery::studio()));
    }
    notices.extend(set_materials(&mut scene, &args, &settings)?);
    let camera = camera(&scene, &args, from_gallery, document.as_ref())?;
    for notice in &notices {
        writeln!(err, "burnish: notice: {}", printable(notice))?;
    }

    let start = Instant::now();
    let gpu = Gpu::new().map_err(Failure::resources)?;
    let view = View { size: args.size, camera, settings, jitter_frames: args.spp_jitter };
    let mut renderer = Renderer::new(&gpu, &scene).map_err(Failure::resources)?;
    for name in renderer.unshadowed_lights() {
        writeln!(err, "burnish: notice: light `{}` casts no shadow: the shadow maps are full", printable(name))?;
    }
    let picture = renderer.render(&view).map_err(Failure::resources)?;
    let stored = document.map(|document| document.view);
    let tone = args.tone.or_else(|| stored.as_ref()?.tone.parse().ok()).unwrap_or_default();
    let exposure_ev = args.exposure.or(stored.map(|view| view.exposure_ev as f32)).unwrap_or(0.0);
    write_picture(&picture, &args.out, tone, exposure_ev).map_err(Failure::resources)?;
    let (UVec2 { x, y }, frames) = (args.size, args.spp_jitter);
    let (adapter, secs) = (&gpu.report().name, start.elapsed().as_secs_f32());
    writeln!(out, "wrote {}: {x}x{y}, {frames} frames, {secs:.1} s on {adapter}", args.out.display())?;
    Ok(Exit::Ok)
}

/// The settings that `--set` takes, from their declaration, and what `--finish` and `--coat` take.
fn settings_help() -> String {
    let ids = |kind| finish::list(kind).map(|finish| finish.id.as_str()).collect::<Vec<_>>().join(", ");
    let (finishes, coats) = (ids(finish::Kind::Finish), ids(finish::Kind::Coat));
    let line = |spec: &ParamSpec| {
        let value = Settings::new(classical::PARAMS).text(spec.key).unwrap_or_default();
        format!("  {}: {} [default: {value}]\n      {}\n", spec.key, spec.kind, spec.help)
    };
    let settings: String = classical::PARAMS.iter().map(line).collect();
    format!("Settings:\n{settings}Finishes: {finishes}\nCoats: {coats}\n")
}

/// `--set` over what the document says.
fn settings(list: &[(String, String)], document: Option<&Document>) -> Result<Settings, Failure> {
    let mut settings = document.map_or_else(|| Settings::new(classical::PARAMS), |d| d.lighting.settings());
    for (key, text) in list {
        settings.set(key, text).map_err(|e| Failure::usage(format!("--set {key}={text}: {e}")))?;
    }
    Ok(settings)
}

/// Applies `--metal`, `--finish`, `--coat`, `--roughness` and `--anisotropy`; returns what the user should know.
fn set_materials(scene: &mut Scene, args: &Args, settings: &Settings) -> Result<Vec<String>, Failure> {
    let mut notices = Vec::new();
    let mut changed = vec![false; scene.materials.len()];
    for MetalChoice { preset, slot } in &args.metal {
        let preset = preset::find(preset).map_err(|e| metal_failure(preset, e))?;
        let fresnel = Arc::new(preset.fresnel(classical::form_choice(settings).form(&preset)));
        let slots = match slot {
            Some(slot) => slot
                .among("material", scene.materials.iter().map(|m| m.name.as_str()))
                .map_err(|e| Failure::usage(format!("--metal {}: {e}", preset.id)))?,
            None => (0..scene.materials.len()).collect(),
        };
        for slot in slots {
            let material = &mut scene.materials[slot];
            material.reflectance = Reflectance::Preset { id: preset.id.clone(), fresnel: fresnel.clone() };
            if std::mem::take(&mut material.unlit) {
                notices.push(format!("material `{}` was unlit and is lit now to show its metal", material.name));
            }
            changed[slot] = true;
        }
    }
    let all = args.metal.is_empty();
    let targets: Vec<usize> = (0..changed.len()).filter(|slot| all || changed[*slot]).collect();
    set_finishes(scene, finish::Kind::Finish, &args.finish, &targets)?;
    set_finishes(scene, finish::Kind::Coat, &args.coat, &targets)?;
    for slot in targets {
        let Material { roughness, anisotropy, .. } = &mut scene.materials[slot];
        *roughness = args.roughness.unwrap_or(*roughness);
        *anisotropy = args.anisotropy.unwrap_or(*anisotropy);
    }
    Ok(notices)
}

/// Applies `--finish` or `--coat`; without a slot to `targets`.
fn set_finishes(
    scene: &mut Scene,
    kind: finish::Kind,
    choices: &[MetalChoice],
    targets: &[usize],
) -> Result<(), Failure> {
    for MetalChoice { preset, slot } in choices {
        let failure = |e: &dyn std::fmt::Display| Failure::usage(format!("--{} {preset}: {e}", kind.word()));
        let finish = finish::find(kind, preset).map_err(|e| failure(&e))?;
        let slots = match slot {
            Some(slot) => {
                slot.among("material", scene.materials.iter().map(|m| m.name.as_str())).map_err(|e| failure(&e))?
            }
            None => targets.to_vec(),
        };
        for slot in slots {
            finish.apply(&mut scene.materials[slot]);
        }
    }
    Ok(())
}

/// A preset's file may be at fault, or the name that was given.
pub(super) fn metal_failure(preset: &str, error: PresetError) -> Failure {
    match error {
        PresetError::File(_) | PresetError::Json { .. } | PresetError::Field { .. } | PresetError::TooLarge { .. } => {
            Failure::input(Path::new(preset), error)
        }
        PresetError::Unknown { .. } => Failure::usage(format!("--metal {preset}: {error}")),
    }
}

fn camera(scene: &Scene, args: &Args, from_gallery: bool, document: Option<&Document>) -> Result<Camera, Failure> {
    match &args.camera {
        Some(CameraChoice::LookAt { eye, target, yfov }) => Ok(Camera::look_at("look at", *eye, *target, *yfov)),
        Some(CameraChoice::Of(pick)) => {
            // Those that were saved in the document come first.
            let saved = document.iter().flat_map(|document| &document.cameras).map(|entry| entry.camera());
            let cameras: Vec<Camera> = saved.chain(scene.cameras.iter().cloned()).collect();
            let found = pick
                .among("camera", cameras.iter().map(|c| c.name.as_str()))
                .map_err(|e| Failure::usage(format!("--camera: {e}; or give ex,ey,ez,tx,ty,tz,fov")))?;
            Ok(cameras[found[0]].clone())
        }
        None => Ok(match (document, scene.cameras.first()) {
            (Some(document), _) => document.view.camera.camera(),
            (None, Some(camera)) if from_gallery => camera.clone(),
            _ => Camera::frame(scene.bounds(), args.size.x as f32 / args.size.y as f32),
        }),
    }
}
