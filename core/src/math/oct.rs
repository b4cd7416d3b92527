//! Unit vectors on a square: the octahedron unfolded.
//!
//! Cigolle et al. 2014, A Survey of Efficient Representations for Independent Unit Vectors.

use glam::{Vec2, Vec3};

/// Maps a vector that is not zero to the square `[-1, 1]^2`; +z is the centre, -z the four corners.
pub fn encode(v: Vec3) -> Vec2 {
    let p = v.truncate() / (v.x.abs() + v.y.abs() + v.z.abs());
    if v.z >= 0.0 { p } else { fold(p) }
}

/// The unit vector of a point of the square; inverse of [`encode`].
pub fn decode(p: Vec2) -> Vec3 {
    let z = 1.0 - p.x.abs() - p.y.abs();
    (if z >= 0.0 { p } else { fold(p) }).extend(z).normalize()
}

/// Mirrors at the nearest edge of the inner diamond.
fn fold(p: Vec2) -> Vec2 {
    let sign = |x: f32| if x >= 0.0 { 1.0 } else { -1.0 };
    Vec2::new((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y))
}
