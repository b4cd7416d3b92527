//! Procedural bumps of a finish: the slopes of a solid height field, filtered to the size of a pixel.
//!
//! The field lives in space, not on the surface: it needs no texture coordinates and has no seam. Where a pixel is too
//! wide for the bumps they fade out, and what they would have tilted is handed to the microfacets instead.

#[cfg(test)]
mod tests;

use glam::{IVec3, UVec3, Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::leaf::Leaf;
use crate::math::{self, sampling};

/// The WGSL twin.
pub static WGSL: Leaf =
    Leaf { name: "micro_normal", source: include_str!("micro_normal.wgsl"), needs: &[&math::WGSL], externs: "" };

/// Least size of a bump in millimetres.
pub const SIZE_MIN_MM: f32 = 0.01;
/// Largest size of a bump in millimetres.
pub const SIZE_MAX_MM: f32 = 1000.0;
/// Pixels over features: bumps are whole up to here. Four pixels show a bump as it is.
pub const FADE_FROM: f32 = 0.25;
/// Pixels over features: bumps are gone from here on.
pub const FADE_TO: f32 = 0.75;
/// Least pixel for a feature at distance 1 from the origin, in features: what an f32 tells apart there, eight times.
pub const PRECISION: f32 = 8.0 * f32::EPSILON;
/// Root mean square slope along a surface of the noise with cells of size 1; measured, a test holds it.
pub const NOISE_SLOPE: f32 = 0.704;
/// The same of the dents.
pub const DENT_SLOPE: f32 = 0.9025;
/// Share of a cell in which its dent may lie. With less the rows of the cells show.
pub const JITTER: f32 = 0.9;
/// Radius to which dents reach, in cells: what lies outside of the 27 cells about a point is at least this far away.
pub const REACH: f32 = 1.05;
/// How sharp the ridges between dents are: those of dents a cell apart are 1/20 of a cell wide.
pub const SHARPNESS: f32 = 20.0;
/// Where no dent reaches, the plate is flat: the weight of that height, 1 dent radius above the middle of a dent.
pub const FLAT: f32 = 1e-9;
/// Octaves of a cast skin, from the size of its features downward.
pub const CAST_OCTAVES: u32 = 3;
/// Slope of an octave over that of the next coarser one. At 1 the skin looks like crumpled foil.
pub const CAST_GAIN: f32 = 0.7;
/// Slope of the coarsest octave, so that the squares of all sum to 1.
pub const CAST_SHARE: f32 = 0.7603;

/// What bumps look like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Kind {
    /// No bumps.
    #[default]
    None = 0,
    /// Bumps of one size, as bead-blasting leaves them.
    Grain = 1,
    /// Bumps of several sizes, as a mould of sand leaves them.
    Cast = 2,
    /// Round dents side by side.
    Hammered = 3,
}

impl Kind {
    /// Every kind, in the order of their numbers.
    pub const ALL: [Kind; 4] = [Kind::None, Kind::Grain, Kind::Cast, Kind::Hammered];
    /// Their names in files, in the same order.
    pub const IDS: [&'static str; 4] = ["none", "grain", "cast", "hammered"];
}

/// Bumps at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MicroNormal {
    /// Gradient of the height, without unit; root mean square 1 along a surface where nothing was filtered out.
    pub gradient: Vec3,
    /// Height in features, near 0.
    pub height: f32,
    /// Share of the squared slopes that was filtered out, 0 to 1.
    pub lost: f32,
}

/// Three hashes of a cell: pcg3d, Jarzynski and Olano 2020, Hash Functions for GPU Rendering.
pub fn hash(cell: IVec3, seed: u32) -> UVec3 {
    let [mut x, mut y, mut z] =
        cell.to_array().map(|c| (c as u32).wrapping_add(seed).wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    for mixed in [false, true] {
        if mixed {
            (x, y, z) = (x ^ (x >> 16), y ^ (y >> 16), z ^ (z >> 16));
        }
        x = x.wrapping_add(y.wrapping_mul(z));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
    }
    UVec3::new(x, y, z)
}

/// Three numbers in [0, 1) of a cell.
pub fn random(cell: IVec3, seed: u32) -> Vec3 {
    Vec3::from_array(hash(cell, seed).to_array().map(sampling::unit))
}

/// Gradient noise with cells of size 1: its gradient, and in w its value. `p` below 2^31.
///
/// `sum over corners c of w(f - c) g_c . (f - c)`, w the product of the quintic `t^3 (t (6 t - 15) + 10)`: Perlin 2002,
/// Improving Noise; the g_c are random points of a cube instead of its edges.
pub fn noise(p: Vec3, seed: u32) -> Vec4 {
    let first = p.floor();
    let f = p - first;
    let upper = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let slope = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    let mut sum = Vec4::ZERO;
    for i in 0..8 {
        let corner = IVec3::new(i & 1, (i >> 1) & 1, i >> 2);
        let c = corner.as_vec3();
        let direction = 2.0 * random(first.as_ivec3() + corner, seed) - 1.0;
        let value = direction.dot(f - c);
        let w = c * upper + (1.0 - c) * (1.0 - upper);
        let d = (2.0 * c - 1.0) * slope;
        let weight = w.x * w.y * w.z;
        let change = Vec3::new(d.x * w.y * w.z, w.x * d.y * w.z, w.x * w.y * d.z);
        sum += (direction * weight + change * value).extend(value * weight);
    }
    sum
}

/// Round dents, one for each cell of size 1: the gradient, and in w the height. `p` below 2^31.
///
/// The blows of one hammer on a plate leave spheres of one radius that cut into each other: close to the vertex of a
/// sphere, the least `d^2` over all dents at distances d. Here their least is taken softly, so that ridges are rounded as
/// on metal: with k the sharpness and `r = 1 - d^2 / REACH^2` over the dents within reach, `h = -1/k ln(FLAT + sum of
/// r^2 exp(-k d^2))`. One dent for each cell, after Worley 1996, A Cellular Texture Basis Function.
pub fn dents(p: Vec3) -> Vec4 {
    let first = p.floor();
    let f = p - first;
    let reach2 = REACH * REACH;
    let (mut total, mut pull) = (FLAT, Vec3::ZERO);
    for i in 0..27 {
        let cell = IVec3::new(i % 3, (i / 3) % 3, i / 9) - 1;
        let middle = cell.as_vec3() + 0.5 + JITTER * (random(first.as_ivec3() + cell, 0) - 0.5);
        let away = f - middle;
        let d2 = away.length_squared();
        let r = (1.0 - d2 / reach2).max(0.0);
        let weight = r * (-SHARPNESS * d2).exp();
        total += weight * r;
        pull += away * (weight * (r + 2.0 / (SHARPNESS * reach2)));
    }
    (2.0 / total * pull).extend(-total.ln() / SHARPNESS)
}

/// Amplitude that is left of features of this size under such a pixel, 1 to 0.
pub fn resolved(feature: f32, pixel: f32) -> f32 {
    let t = ((pixel / feature - FADE_FROM) / (FADE_TO - FADE_FROM)).clamp(0.0, 1.0);
    1.0 - t * t * (3.0 - 2.0 * t)
}

/// To the axes of the cells, which lie askew so that no flat side of a body shows a row of them.
pub fn askew(p: Vec3) -> Vec3 {
    Vec3::new(2.0 * p.x + 2.0 * p.y + p.z, p.y - 2.0 * p.x + 2.0 * p.z, p.x - 2.0 * p.y + 2.0 * p.z) / 3.0
}

/// Back from the axes of the cells.
pub fn straight(p: Vec3) -> Vec3 {
    Vec3::new(2.0 * p.x - 2.0 * p.y + p.z, 2.0 * p.x + p.y - 2.0 * p.z, p.x + 2.0 * p.y + 2.0 * p.z) / 3.0
}

/// Bumps of a kind at `p`, with features of `size` above 0, under a pixel that is `footprint` wide; all in metres.
pub fn eval(kind: Kind, p: Vec3, size: f32, footprint: f32) -> MicroNormal {
    if kind == Kind::None {
        return MicroNormal::default();
    }
    let inverse = 1.0 / size;
    let scaled = p * inverse;
    let q = askew(scaled);
    let pixel = (footprint * inverse).max(scaled.abs().max_element() * PRECISION);
    let (mut sum, mut kept) = (Vec4::ZERO, 0.0);
    if kind == Kind::Hammered {
        let amplitude = resolved(1.0, pixel);
        if amplitude > 0.0 {
            kept = amplitude * amplitude;
            sum = amplitude / DENT_SLOPE * dents(q);
        }
    } else {
        let (octaves, mut share) = if kind == Kind::Cast { (CAST_OCTAVES, CAST_SHARE) } else { (1, 1.0) };
        let mut scale = 1.0;
        for i in 0..octaves {
            let amplitude = share * resolved(1.0, pixel * scale);
            if amplitude > 0.0 {
                kept += amplitude * amplitude;
                let noise = noise(q * scale, i) * (amplitude / NOISE_SLOPE);
                sum += noise.xyz().extend(noise.w / scale);
            }
            share *= CAST_GAIN;
            scale *= 2.0;
        }
    }
    MicroNormal { gradient: straight(sum.xyz()), height: sum.w, lost: (1.0 - kept).max(0.0) }
}

/// The unit normal `n` over bumps of the given slopes, on the side of the triangle's normal `geometric` on which `n` is.
///
/// `normalize(n - (s - n (n . s)))`, s the gradient of the height: Blinn 1978, Simulation of Wrinkled Surfaces, for a
/// field in space.
pub fn bent(n: Vec3, geometric: Vec3, slope: Vec3) -> Vec3 {
    let bent = (n - (slope - n * n.dot(slope))).normalize();
    let side = if n.dot(geometric) >= 0.0 { geometric } else { -geometric };
    (bent - side * bent.dot(side).min(0.0)).normalize()
}

/// Widths of the microfacets together with slopes that were filtered out: `sqrt(alpha^2 + depth^2 lost)`, at most 1.
///
/// `depth` is the root mean square slope, twice the variance along one axis is its square: Olano and Baker 2010, LEAN
/// Mapping, for the width of a Beckmann lobe, which is that of GGX to within its tails.
pub fn widened(alpha: Vec2, depth: f32, lost: f32) -> Vec2 {
    Vec2::from_array((alpha * alpha + depth * depth * lost).to_array().map(f32::sqrt)).min(Vec2::ONE)
}
