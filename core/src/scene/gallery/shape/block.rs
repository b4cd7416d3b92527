//! Boxes with rounded edges.

use glam::{Vec2, Vec3};

use super::{Builder, Vertex};
use crate::scene::Mesh;

/// A box around the origin whose edges are cylinders and whose corners are balls of radius `edge`, with `segments` to
/// half a quarter turn. The edge is at most half the least side; 0 gives creases. Texture set 0 covers each face.
pub fn block(size: Vec3, edge: f32, segments: usize) -> Mesh {
    let half = 0.5 * size.abs();
    let edge = edge.clamp(0.0, half.min_element());
    let mut builder = Builder::default();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for normal in [axis, -axis] {
            face(&mut builder, normal, half, edge, segments.max(1));
        }
    }
    builder.finish("block")
}

/// One side of the box with the halves of its edges and the thirds of its corners.
fn face(builder: &mut Builder, normal: Vec3, half: Vec3, edge: f32, segments: usize) {
    let up = match normal.y {
        0.0 => Vec3::Y,
        y => Vec3::NEG_Z * y,
    };
    let right = up.cross(normal);
    let side = |direction: Vec3| half.dot(direction.abs());
    let across = rails(side(right), edge, segments);
    let down = rails(side(up), edge, segments);
    let size = 2.0 * Vec2::new(side(right), side(up));
    builder.grid(across.len() - 1, down.len() - 1, |i, j| {
        let (x, y) = (across[i], down[j]);
        // A point of the sharp box, seen from the point of the inner box nearest to it, gives the normal.
        let out = (right * x.slope - up * y.slope + normal).normalize();
        let inner = right * x.inner - up * y.inner + normal * (side(normal) - edge);
        let uv_metres = Vec2::new(x.inner + edge * x.slope, y.inner + edge * y.slope) + 0.5 * size;
        Vertex {
            position: inner + edge * out,
            normal: out,
            tangent: (right - out * out.dot(right)).normalize(),
            uv: uv_metres / size.max(Vec2::splat(f32::MIN_POSITIVE)),
            uv_metres,
        }
    });
}

/// A line of vertices along one direction of a face.
#[derive(Clone, Copy)]
struct Rail {
    /// Coordinate of the inner box, metres.
    inner: f32,
    /// Tangent of the angle of the normal against the face's, -1 to 1.
    slope: f32,
}

/// Lines from one side of the face to the other: equal angles on the edges, nothing in the flat between.
fn rails(half: f32, edge: f32, segments: usize) -> Vec<Rail> {
    let inner = half - edge;
    if edge == 0.0 {
        return vec![Rail { inner: -inner, slope: 0.0 }, Rail { inner, slope: 0.0 }];
    }
    let slope = |k: usize| match k == segments {
        // Exactly 1, so that neighbouring faces share their vertices.
        true => 1.0,
        false => (std::f32::consts::FRAC_PI_4 * k as f32 / segments as f32).tan(),
    };
    let low = (0..=segments).rev().map(|k| Rail { inner: -inner, slope: -slope(k) });
    let high = (0..=segments).map(|k| Rail { inner, slope: slope(k) });
    low.chain(high).collect()
}
