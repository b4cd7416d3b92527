use std::f32::consts::PI;

use glam::{DVec3, Vec2, Vec3};

use super::*;
use crate::math::sampling;
use crate::surface::fresnel::Fresnel;
use crate::surface::ggx::Masking;
use crate::surface::layered::Lobe;

const WHITE: Fresnel = Fresnel::Rescaled { f0: Vec3::ONE };

fn metal(fresnel: &Fresnel, alpha: Vec2) -> Surface<'_> {
    Surface {
        base_color: Vec3::ONE,
        metallic: 1.0,
        alpha,
        lobe: Lobe::Ggx,
        fresnel,
        fresnel_mean: fresnel.mean(),
        dielectric_f0: Vec3::splat(0.04),
        dielectric_f90: 1.0,
        coat: 0.0,
        coat_alpha: 0.1,
        masking: Masking::Correlated,
        multiple_scattering: false,
    }
}

fn gold() -> Fresnel {
    Fresnel::Conductor { n: Vec3::new(0.143, 0.375, 1.442), k: Vec3::new(3.983, 2.386, 1.603) }
}

fn toward(theta: f32, phi: f32) -> Vec3 {
    (theta.sin() * Vec2::from_angle(phi)).extend(theta.cos())
}

/// A square around the middle of a lobe, wider or narrower than it.
fn square(middle: Vec3, width: f32) -> Shape {
    let across = middle.cross(Vec3::Y).normalize();
    Shape::rectangle(middle, -middle, across, Vec2::splat(width)).unwrap()
}

/// Directions drawn half from a rectangle and half from the lobe.
fn brute_force(s: &Surface, wo: Vec3, shape: &Shape) -> Vec3 {
    let Shape::Rectangle { center, across, up } = *shape else { return Vec3::ZERO };
    const COUNT: u32 = 1 << 14;
    let area = 4.0 * across.length() * up.length();
    let normal = across.cross(up).normalize();
    let density = |wi: Vec3| {
        let t = center.dot(normal) / wi.dot(normal);
        let at = wi * t - center;
        let inside = at.dot(across).abs() <= across.length_squared() && at.dot(up).abs() <= up.length_squared();
        if t > 0.0 && inside { t * t / (wi.dot(normal).abs() * area) } else { 0.0 }
    };
    let (lobe, zero) = (wo, Vec3::ZERO);
    let term = |wi: Vec3| {
        let (of_light, of_lobe) = (density(wi), s.lobe.pdf(lobe, wi, s.alpha));
        if of_light > 0.0 && wi.z > 0.0 {
            (layered::base(s, wo, wi) * wi.z / (of_light + of_lobe)).as_dvec3()
        } else {
            zero.as_dvec3()
        }
    };
    let sum: DVec3 = (0..COUNT)
        .map(|i| {
            let u = sampling::hammersley(i, COUNT);
            let of_light = (center + across * (2.0 * u.x - 1.0) + up * (2.0 * u.y - 1.0)).normalize();
            term(of_light) + s.lobe.sample_wi(wo, s.alpha, u).map_or(DVec3::ZERO, term)
        })
        .sum();
    (sum / f64::from(COUNT)).as_vec3()
}

#[test]
fn the_irradiance_of_a_parallel_rectangle_and_of_a_sphere_is_that_of_closed_forms() {
    // A corner over the point: Howell's catalogue, C-4, for a = b = 1.
    for (a, b) in [(1.0_f32, 1.0_f32), (0.2, 3.0), (10.0, 0.01)] {
        let shape = Shape::rectangle(Vec3::new(0.5 * a, 0.5 * b, 1.0), Vec3::NEG_Z, Vec3::X, Vec2::new(a, b));
        let (x, y) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        let factor = (a / x * (b / x).atan() + b / y * (a / y).atan()) / (2.0 * PI);
        let flux = shape.unwrap().polygon().flux().z / PI;
        assert!((flux / factor - 1.0).abs() < 1e-5, "{a} {b}: {flux} {factor}");
    }
    // A sphere wholly over the horizon: sin^2 of half its angle times the cosine. Twelve sides cost 0.3 %.
    for (radius, tilt) in [(0.01_f32, 0.0_f32), (0.3, 0.5), (0.5, 0.9), (0.9, 0.1), (0.2, 1.3)] {
        let flux = Shape::sphere(toward(tilt, 0.4), radius).unwrap().polygon().flux().z;
        let exact = PI * radius * radius * tilt.cos();
        assert!((flux / exact - 1.0).abs() < 3e-3, "{radius} {tilt}: {flux} {exact}");
    }
}

#[test]
fn the_share_above_the_horizon_is_the_integral_of_the_density() {
    for (theta, alpha) in [(0.0, 0.5), (1.0, 0.3), (1.4, 1.0), (1.3, 0.1)] {
        let lobe = Cosines::new(toward(theta, 0.7), Vec2::new(alpha, 0.6 * alpha), Masking::Correlated);
        let count = 1 << 14;
        let drawn =
            (0..count).filter(|i| lobe.shape(sampling::cosine_hemisphere(sampling::hammersley(*i, count))).z > 0.0);
        let share = drawn.count() as f32 / count as f32;
        assert!((share - lobe.above()).abs() < 2e-3, "{share} {}", lobe.above());
        let w = toward(0.3, 2.0);
        assert!((lobe.shape(lobe.flatten(w)) - w).length() < 1e-5);
    }
}

#[test]
fn light_from_everywhere_returns_the_albedo() {
    for alpha in [1e-3, 0.02, 0.3, 1.0] {
        for theta in [0.0, 0.8, 1.4, 1.55] {
            let (s, wo) = (metal(&WHITE, Vec2::splat(alpha)), toward(theta, 0.3));
            let all = response(&s, wo, &Shape::Everywhere, wo, &Shape::Everywhere, true);
            let albedo = layered::lobe_albedo(&s, wo);
            assert!((all.x / albedo - 1.0).abs() < 2e-3, "{alpha} {theta}: {all} {albedo}");
        }
    }
}

#[test]
fn metal_under_rectangles_is_brute_force_within_a_few_percent_of_the_mean() {
    let fresnel = gold();
    let (mut apart, mut sum) = (0.0, 0.0);
    for roughness in [0.1_f32, 0.2, 0.35, 0.5, 0.7, 1.0] {
        let s = metal(&fresnel, Vec2::splat(roughness * roughness));
        let (mut apart_here, mut sum_here) = (0.0, 0.0);
        for theta in [0.1, 0.6, 1.1] {
            for off in [-0.5, 0.0, 0.3] {
                for width in [0.1, 0.7, 2.5] {
                    let shape = square(toward(theta + off, PI + 0.2), width);
                    let wo = toward(theta, 0.0);
                    let (ours, exact) = (response(&s, wo, &shape, wo, &shape, true), brute_force(&s, wo, &shape));
                    apart_here += (ours - exact).abs().element_sum();
                    sum_here += exact.element_sum();
                }
            }
        }
        assert!(apart_here / sum_here < 0.03, "roughness {roughness}: {}", apart_here / sum_here);
        apart += apart_here;
        sum += sum_here;
    }
    assert!(apart / sum < 0.015, "{}", apart / sum);
}

#[test]
fn the_table_is_what_the_fit_gives() {
    for (node, column, masking) in
        [(0, 12, Masking::Correlated), (9, 17, Masking::Separable), (25, 6, Masking::Correlated)]
    {
        let stored: [f64; 4] = std::array::from_fn(|k| {
            let at = masking as usize * STRIDE as usize + ((node * NODES + column) * NUMBERS) as usize + k;
            f64::from(table()[at])
        });
        let anew = fit::node(node, column, masking, stored.map(|x| x * 1.02));
        let [old, new] = [stored, anew].map(|p| fit::error(node, column, masking, &p));
        assert!((old - new).abs() < 2e-3, "{node} {column}: {stored:?} {anew:?}, errors {old} {new}");
    }
    assert_eq!(table().len(), 2 * STRIDE as usize);
}

#[test]
fn what_has_no_area_is_dark_and_a_point_on_a_light_is_finite() {
    let towards = Vec3::new(0.0, 0.0, 1.0);
    assert_eq!(Shape::rectangle(towards, Vec3::Z, Vec3::X, Vec2::ONE), None);
    assert_eq!(Shape::rectangle(towards, Vec3::NEG_Z, Vec3::X, Vec2::new(1.0, 0.0)), None);
    assert_eq!(Shape::rectangle(Vec3::ZERO, Vec3::NEG_Z, Vec3::X, Vec2::ONE), None);
    assert_eq!(Shape::sphere(towards, 0.0), None);
    assert_eq!(Shape::sphere(Vec3::ZERO, 1.0), Some(Shape::Everywhere));
    let fresnel = gold();
    let shapes = [
        Shape::sphere(towards, 1.0),
        Shape::sphere(towards, 1.0 - 1e-7),
        Shape::sphere(Vec3::NEG_Z, 0.5),
        Shape::sphere(towards, 1e-20),
        Shape::rectangle(towards * 1e-7, Vec3::NEG_Z, Vec3::X, Vec2::ONE),
        Shape::rectangle(Vec3::new(0.5, 0.5, 1e-30), Vec3::NEG_Z, Vec3::X, Vec2::ONE),
        Shape::rectangle(Vec3::X, Vec3::NEG_X, Vec3::Y, Vec2::splat(1e-15)),
        Shape::rectangle(Vec3::X, Vec3::NEG_X, Vec3::Y, Vec2::splat(1e10)),
    ];
    for shape in shapes.into_iter().flatten() {
        for alpha in [0.0, 1e-3, 0.1, 1.0] {
            for wo in [toward(0.0, 0.0), toward(1.2, 1.0), toward(1.56, 3.0)] {
                let s = Surface { metallic: 0.5, coat: 0.5, ..metal(&fresnel, Vec2::splat(alpha)) };
                let value = response(&s, wo, &shape, wo, &shape, true);
                assert!(value.is_finite() && value.min_element() >= 0.0, "{shape:?} {alpha} {wo}: {value}");
                assert!(value.max_element() < 1.2, "{shape:?} {alpha} {wo}: {value}");
            }
        }
    }
}

#[test]
fn a_light_that_is_not_reflected_lights_the_matte_base_alone() {
    let fresnel = gold();
    let (wo, shape) = (toward(0.5, 0.0), square(toward(0.5, PI), 1.0));
    assert_eq!(response(&metal(&fresnel, Vec2::splat(0.1)), wo, &shape, wo, &shape, false), Vec3::ZERO);
    let s = Surface { metallic: 0.0, ..metal(&fresnel, Vec2::splat(0.1)) };
    let [without, with] = [false, true].map(|on| response(&s, wo, &shape, wo, &shape, on).x);
    assert!(without > 0.0 && with > without, "{without} {with}");
}
