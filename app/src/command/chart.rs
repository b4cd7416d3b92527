//! `burnish chart`: what lighting methods cost against how wrong they are, on one scene or many.

use std::ffi::{OsStr, OsString};
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use burnish_core::document::LightingPreset;
use burnish_core::file::write_atomic;
use burnish_core::lighting;
use burnish_core::lighting::method::{self, Method, Sweep};
use burnish_core::measure::bench::{self, BenchError, Cache, Candidate, News, Record, Rig, Shot};
use burnish_core::param::Settings;
use burnish_core::reference::{self, Control};
use burnish_core::scene::{Scene, gallery};
use glam::UVec2;

use super::lighting as presets;
use crate::failure::{Exit, Failure, printable};
use crate::report::bench::{Look, Measure, drawing, page};
use crate::window::Folders;
use crate::{interrupt, rig, source, value};

#[derive(clap::Args)]
pub struct Args {
    /// Model files (.gltf, .glb, .obj), documents (.burnish) or gallery:NAME[?key=value&...] [default: gallery:workbench]
    scenes: Vec<OsString>,
    /// All scenes of the gallery
    #[arg(long)]
    gallery: bool,
    /// Lighting methods to compare
    #[arg(long, value_name = "METHOD,...", value_delimiter = ',', default_value = "classical,reference")]
    methods: Vec<String>,
    /// Values that a setting takes; without METHOD in all methods that have it; all combinations are measured; repeatable
    #[arg(long, value_name = "[METHOD.]KEY=A,B,...", value_parser = str::parse::<Sweep>)]
    sweep: Vec<Sweep>,
    /// Object that the pictures are about, by name; repeatable [default: the scene's own subject, else all]
    #[arg(long, value_name = "NAME")]
    subject: Vec<String>,
    /// Environment map, .hdr or .exr; repeatable: every scene under each [default: that of the scene, else a studio]
    #[arg(long, value_name = "FILE")]
    env: Vec<PathBuf>,
    /// Lighting preset around the subject in the place of all lights: an id, `all`, or a .json file; repeatable: every scene under each
    #[arg(long, value_name = "ID|FILE")]
    lighting: Vec<String>,
    /// Pixels of the pictures
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = value::size)]
    size: UVec2,
    /// Jittered frames whose mean is compared, 1 to 4096: more where bright edges decide the errors
    #[arg(long, value_name = "N", default_value_t = bench::COMPARED_FRAMES, value_parser = clap::value_parser!(u32).range(1..=4096))]
    frames: u32,
    /// Paths through a pixel of the reference, 2 to 16777216
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(2..=1 << 24))]
    samples: u32,
    /// Setting of the reference that all are judged by, such as bounces=8; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = value::assignment)]
    truth: Vec<(String, String)>,
    /// Draw on the processor also what the graphics device could draw
    #[arg(long)]
    processor: bool,
    /// Measure everything anew: read nothing that was kept from earlier runs
    #[arg(long)]
    fresh: bool,
    /// Folder of what is kept [default: the user's cache]
    #[arg(long, value_name = "FOLDER")]
    cache: Option<PathBuf>,
    /// Setting whose values have a mark each in the chart, of methods that have it [default: a mark for each method]
    #[arg(long, value_name = "KEY")]
    series: Option<String>,
    /// Error that the chart shows; the table has all
    #[arg(long, value_name = "MEASURE", value_enum, default_value_t)]
    measure: Measure,
    /// Chart to write, .svg
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Table to write, .csv; its columns are described in docs/chart.md
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Page to write, .html, with the chart and all figures
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let chosen = methods(&args.methods)?;
    let candidates = candidates(&chosen, &args.sweep)?;
    let truth = truth(&args.truth)?;
    if let Some(key) = &args.series {
        known(&chosen, key)?;
    }
    let shots = shots(&args, err)?;
    let cache = cache(&args)?;
    let stop = interrupt::watch().map_err(Failure::resources)?;
    let control = Control::default();
    let mut rig = rig::rig(&control, args.processor).map_err(Failure::resources)?;

    let mut records = Vec::new();
    let mut failed = None;
    for shot in &shots {
        match measure(shot, &candidates, (&truth, args.samples), &mut rig, &cache, (&stop, &control), err) {
            Ok(more) => records.extend(more),
            Err(error) => {
                failed = Some(failure(&shot.name, &error));
                break;
            }
        }
    }
    // What was measured before a fault is written all the same.
    if !records.is_empty() {
        write(&args, &records, out)?;
    }
    failed.map_or(Ok(Exit::Ok), Err)
}

fn methods(names: &[String]) -> Result<Vec<&'static dyn Method>, Failure> {
    let mut chosen: Vec<&'static dyn Method> = Vec::new();
    for name in names {
        let found = method::find(&lighting::methods(), name).map_err(|e| Failure::usage(format!("--methods: {e}")))?;
        if !chosen.iter().any(|known| known.info().id == found.info().id) {
            chosen.push(found);
        }
    }
    Ok(chosen)
}

fn candidates(methods: &[&dyn Method], sweeps: &[Sweep]) -> Result<Vec<Candidate>, Failure> {
    let usage = |e: method::SweepError| Failure::usage(format!("--sweep: {e}"));
    method::check_sweeps(methods, sweeps).map_err(usage)?;
    let mut list = Vec::new();
    for chosen in methods {
        let all = method::combinations(*chosen, sweeps).map_err(usage)?;
        list.extend(all.into_iter().map(|settings| Candidate { method: chosen.info().id, settings }));
    }
    Ok(list)
}

/// Refuses a setting that none of the methods has.
fn known(methods: &[&dyn Method], key: &str) -> Result<(), Failure> {
    let mut all: Vec<&str> =
        methods.iter().flat_map(|method| method.info().params.iter().map(|spec| spec.key)).collect();
    if all.contains(&key) {
        return Ok(());
    }
    all.sort_unstable();
    all.dedup();
    Err(Failure::usage(format!(
        "--series {key}: the chosen methods have no such setting; there are: {}",
        all.join(", ")
    )))
}

/// Settings of the reference.
fn truth(choices: &[(String, String)]) -> Result<Settings, Failure> {
    let mut settings = Settings::new(reference::PARAMS);
    for (key, value) in choices {
        if key == "samples" {
            return Err(Failure::usage(format!("--truth {key}={value}: write it as --samples {value}")));
        }
        settings.set(key, value).map_err(|e| Failure::usage(format!("--truth {key}={value}: {e}")))?;
    }
    Ok(settings)
}

fn shots(args: &Args, err: &mut dyn Write) -> Result<Vec<Shot>, Failure> {
    let mut names = args.scenes.clone();
    if args.gallery {
        names.extend(gallery::list().iter().map(|scene| format!("gallery:{}", scene.name).into()));
    }
    if names.is_empty() {
        names.push(source::DEFAULT_SCENE.into());
    }
    let mut environments = Vec::new();
    for file in &args.env {
        environments.push(Some((file.as_path(), source::environment(file)?)));
    }
    if environments.is_empty() {
        environments.push(None);
    }
    let mut lightings: Vec<Option<LightingPreset>> = presets::find_all(&args.lighting)?.into_iter().map(Some).collect();
    if lightings.is_empty() {
        lightings.push(None);
    }
    let mut shots = Vec::new();
    for scene in &names {
        for environment in &environments {
            let under = environment.as_ref().filter(|_| environments.len() > 1);
            let under = under.and_then(|(file, _)| file.file_stem()).map(|stem| stem.to_string_lossy());
            for preset in &lightings {
                let map = environment.as_ref().map(|(_, map)| map);
                let mut shot = shot(scene, (map, preset.as_ref()), args, err)?;
                shot.name.extend(under.iter().map(|map| format!(" under {map}")));
                shot.name.extend(preset.iter().map(|preset| format!(" lit by {}", preset.id)));
                shots.push(shot);
            }
        }
    }
    Ok(shots)
}

/// What is looked at of a SCENE.
fn shot(
    scene: &OsStr,
    (environment, preset): (Option<&source::EnvironmentFile>, Option<&LightingPreset>),
    args: &Args,
    err: &mut dyn Write,
) -> Result<Shot, Failure> {
    let mut opened = source::open(scene)?.complete()?;
    opened.light(environment);
    let camera = opened.camera(args.size);
    let name = scene.to_string_lossy().to_string();
    let source::Opened { mut scene, notices, document, .. } = opened;
    for notice in notices {
        writeln!(err, "burnish: notice: {}: {}", printable(&name), printable(&notice))?;
    }
    // Around the subject that the scene has, as `render` does it: `--subject` changes what is measured, not what is seen.
    if let Some(preset) = preset {
        presets::light(&mut scene, preset);
    }
    if !args.subject.is_empty() {
        scene.subject = subject(&scene, &args.subject)?;
    }
    let exposure_ev = document.as_ref().map_or(0.0, |document| document.view.exposure_ev as f32);
    let metals = document.iter().flat_map(|document| &document.presets);
    let metals = metals.map(|metal| (metal.id.clone(), Clone::clone(&**metal))).collect();
    let (scene, size, compared_frames) = (Arc::new(scene), args.size, args.frames);
    let shot = Shot { name, scene, camera, size, exposure_ev, compared_frames, metals };
    for id in shot.unknown_metals() {
        let (name, id) = (printable(&shot.name), printable(id));
        writeln!(err, "burnish: notice: {name}: the n and k of `{id}` are not known; its form is not changed")?;
    }
    Ok(shot)
}

/// The instances of these names.
fn subject(scene: &Scene, names: &[String]) -> Result<Vec<usize>, Failure> {
    let mut subject = Vec::new();
    for name in names {
        let before = subject.len();
        subject.extend((0..scene.instances.len()).filter(|i| scene.instances[*i].name == *name));
        if subject.len() == before {
            let known: Vec<&str> = scene.instances.iter().map(|instance| instance.name.as_str()).collect();
            return Err(Failure::usage(format!(
                "--subject {name}: no such object in `{}`; there are: {}",
                printable(&scene.name),
                printable(&known.join(", "))
            )));
        }
    }
    Ok(subject)
}

fn cache(args: &Args) -> Result<Cache, Failure> {
    let folder = args.cache.clone().or_else(|| Some(Folders::of_user()?.bench()));
    let cache = folder.map_or_else(Cache::none, |folder| Cache::within(&folder));
    Ok(if args.fresh { cache.fresh() } else { cache })
}

/// The records of a shot; a line is written for each step that is new.
fn measure(
    shot: &Shot,
    candidates: &[Candidate],
    (settings, samples): (&Settings, u32),
    rig: &mut Rig<'_>,
    cache: &Cache,
    (stop, control): (&AtomicBool, &Control),
    err: &mut dyn Write,
) -> Result<Vec<Record>, BenchError> {
    let mut told = String::new();
    let mut progress = |words: &str| {
        if stop.load(Ordering::Relaxed) {
            control.cancel();
            return Err(BenchError::Cancelled);
        }
        if told != words {
            told = words.into();
            // Progress that nobody can read does no harm.
            let _ = writeln!(err, "burnish: {}", printable(words));
        }
        Ok(())
    };
    progress(&format!("{}: tracing the reference", shot.name))?;
    let truth = rig::truth(shot, settings, samples, (cache, control), None, || {
        if stop.load(Ordering::Relaxed) {
            control.cancel();
        }
    })?;
    bench::measure(shot, &truth, candidates, rig, cache, &mut |news| match news {
        News::Next(words) => progress(words),
        News::Done(..) => Ok(()),
    })
}

fn failure(scene: &str, error: &BenchError) -> Failure {
    match error {
        BenchError::Cancelled => Failure {
            exit: Exit::Cancelled,
            messages: vec!["cancelled; what was measured is kept: the same command without --fresh goes on".into()],
        },
        error => Failure::resources(format!("{scene}: {error}")),
    }
}

fn write(args: &Args, records: &[Record], out: &mut dyn Write) -> Result<(), Failure> {
    let command = std::env::args().skip(1).collect::<Vec<_>>().join(" ");
    let look = Look { measure: args.measure, series: args.series.clone() };
    let svg = || drawing(records, &look);
    let csv = || bench::csv(records);
    let html = || page(records, &lighting::methods(), &look, &format!("burnish {command}"));
    let files: [(&Option<PathBuf>, &dyn Fn() -> String); 3] =
        [(&args.out, &svg), (&args.csv, &csv), (&args.html, &html)];
    for (file, text) in files.into_iter().filter_map(|(file, text)| Some((file.as_ref()?, text()))) {
        write_atomic(file, text.as_bytes()).map_err(Failure::resources)?;
        writeln!(out, "wrote {}: {} measurements", file.display(), records.len())?;
    }
    for record in records {
        let Some((errors, floor)) = record.of(record.region()) else { continue };
        writeln!(
            out,
            "{:24} {:10} {:>10.2} ms {:>8.2} x  relMSE {:.3e}{} FLIP {:.4} bias {:+.2} % difference {:.2} %  {}",
            printable(&record.scene),
            record.method,
            1e3 * record.frame_secs,
            record.ratio(),
            errors.relmse,
            if errors.relmse <= floor.relmse { " (noise)" } else { "" },
            errors.flip,
            100.0 * errors.bias,
            100.0 * errors.difference,
            record.settings_text()
        )?;
    }
    Ok(())
}
