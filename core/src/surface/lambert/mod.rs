//! Lambert

use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "lambert",
    source: include_str!("lambert.wgsl"),
    needs: &[&crate::math::WGSL],
    externs: "",
};
