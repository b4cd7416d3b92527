//! GGX microfacets: rough metal, and the reflection of rough dielectrics.
//!
//! The local frame has z = n; `alpha` holds the widths along x and y, each held between [`ALPHA_MIN`] and one. Below
//! the floor a surface is a mirror: [`is_mirror`] tells a tracer to treat it as one, all else stays at the floor.
//!
//! - this file: distribution, masking, single-scattering BRDF and its sampling
//! - [`albedo`]: what single scattering reflects in total, tabulated
//! - [`multiple`](fn@multiple): the light that scattered more than once
//! - [`Conductor`]: both together, with sampling

pub mod albedo;
mod conductor;
mod multiple;
pub mod reflection;

#[cfg(test)]
mod tests;

use std::f32::consts::{FRAC_1_PI, TAU};

use glam::{Vec2, Vec3, Vec3Swizzles};

use super::Sample;
use super::fresnel::Fresnel;
use crate::leaf::Leaf;
use crate::math::bounded;

pub use conductor::Conductor;
pub use multiple::{bounces, multiple, multiple_toward};

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "ggx",
    source: include_str!("ggx.wgsl"),
    needs: &[&crate::math::WGSL, &super::fresnel::WGSL],
    externs: "fn ggx_albedo_entry(index: u32) -> f32 { return 0.5; }",
};

/// Below this width a surface is a mirror: the lobe is narrower than a pixel and f32 begins to lose its normals.
pub const ALPHA_MIN: f32 = 1e-3;
/// [`Masking::Correlated`] in shaders.
pub const CORRELATED: u32 = 0;
/// [`Masking::Separable`] in shaders.
pub const SEPARABLE: u32 = 1;

/// How often a microfacet that one side sees is seen by the other. Smith 1967; Heitz 2014, eq. 98 and 99.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Masking {
    /// A high microfacet is seen by both: `G = 1 / (1 + Lambda_o + Lambda_i)`.
    #[default]
    Correlated = CORRELATED,
    /// Independent: `G = 1 / ((1 + Lambda_o)(1 + Lambda_i))`; darker, as in Mitsuba.
    Separable = SEPARABLE,
}

impl Masking {
    /// Both.
    pub const ALL: [Masking; 2] = [Masking::Correlated, Masking::Separable];
}

/// `alpha` within its domain; what is not a number becomes the floor.
pub fn clamp_alpha(alpha: Vec2) -> Vec2 {
    Vec2::new(bounded(alpha.x, ALPHA_MIN, 1.0), bounded(alpha.y, ALPHA_MIN, 1.0))
}

/// True when the surface is smoother than this model draws it.
pub fn is_mirror(alpha: Vec2) -> bool {
    alpha.max_element() < ALPHA_MIN
}

/// Density of microfacet normals per steradian and projected area: `int D(wm) cos dwm = 1`.
///
/// `D = 1 / (pi at ab (x^2/at^2 + y^2/ab^2 + z^2)^2)`, Walter et al. 2007, eq. 33 made anisotropic; written without
/// `1 - cos^2`, which would cancel at small alpha.
pub fn distribution(wm: Vec3, alpha: Vec2) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let a = clamp_alpha(alpha);
    let area = a.x * a.y;
    let v = Vec3::new(wm.x * a.y, wm.y * a.x, wm.z * area);
    let w = area / v.length_squared();
    area * w * w * FRAC_1_PI
}

/// `|(at x, ab y, z)|`, which is `cos sqrt(1 + alpha^2 tan^2)`: finite at grazing, unlike the tangent.
pub fn stretched(w: Vec3, alpha: Vec2) -> f32 {
    (clamp_alpha(alpha) * w.xy()).extend(w.z).length()
}

/// Smith's Lambda, hidden over visible area: `(sqrt(1 + alpha^2 tan^2) - 1) / 2`; the cosine is floored at 1e-7.
pub fn lambda(w: Vec3, alpha: Vec2) -> f32 {
    0.5 * (stretched(w, alpha) - w.z.abs()) / w.z.abs().max(1e-7)
}

/// Fraction of the microfacets facing `w` that it sees, `G1 = 1 / (1 + Lambda)`; 0 below the horizon.
pub fn masking(w: Vec3, alpha: Vec2) -> f32 {
    if w.z <= 0.0 {
        return 0.0;
    }
    2.0 * w.z / (w.z + stretched(w, alpha))
}

/// Fraction seen from both sides; 0 when either is below the horizon.
pub fn shadowing_masking(wo: Vec3, wi: Vec3, alpha: Vec2, masking: Masking) -> f32 {
    4.0 * wo.z.max(0.0) * wi.z.max(0.0) * visibility(wo, wi, alpha, masking)
}

/// [`shadowing_masking`] over `4 cos_o cos_i`, finite at grazing.
pub fn visibility(wo: Vec3, wi: Vec3, alpha: Vec2, masking: Masking) -> f32 {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return 0.0;
    }
    let (so, si) = (stretched(wo, alpha), stretched(wi, alpha));
    let inverse = match masking {
        Masking::Correlated => 2.0 * (wi.z * so + wo.z * si),
        Masking::Separable => (wo.z + so) * (wi.z + si),
    };
    // The floor acts only where a cosine is below 1e-9.
    1.0 / inverse.max(1e-12)
}

/// The cosine at the microfacet that reflects `wi` to `wo`, and `D G / (4 cos_o cos_i)`, which is 0 where either is
/// below the horizon.
pub fn microfacet(wo: Vec3, wi: Vec3, alpha: Vec2, masking: Masking) -> Vec2 {
    match half_vector(wo, wi) {
        Some((wm, cos_theta)) => Vec2::new(cos_theta, distribution(wm, alpha) * visibility(wo, wi, alpha, masking)),
        None => Vec2::ZERO,
    }
}

/// Half vector and its cosine with either direction; `None` where one is below the horizon or the two are opposite.
pub(super) fn half_vector(wo: Vec3, wi: Vec3) -> Option<(Vec3, f32)> {
    let h = wo + wi;
    let length2 = h.length_squared();
    let length = length2.sqrt();
    // The cosine is half the length of the sum of two unit vectors: the same from both sides to the last bit.
    (wo.z > 0.0 && wi.z > 0.0 && length2 >= 1e-24).then(|| (h / length, 0.5 * length))
}

/// Single-scattering BRDF `F D G / (4 cos_o cos_i)`, without the cosine. Cook and Torrance 1982; Walter et al. 2007.
pub fn eval(wo: Vec3, wi: Vec3, alpha: Vec2, fresnel: &Fresnel, masking: Masking) -> Vec3 {
    let facet = microfacet(wo, wi, alpha, masking);
    if facet.y == 0.0 { Vec3::ZERO } else { facet.y * fresnel.eval(facet.x) }
}

/// A microfacet normal visible from `wo`, which is above the horizon; `u` in `[0, 1)^2`.
///
/// The stretched lobe is half a sphere whose reflections fill a spherical cap: Dupuy and Benyoub 2023, Sampling Visible
/// GGX Normals with Spherical Caps.
pub fn sample_wm(wo: Vec3, alpha: Vec2, u: Vec2) -> Vec3 {
    let a = clamp_alpha(alpha);
    let view = (a * wo.xy()).extend(wo.z).normalize();
    // The cap reaches from z = 1 down to -view.z. `below` is 1 - z, and h.z = z + view.z: no digit is lost.
    let below = u.y * (1.0 + view.z);
    let sin_theta = (below * (2.0 - below)).clamp(0.0, 1.0).sqrt();
    let h = (sin_theta * Vec2::from_angle(TAU * u.x) + view.xy()).extend((1.0 - u.y) * (1.0 + view.z));
    (a * h.xy()).extend(h.z.max(1e-20)).normalize()
}

/// Density of [`sample_wm`] per steradian of `wm`: `G1(wo) D(wm) <wo, wm> / cos_o`. Heitz 2018, eq. 1.
pub fn pdf_wm(wo: Vec3, wm: Vec3, alpha: Vec2) -> f32 {
    let toward = wo.dot(wm);
    if wo.z <= 0.0 || toward <= 0.0 {
        return 0.0;
    }
    distribution(wm, alpha) * 2.0 * toward / (wo.z + stretched(wo, alpha))
}

/// A direction by reflection at [`sample_wm`], with the single-scattering BRDF.
pub fn sample(wo: Vec3, alpha: Vec2, fresnel: &Fresnel, masking: Masking, u: Vec2) -> Option<Sample> {
    let wi = sample_wi(wo, alpha, u)?;
    let pdf = pdf(wo, wi, alpha);
    usable(pdf).then(|| Sample { wi, value: eval(wo, wi, alpha, fresnel, masking), pdf })
}

/// Density per steradian of `wi` in [`sample`]: `pdf_wm / (4 <wo, wm>)`.
pub fn pdf(wo: Vec3, wi: Vec3, alpha: Vec2) -> f32 {
    half_vector(wo, wi).map_or(0.0, |(wm, _)| 0.5 * distribution(wm, alpha) / (wo.z + stretched(wo, alpha)))
}

/// `wo` reflected at a visible normal; `None` when it ends below the horizon.
pub fn sample_wi(wo: Vec3, alpha: Vec2, u: Vec2) -> Option<Vec3> {
    if wo.z <= 0.0 {
        return None;
    }
    let wm = sample_wm(wo, alpha, u);
    let wi = (2.0 * wo.dot(wm) * wm - wo).normalize();
    (wi.z > 0.0).then_some(wi)
}

/// A density that may be divided by.
pub(super) fn usable(pdf: f32) -> bool {
    pdf > 0.0 && pdf.is_finite()
}
