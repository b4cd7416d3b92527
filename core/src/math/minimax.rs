//! Linear approximation with the least largest error.

/// Rounds after which the search stops; ten to forty are usual.
const ROUNDS: usize = 500;

/// Coefficients `c` that make the largest `|target_j - phi_j . c|` least, one row of `phi` per point.
///
/// The dual of this linear program has one row per coefficient and one more, so its simplex method handles systems of
/// `M + 1` equations only: each round takes the point of the largest residual into the basis (single exchange). Stiefel
/// 1960, Note on Jordan elimination, linear programming and Tchebycheff approximation. The result is optimal to 1e-9 of
/// the error unless the rounds run out, and finite for finite input.
pub fn minimax<const M: usize>(phi: &[[f64; M]], target: &[f64]) -> [f64; M] {
    let mut basis = Basis::new();
    let mut coefficients = [0.0; M];
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let Some((c, level)) = basis.multipliers() else { break };
        let residual = |j: usize| target[j] - dot(&phi[j], &c);
        let worst = (0..phi.len()).map(|j| (j, residual(j))).max_by(|p, q| p.1.abs().total_cmp(&q.1.abs()));
        let Some((j, error)) = worst else { break };
        if error.abs() < least {
            (least, coefficients) = (error.abs(), c);
        }
        if error.abs() <= level + 1e-9 * error.abs() || !error.is_finite() {
            break;
        }
        let sign = error.signum();
        let column = Column { phi: phi[j].map(|v| sign * v), one: 1.0, cost: sign * target[j], artificial: false };
        if !basis.enter(column) {
            break;
        }
    }
    coefficients
}

fn dot<const M: usize>(a: &[f64; M], b: &[f64; M]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A column of the dual: `(phi, one)`.
#[derive(Clone)]
struct Column<const M: usize> {
    phi: [f64; M],
    one: f64,
    cost: f64,
    /// Stands in for a row until a point takes its place.
    artificial: bool,
}

/// `M + 1` columns with their weights.
struct Basis<const M: usize> {
    columns: Vec<Column<M>>,
    weights: Vec<f64>,
}

impl<const M: usize> Basis<M> {
    /// One artificial column a row; that of the last carries the whole weight, as a point without error would.
    fn new() -> Basis<M> {
        let unit = |row: usize| Column {
            phi: std::array::from_fn(|i| if i == row { 1.0 } else { 0.0 }),
            one: if row == M { 1.0 } else { 0.0 },
            cost: 0.0,
            artificial: row < M,
        };
        let weights = (0..=M).map(|row| if row == M { 1.0 } else { 0.0 }).collect();
        Basis { columns: (0..=M).map(unit).collect(), weights }
    }

    /// Coefficients and level that price the columns of the basis at their cost.
    fn multipliers(&self) -> Option<([f64; M], f64)> {
        let rows = self.columns.iter().map(|c| c.phi.iter().copied().chain([c.one]).collect()).collect();
        let solution = solve(rows, self.columns.iter().map(|c| c.cost).collect())?;
        Some((std::array::from_fn(|i| solution[i]), solution[M]))
    }

    /// Takes a column in and another out; `false` where the weights allow none.
    fn enter(&mut self, column: Column<M>) -> bool {
        let row = |i: usize| self.columns.iter().map(|c| if i < M { c.phi[i] } else { c.one }).collect();
        let right = column.phi.iter().copied().chain([column.one]).collect();
        let Some(step) = solve((0..=M).map(row).collect(), right) else { return false };
        let scale = step.iter().fold(0.0f64, |most, s| most.max(s.abs()));
        let tiny = 1e-11 * scale;
        let artificial = (0..=M).filter(|&i| self.columns[i].artificial && step[i].abs() > tiny);
        let leaving = artificial.max_by(|&i, &j| step[i].abs().total_cmp(&step[j].abs())).or_else(|| {
            let ratio = |i: usize| self.weights[i] / step[i];
            (0..=M).filter(|&i| step[i] > tiny).min_by(|&i, &j| ratio(i).total_cmp(&ratio(j)))
        });
        let Some(leaving) = leaving else { return false };
        let entering = self.weights[leaving] / step[leaving];
        for (weight, step) in self.weights.iter_mut().zip(&step) {
            *weight = (*weight - entering * step).max(0.0);
        }
        self.weights[leaving] = entering.max(0.0);
        self.columns[leaving] = column;
        true
    }
}

/// Solves a small linear system by elimination with row exchange; `None` where it is singular.
fn solve(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let n = right.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&p, &q| rows[p][i].abs().total_cmp(&rows[q][i].abs()))?;
        rows.swap(i, pivot);
        right.swap(i, pivot);
        // Not a number is no pivot either.
        if rows[i][i].abs().partial_cmp(&1e-300) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        for below in i + 1..n {
            let factor = rows[below][i] / rows[i][i];
            let (head, tail) = rows.split_at_mut(below);
            for (value, above) in tail[0][i..].iter_mut().zip(&head[i][i..]) {
                *value -= factor * above;
            }
            right[below] -= factor * right[i];
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| rows[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / rows[i][i];
    }
    Some(right).filter(|solution| solution.iter().all(|v| v.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_line_under_a_parabola_leaves_an_eighth() {
        // x^2 on [0, 1]: the Chebyshev line x - 1/8 leaves 1/8 at 0, 1/2 and 1.
        let xs: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
        let phi: Vec<[f64; 2]> = xs.iter().map(|&x| [1.0, x]).collect();
        let target: Vec<f64> = xs.iter().map(|x| x * x).collect();
        let [constant, slope] = minimax(&phi, &target);
        assert!((constant + 0.125).abs() < 1e-9 && (slope - 1.0).abs() < 1e-9, "{constant} {slope}");
    }

    #[test]
    fn degree_four_of_the_exponential_meets_the_published_error_with_equal_ripples() {
        // Least largest error of degree 4 to exp on [-1, 1]: 5.4667e-4 (Meinardus 1967, table of the exponential).
        let xs: Vec<f64> = (0..=4000).map(|i| -1.0 + f64::from(i) / 2000.0).collect();
        let phi: Vec<[f64; 5]> = xs.iter().map(|&x| std::array::from_fn(|i| x.powi(i as i32))).collect();
        let target: Vec<f64> = xs.iter().map(|x| x.exp()).collect();
        let c = minimax(&phi, &target);
        let error = phi.iter().zip(&target).map(|(p, t)| (t - dot(p, &c)).abs()).fold(0.0, f64::max);
        assert!((error - 5.4667e-4).abs() < 1e-7, "{error}");
    }

    #[test]
    fn nothing_to_approximate_and_columns_of_zeros_give_finite_coefficients() {
        assert_eq!(minimax::<3>(&[], &[]), [0.0; 3]);
        assert_eq!(minimax(&[[0.0, 0.0]; 5], &[1.0; 5]), [0.0, 0.0]);
        let c = minimax(&[[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]], &[1.0, 2.0, 3.1]);
        assert!(c.iter().all(|v| v.is_finite()), "{c:?}");
    }
}
