//! What paths see and where they end.

use glam::Vec3;

use super::*;
use crate::material::AlphaMode;
use crate::scene::gallery::shape;
use crate::scene::{Light, LightKind};

const FRONT: Vec3 = Vec3::new(0.0, 0.0, 3.0);

/// A wall in the plane z = 0 that fills the picture, and what a picture of it shows in the mean.
fn wall(material: Material, options: Options, eye: Vec3, samples: u32) -> Vec3 {
    let mut scene = scene([(shape::plane(40.0, 40.0), material)]);
    scene.environment = even_sky(Vec3::ONE);
    mean(&film(scene, options, &view(eye, Vec3::ZERO, 8, 1), samples)).as_vec3()
}

#[test]
fn what_is_half_there_lets_half_of_the_light_through() {
    let glowing = Material { emission: Vec3::splat(3.0), ..matte(Vec3::ZERO) };
    let pane = Material { opacity: 0.25, alpha_mode: AlphaMode::Blend, ..glowing.clone() };
    let got = wall(pane.clone(), Options::default(), FRONT, 1024);
    assert!((got.x - (0.25 * 3.0 + 0.75)).abs() < 0.01, "{got}");
    let masked = |opacity| Material { opacity, alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, ..glowing.clone() };
    assert_eq!(wall(masked(0.4), Options::default(), FRONT, 4).x, 1.0);
    assert_eq!(wall(masked(0.6), Options::default(), FRONT, 4).x, 3.0);
    let opaque = Material { opacity: 0.1, ..glowing };
    assert_eq!(wall(opaque, Options::default(), FRONT, 4).x, 3.0);
}

#[test]
fn shadows_of_half_transparent_panes_are_half_dark() {
    let pane = Material { opacity: 0.25, alpha_mode: AlphaMode::Blend, ..matte(Vec3::ZERO) };
    let lifted = Affine3A::from_translation(Vec3::new(0.0, 0.0, 1.0));
    let mut lit = scene([
        (shape::plane(1.0, 1.0), matte(Vec3::ONE)),
        (shape::transformed(shape::plane(9.0, 9.0), &lifted), pane),
    ]);
    lit.lights.push(Light {
        name: "sun".into(),
        position: Vec3::ZERO,
        direction: Vec3::NEG_Z,
        intensity: Vec3::splat(std::f32::consts::PI),
        range: f32::INFINITY,
        kind: LightKind::PARALLEL,
        ..Light::default()
    });
    let mut view = view(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 8, 1);
    view.camera = Camera::look_at("below the pane", Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 0.5);
    let got = mean(&film(lit, Options { bounces: 1, ..Options::default() }, &view, 1024));
    assert!((got.x - 0.75).abs() < 0.01, "{got}");
}

#[test]
fn chances_of_the_rays_of_a_path_do_not_hang_together() {
    let pane = Material { opacity: 0.25, alpha_mode: AlphaMode::Blend, ..matte(Vec3::ZERO) };
    let lifted = Affine3A::from_translation(Vec3::Z);
    let mut lit = scene([
        (shape::plane(1.0, 1.0), matte(Vec3::ONE)),
        (shape::transformed(shape::plane(9.0, 9.0), &lifted), pane),
    ]);
    // The eye looks through one triangle of the pane, the sun shines through the other.
    let toward_sun = Vec3::new(-0.8, -0.1, 1.0).normalize();
    lit.lights.push(Light {
        name: "sun".into(),
        position: Vec3::ZERO,
        direction: -toward_sun,
        intensity: Vec3::splat(std::f32::consts::PI),
        range: f32::INFINITY,
        kind: LightKind::PARALLEL,
        ..Light::default()
    });
    let eye = Vec3::new(2.4, 0.3, 3.0);
    let mut view = view(eye, Vec3::ZERO, 8, 1);
    view.camera = Camera::look_at("above the pane", eye, Vec3::ZERO, 0.1);
    let got = mean(&film(lit, Options { bounces: 1, ..Options::default() }, &view, 1024));
    let expected = f64::from(0.75 * 0.75 * toward_sun.z);
    assert!((got.x - expected).abs() < 0.01, "{got} {expected}");
}

#[test]
fn backs_of_one_sided_surfaces_are_clear_to_the_eye_and_dark_to_light() {
    let one_sided = Material { double_sided: false, emission: Vec3::splat(3.0), ..matte(Vec3::ZERO) };
    assert_eq!(wall(one_sided.clone(), Options::default(), FRONT, 4).x, 3.0);
    assert_eq!(wall(one_sided.clone(), Options::default(), -FRONT, 4).x, 1.0);
    // A mirror behind the eye shows the back of the wall.
    let behind = Affine3A::from_translation(Vec3::new(0.0, 0.0, -5.0));
    let mirror = (shape::transformed(shape::plane(90.0, 90.0), &behind), even_metal(Vec3::ONE, 0.0));
    let mut scene = scene([(shape::plane(90.0, 90.0), one_sided), mirror]);
    scene.environment = even_sky(Vec3::ONE);
    let eye = Vec3::new(0.0, 0.0, -2.0);
    let mut view = view(eye, eye - Vec3::Z, 4, 1);
    view.camera = Camera::look_at("toward the mirror", eye, eye - Vec3::Z, 0.1);
    assert_eq!(mean(&film(scene, Options::default(), &view, 4)).x, 0.0);
}

#[test]
fn the_number_of_surfaces_on_a_path_is_limited() {
    let glowing = Material { emission: Vec3::splat(3.0), ..matte(Vec3::splat(0.5)) };
    let bounces = |bounces| wall(glowing.clone(), Options { bounces, ..Options::default() }, FRONT, 64).x;
    assert_eq!(bounces(0), 3.0);
    assert!((bounces(1) - 3.5).abs() < 1e-3, "{}", bounces(1));
    // In a room each bounce adds a power of the albedo.
    for limit in [0, 1, 2, 5] {
        let room = shape::block(Vec3::splat(2.0), 0.0, 1);
        let scene = scene([(room, Material { emission: Vec3::ONE, ..matte(Vec3::splat(0.5)) })]);
        let options = Options { bounces: limit, ..Options::default() };
        let got = mean(&film(scene, options, &view(Vec3::ZERO, Vec3::ONE, 8, 1), 256)).x;
        let want: f64 = (0..=limit).map(|i| 0.5_f64.powi(i as i32)).sum();
        assert!((got - want).abs() < 5e-3 * want, "{limit}: {got} instead of {want}");
    }
}

#[test]
fn what_the_clamp_takes_away_is_what_is_missing() {
    let build = || {
        let room = shape::block(Vec3::splat(2.0), 0.0, 1);
        let small = Affine3A::from_translation(Vec3::new(0.0, 0.9, 0.0));
        let bulb = shape::transformed(shape::sphere(0.05, 12), &small);
        scene([(room, matte(Vec3::splat(0.7))), (bulb, Material { emission: Vec3::splat(500.0), ..matte(Vec3::ZERO) })])
    };
    let view = view(Vec3::new(0.0, -0.5, 0.8), Vec3::new(0.0, -1.0, -0.5), 12, 1);
    let whole = film(build(), Options::default(), &view, 64);
    let clamped = film(build(), Options { clamp: 2.0, ..Options::default() }, &view, 64);
    let taken: f64 = clamped.pixels().iter().map(|p| p.clamped / f64::from(p.count)).sum();
    let missing: f64 = whole.pixels().iter().zip(clamped.pixels()).map(|(a, b)| (a.mean - b.mean).element_sum()).sum();
    assert!(taken > 0.0 && (taken - missing).abs() < 1e-4 * taken, "{taken} {missing}");
    let none: f64 = whole.pixels().iter().map(|p| p.clamped).sum();
    assert_eq!(none, 0.0);
}

#[test]
fn an_edited_world_is_the_same_as_a_new_one() {
    let mut first = scene([
        (shape::sphere(1.0, 32), even_metal(Vec3::splat(0.8), 0.3)),
        (shape::plane(4.0, 4.0), matte(Vec3::ONE)),
    ]);
    first.environment = even_sky(Vec3::ONE);
    let first = Arc::new(first);
    let mut edited = Scene::clone(&first);
    edited.materials[0].roughness = 0.6;
    edited.instances[0].world_from_local = Affine3A::from_translation(Vec3::new(0.3, 0.0, 0.5));
    edited.environment = even_sky(Vec3::new(1.0, 2.0, 3.0));
    let edited = Arc::new(edited);
    let options = Options::default();
    let view = view(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, 8, 1);
    let updated = World::new(&first, options).updated(&edited, options);
    let anew = World::new(&edited, options);
    for i in 0..64 {
        let pixel = UVec2::new(i % 8, i / 8);
        assert_eq!(updated.sample(&view, pixel, 3), anew.sample(&view, pixel, 3));
    }
}

#[test]
fn scenes_without_anything_are_black() {
    let got = film(Scene::default(), Options::default(), &view(FRONT, Vec3::ZERO, 4, 1), 2);
    assert_eq!(mean(&got), DVec3::ZERO);
    assert!(got.pixels().iter().all(|p| p.rejected == 0 && p.hits == 0));
}
