//! The colour of light of a temperature.

use glam::{DVec3, Vec3};

use super::illuminant;
use super::observer::{COUNT, wavelength_nm};
use super::rgb::{luminance, rgb_from_xyz};

/// Second radiation constant in nm K (CODATA 2018).
const C2_NM_K: f64 = 1.438_776_877e7;
/// Temperatures in kelvin that lamps and skies are given by.
pub const KELVIN: [f64; 2] = [1000.0, 40_000.0];

/// Linear Rec.709 of a black body, luminance 1; `kelvin` is brought into [`KELVIN`]. Planck's law over 380-780 nm and the
/// observer of 1931, not adapted: 6500 K is nearly white, less is warmer. What Rec.709 cannot hold, the blue below about
/// 1900 K, is left out.
pub fn blackbody(kelvin: f64) -> Vec3 {
    let kelvin = if kelvin.is_finite() { kelvin.clamp(KELVIN[0], KELVIN[1]) } else { 6500.0 };
    let quantum = |nm: f64| (C2_NM_K / (kelvin * nm)).exp_m1();
    let power: [f64; COUNT] = std::array::from_fn(|i| {
        let nm = wavelength_nm(i);
        (560.0 / nm).powi(5) * quantum(560.0) / quantum(nm)
    });
    let rgb = (rgb_from_xyz() * illuminant::xyz(&power)).max(DVec3::ZERO).as_vec3();
    rgb / luminance(rgb)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::rgb::xyz_from_rgb;

    #[test]
    fn the_chromaticity_is_that_of_the_planckian_locus() {
        // CIE 15: illuminant A stands for 2856 K; 6504 K on the locus, from tables of the locus to three decimals.
        for (kelvin, x, y) in [(2856.0, 0.4476, 0.4074), (4000.0, 0.3805, 0.3768), (6504.0, 0.3135, 0.3237)] {
            let xyz = xyz_from_rgb() * blackbody(kelvin).as_dvec3();
            let sum = xyz.element_sum();
            assert!((xyz.x / sum - x).abs() < 6e-4 && (xyz.y / sum - y).abs() < 6e-4, "{kelvin}: {xyz}");
        }
    }

    #[test]
    fn colours_of_black_bodies_have_luminance_1_and_daylight_is_nearly_white() {
        for kelvin in [-1.0, 1000.0, 2700.0, 6504.0, 40_000.0, f64::NAN] {
            assert!((luminance(blackbody(kelvin)) - 1.0).abs() < 1e-5);
        }
        let day = blackbody(6504.0);
        assert!((day - Vec3::ONE).abs().max_element() < 0.06, "{day}");
        let warm = blackbody(2700.0);
        assert!(warm.x > 1.5 && warm.z < 0.3, "{warm}");
    }

    #[test]
    fn luminance_is_one_and_warm_is_red() {
        let mut last = f32::INFINITY;
        for kelvin in [f64::NAN, -5.0, 1000.0, 1500.0, 2700.0, 5000.0, 6500.0, 12_000.0, 1e9] {
            let rgb = blackbody(kelvin);
            assert!((luminance(rgb) - 1.0).abs() < 1e-5 && rgb.min_element() >= 0.0, "{kelvin}: {rgb}");
            if kelvin > 1000.0 && kelvin < 1e9 {
                assert!(rgb.x < last, "{kelvin}");
                last = rgb.x;
            }
        }
        let white = blackbody(6504.0);
        assert!((white - Vec3::ONE).abs().max_element() < 0.06, "{white}");
    }
}
