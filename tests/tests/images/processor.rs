//! The classical method on the device against its twin on the processor, whole pictures of them.

use std::sync::Arc;

use burnish_core::job::Handle;
use burnish_core::lighting::{Drawing, Layers, Method, Store, classical};
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::reference::{self, Control, Film, Options, Pass, World};
use burnish_core::scene::{Environment, Scene, gallery};
use burnish_render::{Gpu, Renderer, View};
use burnish_tests::{Need, trial};
use glam::{UVec2, Vec3, Vec4};
use libtest_mimic::Trial;

const SIZE: UVec2 = UVec2::new(128, 72);
/// Of both pictures; points in a pixel differ, so edges differ by chance.
const SAMPLES: u32 = 32;
/// Highlights of lamps count as this: they are smaller than a pixel, and so found by chance.
const BRIGHTEST: f32 = 2.0;

pub fn trials() -> Vec<Trial> {
    let scenes = ["workbench", "ball?material=Cu&roughness=0.4", "bowls"];
    let settings = ["0", "16"];
    let each = scenes.iter().flat_map(|scene| settings.map(|samples| (*scene, samples)));
    each.map(|(scene, samples)| {
        let name = format!("classical is the same on device and processor: {scene}, samples {samples}");
        trial(name.leak(), &[Need::Gpu], move || same(scene, samples))
    })
    .collect()
}

/// Means within 0.4 %, texels within 1.5 % in the mean: shadow maps, mip maps and the texture units' eight bits between
/// two texels.
fn same(name: &str, samples: &str) {
    same_scene(gallery::open(name).expect("in the gallery"), samples);
}

/// Means and texels of a scene under an uneven sky; `samples` is the setting.
pub fn same_scene(mut scene: Scene, samples: &str) {
    scene.environment = Some(Arc::new(sky()));
    assert_same(scene, samples);
}

/// A scene lit by `classical` with so many samples is the same on both.
pub fn assert_same(scene: Scene, samples: &str) {
    let mut settings = Settings::new(classical::PARAMS);
    settings.set("samples", samples).expect("a setting");
    let scene = Arc::new(scene);
    let [device, processor] = [on_device(&scene, &settings), on_processor(&scene, &settings)];
    let texels = || device.texels.iter().zip(&processor.texels).map(|(a, b)| (clipped(a), clipped(b)));
    let count = device.texels.len() as f32;
    let [a, b] = [texels().map(|t| t.0).sum::<Vec3>() / count, texels().map(|t| t.1).sum::<Vec3>() / count];
    let ratio = b / a;
    assert!((ratio - 1.0).abs().max_element() < 0.004, "means {a} and {b}, ratio {ratio}");
    let apart = texels().map(|(a, b)| (a - b).abs().element_sum()).sum::<f32>() / (count * a.element_sum());
    assert!(apart < 0.015, "texels are {apart} of the mean apart");
}

/// Small, uneven, with a lamp of two texels, turned.
pub fn sky() -> Environment {
    let texel = |i: u32| match (i % 128, i / 128) {
        (40..42, 20) => Vec3::splat(300.0),
        (x, y) => Vec3::new(1.0 + (x as f32 / 20.0).sin(), 1.0, y as f32 / 32.0),
    };
    Environment { rotation: 0.7, strength: 0.8, ..Environment::new("sky", 128, 64, (0..128 * 64).map(texel).collect()) }
}

fn clipped(texel: &Vec4) -> Vec3 {
    texel.truncate().min(Vec3::splat(BRIGHTEST))
}

fn on_device(scene: &Arc<Scene>, settings: &Settings) -> Picture {
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    let camera = scene.cameras[0].clone();
    let view = View { size: SIZE, camera, settings: settings.clone(), jitter_frames: SAMPLES };
    let mut renderer = Renderer::new(&gpu, scene).unwrap_or_else(|e| panic!("{e}"));
    renderer.render(&view).unwrap_or_else(|e| panic!("{e}"))
}

fn on_processor(scene: &Arc<Scene>, settings: &Settings) -> Picture {
    let classical: &'static dyn Method = &classical::Classical;
    let layers = Layers::of(classical, settings.clone());
    let world = World::new(scene, Options::new(settings));
    let prepared = layers.prepare(&Store::none(), &world, &Handle::default()).expect("an environment");
    let drawing = Drawing::of_layers(&world, &layers, &prepared).expect("it draws on the processor");
    let view = reference::View { camera: scene.cameras[0].clone(), size: SIZE, seed: 1 };
    let mut film = Film::new(SIZE);
    assert_eq!(drawing.draw(&view, &mut film, SAMPLES, &Control::default()), Pass::Whole);
    assert_eq!(film.rejected(), 0);
    film.picture()
}
