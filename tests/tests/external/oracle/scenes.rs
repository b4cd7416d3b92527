//! Scenes that both renderers draw alike: metals of one index per channel, matte surfaces without a reflection, meshes so
//! fine that shading normals hardly differ from the faces.

use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use burnish_core::material::{AlphaMode, Filter, Material, Reflectance, Sampler, TextureRef, preset};
use burnish_core::scene::gallery::shape;
use burnish_core::scene::{Environment, LightKind, Mesh, Scene};
use burnish_core::surface::fresnel::Form;
use burnish_tests::scenes::stage::{Stage, texture};
use glam::{Affine3A, Quat, Vec3};

/// A scene by name, with how many paths a pixel of a batch takes.
pub struct Entry {
    pub name: &'static str,
    pub build: fn() -> Scene,
    pub samples: u32,
}

/// All of them.
pub const ALL: &[Entry] = &[
    Entry { name: "gold ball under a sky", build: gold_ball, samples: 48 },
    Entry { name: "three balls in a box", build: three_balls, samples: 96 },
    Entry { name: "brushed copper", build: brushed_copper, samples: 48 },
    Entry { name: "mirror and chromium under lamps", build: lamps, samples: 48 },
    // Rare bright paths: means of few are not normal, and more than 0.3 % of them lie beyond three deviations.
    Entry { name: "closed metal room", build: metal_room, samples: 256 },
    Entry { name: "textured roughness and base colours", build: textured, samples: 48 },
    Entry { name: "panes, holes and both sides", build: openings, samples: 64 },
];

/// A metal of a preset, in the form that both renderers evaluate.
pub fn metal(id: &str, roughness: f32) -> Material {
    let fresnel = preset::find(id).expect("a preset").fresnel(Form::EffectiveNk);
    let reflectance = Reflectance::Preset { id: id.into(), fresnel: Arc::new(fresnel) };
    Material { reflectance, roughness, ..Material::default() }
}

/// Paint without a reflection.
fn matte(base_color: Vec3) -> Material {
    Material { base_color, specular: 0.0, double_sided: true, ..Material::default() }
}

/// A ball whose triangles are far smaller than its pixels.
pub fn ball(radius: f32) -> Mesh {
    shape::sphere(radius, 192)
}

/// A sky with a horizon, two windows of light and a small sun; no two quarters are alike.
pub fn sky() -> Arc<Environment> {
    let (width, height) = (96, 48);
    let texel = |i: u32| {
        let (x, y) = ((i % width) as f32 + 0.5, (i / width) as f32 + 0.5);
        let up = (PI * y / height as f32).cos();
        let mut color = Vec3::new(0.25, 0.3, 0.4) + 0.3 * up * Vec3::new(0.4, 0.7, 1.0);
        if up < 0.0 {
            color = Vec3::new(0.2, 0.17, 0.13);
        }
        if (18.0..30.0).contains(&x) && (8.0..16.0).contains(&y) {
            color = Vec3::new(6.0, 5.5, 5.0);
        }
        if (60.0..64.0).contains(&x) && (4.0..22.0).contains(&y) {
            color = Vec3::new(4.0, 6.0, 9.0);
        }
        if (80.0..82.0).contains(&x) && (12.0..14.0).contains(&y) {
            color = Vec3::new(160.0, 140.0, 110.0);
        }
        color
    };
    let map = Environment::new("sky", width, height, (0..width * height).map(texel).collect());
    Arc::new(Environment { rotation: 0.7, strength: 0.8, ..map })
}

/// Faces up, its middle at a height.
fn ground(stage: &mut Stage, side: f32, height: f32, color: Vec3) {
    let material = stage.material(matte(color));
    let lying = Affine3A::from_rotation_translation(Quat::from_rotation_x(-FRAC_PI_2), height * Vec3::Y);
    stage.put(shape::plane(side, side), material, lying);
}

fn at(x: f32, y: f32, z: f32) -> Affine3A {
    Affine3A::from_translation(Vec3::new(x, y, z))
}

fn under(mut scene: Scene, environment: Option<Arc<Environment>>) -> Scene {
    scene.environment = environment;
    scene
}

pub fn gold_ball() -> Scene {
    let mut stage = Stage::new("gold ball");
    ground(&mut stage, 2.0, 0.0, Vec3::new(0.5, 0.45, 0.4));
    let gold = stage.material(metal("Au", 0.3));
    stage.put(ball(0.3), gold, at(0.0, 0.3, 0.0));
    under(stage.finish_towards(Vec3::new(0.4, 0.7, 1.5), 0.3 * Vec3::Y, 0.6), Some(sky()))
}

/// The inside of a box of matte or other walls, seen from its open front; `panel` shines downwards.
fn room(stage: &mut Stage, walls: [Material; 4], panel: Vec3) {
    let [floor, ceiling, left, right] = walls.map(|material| stage.material(material));
    let back = stage.material(matte(Vec3::splat(0.6)));
    let side = stage.mesh(shape::plane(2.0, 2.0));
    let turned = |rotation: Quat, place: Vec3| Affine3A::from_rotation_translation(rotation, place);
    stage.place(side, floor, turned(Quat::from_rotation_x(-FRAC_PI_2), Vec3::NEG_Y));
    stage.place(side, ceiling, turned(Quat::from_rotation_x(FRAC_PI_2), Vec3::Y));
    stage.place(side, left, turned(Quat::from_rotation_y(FRAC_PI_2), Vec3::NEG_X));
    stage.place(side, right, turned(Quat::from_rotation_y(-FRAC_PI_2), Vec3::X));
    stage.place(side, back, at(0.0, 0.0, -1.0));
    let lamp = stage.material(Material { emission: panel, ..Material { double_sided: false, ..matte(Vec3::ZERO) } });
    stage.put(shape::plane(1.2, 1.2), lamp, turned(Quat::from_rotation_x(FRAC_PI_2), Vec3::new(0.0, 0.98, 0.0)));
}

pub fn three_balls() -> Scene {
    let mut stage = Stage::new("three balls");
    let (white, red, green) = (Vec3::splat(0.7), Vec3::new(0.6, 0.12, 0.1), Vec3::new(0.15, 0.5, 0.2));
    room(&mut stage, [white, white, red, green].map(matte), Vec3::new(5.0, 4.6, 4.0));
    let body = stage.mesh(ball(0.3));
    for (id, roughness, x) in [("Au", 0.05, -0.62), ("Cu", 0.2, 0.0), ("Al", 0.5, 0.62)] {
        let material = stage.material(metal(id, roughness));
        stage.place(body, material, at(x, -0.7, 0.0));
    }
    under(stage.finish_towards(Vec3::new(0.0, 0.0, 4.2), Vec3::ZERO, 0.5), None)
}

/// The scene that costs are measured on.
pub fn three_balls_under_a_sky() -> Scene {
    let mut stage = Stage::new("three balls under a sky");
    ground(&mut stage, 4.0, 0.0, Vec3::splat(0.5));
    let body = stage.mesh(ball(0.3));
    for (id, roughness, x) in [("Au", 0.1, -0.65), ("Cu", 0.3, 0.0), ("Al", 0.5, 0.65)] {
        let material = stage.material(metal(id, roughness));
        stage.place(body, material, at(x, 0.3, 0.0));
    }
    stage.finish_towards(Vec3::new(0.0, 0.9, 2.4), 0.25 * Vec3::Y, 0.5)
}

pub fn brushed_copper() -> Scene {
    let mut stage = Stage::new("brushed copper");
    let copper = Material { anisotropy: 0.7, ..metal("Cu", 0.3) };
    let turned = Material { anisotropy: 0.8, anisotropy_rotation: 0.6, ..metal("Cu", 0.25) };
    let (copper, turned) = (stage.material(copper), stage.material(turned));
    stage.put(ball(0.3), copper, at(-0.35, 0.0, 0.0));
    stage.put(ball(0.3), turned, at(0.35, 0.0, 0.0) * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
    let base = Material {
        anisotropy: 0.6,
        base_color: Vec3::new(0.9, 0.6, 0.4),
        metallic: 1.0,
        roughness: 0.4,
        ..Material::default()
    };
    let base = stage.material(base);
    stage.put(shape::disc(0.9, 256, 48), base, at(0.0, -0.3, 0.0));
    under(stage.finish_towards(Vec3::new(0.3, 0.8, 2.0), Vec3::new(0.0, -0.1, 0.0), 0.55), Some(sky()))
}

pub fn lamps() -> Scene {
    let mut stage = Stage::new("lamps");
    ground(&mut stage, 3.0, 0.0, Vec3::splat(0.6));
    let (mirror, chromium) = (stage.material(metal("Ag", 0.0)), stage.material(metal("Cr", 0.45)));
    let body = stage.mesh(ball(0.3));
    stage.place(body, mirror, at(-0.35, 0.3, 0.0));
    stage.place(body, chromium, at(0.35, 0.3, 0.1));
    stage.light(LightKind::Point, Vec3::new(-0.9, 1.2, 0.9), Vec3::NEG_Y, Vec3::new(2.0, 1.6, 1.2));
    let spot = LightKind::Spot { inner_angle: 0.25, outer_angle: 0.5 };
    stage.light(spot, Vec3::new(0.9, 1.5, 0.6), Vec3::new(-0.55, -1.2, -0.5), Vec3::new(2.0, 4.0, 6.0));
    stage.sun(Vec3::new(0.3, -1.0, -0.6), 0.4);
    let scene = stage.finish_towards(Vec3::new(0.0, 0.8, 2.0), 0.25 * Vec3::Y, 0.6);
    let dim = Environment { strength: 0.15, ..Environment::clone(&sky()) };
    under(scene, Some(Arc::new(dim)))
}

pub fn metal_room() -> Scene {
    let mut stage = Stage::new("metal room");
    let two_sided = |material: Material| Material { double_sided: true, ..material };
    let walls = [metal("Al", 0.4), matte(Vec3::splat(0.5)), metal("Au", 0.6), metal("Cu", 0.5)];
    room(&mut stage, walls.map(two_sided), Vec3::splat(4.0));
    let front = stage.material(two_sided(metal("Cr", 0.5)));
    let facing = Affine3A::from_rotation_translation(Quat::from_rotation_y(PI), Vec3::Z);
    stage.put(shape::plane(2.0, 2.0), front, facing);
    let iron = stage.material(metal("Fe", 0.35));
    stage.put(ball(0.35), iron, at(0.2, -0.6, -0.2));
    under(stage.finish_towards(Vec3::new(-0.5, 0.1, 0.9), Vec3::new(0.2, -0.4, -0.6), 1.3), None)
}

pub fn textured() -> Scene {
    let mut stage = Stage::new("textured");
    ground(&mut stage, 2.4, -0.3, Vec3::splat(0.4));
    // Smooth and of many texels: Mitsuba interpolates the width of a conductor, we the roughness.
    let wave = |t: u32, turns: f32| 0.5 + 0.4 * (2.0 * PI * turns * (t as f32 + 0.5) / 256.0).sin();
    let level = |v: f32| (255.0 * v).round() as u8;
    let rough = stage.image("rough", 256, |x, y| [0, level(wave(x, 4.0) * wave(y, 2.0) + 0.15), 255, 255]);
    let colors = stage.image("colors", 256, |x, y| [level(wave(x, 3.0)), level(wave(y, 5.0)), 200, 255]);
    let silver = Material { metallic_roughness_texture: Some(texture(rough)), ..metal("Ag", 0.9) };
    let painted = Material {
        base_color: Vec3::new(1.0, 0.8, 0.9),
        base_color_texture: Some(texture(colors)),
        metallic_roughness_texture: Some(texture(rough)),
        metallic: 1.0,
        roughness: 0.8,
        ..Material::default()
    };
    let sheet = Material { base_color_texture: Some(texture(colors)), ..matte(Vec3::ONE) };
    let [silver, painted, sheet] = [silver, painted, sheet].map(|material| stage.material(material));
    let body = stage.mesh(ball(0.3));
    stage.place(body, silver, at(-0.35, 0.0, 0.1));
    stage.place(body, painted, at(0.35, 0.0, 0.1));
    stage.put(shape::plane(1.6, 0.8), sheet, at(0.0, 0.1, -0.5));
    under(stage.finish_towards(Vec3::new(0.0, 0.5, 1.9), Vec3::ZERO, 0.6), Some(sky()))
}

pub fn openings() -> Scene {
    let mut stage = Stage::new("openings");
    ground(&mut stage, 2.4, -0.3, Vec3::splat(0.5));
    let holes = stage.image("holes", 8, |x, y| [255, 255, 255, if (x + y) % 2 == 0 { 255 } else { 0 }]);
    let nearest = Sampler { magnify: Filter::Nearest, minify: Filter::Nearest, ..Sampler::default() };
    let grid = Material {
        base_color_texture: Some(TextureRef { sampler: nearest, ..texture(holes) }),
        alpha_mode: AlphaMode::Mask { cutoff: 0.5 },
        ..matte(Vec3::new(0.7, 0.6, 0.2))
    };
    let pane = Material { alpha_mode: AlphaMode::Blend, opacity: 0.35, ..matte(Vec3::new(0.2, 0.4, 0.8)) };
    let both = Material { double_sided: true, ..metal("Cu", 0.4) };
    let [grid, pane, both] = [grid, pane, both].map(|material| stage.material(material));
    stage.put(shape::plane(0.7, 0.6), grid, at(-0.45, 0.0, 0.2) * Affine3A::from_rotation_y(0.4));
    stage.put(shape::plane(0.7, 0.6), pane, at(0.45, 0.0, 0.2) * Affine3A::from_rotation_y(-0.3));
    stage.put(shape::plane(0.8, 0.5), both, at(0.0, 0.0, -0.3) * Affine3A::from_rotation_y(2.6));
    let gold = stage.material(metal("Au", 0.4));
    stage.put(ball(0.15), gold, at(-0.4, -0.15, -0.1));
    stage.light(LightKind::Point, Vec3::new(-0.3, 1.0, 1.0), Vec3::NEG_Y, Vec3::splat(1.5));
    under(stage.finish_towards(Vec3::new(0.0, 0.5, 1.9), Vec3::ZERO, 0.6), Some(sky()))
}
