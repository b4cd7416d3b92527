//! A dielectric: GGX reflection over a matte base that receives what the reflection leaves.

#[cfg(test)]
mod tests;

use glam::{Vec2, Vec3};

use super::fresnel::schlick;
use super::ggx::albedo::{loss, loss_mean, schlick_mean, schlick_ratio};
use super::ggx::{self, Masking};
use super::{Sample, lambert};
use crate::leaf::Leaf;
use crate::math::sampling;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "dielectric",
    source: include_str!("dielectric.wgsl"),
    needs: &[&ggx::WGSL, &lambert::WGSL],
    externs: "",
};

/// Reflectance at normal incidence by KHR_materials_ior and KHR_materials_specular: `specular min(((ior - 1)/(ior +
/// 1))^2 specular_color, 1)`. `ior` >= 1 (or 0, which reflects everything), `specular` in [0, 1], which is also f90.
pub fn f0(ior: f32, specular: f32, specular_color: Vec3) -> Vec3 {
    let r = (ior - 1.0) / (ior + 1.0);
    specular * (r * r * specular_color).min(Vec3::ONE)
}

/// Share of the light from `w` that the reflection takes: its directional albedo, in [0, 1].
pub fn albedo(w: Vec3, alpha: Vec2, f0: f32, f90: f32, masking: Masking) -> f32 {
    if f0 == 0.0 && f90 == 0.0 {
        return 0.0;
    }
    (1.0 - loss(w, alpha, masking)) * (f0 + (f90 - f0) * schlick_ratio(w, alpha, masking))
}

/// Cosine-weighted mean of [`albedo`] over the hemisphere.
pub fn albedo_mean(alpha: Vec2, f0: f32, f90: f32, masking: Masking) -> f32 {
    f0 * (1.0 - loss_mean(alpha, masking)) + (f90 - f0) * schlick_mean(alpha, masking)
}

/// Matte part below the reflection: BRDF without the cosine, `base (1 - E(wo))(1 - E(wi)) / (pi (1 - E_avg))`.
///
/// Reciprocal, and what the reflection takes and what the base gets sum to one: Kelemen and Szirmay-Kalos 2001, A
/// Microfacet Based Coupled Specular-Matte BRDF Model. The largest channel of `f0` takes from all channels, so that a
/// tinted reflection does not tint the base with the complement.
pub fn base(wo: Vec3, wi: Vec3, alpha: Vec2, f0: Vec3, f90: f32, base_color: Vec3, masking: Masking) -> Vec3 {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return Vec3::ZERO;
    }
    base_toward(wo, alpha, f0, f90, base_color, masking) * left(wi, alpha, f0, f90, masking)
}

/// [`base`] over [`left`] of the light: what depends on one side alone, for those who evaluate many lights.
pub fn base_toward(wo: Vec3, alpha: Vec2, f0: Vec3, f90: f32, base_color: Vec3, masking: Masking) -> Vec3 {
    let left_mean = match f90 == 0.0 && f0 == Vec3::ZERO {
        true => 1.0,
        false => 1.0 - albedo_mean(alpha, f0.max_element(), f90, masking),
    };
    // The floor acts only where f0 and f90 are one and nothing is left to share out.
    lambert::eval(base_color) * (left(wo, alpha, f0, f90, masking) / left_mean.max(1e-6))
}

/// Share of the light from `w` that the reflection leaves to the base.
pub fn left(w: Vec3, alpha: Vec2, f0: Vec3, f90: f32, masking: Masking) -> f32 {
    1.0 - albedo(w, alpha, f0.max_element(), f90, masking)
}

/// Reflection and base: BRDF without the cosine. `f0` and `f90` in [0, 1].
pub fn eval(wo: Vec3, wi: Vec3, alpha: Vec2, f0: Vec3, f90: f32, base_color: Vec3, masking: Masking) -> Vec3 {
    let facet = ggx::microfacet(wo, wi, alpha, masking);
    let reflected = facet.y * schlick(f0, f90, facet.x);
    reflected + base(wo, wi, alpha, f0, f90, base_color, masking)
}

/// A dielectric as a whole, for sampling.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric {
    /// Widths along local x and y.
    pub alpha: Vec2,
    /// Reflectance at normal incidence, in [0, 1].
    pub f0: Vec3,
    /// Reflectance at grazing, in [0, 1].
    pub f90: f32,
    /// Albedo of the base, in [0, 1].
    pub base_color: Vec3,
    /// Kind of masking.
    pub masking: Masking,
}

impl Dielectric {
    /// [`eval`](fn@eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let Dielectric { alpha, f0, f90, base_color, masking } = *self;
        eval(wo, wi, alpha, f0, f90, base_color, masking)
    }

    /// A direction from the reflection or, for the base, by the cosine; `u` in `[0, 1)^3`, its z chooses.
    pub fn sample(&self, wo: Vec3, u: Vec3) -> Option<Sample> {
        if wo.z <= 0.0 {
            return None;
        }
        let wi = if u.z < self.base_share(wo) {
            sampling::cosine_hemisphere(u.truncate())
        } else {
            ggx::sample_wi(wo, self.alpha, u.truncate())?
        };
        let pdf = self.pdf(wo, wi);
        ggx::usable(pdf).then(|| Sample { wi, value: self.eval(wo, wi), pdf })
    }

    /// Density of [`Dielectric::sample`] per steradian.
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let share = self.base_share(wo);
        (1.0 - share) * ggx::pdf(wo, wi, self.alpha) + share * lambert::pdf(wi)
    }

    /// Chance of choosing the cosine lobe: the base's part in the light toward `wo`.
    fn base_share(&self, wo: Vec3) -> f32 {
        let reflected = albedo(wo, self.alpha, self.f0.max_element(), self.f90, self.masking);
        let base = (1.0 - reflected) * self.base_color.max_element();
        if reflected + base > 0.0 { base / (reflected + base) } else { 0.0 }
    }
}
