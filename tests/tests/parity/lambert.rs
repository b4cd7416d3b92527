//! The matte surface.

use burnish_core::surface::lambert;
use glam::Vec4;

use crate::grid::v4;
use crate::harness::Case;

pub fn cases() -> Vec<Case> {
    let albedos = || (0..=20).map(|i| i as f32 / 20.0).map(|a| [Vec4::new(a, 1.0 - a, a * a, 0.0)]).collect();
    vec![Case::new(
        "lambert: albedo over pi",
        &lambert::WGSL,
        "y[0] = vec4f(lambert_eval(x[0].xyz), 0.0);",
        albedos,
        |x| [v4(lambert::eval(x[0].truncate()), 0.0)],
    )]
}
