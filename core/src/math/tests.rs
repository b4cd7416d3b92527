use std::f64::consts::PI;

use glam::{Vec2, Vec3};

use super::frame::Frame;
use super::oct;
use super::quadrature::GaussLegendre;
use super::sampling::{self, Random};
use super::special::{gamma_q, ln_gamma};
use super::statistics::{SphereGrid, chi_square, sidak, sphere_chi_square};

/// Rounding of a few f32 operations on numbers near one.
const ROUNDING: f32 = 1e-6;

/// Directions all over the sphere, the axes and near-axes included.
fn directions() -> Vec<Vec3> {
    let mut random = Random::new(1);
    let mut list: Vec<Vec3> = (0..2000).map(|_| (2.0 * random.point3() - 1.0).normalize()).collect();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for sign in [-1.0, 1.0] {
            list.push(sign * axis);
            list.push((sign * axis + Vec3::new(1e-4, -1e-6, 1e-5)).normalize());
        }
    }
    list
}

#[test]
fn a_frame_is_orthonormal_right_handed_and_turns_back() {
    for n in directions() {
        for frame in [Frame::new(n), Frame::with_tangent(n, Vec3::new(0.3, 0.5, -0.2)), Frame::with_tangent(n, n)] {
            assert!(frame.t.cross(frame.b).distance(frame.n) < ROUNDING, "{frame:?}");
            assert!((frame.t.length() - 1.0).abs() < ROUNDING && frame.t.dot(n).abs() < ROUNDING, "{frame:?}");
            let v = Vec3::new(0.3, -0.4, 0.8);
            assert!(frame.to_world(frame.to_local(v)).distance(v) < ROUNDING);
        }
    }
}

#[test]
fn octahedral_coordinates_turn_back_and_stay_in_the_square() {
    for n in directions() {
        let p = oct::encode(n);
        assert!(p.abs().max_element() <= 1.0);
        assert!(oct::decode(p).distance(n) < ROUNDING, "{n} {p}");
    }
    assert_eq!(oct::encode(Vec3::Z), Vec2::ZERO);
    assert_eq!(oct::decode(Vec2::ONE), Vec3::NEG_Z);
}

#[test]
fn the_disk_map_keeps_areas_and_the_hemisphere_map_has_its_density() {
    let mut random = Random::new(2);
    let inside = (0..100_000).filter(|_| sampling::disk(random.point2()).length() < 0.5).count();
    // A quarter of the area; 5 standard deviations.
    assert!((inside as f64 / 100_000.0 - 0.25).abs() < 5.0 * (0.25 * 0.75 / 100_000.0f64).sqrt());
    let pdf = |w: Vec3| f64::from(w.z.max(0.0)) / PI;
    let test = sphere_chi_square(SphereGrid::uniform(), 1_000_000, &pdf, || {
        Some(sampling::cosine_hemisphere(random.point2()))
    });
    assert!(test.p_value > 0.01 && (test.mass - 1.0).abs() < 1e-6, "{test:?}");
}

#[test]
fn the_chi_square_test_refuses_a_sampler_that_is_off_by_a_few_percent() {
    let mut random = Random::new(3);
    let tilted = |w: Vec3| f64::from(w.z.max(0.0)) / PI * (1.0 + 0.1 * (f64::from(w.z) - 2.0 / 3.0));
    for grid in [SphereGrid::uniform(), SphereGrid::around(Vec3::new(0.6, 0.0, 0.8), 0.3)] {
        let test = sphere_chi_square(grid, 1_000_000, &tilted, || Some(sampling::cosine_hemisphere(random.point2())));
        assert!(test.p_value < 1e-6, "{test:?}");
    }
}

#[test]
fn a_grid_about_a_pole_counts_the_same_density() {
    let mut random = Random::new(4);
    let pdf = |w: Vec3| f64::from(w.z.max(0.0)) / PI;
    let axis = Vec3::new(0.6, -0.64, 0.48).normalize();
    let test = sphere_chi_square(SphereGrid::around(axis, 0.2), 200_000, &pdf, || {
        Some(sampling::cosine_hemisphere(random.point2()))
    });
    assert!(test.p_value > 0.01 && (test.mass - 1.0).abs() < 1e-4, "{test:?}");
}

#[test]
fn known_chi_square_values_come_out() {
    // 95 % quantiles of the chi-square distribution.
    for (degrees, quantile) in [(1.0, 3.841_458_821), (10.0, 18.307_038_05), (100.0, 124.342_113_4)] {
        assert!((gamma_q(0.5 * degrees, 0.5 * quantile) - 0.05).abs() < 1e-9);
    }
    assert!((ln_gamma(0.5) - 0.5 * PI.ln()).abs() < 1e-13);
    assert!((ln_gamma(11.0) - 3_628_800f64.ln()).abs() < 1e-12);
    let test = chi_square(&[12.0, 8.0, 1.0], &[10.0, 10.0, 1.0]);
    // The last cell expects too few and joins its neighbour: (13 - 11)^2 / 11 + (8 - 10)^2 / 10.
    assert!((test.statistic - (4.0 / 11.0 + 0.4)).abs() < 1e-12 && test.degrees == 1, "{test:?}");
    assert!((1.0 - (1.0 - sidak(0.01, 20)).powi(20) - 0.01).abs() < 1e-12);
}

#[test]
fn gauss_legendre_is_exact_for_its_degree() {
    for n in [1, 2, 5, 16, 64] {
        let rule = GaussLegendre::new(n);
        for degree in [0, n, 2 * n - 1] {
            let integral = rule.integrate(0.0, 2.0, |x| (0.5 * x).powi(degree as i32));
            assert!((integral - 2.0 / (degree as f64 + 1.0)).abs() < 1e-13, "{n} {degree} {integral}");
        }
    }
}

#[test]
fn hammersley_points_fill_every_elementary_interval() {
    for n in [16u32, 256] {
        let mut seen = vec![false; n as usize];
        for i in 0..n {
            let p = sampling::hammersley(i, n);
            assert!(p.cmpge(Vec2::ZERO).all() && p.cmplt(Vec2::ONE).all());
            seen[(p.y * n as f32) as usize] = true;
        }
        assert!(seen.iter().all(|&s| s));
    }
    assert!(sampling::radical_inverse(u32::MAX) < 1.0);
    assert!(sampling::unit(u32::MAX) < 1.0);
}

#[test]
fn the_hash_has_no_bias_in_any_bit() {
    let n = 1u32 << 16;
    for bit in 0..32 {
        let ones = (0..n).filter(|&i| sampling::pcg(i) >> bit & 1 == 1).count() as f64;
        // 5 standard deviations of a fair coin.
        assert!((ones - 0.5 * f64::from(n)).abs() < 2.5 * f64::from(n).sqrt(), "bit {bit}: {ones}");
    }
}
