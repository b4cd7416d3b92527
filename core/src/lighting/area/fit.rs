//! How the table of [`Cosines`] is made. Used by `core/examples/fit_ltc.rs` and by the test that makes a few nodes anew.

use glam::{Vec2, Vec3};

use super::cosines::{Cosines, NODES, node_alpha, node_mu};
use crate::math::{minimize, sampling};
use crate::surface::ggx::{self, Masking};

/// Directions drawn from each of the two lobes.
const DIRECTIONS: u32 = 1024;
/// Steps of the simplex search, and how often it starts anew where it ended.
const STEPS: usize = 120;
const ROUNDS: usize = 2;

/// A lobe of GGX to be fitted.
pub struct Target {
    wo: Vec3,
    alpha: f32,
    masking: Masking,
    /// Directions drawn by visible normals.
    drawn: Vec<Vec3>,
    /// Directional albedo for F = 1.
    albedo: f32,
}

impl Target {
    /// The lobe at cosine `mu` for the width `alpha`.
    pub fn new(mu: f32, alpha: f32, masking: Masking) -> Target {
        let wo = Vec3::new(((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt(), 0.0, mu.max(1e-4)).normalize();
        let widths = Vec2::splat(alpha);
        let mut drawn = Vec::new();
        let mut albedo = 0.0;
        for i in 0..DIRECTIONS {
            if let Some(wi) = ggx::sample_wi(wo, widths, sampling::hammersley(i, DIRECTIONS)) {
                albedo += ggx::shadowing_masking(wo, wi, widths, masking) / ggx::masking(wo, widths).max(1e-12);
                drawn.push(wi);
            }
        }
        Target { wo, alpha, masking, drawn, albedo: albedo / DIRECTIONS as f32 }
    }

    fn lobe(&self, numbers: &[f64; 4]) -> Cosines {
        let node = numbers.map(|x| x as f32);
        Cosines::of(node, self.wo, Vec2::X, Vec3::new(self.alpha, self.alpha, 0.0))
    }

    /// Integral of a distance between both lobes over their albedo, by directions drawn from both.
    fn distance(&self, numbers: &[f64; 4], distance: impl Fn(f64, f64) -> f64) -> f64 {
        if numbers[0] < 1e-2 || numbers[1] < 1e-2 {
            return f64::INFINITY;
        }
        let lobe = self.lobe(numbers);
        let widths = Vec2::splat(self.alpha);
        let scale = self.albedo / lobe.above();
        let term = |wi: Vec3| {
            let reflected = ggx::microfacet(self.wo, wi, widths, self.masking).y * wi.z;
            let density = lobe.density(wi);
            let drawn = 0.5 * (ggx::pdf(self.wo, wi, widths) + density);
            distance(f64::from(reflected), f64::from(scale * density)) / f64::from(drawn).max(1e-30)
        };
        let of_surface: f64 = self.drawn.iter().map(|wi| term(*wi)).sum();
        let of_lobe: f64 = (0..DIRECTIONS)
            .map(|i| lobe.shape(sampling::cosine_hemisphere(sampling::hammersley(i, DIRECTIONS))).normalize())
            .filter(|wi| wi.z > 0.0)
            .map(term)
            .sum();
        0.5 * (of_surface + of_lobe) / f64::from(DIRECTIONS) / f64::from(self.albedo)
    }

    /// `int (f - l)^2 / (f + l)`: what is minimised. It weighs peak and tail alike.
    pub fn divergence(&self, numbers: &[f64; 4]) -> f64 {
        // A shear and a turn of a narrow lobe are the same to first order: the last term chooses the small turn.
        self.distance(numbers, |f, l| (f - l).powi(2) / (f + l).max(1e-30)) + 1e-4 * numbers[3].powi(2)
    }

    /// `int |f - l|`: the largest error under any light, over the light that is reflected.
    pub fn error(&self, numbers: &[f64; 4]) -> f64 {
        self.distance(numbers, |f, l| (f - l).abs())
    }

    /// The best lobe near `start`: lengths along and across, shear and turn, all over alpha.
    pub fn fit(&self, start: [f64; 4]) -> [f64; 4] {
        // At normal incidence nothing tells along from across.
        if self.wo.z > 0.999_99 {
            let (best, _) = minimize::nelder_mead([start[0]], 0.1, STEPS, |p| self.divergence(&[p[0], p[0], 0.0, 0.0]));
            return [best[0], best[0], 0.0, 0.0];
        }
        (0..ROUNDS).fold(start, |from, _| minimize::nelder_mead(from, 0.1, STEPS, |p| self.divergence(p)).0)
    }
}

/// A row of the table: all cosines of a width, each fit started at its neighbour's.
pub fn row(node: u32, masking: Masking) -> Vec<[f64; 4]> {
    let alpha = node_alpha(node);
    let mut before = [1.0, 1.0, 0.0, 0.0];
    let mut fitted = Vec::new();
    for column in 0..NODES {
        before = Target::new(node_mu(column), alpha, masking).fit(before);
        fitted.push(before);
    }
    fitted
}

/// A node of the table, from a start near it.
pub fn node(node: u32, column: u32, masking: Masking, start: [f64; 4]) -> [f64; 4] {
    Target::new(node_mu(column), node_alpha(node), masking).fit(start)
}

/// The largest error of a node, [`Target::error`], under any light.
pub fn error(node: u32, column: u32, masking: Masking, numbers: &[f64; 4]) -> f64 {
    Target::new(node_mu(column), node_alpha(node), masking).error(numbers)
}
