//! A ring on a table: its inside reflects itself again and again and throws a caustic on the table.
//!
//! Methods that know far light only miss the second reflection inside the ring, the table in its side and its shadow.

use glam::{Affine3A, Vec2, Vec3};

use super::{
    GalleryScene,
    parts::{add, add_material, add_subject, in_metres, material_param, roughness_param, subject_material},
    pattern,
    shape::{self, Profile},
};
use crate::{
    material::Material,
    param::{ParamSpec, Settings},
    scene::{Camera, Mesh, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene =
    GalleryScene { name: "ring", title: "A ring of metal on a table under the environment", params: PARAMS, build };

const PARAMS: &[ParamSpec] = &[material_param("Au"), roughness_param(0.12)];

/// Of the inside, metres: a ring ten times as large as one for a finger.
const RADIUS: f32 = 0.09;
/// Of the band.
const HEIGHT: f32 = 0.056;
const THICKNESS: f32 = 0.014;

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    let standing = Affine3A::from_translation(Vec3::new(0.0, 0.5 * HEIGHT + 1e-4, 0.0));
    add_subject(&mut scene, "ring", band(), material, standing);
    let tiles = pattern::checker(2, [Vec3::new(0.36, 0.3, 0.25), Vec3::new(0.27, 0.225, 0.19)]);
    let tiles = in_metres(&mut scene, tiles, Vec2::splat(0.16), Vec2::ZERO);
    let table =
        Material { name: "table".into(), base_color_texture: Some(tiles), roughness: 0.6, ..Material::default() };
    let table = add_material(&mut scene, table);
    let top = shape::block(Vec3::new(3.2, 0.05, 3.2), 0.0, 1);
    add(&mut scene, "table", top, table, Affine3A::from_translation(Vec3::new(0.0, -0.025, 0.0)));
    let eye = Vec3::new(0.1, 0.33, 0.52);
    scene.cameras.push(Camera::look_at("main", eye, Vec3::new(0.0, 0.012, 0.012), 0.42));
    scene
}

/// A band, flat inside, rounded outside and at the rims.
fn band() -> Mesh {
    use std::f32::consts::{FRAC_PI_2, PI};
    let (half, rim) = (0.5 * HEIGHT, 0.35 * THICKNESS);
    // The outside is an arc of a large circle that meets the rims without a crease.
    let bulge = 0.12_f32;
    let large = (half - rim) / bulge.sin() + rim;
    let outer = RADIUS + THICKNESS - large;
    let at = Vec2::new(outer, 0.0) + (large - rim) * Vec2::from_angle(bulge);
    let low = Vec2::new(at.x, -at.y);
    let inner = RADIUS + rim;
    let profile = Profile::new()
        .arc(Vec2::new(outer, 0.0), large, bulge, -bulge, 12)
        .arc(low, rim, -bulge, -FRAC_PI_2, 6)
        .arc(Vec2::new(inner, low.y), rim, -FRAC_PI_2, -PI, 6)
        .line(Vec2::new(RADIUS, at.y), 4)
        .arc(Vec2::new(inner, at.y), rim, PI, FRAC_PI_2, 6)
        .arc(at, rim, FRAC_PI_2, bulge, 6)
        .closed();
    shape::revolve("ring", &profile, 144)
}
