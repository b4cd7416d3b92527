//! The mirror room with a matt ball that stands free: reflections pass its silhouette.
//!
//! The distance to the surroundings jumps at the ball's outline as the probe sees it. Methods that search in that
//! distance shift the outline, tear the wall behind it or invent a surface between the two.

use glam::{Affine3A, Vec3};

use super::{
    GalleryScene,
    parts::{add, add_material, material_param, paint, roughness_param, subject_material, vector},
    room::{self, BODY, RADIUS},
    shape,
};
use crate::{
    param::{ParamSpec, Settings},
    scene::{Camera, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene = GalleryScene {
    name: "box-sphere",
    title: "A mirror in a closed room and a matt ball that stands free beside it",
    params: PARAMS,
    build,
};

const PARAMS: &[ParamSpec] = &[BODY, material_param("Ag"), roughness_param(0.0), room::at_param([0.3, -0.2, -0.3])];

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    room::add_body(&mut scene, settings, material, RADIUS, vector(settings, "at"));
    room::add_numbered(&mut scene);
    let chalk = add_material(&mut scene, paint("ball", Vec3::new(0.72, 0.7, 0.66)));
    let (middle, radius) = (Vec3::new(-0.36, -0.3, -0.16), 0.17);
    add(&mut scene, "free ball", shape::sphere(radius, 80), chalk, Affine3A::from_translation(middle));
    // A rod from inside of the ball into the floor.
    let height = middle.y - 0.5 * radius + 1.02;
    let rod = shape::cylinder(0.014, height, 0.003, 24);
    let steel = add_material(&mut scene, paint("rod", Vec3::splat(0.2)));
    let standing = Vec3::new(middle.x, -1.02 + 0.5 * height, middle.z);
    add(&mut scene, "rod", rod, steel, Affine3A::from_translation(standing));
    room::add_lamp(&mut scene);
    scene.cameras.push(Camera::look_at("main", Vec3::new(-0.56, 0.14, 0.92), Vec3::new(0.06, -0.24, -0.25), 0.84));
    scene
}
