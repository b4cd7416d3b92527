//! A bright room and a dark one behind a thin wall, seen from the gap between the wall's end and the camera.
//!
//! The wall is thinner than the distances at which methods gather or store light. What is learnt on the bright side
//! leaks through to the dark one; little light gets there otherwise, so that a small leak shows.

use glam::{Affine3A, Vec2, Vec3};

use super::{
    GalleryScene, number,
    parts::{
        Room, add, add_material, add_panel, add_subject, ambient, in_metres, material_param, paint, roughness_param,
        subject_material,
    },
    pattern, shape,
};
use crate::{
    material::Material,
    param::{Affects, ParamKind, ParamSpec, Settings},
    scene::{Camera, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene =
    GalleryScene { name: "wall", title: "A bright room and a dark one behind a thin wall", params: PARAMS, build };

const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        key: "thickness",
        label: "Thickness",
        unit: "m",
        kind: ParamKind::Number { min: 0.001, max: 0.2, default: 0.01 },
        help: "Thickness of the wall between the rooms.",
        affects: Affects::Prepare,
    },
    material_param("Ag"),
    roughness_param(0.25),
];

/// The hollow of both rooms reaches from the floor, y = 0, to 2.2 m.
const ROOM: Room = Room { middle: Vec3::new(0.0, 1.1, 0.0), half: Vec3::new(2.0, 1.1, 1.5), thickness: 0.15 };
/// Where the wall ends, along z.
const END: f32 = 0.0;

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    let at = Affine3A::from_translation;
    for (name, x) in [("ball-bright", -0.62), ("ball-dark", 0.62)] {
        add_subject(&mut scene, name, shape::sphere(0.34, 112), material, at(Vec3::new(x, 0.7399, -0.35)));
    }
    let plaster = add_material(&mut scene, paint("partition", Vec3::splat(0.72)));
    let sunk = 0.05;
    let size = Vec3::new(number(settings, "thickness"), 2.2 + 2.0 * sunk, END + 1.5 + sunk);
    let middle = Vec3::new(0.0, 1.1, 0.5 * (END - 1.5 - sunk));
    add_subject(&mut scene, "partition", shape::block(size, 0.0, 1), plaster, at(middle));

    let stone = add_material(&mut scene, paint("plinth", Vec3::splat(0.35)));
    for (name, x) in [("plinth-bright", -0.62), ("plinth-dark", 0.62)] {
        let plinth = shape::cylinder(0.2, 0.42, 0.01, 64);
        add(&mut scene, name, plinth, stone, at(Vec3::new(x, 0.19, -0.35)));
    }
    let warm = add_material(&mut scene, paint("wall-left", Vec3::new(0.7, 0.42, 0.2)));
    let cool = add_material(&mut scene, paint("wall-right", Vec3::new(0.25, 0.42, 0.62)));
    let white = add_material(&mut scene, paint("white", Vec3::splat(0.72)));
    let dark = add_material(&mut scene, paint("wall-front", Vec3::splat(0.3)));
    let squares = pattern::checker(2, [Vec3::splat(0.5), Vec3::splat(0.26)]);
    let squares = in_metres(&mut scene, squares, Vec2::splat(0.5), ROOM.overlap(Vec3::Y));
    let floor = Material { base_color_texture: Some(squares), roughness: 0.5, ..paint("floor", Vec3::ONE) };
    let floor = add_material(&mut scene, floor);
    ROOM.add(&mut scene, [warm, cool, floor, white, white, dark]);
    let size = Vec2::new(0.9, 0.9);
    add_panel(&mut scene, "lamp", Vec3::new(-0.8, 2.15, 0.15), Vec3::NEG_Y, size, Vec3::new(13.0, 12.2, 11.0));
    scene.environment = ambient(Vec3::splat(0.2), Vec3::splat(0.3));
    scene.cameras.push(Camera::look_at("main", Vec3::new(0.05, 1.25, 1.46), Vec3::new(0.01, 0.86, -0.4), 0.92));
    scene
}
