//! Lighting methods, one folder each.

pub mod classical;

use crate::leaf::Leaf;

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] = &[&classical::WGSL];
