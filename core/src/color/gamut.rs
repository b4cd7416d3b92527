//! What clamping a colour to Rec.709 costs.

use glam::DVec3;

use crate::color::difference::ciede2000;
use crate::color::lab::lab_from_rgb;

/// A colour outside of [0, 1], and the one a renderer uses in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clip {
    /// Linear Rec.709 as computed.
    pub unclamped: DVec3,
    /// Each channel clamped to [0, 1].
    pub clamped: DVec3,
    /// CIEDE2000 between the two.
    pub delta_e: f64,
}

/// A channel this far outside is rounding of a sum, not a colour.
const ROUNDING: f64 = 1e-9;

/// What clamping linear Rec.709 to [0, 1] changes; none where it changes nothing.
pub fn clip(linear: DVec3) -> Option<Clip> {
    let clamped = linear.clamp(DVec3::ZERO, DVec3::ONE);
    let changes = (linear - clamped).abs().max_element() > ROUNDING;
    changes.then(|| Clip {
        unclamped: linear,
        clamped,
        delta_e: ciede2000(lab_from_rgb(linear), lab_from_rgb(clamped)),
    })
}

#[cfg(test)]
mod tests {
    use glam::Vec3Swizzles as _;

    use super::*;
    use crate::color::rgb;
    use crate::material::preset;

    #[test]
    fn a_colour_within_the_gamut_is_left_alone() {
        assert_eq!(clip(DVec3::new(0.0, 0.5, 1.0)), None);
        assert_eq!(clip(rgb::integrate(|_| 1.0)), None);
    }

    #[test]
    fn gold_loses_a_barely_visible_part_of_its_red() {
        let clip = clip(preset::find("Au").unwrap().unclamped_f0()).unwrap();
        assert!(clip.unclamped.x > 1.03 && clip.clamped.x == 1.0);
        assert_eq!(clip.unclamped.yz(), clip.clamped.yz());
        assert!(clip.delta_e > 0.5 && clip.delta_e < 2.0, "{}", clip.delta_e);
    }

    #[test]
    fn negative_channels_are_clipped_too() {
        let clip = clip(DVec3::new(-0.1, 0.5, 0.5)).unwrap();
        assert_eq!(clip.clamped, DVec3::new(0.0, 0.5, 0.5));
        assert!(clip.delta_e > 1.0 && clip.delta_e.is_finite());
    }
}
