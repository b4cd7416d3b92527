//! Index of refraction from two colours that an artist can pick.

/// Largest reflectance that an index is made for: at 1 both parts are infinite.
pub const REFLECTANCE_MAX: f64 = 0.9999;

/// `(n, k)` of a conductor with reflectance `r` at normal incidence and edge tint `g`, both in [0, 1].
///
/// `n = g (1 - r)/(1 + r) + (1 - g)(1 + sqrt r)/(1 - sqrt r)`, `k^2 = (r (n + 1)^2 - (n - 1)^2)/(1 - r)`; `r` is held at
/// [`REFLECTANCE_MAX`]. Gulbrandsen 2014, Artist Friendly Metallic Fresnel. `g` is neither the reflectance at
/// 82 degrees nor a ratio: 0 is the largest n (k = 0), 1 the smallest.
pub fn gulbrandsen(r: f64, g: f64) -> (f64, f64) {
    let r = if r > 0.0 { r.min(REFLECTANCE_MAX) } else { 0.0 };
    let g = if g > 0.0 { g.min(1.0) } else { 0.0 };
    let root = r.sqrt();
    let n = g * (1.0 - r) / (1.0 + r) + (1.0 - g) * (1.0 + root) / (1.0 - root);
    let k2 = (r * (n + 1.0).powi(2) - (n - 1.0).powi(2)) / (1.0 - r);
    (n, k2.max(0.0).sqrt())
}
