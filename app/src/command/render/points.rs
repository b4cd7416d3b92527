//! Pictures by a method that draws point by point on the processor.

use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use burnish_core::document::{Document, LightingEntry, SHARED_SETTINGS};
use burnish_core::file::write_picture;
use burnish_core::job::Handle;
use burnish_core::lighting::classical::form_choice;
use burnish_core::lighting::{Layers, MethodError, MethodId};
use burnish_core::param::Settings;
use burnish_core::reference::{Film, Options, Pass, View, World};
use glam::UVec2;

use super::reference::ReferenceArgs;
use super::{Output, Sources, assign, tell};
use crate::command::stage::{Forms, StageArgs, Staged};
use crate::failure::{Exit, Failure};
use crate::interrupt;
use crate::source::Opened;

/// Samples where no number is given.
const SAMPLES: u32 = 16;

pub fn run(
    layers: Layers,
    (args, sources): (&ReferenceArgs, Sources<'_>),
    (stage, opened): (&StageArgs, Opened),
    set: &[(String, String)],
    output: &Output,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<Exit, Failure> {
    let id = layers.first().method.info().id;
    let (samples, seed) = args.only_samples(id)?;
    let layers = with_settings(layers, opened.document.as_ref(), set)?;
    let settings = &layers.first().settings;
    let mixed = opened.document.as_ref().filter(|_| !layers.is_single());
    let world = mixed.map_or_else(|| settings.clone(), |document| world_settings(&document.lighting, settings));
    let options = Options::new(&world);
    let staged = stage.set(opened, form_choice(settings), Forms::OfMaterials)?;
    let Staged { scene, camera, size, notices, document, .. } = staged;
    tell(err, &notices)?;

    let start = Instant::now();
    let stop = interrupt::watch().map_err(Failure::resources)?;
    let job = Handle::default();
    let view = View { camera, size, seed };
    let store = sources.store(layers.first(), &scene, err)?;
    let pool = args.pool()?;
    let (mut film, samples) = (Film::new(size), samples.unwrap_or(SAMPLES));
    let cancel = || {
        if stop.load(Ordering::Relaxed) {
            job.cancel();
        }
    };
    let drawn = interrupt::meanwhile(cancel, || {
        pool.install(|| {
            let world = World::new(&Arc::new(scene), options);
            layers.draw(&world, &store, &view, (&mut film, samples), &job)
        })
    });
    match drawn.map_err(|error| method_failure(id, &error))? {
        Some(Pass::Whole) => {}
        Some(Pass::Cancelled) => return Err(cancelled()),
        None => return Err(Failure::usage(format!("--method {id}: it does not draw on the processor"))),
    }
    let (tone, exposure_ev) = output.look(document.as_ref().map(|document| &document.view));
    write_picture(&film.picture(), &output.out, tone, exposure_ev).map_err(Failure::resources)?;
    let (UVec2 { x, y }, secs) = (size, start.elapsed().as_secs_f32());
    let others = match layers.overridden() {
        0 => String::new(),
        1 => ", 1 object by another method".into(),
        count => format!(", {count} objects by other methods"),
    };
    writeln!(out, "wrote {}: {x}x{y}, {samples} samples by {id}{others}, {secs:.1} s", output.out.display())?;
    Ok(Exit::Ok)
}

/// The layers with the settings of the scene's method from the document, if it is its method, and from `--set`.
fn with_settings(layers: Layers, document: Option<&Document>, set: &[(String, String)]) -> Result<Layers, Failure> {
    let method = layers.first().method;
    let stored = document.filter(|document| document.lighting.method == method.info().id.0);
    let mut settings = stored.map_or_else(|| layers.first().settings.clone(), |document| document.lighting.settings());
    assign(&mut settings, set)?;
    Ok(layers.iter().skip(1).cloned().fold(Layers::of(method, settings), Layers::with))
}

/// The settings of the world that a document's layers are drawn in. What is about the surface is that of the scene's
/// method, perhaps from `--set`.
fn world_settings(lighting: &LightingEntry, of_method: &Settings) -> Settings {
    let mut world = lighting.world_settings();
    for key in SHARED_SETTINGS {
        if let Some(value) = of_method.get(key) {
            // Both declare it.
            let _ = world.set_value(key, value);
        }
    }
    world
}

/// Why a method could not prepare.
pub fn method_failure(id: MethodId, error: &MethodError) -> Failure {
    match error {
        MethodError::Cancelled => cancelled(),
        MethodError::Unfit(reason) => Failure::resources(format!("--method {id}: {reason}")),
    }
}

fn cancelled() -> Failure {
    Failure { exit: Exit::Cancelled, messages: vec!["cancelled; nothing was written".into()] }
}
