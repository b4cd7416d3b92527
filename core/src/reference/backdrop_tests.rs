use std::sync::Arc;

use glam::{Affine3A, UVec2, Vec4};

use super::*;
use crate::material::Material;
use crate::reference::Options;
use crate::scene::{Background, Environment, Ground, Instance, Light, LightKind, Mesh, Scene};

/// A square plate of half side 1 at height 1 over the middle of a ground.
fn scene(sky: Environment, lights: Vec<Light>) -> Arc<Scene> {
    let corner = |x: f32, z: f32| Vec3::new(x, 1.0, z);
    let mesh = Mesh {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        normals: vec![Vec3::Y; 4],
        tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4],
        indices: vec![0, 2, 1, 0, 3, 2],
        ..Mesh::default()
    };
    let instance =
        Instance { name: "plate".into(), mesh: 0, material: 0, world_from_local: Affine3A::IDENTITY, visible: true };
    let ground = Ground { middle: Vec3::ZERO, height: 3.0, radius: 50.0, shadows: true };
    Arc::new(Scene {
        meshes: vec![mesh.into()],
        instances: vec![instance],
        materials: vec![Material::default()],
        lights,
        environment: Some(Arc::new(sky)),
        background: Background { map: None, ground: Some(ground) },
        ..Scene::default()
    })
}

fn even(radiance: f32) -> Environment {
    Environment::new("even", 16, 8, vec![Vec3::splat(radiance); 128])
}

fn sun(intensity: f32, direction: Vec3) -> Light {
    Light { direction, intensity: Vec3::splat(intensity), kind: LightKind::PARALLEL, ..Light::default() }
}

/// The share of light that is left at a point of the ground, seen from beside the plate, and the mean of `samples`.
fn left(scene: &Arc<Scene>, point: Vec3, samples: u32) -> f64 {
    let world = World::new(scene, Options::default());
    let eye = Vec3::new(6.0, 0.8, 0.0);
    let ray = Ray { origin: eye, direction: (point - eye).normalize(), t_max: f32::INFINITY };
    let mut sum = 0.0;
    for index in 0..samples {
        let mut sampler = PathSampler::new(1, UVec2::ZERO, index);
        let seen = look(&world, &ray, &mut sampler);
        sum += f64::from((seen.radiance - seen.shadow).x / seen.radiance.x);
    }
    sum / f64::from(samples)
}

#[test]
fn under_a_plate_in_even_light_the_ground_is_darker_by_its_form_factor() {
    // From a point under the middle of a square of half side a at height h, A = a / h: four corners, each
    // A / sqrt(1 + A^2) atan(A / sqrt(1 + A^2)) / pi (Howell (catalog), B-3).
    let root = 2f64.sqrt();
    let form = 4.0 * (1.0 / root) * (1.0 / root).atan() / std::f64::consts::PI;
    let found = left(&scene(even(0.7), Vec::new()), Vec3::ZERO, 1 << 14);
    assert!((found - (1.0 - form)).abs() < 5e-3, "{found} {}", 1.0 - form);
    // The same with a map that is sampled by its light: bright above, where the plate is.
    let mut bright = even(0.7);
    bright.texels = (0..128).map(|i| Vec3::splat(if i < 32 { 40.0 } else { 0.5 })).collect();
    let middle = left(&scene(bright.clone(), Vec::new()), Vec3::ZERO, 1 << 14);
    let beside = left(&scene(bright, Vec::new()), Vec3::new(0.0, 0.0, 30.0), 1 << 12);
    assert!(middle < 0.6 * (1.0 - form) && beside > 0.99, "{middle} {beside}");
}

#[test]
fn the_sun_throws_the_share_of_its_light() {
    let up = 0.7 * std::f32::consts::PI;
    let lit = scene(even(0.7), vec![sun(3.0 * up, Vec3::NEG_Y)]);
    let form = 4.0 * 0.5f64.sqrt() * 0.5f64.sqrt().atan() / std::f64::consts::PI;
    // The sky is a quarter of all light, and the sun stands above the plate.
    let under = left(&lit, Vec3::ZERO, 1 << 14);
    assert!((under - 0.25 * (1.0 - form)).abs() < 5e-3, "{under}");
    // A sun that shines from below lights no ground.
    let below = left(&scene(even(0.7), vec![sun(9.0, Vec3::Y)]), Vec3::ZERO, 1 << 14);
    assert!((below - (1.0 - form)).abs() < 5e-3, "{below}");
}

#[test]
fn lamps_with_a_size_throw_their_share_and_those_without_shadows_none() {
    // Alone in the dark, above the plate: all of it is hidden, or a part from beside.
    let kinds = [
        LightKind::Rectangle { across: Vec3::X, size: Vec2::splat(1.0) },
        LightKind::Sphere { radius: 0.4 },
        LightKind::Directional { angular_radius: 0.05 },
    ];
    for kind in kinds {
        let lamp = Light { kind, position: Vec3::new(0.0, 2.0, 0.0), direction: Vec3::NEG_Y, ..Light::default() };
        let of =
            |shadows: bool, at: Vec3| left(&scene(even(1e-6), vec![Light { shadows, ..lamp.clone() }]), at, 1 << 12);
        let (hidden, open) = (of(true, Vec3::ZERO), of(false, Vec3::ZERO));
        assert!(hidden.abs() < 5e-3 && (open - 1.0).abs() < 5e-3, "{kind:?}: {hidden} {open}");
        let far = of(true, Vec3::new(0.0, 0.0, 9.0));
        assert!((far - 1.0).abs() < 5e-3 || !matches!(kind, LightKind::Directional { .. }), "{kind:?}: {far}");
    }
}

#[test]
fn without_a_catcher_nothing_is_cast_and_the_sky_is_as_it_was() {
    let mut plain = Scene::clone(&scene(even(0.7), Vec::new()));
    let world = |scene: &Scene| World::new(&Arc::new(scene.clone()), Options::default());
    let ray = Ray { origin: Vec3::new(6.0, 0.8, 0.0), direction: Vec3::new(-1.0, -0.1, 0.0), t_max: f32::INFINITY };
    let mut sampler = PathSampler::new(1, UVec2::ZERO, 0);
    if let Some(ground) = &mut plain.background.ground {
        ground.shadows = false;
    }
    let seen = look(&world(&plain), &ray, &mut sampler);
    assert_eq!(seen, Seen { radiance: Vec3::splat(0.7), shadow: Vec3::ZERO, rays: 0 });
    plain.background = Background::of_color(Vec3::X);
    assert_eq!(look(&world(&plain), &ray, &mut sampler).radiance, Vec3::X);
    let dark = scene(even(0.0), Vec::new());
    let seen = look(&world(&dark), &ray, &mut sampler);
    assert_eq!((seen.radiance, seen.shadow), (Vec3::ZERO, Vec3::ZERO));
}
