//! `burnish map-times`: what the parts of a frame by `radiance-map` cost, and what other ways of looking up would.

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::job::Handle;
use burnish_core::lighting::radiance_map::{self, FrameTimes, Part, RadianceMap, frame_times, in_floats};
use burnish_core::lighting::{Method, MethodId, Prepared};
use burnish_core::measure::median;
use burnish_core::param::Settings;
use burnish_core::reference::{Options, View as Eyes, World};
use burnish_core::scene::{Camera, Scene};
use burnish_render::{Gpu, Lighting, Passes, Renderer, View};
use glam::UVec2;
use serde::Serialize;

use super::write_json;
use crate::failure::{Exit, Failure, printable};
use crate::{source, value};

/// The method that is measured.
const METHOD: MethodId = MethodId(radiance_map::ID);

#[derive(clap::Args)]
pub struct Args {
    /// Model file (.gltf, .glb, .obj), document (.burnish) or gallery:NAME[?key=value&...] [default: gallery:workbench]
    scene: Option<OsString>,
    /// Bake to look up [default: one is made]
    #[arg(long, value_name = "FILE")]
    prepared: Option<PathBuf>,
    /// Setting of the method, such as points=30000; repeatable
    #[arg(long, value_name = "KEY=VALUE", value_parser = value::assignment)]
    set: Vec<(String, String)>,
    /// Pixels of a frame
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = value::size)]
    size: UVec2,
    /// Frames of each kind of which the median counts
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
    /// Leave the graphics device alone
    #[arg(long)]
    processor: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Frames on one device.
#[derive(Clone, Debug, Serialize)]
struct Row {
    device: String,
    /// Milliseconds of the whole.
    frame_ms: f64,
    /// Shares of it.
    query: f64,
    filter: f64,
    shading: f64,
    rest: f64,
    /// Times that the query takes if the eight nearest places are searched in the place of a stored set.
    searched_ratio: f64,
    /// Times that the filter takes by a box.
    box_ratio: f64,
    /// Times that it takes of light in floats.
    floats_ratio: f64,
}

impl Row {
    fn new(device: String, times: &FrameTimes) -> Row {
        let share = |secs: f64| secs / times.frame;
        Row {
            device,
            frame_ms: 1e3 * times.frame,
            query: share(times.query),
            filter: share(times.filter),
            shading: share(times.shading),
            rest: share(times.rest()),
            searched_ratio: times.searched / times.query,
            box_ratio: times.boxed / times.filter,
            floats_ratio: times.floats / times.filter,
        }
    }
}

pub fn run(args: Args, out: &mut dyn Write, err: &mut dyn Write) -> Result<Exit, Failure> {
    let mut settings = Settings::new(radiance_map::PARAMS);
    super::render::assign(&mut settings, &args.set)?;
    let name = args.scene.clone().unwrap_or_else(|| source::DEFAULT_SCENE.into());
    let mut opened = source::open(&name)?.complete()?;
    opened.light(None);
    let (camera, scene) = (opened.camera(args.size), Arc::new(opened.scene));
    let world = World::new(&scene, Options::new(&settings));
    let prepared = match &args.prepared {
        Some(path) => super::render::prepared_in(path, (&RadianceMap, &settings), &scene, err)?,
        None => RadianceMap.prepare(&world, &settings, &Handle::default()).map_err(Failure::resources)?,
    };
    let unfit = || Failure::resources("the bake holds no radiance map; bake it anew");
    let view = Eyes { camera: camera.clone(), size: args.size, seed: 0 };
    let rounds = args.rounds as usize;
    let times = frame_times(&world, &prepared, &settings, &view, rounds).ok_or_else(unfit)?;
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut rows = vec![Row::new(format!("processor, {threads} threads"), &times)];
    if !args.processor {
        let gpu = Gpu::new().map_err(Failure::resources)?;
        let view = View { size: args.size, camera: Camera::clone(&camera), settings, jitter_frames: 1 };
        let times = on_device(&Arc::new(Passes::new(&gpu)), &scene, prepared, &view, rounds)?;
        rows.push(Row::new(gpu.report().name.clone(), &times));
    }
    if args.json {
        write_json(out, &rows)?
    } else {
        write!(out, "{}", table(&rows))?
    }
    Ok(Exit::Ok)
}

/// As [`frame_times`] on the graphics device.
fn on_device(
    passes: &Arc<Passes>,
    scene: &Arc<Scene>,
    prepared: Prepared,
    view: &View,
    rounds: usize,
) -> Result<FrameTimes, Failure> {
    let wide = in_floats(&prepared).ok_or_else(|| Failure::resources("the bake lacks a part; bake it anew"))?;
    let lit = |prepared: Prepared| -> Result<Renderer, Failure> {
        let mut renderer = Renderer::with_passes(passes, scene).map_err(Failure::resources)?;
        renderer.light_by(&Lighting::new(METHOD, Some(Arc::new(prepared)))).map_err(Failure::resources)?;
        // Shaders are compiled.
        renderer.time_frame(view).map_err(Failure::resources)?;
        Ok(renderer)
    };
    let (mut halves, mut floats) = (lit(prepared)?, lit(wide)?);
    let mut boxed = view.clone();
    boxed.settings.set("filter", "box").map_err(|e| Failure::usage(e.to_string()))?;
    let mut times = [(); 7].map(|()| Vec::new());
    for _ in 0..rounds {
        let parts = [Part::Nothing, Part::Query, Part::Search, Part::Filter, Part::All];
        let mut of_round = parts.map(|part| halves.time_part(view, part)).to_vec();
        of_round.push(halves.time_part(&boxed, Part::Filter));
        of_round.push(floats.time_part(view, Part::Filter));
        for (times, secs) in times.iter_mut().zip(of_round) {
            times.push(secs.map_err(Failure::resources)?);
        }
    }
    let [nothing, query, search, filter, frame, boxed, floats] = times.map(|mut times| median(&mut times));
    Ok(FrameTimes {
        frame,
        query: query - nothing,
        filter: filter - query,
        shading: frame - filter,
        searched: search - nothing,
        boxed: boxed - query,
        floats: floats - query,
    })
}

/// A Markdown table.
fn table(rows: &[Row]) -> String {
    let mut text = "| device | frame | query | filter | shading | rest | 8 searched / stored set | box / hat | floats / halves |\n\
                    |---|---|---|---|---|---|---|---|---|\n"
        .to_string();
    for row in rows {
        let [query, filter, shading, rest] = [row.query, row.filter, row.shading, row.rest].map(|share| 100.0 * share);
        text += &format!(
            "| {} | {:.0} ms | {query:.1} % | {filter:.1} % | {shading:.1} % | {rest:.1} % | {:.2} | {:.2} | {:.2} |\n",
            printable(&row.device),
            row.frame_ms,
            row.searched_ratio,
            row.box_ratio,
            row.floats_ratio,
        );
    }
    text
}
