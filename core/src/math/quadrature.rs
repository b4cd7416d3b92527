//! Gauss-Legendre quadrature.

use std::f64::consts::PI;

/// A rule on [0, 1]: exact for polynomials up to degree `2 n - 1`.
#[derive(Clone, Debug)]
pub struct GaussLegendre {
    nodes: Vec<(f64, f64)>,
}

impl GaussLegendre {
    /// The rule of `n` nodes, `n >= 1`. Roots of the Legendre polynomial by Newton's method.
    pub fn new(n: usize) -> GaussLegendre {
        let nodes = (0..n.max(1)).map(|i| legendre_root(n.max(1), i)).collect();
        GaussLegendre { nodes }
    }

    /// Nodes in (0, 1), ascending, with their weights, which sum to 1.
    pub fn nodes(&self) -> &[(f64, f64)] {
        &self.nodes
    }

    /// Integral of `f` over `[a, b]`.
    pub fn integrate(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        self.nodes.iter().map(|&(x, w)| w * f(a + (b - a) * x)).sum::<f64>() * (b - a)
    }
}

/// Root `i` of the Legendre polynomial of degree `n` and its weight, moved to [0, 1].
fn legendre_root(n: usize, i: usize) -> (f64, f64) {
    let mut x = -(PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
    let mut derivative = 1.0;
    // Newton doubles the digits each step; the start is good to three.
    for _ in 0..6 {
        let (mut p0, mut p1) = (1.0, x);
        for j in 2..=n {
            let j = j as f64;
            (p0, p1) = (p1, ((2.0 * j - 1.0) * x * p1 - (j - 1.0) * p0) / j);
        }
        derivative = n as f64 * (x * p1 - p0) / (x * x - 1.0);
        x -= p1 / derivative;
    }
    (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * derivative * derivative))
}
