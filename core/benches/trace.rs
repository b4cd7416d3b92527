//! Time to build the trees of a mesh of 1.3 million triangles, and rays per second through them:
//! `cargo bench -p burnish-core --bench trace`.
//!
//! Rays of four kinds, from least to most scattered: `primary` of a camera, `shadow` from what they meet to a lamp,
//! `bounce` from there with the density of a matt surface, `random` between points of the bounds.

use std::hint::black_box;
use std::sync::Arc;

use burnish_core::material::Material;
use burnish_core::math::frame::Frame;
use burnish_core::math::sampling::{self, Random};
use burnish_core::scene::gallery::shape;
use burnish_core::scene::{Camera, Instance, Mesh, Scene};
use burnish_core::trace::{Accel, Ray, offset, rounding};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{Affine3A, Quat, Vec2, Vec3};
use rayon::prelude::*;

/// Rays of a batch.
const COUNT: usize = 1 << 18;

/// Rays that a thread takes at once.
const CHUNK: usize = 1 << 10;

/// A ball with waves of three lengths, of about `4 n^2` triangles.
fn wavy_ball(n: usize) -> Mesh {
    let mut mesh = shape::sphere(1.0, 2 * n);
    for p in &mut mesh.positions {
        let wave = |times: f32| (times * p.x).sin() * (times * p.y).sin() * (times * p.z).sin() / times;
        *p *= 1.0 + wave(5.0) + wave(23.0) + 0.5 * wave(160.0);
    }
    mesh
}

fn scene(mesh: Mesh, places: impl IntoIterator<Item = Affine3A>) -> Scene {
    let place =
        |world_from_local| Instance { name: String::new(), mesh: 0, material: 0, world_from_local, visible: true };
    Scene {
        meshes: vec![Arc::new(mesh)],
        instances: places.into_iter().map(place).collect(),
        materials: vec![Material::default()],
        ..Scene::default()
    }
}

/// Twenty copies, turned, on a grid.
fn crowd(n: usize) -> Scene {
    let place = |i: usize| {
        let at = 2.0 * Vec3::new((i % 5) as f32 - 2.0, (i / 5) as f32 - 1.5, 0.3 * (i % 3) as f32);
        Affine3A::from_rotation_translation(Quat::from_scaled_axis(at), at)
    };
    scene(wavy_ball(n), (0..20).map(place))
}

fn primary(scene: &Scene) -> Vec<Ray> {
    let bounds = scene.bounds();
    let eye = bounds.center() + bounds.radius() * Vec3::new(0.4, 0.3, 2.0);
    let camera = Camera::look_at("bench", eye, bounds.center(), 0.7);
    let mut random = Random::new(1);
    let width = 512;
    let one = |i: usize| {
        let pixel = Vec2::new((i % width) as f32, (i / width) as f32);
        let ray = camera.ray((pixel + random.point2()) / width as f32, 1.0);
        Ray { origin: ray.origin, direction: ray.direction, t_max: f32::INFINITY }
    };
    (0..COUNT).map(one).collect()
}

/// A point of a surface from which rays start.
#[derive(Clone, Copy)]
struct Point {
    position: Vec3,
    normal: Vec3,
    rounding: Vec3,
}

impl Point {
    fn ray(&self, direction: Vec3, t_max: f32) -> Ray {
        Ray { origin: offset(self.position, self.rounding, self.normal, direction), direction, t_max }
    }
}

/// Points that camera rays meet, until there are as many as rays.
fn met(scene: &Scene, accel: &Accel, rays: &[Ray]) -> Vec<Point> {
    let point = |ray: &Ray| {
        let hit = accel.closest(ray, |_| true)?;
        let instance = &scene.instances[hit.instance as usize];
        let mesh = &scene.meshes[instance.mesh];
        let first = 3 * hit.triangle as usize;
        let local = [0, 1, 2].map(|corner| mesh.positions[mesh.indices[first + corner] as usize]);
        let [a, b, c] = local.map(|p| instance.world_from_local.transform_point3(p));
        Some(Point {
            position: a + hit.barycentric.x * (b - a) + hit.barycentric.y * (c - a),
            normal: (b - a).cross(c - a).normalize(),
            rounding: rounding(&instance.world_from_local, local),
        })
    };
    let points: Vec<_> = rays.iter().filter_map(point).collect();
    points.iter().copied().cycle().take(rays.len()).collect()
}

/// The rays of each kind; those of `shadow` end at a lamp.
fn kinds(scene: &Scene, accel: &Accel) -> [(&'static str, Vec<Ray>); 4] {
    let primary = primary(scene);
    let points = met(scene, accel, &primary);
    let bounds = scene.bounds();
    let mut random = Random::new(2);
    let lamp = bounds.center() + bounds.radius() * Vec3::new(1.5, 2.0, 1.0);
    let to_lamp = |point: &Point| point.ray((lamp - point.position).normalize(), (lamp - point.position).length());
    let shadow = points.iter().map(to_lamp).collect();
    let matt = |point: &Point| {
        let direction = Frame::new(point.normal).to_world(sampling::cosine_hemisphere(random.point2()));
        point.ray(direction, f32::INFINITY)
    };
    let bounce = points.iter().map(matt).collect();
    let mut inside = || bounds.min + random.point3() * (bounds.max - bounds.min);
    let random = (0..COUNT).map(|_| {
        let (from, to) = (inside(), inside());
        Ray { origin: from, direction: (to - from).normalize(), t_max: f32::INFINITY }
    });
    let random = random.collect();
    [("primary", primary), ("shadow", shadow), ("bounce", bounce), ("random", random)]
}

fn trace(accel: &Accel, kind: &str, rays: &[Ray]) -> usize {
    let hits = |rays: &[Ray]| match kind {
        "shadow" => rays.iter().filter(|ray| accel.occluded(ray, |_| true)).count(),
        _ => rays.iter().filter(|ray| accel.closest(ray, |_| true).is_some()).count(),
    };
    rays.par_chunks(CHUNK).map(hits).sum()
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started")
}

fn rays(c: &mut Criterion) {
    for (name, scene) in [("ball", scene(wavy_ball(570), [Affine3A::IDENTITY])), ("crowd", crowd(180))] {
        let accel = Accel::new(&scene);
        println!("{name}: {} triangles, {} MB", scene.triangle_count(), accel.bytes() / 1_000_000);
        let mut group = c.benchmark_group(format!("trace/{name}"));
        group.throughput(Throughput::Elements(COUNT as u64)).sample_size(10);
        for (kind, rays) in kinds(&scene, &accel) {
            for threads in [1, 2] {
                let pool = pool(threads);
                group.bench_function(BenchmarkId::new(kind, threads), |b| {
                    b.iter(|| pool.install(|| trace(black_box(&accel), kind, black_box(&rays))));
                });
            }
        }
        group.finish();
    }
}

fn build(c: &mut Criterion) {
    let scene = scene(wavy_ball(570), [Affine3A::IDENTITY]);
    let accel = Accel::new(&scene);
    let mut group = c.benchmark_group("trace/build");
    group.throughput(Throughput::Elements(scene.triangle_count() as u64)).sample_size(10);
    for threads in [1, 2] {
        let pool = pool(threads);
        group.bench_function(BenchmarkId::new("new", threads), |b| {
            b.iter(|| pool.install(|| Accel::new(black_box(&scene))));
        });
    }
    group.bench_function("updated", |b| b.iter(|| accel.updated(black_box(&scene))));
    group.finish();
}

criterion_group!(benches, build, rays);
criterion_main!(benches);
