//! Shadows of lamps on the ground of the background, live: against the path tracer, and with lights that are nowhere sound.

use std::sync::Arc;

use burnish_core::scene::{Background, Camera, Environment, Ground, Light, LightKind, Scene};
use burnish_tests::{Need, trial};
use glam::{UVec2, Vec2, Vec3};
use libtest_mimic::Trial;

use crate::area::{apart, floor, live, renderer, traced};

/// Mean |live - traced| over mean traced, of a ground a sixth of its light in shadow: edges by shadow maps, penumbras
/// by few samples, the noise of the tracer.
const CAUGHT: f64 = 0.008;
/// By how much more the same ground without shadows must differ for the case to tell anything.
const TELLING: f64 = 3.0;
const SIZE: UVec2 = UVec2::new(60, 40);

pub fn trials() -> Vec<Trial> {
    let gpu: &[Need] = &[Need::Gpu];
    vec![
        trial("the live ground catches the shadows of lamps as that of the path tracer", gpu, shadows),
        trial("a ground with lights below, on and without anything leaves numbers", gpu, numbers),
    ]
}

fn even(radiance: f32) -> Arc<Environment> {
    Arc::new(Environment::new("even", 8, 4, vec![Vec3::splat(radiance); 32]))
}

/// A black bar, 0.5 by 0.3 m, 0.3 m over a ground that the eye looks down on past `middle`.
fn scene(sky: f32, lights: Vec<Light>, middle: Vec3) -> Scene {
    let mut scene = floor(LightKind::Point);
    // The bar stays, the floor gives way to the ground.
    scene.instances.remove(0);
    scene.materials[0].base_color = Vec3::ZERO;
    scene.environment = Some(even(sky));
    let ground = Ground { middle: Vec3::ZERO, height: 1.6, radius: 20.0, shadows: true };
    scene.background = Background { map: Some(even(0.5)), ground: Some(ground) };
    scene.lights = lights;
    scene.cameras[0] = Camera::look_at("main", middle + Vec3::new(0.0, 1.6, 1.6), middle, 0.45);
    scene
}

/// The share of the ground's light that is missing, live and traced, and their difference.
fn shadows() {
    let lamp = |kind| Light {
        kind,
        position: Vec3::new(0.1, 1.0, 0.0),
        direction: Vec3::NEG_Y,
        intensity: Vec3::new(3.0, 2.0, 1.0),
        ..Light::default()
    };
    let sun = |angular_radius, elevation: f32| {
        let (sin, cos) = elevation.to_radians().sin_cos();
        let direction = Vec3::new(cos, -sin, 0.0);
        Light { direction, kind: LightKind::Directional { angular_radius }, ..lamp(LightKind::Point) }
    };
    let spot = LightKind::Spot { inner_angle: 0.4, outer_angle: 0.6 };
    let rectangle = |width| LightKind::Rectangle { across: Vec3::X, size: Vec2::new(width, 0.5 * width) };
    // Under a sun 12 degrees high the shadow lies beyond the scene's own bounds.
    let away = Vec3::new(0.3 / 12f32.to_radians().tan(), 0.0, 0.0);
    // Its light on the ground, which an even sky gives once more.
    let as_much = 2.0 * 12f32.to_radians().sin() / std::f32::consts::PI;
    let cases = [
        ("point", 0.0, vec![lamp(LightKind::Point)], Vec3::ZERO),
        ("spot", 0.0, vec![lamp(spot)], Vec3::ZERO),
        ("sun, parallel", 0.0, vec![sun(0.0, 60.0)], Vec3::ZERO),
        ("sun, 6 degrees", 0.0, vec![sun(0.05, 60.0)], Vec3::ZERO),
        ("low sun, parallel", 0.0, vec![sun(0.0, 12.0)], away),
        ("low sun, 3 degrees", 0.0, vec![sun(0.025, 12.0)], away),
        ("low sun under a sky", as_much, vec![sun(0.0, 12.0)], away),
        ("rectangle 0.3 m", 0.0, vec![lamp(rectangle(0.3))], Vec3::ZERO),
        ("sphere 0.15 m", 0.0, vec![lamp(LightKind::Sphere { radius: 0.15 })], Vec3::ZERO),
        ("two", 0.0, vec![lamp(LightKind::Point), sun(0.05, 60.0)], Vec3::ZERO),
    ];
    let mut device = renderer(&floor(LightKind::Point));
    let (mut table, mut worst) = (String::new(), 0.0_f64);
    for (name, sky, lights, middle) in cases {
        let scene = scene(sky, lights, middle);
        let mut open = scene.clone();
        open.lights.iter_mut().for_each(|light| light.shadows = false);
        let expected = traced(&scene, SIZE, 512);
        let error = apart(&live(&mut device, &scene, SIZE, 16), &expected);
        let shadow = apart(&live(&mut device, &open, SIZE, 16), &expected);
        table += &format!("{name}: {:.2} %, without shadows {:.1} %\n", 100.0 * error, 100.0 * shadow);
        worst = worst.max(error);
        assert!(shadow > TELLING * CAUGHT, "there is too little shadow\n{table}");
    }
    println!("{table}");
    assert!(worst <= CAUGHT, "mean error of the ground over {CAUGHT}\n{table}");
}

fn numbers() {
    let one = Vec3::ONE;
    let rectangle = |direction: Vec3| {
        let across = direction.any_orthonormal_vector();
        (LightKind::Rectangle { across, size: Vec2::splat(0.4) }, direction)
    };
    let kinds = [
        (LightKind::Point, Vec3::Y),
        (LightKind::Spot { inner_angle: 0.0, outer_angle: 1.5 }, Vec3::Y),
        (LightKind::Directional { angular_radius: 0.0 }, Vec3::Y),
        (LightKind::Directional { angular_radius: 1.5 }, Vec3::X),
        (LightKind::Sphere { radius: 0.3 }, Vec3::Y),
        (LightKind::Sphere { radius: 0.0 }, Vec3::Y),
        rectangle(Vec3::Y),
        rectangle(Vec3::X),
        rectangle(Vec3::NEG_Y),
    ];
    let mut device = renderer(&floor(LightKind::Point));
    for level in [-1.0, 0.0, 1e-5] {
        let position = Vec3::Y * level;
        let light = |(kind, direction)| Light { kind, direction, position, intensity: one, ..Light::default() };
        let scene = scene(0.0, kinds.map(light).to_vec(), Vec3::ZERO);
        let picture = live(&mut device, &scene, UVec2::splat(32), 2);
        let sound = picture.texels.iter().all(|texel| texel.is_finite() && texel.min_element() >= 0.0);
        assert!(sound, "no numbers with lights at {level} m");
    }
    // In the dark the ground is what its picture shows.
    let picture = live(&mut device, &scene(0.0, Vec::new(), Vec3::ZERO), UVec2::splat(32), 1);
    let brightest = picture.texels.iter().map(|texel| texel.x).fold(0.0, f32::max);
    assert!((brightest - 0.5).abs() < 1e-3, "{brightest}");
}
