//! Drawing directions toward the bright parts of an environment map.
//!
//! The map is bilinear between texel centres ([`Environment::radiance`]), so the density is laid over the cells between
//! four centres and is bilinear in them as well: where the map is not black, it is not zero.

use std::f32::consts::TAU;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::scene::Environment;

/// A direction toward the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkySample {
    /// Unit, world.
    pub direction: Vec3,
    /// Density per steradian, above 0.
    pub pdf: f32,
    /// From there, strength included.
    pub radiance: Vec3,
}

/// An environment with the density by which it is sampled.
///
/// What is below the mean radiance is left to the sampling of the BRDF (Karlik et al. 2019, MIS Compensation). A map of one colour therefore has no density at all; see [`Sky::is_sampled`].
#[derive(Clone, Debug)]
pub struct Sky {
    map: Arc<Environment>,
    tables: Arc<Tables>,
}

/// What depends on the texels alone.
#[derive(Debug)]
struct Tables {
    width: usize,
    height: usize,
    /// Weight of texel centres in the density, row by row.
    weights: Vec<f32>,
    /// Share of the rows of cells before each, from 0 to 1; one more than there are rows.
    rows: Vec<f64>,
    /// For each row the share of its cells before each, from 0 to 1; one more than there are columns.
    columns: Vec<f32>,
    /// Cosine of the polar angle at which rows of cells begin; one more than there are rows.
    edges: Vec<f64>,
    /// Mean radiance over the sphere, without strength.
    mean: Vec3,
    /// Irradiance on a plane that faces up, without strength.
    up: Vec3,
}

impl Sky {
    /// Memory of its tables; the map is the scene's.
    pub fn bytes(&self) -> usize {
        let Tables { weights, rows, columns, edges, .. } = &*self.tables;
        size_of_val(&weights[..]) + size_of_val(&rows[..]) + size_of_val(&columns[..]) + size_of_val(&edges[..])
    }

    /// Makes a map ready.
    pub fn new(map: &Arc<Environment>) -> Sky {
        Sky { map: map.clone(), tables: Arc::new(Tables::new(map)) }
    }

    /// Makes another map ready; one with the same texels shares the tables.
    pub fn updated(&self, map: &Arc<Environment>) -> Sky {
        if !Arc::ptr_eq(&self.map.texels, &map.texels) {
            return Sky::new(map);
        }
        Sky { map: map.clone(), tables: self.tables.clone() }
    }

    /// False where sampling would bring nothing: black maps and maps of one colour.
    pub fn is_sampled(&self) -> bool {
        self.tables.rows.last().is_some_and(|last| *last > 0.0)
    }

    /// Mean radiance over the sphere, strength included.
    pub fn mean(&self) -> Vec3 {
        self.map.scale() * self.tables.mean
    }

    /// Irradiance on a plane that faces up and sees all of it, strength included.
    pub fn up(&self) -> Vec3 {
        self.map.scale() * self.tables.up
    }

    /// Radiance from a world direction, strength included.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        self.map.radiance(direction)
    }

    /// Density of [`Sky::sample`] per steradian; 0 where the map is not sampled.
    #[cfg(test)]
    fn pdf(&self, direction: Vec3) -> f32 {
        self.look(direction).1
    }

    /// [`Sky::radiance`] from a direction, and the density of [`Sky::sample`] per steradian, 0 where the map is not sampled.
    pub fn look(&self, direction: Vec3) -> (Vec3, f32) {
        let uv = self.map.uv_from_direction(direction);
        let radiance = self.map.radiance_at(uv);
        if !self.is_sampled() {
            return (radiance, 0.0);
        }
        let Tables { width, height, edges, .. } = &*self.tables;
        let (w, h) = (*width, *height);
        let x = uv.x * w as f32 - 0.5;
        let i = (x.floor() as i64).rem_euclid(w as i64) as usize;
        let j = ((uv.y * h as f32 + 0.5) as usize).min(h);
        let t = (edges[j] - f64::from(direction.y)) / (edges[j] - edges[j + 1]);
        (radiance, self.tables.cell_pdf(i, j, Vec2::new(x - x.floor(), t.clamp(0.0, 1.0) as f32)))
    }

    /// A direction; `u` in `[0, 1)^2`. `None` where the map is not sampled.
    pub fn sample(&self, u: Vec2) -> Option<SkySample> {
        if !self.is_sampled() {
            return None;
        }
        let Tables { width, height, rows, columns, edges, .. } = &*self.tables;
        let (w, h) = (*width, *height);
        let y = f64::from(u.y);
        let j = (rows.partition_point(|share| *share <= y)).clamp(1, h + 1) - 1;
        let height = rows[j + 1] - rows[j];
        let row = &columns[j * (w + 1)..(j + 1) * (w + 1)];
        let i = row.partition_point(|share| *share <= u.x).clamp(1, w) - 1;
        let width = row[i + 1] - row[i];
        if height <= 0.0 || width <= 0.0 {
            return None;
        }
        let inside = Vec2::new((u.x - row[i]) / width, ((y - rows[j]) / height) as f32);
        let [a, b, c, d] = self.tables.corners(i, j);
        let t = linear(a + b, c + d, inside.y);
        let s = linear(lerp(a, c, t), lerp(b, d, t), inside.x);
        let pdf = self.tables.cell_pdf(i, j, Vec2::new(s, t));
        let cos_theta = edges[j] + (edges[j + 1] - edges[j]) * f64::from(t);
        let column = i as f32 + 0.5 + s;
        let direction = self.direction(column, cos_theta);
        let v = cos_theta.acos() * std::f64::consts::FRAC_1_PI;
        let radiance = self.map.radiance_at(Vec2::new(column / w as f32, v as f32));
        (pdf > 0.0 && pdf.is_finite()).then_some(SkySample { direction, pdf, radiance })
    }

    /// World direction of a column (in texels) and a cosine of the polar angle.
    fn direction(&self, column: f32, cos_theta: f64) -> Vec3 {
        let phi = (column / self.map.width as f32 - 0.5) * TAU - self.map.rotation;
        let (sin_phi, cos_phi) = phi.sin_cos();
        let sin_theta = ((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt() as f32;
        Vec3::new(sin_theta * sin_phi, cos_theta as f32, -sin_theta * cos_phi)
    }
}

impl Tables {
    fn new(map: &Environment) -> Tables {
        let (w, h) = (map.width as usize, map.height as usize);
        let mean = mean_radiance(map);
        let least = brightness(mean);
        let weight = |texel: &Vec3| {
            let value = brightness(*texel) - least;
            // Rounding of the mean must not make a density out of nothing.
            if value > 1e-4 * least { value } else { 0.0 }
        };
        let mut tables = Tables {
            width: w,
            height: h,
            weights: map.texels.iter().take(w * h).map(weight).collect(),
            rows: vec![0.0],
            columns: Vec::with_capacity((h + 1) * (w + 1)),
            edges: (0..=h + 1).map(|j| edge(j, h)).collect(),
            mean,
            up: Environment { strength: 1.0, tint: Vec3::ONE, ..map.clone() }.irradiance_up(),
        };
        tables.weights.resize(w * h, 0.0);
        let mut total = 0.0;
        for j in 0..=h {
            total += tables.push_row(j) * (tables.edges[j] - tables.edges[j + 1]);
            tables.rows.push(total);
        }
        if total > 0.0 {
            tables.rows.iter_mut().for_each(|share| *share /= total);
        }
        tables
    }

    /// Appends the cells of a row; returns their sum.
    fn push_row(&mut self, j: usize) -> f64 {
        let w = self.width;
        let mut sums = Vec::with_capacity(w + 1);
        let mut sum = 0.0;
        sums.push(sum);
        for i in 0..w {
            sum += self.corners(i, j).iter().map(|c| f64::from(*c)).sum::<f64>();
            sums.push(sum);
        }
        let scale = if sum > 0.0 { 1.0 / sum } else { 0.0 };
        self.columns.extend(sums.iter().map(|s| (s * scale) as f32));
        sum
    }

    /// Weights at the corners of a cell: upper left, upper right, lower left, lower right.
    fn corners(&self, i: usize, j: usize) -> [f32; 4] {
        let (w, h) = (self.width, self.height);
        let (left, right) = (i, if i + 1 == w { 0 } else { i + 1 });
        let (above, below) = (j.saturating_sub(1) * w, j.min(h - 1) * w);
        [above + left, above + right, below + left, below + right].map(|at| self.weights[at])
    }

    /// Density at a point of a cell.
    fn cell_pdf(&self, i: usize, j: usize, at: Vec2) -> f32 {
        let w = self.width;
        let first = j * (w + 1) + i;
        let share = (self.rows[j + 1] - self.rows[j]) as f32 * (self.columns[first + 1] - self.columns[first]);
        let [a, b, c, d] = self.corners(i, j);
        let sum = a + b + c + d;
        if sum <= 0.0 {
            return 0.0;
        }
        let value = lerp(lerp(a, b, at.x), lerp(c, d, at.x), at.y);
        let solid_angle = (self.edges[j] - self.edges[j + 1]) as f32 * TAU / w as f32;
        share * 4.0 * value / (sum * solid_angle)
    }
}

/// What the density follows: no channel's noise counts more than another's.
fn brightness(color: Vec3) -> f32 {
    color.element_sum() / 3.0
}

/// Cosine of the polar angle above which cells of row `j` do not reach: rows of cells lie between texel centres.
fn edge(j: usize, h: usize) -> f64 {
    let v = ((j as f64 - 0.5) / h as f64).clamp(0.0, 1.0);
    (v * std::f64::consts::PI).cos()
}

/// Mean over the sphere, without strength.
fn mean_radiance(map: &Environment) -> Vec3 {
    let w = map.width as usize;
    let mut sum = glam::DVec3::ZERO;
    for y in 0..map.height {
        let row = map.texels.iter().skip(y as usize * w).take(w);
        let total: glam::DVec3 = row.map(|texel| texel.as_dvec3()).sum();
        sum += total * map.texel_solid_angle(y);
    }
    (sum / (4.0 * std::f64::consts::PI)).as_vec3()
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// A point of [0, 1] with a density that goes linearly from `a` to `b`, both at least 0.
fn linear(a: f32, b: f32, u: f32) -> f32 {
    if a + b <= 0.0 {
        return u;
    }
    // Root of a x + (b - a) x^2 / 2 = u (a + b) / 2, without cancellation.
    let root = (a * a * (1.0 - u) + b * b * u).sqrt();
    (u * (a + b) / (a + root).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling::Random;
    use crate::math::statistics::{SphereGrid, sphere_chi_square};
    use crate::scene::gallery;

    fn sky(width: u32, height: u32, texel: impl Fn(u32, u32) -> Vec3) -> Sky {
        let texels = (0..width * height).map(|i| texel(i % width, i / width)).collect();
        let map = Environment { rotation: 0.7, strength: 2.0, ..Environment::new("test", width, height, texels) };
        Sky::new(&Arc::new(map))
    }

    fn noise(x: u32, y: u32) -> Vec3 {
        Vec3::splat(crate::math::sampling::unit(crate::math::sampling::pcg(x + 97 * y)).powi(4))
    }

    #[test]
    fn directions_follow_their_density() {
        let skies = [
            ("noise", sky(32, 16, noise)),
            ("sun", sky(64, 32, |x, y| Vec3::splat(if (x, y) == (40, 9) { 1e6 } else { 0.1 }))),
            ("pole", sky(16, 9, |_, y| Vec3::splat(if y == 0 { 10.0 } else { 1.0 }))),
            ("column", sky(1, 7, |_, y| Vec3::splat(y as f32))),
            ("two", sky(2, 1, |x, _| Vec3::splat(x as f32))),
            ("studio", Sky::new(&Arc::new(gallery::studio()))),
        ];
        for (name, sky) in skies {
            let mut random = Random::new(5);
            let draw = || sky.sample(random.point2()).map(|s| s.direction);
            let axis = sky.sample(Vec2::splat(0.5)).unwrap().direction;
            let grid = if name == "sun" { SphereGrid::around(axis, 0.1) } else { SphereGrid::uniform() };
            let test = sphere_chi_square(grid, 400_000, &|w| f64::from(sky.pdf(w)), draw);
            println!("{name}: p {:.4}, mass {:.6}, {} cells", test.p_value, test.mass, test.degrees + 1);
            assert!(test.p_value > 1e-3 && (test.mass - 1.0).abs() < 2e-2, "{name}: {test:?}");
        }
    }

    #[test]
    fn the_density_of_a_sample_is_that_of_its_direction() {
        for sky in [sky(32, 16, noise), Sky::new(&Arc::new(gallery::studio()))] {
            let mut random = Random::new(2);
            let mut apart = 0;
            for _ in 0..10_000 {
                let Some(sample) = sky.sample(random.point2()) else { continue };
                let (radiance, pdf) = sky.look(sample.direction);
                apart += u32::from((radiance - sample.radiance).length() > 2e-3 * (radiance.length() + 1e-3));
                // Rounding of angles moves points across a cell's edge now and then.
                apart += u32::from((pdf - sample.pdf).abs() > 2e-3 * (pdf + sample.pdf));
            }
            assert!(apart < 20, "{apart} of 10000 differ");
        }
    }

    #[test]
    fn what_it_adds_to_the_mean_is_the_integral_of_the_map() {
        let sky = sky(32, 16, noise);
        let (mut sum, n) = (0.0, 1 << 16);
        for i in 0..n {
            let Some(sample) = sky.sample(crate::math::sampling::hammersley(i, n)) else { continue };
            sum += f64::from((sky.radiance(sample.direction) - sky.mean()).x.max(0.0) / sample.pdf);
        }
        // The rest, from where the map is below its mean, by uniform directions.
        let (mut above, mut random) = (0.0, Random::new(3));
        for _ in 0..n {
            let u = random.point2();
            let direction = sky.direction(u.x * 32.0, f64::from(1.0 - 2.0 * u.y));
            above += f64::from((sky.radiance(direction) - sky.mean()).x.max(0.0)) * 4.0 * std::f64::consts::PI;
        }
        assert!((sum / above - 1.0).abs() < 0.03, "{} {}", sum / f64::from(n), above / f64::from(n));
    }

    #[test]
    fn maps_without_contrast_are_not_sampled() {
        for sky in
            [sky(16, 8, |_, _| Vec3::ZERO), sky(16, 8, |_, _| Vec3::new(0.3, 0.5, 0.7)), sky(1, 1, |_, _| Vec3::ONE)]
        {
            assert!(!sky.is_sampled() && sky.sample(Vec2::splat(0.4)).is_none());
            assert_eq!(sky.pdf(Vec3::Y), 0.0);
        }
    }
}
