//! Blinn-Phong: a power of the cosine at the half vector, normalised, and the forms in which older work uses it.
//!
//! The local frame has z = n; the exponent `s` is held between 0, which is matte, and [`EXPONENT_MAX`]. Single
//! scattering only, isotropic. What each [`Variant`] is good for stands in `README.md`.

#[cfg(test)]
mod tests;

use std::f32::consts::{FRAC_1_PI, TAU};

use glam::{Vec2, Vec3};

use super::fresnel::Fresnel;
use super::ggx::{half_vector, usable};
use super::{Sample, lambert};
use crate::leaf::Leaf;
use crate::math::{bounded, sampling};

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "blinn_phong",
    source: include_str!("blinn_phong.wgsl"),
    needs: &[&crate::math::WGSL, &super::fresnel::WGSL, &super::lambert::WGSL],
    externs: "",
};

/// Largest exponent: a lobe as wide as that of GGX at alpha 0.0045.
pub const EXPONENT_MAX: f32 = 1e5;
/// Least cosine by which [`Variant::Unnormalized`] divides.
pub const COS_MIN: f32 = 1e-6;
/// [`Variant::Exact`] in shaders; 0 stands for GGX there.
pub const EXACT: u32 = 1;
/// [`Variant::Approximate`] in shaders.
pub const APPROXIMATE: u32 = 2;
/// [`Variant::Unnormalized`] in shaders.
pub const UNNORMALIZED: u32 = 3;
/// [`Variant::Microfacet`] in shaders.
pub const MICROFACET: u32 = 4;

/// What stands before the power of the cosine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Variant {
    /// `(s + 2)(s + 4) / (8 pi (2^(-s/2) + s))`: returns all light at normal incidence, less elsewhere.
    #[default]
    Exact = EXACT,
    /// `(s + 8) / (8 pi)`, as in many renderers: returns up to 7.5 % more light than it gets, most at s = 9.
    Approximate = APPROXIMATE,
    /// Nothing, and no cosine of the light either: `kd (N.I) + ks (N.H)^n` of older shaders. Unbounded as a BRDF, and
    /// not reciprocal.
    Unnormalized = UNNORMALIZED,
    /// `(s + 2) / (2 pi)` times `1 / (4 (L.H)^2)`, microfacets without masking.
    Microfacet = MICROFACET,
}

impl Variant {
    /// All.
    pub const ALL: [Variant; 4] = [Variant::Exact, Variant::Approximate, Variant::Unnormalized, Variant::Microfacet];
}

/// `exponent` within its domain; what is not a number becomes 0.
pub fn clamp_exponent(exponent: f32) -> f32 {
    bounded(exponent, 0.0, EXPONENT_MAX)
}

/// GGX width with the same density of normals at the peak: `sqrt(2 / (s + 2))`, in [0.0045, 1].
///
/// Walter et al. 2007, section 5.2, between the Phong and the Beckmann distribution.
pub fn alpha(exponent: f32) -> f32 {
    (2.0 / (clamp_exponent(exponent) + 2.0)).sqrt()
}

/// Exponent of a width, the inverse of [`alpha`].
pub fn exponent(alpha: f32) -> f32 {
    // The floor lies beyond the largest exponent.
    clamp_exponent(2.0 / (alpha * alpha).max(1e-9) - 2.0)
}

/// `cos^s` of the angle between `wm` and the normal; 0 below the horizon.
///
/// From the sine where that is the smaller one: the logarithm of a cosine near 1 has no digits left.
pub fn power(wm: Vec3, exponent: f32) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let sin2 = wm.truncate().length_squared();
    let log_cos2 = if sin2 < 0.5 { (-sin2).ln_1p() } else { 2.0 * wm.z.ln() };
    (0.5 * clamp_exponent(exponent) * log_cos2).exp()
}

/// What [`power`] is multiplied with in a variant that depends on nothing but the exponent.
///
/// Exact: Giesen 2009, Phong and Blinn-Phong Normalization Factors. Its integral is that of `cos_i` over the
/// hemisphere with half the light's angle in the power.
pub fn normalizer(exponent: f32, variant: Variant) -> f32 {
    let s = clamp_exponent(exponent);
    let eighth = 0.125 * FRAC_1_PI;
    match variant {
        Variant::Exact => eighth * (s + 2.0) * (s + 4.0) / ((-0.5 * s).exp2() + s),
        Variant::Approximate => eighth * (s + 8.0),
        Variant::Unnormalized => 1.0,
        Variant::Microfacet => 0.5 * FRAC_1_PI * (s + 2.0),
    }
}

/// The cosine at the half vector, which is the argument of Fresnel, and the BRDF for F = 1; 0 where a direction is
/// below the horizon.
pub fn facet(wo: Vec3, wi: Vec3, exponent: f32, variant: Variant) -> Vec2 {
    let Some((wm, cos_theta)) = half_vector(wo, wi) else { return Vec2::ZERO };
    let lobe = normalizer(exponent, variant) * power(wm, exponent);
    let value = match variant {
        Variant::Exact | Variant::Approximate => lobe,
        Variant::Unnormalized => lobe / wi.z.max(COS_MIN),
        Variant::Microfacet => 0.25 * lobe / (cos_theta * cos_theta),
    };
    Vec2::new(cos_theta, value)
}

/// Share of light that the lobe returns toward the cosine `mu` in [0, 1] when F = 1.
///
/// Fits to the integral over the upper hemisphere. Relative error for exponents up to the largest: exact and
/// approximate 1.6 %, microfacet 4 %, unnormalised 12 % (for which it may exceed one). Away from the horizon the exact
/// variant has `(mu^2 (s - 2) + 2) / (s + 2^(-s/2))`, and a smooth lobe depends on `mu sqrt(s)`.
pub fn albedo(mu: f32, exponent: f32, variant: Variant) -> f32 {
    let (mu, s) = (mu.clamp(0.0, 1.0), clamp_exponent(exponent));
    let edge = (-0.5 * s).exp2();
    match variant {
        Variant::Exact | Variant::Approximate => {
            let x = mu * (s + 0.167).sqrt();
            let bend = s / (s + 0.95) * (1.0 - (-1.307 * x - 0.148 * x * x).exp()) * (1.0 + 0.28 * mu);
            let exact = (1.0 + mu * mu * (s - 1.0 + edge) + (1.0 - mu * mu) * bend) / (s + edge);
            exact * normalizer(s, variant) / normalizer(s, Variant::Exact)
        }
        Variant::Unnormalized => {
            let grazing = 0.434 / (s + 0.753).sqrt();
            let (flat, steep) = (grazing.powf(1.4175), (1.0 - 0.5 * edge).powf(1.4175));
            let root = flat + mu.powf(1.4686) * (steep - flat).max(0.0);
            4.0 * TAU / (s + 2.0) * root.powf(1.0 / 1.4175)
        }
        Variant::Microfacet => {
            let x = mu * (s + 1.984).sqrt();
            let dip = (1.0 - mu).powf(0.694) * x / (0.4125 * x * x * x + 3.518 * x + 0.819);
            1.0 - dip - (1.0 - microfacet_peak(s)) * mu.powf(0.748)
        }
    }
}

/// Albedo of microfacets at normal incidence, `2 - 2^(-s/2) - (s + 2)/s (1 - 2^(-s/2))`.
fn microfacet_peak(s: f32) -> f32 {
    let half_ln2 = 0.5 * std::f32::consts::LN_2;
    // (1 - 2^(-s/2)) / s, which is ln(2) / 2 at 0.
    let ratio = if s > 1e-3 { -(-half_ln2 * s).exp_m1() / s } else { half_ln2 };
    2.0 - (-0.5 * s).exp2() - (s + 2.0) * ratio
}

/// Cosine-weighted mean of [`albedo`] over the hemisphere: `(s + 2) / (2 (s + 2^(-s/2)))` for the exact variant; for
/// microfacets a fit, 0.02 off at most. The unnormalised variant shares no light with anything: 0.
pub fn albedo_mean(exponent: f32, variant: Variant) -> f32 {
    let s = clamp_exponent(exponent);
    match variant {
        Variant::Exact => 0.5 * (s + 2.0) / (s + (-0.5 * s).exp2()),
        Variant::Approximate => 0.5 * (s + 8.0) / (s + 4.0),
        Variant::Unnormalized => 0.0,
        Variant::Microfacet => (s + 2.56) / (s + 6.27),
    }
}

/// BRDF with the reflectance at the half vector, without the cosine. Blinn 1977.
pub fn eval(wo: Vec3, wi: Vec3, exponent: f32, variant: Variant, fresnel: &Fresnel) -> Vec3 {
    let facet = facet(wo, wi, exponent, variant);
    if facet.y == 0.0 { Vec3::ZERO } else { facet.y * fresnel.eval(facet.x) }
}

/// Chance that [`sample_wi`] draws by the cosine: broad lobes are nearly matte, and half vectors would often send the
/// light below the horizon. `2^(-s/8)` was found by trial; the unnormalised and the microfacet form are not
/// bounded by the cosine and do without.
pub fn cosine_share(exponent: f32, variant: Variant) -> f32 {
    match variant {
        Variant::Exact | Variant::Approximate => (-0.125 * clamp_exponent(exponent)).exp2(),
        Variant::Unnormalized | Variant::Microfacet => 0.0,
    }
}

/// A half vector with density `(s + 2) / (2 pi) cos^(s + 1)` per steradian; `u` in `[0, 1)^2`.
pub fn sample_wm(exponent: f32, u: Vec2) -> Vec3 {
    // cos^(s + 2) = 1 - u; the sine by `expm1`, since at large s all cosines are nearly 1.
    let log_cos2 = 2.0 * (-u.y).ln_1p() / (clamp_exponent(exponent) + 2.0);
    let sin_theta = (-log_cos2.exp_m1()).sqrt();
    (sin_theta * Vec2::from_angle(TAU * u.x)).extend((0.5 * log_cos2).exp())
}

/// A direction of light for `wo`, by reflection at [`sample_wm`] or by the cosine; `None` when it ends below the
/// horizon. `u` in `[0, 1)^2`.
pub fn sample_wi(wo: Vec3, exponent: f32, variant: Variant, u: Vec2) -> Option<Vec3> {
    if wo.z <= 0.0 {
        return None;
    }
    let share = cosine_share(exponent, variant);
    if u.y < share {
        let wi = sampling::cosine_hemisphere(Vec2::new(u.x, u.y / share));
        return (wi.z > 0.0).then_some(wi);
    }
    // The rest of the square, stretched; rounding must not bring it to one.
    let rest = ((u.y - share) / (1.0 - share)).min(1.0 - f32::EPSILON / 2.0);
    let wm = sample_wm(exponent, Vec2::new(u.x, rest));
    let toward = wo.dot(wm);
    let wi = (2.0 * toward * wm - wo).normalize();
    (toward > 0.0 && wi.z > 0.0).then_some(wi)
}

/// Density of [`sample_wi`] per steradian; 0 where a direction is below the horizon.
pub fn pdf(wo: Vec3, wi: Vec3, exponent: f32, variant: Variant) -> f32 {
    let Some((wm, cos_theta)) = half_vector(wo, wi) else { return 0.0 };
    let share = cosine_share(exponent, variant);
    let s = clamp_exponent(exponent);
    let density = 0.5 * FRAC_1_PI * (s + 2.0) * power(wm, s) * wm.z;
    (1.0 - share) * 0.25 * density / cos_theta + share * lambert::pdf(wi)
}

/// A direction from [`sample_wi`] with the BRDF.
pub fn sample(wo: Vec3, exponent: f32, variant: Variant, fresnel: &Fresnel, u: Vec2) -> Option<Sample> {
    let wi = sample_wi(wo, exponent, variant, u)?;
    let pdf = pdf(wo, wi, exponent, variant);
    usable(pdf).then(|| Sample { wi, value: eval(wo, wi, exponent, variant, fresnel), pdf })
}
