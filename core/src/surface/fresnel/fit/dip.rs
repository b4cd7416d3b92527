//! Fits of the forms that take a dip off Schlick's curve.

use super::super::exponents;
use super::{F82_COSINE, LEAST, RECIPE_COSINE, Target, node};
use crate::math::minimax::minimax;
use crate::math::minimize::on_interval;

/// Range of alpha that is searched: below, the dip is a straight line to the normal; above, a spike at grazing.
const ALPHA: (f64, f64) = (0.02, 120.0);

/// Points of the first search over log alpha.
const ALPHA_STARTS: usize = 80;

/// `a x (1 - x)^alpha`, what is taken off `F*`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dip {
    /// Strength; below 0 it adds.
    pub a: f64,
    /// Exponent, above 0.
    pub alpha: f64,
}

impl Dip {
    /// No dip: the rescaled form.
    pub const NONE: Dip = Dip { a: 0.0, alpha: 1.0 };

    /// Its value at a cosine.
    pub fn at(&self, x: f64) -> f64 {
        if x < 1.0 { self.a * x * (1.0 - x).powf(self.alpha) } else { 0.0 }
    }

    /// Largest relative error of `F*` less this dip.
    pub fn error(&self, target: &Target) -> f64 {
        target.relative_error(|x| target.rescaled(x) - self.at(x))
    }
}

/// a and alpha by the recipe of Lazanyi and Szirmay-Kalos 2005, Fresnel Term Approximations for Metals: a from the slope
/// at grazing, alpha from the error of the rescaled form at 0.15.
///
/// Its logarithm takes an absolute value, which hides a sign. `None` unless the dip has the sign of that error, alpha is
/// positive and the result is better than the rescaled form.
pub fn recipe(target: &Target) -> Option<Dip> {
    let a = -target.slope - 5.0 * (1.0 - target.f0());
    let missing = target.rescaled(RECIPE_COSINE) - target.at_recipe;
    let alpha = (missing / (RECIPE_COSINE * a)).abs().ln() / (1.0 - RECIPE_COSINE).ln();
    let dip = Dip { a, alpha };
    let valid = a.is_finite() && alpha.is_finite() && missing / a > 0.0 && alpha > 0.0;
    (valid && dip.error(target) < Dip::NONE.error(target)).then_some(dip)
}

/// a and alpha of the least largest relative error, F0 exact.
///
/// For an alpha the best a is a linear problem, so one search over log alpha is left. Never worse than the rescaled form
/// (a = 0) or a valid [`recipe`], whose alpha is tried too.
pub fn fitted(target: &Target) -> Dip {
    let best = |log_alpha: f64| {
        let alpha = log_alpha.exp();
        let [a] = minimax(&relative([alpha], target), &excess(target));
        let dip = Dip { a, alpha };
        (dip, dip.error(target))
    };
    let (log_alpha, _) = on_interval(ALPHA.0.ln(), ALPHA.1.ln(), ALPHA_STARTS, |log_alpha| best(log_alpha).1);
    let candidates = [Some(best(log_alpha)), recipe(target).map(|dip| best(dip.alpha.ln()))];
    let none = (Dip::NONE, Dip::NONE.error(target));
    let least = candidates.into_iter().flatten().chain([none]).min_by(|p, q| p.1.total_cmp(&q.1));
    least.unwrap_or(none).0
}

/// Coefficients of the series of two, three or four terms ([`exponents`]) with the least largest relative error.
pub fn series<const TERMS: usize>(target: &Target) -> [f64; TERMS] {
    let exponents = std::array::from_fn(|i| exponents(TERMS).get(i).map_or(1.0, |&e| f64::from(e)));
    minimax(&relative(exponents, target), &excess(target))
}

/// b of `F* - b x (1 - x)^6` through the curve's value at 1/7, and the ratio t = F(1/7) / F*(1/7) that OpenPBR stores.
/// Above 1, t cannot be stored there.
pub fn f82(target: &Target) -> (f64, f64) {
    let x = F82_COSINE;
    let rescaled = target.rescaled(x);
    ((rescaled - target.at_f82) / (x * (1.0 - x).powi(6)), target.at_f82 / rescaled)
}

/// The same with b by least squares of the error over a ball as it is seen, where a cosine x fills 2 x dx of the disc.
pub fn f82_fitted(target: &Target) -> (f64, f64) {
    let (mut product, mut square) = (0.0, 0.0);
    for (i, f) in target.values.iter().enumerate() {
        let x = node(i);
        // dx is proportional to the square root of x on these nodes.
        let weight = 2.0 * x * x.sqrt();
        let phi = x * (1.0 - x).powi(6);
        product += weight * phi * (target.rescaled(x) - f);
        square += weight * phi * phi;
    }
    let b = product / square;
    let x = F82_COSINE;
    (b, 1.0 - b * x * (1.0 - x).powi(6) / target.rescaled(x))
}

/// Values of `x (1 - x)^e / F` at the nodes.
fn relative<const M: usize>(exponents: [f64; M], target: &Target) -> Vec<[f64; M]> {
    let row = |(i, f): (usize, &f64)| {
        let x = node(i);
        // Zero at the normal for every exponent.
        exponents.map(|e| if x < 1.0 { x * (1.0 - x).powf(e) / f.max(LEAST) } else { 0.0 })
    };
    target.values.iter().enumerate().map(row).collect()
}

/// `(F* - F) / F` at the nodes: what the dip has to be.
fn excess(target: &Target) -> Vec<f64> {
    let row = |(i, f): (usize, &f64)| (target.rescaled(node(i)) - f) / f.max(LEAST);
    target.values.iter().enumerate().map(row).collect()
}
