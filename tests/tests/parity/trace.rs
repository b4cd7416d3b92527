//! Rays on the device against rays on the processor: the same trees, walked by `render/src/trace/trace.wgsl`.

use std::sync::Arc;

use burnish_core::material::Material;
use burnish_core::math::sampling::Random;
use burnish_core::scene::gallery::{self, shape};
use burnish_core::scene::{Bounds, Instance, Mesh, Scene};
use burnish_core::trace::{Accel, Hit, Ray, rounding};
use burnish_render::device::{self, ACCEPTED};
use burnish_render::trace::{TracePass, TraceTree};
use burnish_render::{Gpu, RenderError};
use burnish_tests::{Need, trial};
use glam::{Affine3A, Mat3A, Quat, Vec3};
use libtest_mimic::Trial;

use crate::harness::GPU;

/// Rays of each scene.
const RAYS: usize = 100_000;

/// Share of rays whose results may differ by more than [`NEAR`], each of which rounding must explain: rays that start on a
/// surface meet it or not by the last bit. Rays come to a mesh through 48 digits on the device and through 53 on the
/// processor. That tells exact ties apart, as when the inverse of a turn about an axis is short of 1 by 2^-53: half a
/// percent of the rays where the object is turned so and a fifth of them start on surfaces, none elsewhere.
const SHARE: f32 = 0.006;

/// Share of a distance.
const NEAR: f32 = 1e-5;

/// A weight of a corner that is as good as zero: the hit is at the edge.
const AT_THE_EDGE: f32 = 1e-5;

pub fn trials() -> Vec<Trial> {
    vec![
        trial(
            "trace: the device finds what the processor finds in every scene of the gallery",
            &[Need::Gpu],
            galleries,
        ),
        trial("trace: mirrored, sheared, flattened and far instances", &[Need::Gpu], crowds),
        trial("trace: nothing is hit where nothing is", &[Need::Gpu], nothing),
        trial(
            "trace: of hits at one distance the first counts, and ends are those of the processor",
            &[Need::Gpu],
            ties,
        ),
        trial("trace: no ray slips through edges and corners", &[Need::Gpu], closed),
        trial("trace: rays without sense end", &[Need::Gpu], senseless),
        trial("trace: trees may be of any depth", &[Need::Gpu], deep),
        trial("trace: a tree that is too large is refused", &[Need::Gpu], too_large),
    ]
}

/// What both found for some rays.
struct Found {
    rays: Vec<Ray>,
    cpu: Vec<Option<Hit>>,
    gpu: Vec<Option<Hit>>,
}

impl Found {
    fn new(scene: &Scene, rays: Vec<Ray>) -> Found {
        let accel = Accel::new(scene);
        let tree = TraceTree::new(&GPU, &accel).unwrap_or_else(|e| panic!("{e}"));
        let pass = TracePass::new(&GPU);
        let cpu = accel.closest_of_each(&rays);
        let gpu = pass.closest(&tree, &rays).unwrap_or_else(|e| panic!("{e}"));
        let occluded = pass.occluded(&tree, &rays).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((cpu.len(), occluded.len()), (gpu.len(), gpu.len()));
        for ((ray, gpu), occluded) in rays.iter().zip(&gpu).zip(occluded) {
            assert_eq!(gpu.is_some(), occluded, "{ray:?}: {gpu:?}");
        }
        Found { rays, cpu, gpu }
    }

    fn hits(&self) -> usize {
        self.cpu.iter().flatten().count()
    }

    /// Panics where both differ by more than rounding explains; gives what differs all the same.
    fn compare(&self, scene: &Scene, name: &str) -> Differences {
        let mut differences = Differences::default();
        for ((ray, cpu), gpu) in self.rays.iter().zip(&self.cpu).zip(&self.gpu) {
            let same = |cpu: &Hit, gpu: &Hit| (cpu.instance, cpu.triangle) == (gpu.instance, gpu.triangle);
            let moved = |hit: &Hit| moved(scene, ray, hit);
            let by_rounding = |hit: &Hit| rounding_decides(ray, hit, moved(hit));
            let explained = match (cpu, gpu) {
                (None, None) => continue,
                (Some(cpu), Some(gpu)) => {
                    let apart = (gpu.t - cpu.t).abs();
                    differences.bits += usize::from(cpu != gpu);
                    if apart <= NEAR * cpu.t && same(cpu, gpu) {
                        continue;
                    }
                    let nearer = if cpu.t < gpu.t { cpu } else { gpu };
                    apart <= (NEAR * cpu.t).max(moved(nearer)) || (!same(cpu, gpu) && by_rounding(nearer))
                }
                (Some(hit), None) | (None, Some(hit)) => by_rounding(hit),
            };
            assert!(explained, "{name}: {ray:?}\nprocessor {cpu:?}\ndevice {gpu:?}");
            match (cpu, gpu) {
                (Some(cpu), Some(gpu)) if same(cpu, gpu) => differences.at_the_start += 1,
                (Some(_), Some(_)) => differences.other_triangle += 1,
                _ => differences.one_only += 1,
            }
        }
        let Differences { at_the_start, other_triangle, one_only, .. } = differences;
        let share = (at_the_start + other_triangle + one_only) as f32 / self.rays.len() as f32;
        assert!(share <= SHARE, "{name}: {share} of all rays differ, {differences:?}");
        differences
    }
}

/// Rays whose results differ.
#[derive(Debug, Default)]
struct Differences {
    /// Both meet something, with any bit different.
    bits: usize,
    /// The same triangle, so near the origin that rounding is more than a share of the distance.
    at_the_start: usize,
    /// Not the same triangle.
    other_triangle: usize,
    /// Met by one only.
    one_only: usize,
}

/// How far rounding may move a hit along the ray: as far as a point of the triangle, seen along the ray.
fn moved(scene: &Scene, ray: &Ray, hit: &Hit) -> f32 {
    let (instance, corners) = triangle(scene, hit.instance as usize, hit.triangle as usize);
    let [a, b, c] = corners.map(|p| instance.world_from_local.transform_point3(p));
    let normal = (b - a).cross(c - a).normalize();
    normal.abs().dot(rounding(&instance.world_from_local, corners)) / normal.dot(ray.direction).abs()
}

/// True where a hit is at an end of the ray or at the edge of a triangle: the last bit tells whether there is one.
fn rounding_decides(ray: &Ray, hit: &Hit, moved: f32) -> bool {
    let [v, w] = hit.barycentric.to_array();
    let at_the_end = ray.t_max - hit.t <= moved.max(NEAR * hit.t);
    hit.t <= moved || at_the_end || v.min(w).min(1.0 - v - w) <= AT_THE_EDGE
}

fn triangle(scene: &Scene, instance: usize, triangle: usize) -> (&Instance, [Vec3; 3]) {
    let instance = &scene.instances[instance];
    let mesh = &scene.meshes[instance.mesh];
    (instance, [0, 1, 2].map(|corner| mesh.positions[mesh.indices[3 * triangle + corner] as usize]))
}

fn direction(random: &mut Random) -> Vec3 {
    loop {
        let v = 2.0 * random.point3() - 1.0;
        if (1e-4..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

fn pick(random: &mut Random, count: usize) -> usize {
    ((random.unit() * count as f32) as usize).min(count - 1)
}

/// Around a scene in all directions, along axes, from surfaces, and short ones.
fn rays(scene: &Scene, count: usize) -> Vec<Ray> {
    let mut random = Random::new(11);
    let Bounds { min, max } = scene.bounds();
    let size = (max - min).length();
    let visible: Vec<usize> = (0..scene.instances.len()).filter(|i| scene.instances[*i].visible).collect();
    let mut one = |i: usize| {
        let origin = min - 0.1 * size + (max - min + 0.2 * size) * random.point3();
        let (direction, t_max) = (direction(&mut random), f32::INFINITY);
        match i % 5 {
            0 | 1 => Ray { origin, direction, t_max },
            2 => Ray { origin, direction: Vec3::AXES[i % 3] * if i.is_multiple_of(2) { 1.0 } else { -1.0 }, t_max },
            3 => {
                let instance = visible[pick(&mut random, visible.len())];
                let count = scene.meshes[scene.instances[instance].mesh].indices.len() / 3;
                let (instance, [a, b, c]) = triangle(scene, instance, pick(&mut random, count));
                let u = random.point2();
                let (v, w) = if u.x + u.y > 1.0 { (1.0 - u.x, 1.0 - u.y) } else { (u.x, u.y) };
                let origin = instance.world_from_local.transform_point3(a + v * (b - a) + w * (c - a));
                Ray { origin, direction, t_max }
            }
            _ => Ray { origin, direction, t_max: 0.3 * size * random.unit() },
        }
    };
    (0..count).map(&mut one).collect()
}

fn galleries() {
    assert!(!gallery::list().is_empty());
    for gallery in gallery::list() {
        let scene = gallery::open(gallery.name).unwrap_or_else(|e| panic!("{e}"));
        let found = Found::new(&scene, rays(&scene, RAYS));
        let differences = found.compare(&scene, gallery.name);
        let hits = found.hits();
        assert!(hits > RAYS / 4 && hits < RAYS, "{}: {hits} hits", gallery.name);
        println!("{:<12} {hits} hits, {differences:?}", gallery.name);
    }
}

fn instance(mesh: usize, world_from_local: Affine3A) -> Instance {
    Instance { name: String::new(), mesh, material: 0, world_from_local, visible: true }
}

fn scene(meshes: impl IntoIterator<Item = Mesh>, instances: impl IntoIterator<Item = (usize, Affine3A)>) -> Scene {
    Scene {
        meshes: meshes.into_iter().map(Arc::new).collect(),
        instances: instances.into_iter().map(|(mesh, place)| instance(mesh, place)).collect(),
        materials: vec![Material::default()],
        ..Scene::default()
    }
}

fn crowds() {
    let mut random = Random::new(1);
    let cube = |random: &mut Random| 2.0 * random.point3() - 1.0;
    let place = |i: usize, random: &mut Random| {
        let scale = Vec3::new(1.0, 0.2 + random.unit(), if i.is_multiple_of(3) { -0.7 } else { 1e-3 });
        let turn = Quat::from_scaled_axis(4.0 * cube(random));
        let mut place = Affine3A::from_scale_rotation_translation(scale, turn, 5.0 * cube(random));
        if i.is_multiple_of(4) {
            place.matrix3 *= Mat3A::from_cols_array(&[1.0, 0.0, 0.0, 3.0, 1.0, 0.0, 0.0, -2.0, 1.0]);
        }
        place
    };
    let meshes = || [shape::sphere(1.0, 24), shape::torus(1.0, 0.3, 20, 8), shape::block(Vec3::ONE, 0.1, 3)];
    let many = scene(meshes(), (0..60).map(|i| (i % 3, place(i, &mut random))));
    let one = scene([shape::torus(1.0, 0.3, 20, 8)], [(0, Affine3A::IDENTITY)]);
    let mirrored = scene(
        [shape::torus(1.0, 0.3, 20, 8)],
        [(
            0,
            Affine3A::from_scale_rotation_translation(Vec3::new(-2.0, 3.0, 0.5), Quat::from_rotation_x(1.0), Vec3::ONE),
        )],
    );
    let far = scene([shape::sphere(1.0, 24)], [(0, Affine3A::from_translation(Vec3::new(1e3, -2e3, 5e2)))]);
    for (name, scene) in [("many", many), ("one", one), ("mirrored", mirrored), ("far", far)] {
        let found = Found::new(&scene, rays(&scene, 20_000));
        let differences = found.compare(&scene, name);
        assert!(found.hits() > 4_000, "{name}: {} hits", found.hits());
        println!("{name:<12} {} hits, {differences:?}", found.hits());
    }
}

fn nothing() {
    let mut hidden = scene([shape::sphere(1.0, 8)], [(0, Affine3A::IDENTITY)]);
    let ray = Ray { origin: Vec3::ZERO, direction: Vec3::Z, t_max: f32::INFINITY };
    assert_eq!(Found::new(&hidden, vec![ray]).gpu.iter().flatten().count(), 1);
    hidden.instances[0].visible = false;
    let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let flattened = scene([shape::sphere(1.0, 8)], [(0, flat)]);
    for scene in [Scene::default(), scene([Mesh::default()], [(0, Affine3A::IDENTITY)]), hidden, flattened] {
        assert_eq!(Found::new(&scene, vec![ray]).gpu, [None]);
        assert!(Found::new(&scene, Vec::new()).gpu.is_empty());
    }
}

/// Walls across the z axis.
fn walls(places: impl IntoIterator<Item = f32>) -> Scene {
    scene([shape::plane(2.0, 2.0)], places.into_iter().map(|z| (0, Affine3A::from_translation(z * Vec3::Z))))
}

/// Beside the diagonal of a wall.
const ALONG_Z: Ray = Ray { origin: Vec3::new(0.25, 0.125, 0.0), direction: Vec3::Z, t_max: f32::INFINITY };

fn ties() {
    let mut many = walls([1.0; 40]);
    many.instances[0].visible = false;
    let diagonal = Ray { origin: Vec3::ZERO, ..ALONG_Z };
    let found = Found::new(&many, vec![ALONG_Z, diagonal]);
    assert_eq!(found.cpu, found.gpu);
    assert_eq!(found.gpu[1].map(|hit| (hit.instance, hit.triangle)), Some((1, 0)));

    let ends = [2.0, 2.0_f32.next_up(), 2.0_f32.next_down(), 0.0, -0.0, -1.0, f32::NAN, f32::INFINITY, f32::MAX];
    let mut rays: Vec<Ray> = ends.map(|t_max| Ray { t_max, ..ALONG_Z }).to_vec();
    rays.push(Ray { origin: ALONG_Z.origin + 2.0 * Vec3::Z, ..ALONG_Z });
    let found = Found::new(&walls([2.0]), rays);
    assert_eq!(found.cpu, found.gpu);
    assert_eq!(
        found.gpu.iter().map(Option::is_some).collect::<Vec<_>>(),
        [false, true, false, false, false, false, false, true, true, true]
    );
}

/// From inside a closed surface through every corner and the middle of every edge, and through points beside them.
fn closed() {
    let mesh = shape::sphere(1.0, 48);
    let mut random = Random::new(3);
    for place in [
        Affine3A::IDENTITY,
        Affine3A::from_scale_rotation_translation(
            Vec3::new(3.0, -0.1, 1.0),
            Quat::from_rotation_z(0.7),
            Vec3::new(3.0, 7.0, -2.0),
        ),
    ] {
        let mut rays = Vec::new();
        for corners in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| place.transform_point3(mesh.positions[corners[i] as usize]));
            let origin = place.transform_point3(0.3 * (2.0 * random.point3() - 1.0));
            for target in [a, 0.5 * (a + b), 0.5 * (b + c), c + (a - c) * random.unit()] {
                rays.push(Ray { origin, direction: (target - origin).normalize(), t_max: f32::INFINITY });
            }
        }
        let scene = scene([mesh.clone()], [(0, place)]);
        let found = Found::new(&scene, rays);
        let lost = found.gpu.iter().filter(|hit| hit.is_none()).count();
        assert_eq!((lost, found.hits()), (0, found.rays.len()));
        found.compare(&scene, "closed");
    }
}

fn senseless() {
    let mut rays = Vec::new();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, f32::MAX, 1e-45, -0.0] {
        rays.push(Ray { origin: Vec3::splat(bad), ..ALONG_Z });
        rays.push(Ray { direction: Vec3::splat(bad), ..ALONG_Z });
        rays.push(Ray { direction: Vec3::Z.with_x(bad), ..ALONG_Z });
        rays.push(Ray { origin: Vec3::ZERO.with_y(bad), ..ALONG_Z });
    }
    let found = Found::new(&walls([1.0, 2.0]), rays);
    for ((ray, gpu), cpu) in found.rays.iter().zip(&found.gpu).zip(&found.cpu) {
        assert!(gpu.is_none_or(|hit| hit.t.is_finite()), "{ray:?}: {gpu:?}");
        assert_eq!(gpu.is_some(), cpu.is_some(), "{ray:?}: {gpu:?} {cpu:?}");
    }
}

/// Boxes one within the other, each larger by a little, boxes in one place, triangles in one place: their trees are lists.
fn deep() {
    let boxes = |count: i32, growth: f32| {
        let sizes = (0..count).map(move |i| Affine3A::from_scale(Vec3::splat(growth.powi(i))));
        scene([shape::block(Vec3::ONE, 0.0, 1)], sizes.map(|place| (0, place)))
    };
    let mut stacked = shape::block(Vec3::ONE, 0.1, 2);
    stacked.indices = stacked.indices.repeat(60);
    let places = [0.0, 0.4].map(|x| (0, Affine3A::from_translation(x * Vec3::X)));
    let stacked = scene([stacked], places);
    for (name, scene) in [("nested", boxes(1_000, 1.005)), ("in one place", boxes(1_000, 1.0)), ("stacked", stacked)] {
        let found = Found::new(&scene, rays(&scene, 2_000));
        let differences = found.compare(&scene, name);
        println!("{name:<12} {} hits, {differences:?}", found.hits());
        assert!(found.hits() > 500, "{name}: {} hits", found.hits());
    }
    // Along the axis of rings, through all of their boxes and none of them, to a wall.
    let places = (0..1_000).map(|i| (0, Affine3A::from_scale(Vec3::splat(1.003_f32.powi(i)))));
    let wall = (1, Affine3A::from_translation(50.0 * Vec3::Y));
    let rings = scene([shape::torus(1.0, 0.3, 8, 4), shape::block(Vec3::ONE, 0.0, 1)], places.chain([wall]));
    let mut random = Random::new(9);
    let ray = |_| Ray { origin: 0.1 * random.point3(), direction: Vec3::Y, t_max: f32::INFINITY };
    let found = Found::new(&rings, (0..100).map(ray).collect());
    assert!(found.gpu.iter().all(|hit| hit.is_some_and(|hit| hit.instance == 1_000)));
}

/// A device that binds no more than 64 kB.
fn too_large() {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = ACCEPTED;
    let adapters = pollster::block_on(wgpu::Instance::new(descriptor).enumerate_adapters(ACCEPTED));
    let adapter = device::choose(&adapters, |_| true).expect("an adapter");
    let mut descriptor = device::device_descriptor(adapter);
    descriptor.required_limits.max_storage_buffer_binding_size = 1 << 16;
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("a device");
    let gpu = Gpu::from_parts(adapter, device, queue);
    let sphere = |segments| Accel::new(&scene([shape::sphere(1.0, segments)], [(0, Affine3A::IDENTITY)]));
    let tree = TraceTree::new(&gpu, &sphere(12)).expect("a small tree fits");
    assert!(tree.bytes() <= 1 << 16);
    let refused = TraceTree::new(&gpu, &sphere(64)).err();
    assert!(matches!(refused, Some(RenderError::TooLarge { bytes: 100_000.., allowed: 65_536, .. })), "{refused:?}");
    assert_eq!(gpu.check(), Ok(()));
}
