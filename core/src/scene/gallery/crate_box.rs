//! The mirror room with an open checkered crate beside the mirror: surroundings that are concave and hide themselves.
//!
//! Searches along the reflected ray meet the crate's rim first in one map and its inside in another; the corners of the
//! crate are where they stop too early, and what the probe does not see of the inside they smear.

use glam::{Affine3A, Quat, Vec2, Vec3};

use super::{
    GalleryScene,
    parts::{add, add_material, in_metres, material_param, paint, roughness_param, subject_material, vector},
    pattern,
    room::{self, BODY, RADIUS},
    shape,
};
use crate::{
    material::Material,
    param::{ParamSpec, Settings},
    scene::{Camera, Mesh, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene = GalleryScene {
    name: "crate",
    title: "A mirror beside an open checkered crate in a closed room",
    params: PARAMS,
    build,
};

const PARAMS: &[ParamSpec] = &[BODY, material_param("Ag"), roughness_param(0.0), room::at_param([-0.24, -0.42, -0.12])];

/// Outside of the crate, its open side up, and its boards.
const SIZE: Vec3 = Vec3::new(0.72, 0.62, 0.6);
const BOARD: f32 = 0.03;

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    room::add_body(&mut scene, settings, material, RADIUS, vector(settings, "at"));
    room::add_numbered(&mut scene);
    let squares = pattern::checker(2, [Vec3::new(0.72, 0.6, 0.42), Vec3::new(0.1, 0.06, 0.035)]);
    let squares = in_metres(&mut scene, squares, Vec2::splat(0.2), Vec2::ZERO);
    let wood = Material { base_color_texture: Some(squares), roughness: 0.6, ..paint("crate", Vec3::ONE) };
    let wood = add_material(&mut scene, wood);
    // On its side, the opening towards the body.
    let lying = Quat::from_rotation_y(0.42) * Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let placed = Affine3A::from_rotation_translation(lying, Vec3::new(0.44, -0.998 + 0.5 * SIZE.x, -0.38));
    add(&mut scene, "crate", boards(), wood, placed);
    room::add_lamp(&mut scene);
    scene.cameras.push(Camera::look_at("main", Vec3::new(-0.62, 0.1, 0.9), Vec3::new(0.08, -0.46, -0.25), 0.8));
    scene
}

/// Bottom and four sides. The sides reach into the bottom, the long ones between the short ones.
fn boards() -> Mesh {
    let half = 0.5 * SIZE;
    let board = |size: Vec3, x: f32, y: f32, z: f32| {
        shape::transformed(shape::block(size, 0.004, 1), &Affine3A::from_translation(Vec3::new(x, y, z)))
    };
    let long = Vec3::new(SIZE.x - BOARD, SIZE.y - 0.4 * BOARD, BOARD);
    let short = Vec3::new(BOARD, SIZE.y - 0.7 * BOARD, SIZE.z - 0.2 * BOARD);
    let (x, z) = (half.x - 0.6 * BOARD, half.z - 0.5 * BOARD);
    let parts = [
        board(Vec3::new(SIZE.x - 0.5 * BOARD, BOARD, SIZE.z - 0.5 * BOARD), 0.0, 0.5 * BOARD - half.y, 0.0),
        board(long, 0.0, 0.2 * BOARD, z),
        board(long, 0.0, 0.2 * BOARD, -z),
        board(short, x, 0.35 * BOARD, 0.0),
        board(short, -x, 0.35 * BOARD, 0.0),
    ];
    shape::combined("crate", parts)
}
