//! The whole surface, which is what a pass or a tracer evaluates: metal and dielectric mixed, under a coat.

#[cfg(test)]
mod tests;

use glam::{Vec2, Vec3};

use super::fresnel::{Fresnel, schlick};
use super::ggx::{self, Masking, albedo};
use super::{blinn_phong, coat, dielectric, lambert};
use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "layered",
    source: include_str!("layered.wgsl"),
    needs: &[&dielectric::WGSL, &coat::WGSL, &blinn_phong::WGSL],
    externs: "",
};

/// [`Lobe::Ggx`] in shaders.
pub const GGX: u32 = 0;

/// How metal and dielectric reflect; the coat is always GGX.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Lobe {
    /// Microfacets of [`Surface::alpha`].
    #[default]
    Ggx,
    /// A power of the cosine: isotropic, scattered once.
    BlinnPhong {
        /// 0 to [`blinn_phong::EXPONENT_MAX`].
        exponent: f32,
        /// What stands before the power.
        variant: blinn_phong::Variant,
    },
}

impl Lobe {
    /// Number in shaders, and the exponent.
    pub fn numbers(self) -> (u32, f32) {
        match self {
            Lobe::Ggx => (GGX, 0.0),
            Lobe::BlinnPhong { exponent, variant } => (variant as u32, exponent),
        }
    }

    /// What [`Surface::alpha`] must be: `alpha` itself, or the width that stands for the exponent.
    pub fn alpha(self, alpha: Vec2) -> Vec2 {
        match self {
            Lobe::Ggx => alpha,
            Lobe::BlinnPhong { exponent, .. } => Vec2::splat(blinn_phong::alpha(exponent)),
        }
    }

    /// A direction of light for `wo`, [`ggx::sample_wi`] or [`blinn_phong::sample_wi`]; `u` in `[0, 1)^2`.
    pub fn sample_wi(self, wo: Vec3, alpha: Vec2, u: Vec2) -> Option<Vec3> {
        match self {
            Lobe::Ggx => ggx::sample_wi(wo, alpha, u),
            Lobe::BlinnPhong { exponent, variant } => blinn_phong::sample_wi(wo, exponent, variant, u),
        }
    }

    /// Its density per steradian.
    pub fn pdf(self, wo: Vec3, wi: Vec3, alpha: Vec2) -> f32 {
        match self {
            Lobe::Ggx => ggx::pdf(wo, wi, alpha),
            Lobe::BlinnPhong { exponent, variant } => blinn_phong::pdf(wo, wi, exponent, variant),
        }
    }

    /// The cosine at the half vector and the BRDF for F = 1, as [`ggx::microfacet`] and [`blinn_phong::facet`].
    pub fn facet(self, wo: Vec3, wi: Vec3, alpha: Vec2, masking: Masking) -> Vec2 {
        match self {
            Lobe::Ggx => ggx::microfacet(wo, wi, alpha, masking),
            Lobe::BlinnPhong { exponent, variant } => blinn_phong::facet(wo, wi, exponent, variant),
        }
    }
}

/// A shaded point with its textures looked up. Colours are linear Rec.709 in [0, 1].
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// Albedo of the dielectric's base.
    pub base_color: Vec3,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// GGX widths along local x and y of the base; for other lobes those of [`Lobe::alpha`], which stand for them where
    /// tables are looked up.
    pub alpha: Vec2,
    /// How the base reflects.
    pub lobe: Lobe,
    /// Reflectance curve of the metal.
    pub fresnel: &'a Fresnel,
    /// Its cosine-weighted mean, [`Fresnel::mean`].
    pub fresnel_mean: Vec3,
    /// Reflectance of the dielectric at normal incidence, [`dielectric::f0`].
    pub dielectric_f0: Vec3,
    /// And at grazing.
    pub dielectric_f90: f32,
    /// Weight of the coat, in [0, 1].
    pub coat: f32,
    /// GGX width of the coat.
    pub coat_alpha: f32,
    /// Kind of masking, of all lobes.
    pub masking: Masking,
    /// False leaves out light that scattered more than once in the metal.
    pub multiple_scattering: bool,
}

impl Surface<'_> {
    /// True where the metal returns light that scattered more than once.
    pub fn scatters_again(&self) -> bool {
        self.multiple_scattering && self.lobe == Lobe::Ggx
    }
}

/// What metal and dielectric below the coat reflect at once: BRDF without the cosine. They share the lobe. On a mirror
/// this is the part that has no density.
pub fn glossy(s: &Surface, wo: Vec3, wi: Vec3) -> Vec3 {
    let facet = s.lobe.facet(wo, wi, s.alpha, s.masking);
    if facet.y > 0.0 { facet.y * reflectance(s, facet.x) } else { Vec3::ZERO }
}

/// Reflectance of metal and dielectric below the coat at the cosine to a (microfacet) normal.
pub fn reflectance(s: &Surface, cos_theta: f32) -> Vec3 {
    let mut value = Vec3::ZERO;
    if s.metallic > 0.0 {
        value += s.metallic * s.fresnel.eval(cos_theta);
    }
    if s.metallic < 1.0 {
        value += (1.0 - s.metallic) * schlick(s.dielectric_f0, s.dielectric_f90, cos_theta);
    }
    value
}

/// What leaves in all directions after it went on below the first reflection: the matte base of the dielectric and light
/// that scattered more than once in the metal. BRDF without the cosine.
pub fn spread(s: &Surface, wo: Vec3, wi: Vec3) -> Vec3 {
    if wo.z > 0.0 { Spread::new(s, wo).eval(s, wi) } else { Vec3::ZERO }
}

/// [`spread`] toward one direction, for many lights.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    /// Over what single scattering loses of the light.
    metal: Vec3,
    /// Over what the reflection of the dielectric leaves of the light.
    matte: Vec3,
}

impl Spread {
    /// Toward `wo`, which is above the horizon.
    pub fn new(s: &Surface, wo: Vec3) -> Spread {
        let (mut metal, mut matte) = (Vec3::ZERO, Vec3::ZERO);
        if s.metallic > 0.0 && s.scatters_again() {
            metal = s.metallic * ggx::multiple_toward(wo, s.alpha, s.fresnel_mean, s.masking);
        }
        if s.metallic < 1.0 {
            matte = (1.0 - s.metallic) * matte_toward(s, wo);
        }
        Spread { metal, matte }
    }

    /// From `wi`.
    pub fn eval(&self, s: &Surface, wi: Vec3) -> Vec3 {
        if wi.z <= 0.0 {
            return Vec3::ZERO;
        }
        let mut value = Vec3::ZERO;
        if self.metal != Vec3::ZERO {
            value += self.metal * albedo::loss(wi, s.alpha, s.masking);
        }
        value + self.eval_matte(s, wi)
    }

    /// The matte base alone.
    pub fn eval_matte(&self, s: &Surface, wi: Vec3) -> Vec3 {
        if wi.z > 0.0 && self.matte != Vec3::ZERO { self.matte * left(s, wi) } else { Vec3::ZERO }
    }
}

/// The dielectric's base toward `wo` over what the reflection leaves of the light; older shaders add it without 1 / pi.
fn matte_toward(s: &Surface, wo: Vec3) -> Vec3 {
    match s.lobe {
        Lobe::Ggx => dielectric::base_toward(wo, s.alpha, s.dielectric_f0, s.dielectric_f90, s.base_color, s.masking),
        Lobe::BlinnPhong { variant: blinn_phong::Variant::Unnormalized, .. } => s.base_color,
        Lobe::BlinnPhong { exponent, variant } => {
            // The mean leaves out what grazing light gets more by f90, so that the whole stays below one.
            let left_mean = 1.0 - s.dielectric_f0.max_element() * blinn_phong::albedo_mean(exponent, variant);
            lambert::eval(s.base_color) * (left(s, wo) / left_mean.max(1e-6))
        }
    }
}

/// Share of the light from `w` that the dielectric's reflection leaves to its base, in [0, 1].
fn left(s: &Surface, w: Vec3) -> f32 {
    match s.lobe {
        Lobe::Ggx => dielectric::left(w, s.alpha, s.dielectric_f0, s.dielectric_f90, s.masking),
        Lobe::BlinnPhong { variant: blinn_phong::Variant::Unnormalized, .. } => 1.0,
        Lobe::BlinnPhong { exponent, variant } => {
            let strongest = s.dielectric_f0.max_element();
            let ratio = albedo::schlick_ratio(w, s.alpha, s.masking);
            let mean = strongest + (s.dielectric_f90 - strongest) * ratio;
            (1.0 - blinn_phong::albedo(w.z, exponent, variant) * mean).max(0.0)
        }
    }
}

/// Share of light that the lobe returns toward `w` when F = 1: tabulated for GGX, fitted for others.
pub fn lobe_albedo(s: &Surface, w: Vec3) -> f32 {
    match s.lobe {
        Lobe::Ggx => 1.0 - albedo::loss(w, s.alpha, s.masking),
        Lobe::BlinnPhong { exponent, variant } => blinn_phong::albedo(w.z, exponent, variant),
    }
}

/// Share of even light that the dielectric's base sends toward `wo`, about; older shaders count it without 1 / pi.
pub fn matte_albedo(s: &Surface, wo: Vec3) -> Vec3 {
    match s.lobe {
        Lobe::BlinnPhong { variant: blinn_phong::Variant::Unnormalized, .. } => std::f32::consts::PI * s.base_color,
        _ => left(s, wo) * s.base_color,
    }
}

/// Metal and dielectric below the coat, [`glossy`] and [`spread`]: BRDF without the cosine.
pub fn base(s: &Surface, wo: Vec3, wi: Vec3) -> Vec3 {
    glossy(s, wo, wi) + spread(s, wo, wi)
}

/// Radiance toward `wo` over radiance from `wi` and solid angle: all lobes, each times the cosine of its own normal.
///
/// `wo` and `wi` are local to the base (x along its tangent), `coat_wo` and `coat_wi` the same directions local to the
/// coat. Reciprocal up to the cosines, and below one where both normals agree.
pub fn response(s: &Surface, wo: Vec3, wi: Vec3, coat_wo: Vec3, coat_wi: Vec3) -> Vec3 {
    let value = base(s, wo, wi) * wi.z.max(0.0);
    if s.coat <= 0.0 {
        return value;
    }
    let passed = coat::transmission(coat_wo, s.coat_alpha, s.coat, s.masking)
        * coat::transmission(coat_wi, s.coat_alpha, s.coat, s.masking);
    value * passed + s.coat * coat::eval(coat_wo, coat_wi, s.coat_alpha, s.masking) * coat_wi.z.max(0.0)
}
