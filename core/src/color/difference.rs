//! How different two colours look.

use glam::{DVec2, DVec3};

/// CIEDE2000 of two L\*a\*b\* colours, 0 or more, the same either way; about 1 is just noticeable side by side. For
/// differences up to about 5; beyond, the number only says "large". Sharma et al. 2005, eqs. 2-22, kL = kC = kH = 1.
///
/// `dE^2 = (dL'/SL)^2 + (dC'/SC)^2 + (dH'/SH)^2 + RT (dC'/SC) (dH'/SH)`
pub fn ciede2000(lab1: DVec3, lab2: DVec3) -> f64 {
    let (lch1, lch2) = stretched(lab1, lab2);
    let product = lch1.y * lch2.y;
    let turn = if product == 0.0 { 0.0 } else { turn(lch1.z, lch2.z) };
    let mean_hue = if product == 0.0 { lch1.z + lch2.z } else { lch1.z + turn / 2.0 };
    let (dl, dc) = (lch2.x - lch1.x, lch2.y - lch1.y);
    let dh = 2.0 * product.sqrt() * (turn / 2.0).to_radians().sin();
    let (mean_l, mean_c) = ((lch1.x + lch2.x) / 2.0, (lch1.y + lch2.y) / 2.0);

    let cos = |degrees: f64| degrees.to_radians().cos();
    let t = 1.0 - 0.17 * cos(mean_hue - 30.0) + 0.24 * cos(2.0 * mean_hue) + 0.32 * cos(3.0 * mean_hue + 6.0)
        - 0.20 * cos(4.0 * mean_hue - 63.0);
    let from_50 = (mean_l - 50.0).powi(2);
    let sl = 1.0 + 0.015 * from_50 / (20.0 + from_50).sqrt();
    let sc = 1.0 + 0.045 * mean_c;
    let sh = 1.0 + 0.015 * mean_c * t;
    // The blues around 275 degrees, where chroma and hue hang together.
    let theta = 30.0 * (-((mean_hue.rem_euclid(360.0) - 275.0) / 25.0).powi(2)).exp();
    let rt = -2.0 * high(mean_c) * (2.0 * theta).to_radians().sin();

    let (l, c, h) = (dl / sl, dc / sc, dh / sh);
    // Rounding may take the sum just below 0.
    (l * l + c * c + h * h + rt * c * h).max(0.0).sqrt()
}

/// Lightness, chroma and hue in degrees of both, with a\* stretched near grey (eqs. 2-7).
fn stretched(lab1: DVec3, lab2: DVec3) -> (DVec3, DVec3) {
    let chroma = |lab: DVec3| DVec2::new(lab.y, lab.z).length();
    let g = 0.5 * (1.0 - high((chroma(lab1) + chroma(lab2)) / 2.0));
    let lch = |lab: DVec3| {
        let ab = DVec2::new((1.0 + g) * lab.y, lab.z);
        // atan2(0, 0) is 0 in Rust, as the formula wants.
        DVec3::new(lab.x, ab.length(), ab.y.atan2(ab.x).to_degrees().rem_euclid(360.0))
    };
    (lch(lab1), lch(lab2))
}

/// Signed way from one hue to the other on the shorter side, degrees (eq. 10).
fn turn(from: f64, to: f64) -> f64 {
    let turn = to - from;
    match turn {
        t if t > 180.0 => t - 360.0,
        t if t < -180.0 => t + 360.0,
        t => t,
    }
}

/// `sqrt(C^7 / (C^7 + 25^7))`: 0 for grey, 1 for strong colours.
fn high(chroma: f64) -> f64 {
    let power = chroma.powi(7);
    (power / (power + 25f64.powi(7))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sharma et al. 2005, table 1: L, a, b of both colours, and their difference.
    const PAIRS: [[f64; 7]; 34] = [
        [50.0, 2.6772, -79.7751, 50.0, 0.0, -82.7485, 2.0425],
        [50.0, 3.1571, -77.2803, 50.0, 0.0, -82.7485, 2.8615],
        [50.0, 2.8361, -74.0200, 50.0, 0.0, -82.7485, 3.4412],
        [50.0, -1.3802, -84.2814, 50.0, 0.0, -82.7485, 1.0],
        [50.0, -1.1848, -84.8006, 50.0, 0.0, -82.7485, 1.0],
        [50.0, -0.9009, -85.5211, 50.0, 0.0, -82.7485, 1.0],
        [50.0, 0.0, 0.0, 50.0, -1.0, 2.0, 2.3669],
        [50.0, -1.0, 2.0, 50.0, 0.0, 0.0, 2.3669],
        [50.0, 2.49, -0.001, 50.0, -2.49, 0.0009, 7.1792],
        [50.0, 2.49, -0.001, 50.0, -2.49, 0.0010, 7.1792],
        [50.0, 2.49, -0.001, 50.0, -2.49, 0.0011, 7.2195],
        [50.0, 2.49, -0.001, 50.0, -2.49, 0.0012, 7.2195],
        [50.0, -0.001, 2.49, 50.0, 0.0009, -2.49, 4.8045],
        [50.0, -0.001, 2.49, 50.0, 0.0010, -2.49, 4.8045],
        [50.0, -0.001, 2.49, 50.0, 0.0011, -2.49, 4.7461],
        [50.0, 2.5, 0.0, 50.0, 0.0, -2.5, 4.3065],
        [50.0, 2.5, 0.0, 73.0, 25.0, -18.0, 27.1492],
        [50.0, 2.5, 0.0, 61.0, -5.0, 29.0, 22.8977],
        [50.0, 2.5, 0.0, 56.0, -27.0, -3.0, 31.9030],
        [50.0, 2.5, 0.0, 58.0, 24.0, 15.0, 19.4535],
        [50.0, 2.5, 0.0, 50.0, 3.1736, 0.5854, 1.0],
        [50.0, 2.5, 0.0, 50.0, 3.2972, 0.0, 1.0],
        [50.0, 2.5, 0.0, 50.0, 1.8634, 0.5757, 1.0],
        [50.0, 2.5, 0.0, 50.0, 3.2592, 0.3350, 1.0],
        [60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644],
        [63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630],
        [61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731],
        [35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645],
        [22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373],
        [36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146],
        [90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441],
        [90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381],
        [6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377],
        [2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082],
    ];

    #[test]
    fn the_published_pairs_are_met_both_ways() {
        for (i, [l1, a1, b1, l2, a2, b2, published]) in PAIRS.into_iter().enumerate() {
            let (lab1, lab2) = (DVec3::new(l1, a1, b1), DVec3::new(l2, a2, b2));
            for found in [ciede2000(lab1, lab2), ciede2000(lab2, lab1)] {
                // Published with four decimals.
                assert!((found - published).abs() < 1e-4, "pair {}: {found} instead of {published}", i + 1);
            }
        }
    }

    #[test]
    fn a_colour_does_not_differ_from_itself() {
        for [l, a, b, ..] in PAIRS {
            assert_eq!(ciede2000(DVec3::new(l, a, b), DVec3::new(l, a, b)), 0.0);
        }
        assert_eq!(ciede2000(DVec3::ZERO, DVec3::ZERO), 0.0);
    }

    #[test]
    fn lightness_alone_is_weighted_by_its_distance_from_50() {
        // SL = 1 + 0.015 * 0 / sqrt(20) at a mean of 50.
        let found = ciede2000(DVec3::new(49.0, 0.0, 0.0), DVec3::new(51.0, 0.0, 0.0));
        assert!((found - 2.0).abs() < 1e-12, "{found}");
    }
}
