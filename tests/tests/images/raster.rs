//! What probes see as the device draws it, against paths with direct light and against what is known.

use std::f32::consts::PI;
use std::sync::Arc;

use burnish_core::job::Handle;
use burnish_core::lighting::classical::PreparedMaps;
use burnish_core::lighting::probe::{self, Defaults, Probes, Raster, Sites};
use burnish_core::lighting::{MethodError, Prepared};
use burnish_core::material::Material;
use burnish_core::math::cube;
use burnish_core::math::sampling::hammersley;
use burnish_core::reference::{Options, World};
use burnish_core::scene::gallery::shape;
use burnish_core::scene::{Environment, Instance, Light, LightKind, Mesh, ProbeSource, Scene, gallery};
use burnish_render::{DeviceRaster, Gpu, Passes};
use burnish_tests::{Need, trial};
use glam::{Affine3A, UVec2, Vec2, Vec3};
use libtest_mimic::Trial;

/// Edge of a face that is compared, and of one that is drawn.
const EDGE: u32 = 16;
const DRAWN: u32 = 64;
const PATHS: u32 = 256;

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a probe is drawn as paths of direct light see it: lamps", &[Need::Gpu], lamps),
        trial("a probe is drawn as paths of direct light see it: sky and sun", &[Need::Gpu], sky_and_sun),
        trial("a drawn probe shows what is bright in each of six directions", &[Need::Gpu], six_directions),
        trial("a small bright thing keeps its power in a drawn probe", &[Need::Gpu], small_and_bright),
        trial("a sun smaller than a texel keeps its power in a drawn probe", &[Need::Gpu], small_sun),
        trial("a place inside a body is drawn without a fault", &[Need::Gpu], inside_a_body),
        trial("what a probe leaves out moves and its picture stays", &[Need::Gpu], unseen_moves),
    ]
}

fn device() -> Arc<DeviceRaster> {
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    Arc::new(DeviceRaster::new(&Arc::new(Passes::new(&gpu))))
}

fn even(light: f32) -> Environment {
    Environment::new("even", 8, 4, vec![Vec3::splat(light); 32])
}

fn add(scene: &mut Scene, mesh: Mesh, material: Material, place: Vec3) {
    scene.instances.push(Instance {
        name: format!("object {}", scene.instances.len()),
        mesh: scene.meshes.len(),
        material: scene.materials.len(),
        world_from_local: Affine3A::from_translation(place),
        visible: true,
    });
    scene.meshes.push(Arc::new(mesh));
    scene.materials.push(material);
}

/// A ball that a probe serves, at a place.
fn with_subject(place: Vec3) -> Scene {
    let mut scene = Scene { environment: Some(Arc::new(even(0.0))), ..Scene::default() };
    add(&mut scene, shape::sphere(0.1, 16), Material::default(), place);
    scene.subject = vec![0];
    scene
}

fn glowing(emission: Vec3) -> Material {
    Material { base_color: Vec3::ZERO, specular: 0.0, emission, ..Material::default() }
}

/// The scene without what its first probe serves, and where that stands.
fn around(scene: &Scene, options: Options) -> (World, Vec3) {
    let site = Sites::new(scene, Defaults { face: EDGE, paths: 1, layers: 1 }).list.remove(0);
    (World::new(&Arc::new(probe::surroundings(scene, &site.served)), options), site.middle)
}

/// Mean radiance of the texels of faces, and of their differences from paths, over the mean of the paths.
fn compare(scene: &Scene) -> [f32; 2] {
    let (world, middle) = around(scene, Options { bounces: 1, ..Options::default() });
    let drawn = device().faces(&world, middle, DRAWN, &Handle::default()).expect("a picture");
    let times = DRAWN / EDGE;
    let (mut means, mut apart, mut weights) = ([Vec3::ZERO; 2], 0.0, 0.0);
    for i in 0..6 * EDGE * EDGE {
        let (side, y, x) = (i / (EDGE * EDGE), i / EDGE % EDGE, i % EDGE);
        let texel = |j: u32| {
            let (v, u) = (times * y + j / times, times * x + j % times);
            drawn[((side * DRAWN + v) * DRAWN + u) as usize]
        };
        let a = (0..times * times).map(texel).sum::<Vec3>() / (times * times) as f32;
        let path = |path: u32| {
            let inside = hammersley(path, PATHS) + Vec2::splat(0.5 / PATHS as f32);
            let p = (Vec2::new(x as f32, y as f32) + inside) / EDGE as f32 * 2.0 - 1.0;
            world.along(middle, cube::mirrored(cube::direction(side, p)), UVec2::new(i, 0), path).radiance
        };
        let b = (0..PATHS).map(path).sum::<Vec3>() / PATHS as f32;
        let p = (Vec2::new(x as f32, y as f32) + 0.5) / EDGE as f32 * 2.0 - 1.0;
        let weight = cube::weight(p);
        means = [means[0] + weight * a, means[1] + weight * b];
        apart += weight * (a - b).abs().element_sum();
        weights += weight;
    }
    let [a, b] = means.map(|mean| mean / weights);
    assert!(b.min_element() > 1e-3, "there is light: {b}");
    [(a / b - 1.0).abs().max_element(), apart / weights / b.element_sum()]
}

/// The default scene by its spot alone, without an environment and its bright window, whose light `classical` does not know: shadow maps against
/// rays.
fn lamps() {
    let mut scene = gallery::open("workbench").expect("in the gallery");
    scene.environment = Some(Arc::new(even(0.0)));
    scene.materials.iter_mut().for_each(|material| material.emission = Vec3::ZERO);
    let [mean, apart] = compare(&scene);
    assert!(mean < 0.02 && apart < 0.04, "means are {mean} apart, texels {apart} of the mean");
}

/// A floor under an uneven sky with a sun, on which nothing stands: `classical` knows no shadows of the sky.
fn sky_and_sun() {
    let mut scene = with_subject(Vec3::new(0.0, 1.0, 0.0));
    let floor = shape::block(Vec3::new(200.0, 0.2, 200.0), 0.0, 1);
    add(
        &mut scene,
        floor,
        Material { base_color: Vec3::new(0.7, 0.4, 0.2), roughness: 0.8, ..Material::default() },
        Vec3::ZERO,
    );
    scene.environment = Some(Arc::new(uneven(64)));
    scene.lights.push(Light {
        name: "sun".into(),
        direction: Vec3::new(0.3, -1.0, 0.2).normalize(),
        intensity: Vec3::splat(3.0),
        kind: LightKind::Directional { angular_radius: 0.0 },
        ..Light::default()
    });
    let [mean, apart] = compare(&scene);
    assert!(mean < 0.005 && apart < 0.01, "means are {mean} apart, texels {apart} of the mean");
}

fn uneven(height: u32) -> Environment {
    let width = 2 * height;
    let texel = |i: u32| {
        let (x, y) = ((i % width) as f32 / width as f32, (i / width) as f32 / height as f32);
        Vec3::new(1.0 + (2.0 * PI * x).sin(), 1.0 + 0.5 * (4.0 * PI * x).cos(), y)
    };
    Environment { rotation: 0.7, ..Environment::new("uneven", width, height, (0..width * height).map(texel).collect()) }
}

/// The only probe of a scene, drawn, and its light.
fn drawn_probe(scene: Scene, face: u32) -> Prepared {
    let world = World::new(&Arc::new(scene), Options::default()).with_raster(Some(device()));
    let mut sites = Sites::new(world.scene(), Defaults { face, paths: 1, layers: 1 });
    sites.list.iter_mut().for_each(|site| site.source = ProbeSource::Raster);
    probe::prepare(&world, &sites, &Handle::default()).expect("a probe")
}

/// Balls of different colours, none of them in the middle of a face: a face that is mirrored or turned shows another, or none.
fn six_directions() {
    let middle = Vec3::new(0.5, -0.3, 0.2);
    let mut scene = with_subject(middle);
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let colors =
        [[9., 1., 1.], [1., 9., 1.], [1., 1., 9.], [9., 9., 1.], [1., 9., 9.], [9., 1., 9.]].map(Vec3::from_array);
    let places =
        axes.map(|axis| 3.0 * axis + 1.1 * Vec3::new(axis.y, axis.z, axis.x) + 0.6 * Vec3::new(axis.z, axis.x, axis.y));
    for (place, color) in places.iter().zip(colors) {
        add(&mut scene, shape::sphere(0.5, 24), glowing(color), middle + *place);
    }
    let prepared = drawn_probe(scene, 32);
    let probe = Probes::of(&prepared).get(0).expect("a probe");
    let maps = PreparedMaps::unturned(probe.maps).expect("its light");
    let cubes = maps.cubes();
    for (place, color) in places.iter().zip(colors) {
        let seen = maps.scale() * cubes[0].lookup(cube::mirrored(place.normalize()), 0.0);
        assert!(seen.abs_diff_eq(color, 0.05), "{place}: {seen} instead of {color}");
        let distance = probe.distances.distance(place.normalize());
        assert!((distance - (place.length() - 0.5)).abs() < 0.05, "{place}: light and distance differ: {distance}");
        let beside = maps.scale() * cubes[0].lookup(cube::mirrored(-place.normalize()), 0.0);
        assert!(
            beside.max_element() < 0.5 || places.iter().any(|other| other.normalize().dot(-place.normalize()) > 0.98)
        );
    }
}

/// Integral of what a drawn probe shows over all directions.
fn power(prepared: &Prepared) -> Vec3 {
    let maps = PreparedMaps::unturned(&prepared.parts()[0]).expect("its light");
    let map = maps.cubes()[0];
    let edge = map.edge(0);
    let mut sum = Vec3::ZERO;
    for i in 0..6 * edge * edge {
        let (side, y, x) = (i / (edge * edge), i / edge % edge, i % edge);
        let p = (Vec2::new(x as f32, y as f32) + 0.5) / edge as f32 * 2.0 - 1.0;
        sum += cube::weight(p) * (2.0 / edge as f32).powi(2) * map.texel(0, side, x, y);
    }
    maps.scale() * sum
}

/// Balls that are seen under 6 degrees, two texels of the probe: in the middle of a face, near an edge, near a corner, straight up.
fn small_and_bright() {
    for toward in [Vec3::new(0.02, 0.01, -1.0), Vec3::new(1.0, 0.1, 0.95), Vec3::new(-1.0, 0.9, 0.92), Vec3::Y] {
        let mut scene = with_subject(Vec3::ZERO);
        let sine = 3.0_f32.to_radians().sin();
        add(&mut scene, shape::sphere(4.0 * sine, 64), glowing(Vec3::splat(500.0)), 4.0 * toward.normalize());
        let wanted = 500.0 * 2.0 * PI * (1.0 - (1.0 - sine * sine).sqrt());
        let kept = power(&drawn_probe(scene, 32)).x / wanted;
        assert!((kept - 1.0).abs() < 0.15, "{kept} of the power of a lamp toward {toward}");
    }
}

/// A sun of one texel in a fine map, smaller than what is drawn.
fn small_sun() {
    let (width, height) = (2048, 1024);
    for (x, y) in [(1024, 500), (1301, 260), (700, 12)] {
        let mut map = Environment::new("sun", width, height, vec![Vec3::ZERO; (width * height) as usize]);
        let mut texels = map.texels.to_vec();
        texels[(y * width + x) as usize] = Vec3::splat(1e6);
        map.texels = texels.into();
        let wanted = 1e6 * map.texel_solid_angle(y) as f32;
        let mut scene = with_subject(Vec3::ZERO);
        add(&mut scene, shape::sphere(0.1, 8), Material::default(), Vec3::new(0.0, -5.0, 0.0));
        scene.environment = Some(Arc::new(map));
        let kept = power(&drawn_probe(scene, 32)).x / wanted;
        assert!((kept - 1.0).abs() < 0.15, "{kept} of the power of a sun in column {x}, row {y}");
    }
}

fn inside_a_body() {
    let mut scene = with_subject(Vec3::ZERO);
    add(&mut scene, shape::block(Vec3::ONE, 0.0, 1), Material::default(), Vec3::ZERO);
    scene.environment = Some(Arc::new(even(1.0)));
    let (world, middle) = around(&scene, Options::default());
    let raster = device();
    for place in [middle, Vec3::splat(0.5), Vec3::new(0.5, 0.1, 0.0)] {
        let faces = raster.faces(&world, place, 16, &Handle::default()).expect("a picture");
        assert!(faces.len() == 6 * 16 * 16 && faces.iter().all(|light| light.is_finite()), "{place}");
    }
}

fn unseen_moves() {
    let mut scene = gallery::open("workbench").expect("in the gallery");
    scene.environment = Some(Arc::new(uneven(32)));
    let (world, middle) = around(&scene, Options::default());
    let raster = device();
    let draw = |world: &World| raster.faces(world, middle, 32, &Handle::default());
    let before = draw(&world).expect("a picture");
    let served = scene.subject[0];
    scene.instances[served].world_from_local.translation.x += 20.0;
    let (moved, _) = around(&scene, Options::default());
    assert!(draw(&moved).expect("a picture") == before, "shadow maps do not follow what is hidden");
    let job = Handle::default();
    job.cancel();
    assert_eq!(raster.faces(&moved, middle, 32, &job), Err(MethodError::Cancelled));
    assert!(draw(&moved).expect("a picture") == before, "and goes on after that");
    let others = scene.instances.iter_mut().enumerate().filter(|(index, _)| !scene.subject.contains(index));
    others.for_each(|(_, instance)| instance.world_from_local.translation.x += 0.05);
    let (other, _) = around(&scene, Options::default());
    assert!(draw(&other).expect("a picture") != before, "what is seen counts");
    let fresh = device().faces(&other, middle, 32, &Handle::default()).expect("a picture");
    assert!(draw(&other).expect("a picture") == fresh, "what stays on the device is right");
}
