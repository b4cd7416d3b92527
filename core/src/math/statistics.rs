//! Does a sampler draw from the density that it claims?

use std::f64::consts::TAU;

use glam::Vec3;

use super::frame::Frame;
use super::quadrature::GaussLegendre;
use super::special::gamma_q;

/// Cells on the sphere in polar coordinates about an axis.
#[derive(Clone, Copy, Debug)]
pub struct SphereGrid {
    /// Unit vector of the pole.
    pub axis: Vec3,
    /// Rings between pole and antipole.
    pub rings: usize,
    /// Cells of each ring.
    pub sectors: usize,
    /// Ring `i` begins at `cos = 1 - 2 (i / rings)^concentration`: 1 makes cells of one size, more crowds them at the
    /// pole, where a narrow lobe is.
    pub concentration: f64,
}

/// Outcome of [`sphere_chi_square`].
#[derive(Clone, Copy, Debug)]
pub struct ChiSquare {
    /// Sum of `(observed - expected)^2 / expected`.
    pub statistic: f64,
    /// Cells after pooling, less one.
    pub degrees: usize,
    /// Chance of a statistic at least as large when the sampler is right.
    pub p_value: f64,
    /// Integral of the density over the sphere; the rest is the chance that the sampler returns nothing.
    pub mass: f64,
}

impl SphereGrid {
    /// Cells of equal size about z, 32 x 64; the horizon lies on a boundary.
    pub fn uniform() -> SphereGrid {
        SphereGrid { axis: Vec3::Z, rings: 32, sectors: 64, concentration: 1.0 }
    }

    /// Rings crowd about `axis` so that a lobe of the angular radius `width` covers about half of them.
    pub fn around(axis: Vec3, width: f64) -> SphereGrid {
        // Half of the rings end at 1 - cos = 2 (1/2)^c, which is to be width^2 / 2.
        let concentration = (-(width * width / 4.0).log2()).max(1.0);
        SphereGrid { axis, rings: 32, sectors: 64, concentration }
    }

    /// Cell of a unit vector; `frame` is that of the axis.
    fn cell(&self, frame: &Frame, direction: Vec3) -> usize {
        let local = frame.to_local(direction);
        // |v - z|^2 = 2 (1 - cos) keeps its digits near the pole.
        let height = (local - Vec3::Z).as_dvec3().length_squared() / 4.0;
        let ring = (height.powf(1.0 / self.concentration) * self.rings as f64) as usize;
        let turn = (local.y as f64).atan2(local.x as f64) / TAU;
        let sector = ((turn - turn.floor()) * self.sectors as f64) as usize;
        ring.min(self.rings - 1) * self.sectors + sector.min(self.sectors - 1)
    }

    /// Integral of `pdf` over the part of the sphere between two rings and two sectors, all in [0, 1].
    fn integrate(&self, rule: &GaussLegendre, frame: &Frame, pdf: &dyn Fn(Vec3) -> f64, part: Part) -> f64 {
        let c = self.concentration;
        let solid_angle = 2.0 * c * TAU;
        rule.integrate(part.v0, part.v1, |v| {
            let height = v.powf(c);
            let sin_theta = 2.0 * (height * (1.0 - height)).max(0.0).sqrt();
            let ring = solid_angle * height / v;
            ring * rule.integrate(part.t0, part.t1, |t| {
                let (sin_phi, cos_phi) = (TAU * t).sin_cos();
                let local =
                    Vec3::new((sin_theta * cos_phi) as f32, (sin_theta * sin_phi) as f32, (1.0 - 2.0 * height) as f32);
                pdf(frame.to_world(local))
            })
        })
    }
}

/// A patch of the grid: `v` over the rings, `t` around, in units of the whole.
#[derive(Clone, Copy)]
struct Part {
    v0: f64,
    v1: f64,
    t0: f64,
    t1: f64,
}

impl Part {
    /// The four quarters.
    fn quarters(self) -> [Part; 4] {
        let Part { v0, v1, t0, t1 } = self;
        let (v, t) = (0.5 * (v0 + v1), 0.5 * (t0 + t1));
        [
            Part { v0, v1: v, t0, t1: t },
            Part { v0, v1: v, t0: t, t1 },
            Part { v0: v, v1, t0, t1: t },
            Part { v0: v, v1, t0: t, t1 },
        ]
    }
}

/// Splits a cell until halving it changes its integral no more than `tolerance`.
fn refine(rough: f64, part: Part, tolerance: f64, depth: u32, integrate: &dyn Fn(Part) -> f64) -> f64 {
    let quarters = part.quarters().map(|quarter| (integrate(quarter), quarter));
    let fine: f64 = quarters.iter().map(|(value, _)| value).sum();
    if depth == 0 || (fine - rough).abs() <= tolerance {
        return fine;
    }
    quarters.iter().map(|&(value, quarter)| refine(value, quarter, 0.5 * tolerance, depth - 1, integrate)).sum()
}

/// Draws `samples` directions and compares their counts with the integral of `pdf` (per steradian) over each cell.
///
/// What the sampler refuses (`None`) is a cell of its own. Cells in which fewer than five are expected are pooled.
pub fn sphere_chi_square(
    grid: SphereGrid,
    samples: usize,
    pdf: &dyn Fn(Vec3) -> f64,
    mut sample: impl FnMut() -> Option<Vec3>,
) -> ChiSquare {
    let frame = Frame::new(grid.axis);
    let cells = grid.rings * grid.sectors;
    let mut observed = vec![0.0; cells + 1];
    for _ in 0..samples {
        observed[sample().map_or(cells, |direction| grid.cell(&frame, direction))] += 1.0;
    }
    let rule = GaussLegendre::new(4);
    let integrate = |part: Part| grid.integrate(&rule, &frame, pdf, part);
    // An error of a hundredth of a sample, which no cell can tell.
    let tolerance = 0.01 / samples as f64;
    let mut expected: Vec<f64> = (0..cells)
        .map(|cell| {
            let (ring, sector) = ((cell / grid.sectors) as f64, (cell % grid.sectors) as f64);
            let (rings, sectors) = (grid.rings as f64, grid.sectors as f64);
            let part =
                Part { v0: ring / rings, v1: (ring + 1.0) / rings, t0: sector / sectors, t1: (sector + 1.0) / sectors };
            // Split twice at least: the four nodes of a rule may all miss the corner where a density begins.
            part.quarters()
                .iter()
                .flat_map(|quarter| quarter.quarters())
                .map(|part| refine(integrate(part), part, tolerance, 4, &integrate))
                .sum()
        })
        .collect();
    let mass: f64 = expected.iter().sum();
    expected.push((1.0 - mass).max(0.0));
    expected.iter_mut().for_each(|e| *e *= samples as f64);
    ChiSquare { mass, ..chi_square(&observed, &expected) }
}

/// Pearson's test of counts against expected counts, cells expecting fewer than five pooled. `mass` is 1.
pub fn chi_square(observed: &[f64], expected: &[f64]) -> ChiSquare {
    const LEAST_EXPECTED: f64 = 5.0;
    let mut order: Vec<(f64, f64)> = expected.iter().copied().zip(observed.iter().copied()).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pool = (0.0, 0.0);
    let mut pooled: Vec<(f64, f64)> = Vec::new();
    for (expected, observed) in order {
        pool = (pool.0 + expected, pool.1 + observed);
        if pool.0 >= LEAST_EXPECTED {
            pooled.push(std::mem::take(&mut pool));
        }
    }
    // The rest joins the last cell; where nothing at all was expected, something observed is a contradiction.
    match pooled.last_mut() {
        Some(last) => *last = (last.0 + pool.0, last.1 + pool.1),
        None => pooled.push((pool.0.max(f64::MIN_POSITIVE), pool.1)),
    }
    let statistic = pooled.iter().map(|(e, o)| (o - e) * (o - e) / e).sum();
    let degrees = pooled.len() - 1;
    let p_value = if degrees == 0 { 1.0 } else { gamma_q(0.5 * degrees as f64, 0.5 * statistic) };
    ChiSquare { statistic, degrees, p_value, mass: 1.0 }
}

/// Level for each of `tests` independent tests so that all pass with chance `1 - level` when all hypotheses are true.
pub fn sidak(level: f64, tests: usize) -> f64 {
    // 1 - (1 - level)^(1/tests) without cancellation.
    -(f64::ln_1p(-level) / tests.max(1) as f64).exp_m1()
}
