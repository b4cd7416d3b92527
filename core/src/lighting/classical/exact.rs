//! What the method approximates, in f64 and without haste: the yardstick of its tests and of its error tables.

use glam::{DVec3, Vec2, Vec3};

use crate::math::frame::Frame;
use crate::math::sampling;
use crate::scene::Environment;
use crate::surface::ggx::{self, Masking};

/// A lobe this many texels wide is integrated by summing texels, a narrower one by drawing the lobe.
const TEXELS_SUMMED: f32 = 5.0;
/// Points of a lobe that is drawn.
const LOBE_SAMPLES: u32 = 1 << 14;
/// Parts along an edge into which a texel near the peak of a lobe is cut.
const PARTS: u32 = 4;

/// An environment as a list of texels, for sums over the whole sphere.
pub struct Texels<'a> {
    environment: &'a Environment,
    list: Vec<Texel>,
}

struct Texel {
    direction: Vec3,
    radiance: Vec3,
    solid_angle: f32,
}

impl<'a> Texels<'a> {
    /// Directions, radiances and solid angles of all texels; 28 bytes each.
    pub fn new(environment: &'a Environment) -> Texels<'a> {
        let mut list = Vec::with_capacity(environment.texels.len());
        for y in 0..environment.height {
            let solid_angle = environment.texel_solid_angle(y) as f32;
            for x in 0..environment.width {
                let direction = environment.texel_direction(x, y, Vec2::splat(0.5));
                list.push(Texel { direction, radiance: environment.radiance(direction), solid_angle });
            }
        }
        Texels { environment, list }
    }

    /// Radiance that a level of the prefiltered cube should hold: the lobe of N = V = R, weight D(h) cos(theta_i).
    pub fn prefiltered(&self, normal: Vec3, alpha: f32) -> DVec3 {
        let a2 = f64::from(alpha).powi(2);
        let weight = |direction: Vec3| {
            let cos_i = f64::from(direction.dot(normal));
            // sin^2 and cos^2 of the half vector's angle; D up to its constant factor.
            let (sin2_h, cos2_h) = (0.25 * f64::from((direction - normal).length_squared()), 0.5 * (1.0 + cos_i));
            let denominator = sin2_h + a2 * cos2_h;
            if cos_i <= 0.0 { 0.0 } else { cos_i / (denominator * denominator) }
        };
        // Texels are cut where the lobe changes within one: out to some widths, and a texel's diagonal.
        let texel = std::f32::consts::TAU / self.environment.width as f32;
        let near = (1.0 - (8.0 * alpha + 2.0 * texel).powi(2) * 0.5).max(-1.0);
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for (index, texel) in self.list.iter().enumerate() {
            let cos_i = texel.direction.dot(normal);
            if cos_i <= 0.0 {
                continue;
            }
            if alpha < 0.1 && cos_i > near {
                let share = f64::from(texel.solid_angle) / f64::from(PARTS * PARTS);
                for (direction, radiance) in self.parts(index as u32) {
                    let w = weight(direction) * share;
                    sum += w * radiance.as_dvec3();
                    weights += w;
                }
            } else {
                let w = weight(texel.direction) * f64::from(texel.solid_angle);
                sum += w * texel.radiance.as_dvec3();
                weights += w;
            }
        }
        sum / weights.max(1e-300)
    }

    /// Directions and interpolated radiances of the parts of a texel.
    fn parts(&self, index: u32) -> impl Iterator<Item = (Vec3, Vec3)> {
        let (x, y) = (index % self.environment.width, index / self.environment.width);
        (0..PARTS * PARTS).map(move |part| {
            let inside = (Vec2::new((part % PARTS) as f32, (part / PARTS) as f32) + 0.5) / PARTS as f32;
            let direction = self.environment.texel_direction(x, y, inside);
            (direction, self.environment.radiance(direction))
        })
    }

    /// Radiance that an isotropic GGX surface with F = 1 (single scattering) reflects toward `to_viewer`.
    pub fn reflected(&self, normal: Vec3, to_viewer: Vec3, alpha: f32, masking: Masking) -> DVec3 {
        let frame = Frame::new(normal);
        let wo = frame.to_local(to_viewer);
        let texel = std::f32::consts::TAU / self.environment.width as f32;
        if alpha < TEXELS_SUMMED * texel {
            self.reflected_by_lobe(&frame, wo, Vec2::splat(alpha), masking)
        } else {
            self.reflected_by_texels(&frame, wo, Vec2::splat(alpha), masking)
        }
    }

    fn reflected_by_texels(&self, frame: &Frame, wo: Vec3, alpha: Vec2, masking: Masking) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for texel in &self.list {
            let cos_i = texel.direction.dot(frame.n);
            if cos_i > 0.0 {
                let value = ggx::microfacet(wo, frame.to_local(texel.direction), alpha, masking).y;
                sum += f64::from(value * cos_i * texel.solid_angle) * texel.radiance.as_dvec3();
            }
        }
        sum
    }

    fn reflected_by_lobe(&self, frame: &Frame, wo: Vec3, alpha: Vec2, masking: Masking) -> DVec3 {
        let g1 = ggx::masking(wo, alpha).max(1e-12);
        let mut sum = DVec3::ZERO;
        for i in 0..LOBE_SAMPLES {
            let wm = ggx::sample_wm(wo, alpha, sampling::hammersley(i, LOBE_SAMPLES));
            let wi = 2.0 * wo.dot(wm) * wm - wo;
            if wi.z > 0.0 {
                let weight = ggx::shadowing_masking(wo, wi, alpha, masking) / g1;
                sum += f64::from(weight) * self.environment.radiance(frame.to_world(wi)).as_dvec3();
            }
        }
        sum / f64::from(LOBE_SAMPLES)
    }
}
