//! GGX

use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "ggx",
    source: include_str!("ggx.wgsl"),
    needs: &[&crate::math::WGSL, &crate::surface::fresnel::WGSL],
    externs: "fn ggx_albedo_entry(index: u32) -> f32 { return 0.5; }",
};
