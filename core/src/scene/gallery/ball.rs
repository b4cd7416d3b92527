//! A ball alone: what the light from far away makes of a metal, and nothing else.
//!
//! The body is convex and nothing stands around it, so that the environment is all there is: a method that is right
//! about far light is right here, up to its approximation of the reflection.

use glam::{Affine3A, Vec3};

use super::{
    GalleryScene,
    parts::{add_material, add_subject, material_param, roughness_param, subject_material},
    shape,
};
use crate::{
    param::{ParamSpec, Settings},
    scene::{Camera, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene =
    GalleryScene { name: "ball", title: "A ball of metal alone under the environment", params: PARAMS, build };

const PARAMS: &[ParamSpec] = &[material_param("Au"), roughness_param(0.3)];

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    add_subject(&mut scene, "ball", shape::sphere(0.1, 160), material, Affine3A::IDENTITY);
    scene.cameras.push(Camera::look_at("main", Vec3::new(0.0, 0.08, 0.6), Vec3::ZERO, 0.4));
    scene
}
