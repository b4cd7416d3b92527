//! How long a draft of the probes of a scene takes while what they serve is dragged, drawn by the device and traced by the
//! processor, for some numbers of texels along the edge of a face. The window leaves a core to itself: on one of two cores,
//!
//!     RAYON_NUM_THREADS=1 cargo run --locked --workspace --example draft_times -- workbench room

use std::sync::Arc;
use std::time::Instant;

use burnish_core::job::Handle;
use burnish_core::lighting::impostor;
use burnish_core::lighting::probe;
use burnish_core::param::Settings;
use burnish_core::reference::{Options, World};
use burnish_core::scene::{Scene, gallery};
use burnish_render::{DeviceRaster, Gpu, Passes};

/// Moves of which the median counts.
const MOVES: u32 = 9;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let names = if given.is_empty() { vec!["workbench".to_string(), "room".to_string()] } else { given };
    let passes = Arc::new(Passes::new(&Gpu::new()?));
    let settings = Settings::new(impostor::PARAMS);
    for name in names {
        let mut scene = gallery::open(&name)?;
        if scene.environment.is_none() {
            scene.environment = Some(Arc::new(gallery::studio()));
        }
        for face in [32, 64, 128] {
            for drawn in [false, true] {
                let raster = drawn.then(|| Arc::new(DeviceRaster::new(&passes)) as Arc<dyn probe::Raster>);
                let world = World::new(&Arc::new(scene.clone()), Options::new(&settings)).with_raster(raster);
                let mut times = drafts(&world, &scene, &settings, face)?;
                let first = times.remove(0);
                times.sort_by(f64::total_cmp);
                let by = if drawn { "device" } else { "processor" };
                println!(
                    "{name:12} {face:4} texels, {by:9}: median {:7.1} ms, first {first:7.1} ms",
                    times[times.len() / 2]
                );
            }
        }
    }
    Ok(())
}

/// Milliseconds of drafts, the first before anything was moved.
fn drafts(
    world: &World,
    scene: &Scene,
    settings: &Settings,
    face: u32,
) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let (mut world, mut scene) = (world.clone(), scene.clone());
    let mut times = Vec::new();
    for _ in 0..=MOVES {
        let start = Instant::now();
        world = world.updated(&Arc::new(scene.clone()), *world.options());
        let mut sites = impostor::sites(&scene, settings).coarse();
        sites.list.iter_mut().for_each(|site| site.face = face);
        probe::prepare(&world, &sites, &Handle::default())?;
        times.push(1e3 * start.elapsed().as_secs_f64());
        for served in scene.served() {
            scene.instances[served].world_from_local.translation.x += 0.01;
        }
    }
    Ok(times)
}
