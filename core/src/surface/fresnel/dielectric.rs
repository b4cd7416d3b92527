//! Exact reflectance of a dielectric.

/// Unpolarised reflectance for the real relative index `eta` = transmitted / incident, at `cos_theta` in [0, 1] on the
/// incident side. 1 under total reflection (`eta < sin`).
///
/// With `g^2 = eta^2 - sin^2`: `Rs = ((c - g)/(c + g))^2`, `Rp = ((eta^2 c - g)/(eta^2 c + g))^2`.
pub fn dielectric(eta: f32, cos_theta: f32) -> f32 {
    let c = cos_theta.clamp(0.0, 1.0);
    let g2 = (eta - 1.0) * (eta + 1.0) + c * c;
    if g2 > 0.0 {
        let g = g2.sqrt();
        let rs = (c - g) / (c + g);
        let rp = (eta * eta * c - g) / (eta * eta * c + g);
        0.5 * (rs * rs + rp * rp)
    } else {
        1.0
    }
}
