use glam::Vec3;

use super::*;
use crate::math::quadrature::GaussLegendre;
use crate::math::sampling::Random;

const REFERENCE: &str = include_str!("../../../../tests/data/reference/fresnel_exact.csv");
/// The reference values carry twelve digits.
const F64_ERROR: f64 = 1e-10;
const F32_ERROR: f64 = 1e-6;

/// `(n, k, cos_theta, reflectance)` of every reference value.
fn reference() -> Vec<[f64; 4]> {
    let rows: Vec<[f64; 4]> = REFERENCE
        .lines()
        .skip(1)
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').skip(1).map(|x| x.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect();
    assert!(rows.len() > 100 && rows.iter().any(|row| row[2] == 0.0));
    rows
}

/// Every form once.
fn forms() -> Vec<Fresnel> {
    let (n, k) = (Vec3::new(0.18, 0.42, 1.37), Vec3::new(3.42, 2.35, 1.77));
    let curve = |i: usize| {
        let x = i as f64 / (TABLE_SIZE - 1) as f64;
        Vec3::from_array([0, 1, 2].map(|c| exact(n[c].into(), k[c].into(), x) as f32))
    };
    // Gold, with a red above 1.
    let f0 = Vec3::new(1.037, 0.728, 0.365);
    let [c2, c4, c8, c16] =
        [(0.052, -0.009, -0.111), (0.313, 0.009, -0.127), (0.042, -0.018, 0.938), (-0.173, -0.156, -0.381)]
            .map(Vec3::from);
    vec![
        Fresnel::rescaled(n, k),
        Fresnel::schlick(n),
        Fresnel::Conductor { n, k },
        Fresnel::Spectral { table: Box::new(std::array::from_fn(curve)) },
        Fresnel::Compensated { f0, a: Vec3::new(0.327, -0.081, 0.6), alpha: Vec3::new(3.24, 7.88, 0.9) },
        Fresnel::F82 { f0, b: Vec3::new(0.516, -0.054, 0.215) },
        Fresnel::Series2 { f0, c: [c4, c8] },
        Fresnel::Series3 { f0, c: [c2, c4, c8] },
        Fresnel::Series4 { f0, c: [c2, c4, c8, c16] },
    ]
}

#[test]
fn a_batch_of_any_length_is_what_one_angle_after_the_other_gives() {
    for fresnel in forms() {
        for count in [0, 1, 15, 16, 17, 1000] {
            let x: Vec<f32> = (0..count).map(|i| -0.1 + 1.2 * i as f32 / count as f32).chain([0.0, 1.0]).collect();
            let mut out = [(); 3].map(|()| vec![f32::NAN; x.len()]);
            fresnel.eval_batch(&x, out.each_mut().map(Vec::as_mut_slice));
            for (i, &x) in x.iter().enumerate() {
                let value = Vec3::new(out[0][i], out[1][i], out[2][i]);
                // Two ways to a power.
                assert!((value - fresnel.eval(x)).abs().max_element() < 2e-6, "{fresnel:?} {x} {value}");
            }
        }
    }
}

#[test]
fn every_dip_leaves_normal_incidence_exact() {
    for fresnel in forms().into_iter().skip(4) {
        let [f0, ..] = fresnel.coefficients();
        assert_eq!(fresnel.eval(1.0), f0.min(Vec3::ONE), "{fresnel:?}");
    }
}

#[test]
fn no_form_of_any_index_leaves_the_unit_interval() {
    let mut random = Random::new(11);
    for _ in 0..60 {
        let (u, v) = (random.point3(), random.point3());
        let (n, k) = ((0.01 + 9.99 * u).as_dvec3(), (0.01 + 9.99 * v).as_dvec3());
        let targets = [0, 1, 2].map(|c| fit::Target::new(grazing_slope(n[c], k[c]), |x| exact(n[c], k[c], x)));
        let f0 = Vec3::from_array(targets.each_ref().map(|t| t.f0() as f32));
        let three = |f: &dyn Fn(&fit::Target) -> f64| Vec3::from_array(targets.each_ref().map(|t| f(t) as f32));
        let term = |i: usize| three(&|t| fit::series::<4>(t)[i]);
        let dip = |f: fn(&fit::Target) -> fit::Dip| {
            let (a, alpha) = (three(&|t| f(t).a), three(&|t| f(t).alpha));
            Fresnel::Compensated { f0, a, alpha }
        };
        let curves = [
            dip(fit::fitted),
            dip(|t| fit::recipe(t).unwrap_or(fit::Dip::NONE)),
            Fresnel::F82 { f0, b: three(&|t| fit::f82(t).0) },
            Fresnel::F82 { f0, b: three(&|t| fit::f82_fitted(t).0) },
            Fresnel::Series2 { f0, c: [0, 1].map(|i| three(&|t| fit::series::<2>(t)[i])) },
            Fresnel::Series3 { f0, c: [0, 1, 2].map(|i| three(&|t| fit::series::<3>(t)[i])) },
            Fresnel::Series4 { f0, c: [0, 1, 2, 3].map(term) },
            Fresnel::Conductor { n: n.as_vec3(), k: k.as_vec3() },
        ];
        for curve in curves {
            assert!((curve.eval(1.0) - f0).abs().max_element() < 1e-6, "{curve:?}");
            for i in 0..=100 {
                let value = curve.eval(i as f32 / 100.0);
                assert!(value.cmpge(Vec3::ZERO).all() && value.cmple(Vec3::ONE).all(), "{n} {k} {curve:?}");
            }
        }
    }
}

#[test]
fn the_exact_conductor_meets_the_reference_in_f64_and_f32_at_every_angle() {
    let (mut worst64, mut worst32) = (0.0f64, 0.0f64);
    for [n, k, x, reflectance] in reference() {
        worst64 = worst64.max((exact(n, k, x) - reflectance).abs());
        worst32 = worst32.max((f64::from(conductor(n as f32, k as f32, x as f32)) - reflectance).abs());
    }
    println!("largest error: f64 {worst64:.1e}, f32 {worst32:.1e}");
    assert!(worst64 <= F64_ERROR, "f64 {worst64:e}");
    assert!(worst32 <= F32_ERROR, "f32 {worst32:e}");
}

#[test]
fn the_f32_conductor_stays_near_the_truth_where_the_root_cancels() {
    let mut random = Random::new(5);
    let mut worst = 0.0f64;
    for _ in 0..500_000 {
        let u = random.point3();
        let (n, k, x) = (0.5 * u.x, 10.0 * u.y, u.z);
        // Both sides see the same index: the floor of n is part of the f32 form.
        let truth = exact(n.max(INDEX_MIN).into(), k.into(), x.into());
        worst = worst.max((f64::from(conductor(n, k, x)) - truth).abs());
    }
    println!("largest error: {worst:.1e}");
    assert!(worst <= F32_ERROR, "{worst:e}");
}

#[test]
fn without_extinction_a_conductor_is_a_dielectric() {
    for eta in [0.5f32, 0.9, 1.0, 1.33, 1.5, 2.4, 4.0] {
        for i in 0..=100 {
            let x = i as f32 / 100.0;
            // Total reflection begins with infinite slope: there f32 tells the two forms apart.
            let tolerance = if eta < 1.0 { 2e-4 } else { F32_ERROR };
            // 0 / 0 for an index of one: the conductor says 1, the dielectric takes it for total reflection.
            let truth = exact(eta.into(), 0.0, x.into());
            assert!((f64::from(dielectric(eta, x)) - truth).abs() < tolerance, "dielectric {eta} {x}");
            assert!((f64::from(conductor(eta, 0.0, x)) - truth).abs() < tolerance, "conductor {eta} {x}");
        }
    }
}

#[test]
fn at_brewsters_angle_only_one_polarisation_is_reflected() {
    for eta in [1.33f64, 1.5, 2.4] {
        // tan = eta; there Rs = ((1 - eta^2) / (1 + eta^2))^2 and Rp = 0.
        let x = 1.0 / (1.0 + eta * eta).sqrt();
        let rs = ((1.0 - eta * eta) / (1.0 + eta * eta)).powi(2);
        assert!((exact(eta, 0.0, x) - 0.5 * rs).abs() < 1e-12);
        assert!((f64::from(dielectric(eta as f32, x as f32)) - 0.5 * rs).abs() < F32_ERROR);
    }
}

#[test]
fn by_snells_law_both_sides_reflect_alike_and_beyond_the_critical_angle_all_is_reflected() {
    for eta in [1.33f32, 1.5, 2.4] {
        for i in 1..=100 {
            let x = i as f32 / 100.0;
            // sin_t = sin_i / eta.
            let transmitted = (1.0 - (1.0 - x * x) / (eta * eta)).sqrt();
            let (outside, inside) = (dielectric(eta, x), dielectric(1.0 / eta, transmitted));
            // Near the critical angle the inner cosine has lost digits.
            assert!((outside - inside).abs() < 1e-4, "{eta} {x}: {outside} {inside}");
        }
        let critical = (1.0 - 1.0 / (eta * eta)).sqrt();
        assert_eq!(dielectric(1.0 / eta, critical - 1e-3), 1.0);
        assert!(dielectric(1.0 / eta, critical + 1e-3) < 1.0);
    }
}

#[test]
fn every_form_stays_in_range_and_is_one_at_grazing() {
    for fresnel in forms() {
        for i in 0..=1000 {
            let value = fresnel.eval(i as f32 / 1000.0);
            assert!(value.cmpge(Vec3::ZERO).all() && value.cmple(Vec3::ONE).all(), "{fresnel:?}");
        }
        assert!(fresnel.eval(0.0).distance(Vec3::ONE) < 1e-6);
        assert_eq!(fresnel.f0(), fresnel.eval(1.0));
    }
}

#[test]
fn all_forms_of_a_metal_but_schlick_agree_at_normal_incidence() {
    let [rescaled, schlick, conductor, spectral] = forms()[..4].to_vec().try_into().unwrap();
    assert!(rescaled.f0().distance(conductor.f0()) < 1e-6);
    assert!(spectral.f0().distance(conductor.f0()) < 1e-6);
    // Schlick's F0 of a metal is far too low, which is why it is the baseline that fails.
    assert!(conductor.f0().y - schlick.f0().y > 0.5);
    for i in 0..=300 {
        let x = i as f32 / 300.0;
        // h^2 F'' / 8 of the linear table.
        assert!(spectral.eval(x).distance(conductor.eval(x)) < 3e-4, "{x}");
    }
}

#[test]
fn the_mean_is_the_cosine_weighted_integral() {
    let rule = GaussLegendre::new(400);
    for fresnel in forms() {
        let mean = fresnel.mean();
        for channel in 0..3 {
            let integral = rule.integrate(0.0, 1.0, |x| 2.0 * x * f64::from(fresnel.eval(x as f32)[channel]));
            assert!((f64::from(mean[channel]) - integral).abs() < 2e-6, "{fresnel:?} {integral} {mean}");
        }
    }
}

#[test]
fn the_mean_of_a_dip_has_its_closed_form() {
    let (f0, a, alpha) = (Vec3::new(0.5, 0.7, 0.9), Vec3::new(0.6, 0.3, -0.1), Vec3::new(3.2, 7.9, 6.0));
    // 2 int x^2 (1 - x)^alpha dx = 4 / ((alpha + 1)(alpha + 2)(alpha + 3)).
    let dip = 4.0 * a / ((alpha + 1.0) * (alpha + 2.0) * (alpha + 3.0));
    let found = Fresnel::Compensated { f0, a, alpha }.mean();
    assert!((found - (f0 + (1.0 - f0) / 21.0 - dip)).abs().max_element() < 1e-6, "{found}");
    let found = Fresnel::F82 { f0, b: a }.mean();
    assert!((found - (f0 + (1.0 - f0) / 21.0 - a / 126.0)).abs().max_element() < 1e-6, "{found}");
}

#[test]
fn senseless_input_gives_a_number_in_range() {
    let values = [0.0, -1.0, 1e-30, 1.0, 1e9, f32::MAX, f32::INFINITY, f32::NAN];
    for n in values {
        for k in values {
            for x in [-1.0, 0.0, 1e-20, 0.5, 1.0, 2.0] {
                let fresnel = Fresnel::Conductor { n: Vec3::splat(n), k: Vec3::splat(k) };
                let value = fresnel.eval(x).x;
                assert!((0.0..=1.0).contains(&value), "n {n} k {k} cos {x}: {value}");
            }
        }
    }
    // No index at all is a surface that reflects everything.
    assert_eq!(exact(0.0, 0.0, 1.0), 1.0);
}
