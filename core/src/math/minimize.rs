//! Minimisation without derivatives, in f64.

/// Least value of `f` on `[a, b]` near the best of `starts` equally spaced points: golden section in the two intervals
/// beside it. Returns place and value; what is not a number counts as infinite.
pub fn on_interval(a: f64, b: f64, starts: usize, f: impl Fn(f64) -> f64) -> (f64, f64) {
    let value = |x: f64| Some(f(x)).filter(|v| !v.is_nan()).unwrap_or(f64::INFINITY);
    let last = starts.max(2) - 1;
    let place = |i: usize| a + (b - a) * i as f64 / last as f64;
    let best =
        (0..=last).map(|i| (i, value(place(i)))).min_by(|p, q| p.1.total_cmp(&q.1)).unwrap_or((0, f64::INFINITY));
    let (mut low, mut high) = (place(best.0.saturating_sub(1)), place((best.0 + 1).min(last)));
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut p, mut q) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_p, mut at_q) = (value(p), value(q));
    // 0.618^60 is 3e-13 of the interval; a minimum is flat over more than that.
    for _ in 0..60 {
        if at_p < at_q {
            (high, q, at_q) = (q, p, at_p);
            p = high - golden * (high - low);
            at_p = value(p);
        } else {
            (low, p, at_p) = (p, q, at_q);
            q = low + golden * (high - low);
            at_q = value(q);
        }
    }
    [(p, at_p), (q, at_q), (place(best.0), best.1)]
        .into_iter()
        .min_by(|p, q| p.1.total_cmp(&q.1))
        .unwrap_or((a, best.1))
}

/// Local minimum of `f` by the simplex search of Nelder and Mead 1965, A Simplex Method for Function Minimization, from
/// `start` with first steps of `step` in every direction. Returns place and value; what is not a number counts as
/// infinite.
pub fn nelder_mead<const N: usize>(
    start: [f64; N],
    step: f64,
    iterations: usize,
    f: impl Fn(&[f64; N]) -> f64,
) -> ([f64; N], f64) {
    let value = |x: [f64; N]| (x, Some(f(&x)).filter(|v| !v.is_nan()).unwrap_or(f64::INFINITY));
    let mut simplex = vec![value(start)];
    for i in 0..N {
        let mut corner = start;
        corner[i] += step;
        simplex.push(value(corner));
    }
    for _ in 0..iterations {
        simplex.sort_by(|p, q| p.1.total_cmp(&q.1));
        let (best, second_worst, worst) = (simplex[0], simplex[N - 1], simplex[N]);
        let centre: [f64; N] = std::array::from_fn(|i| simplex[..N].iter().map(|p| p.0[i]).sum::<f64>() / N as f64);
        let along = |t: f64| value(std::array::from_fn(|i| centre[i] + t * (worst.0[i] - centre[i])));
        let reflected = along(-1.0);
        simplex[N] = if reflected.1 < best.1 {
            let expanded = along(-2.0);
            if expanded.1 < reflected.1 { expanded } else { reflected }
        } else if reflected.1 < second_worst.1 {
            reflected
        } else {
            let contracted = along(if reflected.1 < worst.1 { -0.5 } else { 0.5 });
            if contracted.1 >= worst.1.min(reflected.1) {
                // Shrinks toward the best.
                for p in &mut simplex[1..] {
                    *p = value(std::array::from_fn(|i| 0.5 * (p.0[i] + best.0[i])));
                }
                continue;
            }
            contracted
        };
    }
    simplex.into_iter().min_by(|p, q| p.1.total_cmp(&q.1)).unwrap_or_else(|| value(start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lower_of_two_valleys_is_found_and_the_end_of_the_interval_too() {
        // Valleys at -1 and 2, the second 3 deeper.
        let f = |x: f64| (x + 1.0).powi(2) * (x - 2.0).powi(2) - x;
        let (x, _) = on_interval(-3.0, 4.0, 40, f);
        let slope = 2.0 * (x + 1.0) * (x - 2.0) * (2.0 * x - 1.0) - 1.0;
        assert!(x > 2.0 && slope.abs() < 1e-5, "{x} {slope}");
        assert_eq!(on_interval(1.0, 5.0, 10, |x| x).0, 1.0);
        assert!(on_interval(0.0, 1.0, 5, |x| if x < 0.3 { f64::NAN } else { x }).0 < 0.35);
    }

    #[test]
    fn the_bent_valley_of_rosenbrock_is_followed_to_its_end() {
        let f = |x: &[f64; 2]| (1.0 - x[0]).powi(2) + 100.0 * (x[1] - x[0] * x[0]).powi(2);
        let (x, least) = nelder_mead([-1.2, 1.0], 0.5, 300, f);
        assert!((x[0] - 1.0).abs() < 1e-6 && (x[1] - 1.0).abs() < 1e-6 && least < 1e-12, "{x:?} {least}");
    }
}
