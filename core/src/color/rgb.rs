//! Linear Rec.709, its encoding for the screen, and the way there from spectra.

use std::sync::LazyLock;

use glam::{DMat3, DVec3, Vec3};

use crate::color::adaptation::bradford;
use crate::color::illuminant::{self, D65};
use crate::color::observer::{CMF, COUNT, wavelength_nm};

/// Chromaticities of the Rec.709 primaries red, green, blue (ITU-R BT.709-6).
pub const PRIMARIES: [(f64, f64); 3] = [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06)];

/// Weights of linear Rec.709 red, green, blue in luminance (ITU-R BT.709-6).
pub const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// Share of each wavelength of the grid in the three channels. The shares of a channel sum to 1.
static WEIGHTS: LazyLock<[DVec3; COUNT]> = LazyLock::new(|| {
    let weighted = |i: usize| D65[i] * DVec3::from_array(CMF[i]);
    let scale = 1.0 / (0..COUNT).map(|i| weighted(i).y).sum::<f64>();
    let rgb_from_xyz = rgb_from_xyz();
    std::array::from_fn(|i| rgb_from_xyz * (scale * weighted(i)))
});

/// XYZ of the perfect reflector under D65, Y = 1, by the same sum as [`integrate`].
pub fn white_xyz() -> DVec3 {
    illuminant::xyz(&D65)
}

/// XYZ from linear Rec.709. Columns are the primaries, scaled so that they add up to [`white_xyz`]: a textbook matrix,
/// made for a rounded white, would give the perfect reflector 0.99988, 1.00004, 0.99997.
pub fn xyz_from_rgb() -> DMat3 {
    xyz_from_primaries(PRIMARIES, white_xyz())
}

/// XYZ from linear RGB of the primaries with chromaticities `(x, y)`, scaled so that (1, 1, 1) is `white`.
pub(super) fn xyz_from_primaries(primaries: [(f64, f64); 3], white: DVec3) -> DMat3 {
    let [r, g, b] = primaries.map(|(x, y)| xyz_from_xy(x, y));
    let unscaled = DMat3::from_cols(r, g, b);
    let scale = unscaled.inverse() * white;
    unscaled * DMat3::from_diagonal(scale)
}

/// XYZ of a chromaticity, Y = 1.
pub(super) fn xyz_from_xy(x: f64, y: f64) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// Linear Rec.709 from XYZ, the inverse of [`xyz_from_rgb`].
pub fn rgb_from_xyz() -> DMat3 {
    xyz_from_rgb().inverse()
}

/// Linear Rec.709 of a reflectance under D65: the sum over 380-780 nm in steps of 5 nm. Not clamped: a saturated
/// reflectance lies outside [0, 1].
pub fn integrate(reflectance: impl Fn(f64) -> f64) -> DVec3 {
    WEIGHTS.iter().enumerate().map(|(i, &weight)| weight * reflectance(wavelength_nm(i))).sum()
}

/// Linear Rec.709 of a reflectance of 1 at one wavelength of the grid and 0 at all others, under D65: the summands of
/// [`integrate`]. `index` is below [`COUNT`].
pub fn weight(index: usize) -> DVec3 {
    WEIGHTS[index]
}

/// Linear Rec.709 of a reflectance under another illuminant, given as relative power on the grid of [`CMF`], adapted to
/// D65 by Bradford: what an observer sees who is used to that light. White stays (1, 1, 1). Two metals that [`integrate`]
/// to one colour may differ here.
pub fn integrate_under(power: &[f64; COUNT], reflectance: impl Fn(f64) -> f64) -> DVec3 {
    let lit = |i: usize| power[i] * DVec3::from_array(CMF[i]);
    let sum: DVec3 = (0..COUNT).map(|i| reflectance(wavelength_nm(i)) * lit(i)).sum();
    let white: f64 = (0..COUNT).map(|i| lit(i).y).sum();
    rgb_from_xyz() * bradford(illuminant::xyz(power), white_xyz()) * (sum / white)
}

/// Luminance of linear Rec.709, in the unit of the channels.
pub fn luminance(linear: Vec3) -> f32 {
    LUMINANCE.dot(linear)
}

/// sRGB encoding of linear light, both in [0, 1]; values outside are clamped (IEC 61966-2-1).
pub fn srgb_from_linear(x: Vec3) -> Vec3 {
    let encode = |v: f32| {
        let v = unit(v);
        if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
    };
    Vec3::new(encode(x.x), encode(x.y), encode(x.z))
}

/// Linear light of an sRGB encoding, both in [0, 1]; values outside are clamped (IEC 61966-2-1).
pub fn linear_from_srgb(x: Vec3) -> Vec3 {
    let decode = |v: f32| {
        let v = unit(v);
        if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    };
    Vec3::new(decode(x.x), decode(x.y), decode(x.z))
}

/// Clamps to [0, 1]; unlike `clamp`, it takes NaN to 0.
fn unit(v: f32) -> f32 {
    if v > 0.0 { v.min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::preset;

    #[test]
    fn the_perfect_reflector_is_exactly_white() {
        let white = integrate(|_| 1.0);
        // 81 sums in f64.
        assert!((white - DVec3::ONE).abs().max_element() < 1e-14, "{white}");
        assert_eq!(integrate(|_| 0.0), DVec3::ZERO);
    }

    #[test]
    fn a_grey_reflector_is_grey_and_a_red_one_is_red() {
        let grey = integrate(|_| 0.18);
        assert!((grey - DVec3::splat(0.18)).abs().max_element() < 1e-14);
        let red = integrate(|nm| if nm < 600.0 { 0.0 } else { 1.0 });
        assert!(red.x > 5.0 * red.y.abs() && red.y < 0.0, "a spectral edge lies outside of Rec.709: {red}");
    }

    #[test]
    fn an_observer_used_to_another_light_sees_grey_as_grey_and_gold_a_little_otherwise() {
        for power in [&D65, &illuminant::A, &illuminant::E] {
            let grey = integrate_under(power, |_| 0.18);
            assert!((grey - 0.18).abs().max_element() < 1e-14, "{grey}");
        }
        let gold = preset::find("Au").unwrap();
        let under = |power| integrate_under(power, |nm| gold.reflectance(nm, 1.0));
        assert!((under(&D65) - gold.unclamped_f0()).abs().max_element() < 1e-14);
        let change = under(&illuminant::A) - under(&D65);
        assert!((0.005..0.1).contains(&change.abs().max_element()), "{change}");
    }

    #[test]
    fn the_matrix_differs_from_the_published_one_by_its_white_alone() {
        // IEC 61966-2-1, to four decimals, white 0.3127, 0.3290.
        let published = DMat3::from_cols(
            DVec3::new(0.4124, 0.2126, 0.0193),
            DVec3::new(0.3576, 0.7152, 0.1192),
            DVec3::new(0.1805, 0.0722, 0.9505),
        );
        let ours = xyz_from_rgb();
        for c in 0..3 {
            assert!((ours.col(c) - published.col(c)).abs().max_element() < 3e-4, "{ours}");
        }
        let luminance = ours.row(1);
        assert!((luminance - LUMINANCE.as_dvec3()).abs().max_element() < 1e-4, "{luminance}");
        assert!((rgb_from_xyz() * white_xyz() - DVec3::ONE).abs().max_element() < 1e-14);
    }

    #[test]
    fn srgb_meets_published_values_and_its_inverse() {
        // 50 % grey and the knee.
        assert!((srgb_from_linear(Vec3::splat(0.5)).x - 0.735_357).abs() < 1e-6);
        assert!((linear_from_srgb(Vec3::splat(0.5)).x - 0.214_041).abs() < 1e-6);
        for i in 0..=1000 {
            let x = Vec3::splat(i as f32 / 1000.0);
            assert!((linear_from_srgb(srgb_from_linear(x)) - x).abs().max_element() < 1e-6);
        }
        let outside = Vec3::new(-1.0, 2.0, f32::NAN);
        // 1.055 - 0.055 in f32 is one unit below 1.
        assert!((srgb_from_linear(outside) - Vec3::Y).abs().max_element() < 1e-6);
        assert_eq!(linear_from_srgb(outside), Vec3::Y);
    }

    #[test]
    fn the_two_pieces_of_srgb_meet_at_the_knee() {
        let below = 12.92 * 0.003_130_8_f32;
        let above = 1.055 * 0.003_130_8_f32.powf(1.0 / 2.4) - 0.055;
        assert!((below - above).abs() < 1e-6);
    }
}
