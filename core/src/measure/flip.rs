//! FLIP: the difference that an observer sees when flipping between two pictures.

use glam::{Vec3, Vec4};

use super::{MeasureError, check};
use crate::color::rgb::{linear_from_srgb, srgb_from_linear};
use crate::color::tone::exposure_factor;
use crate::picture::Picture;

/// The observer of the published metric: a screen 0.7 m wide with 3840 pixels, seen from 0.7 m (67.02, rounded).
pub const PIXELS_PER_DEGREE: f32 = 67.0;

/// What FLIP found.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipError {
    /// Mean over all pixels, 0 (equal) to 1.
    pub mean: f64,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Error of each pixel, 0 to 1, row 0 at the top.
    pub map: Vec<f32>,
}

impl FlipError {
    /// The map in the colours of the published tool (magma: black 0, purple, orange, pale yellow 1), as display light:
    /// write it with `ToneMap::None` and exposure 0.
    pub fn picture(&self) -> Picture {
        let magma = nv_flip::magma_lut().to_vec();
        let color = |error: &f32| {
            // Saturating casts: the map is in [0, 1], and stays within the table whatever it holds.
            let entry = 3 * usize::from((255.0 * error + 0.5) as u8);
            let channel = |c: usize| f32::from(magma.get(entry + c).copied().unwrap_or_default()) / 255.0;
            linear_from_srgb(Vec3::new(channel(0), channel(1), channel(2))).extend(1.0)
        };
        Picture { width: self.width, height: self.height, texels: self.map.iter().map(color).collect::<Vec<Vec4>>() }
    }
}

/// FLIP of two linear pictures on a screen that clamps: both times `2^exposure_ev`, clamped to [0, 1], as 8-bit sRGB.
///
/// `exposure_ev` is the exposure of the scene for rendered radiance, 0 for pictures read from PNG files.
/// `pixels_per_degree` is the observer's, usually [`PIXELS_PER_DEGREE`]; 1 to 1000.
///
/// Andersson et al. 2020, FLIP: A Difference Evaluator for Alternating Images.
pub fn flip(
    reference: &Picture,
    picture: &Picture,
    exposure_ev: f32,
    pixels_per_degree: f32,
) -> Result<FlipError, MeasureError> {
    check(reference, picture)?;
    if !(1.0..=1000.0).contains(&pixels_per_degree) {
        return Err(MeasureError::PixelsPerDegree(pixels_per_degree));
    }
    let seen = |p: &Picture| nv_flip::FlipImageRgb8::with_data(p.width, p.height, &screen_bytes(p, exposure_ev));
    let map = nv_flip::flip(seen(reference), seen(picture), pixels_per_degree).to_vec();
    let mean = map.iter().map(|&e| f64::from(e)).sum::<f64>() / map.len() as f64;
    Ok(FlipError { mean, width: reference.width, height: reference.height, map })
}

/// 8-bit sRGB of exposed linear light.
fn screen_bytes(picture: &Picture, exposure_ev: f32) -> Vec<u8> {
    let factor = exposure_factor(exposure_ev);
    let encode = |t: &Vec4| srgb_from_linear(factor * t.truncate()).to_array().map(|v| (255.0 * v + 0.5) as u8);
    picture.texels.iter().flat_map(encode).collect()
}
