//! Starting points of rays that leave a surface.

use glam::{Affine3A, Mat3A, Vec3};

/// Half a unit in the last place of a number near 1.
const UNIT: f32 = 0.5 * f32::EPSILON;

/// Roundings that the coordinates of a point go through: sums and products of the way to the world (4), of the weighted
/// corners (4), of the step along the normal (1) and of the way back to local space (1). So many errors hardly ever all
/// add up: the rays of the tests need a third of both numbers.
const OF_COORDINATES: f32 = 10.0;

/// Roundings in the test of a triangle, of lengths within it: the shear (6) and the weighted depths (4).
const OF_LENGTHS: f32 = 10.0;

/// How far rounding may move a point of a triangle, in metres along each axis of the world: a bound on what lies between
/// the point that is computed from the weights of a hit and the triangle that the next ray is tested against. `corners` are
/// local.
///
/// Bounds on sums and products as in Pharr, Jakob and Humphreys 2023, Physically Based Rendering, section 6.8, with the
/// extent of the triangle for its test, since that starts from the differences of its corners and the origin of the ray.
pub fn rounding(world_from_local: &Affine3A, corners: [Vec3; 3]) -> Vec3 {
    let [a, b, c] = corners;
    let reach = a.abs().max(b.abs()).max(c.abs());
    let length = (a.max(b).max(c) - a.min(b).min(c)).max_element();
    let Affine3A { matrix3, translation } = *world_from_local;
    let to_world: Mat3A = matrix3.abs();
    let local = UNIT * (OF_COORDINATES * reach + OF_LENGTHS * length);
    to_world * local + Vec3::from(UNIT * OF_COORDINATES * translation.abs())
}

/// `position` on a triangle, moved off it to the side of `normal` (unit) on which `direction` leaves, so that a ray from
/// there meets neither the triangle nor one that goes on in its plane. The step is that of [`rounding`] along the normal:
/// none of what lies farther away is passed.
pub fn offset(position: Vec3, rounding: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
    position + side * normal.abs().dot(rounding)
}
