//! Distance impostors: where a ray meets the surroundings that a cube of distances was taken of.
//!
//! A cube holds, for every direction from its middle, how far away the surface is. What is asked of it is where the ray from
//! a point beside the middle meets that surface: the light of the surroundings is then looked up in the direction in which
//! the middle sees the same place. Solvers, their failures and figures are in `README.md`. Positions are relative to the
//! middle of the cube.

mod march;
mod method;
mod placement;
mod proxy;
pub mod pyramid;
mod secant;
mod show;
mod study;
#[cfg(test)]
mod tests;

use glam::Vec3;

use crate::leaf::Leaf;
use crate::lighting::probe::{self, DistanceCube};
use crate::math;

pub use method::{ID, Impostor, PARAMS, PATHS, RESOLUTION, effort, show, sites};
pub use placement::{Placement, place};
pub use show::{
    MOST_LOOKUPS, MOST_RATIO, SHOW_ERROR, SHOW_LIGHT, SHOW_LOOKUPS, SHOW_RATIO, Show, error_shown, heat, shown,
};
pub use study::{HitErrors, MirrorRay, hit_errors, mirror_rays};

/// The WGSL twin. The pass supplies `impostor_distance`, the radial distance of the surface in a unit direction, 0 for the sky; and for
/// the pyramid `pyramid_face`, the texels along an edge of the cube, at least 2, `pyramid_corners`, the four that a quad lies between, and
/// `pyramid_bounds`, least and greatest of a cell of a level from 1 on.
pub static WGSL: Leaf = Leaf {
    name: "impostor",
    source: concat!(include_str!("pyramid.wgsl"), include_str!("impostor.wgsl")),
    needs: &[&math::WGSL],
    externs: "fn impostor_distance(direction: vec3f) -> f32 { return 1.0; }
fn pyramid_face() -> u32 { return 2u; }
fn pyramid_corners(side: u32, x: u32, y: u32) -> vec4f { return vec4f(1.0); }
fn pyramid_bounds(level: u32, side: u32, x: u32, y: u32) -> vec2f { return vec2f(0.0, 1e30); }",
};

/// Number of [`Solver::Classical`] in shaders.
pub const CLASSICAL: u32 = 0;
/// Number of [`Solver::Sphere`].
pub const SPHERE: u32 = 1;
/// Number of [`Solver::Box`].
pub const BOX: u32 = 2;
/// Number of [`Solver::Perpendicular`].
pub const PERPENDICULAR: u32 = 3;
/// Number of [`Solver::Secant`].
pub const SECANT: u32 = 4;
/// Number of [`Solver::SecantFromPoint`].
pub const SECANT_FROM_POINT: u32 = 5;
/// Number of [`Solver::FalsePosition`].
pub const FALSE_POSITION: u32 = 6;
/// Number of [`Solver::Mixed`].
pub const MIXED: u32 = 7;
/// Number of [`Solver::March`].
pub const MARCH: u32 = 8;
/// Number of [`Solver::Pyramid`].
pub const PYRAMID: u32 = 9;

/// Differences of ratios below this say nothing about where they meet 1.
pub const EPSILON: f32 = 1e-6;

/// A way to find the place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum Solver {
    /// None: the surroundings are infinitely far away.
    Classical = CLASSICAL,
    /// A sphere stands for them.
    Sphere = SPHERE,
    /// A box stands for them, as engines do it.
    Box = BOX,
    /// One guess: the surface stands square to the ray.
    Perpendicular = PERPENDICULAR,
    /// Secant steps from there.
    #[default]
    Secant = SECANT,
    /// Secant steps from the point itself.
    SecantFromPoint = SECANT_FROM_POINT,
    /// False position from the point itself.
    FalsePosition = FALSE_POSITION,
    /// False position from the perpendicular guess.
    Mixed = MIXED,
    /// Steps along the ray until it goes through a surface, then refined.
    March = MARCH,
    /// Cell by cell of a pyramid of bounds to the first crossing of a surface, which is exact.
    Pyramid = PYRAMID,
}

impl Solver {
    /// All of them, in the order of their numbers.
    pub const ALL: [Solver; 10] = [
        Solver::Classical,
        Solver::Sphere,
        Solver::Box,
        Solver::Perpendicular,
        Solver::Secant,
        Solver::SecantFromPoint,
        Solver::FalsePosition,
        Solver::Mixed,
        Solver::March,
        Solver::Pyramid,
    ];

    /// Their names in files and on the command line.
    pub const IDS: [&'static str; 10] = {
        let mut ids = [""; 10];
        let mut i = 0;
        while i < ids.len() {
            ids[i] = Solver::ALL[i].id();
            i += 1;
        }
        ids
    };

    /// Name in files and on the command line.
    pub const fn id(self) -> &'static str {
        match self {
            Solver::Classical => "classical",
            Solver::Sphere => "sphere",
            Solver::Box => "box",
            Solver::Perpendicular => "perpendicular",
            Solver::Secant => "secant",
            Solver::SecantFromPoint => "secant-from-point",
            Solver::FalsePosition => "false-position",
            Solver::Mixed => "mixed",
            Solver::March => "march",
            Solver::Pyramid => "pyramid",
        }
    }
}

/// What is known of the surroundings as a whole, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Least distance of a surface from the middle, above 0.
    pub near: f32,
    /// Largest distance.
    pub far: f32,
    /// Radius of the sphere that stands for them.
    pub radius: f32,
    /// Corners of the box that stands for them; the middle of the cube is inside.
    pub low: Vec3,
    /// See [`Extent::low`].
    pub high: Vec3,
}

/// How a ray is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The way.
    pub solver: Solver,
    /// Refinements after the first guesses; of a place that marching found.
    pub refinements: u32,
    /// Steps of a march; [`Solver::Pyramid`] looks up four times as many at most.
    pub steps: u32,
    /// How far the ratio of [`Found`] may be from 1 for a place on a surface, above 0.
    pub tolerance: f32,
}

/// Where a ray meets the surroundings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Metres along the ray, 0 or more; 0 without a hit of the solvers that can miss.
    pub t: f32,
    /// Distance of that place from the middle over that of the surface in its direction: below 1 before the surface, above
    /// 1 behind it; 0 before the sky. Of proxies 1.
    pub ratio: f32,
    /// Distances that were looked up.
    pub lookups: u32,
    /// The place is on a surface, within the tolerance; else the direction of the ray itself is looked up.
    pub is_hit: bool,
}

impl Found {
    const MISS: Found = Found { t: 0.0, ratio: 0.0, lookups: 0, is_hit: false };

    /// Unit direction in which the middle sees what the ray from `x` in the unit direction `r` meets.
    pub fn direction(&self, x: Vec3, r: Vec3) -> Vec3 {
        if self.is_hit { (x + self.t * r).try_normalize().unwrap_or(r) } else { r }
    }
}

/// Distances of the surroundings.
pub trait Distances {
    /// Of a unit direction, metres; 0 for the sky.
    fn distance(&self, direction: Vec3) -> f32;

    /// As texels with bounds, where they are kept so: [`Solver::Pyramid`] marches without.
    fn cube(&self) -> Option<DistanceCube<'_>> {
        None
    }
}

impl<F: Fn(Vec3) -> f32> Distances for F {
    fn distance(&self, direction: Vec3) -> f32 {
        self(direction)
    }
}

impl Distances for DistanceCube<'_> {
    fn distance(&self, direction: Vec3) -> f32 {
        DistanceCube::distance(self, direction)
    }

    fn cube(&self) -> Option<DistanceCube<'_>> {
        Some(*self)
    }
}

/// A ray through the surroundings, and the place that is looked at.
#[derive(Clone, Copy, Debug)]
struct Walk<'a, D> {
    distances: &'a D,
    extent: &'a Extent,
    x: Vec3,
    r: Vec3,
}

/// A place on the ray with its ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Probe {
    t: f32,
    ratio: f32,
}

impl<D: Distances> Walk<'_, D> {
    fn probe(&self, t: f32) -> Probe {
        let p = self.x + t * self.r;
        let length = p.length();
        let distance = self.distances.distance(if length > 1e-20 { p / length } else { self.r });
        Probe { t, ratio: if distance > 0.0 { length / distance } else { 0.0 } }
    }

    /// Distance of the surface in the direction of the ray; of the farthest where there is sky.
    fn reach(&self) -> f32 {
        let distance = self.distances.distance(self.r);
        if distance > 0.0 { distance } else { self.extent.far }
    }

    /// No surface is farther along the ray: `|x + t r| <= far`.
    fn clamp(&self, t: f32) -> f32 {
        t.clamp(0.0, self.x.length() + self.extent.far)
    }
}

/// Follows the ray from `x` in the unit direction `r`. Total: whatever the distances, `t` is finite and 0 or more.
pub fn solve(distances: &impl Distances, extent: &Extent, x: Vec3, r: Vec3, effort: &Effort) -> Found {
    let walk = Walk { distances, extent, x, r };
    let judged = |(probe, lookups): (Probe, u32)| Found {
        t: probe.t,
        ratio: probe.ratio,
        lookups,
        is_hit: (probe.ratio - 1.0).abs() <= effort.tolerance,
    };
    match effort.solver {
        Solver::Classical => Found::MISS,
        Solver::Sphere => proxy::found(proxy::sphere(x, r, extent.radius)),
        Solver::Box => proxy::found(proxy::cuboid(x, r, extent.low, extent.high)),
        Solver::Perpendicular => judged((walk.probe(walk.perpendicular()), 2)),
        Solver::Secant => judged(walk.secant(walk.perpendicular(), effort.refinements)),
        Solver::SecantFromPoint => judged(walk.secant(0.0, effort.refinements)),
        Solver::FalsePosition => judged(walk.false_position(0.0, effort.refinements)),
        Solver::Mixed => judged(walk.false_position(walk.perpendicular(), effort.refinements)),
        Solver::March => walk.march(effort),
        Solver::Pyramid => match distances.cube() {
            Some(cube) => walk.pyramid(&cube, effort),
            None => walk.march(effort),
        },
    }
}

/// Follows the ray from `x`, relative to the middle of a probe, through what it sees; where that finds nothing, through its second layer. With
/// the layer that is to be looked up: 0 or 1.
pub fn follow(probe: &probe::Probe<'_>, x: Vec3, r: Vec3, effort: &Effort) -> (Found, usize) {
    let first = solve(&probe.distances, &probe.extent, x, r, effort);
    let Some(behind) = probe.behind().filter(|_| !first.is_hit) else { return (first, 0) };
    let second = solve(&behind.distances, &behind.extent, x, r, effort);
    let lookups = first.lookups + second.lookups;
    if second.is_hit { (Found { lookups, ..second }, 1) } else { (Found { lookups, ..first }, 0) }
}

/// Level of a prefiltered cube for a lobe that is seen from `t` metres away instead of from the middle: the same solid angle
/// covers less of the surface where it is near. `level + log2(t / distance)`, within the levels that there are.
pub fn level(level: f32, t: f32, distance: f32, last: f32) -> f32 {
    let shift = (t.max(1e-6) / distance.max(1e-6)).log2();
    (level + shift).clamp(0.0, last)
}
