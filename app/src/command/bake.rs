//! `burnish bake`: what a lighting method prepares, as a file.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use burnish_core::job::Handle;
use burnish_core::lighting::bakes::{About, Bake};
use burnish_core::lighting::classical::form_choice;
use burnish_core::lighting::prepared::Origin;
use burnish_core::lighting::radiance_map::{self, Shard};
use burnish_core::lighting::{Method, MethodError};
use burnish_core::param::Settings;
use burnish_core::reference::{Options, World};
use serde::Serialize;

use super::line::Line;
use super::saving::Saving;
use super::stage::{Forms, StageArgs, Staged};
use super::write_json;
use crate::failure::{Exit, Failure};
use crate::interrupt;
use crate::value::{self, MethodChoice};

#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    stage: StageArgs,
    /// Method that is prepared; `burnish methods` tells its settings
    #[arg(long, value_name = "METHOD", default_value = radiance_map::ID, value_parser = value::method)]
    method: MethodChoice,
    /// Setting of the method, such as points=30000; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = value::assignment)]
    set: Vec<(String, String)>,
    /// As --set seed=N: bakes of different seeds are independent of each other
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
    /// Bake one of N parts, I from 1 on: `burnish merge` joins them
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<[u32; 2]>,
    /// Threads, 1 to 1024; the bake does not depend on them [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// File to write, .bake; FILE.part keeps what is there of a bake of radiance-map: the same command goes on from it
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Most parts of a bake.
const MOST_SHARDS: u32 = 65_536;

fn shard(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once('/').and_then(|(which, of)| Some([which.parse().ok()?, of.parse().ok()?]));
    match parsed {
        Some([which, of]) if (1..=of).contains(&which) && of <= MOST_SHARDS => Ok([which, of]),
        _ => Err(format!("write it as I/N, such as 2/8: I from 1 to N, N at most {MOST_SHARDS}")),
    }
}

/// What was written.
#[derive(Serialize)]
pub(super) struct Report {
    pub file: String,
    pub method: String,
    /// Bytes in memory.
    pub bytes: u64,
    /// Relative standard error, where it is known.
    pub noise: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub secs: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rays: Option<u64>,
}

impl Report {
    pub fn of(bake: &Bake, file: &Path) -> Report {
        Report {
            file: file.display().to_string(),
            method: bake.about.origin.method.clone(),
            bytes: bake.prepared.bytes(),
            noise: bake.about.noise,
            secs: None,
            rays: None,
        }
    }

    pub fn write(&self, json: bool, out: &mut dyn Write) -> Result<(), Failure> {
        if json {
            return write_json(out, self);
        }
        let Report { file, method, bytes, noise, secs, rays } = self;
        write!(out, "wrote {file}: {method}, {:.1} MB", *bytes as f64 / 1e6)?;
        if let Some(noise) = noise {
            write!(out, ", noise {:.2} %", 100.0 * noise)?;
        }
        if let Some(secs) = secs {
            write!(out, ", {secs:.1} s")?;
        }
        if let (Some(rays), Some(secs)) = (rays, secs) {
            write!(out, ", {:.2} Mrays/s", *rays as f64 / secs.max(1e-9) / 1e6)?;
        }
        writeln!(out)?;
        Ok(())
    }
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let Args { stage, method, set, seed, shard, threads, out: file, json } = args;
    let method = method.0;
    let id = method.info().id;
    if stage.is_sized() {
        return Err(Failure::usage("--size is for pictures; leave it out"));
    }
    if id.0 != radiance_map::ID && shard.is_some() {
        return Err(Failure::usage(format!("--shard is for --method {}; leave it out", radiance_map::ID)));
    }
    super::render::check_folder("--out", &file)?;
    let opened = stage.open()?;
    let stored = opened.document.as_ref().filter(|document| document.lighting.method == id.0);
    let mut settings =
        stored.map_or_else(|| Settings::new(method.info().params), |document| document.lighting.settings());
    super::render::assign(&mut settings, &set)?;
    if let Some(seed) = seed {
        super::render::assign(&mut settings, &[("seed".into(), seed.to_string())])?;
    }
    let Staged { scene, notices, .. } = stage.set(opened, form_choice(&settings), Forms::OfMaterials)?;
    super::render::tell(err, &notices)?;

    let pool = super::render::threads(threads)?;
    let (job, start) = (Handle::default(), Instant::now());
    let stop = interrupt::watch().map_err(Failure::resources)?;
    let part = part_of(&file);
    let begun = if id.0 == radiance_map::ID { begun(&part, err)? } else { None };
    let unsaved = Mutex::new(None);
    let mut line = Line::new(err);
    let mut first = None;
    let look = || {
        if stop.load(Ordering::Relaxed) {
            job.cancel();
        }
        line.show(|| told(&job, start, &mut first));
    };
    let made = interrupt::meanwhile(look, || {
        pool.install(|| {
            let world = World::new(&Arc::new(scene), Options::new(&settings));
            if id.0 == radiance_map::ID {
                return baked(&world, &settings, shard, begun, (&part, &unsaved), &job).map(Made::Shard);
            }
            let prepared = method.prepare(&world, &settings, &job)?;
            let origin = Origin::of(method, &settings, world.scene());
            Ok(Made::Bake(Bake { about: About { origin, noise: None, runs: Vec::new() }, prepared }))
        })
    });
    line.clear();
    if let Some(error) = unsaved.into_inner().unwrap_or_else(PoisonError::into_inner) {
        line.tell(&format!("{error}; the bake went on without"));
    }
    let secs = start.elapsed().as_secs_f64();
    let report = match made.map_err(|error| failure(method, &error, &part))? {
        Made::Shard(whole) if shard.is_none() => {
            let bake = radiance_map::whole(&whole.about, &whole.blocks).map_err(Failure::resources)?;
            bake.write(&file).map_err(Failure::resources)?;
            Report { secs: Some(secs), rays: Some(whole.rays()), ..Report::of(&bake, &file) }
        }
        Made::Shard(shard) => {
            shard.write(&file).map_err(Failure::resources)?;
            Report {
                file: file.display().to_string(),
                method: id.0.into(),
                bytes: shard.bytes(),
                noise: radiance_map::noise(&shard.blocks),
                secs: Some(secs),
                rays: Some(shard.rays()),
            }
        }
        Made::Bake(bake) if bake.prepared.is_nothing() => {
            return Err(Failure::usage(format!("--method {id} prepares nothing; there is nothing to keep")));
        }
        Made::Bake(bake) => {
            bake.write(&file).map_err(Failure::resources)?;
            Report { secs: Some(secs), ..Report::of(&bake, &file) }
        }
    };
    if id.0 == radiance_map::ID {
        // The whole is there: what was kept of it is not needed.
        let _ = std::fs::remove_file(&part);
    }
    report.write(json, out)?;
    Ok(Exit::Ok)
}

enum Made {
    Shard(Shard),
    Bake(Bake),
}

/// Where an unfinished bake is kept.
fn part_of(file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

/// What there is of an earlier try; a file that cannot be read is begun anew.
fn begun(part: &Path, err: &mut dyn Write) -> Result<Option<Shard>, Failure> {
    if !part.exists() {
        return Ok(None);
    }
    match Shard::read(part) {
        Ok(shard) => {
            super::render::tell(err, &[format!("{}: going on, where it is of the same bake", part.display())])?;
            Ok(Some(shard))
        }
        Err(error) => {
            super::render::tell(err, &[format!("{error}; the bake begins anew")])?;
            Ok(None)
        }
    }
}

/// Bakes, and writes what is there every now and then.
fn baked(
    world: &World,
    settings: &Settings,
    shard: Option<[u32; 2]>,
    begun: Option<Shard>,
    (part, unsaved): (&Path, &Mutex<Option<String>>),
    job: &Handle,
) -> Result<Shard, MethodError> {
    // The first blocks show whether it can be written.
    let mut saving = Saving::due();
    let keep = |shard: &Shard| {
        if !saving.is_due() && !job.is_cancelled() {
            return;
        }
        let start = Instant::now();
        // The bake is worth more than what is kept of it: it goes on.
        if let Err(error) = shard.write(part) {
            *unsaved.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
        }
        saving.took(start.elapsed());
    };
    radiance_map::run(world, settings, shard.unwrap_or([1, 1]), begun, keep, job)
}

/// Where the work stands, for people.
fn told(job: &Handle, start: Instant, first: &mut Option<(f32, f64)>) -> String {
    let (done, secs) = (job.progress(), start.elapsed().as_secs_f64());
    let mut text = format!("{:.0} %", 100.0 * done);
    let (from, since) = *first.get_or_insert((done, secs));
    if done > from {
        let left = (f64::from(1.0 - done) * (secs - since) / f64::from(done - from)).round() as u64;
        text += &format!(", {}:{:02} left", left / 60, left % 60);
    }
    text
}

fn failure(method: &dyn Method, error: &MethodError, part: &Path) -> Failure {
    match error {
        MethodError::Cancelled if part.exists() => {
            let message =
                format!("cancelled; {} keeps what was baked, and the same command goes on from it", part.display());
            Failure { exit: Exit::Cancelled, messages: vec![message] }
        }
        other => super::render::method_failure(method.info().id, other),
    }
}
