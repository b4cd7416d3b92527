//! Blurred backgrounds: a map convolved on the sphere, small enough to be made while a slider is dragged.

use std::f64::consts::{PI, TAU};

use glam::Vec3;
use rayon::prelude::*;

use crate::scene::Environment;

/// Largest blur, degrees.
pub const BLUR_MAX_DEG: f64 = 90.0;
/// Rows of the largest blurred map; twice as many columns.
const ROWS_MAX: u32 = 256;
/// Fewest rows: bilinear lookups between fewer would be seen.
const ROWS_MIN: u32 = 16;
/// Texels per standard deviation of the lobe; a bilinear lookup of a lobe so sampled is within 1 % of it.
const TEXELS_PER_DEVIATION: f64 = 3.0;
/// The lobe is cut off where it is exp(-this) of its peak.
const CUT: f64 = 9.0;

/// A map blurred by a von Mises-Fisher lobe that falls to a half at `half_width_deg` from its middle, in (0, 90]; 512x256
/// texels at most, turned and scaled as the original. A map whose texels are wider than the blur stays nearly as sharp as
/// its texels.
///
/// Weight of a direction at the angle `g`: `exp(kappa (cos g - 1))`, `kappa = ln 2 / (1 - cos half_width)`.
pub fn blurred(map: &Environment, half_width_deg: f64) -> Environment {
    let half_width = half_width_deg.clamp(0.01, BLUR_MAX_DEG).to_radians();
    let kappa = std::f64::consts::LN_2 / (1.0 - half_width.cos());
    let rows = (PI * kappa.sqrt() * TEXELS_PER_DEVIATION).ceil().min(f64::from(ROWS_MAX)) as u32;
    let small = resized(map, 2 * rows.max(ROWS_MIN), rows.max(ROWS_MIN));
    let texels = Lobe::new(kappa, small.width as usize, small.height as usize).convolve(&small.texels);
    Environment { name: format!("{} blurred", map.name), texels: texels.into(), ..small }
}

/// Means over the solid angle of larger (or copies for smaller) texels.
pub fn resized(map: &Environment, width: u32, height: u32) -> Environment {
    let (w, h) = (map.width.max(1) as usize, map.height.max(1) as usize);
    let source = |x: usize, y: usize| map.texels.get(y * w + x).copied().unwrap_or(Vec3::ZERO);
    let columns: Vec<Vec<(usize, f64)>> = (0..width as usize).map(|x| overlaps(x, width as usize, w)).collect();
    let mut texels = vec![Vec3::ZERO; (width * height) as usize];
    texels.par_chunks_exact_mut(width as usize).enumerate().for_each(|(y, row)| {
        let edge = |at: f64| (PI * at / h as f64).cos();
        let (mut mean, mut whole) = (vec![Vec3::ZERO; w], 0.0);
        for (from, _) in overlaps(y, height as usize, h) {
            let scale = h as f64 / f64::from(height);
            let top = (y as f64 * scale).max(from as f64);
            let bottom = ((y + 1) as f64 * scale).min((from + 1) as f64);
            let weight = edge(top) - edge(bottom);
            whole += weight;
            mean.iter_mut().enumerate().for_each(|(x, sum)| *sum += weight as f32 * source(x, from));
        }
        for (texel, over) in row.iter_mut().zip(&columns) {
            let sum: Vec3 = over.iter().map(|&(x, share)| share as f32 * mean[x]).sum();
            *texel = sum / whole as f32;
        }
    });
    Environment { width, height, texels: texels.into(), ..map.clone() }
}

/// Which of `from` intervals the interval `place` of `to` covers, and with which share of itself.
fn overlaps(place: usize, to: usize, from: usize) -> Vec<(usize, f64)> {
    let scale = from as f64 / to as f64;
    let (start, end) = (place as f64 * scale, (place + 1) as f64 * scale);
    let last = (end.ceil() as usize).min(from);
    let share = |i: usize| (end.min((i + 1) as f64) - start.max(i as f64)) / scale;
    (start as usize..last).map(|i| (i, share(i))).filter(|(_, share)| *share > 0.0).collect()
}

/// A lobe over a grid of rows and columns.
struct Lobe {
    kappa: f64,
    width: usize,
    height: usize,
}

impl Lobe {
    fn new(kappa: f64, width: usize, height: usize) -> Lobe {
        Lobe { kappa, width, height }
    }

    fn convolve(&self, texels: &[Vec3]) -> Vec<Vec3> {
        let mut result = vec![Vec3::ZERO; texels.len()];
        result.par_chunks_exact_mut(self.width).enumerate().for_each(|(y, row)| self.row(y, texels, row));
        result
    }

    fn row(&self, y: usize, texels: &[Vec3], row: &mut [Vec3]) {
        let (w, mut whole) = (self.width, 0.0);
        for (from, weights) in self.weights(y) {
            let source = &texels[from * w..(from + 1) * w];
            // Weights are those of the columns 0, 1 ... to both sides.
            let middle = weights[0];
            whole += f64::from(middle);
            row.iter_mut().zip(source).for_each(|(sum, texel)| *sum += middle * *texel);
            for (step, &weight) in weights.iter().enumerate().skip(1) {
                // Half way around both sides are one column.
                let both = 2 * step != w;
                whole += f64::from(weight) * if both { 2.0 } else { 1.0 };
                for (x, sum) in row.iter_mut().enumerate() {
                    let right = if x + step < w { x + step } else { x + step - w };
                    *sum += weight * source[right];
                    if both {
                        let left = if x >= step { x - step } else { x + w - step };
                        *sum += weight * source[left];
                    }
                }
            }
        }
        row.iter_mut().for_each(|sum| *sum /= whole as f32);
    }

    /// For each row within reach of row `y` the weights by distance in columns, solid angle included.
    fn weights(&self, y: usize) -> Vec<(usize, Vec<f32>)> {
        let polar = |y: usize| (PI * (y as f64 + 0.5) / self.height as f64).sin_cos();
        let (sin, cos) = polar(y);
        let reached = |from: usize| {
            let (sin_from, cos_from) = polar(from);
            let weight = |step: usize| {
                let turn = (TAU * step as f64 / self.width as f64).cos();
                let exponent = self.kappa * (1.0 - (cos * cos_from + sin * sin_from * turn));
                (exponent < CUT).then(|| (sin_from * (-exponent).exp()) as f32)
            };
            let weights: Vec<f32> = (0..=self.width / 2).map_while(weight).collect();
            (!weights.is_empty()).then_some((from, weights))
        };
        (0..self.height).filter_map(reached).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;

    fn mean(map: &Environment) -> glam::DVec3 {
        let w = map.width as usize;
        let texel = |i: usize| map.texels[i].as_dvec3() * map.texel_solid_angle((i / w) as u32);
        (0..map.texels.len()).map(texel).sum::<glam::DVec3>() / (4.0 * PI)
    }

    fn point(width: u32, x: u32, y: u32) -> Environment {
        let mut texels = vec![Vec3::ZERO; (width * width / 2) as usize];
        texels[(y * width + x) as usize] = Vec3::new(1e5, 2e5, 3e5);
        Environment::new("point", width, width / 2, texels)
    }

    #[test]
    fn a_map_of_one_colour_stays_and_keeps_its_rotation_and_tint() {
        let even = Environment::new("even", 8, 4, vec![Vec3::new(1.0, 2.0, 3.0); 32]);
        let even = Environment { rotation: 0.3, strength: 2.0, tint: Vec3::new(1.0, 0.5, 0.25), ..even };
        for width in [0.5, 5.0, 60.0] {
            let soft = blurred(&even, width);
            assert!(soft.texels.iter().all(|t| (*t - Vec3::new(1.0, 2.0, 3.0)).length() < 1e-4), "{width}");
            assert_eq!((soft.rotation, soft.strength, soft.tint), (even.rotation, even.strength, even.tint));
            assert!(soft.width <= 512 && soft.height <= 256);
        }
    }

    #[test]
    fn a_point_becomes_a_round_lobe_of_the_asked_width_wherever_it_is() {
        for y in [0, 3, 40, 128] {
            let map = point(512, 100, y);
            let soft = blurred(&map, 8.0);
            let middle = map.texel_direction(100, y, Vec2::splat(0.5));
            let (side, up) = middle.any_orthonormal_pair();
            let at = |angle: f32, about: f32| {
                let away = about.cos() * side + about.sin() * up;
                soft.radiance(angle.cos() * middle + angle.sin() * away).x
            };
            let peak = soft.radiance(middle).x;
            for turn in 0..8 {
                let half = at(8f32.to_radians(), turn as f32) / peak;
                // Means over texels move a point by up to half a texel, a sixth of a deviation.
                assert!((half - 0.5).abs() < 0.08, "row {y}, {turn}: {half}");
            }
        }
    }

    #[test]
    fn no_light_is_lost() {
        for (x, y) in [(0, 0), (511, 127), (200, 60)] {
            let map = point(512, x, y);
            for width in [1.0, 4.0, 20.0, 90.0] {
                let ratio = mean(&blurred(&map, width)).x / mean(&map).x;
                // Each texel is normalised by itself, so the sum depends on how evenly rows lie; worst beside the pole.
                assert!((ratio - 1.0).abs() < 0.02, "{x} {y} at {width}: {ratio}");
            }
        }
    }

    #[test]
    fn other_shapes_than_two_to_one_and_single_texels_are_blurred_too() {
        let one = blurred(&Environment::new("one", 1, 1, vec![Vec3::ONE]), 10.0);
        assert!(one.texels.iter().all(|t| (*t - Vec3::ONE).length() < 1e-4));
        let odd = blurred(&Environment::new("odd", 3, 7, (0..21).map(|i| Vec3::splat(i as f32)).collect()), 3.0);
        assert!(odd.texels.iter().all(|t| t.is_finite() && t.max_element() <= 20.001));
    }
}
