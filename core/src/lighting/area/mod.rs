//! Lights with an area, rectangles and spheres of even radiance, reflected by a surface without drawing samples: linearly
//! transformed cosines over polygons.
//!
//! What the method is and where it is wrong stands in `README.md`. Everything is unshadowed; passes and the processor
//! multiply with what they find in the way. Directions and shapes are local to the frame of a lobe, relative to the point.

mod cosines;
pub mod fit;
pub mod light;
mod parts;
mod polygon;
#[cfg(test)]
mod preset_tests;
#[cfg(test)]
mod tests;

use std::f32::consts::{FRAC_1_PI, TAU};

use glam::{Vec2, Vec3};

use crate::leaf::Leaf;
use crate::math::frame::Frame;
use crate::surface::coat;
use crate::surface::fresnel::schlick;
use crate::surface::ggx::{self, Masking, albedo};
use crate::surface::layered::{self, Spread, Surface};

pub use cosines::{Cosines, NODES, NUMBERS, ROUGHNESS_MIN, STRIDE, table};
pub use parts::{BENDING, PART_WIDTH, PARTS, Part, STREAK};
pub use polygon::{CORNERS_MAX, Polygon};

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "area",
    source: concat!(include_str!("polygon.wgsl"), "\n", include_str!("area.wgsl")),
    needs: &[&layered::WGSL],
    externs: "fn area_entry(index: u32) -> f32 { return 0.5; }",
};

/// No [`Shape`], in shaders.
pub const NOTHING: u32 = 0;
/// [`Shape::Rectangle`] in shaders.
pub const RECTANGLE: u32 = 1;
/// [`Shape::Cap`] in shaders.
pub const CAP: u32 = 2;
/// [`Shape::Everywhere`] in shaders.
pub const EVERYWHERE: u32 = 3;
/// Sides of the polygon that stands for a sphere.
pub const SIDES: u32 = 12;
/// Its radius over that of the circle of equal area: `sqrt(2 pi / (n sin(2 pi / n)))`.
pub const WIDENING: f32 = 1.023_326_7;
/// Height over the horizon of the corners of the whole hemisphere; on it clips would find nothing.
pub const HORIZON: f32 = 1e-4;
/// Most by which a small light is raised over what the cosines give.
pub const RATIO_MAX: f32 = 4.0;

/// What shines, as a point sees it: relative to the point, in metres, in the axes of some frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Seen from its front.
    Rectangle {
        /// Its middle.
        center: Vec3,
        /// Half a side.
        across: Vec3,
        /// Half the other: `cross(across, up)` points away from the point.
        up: Vec3,
    },
    /// A sphere or a sun.
    Cap {
        /// Unit, to its middle.
        axis: Vec3,
        /// Sine of half the angle under which it is seen, above 0 and at most 1.
        sine: f32,
    },
    /// All directions: the point is inside of a sphere.
    Everywhere,
}

impl Shape {
    /// A rectangle whose middle is at `center` and which shines to the side of `direction` (unit), with `across` along a
    /// side (unit) and full sizes in metres; `None` from behind and without an area.
    pub fn rectangle(center: Vec3, direction: Vec3, across: Vec3, size: Vec2) -> Option<Shape> {
        let is_seen = center.dot(direction) < 0.0 && size.min_element() > 0.0;
        let up = across.cross(direction);
        is_seen.then_some(Shape::Rectangle { center, across: 0.5 * size.x * across, up: 0.5 * size.y * up })
    }

    /// A sphere; `None` without a radius.
    pub fn sphere(center: Vec3, radius: f32) -> Option<Shape> {
        let distance = center.length();
        match radius > 0.0 {
            true if distance <= radius => Some(Shape::Everywhere),
            true => Some(Shape::Cap { axis: center / distance, sine: radius / distance }),
            false => None,
        }
    }

    /// In the axes of a frame.
    pub fn local(&self, frame: &Frame) -> Shape {
        let turned = |v| frame.to_local(v);
        match *self {
            Shape::Rectangle { center, across, up } => {
                Shape::Rectangle { center: turned(center), across: turned(across), up: turned(up) }
            }
            Shape::Cap { axis, sine } => Shape::Cap { axis: turned(axis), sine },
            Shape::Everywhere => Shape::Everywhere,
        }
    }

    /// What of it is above the horizon.
    pub fn polygon(&self) -> Polygon {
        match *self {
            Shape::Rectangle { center, across, up } => {
                let [low, high] = [center - up, center + up];
                Polygon::new([low - across, low + across, high + across, high - across]).clipped()
            }
            Shape::Cap { axis, sine } => {
                let frame = Frame::new(axis);
                let cosine = ((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt();
                let corner = |i: u32| {
                    let around = Vec2::from_angle(TAU * i as f32 / SIDES as f32) * (WIDENING * sine);
                    frame.to_world(around.extend(cosine))
                };
                Polygon::new((0..SIDES).map(corner)).clipped()
            }
            Shape::Everywhere => Polygon::new([Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y].map(|d| d.extend(HORIZON))),
        }
    }
}

/// What a lobe reflects of a polygon of radiance 1.
#[derive(Clone, Copy, Debug)]
pub struct Reflected {
    /// Radiance toward the viewer for F = 1.
    pub value: f32,
    /// Cosine at the half vector of the mean direction of the light: where to take F.
    pub cos_theta: f32,
}

/// By the lobe of GGX of these widths toward `wo`, made to return the share `albedo` of even light; `facet` is the cosine at
/// the half vector and the BRDF for F = 1, toward the light.
///
/// The cosines give the share of the lobe that the polygon fills. They have not quite the shape of the lobe, so a small
/// light is multiplied by the ratio of both at its place; a light that fills the lobe needs nothing, between goes
/// `(1 - share)^2`.
pub fn reflected(
    wo: Vec3,
    alpha: Vec2,
    masking: Masking,
    polygon: &Polygon,
    albedo: f32,
    facet: impl Fn(Vec3) -> Vec2,
) -> Reflected {
    let parts = || (0..parts::count(alpha)).filter_map(|index| parts::part(index, wo, alpha, masking));
    let (mut filled, mut whole, mut toward) = (0.0, 0.0, Vec3::ZERO);
    for Part { frame, lobe, weight } in parts() {
        let local = polygon.map(|corner| frame.to_local(corner)).clipped();
        let flux = lobe.flattened(&local).flux();
        filled += weight * flux.z * FRAC_1_PI;
        whole += weight * lobe.above();
        toward += frame.to_world(lobe.shape(flux).normalize_or_zero()) * (weight * flux.z);
    }
    let share = (filled / whole.max(1e-20)).clamp(0.0, 1.0);
    let wi = above(toward);
    let density: f32 = parts().map(|part| part.weight * part.lobe.density(part.frame.to_local(wi))).sum();
    let ratio = (facet(wi).y * wi.z * whole / (albedo * density).max(1e-20)).clamp(0.0, RATIO_MAX);
    let left = (1.0 - share) * (1.0 - share);
    let cos_theta = wo.dot((wo + wi).normalize_or(Vec3::Z)).clamp(0.0, 1.0);
    Reflected { value: share * albedo * (1.0 + left * (ratio - 1.0)), cos_theta }
}

/// Unit, above the horizon by a hair at least.
fn above(v: Vec3) -> Vec3 {
    let unit = v.normalize_or(Vec3::Z);
    unit.truncate().extend(unit.z.max(1e-4)).normalize()
}

/// Radiance toward the viewer of a surface under a shape of radiance 1, unshadowed: all lobes.
///
/// `wo` and `base` are local to the base, `coat_wo` and `coat` to the coat. Without `reflections` only the matte base of
/// the dielectric is lit.
pub fn response(s: &Surface, wo: Vec3, base: &Shape, coat_wo: Vec3, coat: &Shape, reflections: bool) -> Vec3 {
    let polygon = base.polygon();
    let mut value = Vec3::ZERO;
    if !polygon.is_empty() {
        let flux = polygon.flux();
        let wi = above(flux);
        // What scatters again in a metal counts as reflection.
        let spreading = Surface { multiple_scattering: s.multiple_scattering && reflections, ..*s };
        value = Spread::new(&spreading, wo).eval(&spreading, wi) * flux.z.max(0.0);
        if reflections {
            let facet = |wi| s.lobe.facet(wo, wi, s.alpha, s.masking);
            let glossy = reflected(wo, s.alpha, s.masking, &polygon, layered::lobe_albedo(s, wo), facet);
            value += glossy.value * layered::reflectance(s, glossy.cos_theta);
        }
    }
    if s.coat <= 0.0 {
        return value;
    }
    let polygon = coat.polygon();
    let wi = above(polygon.flux());
    let widths = Vec2::splat(s.coat_alpha);
    value *= coat::transmission(coat_wo, s.coat_alpha, s.coat, s.masking)
        * coat::transmission(wi, s.coat_alpha, s.coat, s.masking);
    if polygon.is_empty() || !reflections {
        return value;
    }
    let facet = |wi| ggx::microfacet(coat_wo, wi, widths, s.masking);
    let over = reflected(coat_wo, widths, s.masking, &polygon, 1.0 - albedo::loss(coat_wo, widths, s.masking), facet);
    value + s.coat * over.value * schlick(Vec3::splat(coat::F0), 1.0, over.cos_theta)
}
