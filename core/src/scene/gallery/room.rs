//! A mirror in a closed room with numbered walls: what is reflected is near, and where it is seen can be read.
//!
//! The body stands off the middle. A map of far light, taken in the middle or at the body, shows the squares of the
//! walls displaced; the numbers tell by how much. A ball makes one probe do, a blob or an animal reflects itself.

use glam::{Affine3A, Vec2, Vec3};

use super::{
    GalleryScene,
    parts::{
        Room, SLABS, add, add_material, add_panel, add_subject, ambient, choice_param, in_metres, material_param,
        paint, roughness_param, subject_material, vector,
    },
    pattern, shape,
};
use crate::{
    material::Material,
    param::{Affects, ParamKind, ParamSpec, Settings},
    scene::{Camera, Mesh, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene = GalleryScene {
    name: "room",
    title: "A mirror off the middle of a closed cubic room with numbered walls",
    params: PARAMS,
    build,
};

/// Bodies that can stand in the room.
pub const BODY: ParamSpec = choice_param(
    "body",
    "Body",
    &["ball", "blob", "bunny-like"],
    "What stands in the room: convex, wavy or with ears.",
);

/// The setting `at`: where the body is.
pub const fn at_param(default: [f64; 3]) -> ParamSpec {
    ParamSpec {
        key: "at",
        label: "Place",
        unit: "m",
        kind: ParamKind::Vector { min: [-0.7; 3], max: [0.7; 3], default },
        help: "Middle of the body from the middle of the room, whose walls are 1 m away.",
        affects: Affects::Prepare,
    }
}

const SHAPE: ParamSpec = choice_param(
    "shape",
    "Shape",
    &["box", "l-shaped"],
    "A cube, or one with a corner built in so that it is concave.",
);

const PARAMS: &[ParamSpec] = &[BODY, material_param("Ag"), roughness_param(0.0), at_param([0.24, -0.2, -0.22]), SHAPE];

/// The hollow: the cube from -1 to 1 m.
pub const ROOM: Room = Room { middle: Vec3::ZERO, half: Vec3::ONE, thickness: 0.12 };
/// Of the body.
pub const RADIUS: f32 = 0.32;

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    let material = add_material(&mut scene, subject_material(settings));
    add_body(&mut scene, settings, material, RADIUS, vector(settings, "at"));
    let walls = add_numbered(&mut scene);
    if settings.text("shape").as_deref() == Some("l-shaped") {
        // A pillar in the corner on the far left, sunk into its neighbours.
        let (to, overlap) = (0.36, 0.05);
        let size = Vec3::new(1.0 - to + overlap, 2.0 + 2.0 * overlap, 1.0 - to + overlap);
        let middle = Vec3::new(-1.0 - overlap, 0.0, -1.0 - overlap) + 0.5 * Vec3::new(size.x, 0.0, size.z);
        add(&mut scene, "pillar", shape::block(size, 0.0, 1), walls[1], Affine3A::from_translation(middle));
    }
    add_lamp(&mut scene);
    scene.cameras.push(Camera::look_at("main", Vec3::new(-0.52, 0.12, 0.84), Vec3::new(0.14, -0.17, -0.22), 0.88));
    scene
}

/// Adds the body that the setting asks for as the subject; `radius` about it in metres.
pub fn add_body(scene: &mut Scene, settings: &Settings, material: usize, radius: f32, at: Vec3) {
    let word = settings.text("body").unwrap_or_default();
    let (name, mesh): (_, Mesh) = match word.as_str() {
        "blob" => ("blob", shape::blob(radius, 128)),
        "bunny-like" => ("bunny-like", shape::bunny_like(radius, 160)),
        _ => ("ball", shape::sphere(radius, 128)),
    };
    let turned = Affine3A::from_rotation_y(-0.5);
    add_subject(scene, name, mesh, material, Affine3A::from_translation(at) * turned);
}

/// Adds the walls with a hue and numbers for each and gives their materials, in the order of [`SLABS`].
pub fn add_numbered(scene: &mut Scene) -> [usize; 6] {
    let hues: [[f32; 3]; 6] = [
        [0.62, 0.13, 0.07],
        [0.1, 0.3, 0.58],
        [0.42, 0.4, 0.37],
        [0.68, 0.67, 0.64],
        [0.6, 0.47, 0.13],
        [0.16, 0.45, 0.2],
    ];
    let materials = std::array::from_fn(|i| {
        let (name, outward) = SLABS[i];
        let light = Vec3::from_array(hues[i]);
        let image = pattern::numbered([light, 0.5 * light]);
        let size = Vec2::splat(2.0 * ROOM.half.x);
        let texture = in_metres(scene, image, size, ROOM.overlap(outward));
        add_material(scene, Material { base_color_texture: Some(texture), ..paint(name, Vec3::ONE) })
    });
    ROOM.add(scene, materials);
    materials
}

/// Adds the lamp under the ceiling and what stands for the room's light far away.
pub fn add_lamp(scene: &mut Scene) {
    let position = Vec3::new(0.0, 0.96, 0.1);
    add_panel(scene, "lamp", position, Vec3::NEG_Y, Vec2::new(0.8, 0.8), Vec3::new(13.0, 12.4, 11.6));
    scene.environment = ambient(Vec3::new(0.22, 0.2, 0.18), Vec3::new(0.5, 0.48, 0.45));
}
