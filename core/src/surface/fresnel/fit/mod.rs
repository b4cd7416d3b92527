//! Finding the numbers of the run-time forms, in f64, one channel at a time.
//!
//! A [`Target`] is the curve that is to be met, not clamped: the red of gold begins at 1.037. Fits with a dip make the
//! largest *relative* error over all angles least, those with an index the largest absolute one.

mod dip;
mod index;
#[cfg(test)]
mod tests;

pub use dip::{Dip, f82, f82_fitted, fitted, recipe, series};
pub use index::{F0_MAX, effective, tint};

/// Number of cosines at which curves are fitted and compared.
pub const NODES: usize = 401;

/// Cosine where the recipe takes the error of the rescaled form.
pub const RECIPE_COSINE: f64 = 0.15;

/// Cosine at which F82 and the effective index meet the curve: 81.8 degrees.
pub const F82_COSINE: f64 = 1.0 / 7.0;

/// Cosine `i` of [`NODES`]: 0 to 1, denser toward grazing, where the curves bend.
pub fn node(i: usize) -> f64 {
    let t = i as f64 / (NODES - 1) as f64;
    t * t
}

/// One channel of a reflectance curve.
#[derive(Clone, Debug)]
pub struct Target {
    /// Reflectance at each [`node`]; 1 at the first for every conductor.
    pub values: Vec<f64>,
    /// Slope dF/dx at grazing.
    pub slope: f64,
    /// Reflectance at [`RECIPE_COSINE`].
    pub at_recipe: f64,
    /// Reflectance at [`F82_COSINE`].
    pub at_f82: f64,
}

impl Target {
    /// Samples a curve with the slope that it has at grazing.
    pub fn new(slope: f64, reflectance: impl Fn(f64) -> f64) -> Target {
        Target {
            values: (0..NODES).map(|i| reflectance(node(i))).collect(),
            slope,
            at_recipe: reflectance(RECIPE_COSINE),
            at_f82: reflectance(F82_COSINE),
        }
    }

    /// Reflectance at normal incidence.
    pub fn f0(&self) -> f64 {
        self.values.last().copied().unwrap_or(1.0)
    }

    /// Schlick's curve with this F0.
    pub fn rescaled(&self, x: f64) -> f64 {
        self.f0() + (1.0 - self.f0()) * (1.0 - x).powi(5)
    }

    /// Largest relative error of another curve over all nodes.
    pub fn relative_error(&self, curve: impl Fn(f64) -> f64) -> f64 {
        let error = |(i, &f): (usize, &f64)| (curve(node(i)) - f).abs() / f.max(LEAST);
        largest(self.values.iter().enumerate().map(error))
    }

    /// Largest absolute error of another curve over all nodes.
    pub fn absolute_error(&self, curve: impl Fn(f64) -> f64) -> f64 {
        largest(self.values.iter().enumerate().map(|(i, f)| (curve(node(i)) - f).abs()))
    }
}

/// Reflectance that counts as none: below it an error is not divided by it. Only an index near 1 goes there.
pub(crate) const LEAST: f64 = 1e-6;

/// The largest, or infinity where one is not a number.
pub(crate) fn largest(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |most, e| if e.is_nan() { f64::INFINITY } else { most.max(e) })
}
