//! What a GGX surface does with light, integrated in f64: the source of all its tables.
//!
//! Reflection at visible normals is integrated in the coordinates of their sampler, in which the density is constant.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::{DVec3, Vec3};

use super::Masking;
use crate::math::quadrature::GaussLegendre;

/// A bundle of light that leaves toward the viewer after one reflection.
#[derive(Clone, Copy, Debug)]
struct Reflection {
    /// Share of the visible microfacets; the shares of a direction sum to 1.
    share: f64,
    /// Cosine at the microfacet, the argument of Fresnel.
    cos_half: f64,
    /// Fraction that is not shadowed, per [`Masking`].
    passes: [f64; 2],
    /// Fraction that is, kept apart since `1 - passes` cancels on smooth surfaces.
    lost: [f64; 2],
}

/// The nodes over the sampler's square.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    polar: GaussLegendre,
    /// Cosine and sine of the azimuths over half a turn; the other half is its mirror image.
    around: Vec<(f64, f64)>,
}

impl Rule {
    /// `polar` nodes toward the tail of the slopes times `around`.
    pub(super) fn new(polar: usize, around: usize) -> Rule {
        let angle = |i: usize| (PI * (i as f64 + 0.5) / around as f64).sin_cos();
        let around = (0..around).map(|i| (angle(i).1, angle(i).0)).collect();
        Rule { polar: GaussLegendre::new(polar), around }
    }
}

/// What all tables are made with: 2e-3 of the loss at worst, where light at the horizon puts a kink into the integrand.
static RULE: LazyLock<Rule> = LazyLock::new(|| Rule::new(40, 16));

/// Calls `f` for a set of reflections that stands for all light leaving at cosine `mu`; the view lies in the plane of
/// the width `along`, `across` is the other one.
fn visit(mu: f64, along: f64, across: f64, rule: &Rule, mut f: impl FnMut(Reflection)) {
    let mu = mu.clamp(0.0, 1.0);
    let sin_theta = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let stretched_o = (along * sin_theta).hypot(mu);
    let view = (along * sin_theta / stretched_o, mu / stretched_o);
    for &(x, weight) in rule.polar.nodes() {
        // The tail of the slopes lies at the lower rim of the cap; the fourth power crowds the nodes there.
        let rim = x.powi(4);
        let share = weight * 4.0 * x.powi(3) / rule.around.len() as f64;
        let height = rim * (1.0 + view.1);
        let z = height - view.1;
        let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        for &(cos_phi, sin_phi) in &rule.around {
            let wm = DVec3::new(along * (radius * cos_phi + view.0), across * radius * sin_phi, height).normalize();
            let cos_half = (sin_theta * wm.x + mu * wm.z).clamp(0.0, 1.0);
            let wi = 2.0 * cos_half * wm - DVec3::new(sin_theta, 0.0, mu);
            let spread = (along * wi.x).powi(2) + (across * wi.y).powi(2);
            let (passes, lost) = shadowing(mu, stretched_o, wi.z, spread);
            f(Reflection { share, cos_half, passes, lost });
        }
    }
}

/// `G2 / G1(wo)` and what it lacks to one, for both kinds of masking; `spread` is `|(at x, ab y)|^2` of the light.
fn shadowing(cos_o: f64, stretched_o: f64, cos_i: f64, spread: f64) -> ([f64; 2], [f64; 2]) {
    if cos_i <= 0.0 {
        return ([0.0; 2], [1.0; 2]);
    }
    let stretched_i = (spread + cos_i * cos_i).sqrt();
    // stretched_i - cos_i without cancellation.
    let excess = spread / (stretched_i + cos_i);
    let correlated = 1.0 / (cos_i * stretched_o + cos_o * stretched_i);
    let separable = 1.0 / (cos_i + stretched_i);
    (
        [cos_i * (cos_o + stretched_o) * correlated, 2.0 * cos_i * separable],
        [cos_o * excess * correlated, excess * separable],
    )
}

/// `1 - E`: what single scattering loses when F = 1, per [`Masking`], toward cosine `mu` in [0, 1]. The view lies in
/// the plane of the width `along`, `across` is the other one; both in (0, 1].
pub fn loss(mu: f64, along: f64, across: f64) -> [f64; 2] {
    loss_with(mu, along, across, &RULE)
}

/// [`loss`] with a rule of choice.
pub(super) fn loss_with(mu: f64, along: f64, across: f64, rule: &Rule) -> [f64; 2] {
    let mut sum = [0.0; 2];
    visit(mu, along, across, rule, |r| (0..2).for_each(|m| sum[m] += r.share * r.lost[m]));
    sum
}

/// Single-scattering directional albedo at cosine `mu` in [0, 1] for the isotropic width `alpha` in (0, 1] and any
/// Fresnel curve over the cosine at the microfacet.
pub fn directional_albedo(mu: f64, alpha: f64, masking: Masking, fresnel: impl Fn(f64) -> DVec3) -> DVec3 {
    let mut sum = DVec3::ZERO;
    visit(mu, alpha, alpha, &RULE, |r| sum += r.share * r.passes[masking as usize] * fresnel(r.cos_half));
    sum
}

/// Values of a Fresnel curve that [`CosineWeights`] take: value `i` at cosine `i / (CURVE_SIZE - 1)`.
pub const CURVE_SIZE: usize = 128;

/// A Fresnel curve ready for [`CosineWeights::albedo`].
pub fn sample_curve(fresnel: impl Fn(f32) -> Vec3) -> [Vec3; CURVE_SIZE] {
    std::array::from_fn(|i| fresnel(i as f32 / (CURVE_SIZE - 1) as f32))
}

/// How the cosines at the microfacets are spread in the light that leaves toward one direction.
///
/// They do not depend on the Fresnel curve: a table of directional albedos of any metal is a table of these, made once,
/// times its curve, which is taken as linear between [`CURVE_SIZE`] values.
#[derive(Clone, Debug)]
pub struct CosineWeights([f32; CURVE_SIZE]);

impl CosineWeights {
    /// Weights for cosine `mu` in [0, 1] and the isotropic width `alpha` in (0, 1], per [`Masking`].
    pub fn new(mu: f64, alpha: f64) -> [CosineWeights; 2] {
        let mut sums = [[0.0f64; CURVE_SIZE]; 2];
        visit(mu, alpha, alpha, &RULE, |r| {
            let x = r.cos_half * (CURVE_SIZE - 1) as f64;
            let i = (x as usize).min(CURVE_SIZE - 2);
            let t = x - i as f64;
            for (sum, passes) in sums.iter_mut().zip(r.passes) {
                sum[i] += r.share * passes * (1.0 - t);
                sum[i + 1] += r.share * passes * t;
            }
        });
        sums.map(|sum| CosineWeights(sum.map(|weight| weight as f32)))
    }

    /// Single-scattering directional albedo for a curve.
    pub fn albedo(&self, curve: &[Vec3; CURVE_SIZE]) -> Vec3 {
        self.0.iter().zip(curve).map(|(&weight, &value)| weight * value).sum()
    }
}

/// Mean of `(1 - x)^5` over the light that passes, per [`Masking`]; arguments as for [`loss`].
pub(super) fn schlick_ratio(mu: f64, along: f64, across: f64) -> [f64; 2] {
    let mut sums = [(0.0, 0.0); 2];
    visit(mu, along, across, &RULE, |r| {
        let curve = (1.0 - r.cos_half).powi(5);
        for (sum, passes) in sums.iter_mut().zip(r.passes) {
            *sum = (sum.0 + r.share * passes * curve, sum.1 + r.share * passes);
        }
    });
    sums.map(|(weighted, all)| weighted / all)
}
