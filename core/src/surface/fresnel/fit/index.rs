//! One complex index per channel for an integrated curve.

use super::super::{REFLECTANCE_MAX, exact, gulbrandsen};
use super::{F82_COSINE, Target};
use crate::math::minimize::{nelder_mead, on_interval};

/// Largest F0 that an index is sought for; above it no index is of use.
pub const F0_MAX: f64 = 0.999;

/// Largest absolute error that the index through F(1) and F(1/7) may leave before all angles are searched.
const ENOUGH: f64 = 0.01;

/// Points of the first search over the edge tint.
const TINTS: usize = 200;

/// `(n, k)` for which the exact formula meets the curve at normal incidence and at 1/7; where that leaves more than 0.01
/// at another angle, the pair of the least largest absolute error.
///
/// Every index of reflectance F0 has an edge tint in [0, 1] ([`gulbrandsen`]), so the first part is a root in one
/// variable, and where it has several the best is taken. F0 above [`F0_MAX`] is out of reach: the curve is then met as it
/// is when held below it.
pub fn effective(target: &Target) -> (f64, f64) {
    let target = held(target);
    let r = target.f0();
    let error = |(n, k): (f64, f64)| target.absolute_error(|x| exact(n, k, x));
    let through = roots(|g| {
        let (n, k) = gulbrandsen(r, g);
        exact(n, k, F82_COSINE) - target.at_f82
    });
    let nearest = through.into_iter().map(|g| gulbrandsen(r, g)).min_by(|p, q| error(*p).total_cmp(&error(*q)));
    match nearest {
        Some(found) if error(found) <= ENOUGH => found,
        found => searched(&target, found.into_iter().chain([gulbrandsen(r, tint(&target))])),
    }
}

/// Edge tint g for which the exact formula with reflectance F0 has the least largest absolute error.
pub fn tint(target: &Target) -> f64 {
    let target = held(target);
    let error = |g: f64| {
        let (n, k) = gulbrandsen(target.f0(), g);
        target.absolute_error(|x| exact(n, k, x))
    };
    // Metals of high reflectance lie near 1, where equal steps in g are large ones in the index: steps of (1 - g)^4.
    let (t, _) = on_interval(0.0, 1.0, TINTS, |t| error(1.0 - t.powi(4)));
    1.0 - t.powi(4)
}

/// The curve within what an index can reach.
fn held(target: &Target) -> Target {
    let most = if target.f0() < F0_MAX { 1.0 } else { F0_MAX.min(REFLECTANCE_MAX) };
    let mut held = target.clone();
    held.values.iter_mut().for_each(|f| *f = f.clamp(0.0, most));
    held.at_f82 = held.at_f82.clamp(0.0, most);
    held
}

/// Where a function of the edge tint changes its sign.
fn roots(f: impl Fn(f64) -> f64) -> Vec<f64> {
    let place = |i: usize| 1.0 - (i as f64 / TINTS as f64).powi(4);
    let mut found = Vec::new();
    for i in 0..TINTS {
        let (mut a, mut b) = (place(i), place(i + 1));
        let (at_a, at_b) = (f(a), f(b));
        if at_a * at_b > 0.0 || (at_a * at_b).is_nan() {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if f(middle) * at_a > 0.0 { a = middle } else { b = middle }
        }
        found.push(0.5 * (a + b));
    }
    found
}

/// The best of simplex searches from some starts, in log n and log k.
fn searched(target: &Target, starts: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let index = |p: &[f64; 2]| (p[0].clamp(-7.0, 5.0).exp(), p[1].clamp(-7.0, 5.0).exp());
    let error = |p: &[f64; 2]| {
        let (n, k) = index(p);
        target.absolute_error(|x| exact(n, k, x))
    };
    let fixed = [(0.1, 1.0), (0.5, 3.0), (2.0, 3.0), (4.0, 1.0)];
    let starts = starts.chain(fixed).map(|(n, k)| [n.max(1e-3).ln(), k.max(1e-3).ln()]);
    let best = starts.map(|start| nelder_mead(start, 0.2, 200, error)).min_by(|p, q| p.1.total_cmp(&q.1));
    best.map_or((1.0, 1.0), |(p, _)| index(&p))
}
