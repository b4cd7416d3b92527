//! The whole surface, which is what a pass or a tracer evaluates: metal and dielectric mixed, under a coat.

#[cfg(test)]
mod tests;

use glam::{Vec2, Vec3};

use super::fresnel::{Fresnel, schlick};
use super::ggx::{self, Masking};
use super::{coat, dielectric};
use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "layered",
    source: include_str!("layered.wgsl"),
    needs: &[&dielectric::WGSL, &coat::WGSL],
    externs: "",
};

/// A shaded point with its textures looked up. Colours are linear Rec.709 in [0, 1].
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// Albedo of the dielectric's base.
    pub base_color: Vec3,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// GGX widths along local x and y of the base.
    pub alpha: Vec2,
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

/// Metal and dielectric below the coat: BRDF without the cosine. They share width and so the microfacet term.
pub fn base(s: &Surface, wo: Vec3, wi: Vec3) -> Vec3 {
    let facet = ggx::microfacet(wo, wi, s.alpha, s.masking);
    let mut value = Vec3::ZERO;
    if s.metallic > 0.0 {
        let mut metal = facet.y * s.fresnel.eval(facet.x);
        if s.multiple_scattering {
            metal += ggx::multiple(wo, wi, s.alpha, s.fresnel_mean, s.masking);
        }
        value += s.metallic * metal;
    }
    if s.metallic < 1.0 {
        let reflected = facet.y * schlick(s.dielectric_f0, s.dielectric_f90, facet.x);
        let base = dielectric::base(wo, wi, s.alpha, s.dielectric_f0, s.dielectric_f90, s.base_color, s.masking);
        value += (1.0 - s.metallic) * (reflected + base);
    }
    value
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
