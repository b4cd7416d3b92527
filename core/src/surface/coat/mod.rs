//! Coat

use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "coat",
    source: include_str!("coat.wgsl"),
    needs: &[&crate::surface::dielectric::WGSL],
    externs: "",
};
