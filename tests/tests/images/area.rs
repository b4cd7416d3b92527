//! Lights with an area, live: against the path tracer, against the processor, and one light at a time.

use std::sync::{Arc, LazyLock};

use burnish_core::lighting::classical;
use burnish_core::material::preset;
use burnish_core::material::{Material, Reflectance};
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::reference::{self, Contribution, Control, Film, Options, Pass, World};
use burnish_core::scene::gallery::shape;
use burnish_core::scene::{Background, Camera, Environment, Ground, Instance, Light, LightKind, Scene, gallery};
use burnish_core::surface::fresnel::Form;
use burnish_render::{Gpu, Renderer, View};
use burnish_tests::{Need, trial};
use glam::{Affine3A, UVec2, Vec2, Vec3, Vec4};
use libtest_mimic::Trial;

use crate::processor;

const ROUGHNESSES: [f32; 6] = [0.1, 0.2, 0.35, 0.5, 0.7, 1.0];
/// Mean |live - traced| over mean traced, of the subject; with the noise of the tracer.
const UNSHADOWED: f64 = 0.03;
/// The same of a matte floor, of which an eighth lies in penumbras.
const SHADOWED: f64 = 0.03;
/// The same of a small picture, in which edges of bright lights and of the bar have 16 samples a pixel.
const SEEN: f64 = 0.06;

pub fn trials() -> Vec<Trial> {
    let gpu: &[Need] = &[Need::Gpu];
    vec![
        trial("a ball under a rectangle or a sphere is that of the path tracer", gpu, balls),
        trial("soft shadows of lights with an area are about those of the path tracer", gpu, shadows),
        trial("lights are seen, linked and left out of reflections as by the path tracer", gpu, switches),
        trial("what each source contributes adds up to the live picture", gpu, contributions),
        trial("live lights without size or power, in a surface or around it leave numbers", gpu, numbers),
        trial("lights with an area are the same on device and processor", gpu, || {
            let mut scene = floor(LightKind::Sphere { radius: 0.2 });
            scene.lights.push(rectangle());
            scene.lights.push(sun());
            processor::same_scene(scene, "16");
        }),
    ]
}

fn black() -> Option<Arc<Environment>> {
    static BLACK: LazyLock<Arc<Environment>> =
        LazyLock::new(|| Arc::new(Environment::new("black", 8, 4, vec![Vec3::ZERO; 32])));
    Some(BLACK.clone())
}

fn aimed(kind: impl Fn(Vec3) -> LightKind, position: Vec3, intensity: Vec3) -> Light {
    let direction = -position.normalize();
    let across = direction.cross(Vec3::Y).normalize();
    Light { name: "area".into(), position, direction, intensity, kind: kind(across), ..Light::default() }
}

fn rectangle() -> Light {
    let kind = |across| LightKind::Rectangle { across, size: Vec2::new(0.4, 0.25) };
    aimed(kind, Vec3::new(0.35, 0.4, 0.35), Vec3::new(5.0, 4.0, 3.0))
}

fn sun() -> Light {
    let kind = |_| LightKind::Directional { angular_radius: 0.05 };
    aimed(kind, Vec3::new(-1.0, 2.0, 0.5), Vec3::new(0.5, 0.6, 0.8))
}

/// A device with its pipelines, for many scenes.
pub fn renderer(scene: &Scene) -> Renderer {
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    Renderer::new(&gpu, scene).unwrap_or_else(|e| panic!("{e}"))
}

pub fn live(renderer: &mut Renderer, scene: &Scene, size: UVec2, frames: u32) -> Picture {
    renderer.set_scene(&Arc::new(scene.clone())).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(renderer.unshadowed_lights(), &[] as &[String]);
    let camera = scene.cameras[0].clone();
    let view = View { size, camera, settings: Settings::new(classical::PARAMS), jitter_frames: frames };
    renderer.render(&view).unwrap_or_else(|e| panic!("{e}"))
}

pub fn traced(scene: &Scene, size: UVec2, samples: u32) -> Picture {
    let world = World::new(&Arc::new(scene.clone()), Options { bounces: 1, ..Options::default() });
    let view = reference::View { camera: scene.cameras[0].clone(), size, seed: 1 };
    let mut film = Film::new(size);
    assert_eq!(reference::trace(&world, &view, &mut film, samples, &Control::default()), Pass::Whole);
    assert_eq!(film.rejected(), 0);
    film.picture()
}

/// Mean |a - b| over mean b.
pub fn apart(a: &Picture, b: &Picture) -> f64 {
    let sum = |texel: Vec4| f64::from(texel.truncate().element_sum());
    let difference: f64 = a.texels.iter().zip(&b.texels).map(|(a, b)| sum((*a - *b).abs())).sum();
    difference / b.texels.iter().map(|b| sum(*b)).sum::<f64>()
}

fn balls() {
    let lights =
        [rectangle(), aimed(|_| LightKind::Sphere { radius: 0.12 }, Vec3::new(-0.3, 0.3, 0.3), Vec3::splat(6.0))];
    let mut table = String::new();
    let mut worst = 0.0_f64;
    let mut device = renderer(&floor(LightKind::Point));
    for (id, form) in [("Au", Form::Fitted), ("Al", Form::Spectral)] {
        let metal = preset::library().iter().find(|preset| preset.id == id).expect("a preset");
        for light in &lights {
            table += &format!("{id} {form:?} {}:", light.kind.label());
            for roughness in ROUGHNESSES {
                let mut scene = gallery::open(&format!("ball?material={id}&roughness={roughness}")).expect("a scene");
                scene.environment = black();
                scene.lights = vec![light.clone()];
                scene.materials[0].reflectance =
                    Reflectance::Preset { id: id.into(), fresnel: Arc::new(metal.fresnel(form)) };
                let size = UVec2::splat(48);
                let picture = live(&mut device, &scene, size, 16);
                let error = apart(&picture, &traced(&scene, size, 512));
                table += &format!(" {:.2} %", 100.0 * error);
                worst = worst.max(error);
            }
            table += "\n";
        }
    }
    println!("roughness {ROUGHNESSES:?}\n{table}");
    assert!(worst <= UNSHADOWED, "mean error of the ball over {UNSHADOWED}\n{table}");
}

/// A matte floor with a bar over it, under a light.
pub fn floor(kind: LightKind) -> Scene {
    let mut scene = Scene { environment: black(), ..Scene::default() };
    let base_color = Vec3::splat(0.7);
    scene.materials.push(Material { base_color, roughness: 0.8, metallic: 0.0, specular: 0.0, ..Material::default() });
    let up = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let bar = Affine3A::from_translation(Vec3::new(0.0, 0.3, 0.0)) * up;
    for (mesh, place) in [(shape::plane(2.0, 2.0), up), (shape::plane(0.5, 0.3), bar)] {
        scene.meshes.push(Arc::new(mesh));
        let mesh = scene.meshes.len() - 1;
        let name = format!("plane {mesh}");
        scene.instances.push(Instance { name, mesh, material: 0, world_from_local: place, visible: true });
    }
    let position = Vec3::new(0.1, 1.0, 0.0);
    let direction = Vec3::NEG_Y;
    scene.lights.push(Light { position, direction, intensity: Vec3::splat(3.0), kind, ..Light::default() });
    scene.cameras.push(Camera::look_at("main", Vec3::new(0.0, 1.6, 1.6), Vec3::ZERO, 0.7));
    scene
}

fn shadows() {
    let mut table = String::new();
    let mut worst = 0.0_f64;
    let rectangle = |width| LightKind::Rectangle { across: Vec3::X, size: Vec2::new(width, 0.5 * width) };
    let kinds = [
        ("rectangle 0.2 m", rectangle(0.2)),
        ("rectangle 0.6 m", rectangle(0.6)),
        ("sphere 0.1 m", LightKind::Sphere { radius: 0.1 }),
        ("sphere 0.25 m", LightKind::Sphere { radius: 0.25 }),
        ("sun 1 degree", LightKind::Directional { angular_radius: 0.0175 }),
        ("sun 6 degrees", LightKind::Directional { angular_radius: 0.1 }),
    ];
    let mut device = renderer(&floor(LightKind::Point));
    for (name, kind) in kinds {
        let scene = floor(kind);
        let size = UVec2::new(60, 40);
        let error = apart(&live(&mut device, &scene, size, 16), &traced(&scene, size, 512));
        table += &format!("{name}: {:.2} %\n", 100.0 * error);
        worst = worst.max(error);
    }
    println!("{table}");
    assert!(worst <= SHADOWED, "mean error of the floor over {SHADOWED}\n{table}");
}

/// Lights that the eye sees, that leave the floor out, that only the matte base takes up, that nothing hides.
fn switches() {
    let mut scene = floor(LightKind::Sphere { radius: 0.12 });
    scene.materials[0].specular = 1.0;
    scene.materials[0].roughness = 0.4;
    scene.lights[0].position = Vec3::new(-0.3, 0.9, -0.2);
    let plain = scene.lights[0].clone();
    let lights = [
        ("seen", Light { camera: true, ..plain.clone() }),
        ("rectangle seen", Light { camera: true, shadows: false, ..rectangle() }),
        ("sun seen", Light { camera: true, direction: Vec3::new(0.1, -0.1, 1.0).normalize(), ..sun() }),
        ("not for the floor", Light { unlit: vec![0], ..plain.clone() }),
        ("not reflected", Light { reflections: false, ..plain.clone() }),
        ("point not reflected", Light { kind: LightKind::Point, reflections: false, ..plain.clone() }),
        ("without shadows", Light { shadows: false, ..plain }),
    ];
    // Low enough to see the lights over the edge of the floor.
    scene.cameras[0] = Camera::look_at("main", Vec3::new(0.0, 1.0, 2.2), Vec3::new(0.0, 0.4, 0.0), 0.9);
    let size = UVec2::new(60, 40);
    let mut table = String::new();
    let mut worst = 0.0_f64;
    let mut device = renderer(&scene);
    for (name, light) in lights {
        scene.lights = vec![light];
        let error = apart(&live(&mut device, &scene, size, 16), &traced(&scene, size, 1024));
        table += &format!("{name}: {:.2} %\n", 100.0 * error);
        worst = worst.max(error);
    }
    println!("{table}");
    assert!(worst <= SEEN, "mean error over {SEEN}\n{table}");
}

fn contributions() {
    let mut scene = gallery::open("ball?material=Cu&roughness=0.3").expect("a scene");
    let texels = (0..32 * 16).map(|i| Vec3::new(0.2, 0.3, 0.4) * (1.0 + (i % 32) as f32 / 8.0)).collect();
    scene.environment = Some(Arc::new(Environment::new("slope", 32, 16, texels)));
    // The ground and the shadows on it belong to the environment.
    let ground = Ground { middle: Vec3::new(0.0, -0.1, 0.0), height: 1.0, radius: 10.0, shadows: true };
    scene.background = Background { map: None, ground: Some(ground) };
    scene.materials[0].emission = Vec3::new(0.05, 0.1, 0.2);
    scene.materials[0].coat = 0.5;
    let sphere = aimed(|_| LightKind::Sphere { radius: 0.03 }, Vec3::new(-0.15, 0.1, 0.1), Vec3::splat(6.0));
    let lamp = aimed(|_| LightKind::Point, Vec3::new(0.5, 0.5, 0.5), Vec3::splat(0.5));
    scene.lights = vec![rectangle(), Light { camera: true, ..sphere }, lamp, sun()];
    let shown: Vec<_> = [Contribution::All].into_iter().chain(Contribution::each(scene.lights.len())).collect();
    let mut device = renderer(&scene);
    let mut of = |shown: &Contribution| {
        device.show(*shown);
        live(&mut device, &scene, UVec2::splat(64), 2)
    };
    let pictures: Vec<Picture> = shown.iter().map(&mut of).collect();
    let mut sum = vec![Vec4::ZERO; pictures[0].texels.len()];
    for picture in &pictures[1..] {
        assert!(picture.texels.iter().any(|texel| texel.truncate().max_element() > 1e-3), "a source shows nothing");
        sum.iter_mut().zip(&picture.texels).for_each(|(sum, texel)| *sum += *texel);
    }
    let mut worst = 0.0_f32;
    for (sum, all) in sum.iter().zip(&pictures[0].texels) {
        worst = worst.max(((*sum - *all).truncate().abs() / all.truncate().max(Vec3::splat(1e-2))).max_element());
    }
    println!("largest difference of a texel: {worst:e}");
    assert!(worst <= 1e-4, "texels differ by {worst}");
}

fn numbers() {
    let ball = 0.1;
    let rectangle = |size| move |across| LightKind::Rectangle { across, size };
    let sphere = |radius| move |_| LightKind::Sphere { radius };
    let one = Vec3::ONE;
    let lights = [
        aimed(rectangle(Vec2::ZERO), one, one),
        aimed(rectangle(Vec2::ONE), one, Vec3::ZERO),
        aimed(rectangle(Vec2::splat(0.3)), Vec3::Z * ball, one),
        aimed(rectangle(Vec2::splat(0.3)), Vec3::Z * 1e-4, one),
        aimed(sphere(0.0), one, one),
        aimed(sphere(1e-6), one, one),
        aimed(sphere(0.05), Vec3::Z * ball, one),
        aimed(sphere(10.0), Vec3::Z * ball, one),
        aimed(|_| LightKind::Directional { angular_radius: 1e-3 }, one, one),
        aimed(|_| LightKind::Directional { angular_radius: 1.5 }, one, one),
    ];
    let mut scene = gallery::open("ball?material=Ag&roughness=0").expect("a scene");
    scene.environment = black();
    scene.materials[0].coat = 0.5;
    let mut device = renderer(&scene);
    for camera in [false, true] {
        scene.lights = lights.iter().map(|light| Light { camera, ..light.clone() }).collect();
        let picture = live(&mut device, &scene, UVec2::splat(32), 2);
        assert!(picture.texels.iter().all(|texel| texel.is_finite() && texel.min_element() >= 0.0));
    }
}
