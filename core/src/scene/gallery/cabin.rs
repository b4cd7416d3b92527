//! A wooden cabin that is lit through one small window.
//!
//! A patch of sky lights the floor, and the floor lights the rest: rays from most points find no light, and few paths
//! carry all of it. What a method learns in one place must not be smeared over the sill.

use glam::{Affine3A, Quat, Vec2, Vec3};

use super::{
    GalleryScene,
    parts::{
        Room, add, add_material, add_subject, ambient, in_metres, material_param, paint, roughness_param,
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
pub const SCENE: GalleryScene =
    GalleryScene { name: "cabin", title: "A wooden cabin lit through one small window", params: PARAMS, build };

const PARAMS: &[ParamSpec] = &[material_param("Cu"), roughness_param(0.2)];

/// The hollow from the floor, y = 0, with the space in front of the window, which the wall with the window cuts off.
const ROOM: Room = Room { middle: Vec3::new(0.0, 1.1, 0.0), half: Vec3::new(1.6, 1.1, 1.4), thickness: 0.2 };
/// Of the wall with the window.
const WALL: f32 = 0.24;
/// Middle of the window, height and place along the wall, and its size.
const WINDOW: Vec2 = Vec2::new(-0.15, 1.3);
const SIZE: Vec2 = Vec2::new(0.7, 0.58);

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    let at = Affine3A::from_translation;
    let turned = at(Vec3::new(-0.62, 0.6201, -0.32)) * Affine3A::from_rotation_y(0.3);
    add_subject(&mut scene, "kettle", shape::teapot(0.2, 112), material, turned);
    add_subject(&mut scene, "bowl", shape::bowl(0.17, 80), material, at(Vec3::new(-0.2, 0.6201, -0.26)));
    furniture(&mut scene);
    walls(&mut scene);
    window(&mut scene);
    scene.environment = ambient(Vec3::new(0.12, 0.08, 0.05), Vec3::new(0.16, 0.11, 0.07));
    scene.cameras.push(Camera::look_at("main", Vec3::new(0.2, 1.08, 0.72), Vec3::new(-0.62, 0.84, -0.28), 0.8));
    scene
}

/// A table of one board on two blocks.
fn furniture(scene: &mut Scene) {
    let oak = pattern::boards(4, Vec3::new(0.4, 0.24, 0.12));
    let oak = in_metres(scene, oak, Vec2::splat(0.5), Vec2::ZERO);
    let oak = Material { base_color_texture: Some(oak), roughness: 0.4, ..paint("table", Vec3::ONE) };
    let oak = add_material(scene, oak);
    let at = Affine3A::from_translation;
    add(scene, "table", shape::block(Vec3::new(1.5, 0.05, 0.8), 0.008, 2), oak, at(Vec3::new(-0.4, 0.595, -0.2)));
    for (name, x) in [("leg-left", -0.95), ("leg-right", 0.15)] {
        // From inside of the board into the floor.
        add(scene, name, shape::block(Vec3::new(0.09, 0.63, 0.6), 0.008, 2), oak, at(Vec3::new(x, 0.275, -0.2)));
    }
}

fn walls(scene: &mut Scene) {
    let mut boarded = |name: &str, wood: Vec3, outward: Vec3| {
        let image = pattern::boards(4, wood);
        let image = in_metres(scene, image, Vec2::splat(0.8), ROOM.overlap(outward));
        add_material(scene, Material { base_color_texture: Some(image), ..paint(name, Vec3::ONE) })
    };
    let pine = Vec3::new(0.62, 0.45, 0.28);
    let side = boarded("wall-side", pine, Vec3::X);
    let end = boarded("wall-end", pine, Vec3::Z);
    let floor = boarded("floor", Vec3::new(0.5, 0.33, 0.19), Vec3::Y);
    let ceiling = boarded("ceiling", Vec3::new(0.66, 0.5, 0.32), Vec3::Y);
    ROOM.add(scene, [side, side, floor, ceiling, end, end]);
    // Sunk into all that is around it; its own texture set begins at its corner.
    let sunk = 0.04;
    let size = Vec3::new(2.0 * (ROOM.half.z + sunk), 2.0 * (ROOM.half.y + sunk), WALL + sunk);
    let pierced = shape::pierced(size, Vec2::new(-WINDOW.x, WINDOW.y - ROOM.middle.y), SIZE);
    let middle = Vec3::new(-ROOM.half.x + 0.5 * (WALL - sunk), ROOM.middle.y, 0.0);
    // Its +z into the cabin, its +x towards -z.
    let placed = Affine3A::from_rotation_translation(Quat::from_rotation_y(std::f32::consts::FRAC_PI_2), middle);
    add(scene, "wall-window", pierced, side, placed);
}

/// The sky behind the window, a pane that glows, and a cross of bars before it.
fn window(scene: &mut Scene) {
    let sky = Material {
        name: "window".into(),
        base_color: Vec3::splat(0.02),
        emission: Vec3::new(46.0, 52.0, 59.0),
        roughness: 0.5,
        ..Material::default()
    };
    let sky = add_material(scene, sky);
    let placed = |depth: f32| {
        Affine3A::from_rotation_translation(
            Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
            Vec3::new(-ROOM.half.x + depth, WINDOW.y, WINDOW.x),
        )
    };
    // Larger than the opening: its edge lies inside the wall.
    add(scene, "window", shape::plane(SIZE.x + 0.02, SIZE.y + 0.02), sky, placed(0.01));
    let frame = add_material(scene, paint("frame", Vec3::new(0.6, 0.57, 0.5)));
    let bars = [
        shape::block(Vec3::new(0.03, SIZE.y + 0.02, 0.04), 0.004, 2),
        shape::block(Vec3::new(SIZE.x + 0.02, 0.03, 0.034), 0.004, 2),
    ];
    add(scene, "frame", shape::combined("frame", bars), frame, placed(0.06));
}
