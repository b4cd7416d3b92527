//! Meshes pulled into other shapes by smooth maps whose derivatives are known, so that normals and tangents stay exact.

use glam::{Mat3, Vec2, Vec3};

use crate::scene::Mesh;

/// The mesh moved by a smooth map: `by` gives the image of a point and the derivatives there, one column for each axis.
/// The map must keep left and right; texture coordinates stay, so those in metres are of the shape before.
pub fn deformed(mut mesh: Mesh, by: impl Fn(Vec3) -> (Vec3, Mat3)) -> Mesh {
    for ((position, normal), tangent) in mesh.positions.iter_mut().zip(&mut mesh.normals).zip(&mut mesh.tangents) {
        let (moved, derivatives) = by(*position);
        debug_assert!(derivatives.determinant() > 0.0, "the map turns the mesh inside out at {position}");
        *position = moved;
        *normal = (derivatives.inverse().transpose() * *normal).normalize_or(*normal);
        let along = (derivatives * tangent.truncate()).normalize_or(tangent.truncate());
        // What rounding left of the normal in it.
        *tangent = (along - *normal * normal.dot(along)).normalize_or(along).extend(tangent.w);
    }
    mesh
}

/// The mesh turned around +y by an angle that grows with the height, `rate` in radians per metre.
pub fn twisted(mesh: Mesh, rate: f32) -> Mesh {
    deformed(mesh, |p| {
        let turn = Mat3::from_rotation_y(rate * p.y);
        let moved = turn * p;
        let along_y = Vec3::Y + rate * Vec3::Y.cross(moved);
        (moved, Mat3::from_cols(turn.x_axis, along_y, turn.z_axis))
    })
}

/// A cubic Bezier curve in the plane z = 0; metres.
#[derive(Clone, Copy, Debug)]
pub struct Curve(pub [Vec2; 4]);

impl Curve {
    /// Point, first and second derivative at `t` in 0..1.
    fn at(&self, t: f32) -> [Vec2; 3] {
        let [a, b, c, d] = self.0;
        let s = 1.0 - t;
        let (ab, bc, cd) = (b - a, c - b, d - c);
        [
            s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d,
            3.0 * (s * s * ab + 2.0 * s * t * bc + t * t * cd),
            6.0 * (s * (bc - ab) + t * (cd - bc)),
        ]
    }

    /// Length in metres, to about 1 in 10 000.
    pub fn length(&self) -> f32 {
        let steps = 64;
        (0..steps).map(|i| self.at((i as f32 + 0.5) / steps as f32)[1].length()).sum::<f32>() / steps as f32
    }
}

/// The mesh bent along a curve: the axis from the height 0 to `height` becomes the curve, +x its right side. The body
/// must be thinner than the curve is tight.
pub fn bent(mesh: Mesh, height: f32, curve: &Curve) -> Mesh {
    deformed(mesh, |p| {
        let [at, first, second] = curve.at(p.y / height);
        let speed = first.length();
        let along = first / speed;
        let turn = (second - along * along.dot(second)) / speed;
        let right = -along.perp();
        let along_y = (first - p.x * turn.perp()) / height;
        ((at + p.x * right).extend(p.z), Mat3::from_cols(right.extend(0.0), along_y.extend(0.0), Vec3::Z))
    })
}
