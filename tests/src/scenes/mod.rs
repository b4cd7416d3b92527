//! Small scenes for image snapshots. Each shows one part of the material or light model side by side, has a camera
//! `main` and stays below 20 000 triangles.

mod lights_and_alpha;
pub mod stage;

use std::sync::Arc;

use burnish_core::{
    material::Material,
    scene::{
        Camera, Environment, Scene,
        gallery::shape::{self, Profile},
    },
    surface::micro_normal,
};
use glam::{Affine3A, EulerRot, Quat, Vec2, Vec3};

pub use lights_and_alpha::lights_and_alpha;
use stage::{Stage, metal, texture};

/// A scene with its name.
pub type Entry = (&'static str, fn() -> Scene);

/// All of them. Snapshot tests loop over this list.
pub const ALL: &[Entry] = &[
    ("roughness_row", roughness_row),
    ("anisotropy", anisotropy),
    ("layers", layers),
    ("bumps", bumps),
    ("lights_and_alpha", lights_and_alpha),
];

/// Base colours of gold, silver and copper, linear Rec.709: close to their reflectance at normal incidence.
const GOLD: Vec3 = Vec3::new(1.0, 0.75, 0.34);
const SILVER: Vec3 = Vec3::new(0.96, 0.95, 0.92);
const COPPER: Vec3 = Vec3::new(0.93, 0.62, 0.50);

/// Radius of the balls; metres between the middles of neighbours.
const BALL: f32 = 0.09;
const STEP: f32 = 0.2;

/// Balls of gold, silver and copper from top to bottom, roughness 0 to 1 from left to right.
pub fn roughness_row() -> Scene {
    let mut stage = Stage::new("roughness_row");
    let ball = stage.mesh(shape::sphere(BALL, 28));
    for (row, color) in [GOLD, SILVER, COPPER].into_iter().enumerate() {
        for column in 0..7 {
            let material = stage.material(metal(color, column as f32 / 6.0));
            stage.place(ball, material, cell(column, 7, row, 3));
        }
    }
    stage.finish(Vec3::new(0.0, 0.1, 2.1), 0.4)
}

/// Brushed metal: discs and balls of growing strength, then balls of one strength whose brushing turns.
pub fn anisotropy() -> Scene {
    let mut stage = Stage::new("anisotropy");
    let ball = stage.mesh(shape::sphere(BALL, 28));
    let disc = stage.mesh(shape::disc(BALL, 64, 3));
    let facing = Affine3A::from_rotation_x(1.2);
    for column in 0..5 {
        let step = column as f32 / 4.0;
        let strength = stage.material(Material { anisotropy: step, ..metal(SILVER, 0.25) });
        stage.place(disc, strength, cell(column, 5, 0, 3) * facing);
        stage.place(ball, strength, cell(column, 5, 1, 3));
        let rotation = step * std::f32::consts::FRAC_PI_2;
        let turned = stage.material(Material { anisotropy: 0.8, anisotropy_rotation: rotation, ..metal(COPPER, 0.2) });
        stage.place(ball, turned, cell(column, 5, 2, 3));
    }
    stage.sun(Vec3::new(-0.4, -0.7, -0.6), 2.0);
    stage.finish(Vec3::new(0.0, 0.1, 2.1), 0.34)
}

/// Balls with bumps. From the top: hammered, cast and grain under dents of growing size, bare in the first row, at half of
/// the scale in the second, under a coat in the third. The last column turns and is mirrored.
pub fn bumps() -> Scene {
    let mut stage = Stage::new("bumps");
    let ball = stage.mesh(shape::sphere(BALL, 28));
    let kinds =
        [(micro_normal::Kind::Hammered, 0.15), (micro_normal::Kind::Cast, 0.3), (micro_normal::Kind::Grain, 0.3)];
    for (row, (micro_normal, micro_depth)) in kinds.into_iter().enumerate() {
        let plain = Material { micro_normal, micro_depth, ..metal(COPPER, 0.2) };
        // Resolved, half resolved, too fine for a pixel.
        for (column, micro_size_mm) in [30.0, 8.0, 2.0].into_iter().enumerate() {
            let material = stage.material(Material { micro_size_mm, ..plain.clone() });
            stage.place(ball, material, cell(column, 6, row, 3));
        }
        let large = Material { micro_size_mm: 30.0, ..plain };
        let coated = stage.material(Material { coat: 1.0, coat_roughness: 0.05, ..large.clone() });
        stage.place(ball, coated, cell(3, 6, row, 3));
        let bare = stage.material(large);
        let turned = Affine3A::from_quat(Quat::from_euler(EulerRot::XYZ, 0.5, 1.0, 1.5));
        stage.place(ball, bare, cell(4, 6, row, 3) * turned);
        stage.place(ball, bare, cell(5, 6, row, 3) * Affine3A::from_scale(Vec3::new(-0.5, 0.5, 0.5)));
    }
    stage.sun(Vec3::new(-0.4, -0.7, -0.6), 2.0);
    stage.finish(Vec3::new(0.0, 0.1, 2.1), 0.34)
}

/// Coats, dielectrics, emission, occlusion, unlit surfaces, vertex colours, and one body beside its mirror image.
pub fn layers() -> Scene {
    let mut stage = Stage::new("layers");
    let stripes = stage.image("stripes", 64, |x, _| if x / 8 % 2 == 0 { [255; 4] } else { [40; 4] });
    let paint = |base_color: Vec3| Material { base_color, roughness: 0.5, ..Material::default() };
    let red = Vec3::new(0.5, 0.04, 0.03);
    let coated = Material { coat: 1.0, coat_roughness: 0.05, ..metal(red, 0.5) };
    let black = Material { roughness: 0.15, ..paint(Vec3::splat(0.02)) };
    let ball = stage.mesh(shape::sphere(BALL, 28));
    let materials = [
        coated.clone(),
        Material { coat_roughness: 0.4, ..coated.clone() },
        Material { coat_texture: Some(texture(stripes)), ..coated },
        Material { coat: 1.0, ..paint(Vec3::new(0.03, 0.12, 0.3)) },
        paint(Vec3::new(0.6, 0.58, 0.55)),
        black.clone(),
        Material { ior: 2.4, ..black.clone() },
        Material { specular: 0.0, ..black.clone() },
        Material { specular_color: Vec3::new(1.0, 0.3, 0.1), ior: 2.4, ..black.clone() },
        Material { metallic: 0.5, ..paint(GOLD) },
        Material { emission: Vec3::new(1.5, 0.9, 0.4), emission_texture: Some(texture(stripes)), ..black.clone() },
        Material { occlusion_texture: Some(texture(stripes)), ..metal(SILVER, 0.3) },
        Material { unlit: true, ..paint(Vec3::new(0.2, 0.5, 0.25)) },
    ];
    for (i, material) in materials.into_iter().enumerate() {
        let material = stage.material(material);
        stage.place(ball, material, cell(i % 5, 5, i / 5, 4));
    }
    let white = stage.material(paint(Vec3::ONE));
    let colours = stage.mesh(rainbow());
    stage.place(colours, white, cell(3, 5, 2, 4));

    // Alpha of the stripes is the strength of the reflection.
    let glossy = stage.material(Material { specular_texture: Some(texture(stripes)), ior: 2.4, ..black });
    stage.place(ball, glossy, cell(4, 5, 2, 4));

    // The mirrored body must keep its fronts, its shading and the sense of its brushing, mirrored.
    let brushed = stage.material(Material {
        anisotropy: 0.8,
        anisotropy_rotation: 0.6,
        base_color_texture: Some(texture(stripes)),
        ..metal(GOLD, 0.25)
    });
    let hook = stage.mesh(hook());
    stage.place(hook, brushed, cell(1, 5, 3, 4));
    stage.place(hook, brushed, cell(3, 5, 3, 4) * Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
    stage.sun(Vec3::new(-0.4, -0.7, -0.6), 1.5);
    stage.finish(Vec3::new(0.0, 0.1, 2.3), 0.37)
}

/// A square that fills the view of a camera in front and of one behind. Its normal is bent by a normal map or, the same
/// way, in the mesh.
pub fn bent_square(mapped: bool) -> Scene {
    let mut stage = Stage::new("bent_square");
    let bent = [200, 160, 220, 255];
    let map = stage.image("bent", 1, |_, _| bent);
    let mut square = shape::plane(2.0, 2.0);
    let mut material = Material { double_sided: true, ..metal(SILVER, 0.3) };
    if mapped {
        material.normal_texture = Some(texture(map));
    } else {
        let normal = Vec3::from_array([0, 1, 2].map(|i| f32::from(bent[i]) / 127.5 - 1.0)).normalize();
        square.normals.fill(normal);
        square.tangents.fill(normal.cross(Vec3::X).normalize().extend(1.0));
    }
    let material = stage.material(material);
    stage.put(square, material, Affine3A::IDENTITY);
    let mut scene = stage.finish(Vec3::new(0.3, 0.4, 3.0), 0.3);
    scene.environment = Some(sky());
    scene.cameras.push(Camera::look_at("behind", Vec3::new(0.3, 0.4, -3.0), Vec3::ZERO, 0.3));
    scene
}

/// A square that fills the view, under a sky without two directions alike.
pub fn plate(material: Material) -> Scene {
    let mut stage = Stage::new("plate");
    let material = stage.material(material);
    stage.put(shape::plane(2.0, 2.0), material, Affine3A::IDENTITY);
    let mut scene = stage.finish(Vec3::new(0.3, 0.4, 3.0), 0.3);
    scene.environment = Some(sky());
    scene
}

/// No two directions are alike, and the map is small: it is quick to filter.
fn sky() -> Arc<Environment> {
    let texels = (0..16 * 8).map(|i| Vec3::new((i % 16) as f32, (i / 16) as f32, 4.0)).collect();
    Arc::new(Environment::new("sky", 16, 8, texels))
}

/// A ball whose vertices are coloured by their normals.
fn rainbow() -> burnish_core::scene::Mesh {
    let mut mesh = shape::sphere(BALL, 28);
    mesh.colors = mesh.normals.iter().map(|n| (0.5 + 0.5 * *n).extend(1.0)).collect();
    mesh
}

/// A body that differs from its mirror image: most of a ring with a block at one end.
fn hook() -> burnish_core::scene::Mesh {
    let circle = Profile::new().arc(Vec2::new(0.065, 0.0), 0.024, 0.0, -std::f32::consts::TAU, 18).closed();
    let ring = shape::sweep("ring", &circle, [0.4, 4.6], 28, 0.008);
    let block = shape::block(Vec3::new(0.05, 0.06, 0.07), 0.008, 2);
    let at_end = Affine3A::from_translation(Vec3::new(-0.06, 0.0, 0.04));
    let lying = shape::combined("hook", [ring, shape::transformed(block, &at_end)]);
    shape::transformed(lying, &Affine3A::from_quat(Quat::from_rotation_x(1.1)))
}

/// Middle of a cell in a grid that faces the camera, row 0 on top.
fn cell(column: usize, columns: usize, row: usize, rows: usize) -> Affine3A {
    let centered = |i: usize, count: usize| i as f32 - 0.5 * (count as f32 - 1.0);
    Affine3A::from_translation(STEP * Vec3::new(centered(column, columns), -centered(row, rows), 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_main_camera_light_and_few_triangles() {
        assert!(!ALL.is_empty());
        for (name, build) in ALL {
            let scene = build();
            assert_eq!(scene.name, *name);
            assert_eq!(scene.cameras.iter().filter(|c| c.name == "main").count(), 1, "{name}");
            assert!(scene.environment.is_some() || !scene.lights.is_empty(), "{name}");
            assert!((100..20_000).contains(&scene.triangle_count()), "{name}: {}", scene.triangle_count());
            assert_eq!(scene.validate(), Ok(()), "{name}");
        }
    }
}
