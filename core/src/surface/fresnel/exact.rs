//! Exact reflectance of a conductor.

use glam::{DVec3, Vec3};

use super::Fresnel;
use crate::math::bounded;
use crate::math::quadrature::GaussLegendre;

/// Least real index of [`conductor`]: at n = k = 0 the reflectance is undefined.
pub const INDEX_MIN: f32 = 1e-4;
/// Largest index of [`conductor`] in either part: beyond it squares of squares leave f32. Metals stay below 20 in the
/// visible range.
pub const INDEX_MAX: f32 = 1e3;

/// Unpolarised reflectance of the index `n + ik` from vacuum at `cos_theta` in [0, 1], in f64: the truth.
///
/// `eta = n + ik`, `w = sqrt(eta^2 - sin^2)`, `F = (|(x - w)/(x + w)|^2 + |(eta^2 x - w)/(eta^2 x + w)|^2) / 2`,
/// Born and Wolf 1999, Principles of Optics, section 14.2. 1 at `cos_theta = 0`. Against reference values the error
/// is below 1e-10, their own digits.
pub fn exact(n: f64, k: f64, cos_theta: f64) -> f64 {
    let x = cos_theta.clamp(0.0, 1.0);
    let eta2 = (n * n - k * k, 2.0 * n * k);
    let w = complex_sqrt(eta2.0 - (1.0 - x) * (1.0 + x), eta2.1);
    let rs = reflected((x, 0.0), w);
    let rp = reflected((eta2.0 * x, eta2.1 * x), w);
    (0.5 * (rs + rp)).clamp(0.0, 1.0)
}

/// Slope `dF/dx` of [`exact`] at 90 degrees, `x = cos theta = 0`: `-2 (Re w0 + Re(eta^2 conj w0)) / |w0|^2`,
/// `w0 = sqrt(eta^2 - 1)`. Not a number for an index of 1.
pub fn grazing_slope(n: f64, k: f64) -> f64 {
    let eta2 = (n * n - k * k, 2.0 * n * k);
    let w = complex_sqrt(eta2.0 - 1.0, eta2.1);
    -2.0 * (w.0 + eta2.0 * w.0 + eta2.1 * w.1) / (w.0 * w.0 + w.1 * w.1)
}

/// `|(a - w) / (a + w)|^2`; 1 where both vanish.
fn reflected(a: (f64, f64), w: (f64, f64)) -> f64 {
    let difference = (a.0 - w.0).powi(2) + (a.1 - w.1).powi(2);
    let sum = (a.0 + w.0).powi(2) + (a.1 + w.1).powi(2);
    if sum > 0.0 { difference / sum } else { 1.0 }
}

/// Principal square root for a non-negative imaginary part, without cancellation.
fn complex_sqrt(re: f64, im: f64) -> (f64, f64) {
    let larger = (0.5 * (re.hypot(im) + re.abs())).sqrt();
    if larger == 0.0 {
        return (0.0, 0.0);
    }
    let smaller = 0.5 * im / larger;
    if re < 0.0 { (smaller, larger) } else { (larger, smaller) }
}

/// The same in f32, error below 1e-6 for n and k of metals; both are clamped to [`INDEX_MIN`] and [`INDEX_MAX`].
///
/// The form without tangents (finite at 90 degrees), with the real part of the root taken from the imaginary one where
/// it would cancel, as it does for most metals.
#[inline]
pub fn conductor(n: f32, k: f32, cos_theta: f32) -> f32 {
    let eta = bounded(n, INDEX_MIN, INDEX_MAX);
    let kappa = bounded(k, 0.0, INDEX_MAX);
    let c = cos_theta.clamp(0.0, 1.0);
    let c2 = c * c;
    let s2 = (1.0 - c) * (1.0 + c);
    let t0 = (eta - kappa) * (eta + kappa) - s2;
    let nk = eta * kappa;
    let ab = (t0 * t0 + 4.0 * nk * nk).sqrt();
    // Real part of sqrt(t0 + 2ink); the larger part first, so that nothing cancels.
    let larger = (0.5 * (ab + t0.abs())).sqrt();
    let smaller = nk / larger.max(1e-20);
    let a = if t0 < 0.0 { smaller } else { larger };
    let t1 = ab + c2;
    let t2 = 2.0 * a * c;
    // At 90 degrees an index of one gives 0 / 0; like every other it reflects all there.
    let rs = if t1 + t2 > 0.0 { (t1 - t2) / (t1 + t2) } else { 1.0 };
    let t3 = c2 * ab + s2 * s2;
    let t4 = t2 * s2;
    let sum = t3 + t4;
    // Zero only where the surface is the vacuum itself.
    let rp = if sum > 0.0 { rs * (t3 - t4) / sum } else { rs };
    (0.5 * (rs + rp)).clamp(0.0, 1.0)
}

/// Reflectance at normal incidence, `((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)`.
pub fn f0(n: f32, k: f32) -> f32 {
    let k2 = k * k;
    (((n - 1.0) * (n - 1.0) + k2) / ((n + 1.0) * (n + 1.0) + k2).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0)
}

/// Cosine-weighted mean of any curve, by quadrature in the square root of the cosine, where grazing curves are smooth.
pub(super) fn mean(fresnel: &Fresnel) -> Vec3 {
    let mut sum = DVec3::ZERO;
    for &(t, weight) in GaussLegendre::new(128).nodes() {
        let x = t * t;
        sum += 4.0 * weight * x * t * fresnel.eval(x as f32).as_dvec3();
    }
    sum.as_vec3()
}
