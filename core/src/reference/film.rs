//! What the paths of a picture add up to.

use glam::{DVec3, UVec2, Vec4};

use super::{FirstHit, PathSample};
use crate::picture::Picture;

/// Instance and material of a pixel that shows no surface.
pub const NOTHING: u32 = u32::MAX;

/// Added to squares in [`Film::error`], as in relMSE: keeps dark pixels from ruling the number.
const RELATIVE_FLOOR: f64 = 0.01;

/// Sums over the samples of every pixel, in f64.
///
/// Samples of a pixel must be added in their order; then the bytes depend on nothing else, whatever passes and threads
/// they came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    size: UVec2,
    samples: u32,
    /// Row by row from the top.
    pixels: Vec<Pixel>,
    first_rejected: Option<Rejected>,
}

/// The sums of one pixel. Samples that are not finite are counted and change nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Samples that were averaged.
    pub count: u32,
    /// Samples that were not finite.
    pub rejected: u32,
    /// Samples that met a surface.
    pub hits: u32,
    /// `Scene::instances` index of the first sample that met one, [`NOTHING`] where none did.
    pub instance: u32,
    /// `Scene::materials` index of the same sample.
    pub material: u32,
    /// Mean radiance, linear Rec.709.
    pub mean: DVec3,
    /// Sum of the squared deviations from the mean.
    pub deviations: DVec3,
    /// Sum of the shading normals; nothing is added where no surface is met.
    pub normal: DVec3,
    /// Sum of the albedos, likewise.
    pub albedo: DVec3,
    /// Sum of R, G and B that the clamp took away.
    pub clamped: f64,
}

/// A sample that was not finite: what repeats it, given scene, view and settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rejected {
    /// Number of the path.
    pub sample: u32,
    /// Pixel from the top left.
    pub pixel: UVec2,
}

impl Default for Pixel {
    fn default() -> Pixel {
        Pixel {
            count: 0,
            rejected: 0,
            hits: 0,
            instance: NOTHING,
            material: NOTHING,
            mean: DVec3::ZERO,
            deviations: DVec3::ZERO,
            normal: DVec3::ZERO,
            albedo: DVec3::ZERO,
            clamped: 0.0,
        }
    }
}

impl Pixel {
    /// Adds the next sample; false when it is not finite and was only counted.
    ///
    /// Mean and deviations by Welford 1962, Note on a Method for Calculating Corrected Sums of Squares and Products.
    pub fn add(&mut self, sample: &PathSample) -> bool {
        let PathSample { radiance, clamped, first, rays: _ } = sample;
        let surface_is_finite = first.is_none_or(|first| first.normal.is_finite() && first.albedo.is_finite());
        if !(radiance.is_finite() && clamped.is_finite() && surface_is_finite) {
            self.rejected += 1;
            return false;
        }
        self.count += 1;
        let x = radiance.as_dvec3();
        let before = x - self.mean;
        self.mean += before / f64::from(self.count);
        self.deviations += before * (x - self.mean);
        self.clamped += clamped.as_dvec3().element_sum();
        if let Some(FirstHit { normal, albedo, instance, material }) = *first {
            if self.hits == 0 {
                (self.instance, self.material) = (instance, material);
            }
            self.hits += 1;
            self.normal += normal.as_dvec3();
            self.albedo += albedo.as_dvec3();
        }
        true
    }

    /// Variance of the mean, s²/n, as if the samples were independent; zero for fewer than two.
    ///
    /// Paths are numbered by a low-discrepancy sequence, whose means vary less than that: it is an upper estimate, by
    /// how much depends on the pixel. Only pictures of different seeds show the true variance.
    pub fn variance(&self) -> DVec3 {
        let n = f64::from(self.count);
        if self.count < 2 { DVec3::ZERO } else { self.deviations / ((n - 1.0) * n) }
    }

    /// Sum over the samples as the mean over those that were averaged.
    fn averaged(&self, sum: DVec3) -> DVec3 {
        sum / f64::from(self.count.max(1))
    }

    /// Mean shading normal: shorter than 1 where a pixel shows several surfaces or the background.
    pub fn mean_normal(&self) -> DVec3 {
        self.averaged(self.normal)
    }

    /// Mean albedo, the background as black.
    pub fn mean_albedo(&self) -> DVec3 {
        self.averaged(self.albedo)
    }

    /// Share of the samples that met a surface.
    pub fn coverage(&self) -> f64 {
        f64::from(self.hits) / f64::from(self.count.max(1))
    }
}

impl Film {
    /// A film without samples.
    pub fn new(size: UVec2) -> Film {
        let pixels = vec![Pixel::default(); size.x as usize * size.y as usize];
        Film { size, samples: 0, pixels, first_rejected: None }
    }

    /// A film from what was stored of one; `None` where the parts do not fit each other.
    pub fn from_parts(size: UVec2, samples: u32, pixels: Vec<Pixel>, first_rejected: Option<Rejected>) -> Option<Film> {
        let whole = pixels.len() as u64 == u64::from(size.x) * u64::from(size.y);
        let counted = |p: &Pixel| p.count.checked_add(p.rejected) == Some(samples) && p.hits <= p.count;
        let finite = |p: &Pixel| {
            [p.mean, p.deviations, p.normal, p.albedo].iter().all(|v| v.is_finite()) && p.clamped.is_finite()
        };
        let rejected = pixels.iter().any(|p| p.rejected > 0) == first_rejected.is_some();
        let sound = whole && rejected && pixels.iter().all(|p| counted(p) && finite(p));
        sound.then_some(Film { size, samples, pixels, first_rejected })
    }

    /// Pixels across and down.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Samples of every pixel, those that were not finite included.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Row by row from the top.
    pub fn pixels(&self) -> &[Pixel] {
        &self.pixels
    }

    /// The mean, opaque: the background is part of the picture, as in the live view. Black where no sample was finite.
    pub fn picture(&self) -> Picture {
        let texel = |pixel: &Pixel| -> Vec4 { pixel.mean.as_vec3().extend(1.0) };
        Picture { width: self.size.x, height: self.size.y, texels: self.pixels.iter().map(texel).collect() }
    }

    /// Standard error of the whole picture, relative: the root of the relMSE that noise alone is expected to make,
    /// `sqrt(mean over pixels and channels of variance / (mean² + 0.01))`.
    ///
    /// The variance is that of [`Pixel::variance`], an upper estimate. Pixels with fewer than two finite samples do not
    /// count; infinite when there are no others.
    pub fn error(&self) -> f64 {
        let relative = |pixel: &Pixel| (pixel.variance() / (pixel.mean * pixel.mean + RELATIVE_FLOOR)).element_sum();
        let (mut sum, mut count) = (0.0, 0_u64);
        for pixel in self.pixels.iter().filter(|pixel| pixel.count >= 2) {
            sum += relative(pixel);
            count += 3;
        }
        if count == 0 { f64::INFINITY } else { (sum / count as f64).sqrt() }
    }

    /// Samples that were not finite.
    pub fn rejected(&self) -> u64 {
        self.pixels.iter().map(|pixel| u64::from(pixel.rejected)).sum()
    }

    /// The first of them, by number and then by row.
    pub fn first_rejected(&self) -> Option<Rejected> {
        self.first_rejected
    }

    /// Share of the light (sum of R, G and B over the picture) that the clamp took away; 0 without a clamp.
    pub fn clamped_share(&self) -> f64 {
        let kept = |pixel: &Pixel| pixel.mean.element_sum() * f64::from(pixel.count);
        let clamped: f64 = self.pixels.iter().map(|pixel| pixel.clamped).sum();
        let kept: f64 = self.pixels.iter().map(kept).sum();
        if clamped > 0.0 { clamped / (clamped + kept.max(0.0)) } else { 0.0 }
    }

    /// Takes over a whole pass: all pixels with `added` samples more.
    pub(super) fn advance(&mut self, added: u32, tiles: Vec<Tile>) {
        for Tile { corner, width, pixels, first_rejected } in tiles {
            for (row, pixels) in pixels.chunks_exact(width as usize).enumerate() {
                let start = (corner.y as usize + row) * self.size.x as usize + corner.x as usize;
                self.pixels[start..start + pixels.len()].copy_from_slice(pixels);
            }
            let order = |r: &Rejected| (r.sample, r.pixel.y, r.pixel.x);
            self.first_rejected = self.first_rejected.into_iter().chain(first_rejected).min_by_key(order);
        }
        self.samples += added;
    }
}

/// A part of the film that one thread works on.
#[derive(Clone, Debug)]
pub(super) struct Tile {
    /// Top left.
    pub corner: UVec2,
    /// Pixels across.
    pub width: u32,
    /// Row by row.
    pub pixels: Vec<Pixel>,
    /// First sample of this pass that was not finite.
    pub first_rejected: Option<Rejected>,
}

#[cfg(test)]
#[path = "film_tests.rs"]
mod tests;
