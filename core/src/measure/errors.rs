//! The errors of a picture in one go, over a part of its pixels, and the noise that the reference itself has.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::{MeasureError, PIXELS_PER_DEGREE, RELMSE_EPSILON, check, flip};
use crate::color::rgb::luminance;
use crate::picture::Picture;

/// Share of the pixels that [`Errors::worst`] is about.
const WORST: f64 = 0.01;

/// How wrong a picture is; all but the bias are 0 or more and 0 for equal pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Relative mean squared error, see [`super::relmse`].
    pub relmse: f64,
    /// Mean of the FLIP map, 0 to 1.
    pub flip: f64,
    /// 99th percentile of the FLIP map, 0 to 1: the least error that 99 % of the pixels do not exceed.
    pub flip_p99: f64,
    /// Difference of mean luminance relative to the reference's; 0 where that is black.
    pub bias: f64,
    /// Mean of |x − r| over mean of r, all channels; 0 where the reference is black.
    pub difference: f64,
    /// Relative MSE of the worst 1 % of the pixels, at least one.
    pub worst: f64,
}

/// Which pixels count: as many as a picture has, row by row.
pub type Mask = [bool];

/// Errors of `picture` over the pixels of each mask, in their order; `None` for one without pixels.
///
/// FLIP sees the whole pictures, since it filters over neighbours; only then are pixels chosen. `exposure_ev` is that of
/// the screen for FLIP, whose observer has [`PIXELS_PER_DEGREE`].
pub fn errors(
    reference: &Picture,
    picture: &Picture,
    exposure_ev: f32,
    masks: &[&Mask],
) -> Result<Vec<Option<Errors>>, MeasureError> {
    check(reference, picture)?;
    let seen = flip(reference, picture, exposure_ev, PIXELS_PER_DEGREE)?.map;
    Ok(masks.iter().map(|mask| over(reference, picture, &seen, mask)).collect())
}

fn over(reference: &Picture, picture: &Picture, seen: &[f32], mask: &Mask) -> Option<Errors> {
    let chosen: Vec<usize> = (0..reference.texels.len()).filter(|i| mask.get(*i) == Some(&true)).collect();
    let count = chosen.len();
    if count == 0 {
        return None;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let color = |of: &Picture, i: usize| -> Vec3 { of.texels[i].truncate() };
    let mut squares: Vec<f64> =
        chosen.iter().map(|i| relative_square(color(reference, *i), color(picture, *i))).collect();
    let relmse = mean(&squares);
    squares.sort_by(f64::total_cmp);
    let worst = (WORST * count as f64).ceil() as usize;
    let mut flips: Vec<f64> = chosen.iter().map(|i| f64::from(seen[*i])).collect();
    let flip = mean(&flips);
    flips.sort_by(f64::total_cmp);
    let total = |of: &Picture| chosen.iter().map(|i| f64::from(luminance(color(of, *i)))).sum::<f64>();
    let (wanted, found) = (total(reference), total(picture));
    let apart: f64 =
        chosen.iter().map(|i| f64::from((color(picture, *i) - color(reference, *i)).abs().element_sum())).sum();
    let light: f64 = chosen.iter().map(|i| f64::from(color(reference, *i).element_sum())).sum();
    Some(Errors {
        relmse,
        flip,
        flip_p99: flips[((0.99 * count as f64).ceil() as usize).clamp(1, count) - 1],
        bias: if wanted > 0.0 { (found - wanted) / wanted } else { 0.0 },
        difference: if light > 0.0 { apart / light } else { 0.0 },
        worst: mean(&squares[count - worst.clamp(1, count)..]),
    })
}

/// `(x - r)² / (r² + 0.01)`, mean over the channels of a pixel.
pub fn relative_square(reference: Vec3, picture: Vec3) -> f64 {
    let (r, x) = (reference.as_dvec3(), picture.as_dvec3());
    ((x - r) * (x - r) / (r * r + RELMSE_EPSILON)).element_sum() / 3.0
}

impl Errors {
    /// What the noise of a reference adds to the errors of a picture that is right, from those between the two halves
    /// that the reference is the mean of.
    ///
    /// The halves differ by twice the deviation of their mean: measures that grow with the difference are halved (FLIP,
    /// bias, the difference itself), those that grow with its square are quartered.
    pub fn floor_of_halves(self) -> Errors {
        Errors {
            relmse: self.relmse / 4.0,
            flip: self.flip / 2.0,
            flip_p99: self.flip_p99 / 2.0,
            bias: self.bias.abs() / 2.0,
            difference: self.difference / 2.0,
            worst: self.worst / 4.0,
        }
    }
}

/// The pixels of a mask without those that touch others: silhouettes left out. `width` is that of the picture.
pub fn interior(mask: &Mask, width: u32) -> Vec<bool> {
    let width = (width as usize).max(1);
    let height = mask.len() / width;
    let inside = |x: usize, y: usize| {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        rows.flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| y * width + x)).all(|i| mask[i])
    };
    (0..mask.len()).map(|i| i / width < height && inside(i % width, i / width)).collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::super::{luminance_bias, relmse};
    use super::*;

    fn noisy(seed: u64, size: u32) -> Picture {
        let mut random = crate::math::sampling::Random::new(seed);
        Picture::from_fn(size, size, |_, _| (random.point3() + 0.1).extend(1.0))
    }

    #[test]
    fn over_all_pixels_they_are_the_metrics_of_whole_pictures() {
        let (a, b) = (noisy(1, 32), noisy(2, 32));
        let all = vec![true; a.texels.len()];
        let [Some(found)] = errors(&a, &b, 0.0, &[&all]).unwrap()[..] else { panic!("pixels") };
        assert!((found.relmse - relmse(&a, &b).unwrap()).abs() < 1e-12);
        assert!((found.bias - luminance_bias(&a, &b).unwrap()).abs() < 1e-12);
        assert!((found.flip - flip(&a, &b, 0.0, PIXELS_PER_DEGREE).unwrap().mean).abs() < 1e-12);
        assert!(found.flip_p99 > found.flip && found.worst > found.relmse);
        assert_eq!(errors(&a, &a, 0.0, &[&all]).unwrap(), [Some(Errors::default())]);
    }

    #[test]
    fn only_the_pixels_of_a_mask_count() {
        let a = Picture::filled(20, 10, Vec4::splat(0.5));
        let mut b = a.clone();
        b.texels[7] = Vec4::new(1.0, 1.0, 1.0, 1.0);
        let here: Vec<bool> = (0..200).map(|i| i < 100).collect();
        let there: Vec<bool> = here.iter().map(|on| !on).collect();
        let found = errors(&a, &b, 0.0, &[&here, &there, &[false; 200]]).unwrap();
        let one = 0.25 / 0.26;
        let here = found[0].unwrap();
        assert!((here.relmse - one / 100.0).abs() < 1e-8 && (here.worst - one).abs() < 1e-6, "{here:?}");
        assert!((here.bias - 0.01).abs() < 1e-6 && (here.difference - 0.01).abs() < 1e-6, "{here:?}");
        let there = found[1].unwrap();
        assert_eq!((there.relmse, there.bias, there.worst), (0.0, 0.0, 0.0));
        assert_eq!(found[2], None);
    }

    #[test]
    fn the_floor_is_the_error_that_the_mean_of_two_halves_has() {
        // Halves with independent noise around a known truth.
        let mut random = crate::math::sampling::Random::new(3);
        let truth = Picture::filled(64, 64, Vec4::new(0.5, 0.5, 0.5, 1.0));
        let mut half = || {
            let texel = |_, _| (0.5 + 0.1 * (random.point3() - 0.5)).extend(1.0);
            Picture::from_fn(64, 64, texel)
        };
        let (a, b) = (half(), half());
        let mean = Picture::from_fn(64, 64, |x, y| {
            let i = (64 * y + x) as usize;
            0.5 * (a.texels[i] + b.texels[i])
        });
        let all = vec![true; 64 * 64];
        let of = |a: &Picture, b: &Picture| errors(a, b, 0.0, &[&all]).unwrap()[0].unwrap();
        let (floor, real) = (of(&a, &b).floor_of_halves(), of(&truth, &mean));
        assert!((floor.relmse / real.relmse - 1.0).abs() < 0.05, "{floor:?} {real:?}");
        assert!((floor.worst / real.worst - 1.0).abs() < 0.2, "{floor:?} {real:?}");
        assert!((floor.difference / real.difference - 1.0).abs() < 0.05, "{floor:?} {real:?}");
    }

    #[test]
    fn the_interior_is_what_touches_nothing_else() {
        let mask: Vec<bool> = (0..25).map(|i| i % 5 < 4).collect();
        let expected: Vec<bool> = (0..25).map(|i| i % 5 < 3).collect();
        assert_eq!(interior(&mask, 5), expected);
        assert_eq!(interior(&[true; 4], 2), [true; 4]);
        assert!(interior(&[], 0).is_empty());
    }
}
