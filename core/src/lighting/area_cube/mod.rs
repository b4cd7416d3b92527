//! Localised glossy and diffuse lighting: the few texels of a coarse cube with distances are lights with an area.
//!
//! Every texel of M x M on a face is a disk of mean radiance at the mean distance that the middle of the cube sees there. A
//! point beside the middle sees it in another direction and under another solid angle ([`localised`]); what a surface reflects
//! of such a cap is looked up in tables ([`tables`]). Equations, failures and figures are in `README.md`. Positions are relative
//! to the middle of the cube.

mod few;
mod gather;
mod method;
pub mod tables;
#[cfg(test)]
mod tests;
mod texels;

use std::f32::consts::TAU;

use glam::Vec3;

use crate::leaf::Leaf;
use crate::lighting::classical;

pub use few::{NEIGHBOURS, neighbour, texel_at};
pub use gather::{Asked, Gathered, HORIZON, LEAST, Lobe, Looked, glossy, reflected, sums};
pub use method::{ARRAY, AreaCube, ID, PARAMS, asked, edge};
pub use texels::{COS_MIN, EDGES, NUMBERS, Texel, Texels, downsample, solid_angle};

/// The WGSL twin. The pass supplies `area_cube_entry`, the numbers of [`tables::flat`], and `area_cube_texel`, the numbers of a
/// texel of the cube that is looked at.
pub static WGSL: Leaf = Leaf {
    name: "area_cube",
    source: include_str!("area_cube.wgsl"),
    needs: &[&classical::WGSL],
    externs: "
fn area_cube_entry(index: u32) -> f32 { return 0.5; }
fn area_cube_texel(index: u32) -> mat3x4f {
    return mat3x4f(vec4f(0.0, 1.0, 0.0, 0.1), vec4f(0.0, -1.0, 0.0, 0.9), vec4f(1.0));
}
",
};

/// Squared distances from which a direction can still be told.
pub const NEAR: f32 = 1e-30;
/// Beyond this the tangent of a cap is as good as infinite; its square is still a number.
pub const WIDEST: f32 = 1e30;

/// A texel as a point sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    /// Unit, to its middle.
    pub direction: Vec3,
    /// Its solid angle over that of a hemisphere, in [0, 1].
    pub share: f32,
}

impl Cap {
    /// Steradians.
    pub fn solid_angle(&self) -> f32 {
        TAU * self.share
    }
}

/// What of a hemisphere a disk fills that is seen under the cosine `cosine` of half its angle when the square of its tangent is
/// multiplied: `spread` is `sin^2` of that angle times the factor. `1 - c / sqrt(c^2 + spread)`, without its cancellation.
fn filled(cosine: f32, spread: f32) -> f32 {
    let t = spread.min(WIDEST);
    let d = (cosine * cosine + t).sqrt();
    (t / (d * (d + cosine)).max(1e-30)).min(1.0)
}

/// Solid angle, from `to` metres away, of what fills `solid_angle` steradians from `from` metres away and stands square to
/// both: `2 pi (1 - 1 / sqrt(1 + ((2 pi / (2 pi - w))^2 - 1) r^2 / r*^2))`. Total: in [0, 2 pi] whatever the numbers are.
///
/// Lazanyi (dissertation), section 5.2.4.
pub fn localised_solid_angle(solid_angle: f32, from: f32, to: f32) -> f32 {
    let w = (solid_angle / TAU).clamp(0.0, 1.0);
    if !(w > 0.0 && from > 0.0) {
        return 0.0;
    }
    let ratio = (from / to.max(0.0)).min(1e15);
    TAU * filled(1.0 - w, w * (2.0 - w) * ratio * ratio)
}

/// A texel as the point `x` sees it. Light of the sky comes from infinitely far: its direction and solid angle stay.
///
/// `corrected`: `r^2 / r*^2` is multiplied by `max(0, cos theta*) / cos theta`, the cosines at the surface toward the point and
/// toward the middle.
pub fn localised(texel: &Texel, x: Vec3, corrected: bool) -> Cap {
    if texel.spread <= 0.0 {
        return Cap { direction: texel.place, share: 1.0 - texel.cosine };
    }
    let v = texel.place - x;
    let length2 = v.length_squared();
    if length2 <= NEAR {
        return Cap { direction: -texel.normal.normalize_or(Vec3::Y), share: 1.0 };
    }
    let inverse = 1.0 / length2.sqrt();
    let direction = v * inverse;
    let turned = if corrected { (-texel.normal.dot(direction)).max(0.0) } else { 1.0 };
    Cap { direction, share: filled(texel.cosine, texel.spread * turned * inverse * inverse) }
}
