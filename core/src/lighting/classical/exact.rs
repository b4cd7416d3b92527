//! What the method approximates, in f64 and without haste: the yardstick of its tests and of its error table.

use glam::{DVec3, Vec2, Vec3};

use crate::math::frame::Frame;
use crate::math::sampling;
use crate::scene::Environment;
use crate::surface::ggx::{self, Masking};

/// Below this width a lobe is sampled, above it texels are summed: the lobe is then wider than several texels of a
/// 1k map.
const ALPHA_SUMMED: f32 = 0.03;
/// Samples of a narrow lobe.
const LOBE_SAMPLES: u32 = 1 << 15;

/// Radiance that a level of the prefiltered cube should hold: the lobe of N = V = R, weight D(h) cos(theta_i).
///
/// Sums `parts * parts` points of every texel that the lobe reaches.
pub fn prefiltered(environment: &Environment, normal: Vec3, alpha: f32, parts: u32) -> DVec3 {
    let mut sum = DVec3::ZERO;
    let mut weights = 0.0;
    let a2 = f64::from(alpha).powi(2);
    let n = normal.as_dvec3();
    environment.for_each_part(0..environment.height, parts, |direction, radiance, solid_angle| {
        let cos_i = direction.as_dvec3().dot(n);
        if cos_i <= 0.0 {
            return;
        }
        // cos^2 of the half vector between N and L is (1 + cos_i) / 2; D up to its constant factor.
        let cos2_h = 0.5 * (1.0 + cos_i);
        let denominator = 1.0 - cos2_h + a2 * cos2_h;
        let weight = solid_angle * cos_i / (denominator * denominator);
        sum += weight * radiance;
        weights += weight;
    });
    sum / weights.max(1e-300)
}

/// Radiance that a GGX mirror with F = 1 (single scattering, isotropic) sends toward `to_viewer`.
pub fn reflected(
    environment: &Environment,
    normal: Vec3,
    to_viewer: Vec3,
    alpha: f32,
    masking: Masking,
) -> DVec3 {
    if alpha < ALPHA_SUMMED {
        reflected_by_lobe(environment, normal, to_viewer, alpha, masking)
    } else {
        reflected_by_texels(environment, normal, to_viewer, alpha, masking)
    }
}

fn reflected_by_texels(e: &Environment, normal: Vec3, to_viewer: Vec3, alpha: f32, masking: Masking) -> DVec3 {
    let frame = Frame::new(normal);
    let wo = frame.to_local(to_viewer);
    let width = Vec2::splat(alpha);
    let mut sum = DVec3::ZERO;
    e.for_each_part(0..e.height, 1, |direction, radiance, solid_angle| {
        let cos_i = direction.dot(normal);
        if cos_i > 0.0 {
            let wi = frame.to_local(direction);
            let value = ggx::half(wo, wi, width, masking).w;
            sum += radiance * (f64::from(value * cos_i) * solid_angle);
        }
    });
    sum
}

fn reflected_by_lobe(e: &Environment, normal: Vec3, to_viewer: Vec3, alpha: f32, masking: Masking) -> DVec3 {
    let frame = Frame::new(normal);
    let wo = frame.to_local(to_viewer);
    let width = Vec2::splat(alpha);
    let g1 = ggx::masking(wo, width).max(1e-12);
    let mut sum = DVec3::ZERO;
    for i in 0..LOBE_SAMPLES {
        let wm = ggx::sample_wm(wo, width, sampling::hammersley(i, LOBE_SAMPLES));
        let wi = 2.0 * wo.dot(wm) * wm - wo;
        if wi.z > 0.0 {
            let weight = ggx::shadowing_masking(wo, wi, width, masking) / g1;
            sum += e.radiance(frame.to_world(wi)).as_dvec3() * f64::from(weight);
        }
    }
    sum / f64::from(LOBE_SAMPLES)
}
