use std::f64::consts::TAU;

use glam::{DVec3, Vec2, Vec3};

use super::*;
use crate::math::quadrature::GaussLegendre;
use crate::math::sampling::Random;
use crate::math::statistics::SphereGrid;
use crate::surface::facts::*;

/// From matte to the end of the range.
const EXPONENTS: [f32; 9] = [0.0, 0.5, 2.0, 5.0, 8.0, 32.0, 512.0, 1e4, 1e5];
/// Those that promise to be reciprocal and to be bounded.
const RECIPROCAL: [Variant; 3] = [Variant::Exact, Variant::Approximate, Variant::Microfacet];

/// Share of light from everywhere that goes toward `wo` for F = 1, over half vectors, `nodes` a side.
fn integrated(wo: Vec3, exponent: f32, variant: Variant, nodes: usize) -> f64 {
    let (rule, around) = (GaussLegendre::new(nodes), 2 * nodes);
    let wo64 = wo.as_dvec3().normalize();
    let s = f64::from(exponent);
    let mut sum = 0.0;
    for &(v, weight) in rule.nodes() {
        // The share 1 - v^4 of the density cos^(s + 1) lies nearer to the normal; its root crowds nodes at the rim.
        let cos = v.powf(4.0 / (s + 2.0));
        let sin = (-f64::exp_m1(8.0 * v.ln() / (s + 2.0))).sqrt();
        let density = (s + 2.0) / TAU * cos.powf(s + 1.0);
        for j in 0..around {
            let phi = TAU * (j as f64 + 0.5) / around as f64;
            let wm = DVec3::new(sin * phi.cos(), sin * phi.sin(), cos);
            let toward = wo64.dot(wm);
            let wi = (2.0 * toward * wm - wo64).normalize();
            if toward > 0.0 && wi.z > 0.0 {
                let value = f64::from(facet(wo, wi.as_vec3(), exponent, variant).y);
                sum += weight * 4.0 * v.powi(3) * value * wi.z * 4.0 * toward / density / around as f64;
            }
        }
    }
    sum
}

#[test]
fn all_light_returns_at_normal_incidence_and_never_more() {
    for exponent in EXPONENTS {
        // The horizon cuts the lobe at one angle: exact up to there, by the half vectors of lights above it.
        let normal = normal_albedo(exponent, Variant::Exact);
        assert!((normal - 1.0).abs() < 1e-4, "{exponent}: {normal}");
        let mut before = f64::MAX;
        for wo in views(0.3) {
            let total = integrated(wo, exponent, Variant::Exact, 64);
            // The quadrature meets the horizon with a step.
            assert!(total < 1.0 + 3e-3 && total < before + 3e-3, "{exponent} {wo}: {total}");
            before = total;
        }
    }
}

/// Albedo for `wo = n`, where light and half vector lie in one plane: smooth up to the horizon.
fn normal_albedo(exponent: f32, variant: Variant) -> f64 {
    let rule = GaussLegendre::new(64);
    // In cos^(s + 2) of the half vector's angle, from 45 degrees to 0.
    let power = f64::from(exponent) + 2.0;
    rule.integrate((-0.5 * power).exp2(), 1.0, |x| {
        let sin2 = -f64::exp_m1(2.0 * x.ln() / power);
        let cos = x.powf(1.0 / power);
        let wi = DVec3::new(2.0 * sin2.sqrt() * cos, 0.0, 1.0 - 2.0 * sin2);
        let value = f64::from(facet(Vec3::Z, wi.as_vec3(), exponent, variant).y);
        // dwi = 4 cos dwm; dwm = 2 pi dcos, and dx = power cos^(power - 1) dcos.
        value * wi.z * 4.0 * cos * TAU / (power * cos.powf(power - 1.0))
    })
}

#[test]
fn an_exponent_of_zero_is_matte() {
    for wo in views(0.2) {
        let value = facet(wo, direction(70.0, 2.0), 0.0, Variant::Exact).y;
        assert!((value / FRAC_1_PI - 1.0).abs() < 1e-6, "{wo}: {value}");
    }
}

#[test]
fn the_approximate_normaliser_gains_up_to_seven_and_a_half_percent() {
    let gain = |exponent| normal_albedo(exponent, Variant::Approximate);
    assert!((gain(5.0) - 1.068).abs() < 5e-4, "{}", gain(5.0));
    assert!((gain(32.0) - 1.046).abs() < 5e-4, "{}", gain(32.0));
    let worst = (0..100).map(|i| gain(i as f32 * 0.5)).fold(0.0, f64::max);
    assert!((worst - gain(9.0)).abs() < 1e-4 && (worst - 1.075).abs() < 5e-4, "{worst}");
    assert!(gain(0.0) < 1.0 + 1e-4 && gain(1e5) < 1.0 + 1e-3);
}

#[test]
fn microfacets_without_masking_return_no_more_than_they_get() {
    for exponent in EXPONENTS {
        for wo in views(0.3) {
            let total = integrated(wo, exponent, Variant::Microfacet, 64);
            assert!(total < 1.0 + 5e-3, "{exponent} {wo}: {total}");
        }
    }
    // Smooth surfaces keep nearly everything up to the horizon, where the exact variant is dark.
    let slanted = direction(60.0, 0.0);
    assert!(integrated(slanted, 1e4, Variant::Microfacet, 64) > 0.99);
    assert!((integrated(slanted, 1e4, Variant::Exact, 64) - 0.25).abs() < 2e-3);
}

#[test]
fn the_unnormalised_variant_gains_has_no_bound_and_is_one_sided() {
    // 8 pi (1 - 2^(-(n + 2)/2)) / (n + 2) at normal incidence.
    assert!((normal_albedo(5.0, Variant::Unnormalized) - 3.273).abs() < 1e-3);
    assert!((normal_albedo(1e4, Variant::Unnormalized) - 2.513e-3).abs() < 1e-5);
    let value = |wo, wi| facet(wo, wi, 10.0, Variant::Unnormalized).y;
    let (wo, wi) = (direction(10.0, 0.0), direction(89.9, 3.0));
    assert!(value(wo, wi) > 100.0 * value(wi, wo));
    assert!(value(wo, direction(89.99, 3.0)) > 9.0 * value(wo, wi));
    // Times the cosine it is what the older shader adds.
    let wm = (wo + wi).normalize();
    assert!((value(wo, wi) * wi.z / wm.z.powi(10) - 1.0).abs() < 1e-4);
}

#[test]
fn the_brdf_is_reciprocal_where_it_says_so_and_finite() {
    let fresnel = Fresnel::rescaled(Vec3::new(0.2, 1.0, 3.0), Vec3::new(3.0, 2.0, 3.0));
    for exponent in EXPONENTS {
        for variant in RECIPROCAL {
            assert_reciprocal("blinn-phong", |wo, wi| eval(wo, wi, exponent, variant, &fresnel));
        }
    }
    for exponent in EXPONENTS.into_iter().chain([-1.0, 1e30, f32::NAN, f32::INFINITY, f32::NEG_INFINITY]) {
        for variant in Variant::ALL {
            assert_finite("blinn-phong", |wo, wi| eval(wo, wi, exponent, variant, &fresnel));
            assert_finite("density", |wo, wi| Vec3::splat(pdf(wo, wi, exponent, variant)));
        }
    }
}

#[test]
fn the_power_keeps_its_digits_at_large_exponents() {
    for exponent in EXPONENTS {
        for i in 0..200 {
            // Out to eight widths of the lobe.
            let angle = (8.0 * f64::from(alpha(exponent)) * f64::from(i) / 200.0).min(1.5);
            let wm = DVec3::new(0.6 * angle.sin(), -0.8 * angle.sin(), angle.cos());
            let exact = (f64::from(exponent) * angle.cos().ln()).exp();
            let value = f64::from(power(wm.as_vec3(), exponent));
            // Roundings of the direction, which the exponent of e^-32 magnifies.
            assert!((value - exact).abs() <= 2e-5 * exact, "{exponent} {angle}: {value} {exact}");
        }
    }
}

#[test]
fn an_equivalent_width_has_the_peak_of_the_lobe() {
    for exponent in EXPONENTS {
        let width = alpha(exponent);
        let peak = super::super::ggx::distribution(Vec3::Z, Vec2::splat(width));
        assert!((peak / normalizer(exponent, Variant::Microfacet) - 1.0).abs() < 1e-5);
        assert!((super::exponent(width) - exponent).abs() <= 1e-5 * (1.0 + exponent));
    }
}

/// Views from the normal to near the horizon, each at its own azimuth.
fn sampler_views() -> [Vec3; 5] {
    [direction(0.0, 0.0), direction(45.0, 0.7), direction(75.0, 2.0), direction(85.0, 1.0), direction(89.5, 4.0)]
}

#[test]
fn half_vectors_are_drawn_from_their_density() {
    let mut cases = Vec::new();
    for exponent in [0.0, 1.0, 32.0, 1e4, 1e5] {
        let width = f64::from(alpha(exponent));
        cases.push(SamplerCase {
            name: format!("half vectors {exponent}"),
            sample: Box::new(move |u| Some(sample_wm(exponent, u.truncate()))),
            pdf: Box::new(move |wm| 0.5 * FRAC_1_PI * (exponent + 2.0) * power(wm, exponent) * wm.z.max(0.0)),
            grid: if width < 0.2 { SphereGrid::around(Vec3::Z, width) } else { SphereGrid::uniform() },
        });
    }
    assert_samplers(&cases);
}

#[test]
fn directions_are_drawn_from_their_density() {
    let mut cases = Vec::new();
    for (exponent, variant) in [
        (0.0, Variant::Exact),
        (1.0, Variant::Exact),
        (8.0, Variant::Approximate),
        (32.0, Variant::Exact),
        (512.0, Variant::Exact),
        (1e4, Variant::Exact),
        (1.0, Variant::Microfacet),
        (8.0, Variant::Unnormalized),
    ] {
        for wo in sampler_views() {
            cases.push(SamplerCase {
                name: format!("{variant:?} {exponent} {wo}"),
                sample: Box::new(move |u| sample(wo, exponent, variant, &WHITE, u.truncate()).map(|s| s.wi)),
                pdf: Box::new(move |wi| pdf(wo, wi, exponent, variant)),
                grid: lobe_grid(wo, Vec2::splat(alpha(exponent))),
            });
        }
    }
    assert_samplers(&cases);
}

#[test]
fn samples_carry_the_value_and_the_density_of_their_direction() {
    let mut random = Random::new(8);
    for exponent in EXPONENTS {
        for variant in Variant::ALL {
            for wo in views(1.0) {
                for _ in 0..50 {
                    let u = random.point2();
                    if let Some(Sample { wi, value, pdf }) = sample(wo, exponent, variant, &WHITE, u) {
                        assert_eq!(value, eval(wo, wi, exponent, variant, &WHITE));
                        assert_eq!(pdf, super::pdf(wo, wi, exponent, variant));
                        assert!(wi.z > 0.0 && pdf > 0.0 && pdf.is_finite() && (wi.length() - 1.0).abs() < 1e-6);
                    }
                }
                assert_eq!(sample(-wo, exponent, variant, &WHITE, Vec2::splat(0.5)), None);
            }
        }
    }
    for u in [Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON / 2.0), Vec2::new(0.5, 1.0 - f32::EPSILON / 2.0)] {
        for exponent in EXPONENTS {
            let wm = sample_wm(exponent, u);
            assert!(wm.is_finite() && wm.z > 0.0 && (wm.length() - 1.0).abs() < 1e-6, "{exponent} {u}: {wm}");
        }
    }
}

#[test]
fn no_sample_weighs_more_than_a_few() {
    let mut random = Random::new(3);
    for variant in [Variant::Exact, Variant::Microfacet] {
        for exponent in EXPONENTS {
            let mut largest = 0.0f32;
            for wo in views(0.5) {
                for _ in 0..500 {
                    if let Some(s) = sample(wo, exponent, variant, &WHITE, random.point2()) {
                        largest = largest.max(s.value.x * s.wi.z / s.pdf);
                    }
                }
            }
            assert!(largest < 4.0, "{variant:?} {exponent}: {largest}");
        }
    }
}

#[test]
fn the_fitted_albedo_follows_the_integral_within_the_stated_error() {
    for (variant, bound) in [
        (Variant::Exact, 0.016),
        (Variant::Approximate, 0.016),
        (Variant::Microfacet, 0.04),
        (Variant::Unnormalized, 0.12),
    ] {
        let mut worst = 0.0f64;
        for exponent in EXPONENTS.into_iter().chain([0.2, 1.0, 1.5, 3.0, 12.0, 20.0, 100.0, 3000.0]) {
            for mu in [0.0003f32, 0.003, 0.01, 0.03, 0.06, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 0.97, 1.0] {
                let wo = Vec3::new(((1.0 - mu) * (1.0 + mu)).sqrt(), 0.0, mu);
                let truth = integrated(wo, exponent, variant, 128);
                let fitted = f64::from(albedo(mu, exponent, variant));
                worst = worst.max((fitted / truth - 1.0).abs());
            }
        }
        println!("{variant:?}: {worst:.4}");
        assert!(worst < bound + 2e-3, "{variant:?}: {worst}");
    }
}

#[test]
fn the_mean_albedo_is_the_cosine_weighted_integral() {
    let rule = GaussLegendre::new(24);
    for (variant, bound) in [(Variant::Exact, 2e-3), (Variant::Approximate, 2e-3), (Variant::Microfacet, 0.02)] {
        for exponent in EXPONENTS {
            // In the root of the cosine, which crowds the nodes at grazing.
            let mean = rule.integrate(0.0, 1.0, |t| {
                let mu = (t * t) as f32;
                let wo = Vec3::new(((1.0 - mu) * (1.0 + mu)).sqrt(), 0.0, mu);
                4.0 * t.powi(3) * integrated(wo, exponent, variant, 48)
            });
            let stated = f64::from(albedo_mean(exponent, variant));
            assert!((mean - stated).abs() < bound, "{variant:?} {exponent}: {mean} {stated}");
        }
    }
}
