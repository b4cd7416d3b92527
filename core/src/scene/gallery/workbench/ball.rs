//! The shader ball: two thick half shells with a ring between them around a core, on a foot on a plinth.
//!
//! Every part is turned around one axis. The upper shell is cut open towards the camera and has a flat facet with a
//! hole on top. Lengths are in metres, the middle of the ball is the origin of its parts.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Affine3A, Quat, Vec2, Vec3};

use crate::{
    material::Material,
    scene::{
        Mesh, Scene,
        gallery::{
            parts::{add, add_material, add_subject},
            shape::{self, Corner, Profile},
        },
    },
};

/// Outside and inside of the shells.
const OUTER: f32 = 0.2;
const INNER: f32 = 0.165;
/// Half the gap in which the ring lies.
const GAP: f32 = 0.02;
/// Radius of the shells' edges at the gap.
const EDGE: f32 = 0.006;
/// Height of the flat facet on top, radius of its edge, radius of the hole in it and of that one's edges.
const FACET: f32 = 0.172;
const FACET_EDGE: f32 = 0.024;
const HOLE: f32 = 0.05;
const HOLE_EDGE: f32 = 0.01;
/// Where the upper shell begins and ends, radians from +z towards +x; and the rims of the cut.
const CUT: [f32; 2] = [1.32, 5.85];
const RIM: f32 = 0.005;
/// Segments around the axis: the silhouette then misses the circle by 0.1 mm.
const AROUND: usize = 112;
/// Heights above the floor: the top of the plinth and the middle of the ball.
const PLINTH_TOP: f32 = 0.09;
const MIDDLE: f32 = 0.325;

/// Adds the ball, its foot and its plinth.
pub fn add_parts(scene: &mut Scene, roughness: f32, anisotropy: f32) {
    let [gold, enamel, steel, stone] = materials(roughness, anisotropy).map(|material| add_material(scene, material));
    let upright = Affine3A::from_translation(Vec3::new(0.0, MIDDLE, 0.0));
    // Tilted, so that the camera looks on the facet and the highlights of the sides are not upright.
    let tilted = upright * Affine3A::from_quat(Quat::from_rotation_z(-0.16) * Quat::from_rotation_x(0.2));
    add_subject(scene, "ball", shape::combined("ball", [upper_shell(), lower_shell()]), gold, tilted);
    add_subject(scene, "foot", foot(), gold, upright);
    add_subject(scene, "core", core(), enamel, tilted);
    add_subject(scene, "ring", shape::torus(0.186, 0.015, AROUND, 24), steel, tilted);
    let plinth = shape::block(Vec3::new(0.46, PLINTH_TOP, 0.46), 0.012, 5);
    add(scene, "plinth", plinth, stone, Affine3A::from_translation(Vec3::new(0.0, 0.5 * PLINTH_TOP, 0.0)));
}

/// The materials of the shells and the foot, the core, the ring and the plinth.
fn materials(roughness: f32, anisotropy: f32) -> [Material; 4] {
    let gold = Material {
        name: "ball".into(),
        base_color: Vec3::new(1.0, 0.75, 0.34),
        metallic: 1.0,
        roughness,
        anisotropy,
        // Tangents go around the axis and anisotropy blurs along its direction: across the lines of a lathe.
        anisotropy_rotation: FRAC_PI_2,
        ..Material::default()
    };
    let enamel = Material {
        name: "core".into(),
        base_color: Vec3::new(0.02, 0.045, 0.09),
        roughness: 0.45,
        coat: 1.0,
        coat_roughness: 0.06,
        ..Material::default()
    };
    let steel = Material {
        name: "ring".into(),
        base_color: Vec3::new(0.66, 0.65, 0.63),
        metallic: 1.0,
        roughness: 0.12,
        ..Material::default()
    };
    let stone = Material {
        name: "plinth".into(),
        base_color: Vec3::new(0.05, 0.05, 0.055),
        roughness: 0.35,
        ..Material::default()
    };
    [gold, enamel, steel, stone]
}

/// Middle of a fillet: a point of the half plane at a distance from the origin and at a height.
fn at_height(distance: f32, y: f32) -> Vec2 {
    Vec2::new((distance * distance - y * y).max(0.0).sqrt(), y)
}

/// The upper shell: from the gap to the facet, cut open.
fn upper_shell() -> Mesh {
    let facet = at_height(OUTER - FACET_EDGE, FACET - FACET_EDGE);
    let outside = at_height(OUTER - EDGE, GAP + EDGE);
    let inside = at_height(INNER + EDGE, GAP + EDGE);
    let hole_x = HOLE + HOLE_EDGE;
    let hole_low = Vec2::new(hole_x, ((INNER + HOLE_EDGE).powi(2) - hole_x * hole_x).sqrt());
    let hole_high = Vec2::new(hole_x, FACET - HOLE_EDGE);
    let profile = Profile::new()
        .arc(Vec2::ZERO, OUTER, facet.to_angle(), outside.to_angle(), 20)
        .arc(outside, EDGE, outside.to_angle(), -FRAC_PI_2, 5)
        .arc(inside, EDGE, -FRAC_PI_2, inside.to_angle() - PI, 5)
        .arc(Vec2::ZERO, INNER, inside.to_angle(), hole_low.to_angle(), 16)
        .arc(hole_low, HOLE_EDGE, hole_low.to_angle() - PI, -PI, 3)
        .arc(hole_high, HOLE_EDGE, PI, FRAC_PI_2, 5)
        .arc(facet, FACET_EDGE, FRAC_PI_2, facet.to_angle(), 6)
        .closed();
    shape::sweep("upper shell", &profile, CUT, AROUND * 3 / 4, RIM)
}

/// The lower shell: a bowl.
fn lower_shell() -> Mesh {
    let outside = at_height(OUTER - EDGE, -GAP - EDGE);
    let inside = at_height(INNER + EDGE, -GAP - EDGE);
    let profile = Profile::new()
        .arc(Vec2::ZERO, INNER, -FRAC_PI_2, inside.to_angle(), 14)
        .arc(inside, EDGE, inside.to_angle() + PI, FRAC_PI_2, 5)
        .arc(outside, EDGE, FRAC_PI_2, outside.to_angle(), 5)
        .arc(Vec2::ZERO, OUTER, outside.to_angle(), -FRAC_PI_2, 22);
    shape::revolve("lower shell", &profile, AROUND)
}

/// The core on its stem.
fn core() -> Mesh {
    let radius = 0.122;
    let stem = Vec2::new(0.045, -INNER);
    let profile = Profile::new().arc(Vec2::ZERO, radius, FRAC_PI_2, -1.1, 26).to(Vec2::new(stem.x, -0.125)).to(stem);
    shape::revolve("core", &profile, AROUND)
}

/// The foot: a lip around the ball above a hollow flare.
fn foot() -> Mesh {
    let bottom = PLINTH_TOP - MIDDLE;
    let outline = [
        Corner::sharp(0.0, -0.175),
        Corner::round(0.134, -0.161, 0.005),
        Corner::round(0.126, -0.212, 0.034),
        Corner::round(0.172, -0.223, 0.004),
        Corner::sharp(0.172, bottom),
        Corner::sharp(0.0, bottom),
    ];
    shape::revolve("foot", &Profile::rounded(&outline, 7), AROUND)
}
