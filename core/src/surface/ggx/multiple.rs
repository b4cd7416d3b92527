//! Light that leaves a rough metal after more than one reflection.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

use super::Masking;
use super::albedo::{loss, loss_mean};

/// BRDF of the light that scattered more than once, without the cosine; reciprocal.
///
/// `F_ms (1 - E(wo))(1 - E(wi)) / (pi (1 - E_avg))` with `F_ms = F^2 E_avg / (1 - F (1 - E_avg))` and F the
/// cosine-weighted mean of the curve ([`Fresnel::mean`](crate::surface::fresnel::Fresnel::mean)). Kulla and Conty 2017,
/// Revisiting Physically Based Shading at Imageworks; F_ms after Turquin 2019.
pub fn multiple(wo: Vec3, wi: Vec3, alpha: Vec2, fresnel_mean: Vec3, masking: Masking) -> Vec3 {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return Vec3::ZERO;
    }
    multiple_toward(wo, alpha, fresnel_mean, masking) * loss(wi, alpha, masking)
}

/// [`multiple`] over what single scattering loses of the light, [`loss`]: what depends on one side alone, for those who
/// evaluate many lights.
pub fn multiple_toward(wo: Vec3, alpha: Vec2, fresnel_mean: Vec3, masking: Masking) -> Vec3 {
    let mean = loss_mean(alpha, masking);
    bounces(fresnel_mean, mean) * (loss(wo, alpha, masking) * FRAC_1_PI / mean)
}

/// What all bounces after the first keep of white light, `F_ms`; `loss_mean` is that of the surface,
/// [`loss_mean`](fn@super::albedo::loss_mean). A surface under even light returns `F_ms (1 - E(wo))` of it this way.
pub fn bounces(fresnel_mean: Vec3, loss_mean: f32) -> Vec3 {
    let f = fresnel_mean.clamp(Vec3::ZERO, Vec3::ONE);
    f * f * (1.0 - loss_mean) / (Vec3::ONE - f * loss_mean)
}
