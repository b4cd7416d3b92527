//! Exact reflectance of a conductor in f64.

/// Unpolarised reflectance of the index `n + ik` from vacuum at `cos_theta` in [0, 1].
///
/// `w = sqrt((n + ik)^2 - sin^2)`, `F = (|(x - w)/(x + w)|^2 + |(eta^2 x - w)/(eta^2 x + w)|^2) / 2`.
pub fn exact(n: f64, k: f64, cos_theta: f64) -> f64 {
    let x = cos_theta.clamp(0.0, 1.0);
    let (re, im) = (n * n - k * k, 2.0 * n * k);
    let inside = re - (1.0 - x) * (1.0 + x);
    let length = inside.hypot(im);
    // Real part from the imaginary one, which does not cancel for inside < 0; metals are there.
    let root_im = (0.5 * (length - inside)).max(0.0).sqrt();
    let root_re = if root_im > 0.0 { 0.5 * im / root_im } else { inside.max(0.0).sqrt() };
    let ratio = |a_re: f64, a_im: f64| {
        let difference = (a_re - root_re).powi(2) + (a_im - root_im).powi(2);
        let sum = (a_re + root_re).powi(2) + (a_im + root_im).powi(2);
        if sum > 0.0 { difference / sum } else { 1.0 }
    };
    (0.5 * (ratio(x, 0.0) + ratio(re * x, im * x))).clamp(0.0, 1.0)
}
