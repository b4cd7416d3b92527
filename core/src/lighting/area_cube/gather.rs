//! The light of all caps that a surface reflects. The twin of `area_cube.wgsl`.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::tables::{self, CHORD_MAX, Normals, lambert};
use super::{Cap, NEIGHBOURS, Texels, localised, neighbour, texel_at};
use crate::lighting::classical::{facing, multiple_albedo, reflection_occlusion, width};
use crate::math::frame::Frame;
use crate::surface::blinn_phong::Variant;
use crate::surface::coat;
use crate::surface::ggx::{self, Masking};
use crate::surface::layered::{self, Surface};
use crate::surface::{blinn_phong, ggx::albedo};

/// The least cosine toward the light of a cap that the horizon cuts.
pub const HORIZON: f32 = 1e-4;

/// Weights below this are roundings: a lobe that none of the caps meets is dark.
pub const LEAST: f32 = 1e-30;

/// A lobe of normals, isotropic.
#[derive(Clone, Copy, Debug)]
pub struct Lobe {
    /// Its kind.
    pub kind: layered::Lobe,
    /// Width of GGX, or what stands for the exponent.
    pub alpha: f32,
    /// Of GGX.
    pub masking: Masking,
}

/// What is asked of the texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asked {
    /// A lobe looks only at the texel that its reflection meets and the four beside it.
    pub few: bool,
    /// See [`localised`].
    pub corrected: bool,
    /// Caps neither tile the sphere nor is the mean over them exact: what they give is divided by what they would give of
    /// even light, and multiplied by what a surface reflects of that.
    pub normalized: bool,
    /// Lobes are taken at the middles of caps instead of their mean over them: one sample a light.
    pub middles: bool,
}

/// Where a surface is and where its reflections are seen from the middle of the cube.
#[derive(Clone, Copy, Debug)]
pub struct Looked {
    /// From the middle, metres.
    pub x: Vec3,
    /// Unit, in which the middle sees what the mirrored direction of the base meets.
    pub base: Vec3,
    /// And that of the coat.
    pub coat: Vec3,
}

/// Sums over caps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gathered {
    /// Radiance toward the viewer for F = 1.
    pub light: Vec3,
    /// The same of light that is 1 everywhere.
    pub weight: f32,
    /// Sum over the channels of `light` times `(1 - cos)^5` at the half vector.
    pub schlick: f32,
}

impl Gathered {
    fn add(&mut self, radiance: Vec3, weight: f32, schlick: f32) {
        let light = weight * radiance;
        self.light += light;
        self.weight += weight;
        self.schlick += schlick * light.element_sum();
    }

    /// The light, brought to what `albedo` gives of even light if that is asked for.
    fn scaled(&self, albedo: f32, normalized: bool) -> Vec3 {
        if normalized { albedo / self.weight.max(LEAST) * self.light } else { self.light }
    }

    /// Cosine at the half vector at which Schlick's form has the mean over the light.
    fn cos_theta(&self) -> f32 {
        let sum = self.light.element_sum();
        if sum > 0.0 { 1.0 - (self.schlick / sum).clamp(0.0, 1.0).powf(0.2) } else { 1.0 }
    }
}

/// What a lobe sends toward `wo` of a cap of radiance 1 for F = 1, and `(1 - cos)^5` at the half vector: the BRDF times the
/// cosine, integrated over the cap. `cap` is local to the lobe; `lit` is its [`lambert`].
///
/// The distribution of normals is averaged over half vectors: those of a cap of `w` fill `w / (4 cos)` about their middle, taken
/// for a cap again; `middle` takes their middle alone. What varies slowly is taken at the middle of what the horizon leaves of the cap.
pub fn glossy(lobe: &Lobe, wo: Vec3, cap: &Cap, lit: f32, middle: bool) -> Vec2 {
    let Cap { direction, share } = *cap;
    if !(lit > 0.0 && share > 0.0) {
        return Vec2::ZERO;
    }
    let sin = (share * (2.0 - share)).sqrt();
    let seen = 0.5 + 0.5 * (direction.z / sin).clamp(-1.0, 1.0);
    // The mean cosine over the whole cap is lit / (2 share), over the part that is seen more.
    let lifted = (0.5 * lit / (share * (1.0 - 0.5 * share) * seen.max(1e-6))).clamp(HORIZON, 1.0);
    let z = if direction.z >= sin { direction.z } else { lifted };
    let level = (1.0 - z * z).max(0.0).sqrt();
    let wi = (direction.truncate().normalize_or(Vec2::X) * level).extend(z);

    let h = wo + wi;
    let length = h.length();
    let cos_theta = (0.5 * length).min(1.0);
    // 2 (1 - cos) is the square of a chord; the cosine itself has no digits left there.
    let offset = h.truncate().length() / length * (2.0 / (1.0 + h.z / length)).sqrt();
    let chord = if middle { 0.0 } else { (0.5 * share / cos_theta.max(1e-6)).sqrt().min(CHORD_MAX) };
    let value = match lobe.kind {
        layered::Lobe::Ggx => {
            let a = ggx::clamp_alpha(Vec2::splat(lobe.alpha));
            let mean = tables::normals(Normals::Ggx, a.x, offset, chord);
            mean / (a.x * a.x) * ggx::visibility(wo, wi, a, lobe.masking) * lit
        }
        layered::Lobe::BlinnPhong { exponent, variant } => {
            let mean = tables::normals(Normals::BlinnPhong, blinn_phong::alpha(exponent), offset, chord);
            let peak = blinn_phong::normalizer(exponent, variant) * mean * PI;
            match variant {
                Variant::Exact | Variant::Approximate => peak * lit,
                Variant::Unnormalized => peak * 2.0 * share * seen,
                Variant::Microfacet => 0.25 * peak * lit / (cos_theta * cos_theta).max(1e-6),
            }
        }
    };
    let rest = 1.0 - cos_theta;
    Vec2::new(value, rest * rest * (rest * rest) * rest)
}

/// A lobe about the normal of a frame, toward the viewer.
struct Side<'a> {
    lobe: Lobe,
    frame: &'a Frame,
    wo: Vec3,
    middles: bool,
}

impl Side<'_> {
    fn cap(&self, texels: &Texels<'_>, index: u32, x: Vec3, corrected: bool) -> (Vec3, Cap) {
        let texel = texels.get(index);
        let cap = localised(&texel, x, corrected);
        (texel.radiance, Cap { direction: self.frame.to_local(cap.direction), ..cap })
    }

    fn all(&self, texels: &Texels<'_>, x: Vec3, corrected: bool) -> Gathered {
        self.over(texels, 0..6 * texels.edge().pow(2), x, corrected)
    }

    fn few(&self, texels: &Texels<'_>, x: Vec3, seen: Vec3, corrected: bool) -> Gathered {
        let middle = texel_at(seen, texels.edge());
        let beside = (0..NEIGHBOURS).map(|side| neighbour(middle, side, texels.edge()));
        self.over(texels, std::iter::once(middle).chain(beside), x, corrected)
    }

    fn over(&self, texels: &Texels<'_>, of: impl Iterator<Item = u32>, x: Vec3, corrected: bool) -> Gathered {
        let mut sum = Gathered::default();
        for index in of {
            let (radiance, cap) = self.cap(texels, index, x, corrected);
            let part = glossy(&self.lobe, self.wo, &cap, lambert(cap.share, cap.direction.z), self.middles);
            sum.add(radiance, part.x, part.y);
        }
        sum
    }
}

/// The same lobe by the few texels that matter and by all of them: what the few leave out is the difference of their light.
pub fn sums(
    texels: &Texels<'_>,
    lobe: Lobe,
    frame: &Frame,
    to_viewer: Vec3,
    at: &Looked,
    corrected: bool,
) -> [Gathered; 2] {
    let side = Side { lobe, frame, wo: facing(frame.to_local(to_viewer)), middles: false };
    [side.few(texels, at.x, at.base, corrected), side.all(texels, at.x, corrected)]
}

/// Irradiance over pi about a normal, as a sum over all texels.
fn irradiance(texels: &Texels<'_>, normal: Vec3, at: &Looked, asked: Asked) -> Vec3 {
    let mut sum = Gathered::default();
    for texel in texels.iter() {
        let cap = localised(&texel, at.x, asked.corrected);
        sum.add(texel.radiance, lambert(cap.share, normal.dot(cap.direction)), 0.0);
    }
    sum.scaled(1.0, asked.normalized)
}

/// Light of the surroundings that the surface sends toward the viewer (unit vector, world space), all lobes.
///
/// `base` and `coat_frame` are the frames of the base layer and of the coat; other arguments say where it is and how much of
/// the light reaches it.
#[allow(clippy::too_many_arguments, reason = "the argument list of the WGSL twin")]
pub fn reflected(
    texels: &Texels<'_>,
    s: &Surface,
    base: &Frame,
    coat_frame: &Frame,
    to_viewer: Vec3,
    occlusion: f32,
    at: &Looked,
    asked: Asked,
) -> Vec3 {
    let gathered = |side: &Side<'_>, seen: Vec3| match asked.few {
        true => side.few(texels, at.x, seen, asked.corrected),
        false => side.all(texels, at.x, asked.corrected),
    };
    let wo = facing(base.to_local(to_viewer));
    let lobe = Lobe { kind: s.lobe, alpha: (s.alpha.x * s.alpha.y).sqrt(), masking: s.masking };
    let found = gathered(&Side { lobe, frame: base, wo, middles: asked.middles }, at.base);
    let light = found.scaled(layered::lobe_albedo(s, wo), asked.normalized);
    let mut value =
        reflection_occlusion(wo.z, width(s.alpha), occlusion) * layered::reflectance(s, found.cos_theta()) * light;
    let scatters = s.metallic > 0.0 && s.scatters_again();
    if scatters || s.metallic < 1.0 {
        let mut albedo = Vec3::ZERO;
        if scatters {
            albedo += s.metallic * multiple_albedo(s, wo);
        }
        if s.metallic < 1.0 {
            albedo += (1.0 - s.metallic) * layered::matte_albedo(s, wo);
        }
        value += occlusion * albedo * irradiance(texels, base.n, at, asked);
    }
    if s.coat <= 0.0 {
        return value;
    }
    let coat_wo = facing(coat_frame.to_local(to_viewer));
    let lobe = Lobe { kind: layered::Lobe::Ggx, alpha: s.coat_alpha, masking: s.masking };
    let over = gathered(&Side { lobe, frame: coat_frame, wo: coat_wo, middles: asked.middles }, at.coat);
    let whole = 1.0 - albedo::loss(coat_wo, Vec2::splat(s.coat_alpha), s.masking);
    let fresnel = crate::surface::fresnel::schlick(Vec3::splat(coat::F0), 1.0, over.cos_theta());
    let top = reflection_occlusion(coat_wo.z, s.coat_alpha, occlusion) * fresnel * over.scaled(whole, asked.normalized);
    // Once on the way out; the way in is averaged over where the light comes from, close to the same for metals.
    let passed = coat::transmission(coat_wo, s.coat_alpha, s.coat, s.masking);
    value * passed * passed + s.coat * top
}
