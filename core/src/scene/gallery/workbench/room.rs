//! The room: a tiled floor, three walls and a window.

use std::sync::Arc;

use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};

use crate::{
    material::{Material, Sampler, TextureRef, Wrap},
    scene::{
        Image, Mesh, Scene, Texels,
        gallery::{
            parts::{add, add_material},
            shape,
        },
    },
};

/// Inside of the room: x is half its width, y its height, z half its depth; metres.
const ROOM: Vec3 = Vec3::new(0.64, 0.6, 0.48);
/// Of the walls.
const THICKNESS: f32 = 0.04;
/// Side of a tile and the joint between two.
const TILE: f32 = 0.128;
const JOINT: f32 = 0.003;

/// Adds tiles on a dark bed.
pub fn add_floor(scene: &mut Scene) {
    let material = Material {
        name: "floor".into(),
        base_color: Vec3::new(0.25, 0.237, 0.22),
        roughness: 0.4,
        ..Material::default()
    };
    let material = add_material(scene, material);
    let (across, deep) = (10, 9);
    let tile = shape::block(Vec3::new(TILE - JOINT, 0.02, TILE - JOINT), 0.003, 1);
    let tiles = (0..across * deep).map(|i| {
        let (column, row) = (i % across, i / across);
        // Sits 10 mm deep, top at the height 0. The last row reaches out of the room towards the camera.
        let middle = Vec2::new(column as f32 + 0.5, row as f32 + 0.5) * TILE - Vec2::new(ROOM.x, ROOM.z);
        let placed = Affine3A::from_translation(Vec3::new(middle.x, -0.01, middle.y));
        let tile = shape::transformed(tile.clone(), &placed);
        shape::colored(tile, Vec3::splat(tone(column, row)).extend(1.0))
    });
    let size = Vec2::new(across as f32, deep as f32) * TILE;
    let bed = shape::block(Vec3::new(size.x, 0.02, size.y), 0.004, 2);
    let bed_middle = Vec3::new(0.0, -0.014, 0.5 * size.y - ROOM.z);
    let bed = shape::transformed(bed, &Affine3A::from_translation(bed_middle));
    let bed = shape::colored(bed, Vec3::splat(0.3).extend(1.0));
    add(scene, "floor", shape::combined("floor", tiles.chain([bed])), material, Affine3A::IDENTITY);
}

/// A factor near 1 that differs from tile to tile without a pattern.
fn tone(column: usize, row: usize) -> f32 {
    let hash = (column as u32 * 73 + row as u32 * 179 + 11).wrapping_mul(2_654_435_761) >> 24;
    0.86 + 0.14 * hash as f32 / 255.0
}

/// Adds the walls and the window.
pub fn add_walls(scene: &mut Scene) {
    let paint =
        |name: &str, base_color| Material { name: name.into(), base_color, roughness: 0.7, ..Material::default() };
    let warm = add_material(scene, paint("wall-left", Vec3::new(0.46, 0.125, 0.045)));
    let cool = add_material(scene, paint("wall-right", Vec3::new(0.03, 0.11, 0.175)));
    let neutral = add_material(scene, paint("wall-back", Vec3::new(0.235, 0.228, 0.22)));
    let side = Vec3::new(THICKNESS, ROOM.y, 2.0 * ROOM.z);
    let aside = ROOM.x + 0.5 * THICKNESS;
    wall(scene, "wall-left", warm, side, Vec3::new(-aside, 0.5 * ROOM.y, 0.0));
    wall(scene, "wall-right", cool, side, Vec3::new(aside, 0.5 * ROOM.y, 0.0));
    let back = Vec3::new(2.0 * (ROOM.x + THICKNESS), ROOM.y, THICKNESS);
    wall(scene, "wall-back", neutral, back, Vec3::new(0.0, 0.5 * ROOM.y, -ROOM.z - 0.5 * THICKNESS));
    add_window(scene);
}

fn wall(scene: &mut Scene, name: &str, material: usize, size: Vec3, middle: Vec3) {
    add(scene, name, shape::block(size, 0.008, 2), material, Affine3A::from_translation(middle));
}

/// A window on the left wall: a pane that glows behind a frame with a cross of mullions.
fn add_window(scene: &mut Scene) {
    let size = Vec2::new(0.5, 0.34);
    let frame_width = 0.026;
    let glow = glow(scene);
    let glow = add_material(scene, glow);
    let wood = Material {
        name: "frame".into(),
        base_color: Vec3::new(0.62, 0.6, 0.56),
        roughness: 0.4,
        ..Material::default()
    };
    let wood = add_material(scene, wood);
    // On the wall, +z of the window into the room.
    let placed = Affine3A::from_rotation_translation(
        Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
        Vec3::new(-ROOM.x, 0.36, -0.06),
    );
    // The pane is 4 mm off the wall, the frame 22 mm deep.
    let pane =
        shape::transformed(shape::plane(size.x, size.y), &Affine3A::from_translation(Vec3::new(0.0, 0.0, 0.004)));
    add(scene, "window", pane, glow, placed);
    let bar = |width: f32, height: f32, x: f32, y: f32, depth: f32| -> Mesh {
        let bar = shape::block(Vec3::new(width, height, depth), 0.004, 2);
        shape::transformed(bar, &Affine3A::from_translation(Vec3::new(x, y, 0.5 * depth)))
    };
    let (w, h) = (0.5 * size.x, 0.5 * size.y);
    let bars = [
        bar(frame_width, size.y + frame_width, -w, 0.0, 0.022),
        bar(frame_width, size.y + frame_width, w, 0.0, 0.022),
        bar(size.x + 2.0 * frame_width, frame_width, 0.0, h, 0.024),
        bar(size.x + 2.0 * frame_width, frame_width, 0.0, -h, 0.03),
        bar(0.014, size.y, -w / 3.0, 0.0, 0.016),
        bar(0.014, size.y, w / 3.0, 0.0, 0.016),
        bar(size.x, 0.014, 0.0, 0.1 * h, 0.018),
    ];
    add(scene, "frame", shape::combined("frame", bars), wood, placed);
}

/// The pane: glows with the picture of the sky.
fn glow(scene: &mut Scene) -> Material {
    scene.images.push(Arc::new(sky()));
    let sky = TextureRef {
        image: scene.images.len() - 1,
        sampler: Sampler { wrap_u: Wrap::Clamp, wrap_v: Wrap::Clamp, ..Sampler::default() },
        uv_set: 0,
        transform: Mat3::IDENTITY,
    };
    Material {
        name: "window".into(),
        base_color: Vec3::splat(0.02),
        emission: Vec3::splat(2.6),
        emission_texture: Some(sky),
        roughness: 0.3,
        ..Material::default()
    }
}

/// What is behind the window: an evening sky, blue above and warm below.
fn sky() -> Image {
    let (width, height) = (4, 64);
    let (zenith, horizon) = (Vec3::new(150.0, 190.0, 250.0), Vec3::new(255.0, 226.0, 190.0));
    let texels = (0..width * height).flat_map(|i| {
        let down = (i / width) as f32 / (height - 1) as f32;
        let [r, g, b] = zenith.lerp(horizon, down.powf(0.7)).to_array().map(|v| v as u8);
        [r, g, b, 255]
    });
    Image { name: "sky".into(), width, height, texels: Texels::Unorm8(texels.collect()) }
}
