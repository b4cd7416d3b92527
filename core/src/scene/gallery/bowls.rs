//! Goblets and bowls on a polished table: glossy things that reflect glossy things.
//!
//! Much of what they reflect is off the screen or hidden from the camera, the insides of the bowls above all; methods
//! that look for it in the picture find the wrong thing or nothing at the outlines.

use glam::{Affine3A, Vec3};

use super::{
    GalleryScene, number,
    parts::{add, add_material, add_subject, choice_param, metal, roughness_param},
    shape,
};
use crate::{
    material::Material,
    param::{ParamSpec, Settings},
    scene::{Camera, Mesh, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene = GalleryScene {
    name: "bowls",
    title: "Goblets and bowls on a polished table under the environment",
    params: PARAMS,
    build,
};

const PARAMS: &[ParamSpec] = &[
    roughness_param(0.18),
    choice_param("metals", "Metals", &["mixed", "silver", "gold"], "Silver, gold and copper, or one for all."),
];

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let roughness = number(settings, "roughness");
    let ids = match settings.text("metals").as_deref() {
        Some("silver") => ["Ag"; 3],
        Some("gold") => ["Au"; 3],
        _ => ["Ag", "Au", "Cu"],
    };
    let named = [("first", ids[0]), ("second", ids[1]), ("third", ids[2])];
    let [silver, gold, copper] = named.map(|(name, id)| add_material(&mut scene, metal(name, id, roughness)));
    let mut stand = |name: &str, mesh: Mesh, material: usize, x: f32, z: f32| {
        add_subject(&mut scene, name, mesh, material, Affine3A::from_translation(Vec3::new(x, 1e-4, z)));
    };
    stand("goblet-left", shape::goblet(0.2, 96), silver, -0.15, -0.03);
    stand("goblet-right", shape::goblet(0.17, 96), gold, 0.175, -0.075);
    stand("bowl-wide", shape::bowl(0.1, 96), copper, 0.03, 0.02);
    stand("bowl-small", shape::bowl(0.055, 72), gold, -0.095, 0.115);
    stand("bowl-back", shape::bowl(0.07, 72), silver, 0.18, 0.1);
    let table = Material {
        name: "table".into(),
        base_color: Vec3::new(0.035, 0.028, 0.025),
        roughness: 0.14,
        ..Material::default()
    };
    let table = add_material(&mut scene, table);
    let top = shape::block(Vec3::new(3.0, 0.04, 3.0), 0.0, 1);
    add(&mut scene, "table", top, table, Affine3A::from_translation(Vec3::new(0.0, -0.02, 0.0)));
    scene.cameras.push(Camera::look_at("main", Vec3::new(0.03, 0.38, 0.74), Vec3::new(0.012, 0.076, 0.02), 0.42));
    scene
}
