//! CIE L\*a\*b\*: colours as an observer tells them apart, relative to a white.

use glam::DVec3;

use crate::color::rgb;

/// Below this share of white the curve is a line: (6/29)^3.
const KNEE: f64 = 216.0 / 24389.0;

/// L\*, a\*, b\* of XYZ as seen beside `white`, in the same unit. L\* is 0 for black and 100 for white; a\* runs from
/// green to red, b\* from blue to yellow. CIE 15:2018, with its linear part; negative XYZ follow the line.
///
/// `L* = 116 f(Y/Yn) - 16, a* = 500 (f(X/Xn) - f(Y/Yn)), b* = 200 (f(Y/Yn) - f(Z/Zn))`
pub fn lab_from_xyz(xyz: DVec3, white: DVec3) -> DVec3 {
    let f = |t: f64| if t > KNEE { t.cbrt() } else { 841.0 / 108.0 * t + 4.0 / 29.0 };
    let share = xyz / white;
    let (x, y, z) = (f(share.x), f(share.y), f(share.z));
    DVec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

/// L\*, a\*, b\* of linear Rec.709, beside the white (1, 1, 1), D65. Any finite value, within the gamut or not.
pub fn lab_from_rgb(linear: DVec3) -> DVec3 {
    lab_from_xyz(rgb::xyz_from_rgb() * linear, rgb::white_xyz())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_100_and_black_0_without_a_hue() {
        for (linear, lightness) in [(DVec3::ONE, 100.0), (DVec3::ZERO, 0.0)] {
            let lab = lab_from_rgb(linear);
            assert!((lab - DVec3::new(lightness, 0.0, 0.0)).abs().max_element() < 1e-12, "{lab}");
        }
    }

    #[test]
    fn grey_has_the_lightness_of_the_formula_on_both_sides_of_the_knee() {
        // Middle grey, 116 * 0.18^(1/3) - 16; and 1/1000, on the line of slope 24389/27 = 903.3.
        for (grey, lightness) in [(0.18, 116.0 * 0.18f64.cbrt() - 16.0), (0.001, 24.389 / 27.0)] {
            let lab = lab_from_rgb(DVec3::splat(grey));
            assert!((lab - DVec3::new(lightness, 0.0, 0.0)).abs().max_element() < 1e-12, "{lab}");
        }
    }

    #[test]
    fn the_primaries_of_the_screen_are_where_they_are_known_to_be() {
        // sRGB red, green and blue in L*a*b* under D65, to one decimal as commonly printed.
        let known = [
            (DVec3::X, DVec3::new(53.2, 80.1, 67.2)),
            (DVec3::Y, DVec3::new(87.7, -86.2, 83.2)),
            (DVec3::Z, DVec3::new(32.3, 79.2, -107.9)),
        ];
        for (linear, lab) in known {
            // The white here has more digits than the usual 0.9505, 1, 1.089.
            assert!((lab_from_rgb(linear) - lab).abs().max_element() < 0.1, "{linear} {}", lab_from_rgb(linear));
        }
    }

    #[test]
    fn the_two_pieces_meet_smoothly_at_the_knee() {
        let lightness = |y: f64| lab_from_xyz(DVec3::splat(y), DVec3::ONE).x;
        let h = 1e-7;
        let (below, above) = (lightness(KNEE) - lightness(KNEE - h), lightness(KNEE + h) - lightness(KNEE));
        // Both slopes are 903.3.
        assert!((below / h - 24389.0 / 27.0).abs() < 0.1 && (above / h - 24389.0 / 27.0).abs() < 0.1);
        assert!(lightness(-0.01) < 0.0, "light that no screen has stays below black");
    }
}
