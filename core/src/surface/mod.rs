//! Surface terms, one folder each: Rust, its WGSL twin, its page, its facts.
//!
//! Directions are unit vectors in a local frame with z = n: `wo` toward the viewer, `wi` toward the light, both away
//! from the surface. `eval` is a BRDF without the cosine.

pub mod blinn_phong;
pub mod coat;
pub mod dielectric;
pub mod fresnel;
pub mod ggx;
pub mod lambert;
pub mod layered;
pub mod micro_normal;

#[cfg(test)]
mod facts;

use glam::Vec3;

use crate::leaf::Leaf;

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] = &[
    &fresnel::WGSL,
    &ggx::WGSL,
    &lambert::WGSL,
    &blinn_phong::WGSL,
    &dielectric::WGSL,
    &coat::WGSL,
    &layered::WGSL,
    &micro_normal::WGSL,
];

/// A direction drawn from a BRDF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Toward the light, local.
    pub wi: Vec3,
    /// The BRDF, without the cosine.
    pub value: Vec3,
    /// Density per steradian, positive and finite.
    pub pdf: f32,
}
