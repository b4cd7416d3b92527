//! The difference of two pictures, pixel by pixel, in colours: what the window lays over a picture.

use glam::Vec3;

use super::{MeasureError, PIXELS_PER_DEGREE, RELMSE_EPSILON, flip};
use crate::color::rgb::{luminance, srgb_from_linear};
use crate::color::tone::exposure_factor;
use crate::picture::Picture;

/// What is measured in each pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Metric {
    /// FLIP at the exposure of the view, 0 to 1.
    #[default]
    Flip,
    /// Luminance of the picture minus that of the reference, exposed: 1 is white.
    Luminance,
    /// `sqrt(mean over R, G, B of (x - r)^2 / (r^2 + 0.01))`: the mean of its square is relMSE.
    Relative,
    /// Largest difference of R, G, B as the screen shows them: exposed, clamped, sRGB-encoded, 0 to 1.
    Screen,
}

impl Metric {
    /// All of them.
    pub const ALL: [Metric; 4] = [Metric::Flip, Metric::Luminance, Metric::Relative, Metric::Screen];

    /// Short name for people.
    pub fn title(self) -> &'static str {
        match self {
            Metric::Flip => "FLIP",
            Metric::Luminance => "Luminance",
            Metric::Relative => "Relative",
            Metric::Screen => "Color",
        }
    }

    /// What its numbers are, one or two sentences.
    pub fn help(self) -> &'static str {
        match self {
            Metric::Flip => "FLIP: what an observer sees when flipping between the pictures, 0 to 1.",
            Metric::Luminance => {
                "Luminance minus that of the reference, at the exposure of the view: 1 is white. Orange is too bright, blue \
                 too dark."
            }
            Metric::Relative => {
                "Difference of the linear color divided by that of the reference (0.01 is added below the root): the mean of \
                 its square is relMSE. Exposure does not count."
            }
            Metric::Screen => "Largest difference of red, green and blue as the screen shows them, 0 to 1.",
        }
    }

    /// It has a sign.
    pub fn is_signed(self) -> bool {
        self == Metric::Luminance
    }
}

/// The difference of two pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorMap {
    /// What was measured.
    pub metric: Metric,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// One for each pixel, row 0 at the top.
    pub values: Vec<f32>,
    /// Mean over all pixels.
    pub mean: f64,
    /// The value with the last colour; with a sign also its negative. 1 for FLIP, else a round number that 95 % of the
    /// pixels do not exceed.
    pub span: f32,
}

impl ErrorMap {
    /// Measures linear pictures of one size at an exposure in stops.
    pub fn new(
        metric: Metric,
        reference: &Picture,
        picture: &Picture,
        exposure_ev: f32,
    ) -> Result<ErrorMap, MeasureError> {
        // Also refuses what no metric can be told of.
        let values = match metric {
            Metric::Flip => flip(reference, picture, exposure_ev, PIXELS_PER_DEGREE)?.map,
            _ => {
                crate::measure::relmse(reference, picture)?;
                let pairs = reference.texels.iter().zip(&picture.texels);
                let exposure = exposure_factor(exposure_ev);
                pairs.map(|(r, x)| value(metric, r.truncate(), x.truncate(), exposure)).collect()
            }
        };
        let mean = values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len().max(1) as f64;
        let span = if metric == Metric::Flip { 1.0 } else { span(&values) };
        Ok(ErrorMap { metric, width: reference.width, height: reference.height, values, mean, span })
    }

    /// The value of a pixel.
    pub fn value(&self, x: u32, y: u32) -> Option<f32> {
        let inside = x < self.width && y < self.height;
        self.values.get(y as usize * self.width as usize + x as usize).copied().filter(|_| inside)
    }

    /// The colours as sRGB bytes, row by row.
    pub fn colors(&self) -> Vec<[u8; 3]> {
        self.values.iter().map(|value| color(self.metric, value / self.span)).collect()
    }
}

fn value(metric: Metric, r: Vec3, x: Vec3, exposure: f32) -> f32 {
    let seen = |v: Vec3| srgb_from_linear((exposure * v).clamp(Vec3::ZERO, Vec3::ONE));
    match metric {
        Metric::Luminance => exposure * (luminance(x) - luminance(r)),
        Metric::Relative => ((x - r) * (x - r) / (r * r + RELMSE_EPSILON as f32)).element_sum().sqrt() / 3f32.sqrt(),
        Metric::Flip | Metric::Screen => (seen(x) - seen(r)).abs().max_element(),
    }
}

/// The first of 1, 2, 5, 10 ... times a power of ten that 95 % of the values do not exceed.
fn span(values: &[f32]) -> f32 {
    let mut sizes: Vec<f32> = values.iter().map(|v| v.abs()).collect();
    let last = sizes.len().saturating_sub(1);
    if sizes.is_empty() {
        return 1.0;
    }
    let (_, high, _) = sizes.select_nth_unstable_by(last * 95 / 100, f32::total_cmp);
    // Differences below this are rounding: equal pictures are of one colour.
    let high = high.clamp(1e-4, 1e6);
    // In f64, so that it is the f32 nearest to the round number.
    let power = 10f64.powf(f64::from(high.log10().floor()));
    let steps = [1.0, 2.0, 5.0].map(|step| (step * power) as f32);
    steps.into_iter().find(|v| *v >= high * 0.9999).unwrap_or((10.0 * power) as f32)
}

/// Where the diverging map begins, passes zero and ends: Okabe and Ito's blue and vermilion, told apart by people of any
/// colour vision, with a light grey between.
const DIVERGING: [Vec3; 3] =
    [Vec3::new(0.0, 114.0, 178.0), Vec3::new(238.0, 238.0, 238.0), Vec3::new(213.0, 94.0, 0.0)];

/// The colour of a share of the span, 0 to 1 or with a sign -1 to 1, as sRGB bytes: magma, or blue, grey, vermilion.
pub fn color(metric: Metric, share: f32) -> [u8; 3] {
    if metric.is_signed() {
        let share = if share.is_finite() { share.clamp(-1.0, 1.0) } else { 1.0 };
        let end = if share < 0.0 { DIVERGING[0] } else { DIVERGING[2] };
        return DIVERGING[1].lerp(end, share.abs()).to_array().map(|v| v.round() as u8);
    }
    let magma = nv_flip::magma_lut().to_vec();
    // A saturating cast stays within the table.
    let entry = 3 * usize::from((255.0 * share + 0.5) as u8);
    let byte = |channel: usize| magma.get(entry + channel).copied().unwrap_or_default();
    [byte(0), byte(1), byte(2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::relmse;

    fn pair() -> (Picture, Picture) {
        let reference = Picture::from_fn(40, 20, |x, _| Vec3::splat(0.1 + 0.01 * x as f32).extend(1.0));
        let picture = Picture::from_fn(40, 20, |x, y| {
            let factor = if y < 10 { 1.1 } else { 0.9 };
            Vec3::splat((0.1 + 0.01 * x as f32) * factor).extend(1.0)
        });
        (reference, picture)
    }

    #[test]
    fn the_mean_square_of_the_relative_map_is_relmse() {
        let (reference, picture) = pair();
        let map = ErrorMap::new(Metric::Relative, &reference, &picture, 3.0).unwrap();
        let mean = map.values.iter().map(|v| f64::from(v * v)).sum::<f64>() / map.values.len() as f64;
        assert!((mean / relmse(&reference, &picture).unwrap() - 1.0).abs() < 1e-4);
    }

    #[test]
    fn luminance_has_a_sign_and_follows_the_exposure() {
        let (reference, picture) = pair();
        let map = ErrorMap::new(Metric::Luminance, &reference, &picture, 1.0).unwrap();
        assert!((map.value(0, 0).unwrap() - 0.02).abs() < 1e-5 && (map.value(0, 19).unwrap() + 0.02).abs() < 1e-5);
        assert_eq!(map.value(40, 0), None);
        assert!(map.mean.abs() < 1e-6);
        assert_eq!(map.span, 0.1);
        let colors = map.colors();
        assert!(colors[0][0] > colors[0][2] && colors[799][2] > colors[799][0], "{:?} {:?}", colors[0], colors[799]);
    }

    #[test]
    fn equal_pictures_are_of_the_neutral_colour() {
        let (reference, _) = pair();
        for metric in Metric::ALL {
            let map = ErrorMap::new(metric, &reference, &reference, 0.0).unwrap();
            assert_eq!(map.mean, 0.0, "{metric:?}");
            let neutral = if metric.is_signed() { [238; 3] } else { color(metric, 0.0) };
            assert!(map.colors().iter().all(|color| *color == neutral), "{metric:?}");
        }
    }

    #[test]
    fn flip_is_the_published_one_and_pictures_of_two_sizes_are_refused() {
        let (reference, picture) = pair();
        let map = ErrorMap::new(Metric::Flip, &reference, &picture, 0.0).unwrap();
        let seen = flip(&reference, &picture, 0.0, PIXELS_PER_DEGREE).unwrap();
        assert_eq!((map.values, map.mean, map.span), (seen.map, seen.mean, 1.0));
        let small = Picture::filled(2, 2, glam::Vec4::ONE);
        assert!(Metric::ALL.iter().all(|metric| ErrorMap::new(*metric, &reference, &small, 0.0).is_err()));
    }

    #[test]
    fn a_span_is_a_round_number_that_nearly_all_values_keep_to() {
        assert_eq!(span(&[0.013; 10]), 0.02);
        assert_eq!(span(&[0.5; 10]), 0.5);
        assert_eq!(span(&[-7.0; 10]), 10.0);
        assert_eq!(span(&[0.0; 10]), 1e-4);
        assert_eq!(span(&[]), 1.0);
    }
}
