//! How far apart two pictures are, and what an evaluation costs.
//!
//! All take the reference first. relMSE and the luminance bias look at linear light, FLIP at what an observer sees on a
//! screen. Alpha is ignored: pictures are compared as they stand over black.

pub mod bench;
pub mod error_map;
mod errors;
mod flip;
mod times;
pub mod view;

pub use errors::{Errors, Mask, errors, interior, relative_square};
pub use flip::{FlipError, PIXELS_PER_DEGREE, flip};
pub use times::{evaluation_times, median};

use glam::Vec3;

use crate::color::rgb::luminance;
use crate::leaf::Leaf;
use crate::picture::Picture;

/// The WGSL twins of what is here.
pub const LEAVES: &[&Leaf] = &[&view::LEAF];

/// Keeps relMSE finite where the reference is dark; radiance squared.
pub const RELMSE_EPSILON: f64 = 0.01;

/// Why two pictures cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeasureError {
    /// They have different sizes.
    #[error(
        "the reference is {reference_width} x {reference_height} pixels and the picture {width} x {height}; \
         render both at one size"
    )]
    Size {
        /// Of the reference.
        reference_width: u32,
        /// Of the reference.
        reference_height: u32,
        /// Of the picture.
        width: u32,
        /// Of the picture.
        height: u32,
    },
    /// No pixels, or not as many as the size says.
    #[error("the {which} is {width} x {height} but has {pixels} pixels; there is nothing to compare")]
    Shape {
        /// `reference` or `picture`.
        which: &'static str,
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Pixels there are.
        pixels: usize,
    },
    /// Infinite or not a number.
    #[error("{count} pixels of the {which} are not finite, the first at column {x}, row {y}; no error can be given")]
    NotFinite {
        /// `reference` or `picture`.
        which: &'static str,
        /// How many.
        count: usize,
        /// Column of the first.
        x: u32,
        /// Row of the first, from the top.
        y: u32,
    },
    /// The reference gives off no light on average.
    #[error("the reference is black on average; a relative bias has no meaning")]
    Black,
    /// A parameter out of range.
    #[error("pixels per degree is {0}; it must be a number from 1 to 1000")]
    PixelsPerDegree(f32),
}

/// Relative mean squared error: mean of `(x - r)^2 / (r^2 + 0.01)` over linear R, G, B of all pixels. 0 or more.
pub fn relmse(reference: &Picture, picture: &Picture) -> Result<f64, MeasureError> {
    check(reference, picture)?;
    let mut sum = 0.0;
    for (r, x) in pairs(reference, picture) {
        sum += relative_square(r, x);
    }
    Ok(sum / reference.texels.len() as f64)
}

/// Difference of mean luminance relative to the reference: 0.1 is 10 % too bright.
pub fn luminance_bias(reference: &Picture, picture: &Picture) -> Result<f64, MeasureError> {
    check(reference, picture)?;
    let (mut wanted, mut found) = (0.0, 0.0);
    for (r, x) in pairs(reference, picture) {
        wanted += f64::from(luminance(r));
        found += f64::from(luminance(x));
    }
    if wanted > 0.0 { Ok((found - wanted) / wanted) } else { Err(MeasureError::Black) }
}

/// Colours at the same place.
fn pairs<'a>(reference: &'a Picture, picture: &'a Picture) -> impl Iterator<Item = (Vec3, Vec3)> + 'a {
    reference.texels.iter().zip(&picture.texels).map(|(r, x)| (r.truncate(), x.truncate()))
}

/// Both whole, finite, and of one size.
fn check(reference: &Picture, picture: &Picture) -> Result<(), MeasureError> {
    check_one("reference", reference)?;
    check_one("picture", picture)?;
    if (reference.width, reference.height) != (picture.width, picture.height) {
        return Err(MeasureError::Size {
            reference_width: reference.width,
            reference_height: reference.height,
            width: picture.width,
            height: picture.height,
        });
    }
    Ok(())
}

fn check_one(which: &'static str, picture: &Picture) -> Result<(), MeasureError> {
    let &Picture { width, height, ref texels } = picture;
    if texels.is_empty() || !picture.is_whole() {
        return Err(MeasureError::Shape { which, width, height, pixels: texels.len() });
    }
    let mut faulty = texels.iter().enumerate().filter(|(_, t)| !t.truncate().is_finite());
    match faulty.next() {
        None => Ok(()),
        Some((first, _)) => {
            let (x, y) = (first as u32 % width, first as u32 / width);
            Err(MeasureError::NotFinite { which, count: 1 + faulty.count(), x, y })
        }
    }
}

#[cfg(test)]
mod tests;
