//! The reflection of GGX microfacets as a clamped cosine that a matrix stretches, shears and turns.

use std::f32::consts::FRAC_1_PI;
use std::sync::LazyLock;

use glam::{Vec2, Vec3, Vec3Swizzles};

use super::polygon::Polygon;
use crate::math::bounded;
use crate::surface::ggx::{ALPHA_MIN, Masking, clamp_alpha};

/// Nodes of the table over the cosine and over the width.
pub const NODES: u32 = 32;
/// Numbers of a node: see [`Cosines`].
pub const NUMBERS: u32 = 4;
/// Entries of one masking.
pub const STRIDE: u32 = NODES * NODES * NUMBERS;
/// `sqrt(ALPHA_MIN)`, where the axis of the width starts.
pub const ROUGHNESS_MIN: f32 = 0.031_622_78;

static TABLE: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let (words, _) = include_bytes!("cosines.f32").as_chunks::<4>();
    words.iter().map(|word| f32::from_le_bytes(*word)).collect()
});

/// `2 * STRIDE` entries for a storage buffer, from which the pass serves `area_entry`: per masking rows over the width,
/// in a row nodes over the cosine, [`NUMBERS`] each. Made by `core/examples/fit_ltc.rs`.
pub fn table() -> &'static [f32] {
    &TABLE
}

/// A clamped cosine under `M = R ((along, 0, shear), (skew, across, 0), (0, 0, 1))` (rows), where R turns z to the
/// direction at `turn` past the mirrored one. Its density in direction w is `o.z / (pi det(M) |o|^4)` with
/// `o = M^-1 w`. Heitz, Dupuy, Hill and Neubelt 2016, eq. 1.
///
/// All numbers are stored over alpha, so that they hardly change where the lobe is narrow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cosines {
    /// Direction of the view in the plane of the surface, unit.
    azimuth: Vec2,
    /// Of the lobe's z axis, in the plane of the view.
    sin: f32,
    cos: f32,
    along: f32,
    across: f32,
    shear: f32,
    skew: f32,
}

impl Cosines {
    /// The lobe toward `wo`, which is above the horizon, for widths along local x and y.
    ///
    /// Unequal widths: slopes have the covariance diag(at^2, ab^2); in the plane of the view and across it that is a
    /// triangular matrix, which goes before the isotropic lobe.
    pub fn new(wo: Vec3, alpha: Vec2, masking: Masking) -> Cosines {
        let a = clamp_alpha(alpha);
        let azimuth = wo.xy().try_normalize().unwrap_or(Vec2::X);
        let mu = wo.z.clamp(0.0, 1.0);
        let p2 = (azimuth * a).length_squared();
        let p = p2.sqrt();
        let q = a.x * a.y / p;
        let mixed = azimuth.x * azimuth.y * (a.y * a.y - a.x * a.x) / p;
        let node = lookup(mu, p, masking);
        let unit_across = if a.x == a.y { node[1] } else { lookup(mu, q, masking)[1] };
        Cosines::of([node[0], unit_across, node[2], node[3]], wo, azimuth, Vec3::new(p, q, mixed))
    }

    /// From the numbers of a node, for the slopes `(along, across, mixed)`.
    pub(super) fn of(node: [f32; 4], wo: Vec3, azimuth: Vec2, slopes: Vec3) -> Cosines {
        let sin_theta = wo.xy().length();
        let (s, c) = (node[3] * slopes.x).sin_cos();
        Cosines {
            azimuth,
            sin: sin_theta * c + wo.z * s,
            cos: wo.z * c - sin_theta * s,
            along: node[0] * slopes.x,
            across: node[1] * slopes.y,
            shear: node[2] * slopes.x,
            skew: node[1] * slopes.z,
        }
    }

    /// `M^-1 v`.
    pub fn flatten(&self, v: Vec3) -> Vec3 {
        let plane = Vec2::new(self.azimuth.dot(v.xy()), self.azimuth.perp_dot(v.xy()));
        let z = v.z * self.cos - plane.x * self.sin;
        let x = (plane.x * self.cos + v.z * self.sin - self.shear * z) / self.along;
        Vec3::new(x, (plane.y - self.skew * x) / self.across, z)
    }

    /// `M o`.
    pub fn shape(&self, o: Vec3) -> Vec3 {
        let x = self.along * o.x + self.shear * o.z;
        let y = self.skew * o.x + self.across * o.y;
        let plane = Vec2::new(x * self.cos - o.z * self.sin, y);
        (self.azimuth * plane.x + self.azimuth.perp() * plane.y).extend(x * self.sin + o.z * self.cos)
    }

    /// Share of the lobe that is above the horizon of the surface.
    ///
    /// The horizon is a plane before M too: the lobe is half a disk and half an ellipse on the plane z = 0.
    pub fn above(&self) -> f32 {
        let up = Vec2::new(self.along * self.sin, self.shear * self.sin + self.cos);
        0.5 + 0.5 * up.y / up.length().max(1e-20)
    }

    /// Density per steradian in the unit direction `w`, all around.
    pub fn density(&self, w: Vec3) -> f32 {
        let o = self.flatten(w);
        let length2 = o.length_squared();
        o.z.max(0.0) * FRAC_1_PI / (self.along * self.across * length2 * length2)
    }

    /// A polygon that is clipped at the horizon, before M, clipped once more.
    pub fn flattened(&self, polygon: &Polygon) -> Polygon {
        polygon.map(|corner| self.flatten(corner)).clipped()
    }
}

/// The numbers for a cosine and an isotropic width, bilinear between nodes.
fn lookup(mu: f32, alpha: f32, masking: Masking) -> [f32; 4] {
    let (i, s) = axis((1.0 - mu).max(0.0).sqrt());
    let (j, t) = axis((bounded(alpha, ALPHA_MIN, 1.0).sqrt() - ROUGHNESS_MIN) / (1.0 - ROUGHNESS_MIN));
    let first = masking as u32 * STRIDE + (j * NODES + i) * NUMBERS;
    std::array::from_fn(|k| {
        let at = |row: u32, column: u32| entry(first + (row * NODES + column) * NUMBERS + k as u32);
        let near = at(0, 0) + (at(0, 1) - at(0, 0)) * s;
        let far = at(1, 0) + (at(1, 1) - at(1, 0)) * s;
        near + (far - near) * t
    })
}

fn entry(index: u32) -> f32 {
    TABLE.get(index as usize).copied().unwrap_or(0.0)
}

/// Node below and fraction for a place in [0, 1].
fn axis(x: f32) -> (u32, f32) {
    let scaled = bounded(x, 0.0, 1.0) * (NODES - 1) as f32;
    let index = (scaled as u32).min(NODES - 2);
    (index, scaled - index as f32)
}

/// Cosine at a node.
pub(super) fn node_mu(node: u32) -> f32 {
    let x = node as f32 / (NODES - 1) as f32;
    1.0 - x * x
}

/// Width at a node.
pub(super) fn node_alpha(node: u32) -> f32 {
    let t = node as f32 / (NODES - 1) as f32;
    (ROUGHNESS_MIN + t * (1.0 - ROUGHNESS_MIN)).powi(2)
}
