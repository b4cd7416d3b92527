//! The choices that no other beats in both cost and error.

/// Indices of the pairs (cost, error) that no other pair is at most as high in both of and lower in one, by ascending
/// cost. Pairs with a NaN never count; of equal pairs the first does.
pub fn pareto(pairs: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..pairs.len()).filter(|i| !pairs[*i].0.is_nan() && !pairs[*i].1.is_nan()).collect();
    order.sort_by(|a, b| pairs[*a].0.total_cmp(&pairs[*b].0).then(pairs[*a].1.total_cmp(&pairs[*b].1)));
    let mut least = f64::INFINITY;
    order.retain(|i| {
        let better = pairs[*i].1 < least;
        least = least.min(pairs[*i].1);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling::Random;

    #[test]
    fn what_is_dearer_and_no_better_falls_out() {
        assert_eq!(pareto(&[(1.0, 5.0), (2.0, 5.0), (2.0, 3.0), (4.0, 1.0), (3.0, 4.0)]), [0, 2, 3]);
        assert_eq!(pareto(&[(1.0, 1.0), (1.0, 1.0)]), [0]);
        assert_eq!(pareto(&[(f64::NAN, 0.0), (1.0, f64::NAN), (2.0, 2.0)]), [2]);
        assert!(pareto(&[]).is_empty());
    }

    #[test]
    fn it_is_the_definition_on_random_pairs() {
        let mut random = Random::new(11);
        for _ in 0..50 {
            let pairs: Vec<(f64, f64)> = (0..40)
                .map(|_| {
                    let p = 8.0 * random.point2();
                    (f64::from(p.x.floor()), f64::from(p.y.floor()))
                })
                .collect();
            let beaten = |i: usize| {
                pairs.iter().enumerate().any(|(j, q)| {
                    let p = pairs[i];
                    q.0 <= p.0 && q.1 <= p.1 && (q.0 < p.0 || q.1 < p.1 || j < i)
                })
            };
            let mut found = pareto(&pairs);
            found.sort_unstable();
            assert_eq!(found, (0..pairs.len()).filter(|i| !beaten(*i)).collect::<Vec<_>>(), "{pairs:?}");
        }
    }
}
