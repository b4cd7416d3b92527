//! What lobes reflect of a cap on the average: tables, computed at first use by numeric integration.
//!
//! - Lambert: the irradiance of a cap that the horizon cuts; above the horizon it has a closed form.
//! - GGX and Blinn-Phong: the mean of the distribution of normals over a cap of half vectors, over its peak. Axes: the width; the
//!   angle of the cap and its distance from the normal, both over the width, so that one grid does for all. Kept is the
//!   fourth root, which falls as the distance and not as its fourth power.

use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};
use std::sync::LazyLock;

use rayon::prelude::*;

use crate::math::bounded;
use crate::math::quadrature::GaussLegendre;
use crate::surface::ggx::ALPHA_MIN;
use crate::surface::ggx::albedo::ALBEDO_ROOT_MIN;
use crate::surface::layered;

/// Nodes over the height of a cap, from where it is set to where it has risen.
pub const HEIGHTS: u32 = 33;
/// Nodes over the share of the hemisphere that a cap fills.
pub const SHARES: u32 = 9;
/// Nodes over the width of a lobe.
pub const WIDTHS: u32 = 16;
/// Nodes over the angle of a cap of half vectors.
pub const CAPS: u32 = 17;
/// Nodes over its distance from the normal.
pub const OFFSETS: u32 = 25;
/// Place of the first table of normals.
pub const NORMALS: u32 = HEIGHTS * SHARES;
/// Entries of one distribution of normals.
pub const STRIDE: u32 = WIDTHS * CAPS * OFFSETS;
/// Chord of a right angle, the largest distance of a half vector from the normal.
pub const CHORD_MAX: f32 = std::f32::consts::SQRT_2;

/// A distribution of normals, in the order of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Normals {
    /// Of GGX.
    Ggx = layered::GGX,
    /// A power of the cosine.
    BlinnPhong = 1,
}

static TABLE: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let quadrature = GaussLegendre::new(48);
    let lambert = (0..NORMALS).map(|i| {
        let (height, share) = (axis_at(i % HEIGHTS, HEIGHTS), axis_at(i / HEIGHTS, SHARES));
        set(2.0 * height - 1.0, share, &quadrature) as f32
    });
    let normals = (0..2 * STRIDE).into_par_iter().map(|i| {
        let of = if i < STRIDE { Normals::Ggx } else { Normals::BlinnPhong };
        let (offset, cap, width) = (i % OFFSETS, i / OFFSETS % CAPS, i % STRIDE / (OFFSETS * CAPS));
        let root = f64::from(ALBEDO_ROOT_MIN);
        let alpha = (root + axis_at(width, WIDTHS) * (1.0 - root)).powi(4);
        let chord = |node, count| unpacked(axis_at(node, count), alpha);
        mean(of, alpha, chord(offset, OFFSETS), chord(cap, CAPS), &quadrature).powf(0.25) as f32
    });
    lambert.chain(normals.collect::<Vec<_>>()).collect()
});

/// `NORMALS + 2 * STRIDE` entries for a storage buffer, from which the pass serves `area_cube_entry`: Lambert by shares and
/// heights, then GGX and Blinn-Phong by widths, caps and offsets; the last named runs fastest.
pub fn flat() -> &'static [f32] {
    &TABLE
}

/// Irradiance, over pi, of a cap of radiance 1 that fills `share` of a hemisphere in a direction of cosine `n_dot_l` with the
/// normal: `sin^2(a) cos` above the horizon, a being half the angle of the cap; tabulated where the horizon cuts it. In [0, 1].
pub fn lambert(share: f32, n_dot_l: f32) -> f32 {
    let sin2 = share * (2.0 - share);
    let sin = sin2.max(0.0).sqrt();
    if n_dot_l >= sin {
        return sin2 * n_dot_l;
    }
    if n_dot_l <= -sin {
        return 0.0;
    }
    let (i, s) = axis(0.5 + 0.5 * n_dot_l / sin, HEIGHTS);
    let (j, t) = axis(share, SHARES);
    let row = |j: u32| mix(entry(j * HEIGHTS + i), entry(j * HEIGHTS + i + 1), s);
    sin2 * sin * mix(row(j), row(j + 1), t)
}

/// Mean of a distribution of normals of width `alpha` over a cap of half vectors, over its peak: `offset` is the chord from the
/// normal to the middle of the cap, `cap` the chord from its middle to its rim, both at most [`CHORD_MAX`].
///
/// A chord is `2 sin(angle / 2)`; the solid angle of the cap is `pi cap^2`.
pub fn normals(of: Normals, alpha: f32, offset: f32, cap: f32) -> f32 {
    let a = bounded(alpha, ALPHA_MIN, 1.0);
    let (i, s) = axis(packed(offset, a), OFFSETS);
    let (j, t) = axis(packed(cap, a), CAPS);
    let (k, u) = axis((a.sqrt().sqrt() - ALBEDO_ROOT_MIN) / (1.0 - ALBEDO_ROOT_MIN), WIDTHS);
    let first = NORMALS + of as u32 * STRIDE;
    let line = |k: u32, j: u32| {
        let at = first + (k * CAPS + j) * OFFSETS + i;
        mix(entry(at), entry(at + 1), s)
    };
    let plane = |k: u32| mix(line(k, j), line(k, j + 1), t);
    let root = mix(plane(k), plane(k + 1), u);
    root * root * (root * root)
}

fn entry(index: u32) -> f32 {
    TABLE.get(index as usize).copied().unwrap_or(0.0)
}

fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Node below and fraction for a place in [0, 1].
fn axis(x: f32, count: u32) -> (u32, f32) {
    let scaled = bounded(x, 0.0, 1.0) * (count - 1) as f32;
    let index = (scaled as u32).min(count - 2);
    (index, scaled - index as f32)
}

fn axis_at(node: u32, count: u32) -> f64 {
    f64::from(node) / f64::from(count - 1)
}

/// A chord on its axis: even in small ones over the width, [0, 1] up to the largest.
fn packed(chord: f32, alpha: f32) -> f32 {
    chord / (chord + alpha) * (1.0 + alpha / CHORD_MAX)
}

fn unpacked(x: f64, alpha: f64) -> f64 {
    let y = x / (1.0 + alpha / SQRT_2);
    alpha * y / (1.0 - y)
}

/// What is tabulated for [`lambert`]: irradiance over `pi sin^3(a)` of a cap whose middle has the cosine `height sin(a)` with the
/// normal. Along circles about the middle of the cap the integral has a closed form.
fn set(height: f64, share: f64, quadrature: &GaussLegendre) -> f64 {
    // Of no extent it is a flat disk.
    let share = share.max(1e-8);
    let a = (share * (2.0 - share)).sqrt().atan2(1.0 - share);
    let cos = height * a.sin();
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let circle = |t: f64| {
        let (up, across) = (cos * t.cos(), sin * t.sin());
        let lit = if up >= across {
            PI * up
        } else if up <= -across {
            0.0
        } else {
            let end = (-up / across).acos();
            up * end + across * end.sin()
        };
        2.0 * lit * t.sin()
    };
    // The circle that touches the horizon parts smooth from smooth.
    let touching = cos.abs().asin().min(a);
    let sum = bowed(quadrature, 0.0, touching, circle) + bowed(quadrature, touching, a, circle);
    sum / (PI * a.sin().powi(3))
}

/// What is tabulated for [`normals`]. Along circles about the normal the cap is an arc. Half vectors are above the horizon: what
/// of a cap is not comes of its being no cap, and the distribution goes on there as in a mirror.
pub(super) fn mean(of: Normals, alpha: f64, offset: f64, cap: f64, quadrature: &GaussLegendre) -> f64 {
    let angle = |chord: f64| 2.0 * (0.5 * chord).min(1.0).asin();
    let (theta, beta) = (angle(offset), angle(cap).min(FRAC_PI_2));
    // Not held to the largest exponent: nodes beyond it are between others too.
    let exponent = (2.0 / (alpha * alpha) - 2.0).max(0.0);
    let value = |t: f64| match of {
        Normals::Ggx => {
            let (sin, cos) = (t.sin(), t.cos());
            (alpha * alpha / (sin * sin + alpha * alpha * cos * cos)).powi(2)
        }
        Normals::BlinnPhong => (0.5 * exponent * (-t.sin().powi(2)).ln_1p().max(-1e3)).exp(),
    };
    if beta < 1e-9 {
        return value(theta.min(FRAC_PI_2 - 1e-9));
    }
    let arc = |t: f64| {
        let cosine = (beta.cos() - t.cos() * theta.cos()) / (t.sin() * theta.sin());
        2.0 * cosine.clamp(-1.0, 1.0).acos() * value(t) * t.sin()
    };
    // Even steps where the lobe is wide, even ratios beyond.
    let place = |t: f64| (t / alpha).ln_1p();
    let over = |from: f64, to: f64, f: &dyn Fn(f64) -> f64| {
        bowed(quadrature, place(from), place(to), |p| {
            let t = alpha * p.exp_m1();
            f(t) * (t + alpha)
        })
    };
    let near = (beta - theta).max(0.0);
    let rings = over(0.0, near, &|t| 2.0 * PI * value(t) * t.sin());
    let (from, to) = ((theta - beta).abs(), (theta + beta).min(PI));
    (rings + over(from, to, &arc)) / (2.0 * PI * (1.0 - beta.cos()))
}

/// Integral over [a, b] of what may rise or fall like a root at its ends: `x` by the cosine of half a turn.
fn bowed(quadrature: &GaussLegendre, a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    if b <= a {
        return 0.0;
    }
    let half = 0.5 * (b - a);
    quadrature.integrate(0.0, PI, |s| f(a + half * (1.0 - s.cos())) * half * s.sin())
}
