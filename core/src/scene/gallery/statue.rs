//! Two scenes of a statue: among coloured walls, and in the dark between small bright balls.
//!
//! The statue is not convex and everything around it is near. By day it asks for glossy reflections of walls; in the
//! dark of `fireballs` the light is small, bright and close, and a coarse map of it puts every highlight in the wrong
//! place.

use glam::{Affine3A, Vec2, Vec3};

use super::{
    GalleryScene,
    parts::{
        Room, add, add_glowing_ball, add_material, add_panel, add_subject, ambient, in_metres, material_param, paint,
        roughness_param, subject_material,
    },
    pattern, shape,
};
use crate::{
    material::Material,
    param::{ParamSpec, Settings},
    scene::{Camera, Scene},
};

/// Entry in the list of scenes.
pub const STATUE: GalleryScene = GalleryScene {
    name: "statue",
    title: "A statue of glossy metal in a closed room with coloured, striped walls",
    params: PARAMS,
    build: build_statue,
};

/// Entry in the list of scenes.
pub const FIREBALLS: GalleryScene = GalleryScene {
    name: "fireballs",
    title: "A statue of glossy metal between small bright balls in the dark",
    params: PARAMS,
    build: build_fireballs,
};

const PARAMS: &[ParamSpec] = &[material_param("CuZn10"), roughness_param(0.28)];

/// The hollow reaches from the floor, y = 0, to 2.4 m.
const ROOM: Room = Room { middle: Vec3::new(0.0, 1.2, 0.0), half: Vec3::new(1.6, 1.2, 1.6), thickness: 0.2 };
/// Of the plinth and of the figure on it.
const PLINTH: f32 = 0.3;
const HEIGHT: f32 = 1.1;

/// The figure on its plinth and the camera before it.
fn figure(name: &str, settings: &Settings) -> Scene {
    let mut scene = Scene { name: name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    let standing = Affine3A::from_translation(Vec3::new(0.0, PLINTH - 0.004, 0.0));
    add_subject(&mut scene, "figure", shape::figure(HEIGHT, 96), material, standing);
    let stone = Material { roughness: 0.45, ..paint("plinth", Vec3::splat(0.12)) };
    let stone = add_material(&mut scene, stone);
    let plinth = shape::cylinder(0.3, PLINTH, 0.015, 96);
    let standing = Affine3A::from_translation(Vec3::new(0.0, 0.5 * PLINTH + 1e-4, 0.0));
    add(&mut scene, "plinth", plinth, stone, standing);
    scene
}

fn build_statue(settings: &Settings) -> Scene {
    let mut scene = figure(STATUE.name, settings);
    let striped = |scene: &mut Scene, name: &str, light: Vec3, outward: Vec3| {
        let image = pattern::stripes(2, [light, 0.35 * light]);
        let image = in_metres(scene, image, Vec2::splat(0.8), ROOM.overlap(outward));
        add_material(scene, Material { base_color_texture: Some(image), ..paint(name, Vec3::ONE) })
    };
    let left = striped(&mut scene, "wall-left", Vec3::new(0.66, 0.16, 0.07), Vec3::X);
    let right = striped(&mut scene, "wall-right", Vec3::new(0.08, 0.3, 0.55), Vec3::X);
    let front = striped(&mut scene, "wall-front", Vec3::new(0.5, 0.5, 0.2), Vec3::Z);
    let back = add_material(&mut scene, paint("wall-back", Vec3::new(0.62, 0.58, 0.52)));
    let ceiling = add_material(&mut scene, paint("ceiling", Vec3::splat(0.66)));
    let squares = pattern::checker(2, [Vec3::splat(0.42), Vec3::splat(0.16)]);
    let squares = in_metres(&mut scene, squares, Vec2::splat(0.8), ROOM.overlap(Vec3::Y));
    let floor = Material { base_color_texture: Some(squares), roughness: 0.4, ..paint("floor", Vec3::ONE) };
    let floor = add_material(&mut scene, floor);
    ROOM.add(&mut scene, [left, right, floor, ceiling, back, front]);
    let warm = Vec3::new(22.0, 20.4, 18.0);
    add_panel(&mut scene, "lamp-left", Vec3::new(-0.8, 2.34, 0.75), Vec3::NEG_Y, Vec2::new(0.5, 1.0), warm);
    let cool = Vec3::new(12.0, 13.0, 14.6);
    add_panel(&mut scene, "lamp-right", Vec3::new(0.95, 2.34, -0.5), Vec3::NEG_Y, Vec2::new(0.5, 0.8), cool);
    scene.environment = ambient(Vec3::splat(0.16), Vec3::new(0.5, 0.47, 0.43));
    scene.cameras.push(Camera::look_at("main", Vec3::new(0.42, 1.05, 1.5), Vec3::new(0.0, 0.88, 0.0), 0.82));
    scene
}

fn build_fireballs(settings: &Settings) -> Scene {
    let mut scene = figure(FIREBALLS.name, settings);
    let slate = add_material(&mut scene, paint("wall", Vec3::new(0.26, 0.26, 0.28)));
    let floor = Material { roughness: 0.3, ..paint("floor", Vec3::new(0.2, 0.19, 0.18)) };
    let floor = add_material(&mut scene, floor);
    ROOM.add(&mut scene, [slate, slate, floor, slate, slate, slate]);
    // Place, radius and radiance: the further, the larger.
    let (amber, red, blue, green) =
        (Vec3::new(13.0, 4.2, 0.6), Vec3::new(13.0, 1.0, 0.4), Vec3::new(0.7, 3.6, 14.0), Vec3::new(0.9, 9.0, 1.2));
    let balls = [
        (Vec3::new(-0.5, 1.28, 0.3), 0.105, amber),
        (Vec3::new(0.62, 1.02, 0.2), 0.1, blue),
        (Vec3::new(-0.66, 0.62, -0.3), 0.11, blue),
        (Vec3::new(0.47, 0.6, 0.44), 0.07, amber),
        (Vec3::new(0.42, 1.46, -0.42), 0.11, red),
        (Vec3::new(-0.36, 0.62, 0.5), 0.065, green),
    ];
    for (i, (position, radius, radiance)) in balls.into_iter().enumerate() {
        add_glowing_ball(&mut scene, &format!("fireball-{}", i + 1), position, radius, radiance);
    }
    scene.environment = ambient(Vec3::splat(0.05), Vec3::splat(0.05));
    scene.cameras.push(Camera::look_at("main", Vec3::new(0.3, 1.0, 1.52), Vec3::new(0.0, 0.88, 0.0), 0.84));
    scene
}
