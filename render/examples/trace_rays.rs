//! Rays per second on the graphics adapter and on the processor.
//!
//! `cargo run --release -p burnish-render --example trace_rays -- [gallery scene or model file]...`; without any it
//! takes every scene of the gallery.

use std::path::Path;
use std::time::Instant;

use burnish_core::import::{ImportOptions, load_scene};
use burnish_core::math::sampling::Random;
use burnish_core::scene::{Scene, gallery};
use burnish_core::trace::{Accel, Ray};
use burnish_render::trace::{TracePass, TraceTree};
use burnish_render::{Gpu, RenderError};

type Failure = Box<dyn std::error::Error>;

/// Rays of a scene, traced several times of which the fastest counts.
const RAYS: usize = 1 << 18;
const ROUNDS: usize = 3;

fn main() -> Result<(), Failure> {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    if names.is_empty() {
        names = gallery::list().iter().map(|scene| scene.name.to_string()).collect();
    }
    let gpu = Gpu::new()?;
    let pass = TracePass::new(&gpu);
    println!("{}, {} threads of the processor", gpu.report().name, std::thread::available_parallelism()?);
    println!(
        "{:<24}{:>10}{:>8} | closest: {:>9} {:>9} {:>6} | any: {:>9} {:>9} {:>6}",
        "million rays per second", "triangles", "MB", "device", "processor", "ratio", "device", "processor", "ratio"
    );
    for name in &names {
        let scene = open(name)?;
        let accel = Accel::new(&scene);
        let tree = TraceTree::new(&gpu, &accel)?;
        let rays = rays(&scene);
        // Once before: it compiles.
        pass.closest(&tree, &rays[..64])?;
        pass.occluded(&tree, &rays[..64])?;
        let closest =
            [speed(|| pass.closest(&tree, &rays))?, speed(|| Ok::<_, RenderError>(accel.closest_of_each(&rays)))?];
        let any =
            [speed(|| pass.occluded(&tree, &rays))?, speed(|| Ok::<_, RenderError>(accel.occluded_of_each(&rays)))?];
        let columns = |[gpu, cpu]: [f64; 2]| format!("{gpu:>9.3} {cpu:>9.3} {:>6.2}", gpu / cpu);
        let (triangles, megabytes) = (scene.triangle_count(), tree.bytes() as f64 * 1e-6);
        println!("{name:<24}{triangles:>10}{megabytes:>8.1} |          {} |      {}", columns(closest), columns(any));
    }
    Ok(())
}

fn open(name: &str) -> Result<Scene, Failure> {
    if Path::new(name).exists() {
        return Ok(load_scene(Path::new(name), &ImportOptions::default())?.scene);
    }
    Ok(gallery::open(name)?)
}

/// From everywhere in the box around the scene in all directions.
fn rays(scene: &Scene) -> Vec<Ray> {
    let mut random = Random::new(5);
    let bounds = scene.bounds();
    let mut direction = || loop {
        let v = 2.0 * random.point3() - 1.0;
        if (1e-4..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    };
    let directions: Vec<_> = (0..RAYS).map(|_| direction()).collect();
    let at = |direction| Ray {
        origin: bounds.min + (bounds.max - bounds.min) * random.point3(),
        direction,
        t_max: f32::INFINITY,
    };
    directions.into_iter().map(at).collect()
}

/// Million rays per second.
fn speed<T>(trace: impl Fn() -> Result<T, RenderError>) -> Result<f64, RenderError> {
    let mut fastest = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        trace()?;
        fastest = fastest.min(start.elapsed().as_secs_f64());
    }
    Ok(1e-6 * RAYS as f64 / fastest)
}
