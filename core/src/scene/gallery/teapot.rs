//! A teapot on a polished table: a body that sees itself, with reflections of a Blinn-Phong exponent.
//!
//! The spout in the belly, the handle in the lid and the pot in the table are second bounces whose lobes are as narrow
//! as the exponent says: transfer with few lobes makes them too broad.

use glam::{Affine3A, Vec3};

use super::{
    GalleryScene, number,
    parts::{add, add_material, add_subject, material_param, metal},
    shape,
};
use crate::{
    material::{Material, ReflectionModel},
    param::{Affects, ParamKind, ParamSpec, Settings},
    scene::{Camera, Scene},
    surface::blinn_phong::Variant,
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene = GalleryScene {
    name: "teapot",
    title: "A teapot-like body on a polished table under the environment",
    params: PARAMS,
    build,
};

const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        key: "exponent",
        label: "Exponent",
        unit: "",
        kind: ParamKind::Number { min: 32.0, max: 512.0, default: 256.0 },
        help: "Blinn-Phong exponent of the teapot and the table: 32 is satin, 512 polished.",
        affects: Affects::Prepare,
    },
    material_param("Cu"),
];

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let exponent = number(settings, "exponent");
    // The GGX roughness of the same width, for whoever does not know the exponent: alpha^2 = 2 / (exponent + 2).
    let roughness = (2.0 / (exponent + 2.0)).powf(0.25);
    let glossy = |m: Material| Material {
        reflection_model: ReflectionModel::BlinnPhong(Variant::Exact),
        exponent,
        roughness,
        ..m
    };
    let word = settings.text("material").unwrap_or_default();
    let pot = add_material(&mut scene, glossy(metal("subject", &word, roughness)));
    let pot_at = Affine3A::from_translation(Vec3::new(0.0, 1e-4, 0.0)) * Affine3A::from_rotation_y(0.35);
    add_subject(&mut scene, "teapot", shape::teapot(0.1, 112), pot, pot_at);
    let table =
        Material { name: "table".into(), base_color: Vec3::new(0.24, 0.25, 0.27), ..glossy(Material::default()) };
    let table = add_material(&mut scene, table);
    let top = shape::block(Vec3::new(3.0, 0.04, 3.0), 0.0, 1);
    add(&mut scene, "table", top, table, Affine3A::from_translation(Vec3::new(0.0, -0.02, 0.0)));
    scene.cameras.push(Camera::look_at("main", Vec3::new(0.06, 0.3, 0.62), Vec3::new(0.0, 0.064, 0.0), 0.36));
    scene
}
