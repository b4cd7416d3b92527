//! Standard illuminants.

use std::sync::LazyLock;

use glam::DVec3;

use crate::color::observer::{CMF, COUNT, wavelength_nm};

/// Relative power of D65 at 380, 385 ... 780 nm, 100 at 560 nm (CIE 15:2018).
pub const D65: [f64; COUNT] = [
    49.9755, 52.3118, 54.6482, 68.7015, 82.7549, 87.1204, 91.486, 92.4589, 93.4318, 90.057, 86.6823, 95.7736, 104.865,
    110.936, 117.008, 117.41, 117.812, 116.336, 114.861, 115.392, 115.923, 112.367, 108.811, 109.082, 109.354, 108.578,
    107.802, 106.296, 104.79, 106.239, 107.689, 106.047, 104.405, 104.225, 104.046, 102.023, 100.0, 98.1671, 96.3342,
    96.0611, 95.788, 92.2368, 88.6856, 89.3459, 90.0062, 89.8026, 89.5991, 88.6489, 87.6987, 85.4936, 83.2886, 83.4939,
    83.6992, 81.863, 80.0268, 80.1207, 80.2146, 81.2462, 82.2778, 80.281, 78.2842, 74.0027, 69.7213, 70.6652, 71.6091,
    72.979, 74.349, 67.9765, 61.604, 65.7448, 69.8856, 72.4863, 75.087, 69.3398, 63.5927, 55.0054, 46.4182, 56.6118,
    66.8054, 65.0941, 63.3828,
];

/// Equal energy at every wavelength.
pub const E: [f64; COUNT] = [100.0; COUNT];

/// Incandescent light on the grid of [`CMF`], 100 at 560 nm: Planck's law at 2848 K with the second radiation constant
/// 1.435e7 nm K, which defines it (CIE 15:2018; today's constant would say 2856 K).
pub static A: LazyLock<[f64; COUNT]> = LazyLock::new(|| {
    let quantum = |nm: f64| (1.435e7 / (2848.0 * nm)).exp_m1();
    std::array::from_fn(|i| {
        let nm = wavelength_nm(i);
        100.0 * (560.0 / nm).powi(5) * quantum(560.0) / quantum(nm)
    })
});

/// XYZ of the perfect reflector under an illuminant, Y = 1.
pub fn xyz(power: &[f64; COUNT]) -> DVec3 {
    let sum: DVec3 = power.iter().zip(&CMF).map(|(&power, &cmf)| power * DVec3::from_array(cmf)).sum();
    sum / sum.y
}

/// Chromaticity `(x, y)` of an illuminant for the 2-degree observer.
pub fn chromaticity(power: &[f64; COUNT]) -> (f64, f64) {
    let xyz = xyz(power);
    let total = xyz.element_sum();
    (xyz.x / total, xyz.y / total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn d65_has_the_chromaticity_that_the_cie_publishes() {
        let (x, y) = chromaticity(&D65);
        // Published with five decimals.
        assert!((x - 0.31272).abs() < 5e-6 && (y - 0.32903).abs() < 5e-6, "{x} {y}");
    }

    #[test]
    fn illuminant_a_has_the_published_power_and_chromaticity() {
        // CIE 15:2018: 9.80 at 380 nm, 100 at 560 nm, 227.0 at 750 nm.
        let at = |nm: usize| A[(nm - 380) / 5];
        assert!((at(380) - 9.7951).abs() < 5e-5 && at(560) == 100.0 && (at(750) - 227.0).abs() < 0.05, "{}", at(380));
        let (x, y) = chromaticity(&A);
        // Published as 0.44758, 0.40745, from 1 nm steps.
        assert!((x - 0.44758).abs() < 2e-5 && (y - 0.40745).abs() < 2e-5, "{x} {y}");
    }

    #[test]
    fn equal_energy_is_at_one_third() {
        let (x, y) = chromaticity(&E);
        assert!((x - 1.0 / 3.0).abs() < 2e-5 && (y - 1.0 / 3.0).abs() < 2e-5, "{x} {y}");
    }
}
