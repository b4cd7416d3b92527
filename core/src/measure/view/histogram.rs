//! How often each brightness occurs, in stops.

use glam::Vec3;

use super::MIDDLE_GREY;
use crate::color::rgb::luminance;
use crate::color::tone::exposure_factor;
use crate::picture::Picture;

/// Stops on either side of middle grey that a histogram covers.
pub const STOPS: f32 = 12.0;

/// Counts of one quantity.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Pixels of each bin, the darkest first.
    pub bins: Vec<u64>,
    /// Pixels below the first bin: black, negative or no number as well.
    pub under: u64,
    /// Pixels above the last bin, infinite ones as well.
    pub over: u64,
}

/// Pixels by exposed linear light in stops about middle grey, from -12 to +12.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Histogram {
    /// Of luminance.
    pub luminance: Counts,
    /// Of red, green and blue.
    pub channels: [Counts; 3],
    /// Bins in a stop.
    pub per_stop: u32,
    /// Pixels in all.
    pub pixels: u64,
}

impl Counts {
    fn add(&mut self, value: f32, per_stop: u32) {
        let stops = (value / MIDDLE_GREY).log2();
        if stops >= STOPS {
            self.over += 1;
        } else if stops >= -STOPS {
            let bin = ((stops + STOPS) * per_stop as f32) as usize;
            let last = self.bins.len().saturating_sub(1);
            if let Some(count) = self.bins.get_mut(bin.min(last)) {
                *count += 1;
            }
        } else {
            // Logarithms of negative numbers are none and end here too.
            self.under += 1;
        }
    }
}

impl Histogram {
    /// Stops about middle grey at which a bin begins.
    pub fn stops(&self, bin: usize) -> f32 {
        bin as f32 / self.per_stop.max(1) as f32 - STOPS
    }

    /// The share of pixels whose luminance lies below and above all bins, 0 to 1.
    pub fn shares_outside(&self) -> (f64, f64) {
        let share = |count: u64| count as f64 / self.pixels.max(1) as f64;
        (share(self.luminance.under), share(self.luminance.over))
    }
}

/// Counts a picture with so many bins a stop, 1 to 64. Alpha is left aside.
pub fn histogram(picture: &Picture, exposure_ev: f32, per_stop: u32) -> Histogram {
    let per_stop = per_stop.clamp(1, 64);
    let empty = Counts { bins: vec![0; (2.0 * STOPS) as usize * per_stop as usize], under: 0, over: 0 };
    let mut result = Histogram {
        luminance: empty.clone(),
        channels: [empty.clone(), empty.clone(), empty],
        per_stop,
        pixels: picture.texels.len() as u64,
    };
    let factor = exposure_factor(exposure_ev);
    for texel in &picture.texels {
        let exposed: Vec3 = factor * texel.truncate();
        result.luminance.add(luminance(exposed), per_stop);
        for (counts, value) in result.channels.iter_mut().zip(exposed.to_array()) {
            counts.add(value, per_stop);
        }
    }
    result
}
