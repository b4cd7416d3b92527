//! `burnish export`: a scene for another renderer or viewer.

use std::io::Write;
use std::path::PathBuf;

use burnish_core::document::Document;
use burnish_core::export::mitsuba;
use burnish_core::material::preset::{self, FormChoice, Preset};
use burnish_core::param::Settings;
use burnish_core::reference;
use burnish_core::scene::{Camera, Scene};
use burnish_core::surface::fresnel::Form;

use super::stage::{self, Forms, StageArgs, Staged};
use super::{glb, write_json};
use crate::failure::{Exit, Failure, printable};

/// The programs that scenes are written for.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Target {
    /// Mitsuba 3: scene.xml, meshes as PLY, pictures as OpenEXR and PNG
    Mitsuba,
    /// Viewers of glTF 2.0: one .glb, and the environment beside it as .exr
    Gltf,
}

#[derive(clap::Args)]
#[command(after_help = stage::help())]
pub struct Args {
    #[command(flatten)]
    stage: StageArgs,
    /// Program that will read it
    #[arg(long, value_enum)]
    target: Target,
    /// mitsuba: folder to write into; files of an earlier export are replaced, others stay. gltf: file to write, .glb
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    /// mitsuba: paths through each pixel, 1 to 1048576 [default: 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    samples: Option<u32>,
    /// mitsuba: most surfaces on the way of light, 0 to 1024 [default: that of the document, else 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1024))]
    bounces: Option<u32>,
    /// mitsuba: metals with their measured n and k, for the *_spectral variants; else with one index for each of red,
    /// green and blue
    #[arg(long)]
    spectral: bool,
    /// Write the report as JSON
    #[arg(long)]
    json: bool,
}

/// Paths through a pixel where nothing is said of them.
const SAMPLES: u32 = 64;

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    // What needs no scene is refused before it is read.
    let form = match args.target {
        Target::Mitsuba => Form::EffectiveNk,
        Target::Gltf => {
            check_gltf(&args)?;
            // Its reflectance at normal incidence, which is what is written, is the exact one.
            Form::Rescaled
        }
    };
    let opened = args.stage.open()?;
    let staged = args.stage.set(opened, FormChoice::Of(form), Forms::OfAll)?;
    for notice in &staged.notices {
        writeln!(err, "burnish: notice: {}", printable(notice))?;
    }
    match args.target {
        Target::Mitsuba => to_mitsuba(&args, &staged, out),
        Target::Gltf => to_gltf(&args, staged, out),
    }
}

fn to_mitsuba(args: &Args, staged: &Staged, out: &mut dyn Write) -> Result<Exit, Failure> {
    let Staged { scene, camera, size, document, metals, .. } = staged;
    let metal = |id: &str| -> Option<Preset> {
        let of_document = || document.as_ref()?.metal(id).cloned();
        metals.get(id).cloned().or_else(of_document).or_else(|| preset::find(id).ok())
    };
    let stored = document.as_ref().map(|document| document.lighting.reference_settings());
    let settings = stored.unwrap_or_else(|| Settings::new(reference::PARAMS));
    let bounces = args.bounces.unwrap_or(reference::Options::new(&settings).bounces);
    let view = mitsuba::View { camera, size: *size, samples: args.samples.unwrap_or(SAMPLES), bounces };
    let options = mitsuba::Options { spectral: args.spectral, metal: &metal };
    let report = mitsuba::export(scene, &view, &options, &args.out).map_err(Failure::resources)?;
    if args.json {
        write_json(out, &report)?;
        return Ok(Exit::Ok);
    }
    glb::write_notes(out, None, &report.notes)?;
    writeln!(out, "wrote {} and {} more files", args.out.join(mitsuba::MAIN).display(), report.files.len() - 1)?;
    Ok(Exit::Ok)
}

/// Refuses what glTF has no place for, and a name that is not that of a GLB.
fn check_gltf(args: &Args) -> Result<(), Failure> {
    let Args { stage, samples, bounces, spectral, out, .. } = args;
    let given = [
        ("--samples", samples.is_some()),
        ("--bounces", bounces.is_some()),
        ("--spectral", *spectral),
        ("--size", stage.is_sized()),
    ];
    let names: Vec<&str> = given.into_iter().filter(|(_, given)| *given).map(|(name, _)| name).collect();
    if !names.is_empty() {
        let names = names.join(", ");
        return Err(Failure::usage(format!("{names}: for --target mitsuba only; leave it out with --target gltf")));
    }
    if !out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("glb")) {
        let file = out.display();
        return Err(Failure::usage(format!("--out {file}: --target gltf writes one file; give it a name in .glb")));
    }
    Ok(())
}

fn to_gltf(args: &Args, staged: Staged, out: &mut dyn Write) -> Result<Exit, Failure> {
    let Staged { mut scene, camera, document, .. } = staged;
    spare_sources(args, document.as_ref())?;
    set_cameras(&mut scene, camera, document.as_ref());
    let report = glb::write(&scene, &args.out)?;
    if args.json {
        write_json(out, &report)?;
        return Ok(Exit::Ok);
    }
    glb::write_notes(out, None, &report.notes)?;
    glb::write_files(out, &args.out, &report)?;
    Ok(Exit::Ok)
}

/// Refuses to write over a file that the scene is made of.
fn spare_sources(args: &Args, document: Option<&Document>) -> Result<(), Failure> {
    let of_document =
        document.iter().flat_map(|document| [Some(&document.scene), document.environment.source.as_ref()]);
    let sources = args.stage.files().into_iter().chain(of_document.flatten().map(PathBuf::from));
    let sources: Vec<PathBuf> = sources.filter_map(|file| file.canonicalize().ok()).collect();
    for file in [args.out.clone(), glb::map_beside(&args.out)] {
        if file.canonicalize().is_ok_and(|file| sources.contains(&file)) {
            let (file, given) = (file.display(), args.out.display());
            return Err(Failure::usage(format!(
                "--out {given}: would write over {file}, which the scene is made of; choose another name"
            )));
        }
    }
    Ok(())
}

/// The point of view first, then those that were saved, then those of the model.
fn set_cameras(scene: &mut Scene, view: Camera, document: Option<&Document>) {
    let saved = document.iter().flat_map(|document| &document.cameras).map(|entry| entry.camera());
    let of_model = std::mem::take(&mut scene.cameras);
    let is_view = |camera: &Camera| {
        (camera.world_from_view, camera.projection) == (view.world_from_view, view.projection)
            && camera.name == view.name
    };
    let others: Vec<Camera> = saved.chain(of_model).filter(|camera| !is_view(camera)).collect();
    let name = if view.name.is_empty() { "view".into() } else { view.name };
    scene.cameras = std::iter::once(Camera { name, ..view }).chain(others).collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_view_comes_first_and_only_once() {
        let mut scene = burnish_core::scene::gallery::open("workbench").expect("it is built in");
        let names = |scene: &Scene| scene.cameras.iter().map(|camera| camera.name.clone()).collect::<Vec<_>>();
        let before = names(&scene);
        assert!(before.len() > 1);
        let second = scene.cameras[1].clone();
        set_cameras(&mut scene, second, None);
        assert_eq!(names(&scene)[0], before[1]);
        assert_eq!(scene.cameras.len(), before.len());
        let unnamed = Camera { name: String::new(), ..scene.cameras[0].clone() };
        set_cameras(&mut scene, unnamed, None);
        assert_eq!((names(&scene)[0].as_str(), scene.cameras.len()), ("view", before.len() + 1));
    }
}
