//! Schlick's curve, for metals with F0 that ignores extinction (`schlick`) or with the true one (`rescaled`).

use glam::Vec3;

/// `f0 + (f90 - f0)(1 - cos)^5`. Schlick 1994, An Inexpensive BRDF Model for Physically-based Rendering.
pub fn schlick(f0: Vec3, f90: f32, cos_theta: f32) -> Vec3 {
    let y = 1.0 - cos_theta.clamp(0.0, 1.0);
    let y2 = y * y;
    f0 + (Vec3::splat(f90) - f0) * (y2 * y2 * y)
}

/// Cosine-weighted mean of [`schlick`] over the hemisphere: `f0 + (f90 - f0) / 21`.
pub fn schlick_mean(f0: Vec3, f90: f32) -> Vec3 {
    f0 + (Vec3::splat(f90) - f0) / 21.0
}
