//! Frames, unit vectors, cube maps, point sets, quadrature, special functions and statistics.

pub mod cube;
pub mod frame;
pub mod minimax;
pub mod minimize;
pub mod oct;
pub mod power;
pub mod quadrature;
pub mod sampling;
pub mod special;
pub mod statistics;

#[cfg(test)]
mod tests;

use crate::leaf::Leaf;

/// The WGSL twin of this folder.
pub static WGSL: Leaf = Leaf { name: "math", source: include_str!("math.wgsl"), needs: &[], externs: "" };

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] = &[&WGSL];

/// `x` in `[least, most]`; what is not a number becomes `least`, where `f32::clamp` would let it pass.
pub fn bounded(x: f32, least: f32, most: f32) -> f32 {
    x.max(least).min(most)
}
