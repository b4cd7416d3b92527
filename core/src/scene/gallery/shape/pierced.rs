//! A plate with a rectangular hole, such as a wall with a window.

use glam::{Vec2, Vec3};

use super::{Builder, Vertex};
use crate::scene::Mesh;

/// A plate of `size` metres around the origin, facing +z and -z, with a hole of size `hole` around the point `middle`.
/// The hole must lie inside the plate. Texture set 0 covers each face, set 1 counts from its left top corner.
pub fn pierced(size: Vec3, middle: Vec2, hole: Vec2) -> Mesh {
    let half = 0.5 * size;
    let (low, high) = (middle - 0.5 * hole, middle + 0.5 * hole);
    let xs = [-half.x, low.x, high.x, half.x];
    let ys = [-half.y, low.y, high.y, half.y];
    let mut builder = Builder::default();
    for side in [1.0, -1.0] {
        for (column, row) in (0..9).map(|i| (i % 3, i / 3)).filter(|cell| *cell != (1, 1)) {
            let corners = [Vec2::new(xs[column], ys[row]), Vec2::new(xs[column + 1], ys[row + 1])];
            rectangle(&mut builder, corners.map(|c| c.extend(side * half.z)), side * Vec3::Z, half);
        }
    }
    // The edges face outwards, the reveal of the hole inwards; each in parts, so that its corners are those of the faces.
    for i in 0..3 {
        for (x, normal) in [(half.x, Vec3::X), (-half.x, Vec3::NEG_X)] {
            rectangle(&mut builder, [Vec3::new(x, ys[i], -half.z), Vec3::new(x, ys[i + 1], half.z)], normal, half);
        }
        for (y, normal) in [(half.y, Vec3::Y), (-half.y, Vec3::NEG_Y)] {
            rectangle(&mut builder, [Vec3::new(xs[i], y, -half.z), Vec3::new(xs[i + 1], y, half.z)], normal, half);
        }
    }
    for (x, normal) in [(low.x, Vec3::X), (high.x, Vec3::NEG_X)] {
        rectangle(&mut builder, [Vec3::new(x, low.y, -half.z), Vec3::new(x, high.y, half.z)], normal, half);
    }
    for (y, normal) in [(low.y, Vec3::Y), (high.y, Vec3::NEG_Y)] {
        rectangle(&mut builder, [Vec3::new(low.x, y, -half.z), Vec3::new(high.x, y, half.z)], normal, half);
    }
    builder.finish("pierced")
}

/// The rectangle between two opposite corners, seen from `normal`.
fn rectangle(builder: &mut Builder, [a, b]: [Vec3; 2], normal: Vec3, half: Vec3) {
    let up = if normal.y == 0.0 { Vec3::Y } else { Vec3::NEG_Z * normal.y };
    let right = up.cross(normal);
    let size = 2.0 * Vec2::new(half.dot(right.abs()), half.dot(up.abs()));
    // Corners to the left and right, above and below.
    let (left, end) = (a.dot(right).min(b.dot(right)), a.dot(right).max(b.dot(right)));
    let (top, bottom) = (a.dot(up).max(b.dot(up)), a.dot(up).min(b.dot(up)));
    builder.grid(1, 1, |i, j| {
        // The numbers as they are, without a sum that rounds: neighbours share their corners.
        let (x, y) = (if i == 0 { left } else { end }, if j == 0 { top } else { bottom });
        let uv_metres = Vec2::new(x, -y) + 0.5 * size;
        Vertex {
            position: right * x + up * y + normal * a.dot(normal),
            normal,
            tangent: right,
            uv: uv_metres / size.max(Vec2::splat(f32::MIN_POSITIVE)),
            uv_metres,
        }
    });
}
