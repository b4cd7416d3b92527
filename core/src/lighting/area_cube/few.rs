//! The texel that a reflection meets, and those beside it.

use glam::{Vec2, Vec3};

use crate::lighting::cube_map::on_face;
use crate::math::cube::{self, mirrored};

/// Texels that share an edge with one.
pub const NEIGHBOURS: u32 = 4;

/// Number of the texel in a direction, in the world, of a cube with `edge` texels along an edge.
pub fn texel_at(direction: Vec3, edge: u32) -> u32 {
    number(cube::face_point(mirrored(direction)), edge)
}

fn number((face, p): (u32, Vec2), edge: u32) -> u32 {
    let at = |v: f32| ((0.5 * v + 0.5) * edge as f32).clamp(0.0, (edge - 1) as f32) as u32;
    (face * edge + at(p.y)) * edge + at(p.x)
}

/// Number of the texel beyond the right, left, lower or upper edge of a texel, on the face or the next one.
pub fn neighbour(index: u32, side: u32, edge: u32) -> u32 {
    let (face, x, y) = (index / (edge * edge), index % edge, index / edge % edge);
    let to = [Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y][side as usize % 4];
    // The middle of the next texel; where that is on another face a place just beyond the edge of this one.
    let next = on_face(x, y, Vec2::splat(0.5), edge) + to * (2.0 / edge as f32);
    number(cube::face_point(cube::direction(face, next.clamp(Vec2::splat(-1.001), Vec2::splat(1.001)))), edge)
}
