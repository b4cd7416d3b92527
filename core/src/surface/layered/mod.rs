//! Layered

use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "layered",
    source: include_str!("layered.wgsl"),
    needs: &[&crate::surface::dielectric::WGSL, &crate::surface::coat::WGSL],
    externs: "",
};
