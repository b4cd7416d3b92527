//! Colour: spectra, the observer, RGB spaces and display transforms.
//!
//! The working space is linear Rec.709 with the D65 white; radiance is unbounded, reflectance lies in [0, 1]. Spectra
//! enter it through [`rgb::integrate`]; pictures leave it through [`tone::tone_map`], numbers for other programs through
//! [`space::Space`]. How different two colours look says [`difference::ciede2000`].

pub mod adaptation;
pub mod blackbody;
pub mod difference;
pub mod gamut;
pub mod illuminant;
pub mod lab;
pub mod observer;
pub mod rgb;
pub mod space;
pub mod spectrum;
pub mod tone;
pub mod upsample;

use crate::leaf::Leaf;

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] = &[&tone::LEAF];
