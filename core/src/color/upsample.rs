//! From linear Rec.709 to a spectrum that has this colour.

use glam::Vec3;

use super::observer::COUNT;

/// Parts of red, green and blue at 380, 385 ... 780 nm.
///
/// Under D65 the colour of the parts of red is (1, 0, 0), and likewise for the others, to 2e-7. At each wavelength they sum
/// to 1, so grey has an even spectrum, and lie in [0, 1], so a colour in [0, 1] is a reflectance. Of all such parts these
/// have the least sum of squared second differences. The constraints are those of Mallett and Yuksel 2019, Spectral Primary
/// Decomposition for Rendering with sRGB Reflectance; the numbers were computed for this observer and this grid.
pub const PARTS: [[f32; 3]; COUNT] = [
    [0.267499, 0.0, 0.732501],
    [0.245807, 0.000001, 0.754192],
    [0.224117, 0.0, 0.775883],
    [0.20243, 0.0, 0.79757],
    [0.180754, 0.0, 0.819246],
    [0.159104, 0.0, 0.840896],
    [0.137511, 0.0, 0.862489],
    [0.11604, 0.0, 0.88396],
    [0.094816, 0.0, 0.905184],
    [0.074067, 0.0, 0.925933],
    [0.054202, 0.0, 0.945798],
    [0.035886, 0.0, 0.964114],
    [0.020071, 0.0, 0.979929],
    [0.008009, 0.0, 0.991991],
    [0.001194, 0.0, 0.998806],
    [0.0, 0.002434, 0.997566],
    [0.000225, 0.018652, 0.981123],
    [0.000312, 0.054821, 0.944867],
    [0.000099, 0.112841, 0.88706],
    [0.0, 0.191259, 0.808741],
    [0.0, 0.286509, 0.713491],
    [0.0, 0.393441, 0.606559],
    [0.0, 0.505916, 0.494084],
    [0.0, 0.61749, 0.38251],
    [0.0, 0.721937, 0.278063],
    [0.0, 0.813733, 0.186267],
    [0.0, 0.888532, 0.111468],
    [0.0, 0.943672, 0.056328],
    [0.0, 0.978677, 0.021323],
    [0.0, 0.995723, 0.004277],
    [0.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.998869, 0.001131],
    [0.0, 0.99043, 0.00957],
    [0.011507, 0.965444, 0.023049],
    [0.048687, 0.915658, 0.035655],
    [0.116896, 0.839126, 0.043978],
    [0.214515, 0.73884, 0.046645],
    [0.334781, 0.621375, 0.043844],
    [0.467668, 0.495486, 0.036846],
    [0.601806, 0.370693, 0.027501],
    [0.726166, 0.256046, 0.017788],
    [0.83153, 0.159035, 0.009435],
    [0.911684, 0.084708, 0.003608],
    [0.964309, 0.035029, 0.000662],
    [0.991511, 0.008489, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.999999, 0.0, 0.000001],
    [0.999999, 0.0, 0.000001],
    [0.999999, 0.0, 0.000001],
    [0.999999, 0.0, 0.000001],
    [0.999999, 0.000001, 0.0],
    [0.999998, 0.000001, 0.000001],
    [0.999993, 0.000002, 0.000005],
    [0.999984, 0.000004, 0.000012],
    [0.999969, 0.00001, 0.000021],
    [0.999951, 0.000017, 0.000032],
    [0.99993, 0.000025, 0.000045],
    [0.999906, 0.000035, 0.000059],
    [0.999882, 0.000045, 0.000073],
    [0.999856, 0.000056, 0.000088],
    [0.999831, 0.000067, 0.000102],
];

/// Value at a wavelength of the grid of the spectrum that stands for a colour: the reflectance of a surface, or the
/// radiance of light over that of D65. `index` is below [`COUNT`].
pub fn at(rgb: Vec3, index: usize) -> f32 {
    Vec3::from_array(PARTS[index]).dot(rgb)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::observer::{FIRST_NM, STEP_NM};
    use crate::color::rgb::integrate;

    #[test]
    fn the_spectrum_of_a_colour_has_that_colour() {
        for rgb in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE, Vec3::new(0.9, 0.5, 0.1)] {
            let back = integrate(|nm| f64::from(at(rgb, ((nm - FIRST_NM) / STEP_NM).round() as usize)));
            assert!((back - rgb.as_dvec3()).abs().max_element() < 1e-6, "{rgb}: {back}");
        }
    }

    #[test]
    fn grey_is_even_and_colours_stay_reflectances() {
        for (index, parts) in PARTS.iter().enumerate() {
            assert!((at(Vec3::ONE, index) - 1.0).abs() < 1e-5, "{index}: {parts:?}");
            assert!(parts.iter().all(|p| (0.0..=1.0).contains(p)), "{index}: {parts:?}");
        }
        let steps = PARTS.windows(2).map(|w| (Vec3::from_array(w[0]) - Vec3::from_array(w[1])).abs().max_element());
        assert!(steps.fold(0.0, f32::max) < 0.15, "smooth");
    }
}
