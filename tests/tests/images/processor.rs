//! Methods on the device against their twins on the processor, whole pictures of them.

use std::sync::Arc;

use burnish_core::job::Handle;
use burnish_core::lighting::radiance_map::{self, RadianceMap};
use burnish_core::lighting::{Drawing, Layers, Method, Prepared, Store, area_cube, classical, impostor};
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::reference::{self, Control, Film, Options, Pass, World};
use burnish_core::scene::{Environment, Probe, Scene, gallery};
use burnish_render::{Gpu, Lighting, Renderer, View};
use burnish_tests::{Need, trial};
use glam::{UVec2, Vec2, Vec3, Vec4};
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
    let classical = each.map(|(scene, samples)| {
        let name = format!("classical is the same on device and processor: {scene}, samples {samples}");
        trial(name.leak(), &[Need::Gpu], move || same(scene, samples))
    });
    let searches =
        [("secant", "0"), ("secant", "16"), ("box", "0"), ("march", "16"), ("pyramid", "16"), ("classical", "0")];
    let impostor = searches.into_iter().map(|(solver, samples)| {
        let name = format!("impostor is the same on device and processor: {solver}, samples {samples}");
        trial(name.leak(), &[Need::Gpu], move || {
            same_with_probes(&impostor::Impostor, &[("solver", solver), ("samples", samples)])
        })
    });
    let sums = [("all", "4", "on"), ("few", "4", "on"), ("all", "2", "off")];
    let area_cube = sums.into_iter().map(|(sum, texels, correction)| {
        let name =
            format!("area-cube is the same on device and processor: {sum}, {texels} texels, correction {correction}");
        trial(name.leak(), &[Need::Gpu], move || {
            same_with_probes(&area_cube::AreaCube, &[("sum", sum), ("texels", texels), ("correction", correction)])
        })
    });
    let layers =
        trial("impostor is the same on device and processor: through two layers", &[Need::Gpu], same_with_layers);
    let baked = trial("radiance-map is the same on device and processor", &[Need::Gpu], same_baked);
    classical.chain(impostor).chain(area_cube).chain([layers, baked]).collect()
}

/// A rough body in a room, with two probes that fade into each other on it. Of what no probe serves the device has filtered
/// cubes and the processor samples of the environment: only the body is compared.
fn same_with_probes(method: &'static dyn Method, given: &[(&str, &str)]) {
    let mut scene = gallery::open("room?roughness=0.35").expect("in the gallery");
    scene.environment = Some(Arc::new(sky()));
    let at = |x: f32| Probe { position: Some(Vec3::new(0.24 + x, -0.2, -0.22)), ..Probe::default() };
    scene.probes = vec![at(-0.1), at(0.15)];
    let mut settings = Settings::new(method.info().params);
    for (key, value) in [("resolution", "32"), ("probe-paths", "4")].iter().chain(given) {
        settings.set(key, value).expect("a setting");
    }
    assert_same(scene, method, &settings);
}

/// A rough body in a room whose light was baked.
fn same_baked() {
    let scene = gallery::open("room?roughness=0.6").expect("in the gallery");
    let mut settings = Settings::new(radiance_map::PARAMS);
    for (key, value) in [("points", "1000"), ("directions", "32"), ("paths", "2"), ("lobe-samples", "0")] {
        settings.set(key, value).expect("a setting");
    }
    // Each side draws directions of its own in the cells, 16 in each: texels have the noise of both.
    assert_alike(scene, &RadianceMap, &settings, 0.04);
}

/// A body that mirrors what a crate hides from the probe, which stands behind that.
fn same_with_layers() {
    let mut scene = gallery::open("crate?roughness=0.2").expect("in the gallery");
    scene.environment = Some(Arc::new(sky()));
    scene.probes = vec![Probe { position: Some(Vec3::new(0.8, -0.7, -0.4)), ..Probe::default() }];
    let mut settings = Settings::new(impostor::PARAMS);
    for (key, value) in [("resolution", "64"), ("probe-paths", "4"), ("samples", "0"), ("solver", "march")] {
        settings.set(key, value).expect("a setting");
    }
    let [one, two] = ["1", "2"].map(|layers| {
        settings.set("layers", layers).expect("a setting");
        assert_same(scene.clone(), &impostor::Impostor, &settings)
    });
    let sum = |texels: &mut dyn Iterator<Item = Vec3>| texels.map(Vec3::element_sum).sum::<f32>();
    let apart = sum(&mut one.iter().zip(&two).map(|(a, b)| (a - b).abs())) / sum(&mut one.iter().copied());
    println!("the second layer changes {apart} of the light");
    assert!(apart > 0.05, "the second layer changes {apart} of the light: nothing is compared");
}

/// Means within 0.4 %, texels within 1.5 % in the mean: shadow maps, mip maps and the texture units' eight bits between
/// two texels.
fn same(name: &str, samples: &str) {
    same_scene(gallery::open(name).expect("in the gallery"), samples);
}

/// Means and texels of a scene under an uneven sky; `samples` is the setting.
pub fn same_scene(mut scene: Scene, samples: &str) {
    scene.environment = Some(Arc::new(sky()));
    assert_classical_same(scene, samples);
}

/// A scene lit by `classical` with so many samples is the same on both.
pub fn assert_classical_same(scene: Scene, samples: &str) {
    let mut settings = Settings::new(classical::PARAMS);
    settings.set("samples", samples).expect("a setting");
    assert_same(scene, &classical::Classical, &settings);
}

/// A scene lit by a method is the same on both; the processor's texels that were compared.
fn assert_same(scene: Scene, method: &'static dyn Method, settings: &Settings) -> Vec<Vec3> {
    assert_alike(scene, method, settings, 0.015)
}

/// Likewise; texels are no farther apart than a share of the mean.
fn assert_alike(scene: Scene, method: &'static dyn Method, settings: &Settings, most: f32) -> Vec<Vec3> {
    let scene = Arc::new(scene);
    let layers = Layers::of(method, settings.clone());
    let world = World::new(&scene, Options::new(settings));
    let prepared = layers.prepare(&Store::none(), &world, &Handle::default()).expect("what it needs");
    let lighting = Lighting::new(method.info().id, prepared.first().cloned());
    let device = on_device(&scene, settings, &lighting);
    let processor = on_processor(&world, &layers, &prepared);
    let compared = |place: usize| method.info().id.0 == classical::ID || shows_subject(&world, place);
    let pairs = device.texels.iter().zip(&processor.texels).enumerate().filter(|(place, _)| compared(*place));
    let pairs: Vec<(Vec3, Vec3)> = pairs.map(|(_, (a, b))| (clipped(a), clipped(b))).collect();
    let (texels, count) = (|| pairs.iter().copied(), pairs.len() as f32);
    assert!(count > 100.0, "{count} pixels");
    let [a, b] = [texels().map(|t| t.0).sum::<Vec3>() / count, texels().map(|t| t.1).sum::<Vec3>() / count];
    let ratio = b / a;
    assert!((ratio - 1.0).abs().max_element() < 0.004, "means {a} and {b}, ratio {ratio}");
    let apart = texels().map(|(a, b)| (a - b).abs().element_sum()).sum::<f32>() / (count * a.element_sum());
    assert!(apart < most, "texels are {apart} of the mean apart");
    texels().map(|(_, b)| b).collect()
}

/// A pixel, of which the corners lie on the subject.
fn shows_subject(world: &World, place: usize) -> bool {
    let scene = world.scene();
    let pixel = UVec2::new(place as u32 % SIZE.x, place as u32 / SIZE.x).as_vec2();
    [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].into_iter().all(|corner| {
        let ray = scene.cameras[0].ray((pixel + corner) / SIZE.as_vec2(), SIZE.x as f32 / SIZE.y as f32);
        scene.pick(ray).is_some_and(|picked| scene.subject.contains(&picked.instance))
    })
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

fn on_device(scene: &Arc<Scene>, settings: &Settings, lighting: &Lighting) -> Picture {
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    let camera = scene.cameras[0].clone();
    let view = View { size: SIZE, camera, settings: settings.clone(), jitter_frames: SAMPLES };
    let mut renderer = Renderer::new(&gpu, scene).unwrap_or_else(|e| panic!("{e}"));
    renderer.light_by(lighting).unwrap_or_else(|e| panic!("{e}"));
    renderer.render(&view).unwrap_or_else(|e| panic!("{e}"))
}

fn on_processor(world: &World, layers: &Layers, prepared: &[Arc<Prepared>]) -> Picture {
    let drawing = Drawing::of_layers(world, layers, prepared).expect("it draws on the processor");
    let view = reference::View { camera: world.scene().cameras[0].clone(), size: SIZE, seed: 1 };
    let mut film = Film::new(SIZE);
    assert_eq!(drawing.draw(&view, &mut film, SAMPLES, &Control::default()), Pass::Whole);
    assert_eq!(film.rejected(), 0);
    film.picture()
}
