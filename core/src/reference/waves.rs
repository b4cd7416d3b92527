//! What the three numbers of a path stand for: red, green and blue, or three wavelengths.
//!
//! With wavelengths, metals reflect by their n and k there, and colours become smooth spectra
//! ([`upsample`](crate::color::upsample)). The three lie a third of the way apart and all follow one path, whose
//! directions are drawn by what they have in common: Wilkie et al. 2014, Hero Wavelength Spectral Sampling. Nothing here bends
//! light by its wavelength, so their densities are the same and their weights alike.

use std::sync::LazyLock;

use glam::Vec3;

use crate::color::observer::COUNT;
use crate::color::rgb;
use crate::color::upsample;
use crate::material::preset::Preset;
use crate::surface::fresnel::Fresnel;

/// What a path carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Waves {
    /// Linear Rec.709.
    Rgb,
    /// Places of three wavelengths on the grid of the observer; radiance is that over D65.
    Three([usize; 3]),
}

/// Least share of a wavelength in the draw, over an even one.
const LEAST: f64 = 0.1;

/// How wavelengths are drawn and what they weigh.
struct Grid {
    /// Share before each, from 0 to 1.
    shares: [f64; COUNT + 1],
    /// Linear Rec.709 of unit radiance at each over the chance to draw it.
    colors: [Vec3; COUNT],
}

static GRID: LazyLock<Grid> = LazyLock::new(|| {
    let color = |i: usize| rgb::weight(i);
    let strength = |i: usize| color(i).abs().element_sum();
    let total: f64 = (0..COUNT).map(strength).sum();
    let chance = |i: usize| (1.0 - LEAST) * strength(i) / total + LEAST / COUNT as f64;
    let mut shares = [0.0; COUNT + 1];
    for i in 0..COUNT {
        shares[i + 1] = shares[i] + chance(i);
    }
    Grid { shares, colors: std::array::from_fn(|i| (color(i) / chance(i)).as_vec3()) }
});

impl Waves {
    /// Three wavelengths; `u` in [0, 1).
    pub(super) fn draw(u: f32) -> Waves {
        let place = |i: u32| {
            let x = (f64::from(u) + f64::from(i) / 3.0).fract();
            GRID.shares.partition_point(|share| *share <= x).clamp(1, COUNT) - 1
        };
        Waves::Three([place(0), place(1), place(2)])
    }

    /// A colour as the path carries it.
    pub(super) fn of_rgb(self, rgb: Vec3) -> Vec3 {
        match self {
            Waves::Rgb => rgb,
            Waves::Three(places) => Vec3::from_array(places.map(|place| upsample::at(rgb, place))),
        }
    }

    /// What was carried as a colour; its mean over paths is that of the spectrum, single ones may be negative.
    pub(super) fn to_rgb(self, carried: Vec3) -> Vec3 {
        match self {
            Waves::Rgb => carried,
            Waves::Three(places) => {
                places.iter().zip(carried.to_array()).map(|(place, value)| GRID.colors[*place] * value).sum::<Vec3>()
                    / 3.0
            }
        }
    }
}

/// A metal at every wavelength of the grid.
#[derive(Clone, Debug)]
pub(super) struct MetalWaves {
    /// n, k and the cosine-weighted mean reflectance.
    entries: Vec<[f32; 3]>,
}

impl MetalWaves {
    pub(super) fn new(metal: &Preset) -> MetalWaves {
        let entry = |i: usize| {
            let (n, k) = metal.index_at(crate::color::observer::wavelength_nm(i));
            let (n, k) = (n as f32, k as f32);
            let mean = Fresnel::Conductor { n: Vec3::splat(n), k: Vec3::splat(k) }.mean().x;
            [n, k, mean]
        };
        MetalWaves { entries: (0..COUNT).map(entry).collect() }
    }

    /// n, k and mean reflectance at every wavelength: all that paths read.
    pub(super) fn entries(&self) -> &[[f32; 3]] {
        &self.entries
    }

    /// The curves at three wavelengths and their means.
    pub(super) fn at(&self, places: [usize; 3]) -> (Fresnel, Vec3) {
        let part = |which: usize| Vec3::from_array(places.map(|place| self.entries[place][which]));
        (Fresnel::Conductor { n: part(0), k: part(1) }, part(2))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::material::preset;
    use crate::math::sampling::radical_inverse;

    #[test]
    fn colours_and_metals_come_back_as_their_colour() {
        let gold = preset::find("Au").unwrap();
        let waves = MetalWaves::new(&gold);
        let n = 1 << 14;
        let rgb = Vec3::new(0.2, 0.7, 0.4);
        let (mut color, mut metal) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..n {
            let drawn = Waves::draw(radical_inverse(i));
            let Waves::Three(places) = drawn else { panic!("wavelengths") };
            color += drawn.to_rgb(drawn.of_rgb(rgb)).as_dvec3() / f64::from(n);
            metal += drawn.to_rgb(waves.at(places).0.eval(0.7)).as_dvec3() / f64::from(n);
        }
        assert!((color - rgb.as_dvec3()).abs().max_element() < 1e-3, "{color}");
        assert!((metal - gold.unclamped(0.7)).abs().max_element() < 1e-3, "{metal} {}", gold.unclamped(0.7));
    }
}
