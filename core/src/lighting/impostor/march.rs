//! Steps along the ray, even in the angle under which the middle sees them, until one lies behind a surface.

use super::secant::between;
use super::{Distances, Effort, Found, Probe, Walk};

impl<D: Distances> Walk<'_, D> {
    /// The first place where the ray goes through a surface that the middle sees. Places where the surface jumps away from
    /// the ray, at the rim of something near, are passed; what ends without one is a miss.
    pub(super) fn march(&self, effort: &Effort) -> Found {
        let Some((from, to)) = self.span() else { return Found::MISS };
        let foot = -self.x.dot(self.r);
        let height = (self.x + foot * self.r).length().max(1e-4 * self.extent.far);
        let (first, last) = (((from - foot) / height).atan(), ((to - foot) / height).atan());
        let steps = effort.steps.max(1);
        let at = |step: u32| {
            let angle = first + (last - first) * (step as f32 / steps as f32);
            // The ends as they are: a tangent near a right angle loses digits.
            if step == steps { to } else { (foot + height * angle.tan()).clamp(from, to) }
        };
        let mut before = self.probe(from);
        let mut lookups = 1;
        for step in 1..=steps {
            let probe = self.probe(at(step));
            lookups += 1;
            if before.ratio < 1.0 && probe.ratio >= 1.0 {
                let (found, more) = self.refine(before, probe, effort.refinements);
                lookups += more;
                if (found.ratio - 1.0).abs() <= effort.tolerance {
                    return Found { t: found.t, ratio: found.ratio, lookups, is_hit: true };
                }
            }
            before = probe;
        }
        Found { lookups, ..Found::MISS }
    }

    /// The part of the ray in which surfaces may be: not nearer to the middle than the nearest, not farther than the farthest.
    pub(super) fn span(&self) -> Option<(f32, f32)> {
        let (b, length2) = (self.x.dot(self.r), self.x.length_squared());
        let root = |radius: f32| b * b - length2 + radius * radius;
        // A little beyond, so that the farthest surface has something behind it.
        let outer = root(1.001 * self.extent.far);
        if outer <= 0.0 {
            return None;
        }
        let to = outer.sqrt() - b;
        let entry = (-outer.sqrt() - b).max(0.0);
        let inner = root(0.999 * self.extent.near);
        let inside = length2 < (0.999 * self.extent.near) * (0.999 * self.extent.near);
        let from = if inside { inner.max(0.0).sqrt() - b } else { entry };
        (to > from && from.is_finite() && to.is_finite()).then_some((from, to))
    }

    /// False position between a place before the surface and one behind it that halves the ratio of an end that stays: Dowell
    /// and Jarratt 1971, A modified regula falsi method ("Illinois").
    fn refine(&self, under: Probe, over: Probe, refinements: u32) -> (Probe, u32) {
        // Weights of the ends: by how much they miss 1.
        let (mut low, mut high) = ((under.t, 1.0 - under.ratio), (over.t, over.ratio - 1.0));
        let mut best = if high.1 < low.1 { over } else { under };
        let mut side = 0;
        let mut lookups = 0;
        for _ in 0..refinements {
            let bracket = (Probe { t: low.0, ratio: 1.0 - low.1 }, Probe { t: high.0, ratio: 1.0 + high.1 });
            let probe = self.probe(between(bracket.0, bracket.1));
            lookups += 1;
            if (probe.ratio - 1.0).abs() < (best.ratio - 1.0).abs() {
                best = probe;
            }
            if probe.ratio < 1.0 {
                low = (probe.t, 1.0 - probe.ratio);
                high.1 *= if side == 1 { 0.5 } else { 1.0 };
                side = 1;
            } else {
                high = (probe.t, probe.ratio - 1.0);
                low.1 *= if side == 2 { 0.5 } else { 1.0 };
                side = 2;
            }
        }
        (best, lookups)
    }
}
