//! How much each of several probes counts at a point.

use glam::Vec3;

/// A probe fades out where another is nearer by this share of its distance.
pub const BLEND: f32 = 0.5;
/// Share of its box, from the rim inward, over which a probe fades.
pub const FADE: f32 = 0.2;

/// Where a probe stands and in which box it serves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Metres.
    pub middle: Vec3,
    /// Half the edges of its box, infinite or above 0.
    pub half: Vec3,
}

fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// 1 well inside the box, 0 at its rim and outside.
fn inside(place: &Place, position: Vec3) -> f32 {
    let share = ((position - place.middle).abs() / place.half).max_element();
    smooth((1.0 - share) / FADE)
}

/// Distance of a point from a probe, which grows without bound toward the rim of its box; infinite outside.
fn reach(place: &Place, position: Vec3) -> f32 {
    let inside = inside(place, position);
    // Not 0: the ratio of two distances is asked for.
    if inside > 0.0 { (position - place.middle).length().max(1e-6) / inside } else { f32::INFINITY }
}

/// Weights of the probes at a point: the nearest counts, and fades into those nearly as near; together as much as the point is
/// inside of any box. They change without a jump with the point.
pub fn weights(places: &[Place], position: Vec3) -> Vec<f32> {
    let reaches: Vec<f32> = places.iter().map(|place| reach(place, position)).collect();
    let nearest = reaches.iter().copied().fold(f32::INFINITY, f32::min);
    if !nearest.is_finite() {
        return vec![0.0; places.len()];
    }
    let shares: Vec<f32> = reaches.iter().map(|reach| smooth(1.0 - (reach / nearest - 1.0) / BLEND)).collect();
    let sum: f32 = shares.iter().sum();
    let covered = places.iter().map(|place| inside(place, position)).fold(0.0, f32::max);
    shares.into_iter().map(|share| covered * share / sum).collect()
}
