//! Whether two renderers agree, judged by the spread of their own pictures.

use std::fmt::{self, Display, Formatter};

use glam::{DVec3, Vec3};

/// Largest distance in standard deviations that counts as agreement.
const LARGEST_Z: f64 = 3.0;

/// Batches whose scatter is this small against the mean have none: rounding.
const ROUNDING: f64 = 3e-5;

/// Mean and variance of the mean of every pixel, of pictures that are independent of each other.
#[derive(Clone, Debug, Default)]
pub struct Batches {
    count: u32,
    mean: Vec<DVec3>,
    /// Sums of squared deviations.
    deviations: Vec<DVec3>,
}

impl Batches {
    /// Adds a picture.
    pub fn add(&mut self, picture: &[Vec3]) {
        if self.count == 0 {
            self.mean = vec![DVec3::ZERO; picture.len()];
            self.deviations = self.mean.clone();
        }
        assert_eq!(picture.len(), self.mean.len());
        self.count += 1;
        for ((mean, deviations), x) in self.mean.iter_mut().zip(&mut self.deviations).zip(picture) {
            let before = x.as_dvec3() - *mean;
            *mean += before / f64::from(self.count);
            *deviations += before * (x.as_dvec3() - *mean);
        }
    }

    /// Pictures that were added.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Means of the pixels.
    pub fn mean(&self) -> &[DVec3] {
        &self.mean
    }

    /// Mean over the pixels.
    pub fn total(&self) -> DVec3 {
        self.mean.iter().sum::<DVec3>() / self.mean.len().max(1) as f64
    }

    /// Variance of the mean of a pixel.
    fn variance(&self, pixel: usize) -> DVec3 {
        let n = f64::from(self.count);
        self.deviations[pixel] / (n * (n - 1.0)).max(1.0)
    }

    /// Variance of [`Batches::total`], as if pixels were independent.
    fn total_variance(&self) -> DVec3 {
        let sum: DVec3 = (0..self.mean.len()).map(|i| self.variance(i)).sum();
        sum / (self.mean.len().max(1) as f64).powi(2)
    }
}

/// How two renderers compare.
#[derive(Clone, Copy, Debug)]
pub struct Comparison {
    /// Share of pixels and channels with |z| <= 3.
    pub within: f64,
    /// Root mean square of z where there is noise: 1 when all differences are noise.
    pub spread: f64,
    /// Largest relative difference of the means of the picture over the channels.
    pub mean: f64,
    /// Standard deviations of the two means, relative to the second, as if pixels were independent.
    pub noise: [f64; 2],
    /// Sum of the absolute differences over the sum of the second picture.
    pub absolute: f64,
}

impl Comparison {
    /// Of all pixels.
    pub fn new(a: &Batches, b: &Batches) -> Comparison {
        let (mut within, mut noisy, mut squares, mut absolute, mut all) = (0_usize, 0_usize, 0.0, 0.0, 0.0);
        for i in 0..a.mean.len() {
            for c in 0..3 {
                let (x, y) = (a.mean[i][c], b.mean[i][c]);
                let floor = ROUNDING * x.abs().max(y.abs());
                let deviation = (a.variance(i)[c] + b.variance(i)[c]).sqrt();
                let z = if x == y { 0.0 } else { (x - y) / deviation.max(floor) };
                within += usize::from(z.abs() <= LARGEST_Z);
                if deviation > floor {
                    noisy += 1;
                    squares += z * z;
                }
                absolute += (x - y).abs();
                all += y;
            }
        }
        let count = 3.0 * a.mean.len().max(1) as f64;
        let (x, y) = (a.total(), b.total());
        Comparison {
            within: within as f64 / count,
            spread: (squares / noisy.max(1) as f64).sqrt(),
            mean: ((x - y) / y).abs().max_element(),
            noise: [a, b].map(|batches| (batches.total_variance() / (y * y)).max_element().sqrt()),
            absolute: absolute / all,
        }
    }
}

impl Display for Comparison {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Comparison { within, spread, mean, noise: [ours, theirs], absolute } = self;
        write!(f, "|z| <= 3 for {:.3} %, spread of z {spread:.3}, means {:.3} % apart ", 100.0 * within, 100.0 * mean)?;
        write!(f, "(noise {:.3} and {:.3} %), pixels {:.2} %", 100.0 * ours, 100.0 * theirs, 100.0 * absolute)
    }
}
