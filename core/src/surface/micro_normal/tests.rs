use glam::DVec3;

use super::*;
use crate::math::sampling::Random;

const BUMPY: [Kind; 3] = [Kind::Grain, Kind::Cast, Kind::Hammered];

/// Points of a cube about the origin, `cells` to each side.
fn points(count: u32, cells: f32) -> impl Iterator<Item = Vec3> {
    let mut random = Random::new(7);
    (0..count).map(move |_| cells * (2.0 * random.point3() - 1.0))
}

/// Mean gradient, and mean square slope along a surface of any direction: two of three components.
fn slopes(count: u32, field: impl Fn(Vec3) -> Vec3) -> (DVec3, f64) {
    let (mut mean, mut square) = (DVec3::ZERO, 0.0);
    for p in points(count, 500.0) {
        let gradient = field(p).as_dvec3();
        mean += gradient / f64::from(count);
        square += 2.0 / 3.0 * gradient.length_squared() / f64::from(count);
    }
    (mean, square)
}

#[test]
fn the_stated_slopes_of_noise_and_dents_are_those_they_have() {
    let (_, square) = slopes(400_000, |p| noise(p, 3).xyz());
    assert!((square.sqrt() / f64::from(NOISE_SLOPE) - 1.0).abs() < 0.005, "{}", square.sqrt());
    let (_, square) = slopes(400_000, |p| dents(p).xyz());
    assert!((square.sqrt() / f64::from(DENT_SLOPE) - 1.0).abs() < 0.005, "{}", square.sqrt());
    let squares: f32 = (0..CAST_OCTAVES as i32).map(|i| (CAST_SHARE * CAST_GAIN.powi(i)).powi(2)).sum();
    assert!((squares - 1.0).abs() < 1e-3, "{squares}");
}

#[test]
fn every_kind_has_mean_slope_zero_and_root_mean_square_slope_one() {
    for kind in BUMPY {
        let (mean, square) = slopes(200_000, |p| eval(kind, p, 1.0, 0.0).gradient);
        assert!(mean.length() < 0.01, "{kind:?}: {mean}");
        assert!((square - 1.0).abs() < 0.02, "{kind:?}: {square}");
    }
}

#[test]
fn sides_that_face_an_axis_have_the_same_slopes_as_others() {
    for kind in BUMPY {
        for axis in 0..3 {
            let mut square = 0.0;
            for mut p in points(100_000, 300.0) {
                p[axis] = 0.0;
                let mut gradient = eval(kind, p, 1.0, 0.0).gradient;
                gradient[axis] = 0.0;
                square += f64::from(gradient.length_squared()) / 1e5;
            }
            assert!((square - 1.0).abs() < 0.05, "{kind:?}, axis {axis}: {square}");
        }
    }
}

#[test]
fn the_gradient_is_the_difference_of_heights() {
    // Steps short against a feature, long against the rounding of its coordinates.
    let step = 2f32.powi(-8);
    for kind in BUMPY {
        for (cells, size) in [(3.0, 1.0), (50.0, 1.0), (50.0, 2f32.powi(-9))] {
            for p in points(2000, cells * size) {
                let height = |p: Vec3| eval(kind, p, size, 0.0).height;
                let gradient = eval(kind, p, size, 0.0).gradient;
                for axis in Vec3::AXES {
                    let across = 0.5 * step * size * axis;
                    let slope = (height(p + across) - height(p - across)) / step;
                    let error = (slope - gradient.dot(axis)).abs();
                    assert!(error < 0.02, "{kind:?} at {p}: {slope} {gradient}");
                }
            }
        }
    }
}

#[test]
fn height_and_slope_go_on_across_the_borders_of_cells() {
    let fields: [&dyn Fn(Vec3) -> Vec4; 2] = [&|p| noise(p, 1), &dents];
    for field in fields {
        for p in points(20_000, 20.0) {
            for axis in Vec3::AXES {
                let border = p + axis * (p.round() - p);
                let [before, after] = [-1e-5, 1e-5].map(|step| field(border + step * axis));
                assert!((before - after).abs().max_element() < 2e-3, "{border}: {before} {after}");
            }
        }
    }
}

#[test]
fn a_body_of_any_size_and_place_has_finite_bumps_and_what_a_number_cannot_resolve_is_roughness() {
    for kind in BUMPY {
        for size in [1e-3 * SIZE_MIN_MM, 5e-3, 1e-3 * SIZE_MAX_MM] {
            for place in [0.0, 1e-30, 1e-3, 1.0, 1e3, 1e6, 1e30] {
                for p in [Vec3::splat(place), Vec3::splat(-place), Vec3::new(place, -place, 0.5 * place)] {
                    for footprint in [0.0, 1e-6, 1.0, 1e30, f32::INFINITY] {
                        let bumps = eval(kind, p, size, footprint);
                        assert!(bumps.gradient.is_finite() && bumps.height.is_finite(), "{kind:?} {p}: {bumps:?}");
                        assert!((0.0..=1.0).contains(&bumps.lost), "{kind:?} {p}: {bumps:?}");
                    }
                }
            }
        }
        let far = eval(kind, Vec3::splat(1e6), 5e-3, 0.0);
        assert_eq!((far.gradient, far.lost), (Vec3::ZERO, 1.0));
    }
}

#[test]
fn slopes_that_are_filtered_out_are_counted_as_lost() {
    for kind in BUMPY {
        let mut last = 0.0;
        for footprint in [0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8] {
            let (_, square) = slopes(50_000, |p| eval(kind, p, 1.0, footprint).gradient);
            let lost = eval(kind, Vec3::ZERO, 1.0, footprint).lost;
            assert!((square + f64::from(lost) - 1.0).abs() < 0.02, "{kind:?}: {square} {lost}");
            assert!(lost >= last, "a wider pixel loses more");
            last = lost;
        }
        assert_eq!(last, 1.0);
    }
}

#[test]
fn without_bumps_the_normal_and_the_widths_are_those_that_were_given() {
    for p in points(100, 1e3) {
        assert_eq!(eval(Kind::None, p, 5e-3, 1.0), MicroNormal::default());
    }
    let alpha = Vec2::new(0.3, 0.001);
    assert_eq!(widened(alpha, 0.7, 0.0).to_array().map(|a| (a * 1e6).round()), [3e5, 1e3]);
    assert_eq!(bent(Vec3::Z, Vec3::Z, Vec3::ZERO), Vec3::Z);
}

#[test]
fn bumps_scale_with_their_size() {
    for kind in BUMPY {
        for p in points(100, 10.0) {
            assert_eq!(eval(kind, p, 0.25, 0.01), eval(kind, 8.0 * p, 2.0, 0.08));
        }
    }
}

#[test]
fn a_slope_tilts_the_normal_by_its_angle_and_none_along_the_normal_does() {
    let n = Vec3::new(0.6, 0.0, 0.8);
    let across = Vec3::new(0.8, 0.0, -0.6);
    for slope in [0.0, 0.1, 0.5, 2.0] {
        let bent = bent(n, n, slope * across + 3.0 * n);
        assert!((bent.angle_between(n) - slope.atan()).abs() < 1e-3, "{slope}: {bent}");
        assert!(bent.dot(across) <= 0.0, "away from the higher side");
    }
}

#[test]
fn a_bent_normal_stays_on_the_side_of_the_triangle_on_which_it_was() {
    let mut random = Random::new(3);
    let mut unit = || (2.0 * random.point3() - 1.0).normalize();
    for _ in 0..10_000 {
        let (n, geometric, slope) = (unit(), unit(), 3.0 * unit());
        let bent = bent(n, geometric, slope);
        assert!((bent.length() - 1.0).abs() < 1e-5);
        assert!(bent.dot(geometric) * n.dot(geometric).signum() > -1e-6, "{n} {geometric} {slope}: {bent}");
    }
}

#[test]
fn bumps_out_of_sight_are_a_beckmann_lobe_of_their_slopes() {
    assert_eq!(widened(Vec2::ZERO, 0.3, 1.0), Vec2::splat(0.3));
    let both = widened(Vec2::new(0.3, 0.8), 0.4, 1.0);
    assert!((both - Vec2::new(0.5, 0.8f32.hypot(0.4))).length() < 1e-6, "{both}");
    assert_eq!(widened(Vec2::splat(0.9), 1.0, 1.0), Vec2::ONE);
}

#[test]
fn the_axes_of_the_cells_are_turned_and_not_stretched() {
    for p in points(100, 10.0) {
        assert!((straight(askew(p)) - p).length() < 1e-5);
        assert!((askew(p).length() - p.length()).abs() < 1e-5);
    }
    assert!(askew(Vec3::X).dot(askew(Vec3::Y).cross(askew(Vec3::Z))) > 0.999, "no mirror");
}

#[test]
fn random_numbers_of_cells_are_even_and_those_of_neighbours_differ() {
    let (mut mean, mut product) = (Vec3::ZERO, 0.0);
    let count = 40 * 40 * 40;
    for i in 0..count {
        let cell = IVec3::new(i % 40, i / 40 % 40, i / 1600) - 20;
        let here = random(cell, 0) - 0.5;
        mean += here / count as f32;
        for other in [random(cell + IVec3::X, 0), random(cell, 1)] {
            product += here.dot(other - 0.5) / (6.0 * count as f32);
        }
    }
    assert!(mean.length() < 0.005, "{mean}");
    // The variance of a number is 1/12.
    assert!(product.abs() < 0.02 / 12.0, "{product}");
}
