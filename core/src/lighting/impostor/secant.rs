//! Steps toward the surface from two guesses: secant and false position.

use super::{Distances, EPSILON, Probe, Walk};

impl<D: Distances> Walk<'_, D> {
    /// Where the ray would meet a surface that stands square to it, at the distance that the middle sees in the ray's
    /// direction: `|r'| - x.r`.
    pub(super) fn perpendicular(&self) -> f32 {
        self.clamp(self.reach() - self.x.dot(self.r))
    }

    /// The guess after a first one: `d + |r'| (1 - ratio)`.
    fn second(&self, reach: f32, first: Probe) -> f32 {
        self.clamp(first.t + reach * (1.0 - first.ratio))
    }

    /// Each step goes through the last two places; exact once both lie before one plane, where the ratio is linear. It stops
    /// where the ratios differ by too little to tell. Also the number of distances looked up.
    pub(super) fn secant(&self, start: f32, refinements: u32) -> (Probe, u32) {
        let reach = self.reach();
        let mut before = self.probe(start);
        let mut last = self.probe(self.second(reach, before));
        let mut lookups = 3;
        for _ in 0..refinements {
            let (difference, missing) = (last.ratio - before.ratio, 1.0 - last.ratio);
            if !(difference.abs() > EPSILON || difference.abs() > missing.abs()) || difference == 0.0 {
                break;
            }
            let next = self.probe(self.clamp(last.t + (last.t - before.t) * missing / difference));
            (before, last) = (last, next);
            lookups += 1;
        }
        (last, lookups)
    }

    /// Each step goes through the last place before the surface and the last behind it; without one of both it goes on by
    /// the missing share of the distance. Slower than the secant, and never out of the bracket.
    pub(super) fn false_position(&self, start: f32, refinements: u32) -> (Probe, u32) {
        let reach = self.reach();
        let (mut under, mut over) = (None, None);
        let mut note = |probe: Probe| {
            *(if probe.ratio < 1.0 { &mut under } else { &mut over }) = Some(probe);
            (under, over)
        };
        let first = self.probe(start);
        note(first);
        let mut last = self.probe(self.second(reach, first));
        let mut lookups = 3;
        for _ in 0..refinements {
            let next = match note(last) {
                (Some(under), Some(over)) => between(under, over),
                _ => self.second(reach, last),
            };
            last = self.probe(self.clamp(next));
            lookups += 1;
        }
        (last, lookups)
    }
}

/// Where a straight line between a place before the surface and one behind it has the ratio 1.
pub(super) fn between(under: Probe, over: Probe) -> f32 {
    let share = (1.0 - under.ratio) / (over.ratio - under.ratio).max(1e-20);
    under.t + (over.t - under.t) * share.clamp(0.0, 1.0)
}
