//! Pictures by the reference, on the processor alone.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::document::Document;
use burnish_core::file::{PictureFormat, write_png};
use burnish_core::lighting::{MethodId, classical};
use burnish_core::material::preset::{self, FormChoice};
use burnish_core::param::Settings;
use burnish_core::reference::checkpoint::Key;
use burnish_core::reference::{self, Film, Goal, MAX_SAMPLES, Options, View, World};
use burnish_core::surface::fresnel::Form;
use glam::UVec2;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::tracing::{Store, Traced, Tracing};
use super::{Output, assign, check_folder, tell};
use crate::command::stage::{Forms, StageArgs, Staged};
use crate::failure::{Exit, Failure};
use crate::source::Opened;
use crate::value;

/// Samples where no end is given.
const SAMPLES: u32 = 64;

/// What only this method takes.
#[derive(clap::Args, Default)]
pub struct ReferenceArgs {
    /// Samples of every pixel, 1 to 16777216 [default: 64 when neither --time nor --error is given]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    samples: Option<u32>,
    /// Seconds to trace for, to the nearest sample; of several ends the first counts
    #[arg(long, value_name = "S", value_parser = value::number(0.0, 1e9))]
    time: Option<f32>,
    /// Relative standard error of the picture to reach, such as 0.02: the root of the relMSE that noise makes
    #[arg(long, value_name = "E", value_parser = value::number(1e-6, 1e3))]
    error: Option<f32>,
    /// Pictures of different seeds are independent of each other, 0 to 4294967295 [default: 0]
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
    /// Most surfaces on the way of light, as --set bounces=N
    #[arg(long, value_name = "N")]
    bounces: Option<u32>,
    /// File that keeps the samples: written every 10 seconds and at the end; if it exists, the picture goes on from it
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// Threads, 1 to 1024; the picture does not depend on them [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

impl ReferenceArgs {
    /// So many samples of every pixel, all else as it is without options.
    pub fn of_samples(samples: u32) -> ReferenceArgs {
        ReferenceArgs { samples: Some(samples), ..ReferenceArgs::default() }
    }

    /// An option that was given.
    pub fn given(&self) -> Option<&'static str> {
        self.all_given().first().copied()
    }

    fn all_given(&self) -> Vec<&'static str> {
        let ReferenceArgs { samples, time, error, seed, bounces, checkpoint, threads } = self;
        let options = [
            ("--samples", samples.is_some()),
            ("--time", time.is_some()),
            ("--error", error.is_some()),
            ("--seed", seed.is_some()),
            ("--bounces", bounces.is_some()),
            ("--checkpoint", checkpoint.is_some()),
            ("--threads", threads.is_some()),
        ];
        options.into_iter().filter(|(_, given)| *given).map(|(name, _)| name).collect()
    }

    /// The options that other methods on the processor take too, samples and seed; any other is refused.
    pub fn only_samples(&self, id: MethodId) -> Result<(Option<u32>, u32), Failure> {
        let ReferenceArgs { samples, seed, threads: _, .. } = self;
        let shared = ["--samples", "--seed", "--threads"];
        match self.all_given().into_iter().find(|option| !shared.contains(option)) {
            Some(option) => Err(Failure::usage(format!("{option} does not go with --method {id}; leave it out"))),
            None => Ok((*samples, seed.unwrap_or(0))),
        }
    }

    fn goal(&self) -> Goal {
        let open = self.time.is_none() && self.error.is_none();
        Goal {
            samples: self.samples.or(open.then_some(SAMPLES)),
            secs: self.time.map(f64::from),
            error: self.error.map(f64::from),
        }
    }

    fn settings(&self, set: &[(String, String)], document: Option<&Document>) -> Result<Settings, Failure> {
        let stored = document.map(|document| document.lighting.reference_settings());
        let mut settings = stored.unwrap_or_else(|| Settings::new(reference::PARAMS));
        assign(&mut settings, set)?;
        if let Some(bounces) = self.bounces {
            settings
                .set("bounces", &bounces.to_string())
                .map_err(|e| Failure::usage(format!("--bounces {bounces}: {e}")))?;
        }
        Ok(settings)
    }

    /// The threads.
    pub fn pool(&self) -> Result<ThreadPool, Failure> {
        threads(self.threads)
    }
}

/// The threads of `--threads`.
pub fn threads(given: Option<u16>) -> Result<ThreadPool, Failure> {
    // Zero stands for one for each core.
    let pool = ThreadPoolBuilder::new().num_threads(given.unwrap_or(0).into()).build();
    pool.map_err(|e| Failure::resources(format!("the threads cannot be started: {e}; give fewer --threads")))
}

pub fn run(
    args: &ReferenceArgs,
    (stage, opened): (&StageArgs, Opened),
    set: &[(String, String)],
    output: &Output,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<Exit, Failure> {
    if let Some(file) = &args.checkpoint {
        check_folder("--checkpoint", file)?;
        if *file == output.out {
            return Err(Failure::usage("--checkpoint and --out name the same file; give them different names"));
        }
    }
    let settings = args.settings(set, opened.document.as_ref())?;
    let choice = form_choice(&settings, opened.document.as_ref());
    let Staged { scene, camera, size, mut notices, document, metals } = stage.set(opened, choice, Forms::OfAll)?;

    let view = View { camera, size, seed: args.seed.unwrap_or(0) };
    let pool = args.pool()?;
    let of_document = |id: &str| document.as_ref()?.metal(id).cloned();
    let metal = |id: &str| metals.get(id).cloned().or_else(|| of_document(id)).or_else(|| preset::find(id).ok());
    let (world, unknown) = pool.install(|| World::of_settings(&Arc::new(scene), &settings, None, metal));
    notices.extend(unknown.iter().map(|id| format!("the n and k of `{id}` are not known; its colour is traced")));
    tell(err, &notices)?;
    let (film, store) = match &args.checkpoint {
        Some(file) => resume(file, pool.install(|| Key::new(&world, &view)), size, args, err)?,
        None => (Film::new(size), None),
    };
    let tracing = Tracing { world: &world, view: &view, goal: args.goal(), pool: &pool };
    let traced = tracing.run(film, store, err)?;
    let Traced { film, unsaved, .. } = &traced;
    warn(film, err)?;
    if traced.end.is_none() {
        return Err(cancelled(film, args.checkpoint.as_deref(), unsaved.as_deref()));
    }
    let (tone, exposure_ev) = output.look(document.as_ref().map(|document| &document.view));
    match PictureFormat::of(&output.out) {
        Ok(PictureFormat::Exr) => film.write_exr(&world, &view, &output.out),
        _ => write_png(&film.picture(), &output.out, tone, exposure_ev),
    }
    .map_err(Failure::resources)?;
    writeln!(out, "{}", summary(&traced, &output.out, world.options()))?;
    match unsaved {
        Some(reason) => Err(Failure::resources(reason)),
        None => Ok(Exit::Ok),
    }
}

/// The form of all metals; the tolerances of its cheapest are those of the document.
fn form_choice(settings: &Settings, document: Option<&Document>) -> FormChoice {
    let live = document.map_or_else(|| Settings::new(classical::PARAMS), |d| d.lighting.settings());
    let text = settings.text("fresnel").unwrap_or_default();
    FormChoice::read(&text, classical::tolerance(&live)).unwrap_or(FormChoice::Of(Form::Spectral))
}

/// The film of a checkpoint if there is one, else a new one.
fn resume(
    file: &Path,
    key: Key,
    size: UVec2,
    args: &ReferenceArgs,
    err: &mut dyn Write,
) -> Result<(Film, Option<Store>), Failure> {
    if !file.exists() {
        return Ok((Film::new(size), Some(Store::new(file, key))));
    }
    let film = reference::checkpoint::read(file, &key).map_err(|e| Failure::input(file, e))?;
    let held = film.samples();
    if let Some(wanted) = args.samples.filter(|wanted| held > *wanted) {
        let reason = format!("holds {held} samples, more than --samples {wanted}");
        return Err(Failure::usage(format!("{}: {reason}; ask for {held} or more, or name another", file.display())));
    }
    writeln!(err, "burnish: notice: going on from {} at {held} samples", file.display())?;
    Ok((film, Some(Store::resumed(file, key))))
}

/// Tells of samples that are not in the picture.
fn warn(film: &Film, err: &mut dyn Write) -> Result<(), Failure> {
    if let Some(first) = film.first_rejected() {
        let (count, UVec2 { x, y }, sample) = (film.rejected(), first.pixel, first.sample);
        writeln!(
            err,
            "burnish: warning: {count} samples were not finite and are left out, the first at pixel {x},{y}, sample \
             {sample}; please report the scene"
        )?;
    }
    Ok(())
}

fn cancelled(film: &Film, checkpoint: Option<&Path>, unsaved: Option<&str>) -> Failure {
    if film.samples() == 0 {
        let message = "cancelled before every pixel had its first sample; nothing was written".into();
        return Failure { exit: Exit::Cancelled, messages: vec![message] };
    }
    let kept = match (checkpoint, unsaved) {
        (_, Some(reason)) => format!("the checkpoint is lost: {reason}"),
        (Some(file), None) => format!("{} holds them: the same command goes on from there", file.display()),
        (None, None) => "nothing was written; with --checkpoint FILE a picture can go on later".into(),
    };
    Failure { exit: Exit::Cancelled, messages: vec![format!("cancelled at {} samples; {kept}", film.samples())] }
}

fn summary(traced: &Traced, file: &Path, options: &Options) -> String {
    let Traced { film, secs, rays, .. } = traced;
    let UVec2 { x, y } = film.size();
    let (samples, mega_rays) = (film.samples(), *rays as f64 / secs.max(1e-9) / 1e6);
    let error = if film.error().is_finite() { format!("error {:.4}", film.error()) } else { "error unknown".into() };
    let mut line =
        format!("wrote {}: {x}x{y}, {samples} samples, {error}, {secs:.1} s, {mega_rays:.2} Mrays/s", file.display());
    if film.rejected() > 0 {
        line += &format!(", {} samples not finite", film.rejected());
    }
    if options.clamp.is_finite() {
        line += &format!(", {:.3} % of the light clamped", 100.0 * film.clamped_share());
    }
    line
}
