//! A tabulated curve: the reflectance spectrum integrated to R, G, B at each angle.

use glam::{DVec3, Vec3};

use super::TABLE_SIZE;
use crate::math::bounded;

/// The table at `cos_theta`, which is clamped to [0, 1]; linear between entries.
pub fn spectral(table: &[Vec3; TABLE_SIZE], cos_theta: f32) -> Vec3 {
    let x = bounded(cos_theta, 0.0, 1.0) * (TABLE_SIZE - 1) as f32;
    let entry = (x as usize).min(TABLE_SIZE - 2);
    table[entry].lerp(table[entry + 1], x - entry as f32)
}

/// Cosine-weighted mean over the hemisphere of the piecewise linear curve, exact: `2 int F x dx`.
pub(super) fn mean(table: &[Vec3; TABLE_SIZE]) -> Vec3 {
    let h = 1.0 / (TABLE_SIZE - 1) as f64;
    let mut sum = DVec3::ZERO;
    for (i, entry) in table.iter().enumerate() {
        // Moment of the hat function about entry i; half a hat at either end.
        let moment = match i {
            0 => h * h / 6.0,
            _ if i == TABLE_SIZE - 1 => h * (0.5 - h / 6.0),
            _ => h * (i as f64 * h),
        };
        sum += 2.0 * moment * entry.clamp(Vec3::ZERO, Vec3::ONE).as_dvec3();
    }
    sum.as_vec3()
}
