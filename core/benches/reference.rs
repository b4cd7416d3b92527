//! Paths per second of the reference: three balls of metal on a plane, lit by the studio or by a panel.

use std::sync::Arc;
use std::time::Duration;

use burnish_core::material::preset;
use burnish_core::material::{Material, Reflectance};
use burnish_core::reference::{Control, Film, Options, View, World, trace};
use burnish_core::scene::gallery::{self, shape};
use burnish_core::scene::{Camera, Instance, Mesh, Scene};
use burnish_core::surface::fresnel::Form;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{Affine3A, UVec2, Vec3};

const SIZE: UVec2 = UVec2::new(160, 90);
const SAMPLES: u32 = 4;

fn metal(id: &str, roughness: f32) -> Material {
    let preset = preset::find(id).expect("a preset of the library");
    let fresnel = Arc::new(preset.fresnel(Form::Spectral));
    Material { reflectance: Reflectance::Preset { id: id.into(), fresnel }, roughness, ..Material::default() }
}

fn add(scene: &mut Scene, mesh: Mesh, material: Material, at: Affine3A) {
    scene.meshes.push(Arc::new(mesh));
    scene.materials.push(material);
    let place = scene.instances.len();
    scene.instances.push(Instance {
        name: format!("part {place}"),
        mesh: place,
        material: place,
        world_from_local: at,
        visible: true,
    });
}

fn balls(panel: bool) -> Scene {
    let mut scene = Scene::default();
    for (i, (id, roughness)) in [("Au", 0.1), ("Cu", 0.3), ("Al", 0.6)].into_iter().enumerate() {
        let at = Affine3A::from_translation(Vec3::new(2.2 * i as f32 - 2.2, 1.0, 0.0));
        add(&mut scene, shape::sphere(1.0, 128), metal(id, roughness), at);
    }
    let flat = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let floor = Material { base_color: Vec3::splat(0.5), specular: 0.0, ..Material::default() };
    add(&mut scene, shape::plane(40.0, 40.0), floor, flat);
    if panel {
        let down = Affine3A::from_translation(4.0 * Vec3::Y) * Affine3A::from_rotation_x(std::f32::consts::FRAC_PI_2);
        let light = Material { emission: Vec3::splat(10.0), base_color: Vec3::ZERO, ..Material::default() };
        add(&mut scene, shape::plane(3.0, 3.0), light, down);
    } else {
        scene.environment = Some(Arc::new(gallery::studio()));
    }
    scene
}

fn paths(c: &mut Criterion) {
    let mut group = c.benchmark_group("reference/paths");
    group.sample_size(10).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(5));
    group.throughput(Throughput::Elements(u64::from(SIZE.x * SIZE.y * SAMPLES)));
    for (name, panel) in [("studio", false), ("panel", true)] {
        let world = World::new(&Arc::new(balls(panel)), Options::default());
        let camera = Camera::look_at("bench", Vec3::new(0.0, 3.0, 8.0), Vec3::new(0.0, 0.8, 0.0), 0.6);
        let view = View { camera, size: SIZE, seed: 0 };
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            group.bench_function(format!("{name}/{threads}"), |b| {
                b.iter(|| {
                    let mut film = Film::new(SIZE);
                    pool.install(|| trace(&world, &view, &mut film, SAMPLES, &Control::default()))
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, paths);
criterion_main!(benches);
