//! From cell to cell of a pyramid of bounds until the ray goes through a surface.
//!
//! Over a face of the cube a ray is a straight line, and the inverse of its depth along the axis of the face is linear on it, as
//! what is kept of the distances. Where it stays above the greatest that is kept in a cell the ray is before all surfaces
//! there, where it stays below the least behind them: the cell is passed. Else its quarters are looked at, down to single quads,
//! where the place is the root of a quadratic equation.

use glam::{UVec2, Vec2, Vec3};

use super::{Distances, Effort, Found, Walk};
use crate::lighting::probe::{Cells, DistanceCube, JUMP};
use crate::math::cube::{face_point, mirrored};

/// Most ways over faces; a straight line crosses fewer, roundings at corners may add some.
pub const WAYS: u32 = 12;
/// Most lookups for each step of a march.
pub const LOOKUPS_PER_STEP: u32 = 4;
/// Levels below the highest at which a face is entered: the highest say little.
pub const ENTRY: u32 = 3;
/// Depths below count as this.
pub const DEPTH_MIN: f32 = 1e-20;

/// Beyond every ray.
pub const FAR: f32 = 3e38;

/// A straight way over a face.
#[derive(Clone, Copy, Debug)]
struct Way {
    side: u32,
    /// Where it starts, in texels from the middle of the first, and how far it goes.
    at: Vec2,
    step: Vec2,
    /// The ray's inverse depth there, and how much it changes.
    inverse: f32,
    change: f32,
}

/// What is known of the ray on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct State {
    /// It is before the surface that the middle sees.
    is_under: bool,
    /// Its ratio at the last place that was looked at; 0 where cells were passed.
    last: f32,
    lookups: u32,
}

/// A place on a way, as a share of it, and its ratio.
type Hit = (f32, f32);

impl<D: Distances> Walk<'_, D> {
    /// The first place where the ray goes through a surface, or jumps behind one that is as near as the tolerance.
    pub(super) fn pyramid(&self, cube: &DistanceCube<'_>, effort: &Effort) -> Found {
        let Some((from, to)) = self.span() else { return Found::MISS };
        let gap = self.gap();
        let (x, r) = (mirrored(self.x), mirrored(self.r));
        let mut state = State { is_under: false, last: 0.0, lookups: 0 };
        let (mut t, mut side) = (from, face_point(x + from * r).0);
        for _ in 0..WAYS {
            let stop = if t < gap.0 { gap.0.min(to) } else { to };
            let (a, b) = (on_axes(side, x), on_axes(side, r));
            let exit = leaves(a, b).max(t);
            let end = exit.min(stop);
            if end > t {
                let way = way(cube.face(), side, a + t * b, a + end * b);
                let (hit, now) = follow(cube, &way, state, effort);
                state = now;
                if let Some((share, ratio)) = hit {
                    // Inverse depths are linear on the way, not depths.
                    let share = share * (way.inverse + way.change) / (way.inverse + share * way.change);
                    let t = t + (end - t) * share.clamp(0.0, 1.0);
                    return Found { t, ratio, lookups: state.lookups, is_hit: true };
                }
            }
            if exit < stop {
                side = next_side(side, a + exit * b, x + exit * r);
                t = exit;
            } else if stop < to && gap.1 < to {
                t = gap.1;
                side = face_point(x + t * r).0;
            } else {
                break;
            }
        }
        Found { lookups: state.lookups, ..Found::MISS }
    }

    /// From where to where the ray is nearer to the middle than anything else; empty where it never is.
    fn gap(&self) -> (f32, f32) {
        let b = self.x.dot(self.r);
        let near = 0.999 * self.extent.near;
        let inner = b * b - self.x.length_squared() + near * near;
        if inner > 0.0 { (-inner.sqrt() - b, inner.sqrt() - b) } else { (0.0, 0.0) }
    }
}

/// A vector along the two edges and the axis of a face.
fn on_axes(side: u32, d: Vec3) -> Vec3 {
    match side {
        0 => Vec3::new(-d.z, -d.y, d.x),
        1 => Vec3::new(d.z, -d.y, -d.x),
        2 => Vec3::new(d.x, d.z, d.y),
        3 => Vec3::new(d.x, -d.z, -d.y),
        4 => Vec3::new(d.x, -d.y, d.z),
        _ => Vec3::new(-d.x, -d.y, -d.z),
    }
}

/// Where a ray on the axes of a face leaves it.
fn leaves(x: Vec3, r: Vec3) -> f32 {
    let mut exit = FAR;
    for (beyond, slope) in [(x.x, r.x), (-x.x, -r.x), (x.y, r.y), (-x.y, -r.y)].map(|(x0, r0)| (x0 - x.z, r0 - r.z)) {
        if slope > 0.0 {
            exit = exit.min(-beyond / slope);
        }
    }
    exit
}

/// The face beyond an edge: `on` is the place on the axes of the face, `p` the same in the frame of the cube.
fn next_side(side: u32, on: Vec3, p: Vec3) -> u32 {
    let crosses_u = on.x.abs() >= on.y.abs();
    let (axis, sign) = match (crosses_u, side) {
        (true, 0 | 1) => (4, p.z),
        (true, _) => (0, p.x),
        (false, 2 | 3) => (4, p.z),
        (false, _) => (2, p.y),
    };
    axis + u32::from(sign < 0.0)
}

fn way(face: u32, side: u32, from: Vec3, to: Vec3) -> Way {
    let n = face as f32;
    let inverse = |on: Vec3| on.z.max(DEPTH_MIN).recip();
    let at =
        |on: Vec3| ((0.5 * inverse(on) * on.truncate() + 0.5) * n - 0.5).clamp(Vec2::splat(-0.5), Vec2::splat(n - 0.5));
    Way { side, at: at(from), step: at(to) - at(from), inverse: inverse(from), change: inverse(to) - inverse(from) }
}

/// Follows a way over a face.
fn follow(cube: &DistanceCube<'_>, way: &Way, mut state: State, effort: &Effort) -> (Option<Hit>, State) {
    let Cells { quads, top } = Cells::new(cube.face());
    let last = UVec2::splat(quads - 1);
    let quad_at = |at: Vec2| at.floor().max(Vec2::ZERO).as_uvec2().min(last);
    let (mut share, mut quad, mut level) = (0.0, quad_at(way.at), top.saturating_sub(ENTRY));
    while state.lookups < LOOKUPS_PER_STEP * effort.steps.max(1) {
        let low = (quad >> level) << level;
        let high = low + (UVec2::ONE << level);
        let exit = |from: f32, step: f32, low: u32, high: u32| match step {
            _ if step > 0.0 && high <= last.x => (high as f32 - from) / step,
            _ if step < 0.0 && low > 0 => (low as f32 - from) / step,
            _ => 2.0,
        };
        let (exit_x, exit_y) = (exit(way.at.x, way.step.x, low.x, high.x), exit(way.at.y, way.step.y, low.y, high.y));
        let end = exit_x.min(exit_y).min(1.0).max(share);
        let ray = [share, end].map(|share| way.inverse + share * way.change);
        state.lookups += 1;
        if level > 0 {
            let [least, most] = cube.bounds(level, way.side, quad.x >> level, quad.y >> level);
            let beyond = if state.is_under { 1.0 + effort.tolerance } else { 1.0 };
            if most < ray[0].min(ray[1]) {
                state = State { is_under: true, last: 0.0, ..state };
            } else if least > beyond * ray[0].max(ray[1]) {
                state = State { is_under: false, last: 0.0, ..state };
            } else {
                level -= 1;
                continue;
            }
        } else {
            let corners = cube.corners(way.side, quad.x, quad.y);
            let at = way.at + share * way.step - quad.as_vec2();
            let (hit, now) = cross(corners, at, (end - share) * way.step, ray, state, effort.tolerance);
            state = now;
            if let Some((within, ratio)) = hit {
                return (Some((share + (end - share) * within, ratio)), state);
            }
        }
        if end >= 1.0 {
            break;
        }
        let along = quad_at(way.at + end * way.step).clamp(low, high - 1);
        let over = |step: f32, low: u32, high: u32| if step > 0.0 { high } else { low.saturating_sub(1) };
        quad = if exit_x <= exit_y {
            UVec2::new(over(way.step.x, low.x, high.x), along.y)
        } else {
            UVec2::new(along.x, over(way.step.y, low.y, high.y))
        };
        share = end;
        if level < top && (quad >> (level + 1)) != (low >> (level + 1)) {
            level += 1;
        }
    }
    (None, state)
}

/// Where a piece of a ray goes through the surface over a quad, as a share of the piece. `at` and `step` are its start and length, from the
/// first corner in quads, `ray` its inverse depths at both ends.
fn cross(
    corners: [f32; 4],
    at: Vec2,
    step: Vec2,
    ray: [f32; 2],
    before: State,
    tolerance: f32,
) -> (Option<Hit>, State) {
    let [a, b, c, d] = corners;
    let least = a.min(b).min(c.min(d));
    let smooth = least > 0.0 && a.max(b).max(c.max(d)) <= JUMP * least;
    // At a jump each quarter is as far as its texel.
    let middle = |from: f32, step: f32| {
        let cut = (0.5 - from) / step;
        if !smooth && step != 0.0 && cut > 0.0 && cut < 1.0 { cut } else { 1.0 }
    };
    let cuts = (middle(at.x, step.x), middle(at.y, step.y));
    let ends = [0.0, cuts.0.min(cuts.1), cuts.0.max(cuts.1), 1.0];
    let mut state = before;
    for (low, high) in ends.into_iter().zip(ends.into_iter().skip(1)).filter(|(low, high)| high > low) {
        let surface = if smooth {
            let (u, v, twist) = (b - a, c - a, a - b - c + d);
            let linear = u * step.x + v * step.y + twist * (at.x * step.y + at.y * step.x);
            [a + u * at.x + v * at.y + twist * at.x * at.y, linear, twist * step.x * step.y]
        } else {
            let at = at + 0.5 * (low + high) * step;
            [corners[usize::from(at.x >= 0.5) + 2 * usize::from(at.y >= 0.5)], 0.0, 0.0]
        };
        let kept = |share: f32| surface[0] + (surface[1] + surface[2] * share) * share;
        let inverse = |share: f32| ray[0] + (ray[1] - ray[0]) * share;
        let is_under = |share: f32| kept(share) < inverse(share);
        let ratio = kept(low) / inverse(low);
        if state.is_under && !is_under(low) {
            if ratio - 1.0 <= tolerance {
                return (Some((low, ratio)), state);
            }
            if 1.0 - state.last <= tolerance {
                return (Some((low, state.last)), state);
            }
        }
        let root = rising_root(surface[0] - ray[0], surface[1] - (ray[1] - ray[0]), surface[2]);
        let crosses = is_under(low) && !is_under(high);
        if crosses || root.is_some_and(|root| root > low && root < high) {
            let share = root.unwrap_or(high).clamp(low, high);
            return (Some((share, kept(share) / inverse(share))), state);
        }
        state = State { is_under: is_under(high), last: kept(high) / inverse(high), ..state };
    }
    (None, state)
}

/// Where `c + b s + a s^2` rises through 0.
fn rising_root(c: f32, b: f32, a: f32) -> Option<f32> {
    let root = b * b - 4.0 * a * c;
    let (over, under) =
        if b > 0.0 { (-2.0 * c, b + root.max(0.0).sqrt()) } else { (root.max(0.0).sqrt() - b, 2.0 * a) };
    (root >= 0.0 && under.abs() > DEPTH_MIN).then(|| over / under)
}

#[cfg(test)]
#[path = "pyramid_tests.rs"]
mod tests;
