//! The corner of a closed room that no lamp reaches: all light has bounced at least once.
//!
//! Lamps on ledges light the ceiling, and that lights the corner. Light sources that are put on the
//! walls instead have their spikes and their darkening where the walls meet and where things touch.

use glam::{Affine3A, Vec2, Vec3};

use super::{
    GalleryScene,
    parts::{
        Room, add, add_material, add_panel, add_subject, ambient, in_metres, material_param, paint, roughness_param,
        subject_material,
    },
    pattern, shape,
};
use crate::{
    material::Material,
    param::{ParamSpec, Settings},
    scene::{Camera, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene = GalleryScene {
    name: "corner",
    title: "The corner of a closed room that only bounced light reaches",
    params: PARAMS,
    build,
};

const PARAMS: &[ParamSpec] = &[material_param("Al"), roughness_param(0.35)];

/// The hollow reaches from the floor, y = 0, to 2.2 m.
const ROOM: Room = Room { middle: Vec3::new(0.0, 1.1, 0.0), half: Vec3::new(1.5, 1.1, 1.3), thickness: 0.15 };

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    let at = Affine3A::from_translation;
    add_subject(&mut scene, "ball", shape::sphere(0.3, 112), material, at(Vec3::new(0.55, 0.3, -0.62)));
    let turned = at(Vec3::new(1.06, 0.3001, -0.42)) * Affine3A::from_rotation_y(0.5);
    add_subject(&mut scene, "block", shape::block(Vec3::new(0.36, 0.6, 0.36), 0.015, 4), material, turned);
    let clay = add_material(&mut scene, paint("bowl", Vec3::new(0.55, 0.26, 0.14)));
    add(&mut scene, "bowl", shape::bowl(0.2, 72), clay, at(Vec3::new(0.62, 1e-4, -0.02)));

    let orange = add_material(&mut scene, paint("wall-left", Vec3::new(0.78, 0.45, 0.2)));
    let blue = add_material(&mut scene, paint("wall-right", Vec3::new(0.3, 0.44, 0.62)));
    let white = add_material(&mut scene, paint("white", Vec3::splat(0.76)));
    let squares = pattern::checker(2, [Vec3::splat(0.55), Vec3::splat(0.3)]);
    let squares = in_metres(&mut scene, squares, Vec2::splat(0.6), ROOM.overlap(Vec3::Y));
    let floor = Material { base_color_texture: Some(squares), roughness: 0.5, ..paint("floor", Vec3::ONE) };
    let floor = add_material(&mut scene, floor);
    ROOM.add(&mut scene, [orange, blue, floor, white, white, white]);
    // Lamps lie on ledges above the picture and shine at the ceiling, all of which lights what is below.
    for (name, side) in [("left", -1.0), ("right", 1.0)] {
        let ledge = shape::block(Vec3::new(0.3, 0.05, 2.64), 0.005, 2);
        add(&mut scene, &format!("ledge-{name}"), ledge, white, at(Vec3::new(1.37 * side, 1.66, 0.0)));
        let (place, size) = (Vec3::new(1.35 * side, 1.72, 0.0), Vec2::new(0.16, 2.3));
        add_panel(&mut scene, &format!("lamp-{name}"), place, Vec3::Y, size, Vec3::new(19.0, 17.7, 15.9));
    }
    scene.environment = ambient(Vec3::splat(0.45), Vec3::splat(0.8));
    scene.cameras.push(Camera::look_at("main", Vec3::new(-0.1, 1.0, 1.14), Vec3::new(0.74, 0.42, -0.62), 0.76));
    scene
}
