//! Tables of what single scattering reflects and loses, for shaders and for [`multiple`](fn@super::multiple).
//!
//! The loss depends on the cosine and on two widths, in the plane of the view and across it. Axes: alpha by its fourth
//! root, so that the rows keep a steady ratio; the cosine by the root of `mu (1 + a)/(mu + a)` for the loss, which at
//! small widths depends on `mu / a` alone, and by its root for the Schlick ratio. The loss is stored by its root: it
//! rises as `mu` at grazing and falls as `(a / mu)^2` above, and the root is nearly linear on that axis at both ends.

use std::sync::LazyLock;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::{ALPHA_MIN, Masking, clamp_alpha, reflection};
use crate::math::quadrature::GaussLegendre;

/// Nodes over the cosine.
pub const ALBEDO_MU: u32 = 24;
/// Nodes over either width.
pub const ALBEDO_ALPHA: u32 = 16;
/// Offset of the mean losses in the part of one masking, after the roots of the loss.
pub const ALBEDO_LOSS_MEAN: u32 = ALBEDO_MU * ALBEDO_ALPHA * ALBEDO_ALPHA;
/// Offset of the Schlick ratios.
pub const ALBEDO_SCHLICK: u32 = ALBEDO_LOSS_MEAN + ALBEDO_ALPHA * ALBEDO_ALPHA;
/// Offset of the mean Schlick albedos.
pub const ALBEDO_SCHLICK_MEAN: u32 = ALBEDO_SCHLICK + ALBEDO_MU * ALBEDO_ALPHA;
/// Entries of one masking.
pub const ALBEDO_STRIDE: u32 = ALBEDO_SCHLICK_MEAN + ALBEDO_ALPHA;
/// `ALPHA_MIN^(1/4)`, where the alpha axis starts.
pub const ALBEDO_ROOT_MIN: f32 = 0.177_827_94;
/// How far the slopes across the view are narrowed by those along it; fitted, see [`toward`].
pub const ALBEDO_ANISOTROPY: f32 = 0.42;

/// The tables of both maskings in one flat array.
#[derive(Debug)]
pub struct AlbedoTable {
    flat: Vec<f32>,
}

static TABLE: LazyLock<AlbedoTable> = LazyLock::new(AlbedoTable::new);

impl AlbedoTable {
    /// The table, computed at first use.
    pub fn get() -> &'static AlbedoTable {
        &TABLE
    }

    /// `2 * ALBEDO_STRIDE` entries for a storage buffer, from which the pass serves `ggx_albedo_entry`. Per masking:
    /// root of the loss over (width across, width along, cosine), mean loss over its `alpha^2` over both widths,
    /// Schlick ratio over (width, cosine), mean Schlick albedo over the width; the last named runs fastest.
    pub fn flat(&self) -> &[f32] {
        &self.flat
    }

    fn new() -> AlbedoTable {
        let mut table = AlbedoTable { flat: vec![0.0; 2 * ALBEDO_STRIDE as usize] };
        table.fill_loss();
        table.fill_schlick();
        let polar = GaussLegendre::new(32);
        for row in 0..ALBEDO_ALPHA * ALBEDO_ALPHA {
            table.fill_loss_mean(row, &polar);
        }
        for row in 0..ALBEDO_ALPHA {
            table.fill_schlick_mean(row, &polar);
        }
        table
    }

    /// Roots of the loss.
    fn fill_loss(&mut self) {
        let losses: Vec<[f64; 2]> = (0..ALBEDO_LOSS_MEAN)
            .into_par_iter()
            .map(|entry| {
                let (column, row) = (entry % ALBEDO_MU, entry / ALBEDO_MU);
                let (along, across) = (node_alpha(row % ALBEDO_ALPHA), node_alpha(row / ALBEDO_ALPHA));
                // Inverse of x^2 = mu (1 + a) / (mu + a).
                let (x2, a) = (node_x(column).powi(2), (0.5 * (along * along + across * across)).sqrt());
                reflection::loss(a * x2 / (1.0 + a - x2), along, across)
            })
            .collect();
        for (entry, loss) in losses.iter().enumerate() {
            for m in 0..2 {
                self.flat[m * ALBEDO_STRIDE as usize + entry] = loss[m].max(0.0).sqrt() as f32;
            }
        }
    }

    /// Schlick ratios.
    fn fill_schlick(&mut self) {
        for entry in 0..ALBEDO_MU * ALBEDO_ALPHA {
            let mu = node_x(entry % ALBEDO_MU).powi(2);
            let ratios = reflection::schlick_ratio(mu, node_alpha(entry / ALBEDO_MU));
            for m in 0..2 {
                self.flat[(m as u32 * ALBEDO_STRIDE + ALBEDO_SCHLICK + entry) as usize] = ratios[m] as f32;
            }
        }
    }

    /// Mean over the hemisphere of what the interpolated losses give, so that both belong together.
    fn fill_loss_mean(&mut self, row: u32, polar: &GaussLegendre) {
        const AZIMUTHS: u32 = 8;
        let alpha = Vec2::new(node_alpha(row % ALBEDO_ALPHA) as f32, node_alpha(row / ALBEDO_ALPHA) as f32);
        for masking in Masking::ALL {
            let mut sum = 0.0;
            for (mu, weight) in cosines(polar) {
                let sin_theta = ((1.0 - mu) * (1.0 + mu)).sqrt() as f32;
                for i in 0..AZIMUTHS {
                    let phi = std::f32::consts::FRAC_PI_2 * (i as f32 + 0.5) / AZIMUTHS as f32;
                    let w = (sin_theta * Vec2::from_angle(phi)).extend(mu as f32);
                    sum += weight * f64::from(self.loss(w, alpha, masking)) / f64::from(AZIMUTHS);
                }
            }
            let entry = (masking as u32 * ALBEDO_STRIDE + ALBEDO_LOSS_MEAN + row) as usize;
            self.flat[entry] = (sum / (0.5 * f64::from(alpha.length_squared()))) as f32;
        }
    }

    /// Mean over the hemisphere of the interpolated Schlick albedo.
    fn fill_schlick_mean(&mut self, row: u32, polar: &GaussLegendre) {
        let alpha = node_alpha(row) as f32;
        for masking in Masking::ALL {
            let mut sum = 0.0;
            for (mu, weight) in cosines(polar) {
                let reflected = 1.0 - self.loss_in_plane(mu as f32, alpha, alpha, masking);
                sum += weight * f64::from(reflected * self.schlick_ratio(mu as f32, alpha, masking));
            }
            self.flat[(masking as u32 * ALBEDO_STRIDE + ALBEDO_SCHLICK_MEAN + row) as usize] = sum as f32;
        }
    }

    fn loss(&self, w: Vec3, alpha: Vec2, masking: Masking) -> f32 {
        let widths = toward(w, alpha);
        self.loss_in_plane(w.z, widths.x, widths.y, masking)
    }

    fn loss_in_plane(&self, mu: f32, along: f32, across: f32, masking: Masking) -> f32 {
        let m = mu.clamp(0.0, 1.0);
        let a = (0.5 * (along * along + across * across)).sqrt();
        let x = Axis::new((m * (1.0 + a) / (m + a)).sqrt(), ALBEDO_MU);
        let (y, z) = (Axis::of_alpha(along), Axis::of_alpha(across));
        let slab = masking as u32 * ALBEDO_STRIDE + z.index * ALBEDO_MU * ALBEDO_ALPHA;
        let next = slab + ALBEDO_MU * ALBEDO_ALPHA;
        let root = z.mix(self.plane(slab, x, y, ALBEDO_MU), self.plane(next, x, y, ALBEDO_MU));
        root * root
    }

    fn schlick_ratio(&self, mu: f32, alpha: f32, masking: Masking) -> f32 {
        let first = masking as u32 * ALBEDO_STRIDE + ALBEDO_SCHLICK;
        let x = Axis::new(mu.clamp(0.0, 1.0).sqrt(), ALBEDO_MU);
        self.plane(first, x, Axis::of_alpha(alpha), ALBEDO_MU)
    }

    /// Bilinear interpolation of rows of `width` entries from `first`.
    fn plane(&self, first: u32, x: Axis, y: Axis, width: u32) -> f32 {
        let row = first + y.index * width;
        y.mix(self.line(row, x), self.line(row + width, x))
    }

    /// Linear interpolation of the entries from `first`.
    fn line(&self, first: u32, x: Axis) -> f32 {
        let entry = (first + x.index) as usize;
        x.mix(self.flat[entry], self.flat[entry + 1])
    }
}

/// A place between two nodes of an axis.
#[derive(Clone, Copy)]
struct Axis {
    index: u32,
    fraction: f32,
}

impl Axis {
    /// `x` in [0, 1] over `count` nodes.
    fn new(x: f32, count: u32) -> Axis {
        let scaled = x.max(0.0).min(1.0) * (count - 1) as f32;
        let index = (scaled as u32).min(count - 2);
        Axis { index, fraction: scaled - index as f32 }
    }

    /// A width on its axis.
    fn of_alpha(alpha: f32) -> Axis {
        let root = alpha.max(ALPHA_MIN).min(1.0).sqrt().sqrt();
        Axis::new((root - ALBEDO_ROOT_MIN) / (1.0 - ALBEDO_ROOT_MIN), ALBEDO_ALPHA)
    }

    fn mix(self, a: f32, b: f32) -> f32 {
        a + (b - a) * self.fraction
    }
}

/// Cosines and weights of a mean over the hemisphere; the fourth power crowds the nodes at mu ~ alpha.
fn cosines(rule: &GaussLegendre) -> impl Iterator<Item = (f64, f64)> {
    rule.nodes().iter().map(|&(t, weight)| (t.powi(4), weight * 8.0 * t.powi(7)))
}

/// Width at a node of its axis.
fn node_alpha(node: u32) -> f64 {
    let root = f64::from(ALBEDO_ROOT_MIN);
    (root + f64::from(node) / f64::from(ALBEDO_ALPHA - 1) * (1.0 - root)).powi(4)
}

/// A node of the cosine's axis in [0, 1].
fn node_x(node: u32) -> f64 {
    f64::from(node) / f64::from(ALBEDO_MU - 1)
}

/// Widths along the plane of `w` and across it, for which the table is looked up.
///
/// Slopes have the covariance `diag(at^2, ab^2)`. Along the azimuth phi of `w` their width is `p`; across it `q`, which
/// shrinks to `at ab / p` once the slope along is known. The loss lies between: `p^2 = mix(ab^2, at^2, cos^2 phi)` and
/// `q^2 = mix(mix(at^2, ab^2, cos^2 phi), (at ab / p)^2, ` [`ALBEDO_ANISOTROPY`]`)`. Toward the normal phi turns to the
/// wider axis, so that nothing jumps where it is undefined. Exact for equal widths, at the normal and along the wider
/// axis.
pub fn toward(w: Vec3, alpha: Vec2) -> Vec2 {
    let a = clamp_alpha(alpha);
    let a2 = a * a;
    let cos2 = 1.0 - w.x * w.x - w.y * w.y;
    let cos4 = cos2 * cos2;
    // cos^2 phi (1 - cos^8 theta), where sin^2 theta divides out.
    let turned = w.x * w.x * (1.0 + cos2) * (1.0 + cos4);
    let c = (turned + if a.x > a.y { cos4 * cos4 } else { 0.0 }).clamp(0.0, 1.0);
    let p2 = a2.y + (a2.x - a2.y) * c;
    let q2 = a2.x + (a2.y - a2.x) * c;
    let narrowed2 = a2.x * a2.y / p2;
    Vec2::new(p2, q2 + (narrowed2 - q2) * ALBEDO_ANISOTROPY).map(f32::sqrt)
}

/// Energy that single scattering loses when F = 1: `1 - E(w)`. Error of the table 5e-3 for equal widths.
pub fn loss(w: Vec3, alpha: Vec2, masking: Masking) -> f32 {
    TABLE.loss(w, alpha, masking)
}

/// Cosine-weighted mean of [`loss`] over the hemisphere.
pub fn loss_mean(alpha: Vec2, masking: Masking) -> f32 {
    let a = clamp_alpha(alpha);
    let first = masking as u32 * ALBEDO_STRIDE + ALBEDO_LOSS_MEAN;
    let (x, y) = (Axis::of_alpha(a.x), Axis::of_alpha(a.y));
    0.5 * a.length_squared() * TABLE.plane(first, x, y, ALBEDO_ALPHA)
}

/// Directional albedo of single scattering when F = 1, `E`, at cosine `mu` for the isotropic width `alpha`.
pub fn albedo(mu: f32, alpha: f32, masking: Masking) -> f32 {
    let a = alpha.max(ALPHA_MIN).min(1.0);
    1.0 - TABLE.loss_in_plane(mu, a, a, masking)
}

/// Cosine-weighted mean of [`albedo`] over the hemisphere.
pub fn albedo_mean(alpha: f32, masking: Masking) -> f32 {
    1.0 - loss_mean(Vec2::splat(alpha), masking)
}

/// Mean of `(1 - x)^5` over the reflected light, x = cosine at the microfacet: the directional albedo for the curve
/// `f0 + (f90 - f0)(1 - x)^5` is `E mix(f0, f90, this)`.
pub fn albedo_schlick_ratio(mu: f32, alpha: f32, masking: Masking) -> f32 {
    TABLE.schlick_ratio(mu, alpha, masking)
}

/// Cosine-weighted mean over the hemisphere of `E` times [`albedo_schlick_ratio`].
pub fn albedo_schlick_mean(alpha: f32, masking: Masking) -> f32 {
    TABLE.line(masking as u32 * ALBEDO_STRIDE + ALBEDO_SCHLICK_MEAN, Axis::of_alpha(alpha))
}
