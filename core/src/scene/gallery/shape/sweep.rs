//! Ring-shaped bodies cut open: a closed profile turned through part of a circle, with flat ends and rounded rims.

use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3};

use super::{
    Builder, EDGE_SEGMENTS, Profile, Vertex,
    profile::ProfilePoint,
    revolve::{Unwrapped, around, at_angle, turn},
};
use crate::scene::Mesh;

/// Turns a closed profile around +y from one angle to another (radians from +z towards +x) and closes both ends with
/// flat caps whose rims are rounded with radius `rim`.
///
/// The rim is exact where the profile is smooth and no outward bulge of it is tighter than `rim`; the flat of the caps
/// stands `rim` outside the angles.
pub fn sweep(name: &str, profile: &Profile, [from, to]: [f32; 2], segments: usize, rim: f32) -> Mesh {
    let mut builder = Builder::default();
    let middle = (to - from) * profile.widest();
    let bend = FRAC_PI_2 * rim;
    let unwrapped = |offset| Unwrapped { offset, width: middle + 2.0 * bend, height: profile.length() };
    for piece in &profile.pieces {
        turn(&mut builder, piece, [from, to], segments.max(1), profile.widest(), unwrapped(bend));
        for (end, offset) in [(End { angle: from, sign: -1.0 }, 0.0), (End { angle: to, sign: 1.0 }, bend + middle)] {
            end.rim(&mut builder, piece, rim, unwrapped(offset));
        }
    }
    End { angle: from, sign: -1.0 }.cap(&mut builder, profile, rim);
    End { angle: to, sign: 1.0 }.cap(&mut builder, profile, rim);
    builder.finish(name)
}

/// One end of a swept body.
#[derive(Clone, Copy)]
struct End {
    /// Of the half plane in which the body ends.
    angle: f32,
    /// +1 when the body ends there, -1 when it begins.
    sign: f32,
}

impl End {
    /// Unit, away from the body.
    fn out(self) -> Vec3 {
        self.sign * around(self.angle)
    }

    /// A point of the rim: `turn` is 0 on the body and a right angle on the cap.
    fn on_rim(self, point: ProfilePoint, rim: f32, turn: f32) -> Vec3 {
        let (sin, cos) = turn.sin_cos();
        at_angle(point.at - rim * (1.0 - cos) * point.normal, self.angle) + rim * sin * self.out()
    }

    /// A quarter of a tube along one piece of the profile.
    fn rim(self, builder: &mut Builder, piece: &[ProfilePoint], rim: f32, unwrapped: Unwrapped) {
        builder.grid(EDGE_SEGMENTS, piece.len() - 1, |i, j| {
            let along = i as f32 / EDGE_SEGMENTS as f32;
            // u follows the angle of the body: into the body at its beginning, off it at its end.
            let turn = FRAC_PI_2 * if self.sign > 0.0 { along } else { 1.0 - along };
            let (sin, cos) = turn.sin_cos();
            let side = at_angle(piece[j].normal, self.angle);
            let (uv, uv_metres) = unwrapped.uvs(along * FRAC_PI_2 * rim, piece[j].length);
            Vertex {
                position: self.on_rim(piece[j], rim, turn),
                normal: cos * side + sin * self.out(),
                tangent: self.sign * (cos * self.out() - sin * side),
                uv,
                uv_metres,
            }
        });
    }

    /// The flat end.
    fn cap(self, builder: &mut Builder, profile: &Profile, rim: f32) {
        // The last point of a piece is the first of the next.
        let outline: Vec<ProfilePoint> =
            profile.pieces.iter().flat_map(|piece| &piece[..piece.len() - 1]).copied().collect();
        let flat: Vec<Vec2> = outline.iter().map(|point| point.at - rim * point.normal).collect();
        let low = flat.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let high = flat.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        let right = Vec3::Y.cross(self.out());
        let first: Vec<u32> = outline
            .iter()
            .zip(&flat)
            .map(|(&point, at)| {
                let across = if self.sign > 0.0 { high.x - at.x } else { at.x - low.x };
                let uv_metres = Vec2::new(across, high.y - at.y);
                builder.vertex(Vertex {
                    position: self.on_rim(point, rim, FRAC_PI_2),
                    normal: self.out(),
                    tangent: right,
                    uv: uv_metres / (high - low).max(Vec2::splat(f32::MIN_POSITIVE)),
                    uv_metres,
                })
            })
            .collect();
        for [a, b, c] in triangulated(&flat) {
            // Seen from the end of the body the profile runs counter-clockwise, from its beginning clockwise.
            let corners = if self.sign > 0.0 { [a, b, c] } else { [a, c, b] };
            builder.triangle(corners.map(|i| first[i]));
        }
    }
}

/// Cuts a simple polygon that runs clockwise into triangles that run clockwise, by cutting off ears.
fn triangulated(polygon: &[Vec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..polygon.len()).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let count = left.len();
        let corner = |i: usize| [left[(i + count - 1) % count], left[i], left[(i + 1) % count]];
        let ear = (0..count).find(|&i| {
            let [a, b, c] = corner(i);
            right_of(polygon[a], polygon[b], polygon[c]) > 0.0
                && !left.iter().any(|&p| ![a, b, c].contains(&p) && inside(polygon, [a, b, c], p))
        });
        // A polygon that crosses itself has no ear; any corner then does.
        let ear = ear.unwrap_or(0);
        triangles.push(corner(ear));
        left.remove(ear);
    }
    if let [a, b, c] = left[..] {
        triangles.push([a, b, c]);
    }
    triangles
}

/// Twice the area of a triangle, positive when it runs clockwise.
fn right_of(a: Vec2, b: Vec2, c: Vec2) -> f32 {
    (c - a).perp_dot(b - a)
}

/// True when point `p` lies in a clockwise triangle or on its border.
fn inside(polygon: &[Vec2], [a, b, c]: [usize; 3], p: usize) -> bool {
    let [a, b, c, p] = [a, b, c, p].map(|i| polygon[i]);
    right_of(a, b, p) >= 0.0 && right_of(b, c, p) >= 0.0 && right_of(c, a, p) >= 0.0
}
