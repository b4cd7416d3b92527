//! Frames, unit vectors, point sets, quadrature and statistics.

use crate::leaf::Leaf;

/// The WGSL twin of this folder.
pub static WGSL: Leaf = Leaf { name: "math", source: include_str!("math.wgsl"), needs: &[], externs: "" };

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] = &[&WGSL];
