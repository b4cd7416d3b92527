//! Times of the viewport on this machine: to the first picture, while the camera orbits, after an edit, until settled.
//!
//! `cargo run --release -p burnish-render --example frame_times -- [MODEL] [WIDTH HEIGHT]`; without a model it opens
//! the default workbench.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use burnish_core::color::tone::ToneMap;
use burnish_core::import::{ImportOptions, load_scene};
use burnish_core::lighting::classical;
use burnish_core::param::Settings;
use burnish_core::scene::{Camera, Scene, gallery};
use burnish_render::{Drawn, Frame, Gpu, Viewport};
use glam::{Affine3A, UVec2};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let model = arguments.first().filter(|a| a.as_str() != "-");
    let number = |i: usize| arguments.get(i).map(|text| text.parse::<u32>()).transpose();
    let size = UVec2::new(number(1)?.unwrap_or(800), number(2)?.unwrap_or(600));

    let start = Instant::now();
    let mut since = start;
    let mut lap = |what: &str| {
        println!("{what:<24}{:8.1} ms", since.elapsed().as_secs_f64() * 1e3);
        since = Instant::now();
    };
    let gpu = Gpu::new()?;
    lap("device");
    let mut viewport = Viewport::new(&gpu);
    lap("pipelines");
    let scene = Arc::new(open(model)?);
    lap("scene");
    viewport.set_scene(&scene)?;
    gpu.wait()?;
    lap("upload");
    let aspect = size.x as f32 / size.y as f32;
    let camera = match (model, scene.cameras.first()) {
        (None, Some(camera)) => camera.clone(),
        _ => Camera::frame(scene.bounds(), aspect),
    };
    let settings = Settings::new(classical::PARAMS);
    let mut frame = Frame {
        size,
        camera,
        settings,
        lighting: Default::default(),
        tone: ToneMap::Neutral,
        exposure_ev: 0.0,
        mode: Default::default(),
        contribution: Default::default(),
        moving: true,
    };
    report("first picture", &viewport.draw(&frame)?);
    println!("{:<24}{:8.1} ms\n", "all that", start.elapsed().as_secs_f64() * 1e3);
    println!("{} triangles on {}", scene.triangle_count(), gpu.report().name);

    let center = Affine3A::from_translation(scene.bounds().center());
    for step in 0..24 {
        // To and fro: a room is open to the front only.
        let angle = if step % 12 < 6 { 0.05 } else { -0.05 };
        let turn = center * Affine3A::from_rotation_y(angle) * center.inverse();
        frame.camera.world_from_view = turn * frame.camera.world_from_view;
        let drawn = viewport.draw(&frame)?;
        if step % 3 == 2 {
            report("moving", &drawn);
        }
    }
    frame.moving = false;
    let mut edited = Scene::clone(&scene);
    if let Some(material) = edited.materials.first_mut() {
        material.roughness = 0.5 * material.roughness + 0.1;
    }
    let start = Instant::now();
    viewport.set_scene(&Arc::new(edited))?;
    println!("{:<24}{:8.1} ms", "edit", start.elapsed().as_secs_f64() * 1e3);
    let (start, mut longest, mut calls) = (Instant::now(), 0.0_f64, 0);
    loop {
        let drawn = viewport.draw(&frame)?;
        longest = longest.max(drawn.milliseconds);
        calls += 1;
        if calls <= 6 || drawn.settled {
            report("still", &drawn);
        }
        if drawn.settled {
            break;
        }
    }
    let total = start.elapsed().as_secs_f64();
    println!("settled after {calls} calls in {total:.1} s, the longest {longest:.1} ms");
    Ok(())
}

fn open(model: Option<&String>) -> Result<Scene, Failure> {
    let mut scene = match model {
        Some(path) => load_scene(Path::new(path), &ImportOptions::default())?.scene,
        None => gallery::open("workbench")?,
    };
    scene.environment.get_or_insert_with(|| Arc::new(gallery::studio()));
    Ok(scene)
}

fn report(what: &str, drawn: &Drawn) {
    let Drawn { size, frames, milliseconds, .. } = drawn;
    println!("{what:<24}{milliseconds:8.1} ms  {:4}x{:<4} {frames} frames", size.x, size.y);
}
