//! Simple bodies that stand for the surroundings.

use glam::Vec3;

use super::Found;

/// Where a ray from inside leaves the sphere about the middle; `None` from outside.
pub(super) fn sphere(x: Vec3, r: Vec3, radius: f32) -> Option<f32> {
    let (b, c) = (x.dot(r), x.length_squared() - radius * radius);
    (c <= 0.0).then(|| (b * b - c).max(0.0).sqrt() - b)
}

/// Where a ray from inside leaves a box: Lagarde and Zanuttini 2012, Local Image-based Lighting with Parallax-corrected
/// Cubemap. `None` from outside.
pub(super) fn cuboid(x: Vec3, r: Vec3, low: Vec3, high: Vec3) -> Option<f32> {
    let inside = x.cmpge(low).all() && x.cmple(high).all();
    let axis = |x: f32, r: f32, low: f32, high: f32| (if r > 0.0 { high - x } else { x - low }) / r.abs().max(1e-20);
    let t = axis(x.x, r.x, low.x, high.x).min(axis(x.y, r.y, low.y, high.y)).min(axis(x.z, r.z, low.z, high.z));
    inside.then_some(t)
}

pub(super) fn found(t: Option<f32>) -> Found {
    t.map_or(Found::MISS, |t| Found { t: t.max(0.0), ratio: 1.0, lookups: 0, is_hit: true })
}
