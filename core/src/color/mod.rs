//! Colour: spectra, the observer, RGB spaces and display transforms.
//!
//! The working space is linear Rec.709 with the D65 white; radiance is unbounded, reflectance lies in [0, 1]. Spectra
//! enter it through [`rgb::integrate`]; pictures leave it through [`tone::tone_map`].

pub mod illuminant;
pub mod observer;
pub mod rgb;
pub mod spectrum;
pub mod tone;

use crate::leaf::Leaf;

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] = &[&tone::LEAF];
