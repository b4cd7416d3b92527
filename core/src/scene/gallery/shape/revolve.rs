//! Surfaces of revolution around +y.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use super::{Builder, Profile, Vertex, profile::ProfilePoint};
use crate::scene::Mesh;

/// Turns a profile around +y, `segments` (at least 3) around. Tangents go around the axis.
pub fn revolve(name: &str, profile: &Profile, segments: usize) -> Mesh {
    let mut builder = Builder::default();
    let width = TAU * profile.widest();
    let unwrapped = Unwrapped { offset: 0.0, width, height: profile.length() };
    for piece in &profile.pieces {
        turn(&mut builder, piece, [0.0, TAU], segments.max(3), profile.widest(), unwrapped);
    }
    builder.finish(name)
}

/// Where a patch lies in the unwrapped surface; metres.
#[derive(Clone, Copy)]
pub(super) struct Unwrapped {
    /// Left edge of the patch.
    pub offset: f32,
    /// Of the whole surface.
    pub width: f32,
    /// Of the whole surface.
    pub height: f32,
}

impl Unwrapped {
    /// Both texture coordinates of the point that is `x` to the right of the patch's edge and `y` down.
    pub fn uvs(&self, x: f32, y: f32) -> (Vec2, Vec2) {
        let metres = Vec2::new(self.offset + x, y);
        (metres / Vec2::new(self.width, self.height).max(Vec2::splat(f32::MIN_POSITIVE)), metres)
    }
}

/// Turns one smooth piece through a range of angles; `widest` turns angles into metres across.
pub(super) fn turn(
    builder: &mut Builder,
    piece: &[ProfilePoint],
    [from, to]: [f32; 2],
    segments: usize,
    widest: f32,
    unwrapped: Unwrapped,
) {
    let last = piece.len() - 1;
    builder.grid(segments, last, |i, j| {
        let point = piece[j];
        // A pole has no direction around: each of its triangles gets the one of its middle. The triangle of column i
        // uses vertex i of a pole at the top and vertex i + 1 of one at the bottom (see `Builder::grid`).
        let shift = match (point.at.x == 0.0, j) {
            (true, 0) => 0.5,
            (true, _) => -0.5,
            _ => 0.0,
        };
        let along = (i as f32 + shift) / segments as f32;
        let angle = from + (to - from) * along;
        // A full turn ends exactly where it began.
        let angle = if angle == TAU { 0.0 } else { angle };
        let (uv, uv_metres) = unwrapped.uvs(along * (to - from) * widest, point.length);
        Vertex {
            position: at_angle(point.at, angle),
            normal: at_angle(point.normal, angle),
            tangent: around(angle),
            uv,
            uv_metres,
        }
    });
}

/// The point of the half plane at `angle`, which counts from +z towards +x.
pub(super) fn at_angle(point: Vec2, angle: f32) -> Vec3 {
    let (sin, cos) = angle.sin_cos();
    Vec3::new(point.x * sin, point.y, point.x * cos)
}

/// Unit direction in which `angle` grows.
pub(super) fn around(angle: f32) -> Vec3 {
    let (sin, cos) = angle.sin_cos();
    Vec3::new(cos, 0.0, -sin)
}
