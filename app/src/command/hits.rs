//! `burnish hits`: how far the searches of `impostor` are off what mirrored lines of sight meet, and what they cost.

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::file::write_atomic;
use burnish_core::job::Handle;
use burnish_core::lighting::Method;
use burnish_core::lighting::impostor::{self, HitErrors, Impostor, Solver};
use burnish_core::measure::median;
use burnish_core::param::Settings;
use burnish_core::reference::{Options, View as Eyes, World};
use burnish_render::{Gpu, Lighting, Passes, Renderer, View};
use glam::UVec2;
use serde::Serialize;

use super::write_json;
use crate::failure::{Exit, Failure, printable};
use crate::{source, value};

/// Frames of which the median time counts.
const FRAMES: usize = 7;

#[derive(clap::Args)]
pub struct Args {
    /// Model files (.gltf, .glb, .obj), documents (.burnish) or gallery:NAME[?key=value&...] [default: gallery:room]
    scenes: Vec<OsString>,
    /// Searches to measure [default: all]
    #[arg(long, value_name = "SOLVER,...", value_delimiter = ',')]
    solvers: Vec<String>,
    /// Refinements of the searches that have some
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_values_t = [0, 1, 2, 4, 10, 48])]
    refinements: Vec<u32>,
    /// Setting of the method, such as resolution=256; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = value::assignment)]
    set: Vec<(String, String)>,
    /// Pixels of the view whose lines of sight are mirrored
    #[arg(long, value_name = "WxH", default_value = "700x700", value_parser = value::size)]
    size: UVec2,
    /// Leave frames untimed: needs no graphics device
    #[arg(long)]
    untimed: bool,
    /// Table to write, .csv
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// A search on a scene.
#[derive(Clone, Debug, Serialize)]
struct Row {
    scene: String,
    solver: &'static str,
    refinements: u32,
    rays: usize,
    /// Degrees.
    median: f32,
    /// Degrees.
    p95: f32,
    /// Share of the rays.
    misses: f32,
    /// Share of the rays.
    hidden: f32,
    /// Share of the rays that meet what the probe sees.
    off: f32,
    lookups: f32,
    /// Milliseconds of a frame; null where none was timed.
    frame_ms: Option<f64>,
    /// The same over that of the method `classical`.
    ratio: Option<f64>,
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let solvers = solvers(&args.solvers)?;
    let mut settings = Settings::new(impostor::PARAMS);
    // The cheapest lookups: what searches cost stands out, and is no more than that.
    settings.set("samples", "0").map_err(|e| Failure::usage(e.to_string()))?;
    super::render::assign(&mut settings, &args.set)?;
    let passes =
        if args.untimed { None } else { Some(Arc::new(Passes::new(&Gpu::new().map_err(Failure::resources)?))) };
    let scenes = if args.scenes.is_empty() { vec!["gallery:room".into()] } else { args.scenes.clone() };
    let mut rows = Vec::new();
    for scene in &scenes {
        rows.extend(measure(scene, &solvers, &settings, &args, passes.as_ref(), err)?);
    }
    if let Some(file) = &args.csv {
        write_atomic(file, csv(&rows).as_bytes()).map_err(Failure::resources)?;
    }
    if args.json {
        write_json(out, &rows)?
    } else {
        write!(out, "{}", table(&rows))?
    }
    Ok(Exit::Ok)
}

fn solvers(names: &[String]) -> Result<Vec<Solver>, Failure> {
    if names.is_empty() {
        return Ok(Solver::ALL.to_vec());
    }
    let find = |name: &String| {
        let found = Solver::ALL.into_iter().find(|solver| solver.id() == name);
        found.ok_or_else(|| Failure::usage(format!("--solvers {name}: there are {}", Solver::IDS.join(", "))))
    };
    names.iter().map(find).collect()
}

/// Searches of one scene; those without refinements once.
fn measure(
    scene: &OsString,
    solvers: &[Solver],
    settings: &Settings,
    args: &Args,
    passes: Option<&Arc<Passes>>,
    err: &mut dyn Write,
) -> Result<Vec<Row>, Failure> {
    let name = scene.to_string_lossy().to_string();
    let mut opened = source::open(scene)?.complete()?;
    opened.light(None);
    let (camera, scene) = (opened.camera(args.size), Arc::new(opened.scene));
    let world = World::new(&scene, Options::new(settings));
    let prepared = Impostor.prepare(&world, settings, &Handle::default()).map_err(Failure::resources)?;
    for warning in Impostor.warnings(&scene, &prepared, settings) {
        writeln!(err, "burnish: notice: {}: {}", printable(&name), printable(&warning))?;
    }
    let rays = impostor::mirror_rays(&world, &prepared, &Eyes { camera: camera.clone(), size: args.size, seed: 0 });
    let mut timer = match passes {
        Some(passes) => {
            let lighting = Lighting::new(Impostor.info().id, Some(Arc::new(prepared.clone())));
            Some(Timer::new(
                passes,
                &scene,
                &lighting,
                View { size: args.size, camera, settings: settings.clone(), jitter_frames: 1 },
            )?)
        }
        None => None,
    };
    let mut rows = Vec::new();
    for solver in solvers {
        let refined = !matches!(
            solver,
            Solver::Classical | Solver::Sphere | Solver::Box | Solver::Perpendicular | Solver::Pyramid
        );
        for refinements in if refined { args.refinements.as_slice() } else { &[0] } {
            let mut own = settings.clone();
            own.set("solver", solver.id()).map_err(|e| Failure::usage(e.to_string()))?;
            own.set("refinements", &refinements.to_string()).map_err(|e| Failure::usage(e.to_string()))?;
            let HitErrors { rays, median, p95, misses, hidden, off, lookups } =
                impostor::hit_errors(&prepared, &rays, &impostor::effort(&own));
            let times = timer.as_mut().map(|timer| timer.time(own)).transpose()?;
            rows.push(Row {
                scene: name.clone(),
                solver: solver.id(),
                refinements: *refinements,
                rays,
                median,
                p95,
                misses,
                hidden,
                off,
                lookups,
                frame_ms: times.map(|[own, _]| 1e3 * own),
                ratio: times.map(|[own, classical]| own / classical),
            });
        }
    }
    Ok(rows)
}

/// Frames by the method and by `classical`, in turn.
struct Timer {
    own: Renderer,
    classical: Renderer,
    view: View,
}

impl Timer {
    fn new(
        passes: &Arc<Passes>,
        scene: &Arc<burnish_core::scene::Scene>,
        lighting: &Lighting,
        view: View,
    ) -> Result<Timer, Failure> {
        let mut own = Renderer::with_passes(passes, scene).map_err(Failure::resources)?;
        own.light_by(lighting).map_err(Failure::resources)?;
        let mut classical = Renderer::with_passes(passes, scene).map_err(Failure::resources)?;
        // Shaders are compiled.
        own.time_frame(&view).and_then(|_| classical.time_frame(&view)).map_err(Failure::resources)?;
        Ok(Timer { own, classical, view })
    }

    /// Median seconds of a frame by the method, and by `classical` between them: a busy machine slows both.
    fn time(&mut self, settings: Settings) -> Result<[f64; 2], Failure> {
        let view = View { settings, ..self.view.clone() };
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..FRAMES {
            times[0].push(self.own.time_frame(&view).map_err(Failure::resources)?);
            times[1].push(self.classical.time_frame(&view).map_err(Failure::resources)?);
        }
        Ok(times.map(|mut times| median(&mut times)))
    }
}

fn csv(rows: &[Row]) -> String {
    let mut text =
        "scene,solver,refinements,rays,median_deg,p95_deg,misses,hidden,off,lookups,frame_ms,ratio\n".to_string();
    for row in rows {
        let Row { scene, solver, refinements, rays, median, p95, misses, hidden, off, lookups, frame_ms, ratio } = row;
        let optional = |value: &Option<f64>| value.map(|value| format!("{value:.4}")).unwrap_or_default();
        let (ms, ratio) = (optional(frame_ms), optional(ratio));
        let scene = scene.replace('"', "\"\"");
        text += &format!(
            "\"{scene}\",{solver},{refinements},{rays},{median:.5},{p95:.5},{misses:.6},{hidden:.6},{off:.6},{lookups:.3},{ms},{ratio}\n"
        );
    }
    text
}

/// A Markdown table.
fn table(rows: &[Row]) -> String {
    let mut text =
        "| scene | search | refinements | median | 95 % | missed | hidden | off | lookups | frame | to classical |\n\
                    |---|---|---|---|---|---|---|---|---|---|---|\n"
            .to_string();
    for row in rows {
        let optional = |value: Option<f64>, unit: &str| value.map_or("-".into(), |value| format!("{value:.2}{unit}"));
        text += &format!(
            "| {} | {} | {} | {:.3}° | {:.2}° | {:.2} % | {:.2} % | {:.2} % | {:.1} | {} | {} |\n",
            row.scene,
            row.solver,
            row.refinements,
            row.median,
            row.p95,
            100.0 * row.misses,
            100.0 * row.hidden,
            100.0 * row.off,
            row.lookups,
            optional(row.frame_ms, " ms"),
            optional(row.ratio, ""),
        );
    }
    text
}
