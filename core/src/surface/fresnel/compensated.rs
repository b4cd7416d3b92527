//! Schlick's curve less a term that follows the dip of metals before grazing.

use glam::Vec3;

use super::schlick;

/// Exponents of the series of two, three or four terms; none for another number. Powers of `y = 1 - x` that a few
/// products reach.
pub const fn exponents(terms: usize) -> &'static [u32] {
    match terms {
        2 => &[3, 8],
        3 => &[2, 6, 12],
        4 => &[2, 4, 8, 16],
        _ => &[],
    }
}

/// `F* - a x (1 - x)^alpha`, F* = [`schlick`] to 1. Lazanyi and Szirmay-Kalos 2005, Fresnel Term Approximations for
/// Metals. `alpha` is positive; 0 at `cos_theta` = 1 whatever `alpha`, so that F0 stays exact.
pub fn compensated(f0: Vec3, a: Vec3, alpha: Vec3, cos_theta: f32) -> Vec3 {
    let x = cos_theta.clamp(0.0, 1.0);
    let y = 1.0 - x;
    let power = if y > 0.0 { Vec3::new(y.powf(alpha.x), y.powf(alpha.y), y.powf(alpha.z)) } else { Vec3::ZERO };
    schlick(f0, 1.0, x) - x * a * power
}

/// [`compensated`] with the exponent 6 that OpenPBR, Adobe and Blender use. Kutz et al. 2021, Novel Aspects of the
/// Adobe Standard Material.
pub fn f82(f0: Vec3, b: Vec3, cos_theta: f32) -> Vec3 {
    let x = cos_theta.clamp(0.0, 1.0);
    let y = 1.0 - x;
    let y2 = y * y;
    schlick(f0, 1.0, x) - x * (y2 * y2 * y2) * b
}

/// `F* - x (c3 y^3 + c8 y^8)`, y = 1 - x.
pub fn series2(f0: Vec3, c: &[Vec3; 2], cos_theta: f32) -> Vec3 {
    let x = cos_theta.clamp(0.0, 1.0);
    let y = 1.0 - x;
    let y2 = y * y;
    let y4 = y2 * y2;
    schlick(f0, 1.0, x) - (x * y2 * y) * (c[0] + (y4 * y) * c[1])
}

/// `F* - x (c2 y^2 + c6 y^6 + c12 y^12)`, y = 1 - x.
pub fn series3(f0: Vec3, c: &[Vec3; 3], cos_theta: f32) -> Vec3 {
    let x = cos_theta.clamp(0.0, 1.0);
    let y = 1.0 - x;
    let y2 = y * y;
    let y4 = y2 * y2;
    schlick(f0, 1.0, x) - (x * y2) * (c[0] + y4 * (c[1] + (y4 * y2) * c[2]))
}

/// `F* - x (c2 y^2 + c4 y^4 + c8 y^8 + c16 y^16)`, y = 1 - x.
pub fn series4(f0: Vec3, c: &[Vec3; 4], cos_theta: f32) -> Vec3 {
    let x = cos_theta.clamp(0.0, 1.0);
    let y = 1.0 - x;
    let y2 = y * y;
    let y4 = y2 * y2;
    schlick(f0, 1.0, x) - (x * y2) * (c[0] + y2 * (c[1] + y4 * (c[2] + (y4 * y4) * c[3])))
}
