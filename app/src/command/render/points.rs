//! Pictures by a method that draws point by point on the processor.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use burnish_core::file::write_picture;
use burnish_core::job::Handle;
use burnish_core::lighting::classical::form_choice;
use burnish_core::lighting::{Drawing, Method, MethodError, MethodId, Store};
use burnish_core::param::Settings;
use burnish_core::reference::{Control, Film, Options, Pass, View, World};
use glam::UVec2;

use super::reference::ReferenceArgs;
use super::{Output, assign, tell};
use crate::command::stage::{Forms, StageArgs, Staged};
use crate::failure::{Exit, Failure};
use crate::interrupt;
use crate::window::Folders;

/// Samples where no number is given.
const SAMPLES: u32 = 16;

pub fn run(
    method: &'static dyn Method,
    (args, cache): (&ReferenceArgs, Option<&Path>),
    stage: &StageArgs,
    set: &[(String, String)],
    output: &Output,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<Exit, Failure> {
    let id = method.info().id;
    let (samples, seed) = args.only_samples(id)?;
    let opened = stage.open()?;
    let stored = opened.document.as_ref().filter(|document| document.lighting.method == id.0);
    let mut settings =
        stored.map_or_else(|| Settings::new(method.info().params), |document| document.lighting.settings());
    assign(&mut settings, set)?;
    let staged = stage.set(opened, form_choice(&settings), Forms::OfMaterials)?;
    let Staged { scene, camera, size, notices, document, .. } = staged;
    tell(err, &notices)?;

    let start = Instant::now();
    let stop = interrupt::watch().map_err(Failure::resources)?;
    let job = Handle::default();
    let view = View { camera, size, seed };
    let folder = cache.map(Path::to_path_buf).or_else(|| Some(Folders::of_user()?.prepared()));
    let store = folder.map_or_else(Store::none, |folder| Store::within(&folder));
    let pool = args.pool()?;
    let (mut film, samples) = (Film::new(size), samples.unwrap_or(SAMPLES));
    let cancel = || {
        if stop.load(Ordering::Relaxed) {
            job.cancel();
        }
    };
    let drawn = interrupt::meanwhile(cancel, || {
        pool.install(|| {
            let world = World::new(&Arc::new(scene), Options::new(&settings));
            let prepared = store.prepare(method, &world, &settings, &job)?;
            let drawing = Drawing::new(method, &world, &prepared, &settings);
            Ok(drawing.map(|drawing| drawing.draw(&view, &mut film, samples, &Control::of_job(&job))))
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
    writeln!(out, "wrote {}: {x}x{y}, {samples} samples by {id}, {secs:.1} s", output.out.display())?;
    Ok(Exit::Ok)
}

fn method_failure(id: MethodId, error: &MethodError) -> Failure {
    match error {
        MethodError::Cancelled => cancelled(),
        MethodError::Unfit(reason) => Failure::resources(format!("--method {id}: {reason}")),
    }
}

fn cancelled() -> Failure {
    Failure { exit: Exit::Cancelled, messages: vec!["cancelled; nothing was written".into()] }
}
