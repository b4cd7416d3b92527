//! Many angles of one curve at once.
//!
//! The same curves as [`Fresnel::eval`], written so that the loops become vector code: one channel after the other over
//! blocks of angles, and what the channels share computed once. A test holds both together.

use glam::Vec3;

use super::{Fresnel, TABLE_SIZE, conductor};
use crate::math::power::{exp2, log2};

/// Angles in a block.
const LANES: usize = 8;

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
        let channels = [0, 1, 2];
        match self {
            Fresnel::Conductor { n, k } => channels.map(|c| {
                let (n, k) = (n[c], k[c]);
                x.map(|x| conductor(n, k, x))
            }),
            Fresnel::Spectral { table } => looked_up(table, x),
            Fresnel::Rescaled { f0 } | Fresnel::Schlick { f0 } => {
                let p = Powers::new(x);
                channels.map(|c| p.dipped(f0[c], |_| 0.0))
            }
            Fresnel::Compensated { f0, a, alpha } => {
                let p = Powers::new(x);
                // One logarithm for the three channels. At normal incidence y is 0: the least number stands in, and the
                // power of a negative infinity is taken as 0.
                let log: Lanes = p.y.map(|y| log2(y.max(f32::MIN_POSITIVE)));
                let above: Lanes = p.y.map(|y| if y > 0.0 { 1.0 } else { 0.0 });
                channels.map(|c| {
                    let (a, alpha) = (a[c], alpha[c]);
                    p.dipped(f0[c], |i| a * above[i] * exp2(alpha * log[i]))
                })
            }
            Fresnel::F82 { f0, b } => {
                let p = Powers::new(x);
                let y6: Lanes = std::array::from_fn(|i| p.y4[i] * p.y2[i]);
                channels.map(|c| {
                    let b = b[c];
                    p.dipped(f0[c], |i| b * y6[i])
                })
            }
            Fresnel::Series2 { f0, c: terms } => {
                let p = Powers::new(x);
                let y3: Lanes = std::array::from_fn(|i| p.y2[i] * p.y[i]);
                channels.map(|c| {
                    let [c3, c8] = terms.map(|term| term[c]);
                    p.dipped(f0[c], |i| y3[i] * (c3 + p.y5[i] * c8))
                })
            }
            Fresnel::Series3 { f0, c: terms } => {
                let p = Powers::new(x);
                let y6: Lanes = std::array::from_fn(|i| p.y4[i] * p.y2[i]);
                channels.map(|c| {
                    let [c2, c6, c12] = terms.map(|term| term[c]);
                    p.dipped(f0[c], |i| p.y2[i] * (c2 + p.y4[i] * (c6 + y6[i] * c12)))
                })
            }
            Fresnel::Series4 { f0, c: terms } => {
                let p = Powers::new(x);
                let y8: Lanes = std::array::from_fn(|i| p.y4[i] * p.y4[i]);
                channels.map(|c| {
                    let [c2, c4, c8, c16] = terms.map(|term| term[c]);
                    p.dipped(f0[c], |i| p.y2[i] * (c2 + p.y2[i] * (c4 + p.y4[i] * (c8 + y8[i] * c16))))
                })
            }
        }
    }
}

/// Powers of `y = 1 - x`, which the channels share.
struct Powers<'a> {
    x: &'a Lanes,
    y: Lanes,
    y2: Lanes,
    y4: Lanes,
    y5: Lanes,
}

impl Powers<'_> {
    #[inline(always)]
    fn new(x: &Lanes) -> Powers<'_> {
        let y = x.map(|x| 1.0 - x);
        let y2 = y.map(|y| y * y);
        let y4 = y2.map(|y2| y2 * y2);
        let y5 = std::array::from_fn(|i| y4[i] * y[i]);
        Powers { x, y, y2, y4, y5 }
    }

    /// `F* - x dip(lane)` of a channel.
    #[inline(always)]
    fn dipped(&self, f0: f32, dip: impl Fn(usize) -> f32) -> Lanes {
        let rest = 1.0 - f0;
        std::array::from_fn(|i| f0 + rest * self.y5[i] - self.x[i] * dip(i))
    }
}

#[inline(always)]
fn looked_up(table: &[Vec3; TABLE_SIZE], x: &Lanes) -> [Lanes; 3] {
    let colors = x.map(|x| super::spectral(table, x));
    [0, 1, 2].map(|c| colors.map(|color| color[c]))
}
