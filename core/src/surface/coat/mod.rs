//! A clear coat: colourless GGX reflection over another surface.
//!
//! The coat has a normal of its own: directions here are local to its frame.

#[cfg(test)]
mod tests;

use glam::{Vec2, Vec3};

use super::dielectric;
use super::fresnel::schlick;
use super::ggx::{self, Masking};
use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf =
    Leaf { name: "coat", source: include_str!("coat.wgsl"), needs: &[&dielectric::WGSL], externs: "" };

/// Reflectance of index 1.5 at normal incidence (KHR_materials_clearcoat).
pub const F0: f32 = 0.04;

/// The coat's reflection for weight 1: BRDF without the cosine.
pub fn eval(wo: Vec3, wi: Vec3, alpha: f32, masking: Masking) -> f32 {
    let facet = ggx::microfacet(wo, wi, Vec2::splat(alpha), masking);
    facet.y * schlick(Vec3::splat(F0), 1.0, facet.x).x
}

/// Share of the light that passes a coat of weight `coat` (in [0, 1]) toward `w`.
///
/// A surface below is multiplied by this toward `wo` and toward `wi`, once for each crossing, which keeps the whole
/// reciprocal and below one. KHR_materials_clearcoat's sample form takes `1 - coat F(<wo, n>)` once.
pub fn transmission(w: Vec3, alpha: f32, coat: f32, masking: Masking) -> f32 {
    if coat == 0.0 {
        return 1.0;
    }
    1.0 - coat * dielectric::albedo(w, Vec2::splat(alpha), F0, 1.0, masking)
}
