//! Tables of what single scattering reflects and loses, for shaders and for [`multiple`](fn@super::multiple).
//!
//! The loss depends on the cosine and on two widths, in the plane of the view and across it. Axes: alpha by its fourth
//! root, so that the rows keep a steady ratio; the cosine by the root of `mu (1 + a)/(mu + a)` for the loss, which at
//! small widths depends on `mu / a` alone, and by its root for the Schlick ratio. The loss is stored by its root: it
//! rises as `mu` at grazing and falls as `(a / mu)^2` above, and the root is nearly linear on that axis at both ends.

use std::sync::LazyLock;

use super::{ALPHA_MIN, Masking, clamp_alpha, reflection};
use crate::math::bounded;
use crate::math::quadrature::GaussLegendre;
use glam::{Vec2, Vec3};

/// Nodes over the cosine.
pub const ALBEDO_MU: u32 = 24;
/// Nodes over either width.
pub const ALBEDO_ALPHA: u32 = 16;
/// Offset of the mean losses in the part of one masking, after the roots of the loss.
pub const ALBEDO_LOSS_MEAN: u32 = ALBEDO_MU * ALBEDO_ALPHA * ALBEDO_ALPHA;
/// Offset of the Schlick ratios.
pub const ALBEDO_SCHLICK: u32 = ALBEDO_LOSS_MEAN + ALBEDO_ALPHA * ALBEDO_ALPHA;
/// Offset of the mean Schlick albedos.
pub const ALBEDO_SCHLICK_MEAN: u32 = ALBEDO_SCHLICK + ALBEDO_MU * ALBEDO_ALPHA * ALBEDO_ALPHA;
/// Entries of one masking.
pub const ALBEDO_STRIDE: u32 = ALBEDO_SCHLICK_MEAN + ALBEDO_ALPHA * ALBEDO_ALPHA;
/// `ALPHA_MIN^(1/4)`, where the alpha axis starts.
pub const ALBEDO_ROOT_MIN: f32 = 0.177_827_94;
/// How far the slopes across the view are narrowed for the loss; fitted, see [`toward`].
pub const ALBEDO_LOSS_NARROWING: f32 = 0.42;
/// How far the slopes along the view are narrowed for the Schlick ratio; fitted, see [`toward`].
pub const ALBEDO_SCHLICK_NARROWING: f32 = 0.2;

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
    /// root of the loss over (width across, width along, cosine), mean loss divided by the mean `alpha^2` over both
    /// widths, Schlick ratio and mean Schlick albedo likewise; the last named runs fastest.
    pub fn flat(&self) -> &[f32] {
        &self.flat
    }

    fn new() -> AlbedoTable {
        let mut table = AlbedoTable { flat: vec![0.0; 2 * ALBEDO_STRIDE as usize] };
        table.fill_directions();
        let polar = GaussLegendre::new(32);
        for row in 0..ALBEDO_ALPHA * ALBEDO_ALPHA {
            table.fill_means(row, &polar);
        }
        table
    }

    /// Roots of the loss and Schlick ratios.
    fn fill_directions(&mut self) {
        for (entry, (loss, ratio)) in on_threads(ALBEDO_LOSS_MEAN, direction_entry).iter().enumerate() {
            for m in 0..2 {
                let first = m * ALBEDO_STRIDE as usize + entry;
                self.flat[first] = loss[m].max(0.0).sqrt() as f32;
                self.flat[first + ALBEDO_SCHLICK as usize] = ratio[m] as f32;
            }
        }
    }

    /// Means over the hemisphere of what the interpolated entries give, so that both belong together.
    fn fill_means(&mut self, row: u32, polar: &GaussLegendre) {
        const AZIMUTHS: u32 = 8;
        let alpha = Vec2::new(node_alpha(row % ALBEDO_ALPHA) as f32, node_alpha(row / ALBEDO_ALPHA) as f32);
        for masking in Masking::ALL {
            let (mut lost, mut schlick) = (0.0, 0.0);
            for &(t, weight) in polar.nodes() {
                // The fourth power crowds the nodes at mu ~ alpha.
                let mu = t.powi(4);
                let sin_theta = ((1.0 - mu) * (1.0 + mu)).sqrt() as f32;
                for i in 0..AZIMUTHS {
                    let phi = std::f32::consts::FRAC_PI_2 * (i as f32 + 0.5) / AZIMUTHS as f32;
                    let w = (sin_theta * Vec2::from_angle(phi)).extend(mu as f32);
                    let measure = weight * 8.0 * t.powi(7) / f64::from(AZIMUTHS);
                    let loss = f64::from(self.loss(w, alpha, masking));
                    lost += measure * loss;
                    schlick += measure * (1.0 - loss) * f64::from(self.schlick_ratio(w, alpha, masking));
                }
            }
            let first = masking as u32 * ALBEDO_STRIDE + row;
            let alpha2 = 0.5 * f64::from(alpha.length_squared());
            self.flat[(first + ALBEDO_LOSS_MEAN) as usize] = (lost / alpha2) as f32;
            self.flat[(first + ALBEDO_SCHLICK_MEAN) as usize] = schlick as f32;
        }
    }

    fn loss(&self, w: Vec3, alpha: Vec2, masking: Masking) -> f32 {
        let widths = toward(w, alpha, Vec2::new(0.0, ALBEDO_LOSS_NARROWING));
        self.loss_in_plane(w.z, widths.x, widths.y, masking)
    }

    fn loss_in_plane(&self, mu: f32, along: f32, across: f32, masking: Masking) -> f32 {
        let m = mu.clamp(0.0, 1.0);
        let a = (0.5 * (along * along + across * across)).sqrt();
        let x = (m * (1.0 + a) / (m + a)).sqrt();
        let root = self.volume(masking as u32 * ALBEDO_STRIDE, x, along, across);
        root * root
    }

    fn schlick_ratio(&self, w: Vec3, alpha: Vec2, masking: Masking) -> f32 {
        let widths = toward(w, alpha, Vec2::new(ALBEDO_SCHLICK_NARROWING, 0.0));
        let first = masking as u32 * ALBEDO_STRIDE + ALBEDO_SCHLICK;
        self.volume(first, w.z.clamp(0.0, 1.0).sqrt(), widths.x, widths.y)
    }

    fn mean(&self, first: u32, alpha: Vec2) -> f32 {
        self.plane(first, Axis::of_alpha(alpha.x), Axis::of_alpha(alpha.y), ALBEDO_ALPHA)
    }

    /// Trilinear interpolation of the table over both widths and the cosine that starts at `first`.
    fn volume(&self, first: u32, x: f32, along: f32, across: f32) -> f32 {
        let (x, y, z) = (Axis::new(x, ALBEDO_MU), Axis::of_alpha(along), Axis::of_alpha(across));
        let slab = first + z.index * ALBEDO_MU * ALBEDO_ALPHA;
        let next = slab + ALBEDO_MU * ALBEDO_ALPHA;
        z.mix(self.plane(slab, x, y, ALBEDO_MU), self.plane(next, x, y, ALBEDO_MU))
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

/// Losses and Schlick ratios of both maskings.
type Entry = ([f64; 2], [f64; 2]);

fn direction_entry(entry: u32) -> Entry {
    let (column, row) = (entry % ALBEDO_MU, entry / ALBEDO_MU);
    let (along, across) = (node_alpha(row % ALBEDO_ALPHA), node_alpha(row / ALBEDO_ALPHA));
    let x2 = (f64::from(column) / f64::from(ALBEDO_MU - 1)).powi(2);
    // Inverse of x^2 = mu (1 + a) / (mu + a).
    let a = (0.5 * (along * along + across * across)).sqrt();
    let loss = reflection::loss(a * x2 / (1.0 + a - x2), along, across);
    (loss, reflection::schlick_ratio(x2, along, across))
}

/// The entries `0..count` in order, on threads of their own. A shared pool would hand work to a thread that waits for
/// the table, and that work may want the table too.
fn on_threads(count: u32, entry: fn(u32) -> Entry) -> Vec<Entry> {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u32);
    let each = count.div_ceil(threads).max(1);
    std::thread::scope(|scope| {
        let parts = (0..count).step_by(each as usize).map(|first| {
            let range = first..(first + each).min(count);
            (
                range.clone(),
                std::thread::Builder::new().spawn_scoped(scope, move || range.map(entry).collect::<Vec<_>>()),
            )
        });
        // All start before the first is waited for.
        let parts: Vec<_> = parts.collect();
        let made = |(range, thread): (std::ops::Range<u32>, std::io::Result<std::thread::ScopedJoinHandle<'_, _>>)| {
            // What no thread made is made here.
            thread.ok().and_then(|thread| thread.join().ok()).unwrap_or_else(|| range.map(entry).collect())
        };
        parts.into_iter().flat_map(made).collect()
    })
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
        let scaled = bounded(x, 0.0, 1.0) * (count - 1) as f32;
        let index = (scaled as u32).min(count - 2);
        Axis { index, fraction: scaled - index as f32 }
    }

    /// A width on its axis.
    fn of_alpha(alpha: f32) -> Axis {
        let root = bounded(alpha, ALPHA_MIN, 1.0).sqrt().sqrt();
        Axis::new((root - ALBEDO_ROOT_MIN) / (1.0 - ALBEDO_ROOT_MIN), ALBEDO_ALPHA)
    }

    fn mix(self, a: f32, b: f32) -> f32 {
        a + (b - a) * self.fraction
    }
}

/// Width at a node of its axis.
fn node_alpha(node: u32) -> f64 {
    let root = f64::from(ALBEDO_ROOT_MIN);
    (root + f64::from(node) / f64::from(ALBEDO_ALPHA - 1) * (1.0 - root)).powi(4)
}

/// Widths along the plane of `w` and across it, for which the table is looked up.
///
/// Slopes have the covariance `diag(at^2, ab^2)`. With phi the azimuth of `w` their width along it is `p`, across it
/// `q`: `p^2 = mix(ab^2, at^2, cos^2 phi)`, `q^2 = mix(at^2, ab^2, cos^2 phi)`; once the slope in one direction is
/// known the width in the other shrinks to `at ab / q` or `at ab / p`. The truth lies between: `narrowing` is the share
/// of the way (on the squares) for the width along and the width across. Toward the normal phi turns to the wider axis,
/// so that nothing jumps where it is undefined. Exact for equal widths, at the normal and along the wider axis.
pub fn toward(w: Vec3, alpha: Vec2, narrowing: Vec2) -> Vec2 {
    let a = clamp_alpha(alpha);
    let a2 = a * a;
    let cos2 = 1.0 - w.x * w.x - w.y * w.y;
    let cos4 = cos2 * cos2;
    // cos^2 phi (1 - cos^8 theta), where sin^2 theta divides out.
    let turned = w.x * w.x * (1.0 + cos2) * (1.0 + cos4);
    let c = (turned + if a.x > a.y { cos4 * cos4 } else { 0.0 }).clamp(0.0, 1.0);
    let wide = Vec2::new(a2.y + (a2.x - a2.y) * c, a2.x + (a2.y - a2.x) * c);
    let narrow = a2.x * a2.y / Vec2::new(wide.y, wide.x);
    (wide + (narrow - wide) * narrowing).map(f32::sqrt)
}

/// Energy that single scattering loses when F = 1: `1 - E(w)`. Error of the table 5e-3 for equal widths.
pub fn loss(w: Vec3, alpha: Vec2, masking: Masking) -> f32 {
    TABLE.loss(w, alpha, masking)
}

/// Cosine-weighted mean of [`loss`] over the hemisphere.
pub fn loss_mean(alpha: Vec2, masking: Masking) -> f32 {
    let a = clamp_alpha(alpha);
    let first = masking as u32 * ALBEDO_STRIDE + ALBEDO_LOSS_MEAN;
    0.5 * a.length_squared() * TABLE.mean(first, a)
}

/// Directional albedo of single scattering when F = 1, `E`, at cosine `mu` for the isotropic width `alpha`.
pub fn albedo(mu: f32, alpha: f32, masking: Masking) -> f32 {
    let a = bounded(alpha, ALPHA_MIN, 1.0);
    1.0 - TABLE.loss_in_plane(mu, a, a, masking)
}

/// Cosine-weighted mean of [`albedo`] over the hemisphere.
pub fn albedo_mean(alpha: f32, masking: Masking) -> f32 {
    1.0 - loss_mean(Vec2::splat(alpha), masking)
}

/// Mean of `(1 - x)^5` over the light that is reflected toward `w`, x = cosine at the microfacet: the directional
/// albedo for the curve `f0 + (f90 - f0)(1 - x)^5` is `E mix(f0, f90, this)`.
pub fn schlick_ratio(w: Vec3, alpha: Vec2, masking: Masking) -> f32 {
    TABLE.schlick_ratio(w, alpha, masking)
}

/// Cosine-weighted mean over the hemisphere of `E` times [`schlick_ratio`].
pub fn schlick_mean(alpha: Vec2, masking: Masking) -> f32 {
    TABLE.mean(masking as u32 * ALBEDO_STRIDE + ALBEDO_SCHLICK_MEAN, alpha)
}
