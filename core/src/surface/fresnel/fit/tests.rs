use super::*;
use crate::math::minimize::nelder_mead;
use crate::math::sampling::Random;
use crate::surface::fresnel::{exact, f0, grazing_slope, gulbrandsen};

const REFERENCE: &str = include_str!("../../../../../tests/data/reference/fresnel_fit.csv");

fn target(n: f64, k: f64) -> Target {
    Target::new(grazing_slope(n, k), |x| exact(n, k, x))
}

/// Rows of the reference by the names of its columns; `nan` where the recipe is undefined.
fn reference() -> Vec<impl Fn(&str) -> f64> {
    let mut lines = REFERENCE.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert!(rows.len() > 50);
    rows.into_iter()
        .map(|row| {
            let names = names.clone();
            move |name: &str| {
                let place = names.iter().position(|known| *known == name).unwrap();
                row[place].parse().unwrap_or(f64::NAN)
            }
        })
        .collect()
}

fn near(found: f64, expected: f64, relative: f64) -> bool {
    (found - expected).abs() <= relative * expected.abs().max(1e-9)
}

#[test]
fn the_rescaled_form_and_f82_have_the_errors_of_the_reference() {
    for row in reference() {
        let target = target(row("n"), row("k"));
        assert!(near(target.f0(), row("f0"), 1e-9));
        // The reference looks at other angles: the largest error lies between them.
        let error = target.relative_error(|x| target.rescaled(x));
        assert!(near(error, row("max_rel_error_rescaled"), 5e-3), "{} {error}", row("n"));
        let (b, t) = f82(&target);
        assert!(near(b, row("b_f82"), 1e-8), "{b} {}", row("b_f82"));
        let dip = Dip { a: b, alpha: 6.0 };
        assert!(near(dip.error(&target), row("max_rel_error_f82"), 5e-3));
        assert!((target.rescaled(F82_COSINE) - dip.at(F82_COSINE) - t * target.rescaled(F82_COSINE)).abs() < 1e-14);
    }
}

#[test]
fn the_recipe_is_that_of_the_reference_where_it_is_valid_and_none_elsewhere() {
    let mut valid = 0;
    for row in reference() {
        let target = target(row("n"), row("k"));
        let a = -target.slope - 5.0 * (1.0 - target.f0());
        assert!(near(a, row("a_recipe"), 1e-6), "{a} {}", row("a_recipe"));
        let (alpha, error) = (row("alpha_recipe"), row("max_rel_error_recipe"));
        // The column holds (F - F*)(0.15).
        let sign = -row("error_at_0.15") / row("a_recipe") > 0.0;
        let expected = sign && alpha > 0.0 && error < row("max_rel_error_rescaled");
        let found = recipe(&target);
        assert_eq!(found.is_some(), expected, "n {} k {}", row("n"), row("k"));
        if let Some(dip) = found {
            assert!(near(dip.alpha, alpha, 1e-6), "{} {alpha}", dip.alpha);
            assert!(near(dip.error(&target), error, 5e-3), "{} {error}", dip.error(&target));
            valid += 1;
        }
    }
    assert!(valid > 10, "{valid}");
}

#[test]
fn the_fitted_dip_reaches_the_reference_and_a_search_from_many_starts() {
    let mut worst = 0.0f64;
    for row in reference() {
        let target = target(row("n"), row("k"));
        let error = fitted(&target).error(&target);
        let searched = multi_start(&target);
        worst = worst.max(error / row("max_rel_error_best_found")).max(error / searched);
        // The reference looks at other angles.
        assert!(error <= 1.002 * row("max_rel_error_best_found"), "{} {}: {error}", row("n"), row("k"));
        assert!(error <= 1.002 * searched, "{} {}: {error} {searched}", row("n"), row("k"));
    }
    println!("largest ratio to the best known: {worst:.4}");
}

/// Another optimiser: simplex searches in (a, log alpha) from forty starts.
fn multi_start(target: &Target) -> f64 {
    let error = |p: &[f64; 2]| Dip { a: p[0], alpha: p[1].clamp(-4.0, 4.8).exp() }.error(target);
    let mut least = f64::INFINITY;
    for a in [-4.0, -1.0, -0.2, 0.2, 0.6, 1.5, 3.0, 6.0] {
        for log_alpha in [-1.0, 0.5, 1.5, 2.2, 3.2] {
            least = least.min(nelder_mead([a, log_alpha], 0.3, 80, error).1);
        }
    }
    least
}

#[test]
fn no_fit_of_any_index_is_worse_than_no_dip_or_not_a_number() {
    let mut random = Random::new(3);
    for _ in 0..150 {
        let u = random.point3();
        let (n, k) = (0.01 + 9.99 * f64::from(u.x), 0.01 + 9.99 * f64::from(u.y));
        let target = target(n, k);
        let none = Dip::NONE.error(&target);
        let fit = fitted(&target);
        assert!(fit.a.is_finite() && fit.alpha > 0.0 && fit.error(&target) <= none, "{n} {k}");
        if let Some(dip) = recipe(&target) {
            assert!(fit.error(&target) <= dip.error(&target) * (1.0 + 1e-9), "{n} {k}");
        }
        let four = series::<4>(&target);
        let [two, three] = [series::<2>(&target).to_vec(), series::<3>(&target).to_vec()];
        for (c, exponents) in [(two, [3, 8].as_slice()), (three, &[2, 6, 12]), (four.to_vec(), &[2, 4, 8, 16])] {
            let dip = |x: f64| x * c.iter().zip(exponents).map(|(c, e)| c * (1.0 - x).powi(*e)).sum::<f64>();
            let error = target.relative_error(|x| target.rescaled(x) - dip(x));
            assert!(error <= none * (1.0 + 1e-9), "{n} {k} {exponents:?}: {error} {none}");
        }
        let numbers = [f82(&target), f82_fitted(&target), effective(&target)];
        assert!(numbers.iter().all(|(a, b)| a.is_finite() && b.is_finite()), "{n} {k} {numbers:?}");
    }
}

#[test]
fn the_index_of_a_curve_that_has_one_is_found_again() {
    let mut random = Random::new(4);
    let mut worst = 0.0f64;
    for _ in 0..60 {
        let u = random.point3();
        let (n, k) = (0.05 + 5.0 * f64::from(u.x), 0.5 + 6.0 * f64::from(u.y));
        let target = target(n, k);
        if target.f0() >= F0_MAX {
            continue;
        }
        let (found_n, found_k) = effective(&target);
        worst = worst.max(target.absolute_error(|x| exact(found_n, found_k, x)));
        let (tint_n, tint_k) = gulbrandsen(target.f0(), tint(&target));
        worst = worst.max(target.absolute_error(|x| exact(tint_n, tint_k, x)));
    }
    println!("largest absolute error {worst:.1e}");
    assert!(worst < 1e-3, "{worst:e}");
}

#[test]
fn reflectance_and_tint_give_an_index_of_that_reflectance() {
    for r in [0.0, 0.04, 0.3, 0.7, 0.95, 0.9999, 1.0, 2.0] {
        for g in [-1.0, 0.0, 0.2, 0.5, 0.9, 1.0, f64::NAN] {
            let (n, k) = gulbrandsen(r, g);
            let expected = r.min(0.9999);
            assert!((f64::from(f0(n as f32, k as f32)) - expected).abs() < 2e-5, "{r} {g}: {n} {k}");
        }
    }
    // Without tint there is no extinction: the index of a dielectric.
    assert!(gulbrandsen(0.04, 0.0).1 < 1e-7);
    assert!((gulbrandsen(0.04, 0.0).0 - 1.5).abs() < 1e-12);
}

#[test]
fn a_curve_above_one_gets_an_index_of_just_less() {
    let gold = Target::new(-0.3, |x| 1.04 - 0.04 * (1.0 - x).powi(5));
    let (n, k) = effective(&gold);
    assert!((exact(n, k, 1.0) - F0_MAX).abs() < 2e-3, "{n} {k}");
    assert!(tint(&gold).is_finite());
}
