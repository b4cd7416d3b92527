//! Dielectric

use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "dielectric",
    source: include_str!("dielectric.wgsl"),
    needs: &[&crate::surface::ggx::WGSL, &crate::surface::lambert::WGSL],
    externs: "",
};
