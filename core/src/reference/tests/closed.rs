//! Closed scenes of known radiance: each within 0.5 % for three seeds.

use std::f32::consts::PI;

use glam::{DVec3, Vec3};

use super::*;
use crate::scene::gallery::shape;
use crate::scene::{Light, LightKind};

/// Segments of spheres: flat facets take 0.02 % off the area of a sphere.
const SEGMENTS: usize = 128;

/// Enough bounces that what is left out is below 1e-5 at the albedos here.
fn many_bounces() -> Options {
    Options { bounces: 100, ..Options::default() }
}

/// Pictures of 16 x 16 pixels with so many samples that their noise in the mean is a quarter of the bound or less.
fn assert_seen(name: &str, build: impl Fn() -> Scene, view_of: impl Fn(u32) -> View, samples: u32, want: Vec3) {
    for seed in 1..=3 {
        let film = film(build(), many_bounces(), &view_of(seed), samples);
        let got = mean(&film);
        let off = (got / want.as_dvec3() - DVec3::ONE).abs().max_element();
        println!(
            "{name}, seed {seed}: {got:.5} for {want}, off {:.3} %, noise {:.2} %",
            100.0 * off,
            100.0 * film.error()
        );
        assert!(off < 5e-3, "{name}, seed {seed}: {got} instead of {want}");
        assert_eq!(film.rejected(), 0);
    }
}

/// Looks from `eye` at `target`.
fn looking(eye: Vec3, target: Vec3) -> impl Fn(u32) -> View {
    move |seed| view(eye, target, 16, seed)
}

fn lamp(position: Vec3, intensity: f32, kind: LightKind) -> Light {
    let direction = Vec3::new(0.0, -0.8, -0.6);
    Light { name: "lamp".into(), position, direction, intensity: Vec3::splat(intensity), kind, ..Light::default() }
}

/// All walls glow alike and are grey: L = e / (1 - a). Bright light outside must not come in.
#[test]
fn a_glowing_grey_room() {
    let (e, a) = (Vec3::new(1.0, 0.5, 2.0), Vec3::new(0.5, 0.7, 0.2));
    let build = || {
        let room = shape::block(Vec3::new(2.0, 3.0, 4.0), 0.0, 1);
        let mut scene = scene([(room, Material { emission: e, ..matte(a) })]);
        scene.environment = even_sky(Vec3::splat(1e5));
        scene
    };
    let seen = looking(Vec3::new(0.2, 0.3, 0.4), Vec3::new(0.5, -0.2, -0.6));
    assert_seen("glowing room", build, seen, 256, e / (Vec3::ONE - a));
}

/// A lamp I in the middle of a sphere: E = I / r^2 everywhere, L = a E / (pi (1 - a)).
#[test]
fn a_lamp_in_the_middle_of_a_sphere() {
    let (r, a) = (2.0, Vec3::new(0.5, 0.8, 0.1));
    let build = || {
        let mut scene = scene([(shape::sphere(r, SEGMENTS), matte(a))]);
        scene.lights.push(lamp(Vec3::ZERO, 3.0, LightKind::Point));
        scene
    };
    let irradiance = 3.0 / (r * r);
    let seen = looking(Vec3::new(0.5, 0.1, 0.3), Vec3::new(0.8, -0.4, -0.7));
    assert_seen("lamp in a sphere", build, seen, 256, a * irradiance / (PI * (Vec3::ONE - a)));
}

/// A mirror all around that glows: L = e / (1 - r).
#[test]
fn a_glowing_mirror_sphere() {
    let (e, r) = (Vec3::new(1.0, 2.0, 0.5), Vec3::new(0.8, 0.5, 0.7));
    let build = || {
        let material = Material { emission: e, ..even_metal(r, 0.0) };
        scene([(shape::sphere(1.0, SEGMENTS), material)])
    };
    let seen = looking(Vec3::new(0.2, 0.0, 0.1), Vec3::new(0.5, -0.5, -0.9));
    assert_seen("glowing mirror", build, seen, 1024, e / (Vec3::ONE - r));
}

/// The upper part of a sphere glows. From every point of a sphere every part of its area shines alike: what comes back
/// from a dark wall is L = a e q / (1 - a), q the share of the area that glows.
#[test]
fn a_sphere_that_glows_in_part() {
    let (e, a) = (Vec3::new(2.0, 1.0, 4.0), Vec3::new(0.6, 0.3, 0.8));
    let q = 0.1;
    let build = || {
        // The cap over which the share of the area, (1 - cos) / 2, is q.
        let limit: f32 = 1.0 - 2.0 * q;
        let arc = |from: f32, to: f32, segments| {
            let half = std::f32::consts::FRAC_PI_2;
            let profile = shape::Profile::new().arc(glam::Vec2::ZERO, 1.0, half - from, half - to, segments);
            shape::revolve("part", &profile, SEGMENTS)
        };
        let angle = limit.acos();
        let cap = arc(0.0, angle, 24);
        let rest = arc(angle, PI, 64);
        scene([(cap, Material { emission: e, ..matte(a) }), (rest, matte(a))])
    };
    let want = a * e * q / (Vec3::ONE - a);
    assert_seen("part of a sphere", build, looking(Vec3::new(0.1, 0.0, 0.2), Vec3::new(0.2, -1.0, 0.0)), 1024, want);
}

/// A spot lamp in the middle of a sphere: outside of its cone the walls show L = a^2 P / (pi A (1 - a)), P its power.
#[test]
fn a_spot_lamp_in_a_sphere() {
    let a = Vec3::new(0.6, 0.3, 0.5);
    let (inner, outer) = (0.2_f32, 0.5_f32);
    let kind = LightKind::Spot { inner_angle: inner, outer_angle: outer };
    let build = || {
        let mut scene = scene([(shape::sphere(1.5, SEGMENTS), matte(a))]);
        scene.lights.push(lamp(Vec3::ZERO, 5.0, kind));
        scene
    };
    // Full strength inside; between the cones the square of a number that goes linearly with the cosine.
    let power = 5.0 * 2.0 * PI * ((1.0 - inner.cos()) + (inner.cos() - outer.cos()) / 3.0);
    let want = a * a * power / (PI * 4.0 * PI * 1.5 * 1.5 * (Vec3::ONE - a));
    assert_seen("spot in a sphere", build, looking(Vec3::ZERO, Vec3::new(0.0, 0.8, 0.6)), 2048, want);
}

/// A square that glows over a small matte patch: E = L pi F, F the form factor of a parallel rectangle over a point,
/// four times that of a quarter (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3).
#[test]
fn a_panel_over_a_patch() {
    let (half, height) = (0.7_f64, 0.9_f64);
    let quarter = {
        let x = half / height;
        let s = (1.0 + x * x).sqrt();
        x / s * (x / s).atan() / std::f64::consts::PI
    };
    let factor = (4.0 * quarter) as f32;
    let (e, a) = (Vec3::new(3.0, 1.0, 2.0), Vec3::new(0.5, 0.9, 0.2));
    for roughly in [false, true] {
        let build = || {
            // Facing down; the patch is small beside it.
            let down =
                Affine3A::from_translation(Vec3::new(0.0, height as f32, 0.0)) * Affine3A::from_rotation_x(0.5 * PI);
            let up = Affine3A::from_rotation_x(-0.5 * PI);
            let side = 2.0 * half as f32;
            let panel = shape::transformed(shape::plane(side, side), &down);
            let patch = shape::transformed(shape::plane(0.02, 0.02), &up);
            let emission = if roughly { e * 0.5 } else { e };
            let panel = (panel, Material { emission, double_sided: roughly, ..matte(Vec3::ZERO) });
            scene([panel, (patch, matte(a))])
        };
        let want = a * e * factor * if roughly { 0.5 } else { 1.0 };
        let near = |seed| {
            let camera = Camera::look_at("patch", Vec3::new(0.1, 0.2, 0.0), Vec3::ZERO, 0.02);
            View { camera, size: UVec2::splat(16), seed }
        };
        assert_seen("panel", build, near, 256, want);
    }
}
