//! Starting points of rays that leave a surface.

use glam::Vec3;

/// Offset over the extent: some thirty units in the last place. The distance to a triangle is computed from its corners, so
/// its error grows with them, not with the point.
const RELATIVE: f32 = 4e-6;

/// `position` on a triangle, moved off it to the side of `normal` (unit) on which `direction` leaves, so that a ray from
/// there meets neither the triangle nor one that goes on in its plane. `extent` is the largest absolute coordinate of the
/// corners in the world, metres.
pub fn offset(position: Vec3, extent: f32, normal: Vec3, direction: Vec3) -> Vec3 {
    let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
    position + side * (extent.max(1e-3) * RELATIVE)
}
