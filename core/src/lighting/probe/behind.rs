//! The second layer of what a probe records: surfaces behind those that it sees.

use glam::Vec3;
use rayon::prelude::*;

use super::DistanceCube;
use crate::job::Handle;
use crate::reference::{Sighted, World};

/// Most surfaces that a ray goes through.
const MOST_SURFACES: u32 = 16;
/// Share of its distance by which a ray starts behind a surface that it went through.
const LIFT: f32 = 1e-4;

/// A surface behind the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Behind {
    /// Metres to a place from which nothing is before the surface.
    pub from: f32,
    /// Metres to the surface.
    pub to: f32,
}

/// The next surface behind the first one that a ray from `origin` in the unit `direction` meets. What closes a body that the ray went into is none:
/// light that leaves it goes away from the probe, and what is behind the body is of more use.
pub fn behind(world: &World, origin: Vec3, direction: Vec3) -> Option<Behind> {
    let mut last = world.sighted(origin, direction)?;
    let mut reached = last.distance;
    for _ in 1..MOST_SURFACES {
        let from = reached * (1.0 + LIFT);
        let met = world.sighted(origin + from * direction, direction)?;
        reached = from + met.distance;
        if !closes(&last, &met) {
            return reached.is_finite().then_some(Behind { from, to: reached });
        }
        last = met;
    }
    None
}

/// The second surface is the other side of the body to which the first belongs, or the inside of one.
fn closes(first: &Sighted, second: &Sighted) -> bool {
    second.from_behind && (!second.two_sided || second.instance == first.instance)
}

/// What is kept of the distances of the second layer, as of the first: 0 where there is none, and of a job that is cancelled.
pub fn distances(world: &World, middle: Vec3, face: u32, job: &Handle) -> Vec<f32> {
    let texel = |i: u32| {
        if job.is_cancelled() {
            return 0.0;
        }
        let (side, y, x) = (i / (face * face), i / face % face, i % face);
        let met = behind(world, middle, DistanceCube::direction(face, side, x, y));
        DistanceCube::kept(face, x, y, met.map(|met| met.to))
    };
    (0..6 * face * face).into_par_iter().map(texel).collect()
}
