//! The CPU twin of `classical.wgsl`, over maps given as a trait.

use glam::{Vec2, Vec3};

use super::sources::Source;
use super::{level, mean_fresnel_node};
use crate::math::frame::Frame;
use crate::math::sampling;
use crate::surface::coat;
use crate::surface::fresnel::Fresnel;
use crate::surface::ggx;
use crate::surface::ggx::Masking;
use crate::surface::ggx::albedo::{ALBEDO_ALPHA, ALBEDO_MU, ALBEDO_ROOT_MIN, loss, loss_mean, schlick_ratio};
use crate::surface::ggx::reflection::sample_curve;
use crate::surface::layered::{self, Lobe, Surface};

/// What the method looks up. Directions are unit vectors in world space.
pub trait Maps {
    /// Radiance, box-filtered at a level of the radiance cube.
    fn radiance(&self, direction: Vec3, level: f32) -> Vec3;
    /// The same without the light of its sources.
    fn dimmed(&self, direction: Vec3, level: f32) -> Vec3;
    /// Bright sources that [`Maps::dimmed`] leaves out.
    fn source_count(&self) -> usize;
    /// One of them; its direction in world space.
    fn source(&self, index: usize) -> Source;
    /// Width from which a bright block is a point to a lobe, see [`super::wide_alpha`].
    fn wide_alpha(&self) -> f32;
    /// Radiance filtered with the lobe of a level of the prefiltered cube.
    fn prefiltered(&self, direction: Vec3, level: f32) -> Vec3;
    /// Integral of radiance times cosine about a normal.
    fn irradiance(&self, normal: Vec3) -> Vec3;
    /// Levels of the radiance cube; its finest level has `2^(levels - 1)` texels along an edge.
    fn radiance_levels(&self) -> f32;
    /// Levels of the prefiltered cube.
    fn prefiltered_levels(&self) -> f32;
}

/// How the split sum finds the mean of a metal's curve over the light that its lobe reflects.
#[derive(Clone, Copy, Debug)]
pub enum MeanFresnel<'a> {
    /// In closed form, of curves `f0 + (1 - f0)(1 - x)^5`.
    Schlick,
    /// In its [`super::mean_fresnel_table`].
    Table(&'a [f32]),
    /// From the curve itself, which takes microseconds.
    Curve,
}

impl MeanFresnel<'_> {
    /// That of a curve for which there is no table.
    pub fn of(fresnel: &Fresnel) -> MeanFresnel<'static> {
        match fresnel {
            Fresnel::Rescaled { .. } | Fresnel::Schlick { .. } => MeanFresnel::Schlick,
            _ => MeanFresnel::Curve,
        }
    }
}

/// How the reflection is computed.
#[derive(Clone, Copy, Debug)]
pub struct Lobes {
    /// 0 for the split sum, else visible normals drawn per pixel.
    pub samples: u32,
    /// Offset of the sample points, see [`sampling::spiral`].
    pub rotation: Vec2,
}

/// Level whose texels are as large as the share of one of `n` samples of that density (per steradian), `blur` levels
/// coarser.
pub fn footprint(direction: Vec3, pdf: f32, n: u32, levels: f32, blur: f32) -> f32 {
    let ratio = 1.0 / (n as f32 * pdf.max(1e-12) * texel(direction, levels));
    (0.5 * ratio.max(1e-12).log2() + blur).clamp(0.0, levels - 1.0)
}

/// Solid angle of a texel of the finest level.
fn texel(direction: Vec3, levels: f32) -> f32 {
    let m = direction.abs().max_element();
    4.0 * m * m * m * (-2.0 * (levels - 1.0)).exp2()
}

/// Neighbouring footprints overlap by this many levels, so that a lamp between two samples is not lost.
pub const OVERLAP: f32 = 1.0;

/// Weight of a direction in the lobe of N = V = R, D(h) cos(theta_i), up to the factor that the sampler's mean cosine
/// brings in: n samples of density D / 4 weigh sum(cos_i), a source of solid angle w weighs n w D cos_i / 4.
fn source_weight(normal: Vec3, alpha: f32, direction: Vec3) -> f32 {
    let cos_i = normal.dot(direction);
    // sin^2 and cos^2 of the half vector's angle.
    let d = 0.25 * (direction - normal).length_squared() + alpha * alpha * 0.5 * (1.0 + cos_i);
    cos_i.max(0.0) * 0.25 * std::f32::consts::FRAC_1_PI * alpha * alpha / (d * d)
}

/// Radiance filtered with the GGX lobe of N = V = R by `n` samples: weight D(h) cos(theta_i). `sources` are left out of
/// the map, which is given as [`Maps::radiance`] and its levels, and added exactly.
///
/// Karis 2013, Real Shading in Unreal Engine 4, with the footprint of Krivanek and Colbert 2008.
pub fn prefilter(
    (radiance, levels): (impl Fn(Vec3, f32) -> Vec3, f32),
    normal: Vec3,
    alpha: f32,
    n: u32,
    sources: &[Source],
) -> Vec3 {
    let frame = Frame::new(normal);
    let a2 = alpha * alpha;
    let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
    for i in 0..n {
        let u = sampling::spiral(i, n, Vec2::new(0.0, 0.5));
        // Half vectors with density D cos: tan^2 = alpha^2 v / (1 - v). The sine from v too: 1 - cos^2 would cancel.
        let sum2 = (1.0 - u.y) + a2 * u.y;
        let (cos2, sin2) = ((1.0 - u.y) / sum2, a2 * u.y / sum2);
        let cos_i = cos2 - sin2;
        if cos_i <= 0.0 {
            continue;
        }
        let h = Vec3::new(sin2.sqrt(), 0.0, cos2.sqrt());
        let sin_i = 2.0 * h.x * h.z;
        let (sin_phi, cos_phi) = (std::f32::consts::TAU * u.x).sin_cos();
        let wi = frame.to_world(Vec3::new(sin_i * cos_phi, sin_i * sin_phi, cos_i));
        let pdf = 0.25 * ggx::distribution(h, Vec2::splat(alpha));
        let level = footprint(wi, pdf, n, levels, OVERLAP);
        sum += cos_i * radiance(wi, level);
        weight += cos_i;
    }
    for source in sources {
        sum += n as f32 * source_weight(normal, alpha, source.direction) * source.power;
    }
    sum / weight.max(1e-12)
}

/// Light of the environment that the surface sends toward the viewer (unit vector, world space).
///
/// `mean` says how the split sum finds the mean of the surface's curve; `base` and `coat_frame` are the frames of the base
/// layer (x along the anisotropy axis) and of the coat.
#[allow(clippy::too_many_arguments, reason = "the argument list of the WGSL twin")]
pub fn environment(
    maps: &impl Maps,
    s: &Surface,
    mean: MeanFresnel<'_>,
    base: &Frame,
    coat_frame: &Frame,
    to_viewer: Vec3,
    occlusion: f32,
    lobes: Lobes,
) -> Vec3 {
    let wo = facing(base.to_local(to_viewer));
    let width = width(s.alpha);
    let irradiance = occlusion * maps.irradiance(base.n) * std::f32::consts::FRAC_1_PI;
    let reflected = match lobes.samples {
        0 => split_sum(maps, s, mean, base, wo),
        _ => sampled(maps, s, base, wo, lobes),
    };
    let mut value = reflection_occlusion(wo.z, width, occlusion) * reflected;
    if s.metallic > 0.0 && s.scatters_again() {
        value += s.metallic * multiple_albedo(s, wo) * irradiance;
    }
    if s.metallic < 1.0 {
        value += (1.0 - s.metallic) * layered::matte_albedo(s, wo) * irradiance;
    }
    if s.coat <= 0.0 {
        return value;
    }
    let top = Surface {
        metallic: 0.0,
        alpha: Vec2::splat(s.coat_alpha),
        lobe: Lobe::Ggx,
        dielectric_f0: Vec3::splat(coat::F0),
        dielectric_f90: 1.0,
        ..*s
    };
    let coat_wo = facing(coat_frame.to_local(to_viewer));
    let coat_light = match lobes.samples {
        0 => split_sum(maps, &top, MeanFresnel::Schlick, coat_frame, coat_wo),
        _ => sampled(maps, &top, coat_frame, coat_wo, lobes),
    };
    // Once on the way out; the way in is averaged over where the light comes from, close to the same for metals.
    let passed = coat::transmission(coat_wo, s.coat_alpha, s.coat, s.masking);
    value * passed * passed + s.coat * reflection_occlusion(coat_wo.z, s.coat_alpha, occlusion) * coat_light
}

/// A shading normal may look away from the viewer: brings the direction back above the horizon.
pub(in crate::lighting) fn facing(wo: Vec3) -> Vec3 {
    Vec3::new(wo.x, wo.y, wo.z.max(1e-3)).normalize()
}

fn split_sum(maps: &impl Maps, s: &Surface, mean: MeanFresnel<'_>, base: &Frame, wo: Vec3) -> Vec3 {
    let wo_world = base.to_world(wo);
    let n = bent_normal(base, wo_world, s.alpha);
    // Wide lobes lean toward the normal, where the cosine is larger. The weight was chosen by the error table.
    let lean = s.alpha.x * s.alpha.y;
    let direction = (2.0 * n.dot(wo_world) * n - wo_world).lerp(n, lean).normalize();
    let roughness = (s.alpha.x * s.alpha.y).sqrt().sqrt();
    let width = width(s.alpha);
    let e = layered::lobe_albedo(s, wo);
    let ratio = schlick_ratio(wo, s.alpha, s.masking);
    let schlick = s.dielectric_f0.lerp(Vec3::splat(s.dielectric_f90), ratio);
    let metal = match mean {
        MeanFresnel::Schlick => s.fresnel.f0().lerp(Vec3::ONE, ratio),
        MeanFresnel::Table(table) => mean_fresnel(table, wo.z, width),
        MeanFresnel::Curve => mean_fresnel_of(s.fresnel, s.masking, wo.z, width),
    };
    let albedo = e * schlick.lerp(metal, s.metallic);
    albedo * maps.prefiltered(direction, level(roughness, maps.prefiltered_levels()))
}

/// Isotropic width that stands for both where the direction of the grooves matters little.
pub(in crate::lighting) fn width(alpha: Vec2) -> f32 {
    (0.5 * alpha.length_squared()).sqrt()
}

/// Looks up the three grids of [`super::mean_fresnel_table`].
fn mean_fresnel(table: &[f32], mu: f32, alpha: f32) -> Vec3 {
    let (width, height) = (ALBEDO_MU as usize, ALBEDO_ALPHA as usize);
    let at = |c: usize, i: usize, j: usize| table.get((c * height + j) * width + i).copied().unwrap_or(0.0);
    between_nodes(mu, alpha, |i, j| Vec3::new(at(0, i, j), at(1, i, j), at(2, i, j)))
}

/// The same of a curve whose table nobody made: the four nodes that are needed.
fn mean_fresnel_of(fresnel: &Fresnel, masking: Masking, mu: f32, alpha: f32) -> Vec3 {
    let curve = sample_curve(|x| fresnel.eval(x));
    between_nodes(mu, alpha, |i, j| mean_fresnel_node(&curve, masking, i, j))
}

/// Linear between the nodes of the grid about a cosine and a width.
fn between_nodes(mu: f32, alpha: f32, at: impl Fn(usize, usize) -> Vec3) -> Vec3 {
    let (width, height) = (ALBEDO_MU as usize, ALBEDO_ALPHA as usize);
    let y = (alpha.clamp(ggx::ALPHA_MIN, 1.0).sqrt().sqrt() - ALBEDO_ROOT_MIN) / (1.0 - ALBEDO_ROOT_MIN);
    let (fx, fy) = (mu.clamp(0.0, 1.0).sqrt() * (width - 1) as f32, y.clamp(0.0, 1.0) * (height - 1) as f32);
    let (i, j) = ((fx as usize).min(width - 2), (fy as usize).min(height - 2));
    let (tx, ty) = (fx - i as f32, fy - j as f32);
    let row = |j| at(i, j).lerp(at(i + 1, j), tx);
    row(j).lerp(row(j + 1), ty)
}

/// Filtered importance sampling of the lobe. A wide lobe's samples would meet a lamp of a few texels or miss it:
/// there the brightest blocks are left out of the map and reflected one by one.
fn sampled(maps: &impl Maps, s: &Surface, base: &Frame, wo: Vec3, lobes: Lobes) -> Vec3 {
    let wide = s.alpha.min_element() >= maps.wide_alpha();
    let mut sum = Vec3::ZERO;
    for i in 0..lobes.samples {
        let u = sampling::spiral(i, lobes.samples, lobes.rotation);
        let Some(Drawn { wi, cos_theta, pdf, weight }) = drawn(s, wo, u) else { continue };
        let direction = base.to_world(wi);
        let level = footprint(direction, pdf, lobes.samples, maps.radiance_levels(), 0.0);
        let radiance = if wide { maps.dimmed(direction, level) } else { maps.radiance(direction, level) };
        sum += weight * layered::reflectance(s, cos_theta) * radiance;
    }
    sum /= lobes.samples as f32;
    for source in (0..if wide { maps.source_count() } else { 0 }).map(|index| maps.source(index)) {
        let wi = base.to_local(source.direction);
        if wi.z > 0.0 {
            let facet = s.lobe.facet(wo, wi, s.alpha, s.masking);
            sum += facet.y * wi.z * layered::reflectance(s, facet.x) * source.power;
        }
    }
    sum
}

/// A direction drawn from the lobe.
struct Drawn {
    wi: Vec3,
    /// At the half vector.
    cos_theta: f32,
    pdf: f32,
    /// BRDF for F = 1 times cosine over density.
    weight: f32,
}

fn drawn(s: &Surface, wo: Vec3, u: Vec2) -> Option<Drawn> {
    if s.lobe == Lobe::Ggx {
        let wm = ggx::sample_wm(wo, s.alpha, u);
        let wi = 2.0 * wo.dot(wm) * wm - wo;
        // What is left of the quotient, in which distribution and cosines cancel.
        let weight = ggx::shadowing_masking(wo, wi, s.alpha, s.masking) / ggx::masking(wo, s.alpha).max(1e-12);
        return (wi.z > 0.0).then(|| Drawn { wi, cos_theta: wi.dot(wm), pdf: ggx::pdf(wo, wi, s.alpha), weight });
    }
    let wi = s.lobe.sample_wi(wo, s.alpha, u)?;
    let (facet, pdf) = (s.lobe.facet(wo, wi, s.alpha, s.masking), s.lobe.pdf(wo, wi, s.alpha));
    Some(Drawn { wi, cos_theta: facet.x, pdf, weight: facet.y * wi.z / pdf.max(1e-12) })
}

/// Normal bent toward the viewer in the plane in which the lobe is wide, which stretches the one lookup of the split
/// sum; across the narrow axis the reflection stays that of a mirror.
///
/// After McAuley 2015, Rendering the World of Far Cry 4.
fn bent_normal(base: &Frame, wo_world: Vec3, alpha: Vec2) -> Vec3 {
    let axis = if alpha.x >= alpha.y { base.b } else { base.t };
    let (wide, narrow) = (alpha.max_element(), alpha.min_element());
    let toward = axis.cross(wo_world).cross(axis);
    if toward.length_squared() < 1e-8 || wide <= narrow {
        return base.n;
    }
    let amount = (1.0 - narrow / wide) * (4.0 * wide).min(1.0);
    base.n.lerp(toward.normalize(), 0.5 * amount).normalize()
}

/// Albedo of light that bounced more than once between microfacets.
pub(in crate::lighting) fn multiple_albedo(s: &Surface, wo: Vec3) -> Vec3 {
    ggx::bounces(s.fresnel_mean, loss_mean(s.alpha, s.masking)) * loss(wo, s.alpha, s.masking)
}

/// Share of a reflection that an ambient occlusion leaves: a mirror loses little, a matte surface all of it.
///
/// Lagarde and de Rousiers 2014, Moving Frostbite to Physically Based Rendering, section 4.10.2.
pub(in crate::lighting) fn reflection_occlusion(mu: f32, alpha: f32, occlusion: f32) -> f32 {
    ((mu + occlusion).powf((-16.0 * alpha - 1.0).exp2()) - 1.0 + occlusion).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bent_normal_leaves_the_plane_of_the_narrow_axis_a_mirror() {
        let frame = Frame::new(Vec3::Y);
        for (alpha, wide, narrow) in
            [(Vec2::new(0.5, 0.05), frame.t, frame.b), (Vec2::new(0.05, 0.5), frame.b, frame.t)]
        {
            let bent = |toward: Vec3| bent_normal(&frame, (toward + frame.n).normalize(), alpha);
            assert!(bent(narrow).abs_diff_eq(frame.n, 1e-6), "{}", bent(narrow));
            let n = bent(wide);
            assert!(n.dot(wide) > 0.1 && n.dot(narrow).abs() < 1e-6, "{n}");
        }
    }
}
