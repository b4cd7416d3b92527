//! Many angles of one curve at once.
//!
//! The same curves as [`Fresnel::eval`], written so that the loops become vector code: one channel after the other over
//! blocks of angles, and what the channels share computed once. A test holds both together.

use glam::Vec3;

use super::{Fresnel, TABLE_SIZE, conductor};
use crate::math::power::{exp2, log2};

/// Angles in a block.
const LANES: usize = 16;

type Lanes = [f32; LANES];

impl Fresnel {
    /// Reflectance at each cosine, red, green and blue apart. Evaluates as many as the shortest of the four lists holds.
    pub fn eval_batch(&self, cos_theta: &[f32], out: [&mut [f32]; 3]) {
        let [r, g, b] = out;
        let count = cos_theta.len().min(r.len()).min(g.len()).min(b.len());
        let (cos_theta, r, g, b) = (&cos_theta[..count], &mut r[..count], &mut g[..count], &mut b[..count]);
        let blocks = cos_theta.chunks(LANES).zip(r.chunks_mut(LANES)).zip(g.chunks_mut(LANES)).zip(b.chunks_mut(LANES));
        for (((x, r), g), b) in blocks {
            let mut lanes = [1.0; LANES];
            lanes[..x.len()].copy_from_slice(x);
            let lanes = lanes.map(|x| x.clamp(0.0, 1.0));
            let values = self.block(&lanes);
            for (out, values) in [r, g, b].into_iter().zip(values) {
                let held = values.map(|v| v.clamp(0.0, 1.0));
                out.copy_from_slice(&held[..out.len()]);
            }
        }
    }

    #[inline(always)]
    fn block(&self, x: &Lanes) -> [Lanes; 3] {
        match self {
            Fresnel::Rescaled { f0 } | Fresnel::Schlick { f0 } => dipped(x, *f0, |_, _| 0.0),
            Fresnel::Conductor { n, k } => [0, 1, 2].map(|c| x.map(|x| conductor(n[c], k[c], x))),
            Fresnel::Spectral { table } => looked_up(table, x),
            Fresnel::Compensated { f0, a, alpha } => compensated(x, *f0, *a, *alpha),
            Fresnel::F82 { f0, b } => dipped(x, *f0, |p, c| b[c] * p.y6()),
            Fresnel::Series2 { f0, c: k } => dipped(x, *f0, |p, c| k[0][c] * p.y3() + k[1][c] * p.y8()),
            Fresnel::Series3 { f0, c: k } => {
                dipped(x, *f0, |p, c| k[0][c] * p.y2 + k[1][c] * p.y6() + k[2][c] * (p.y6() * p.y6()))
            }
            Fresnel::Series4 { f0, c: k } => dipped(x, *f0, |p, c| {
                k[0][c] * p.y2 + k[1][c] * p.y4() + k[2][c] * p.y8() + k[3][c] * (p.y8() * p.y8())
            }),
        }
    }
}

/// Powers of `y = 1 - x`.
#[derive(Clone, Copy)]
struct Powers {
    y: f32,
    y2: f32,
}

impl Powers {
    #[inline(always)]
    fn y3(self) -> f32 {
        self.y2 * self.y
    }
    #[inline(always)]
    fn y4(self) -> f32 {
        self.y2 * self.y2
    }
    #[inline(always)]
    fn y6(self) -> f32 {
        self.y4() * self.y2
    }
    #[inline(always)]
    fn y8(self) -> f32 {
        self.y4() * self.y4()
    }
}

/// `F* - x dip(powers, channel)`.
#[inline(always)]
fn dipped(x: &Lanes, f0: Vec3, dip: impl Fn(Powers, usize) -> f32) -> [Lanes; 3] {
    [0, 1, 2].map(|c| {
        x.map(|x| {
            let y = 1.0 - x;
            let p = Powers { y, y2: y * y };
            f0[c] + (1.0 - f0[c]) * (p.y4() * y) - x * dip(p, c)
        })
    })
}

/// One logarithm for the three channels: `y^alpha = 2^(alpha log2 y)`.
#[inline(always)]
fn compensated(x: &Lanes, f0: Vec3, a: Vec3, alpha: Vec3) -> [Lanes; 3] {
    // At normal incidence y is 0; the least number of the range stands in, and x y^alpha is taken as 0 below it.
    let log = x.map(|x| log2((1.0 - x).max(f32::MIN_POSITIVE)));
    [0, 1, 2].map(|c| {
        std::array::from_fn(|i| {
            let y = 1.0 - x[i];
            let y2 = y * y;
            let power = if y > 0.0 { exp2(alpha[c] * log[i]) } else { 0.0 };
            f0[c] + (1.0 - f0[c]) * (y2 * y2 * y) - x[i] * a[c] * power
        })
    })
}

#[inline(always)]
fn looked_up(table: &[Vec3; TABLE_SIZE], x: &Lanes) -> [Lanes; 3] {
    let colors = x.map(|x| super::spectral(table, x));
    [0, 1, 2].map(|c| colors.map(|color| color[c]))
}
