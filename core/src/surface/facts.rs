//! What every BRDF must fulfil, written once.

use std::f64::consts::PI;

use glam::{Vec2, Vec3};

use super::Sample;
use super::fresnel::Fresnel;
use super::ggx::ALPHA_MIN;
use crate::math::quadrature::GaussLegendre;
use crate::math::sampling::Random;
use crate::math::statistics::{SphereGrid, sidak, sphere_chi_square};

/// A metal that reflects everything.
pub const WHITE: Fresnel = Fresnel::Rescaled { f0: Vec3::ONE };

/// Level of each family of samplers: the chance that one that is right fails.
const LEVEL: f64 = 0.01;

/// Unit vector at polar angle `theta` in degrees and azimuth `phi` in radians.
pub fn direction(theta: f32, phi: f32) -> Vec3 {
    let theta = theta.to_radians();
    (theta.sin() * Vec2::from_angle(phi)).extend(theta.cos())
}

/// Twenty views from the normal to 89.99 degrees at azimuth `phi`.
pub fn views(phi: f32) -> impl Iterator<Item = Vec3> {
    (0..20).map(move |i| direction(89.99 * i as f32 / 19.0, phi))
}

/// Twenty widths from the floor to 1, steady in roughness.
pub fn alphas() -> impl Iterator<Item = f32> {
    let floor = ALPHA_MIN.sqrt();
    (0..20).map(move |i| (floor + (1.0 - floor) * i as f32 / 19.0).powi(2))
}

/// Share of light returned toward one view, by `n^2` regular points of a sampler that takes two numbers.
pub fn sampled_albedo(n: u32, sample: impl Fn(Vec2) -> Option<Sample>) -> f64 {
    let mut sum = 0.0;
    for i in 0..n * n {
        let u = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
        sum += sample(u).map_or(0.0, |s| f64::from(s.value.x * s.wi.z) / f64::from(s.pdf));
    }
    sum / f64::from(n * n)
}

/// Share of light returned toward one view by a broad BRDF, by quadrature over the hemisphere.
pub fn smooth_albedo(polar: &GaussLegendre, around: u32, eval: impl Fn(Vec3) -> f32) -> f64 {
    let mut sum = 0.0;
    for &(t, weight) in polar.nodes() {
        // The fourth power crowds the nodes at grazing, where smooth surfaces change fast.
        let mu = t.powi(4);
        let sin_theta = ((1.0 - mu) * (1.0 + mu)).sqrt() as f32;
        for j in 0..around {
            let phi = std::f32::consts::TAU * (j as f32 + 0.5) / around as f32;
            let wi = (sin_theta * Vec2::from_angle(phi)).extend(mu as f32);
            sum += weight * 8.0 * PI * mu * t.powi(3) * f64::from(eval(wi)) / f64::from(around);
        }
    }
    sum
}

/// Pairs of directions above the horizon, some grazing, some near each other's mirror image.
fn pairs(count: usize) -> impl Iterator<Item = (Vec3, Vec3)> {
    let mut random = Random::new(11);
    let mut upper = move || {
        let u = random.point3();
        let z = if u.z < 0.3 { u.x * 1e-3 + 1e-5 } else { u.x };
        let wo = ((1.0 - z * z).sqrt() * Vec2::from_angle(std::f32::consts::TAU * u.y)).extend(z);
        (wo, u.z)
    };
    (0..count).map(move |_| {
        let ((wo, choice), (wi, _)) = (upper(), upper());
        let near = (Vec3::new(-wo.x, -wo.y, wo.z) + 0.02 * wi).normalize();
        (wo, if choice > 0.7 { near } else { wi })
    })
}

/// `f(wo, wi) = f(wi, wo)` to 1e-5 of its value.
pub fn assert_reciprocal(name: &str, eval: impl Fn(Vec3, Vec3) -> Vec3) {
    let mut largest = 0.0f32;
    for (wo, wi) in pairs(20_000) {
        let (there, back) = (eval(wo, wi), eval(wi, wo));
        let error = (there - back).abs().max_element();
        assert!(error <= 1e-5 * there.max_element(), "{name}: {wo} {wi}: {there} {back}");
        largest = largest.max(there.max_element());
    }
    assert!(largest > 0.0, "{name} is black");
}

/// Finite and not negative for all pairs of directions, opposite ones, the horizon and below included.
pub fn assert_finite(name: &str, eval: impl Fn(Vec3, Vec3) -> Vec3) {
    let check = |wo: Vec3, wi: Vec3| {
        let value = eval(wo, wi);
        assert!(value.is_finite() && value.min_element() >= 0.0, "{name}: {wo} {wi}: {value}");
    };
    pairs(20_000).for_each(|(wo, wi)| check(wo, wi));
    let tiny = [1e-3, 1e-7, 1e-20, 1e-38, f32::MIN_POSITIVE / 8.0, 0.0, -0.0, -1e-7];
    let mut limits = vec![Vec3::Z, Vec3::NEG_Z];
    for z in tiny {
        limits.extend([Vec3::new(1.0, 0.0, z), Vec3::new(-1.0, 0.0, z), Vec3::new(0.6, 0.8, z)]);
        limits.extend([Vec3::new(z, z, 1.0), Vec3::new(0.0, z, -1.0)]);
    }
    for &wo in &limits {
        limits.iter().for_each(|&wi| check(wo, wi));
        check(wo, -wo);
    }
}

/// A sampler at one view: what to draw, its density and where its lobe is.
pub struct SamplerCase<'a> {
    /// For the message.
    pub name: String,
    /// Draws a direction.
    pub sample: Box<dyn Fn(Vec3) -> Option<Vec3> + 'a>,
    /// Claimed density per steradian.
    pub pdf: Box<dyn Fn(Vec3) -> f32 + 'a>,
    /// Cells to count in.
    pub grid: SphereGrid,
}

/// Chi-square of every case with 1e6 samples, at 1 % for all together.
pub fn assert_samplers(cases: &[SamplerCase]) {
    let level = sidak(LEVEL, cases.len());
    let mut failures = Vec::new();
    for (seed, case) in cases.iter().enumerate() {
        let mut random = Random::new(1000 + seed as u64);
        let test =
            sphere_chi_square(case.grid, 1_000_000, &|w| f64::from((case.pdf)(w)), || (case.sample)(random.point3()));
        let SamplerCase { name, .. } = case;
        println!("{name}: p {:.4}, mass {:.6}, {} cells", test.p_value, test.mass, test.degrees + 1);
        if test.p_value < level || test.mass > 1.0 + 1e-3 || test.degrees < 20 {
            failures.push(format!("{name}: {test:?}"));
        }
    }
    assert!(!cases.is_empty() && failures.is_empty(), "level {level:.1e}\n{}", failures.join("\n"));
}

/// Cells for a lobe of widths `alpha` about the mirror image of `wo`.
pub fn lobe_grid(wo: Vec3, alpha: Vec2) -> SphereGrid {
    let width = alpha.max(Vec2::splat(ALPHA_MIN)).max_element();
    if alpha.min_element() >= 0.2 {
        return SphereGrid::uniform();
    }
    SphereGrid::around(Vec3::new(-wo.x, -wo.y, wo.z), f64::from(width))
}
