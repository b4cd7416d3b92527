//! Surface terms, one folder each: Rust, its WGSL twin, its page, its facts.

pub mod coat;
pub mod dielectric;
pub mod fresnel;
pub mod ggx;
pub mod lambert;
pub mod layered;

use crate::leaf::Leaf;

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] =
    &[&fresnel::WGSL, &ggx::WGSL, &lambert::WGSL, &dielectric::WGSL, &coat::WGSL, &layered::WGSL];
