//! A lobe of GGX as cosines: one, or several along the streak of very unequal widths, which bends around the normal.

use glam::{Vec2, Vec3};

use super::cosines::Cosines;
use crate::math::frame::Frame;
use crate::surface::ggx::{Masking, clamp_alpha};

/// Parts of a streak.
pub const PARTS: u32 = 8;
/// A streak is cut where the narrow width is less than this times the square of the wide one: where it bends by more than
/// about its own width.
pub const BENDING: f32 = 1.2;
/// And less than this times the wide one.
pub const STREAK: f32 = 0.6;
/// Width of a part over its share of the slopes.
pub const PART_WIDTH: f32 = 0.8;

/// Some of the microfacets, about a normal of their own.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// About their mean normal, in the frame of the surface.
    pub frame: Frame,
    /// In that frame.
    pub lobe: Cosines,
    /// How much of them the viewer sees, up to a factor that all share.
    pub weight: f32,
}

/// Into how many parts the lobe for such widths is cut.
pub fn count(alpha: Vec2) -> u32 {
    let a = clamp_alpha(alpha);
    let (wide, narrow) = (a.max_element(), a.min_element());
    if narrow < wide * (BENDING * wide).min(STREAK) { PARTS } else { 1 }
}

/// Part `index` of the lobe toward `wo`; `None` where the viewer sees none of it.
///
/// The slope x along the wide axis has the distribution `(1 + x / sqrt(a^2 + x^2)) / 2`, so `x = a t / sqrt(1 - t^2)` for even t;
/// the slope across has the width `b / sqrt(1 - t^2)` there. About the tilted normal slopes shrink by 1 + x^2 and its root.
pub fn part(index: u32, wo: Vec3, alpha: Vec2, masking: Masking) -> Option<Part> {
    let a = clamp_alpha(alpha);
    if count(a) == 1 {
        let frame = Frame { t: Vec3::X, b: Vec3::Y, n: Vec3::Z };
        return Some(Part { frame, lobe: Cosines::new(wo, a, masking), weight: 1.0 });
    }
    let (wide, narrow) = (a.max_element(), a.min_element());
    let along = if a.x > a.y { Vec3::X } else { Vec3::Y };
    let t = (2 * index + 1) as f32 / PARTS as f32 - 1.0;
    let rest = ((1.0 - t) * (1.0 + t)).sqrt();
    let x = wide * t / rest;
    let tilt2 = 1.0 + x * x;
    let normal = along * x + Vec3::Z;
    let weight = wo.dot(normal);
    if weight <= 0.0 {
        return None;
    }
    let n = normal / tilt2.sqrt();
    let t = (along - Vec3::Z * x) / tilt2.sqrt();
    let frame = Frame { t, b: n.cross(t), n };
    let step = 2.0 / PARTS as f32 * wide / (rest * rest * rest);
    let widths = Vec2::new(PART_WIDTH * step / tilt2, narrow / (rest * tilt2.sqrt()));
    Some(Part { frame, lobe: Cosines::new(frame.to_local(wo), widths, masking), weight })
}
