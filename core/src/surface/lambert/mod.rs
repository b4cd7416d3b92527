//! A perfectly matte surface: the same radiance in every direction.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

use super::Sample;
use crate::leaf::Leaf;
use crate::math::sampling;

#[cfg(test)]
mod tests;

/// The WGSL twin.
pub static WGSL: Leaf =
    Leaf { name: "lambert", source: include_str!("lambert.wgsl"), needs: &[&crate::math::WGSL], externs: "" };

/// BRDF `albedo / pi`, without the cosine; albedo in [0, 1]. Lambert 1760, Photometria.
pub fn eval(albedo: Vec3) -> Vec3 {
    albedo * FRAC_1_PI
}

/// Density of [`sample`] per steradian: `cos / pi`.
pub fn pdf(wi: Vec3) -> f32 {
    wi.z.max(0.0) * FRAC_1_PI
}

/// A direction by the cosine; `u` in `[0, 1)^2`.
pub fn sample(albedo: Vec3, u: Vec2) -> Option<Sample> {
    let wi = sampling::cosine_hemisphere(u);
    (wi.z > 0.0).then(|| Sample { wi, value: eval(albedo), pdf: pdf(wi) })
}
