//! Starting points of rays that leave a surface.

use glam::Vec3;

/// `position` moved off the surface to the side of `normal` on which `direction` leaves, by the rounding error of a
/// position of that magnitude.
pub fn offset(position: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
    position + side * (position.abs().max_element().max(1e-3) * 4e-6)
}
