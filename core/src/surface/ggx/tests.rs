use std::f64::consts::TAU;

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::albedo::AlbedoTable;
use super::*;
use crate::math::quadrature::GaussLegendre;
use crate::math::sampling::Random;
use crate::math::statistics::SphereGrid;
use crate::surface::facts::*;

const REFERENCE: &str = include_str!("../../../../tests/data/reference/ggx_conductor_mitsuba.csv");
/// The reference carries nine digits of f32 values.
const REFERENCE_ERROR: f32 = 1e-4;
/// Required of the furnace for equal widths.
const FURNACE_ERROR: f64 = 0.01;

/// Widths with every kind of anisotropy.
const ANISOTROPIC: [Vec2; 8] = [
    Vec2::new(0.1, 0.001),
    Vec2::new(0.05, 0.3),
    Vec2::new(0.5, 0.1),
    Vec2::new(1.0, 0.01),
    Vec2::new(0.1, 1.0),
    Vec2::new(1.0, 0.3),
    Vec2::new(0.6, 1.0),
    Vec2::new(0.6, 0.3),
];

/// Single-scattering albedo of white metal in f32.
fn single(wo: Vec3, alpha: Vec2, masking: Masking) -> f64 {
    sampled_albedo(48, |u| sample(wo, alpha, &WHITE, masking, u))
}

/// Integral over all microfacet normals of `f(wm) D(wm)`, in the slopes, where the integrand of `f = cos` is constant.
fn over_normals(alpha: Vec2, f: impl Fn(Vec3) -> f64) -> f64 {
    let (rule, around) = (GaussLegendre::new(64), 128);
    let a: DVec2 = clamp_alpha(alpha).as_dvec2();
    let mut sum = 0.0;
    for &(v, weight) in rule.nodes() {
        // Share of slopes beyond r; by its root, since normals on the rim count as much as others.
        let beyond = v * v;
        let r = ((1.0 - beyond) / beyond).sqrt();
        for j in 0..around {
            let phi = TAU * (j as f64 + 0.5) / around as f64;
            let slope = a * r * DVec2::from_angle(phi);
            let wm = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
            // dw = cos^3 dslope, dslope = at ab r dr dphi, r dr = v dv / beyond^2.
            let measure = wm.z.powi(3) * a.x * a.y * v / beyond.powi(2) * TAU / around as f64;
            sum += weight * measure * f(wm.as_vec3()) * f64::from(distribution(wm.as_vec3(), alpha));
        }
    }
    sum
}

#[test]
fn the_projected_area_of_all_microfacets_is_one() {
    for alpha in alphas().map(Vec2::splat).chain(ANISOTROPIC) {
        let area = over_normals(alpha, |wm| wm.z.into());
        // f32 rounding of normals one floor wide: 6e-8 / 1e-3.
        assert!((area - 1.0).abs() < 1e-4, "{alpha}: {area}");
    }
}

#[test]
fn the_visible_microfacets_fill_the_projected_area_of_the_view() {
    for alpha in [Vec2::splat(0.3), Vec2::ONE, Vec2::new(0.6, 0.3), Vec2::new(0.3, 1.0)] {
        for wo in [direction(0.0, 0.0), direction(45.0, 0.7), direction(80.0, 2.0)] {
            let visible = over_normals(alpha, |wm| (masking(wo, alpha) * wo.dot(wm).max(0.0)).into());
            // The horizon of the view is a kink for the quadrature.
            assert!((visible / f64::from(wo.z) - 1.0).abs() < 3e-3, "{alpha} {wo}: {visible}");
        }
    }
}

#[test]
fn masking_agrees_with_lambda() {
    for alpha in ANISOTROPIC {
        for (wo, wi) in views(0.3).zip(views(2.0)) {
            let (lo, li) = (lambda(wo, alpha), lambda(wi, alpha));
            let close = |a: f32, b: f32| (a - b).abs() <= 1e-5 * b;
            assert!(close(masking(wo, alpha), 1.0 / (1.0 + lo)));
            assert!(close(shadowing_masking(wo, wi, alpha, Masking::Correlated), 1.0 / (1.0 + lo + li)));
            let separable = shadowing_masking(wo, wi, alpha, Masking::Separable);
            assert!(close(separable, 1.0 / ((1.0 + lo) * (1.0 + li))));
            assert!(separable <= 1.000_001 * shadowing_masking(wo, wi, alpha, Masking::Correlated));
        }
    }
}

#[test]
fn value_and_density_meet_mitsubas_rough_conductor() {
    let (mut worst_value, mut worst_pdf, mut rows) = (0.0f32, 0.0f32, 0);
    for line in REFERENCE.lines().skip(1) {
        let x: Vec<f32> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let three = |i: usize| Vec3::new(x[i], x[i + 1], x[i + 2]);
        let fresnel = Fresnel::Conductor { n: three(2), k: three(5) };
        let (alpha, wo, wi) = (Vec2::new(x[0], x[1]), three(8).normalize(), three(11).normalize());
        let value = eval(wo, wi, alpha, &fresnel, Masking::Separable) * wi.z;
        worst_value = worst_value.max(((value - three(14)) / three(14)).abs().max_element());
        worst_pdf = worst_pdf.max((pdf(wo, wi, alpha) / x[17] - 1.0).abs());
        rows += 1;
    }
    println!("{rows} rows, largest relative error: value {worst_value:.1e}, pdf {worst_pdf:.1e}");
    assert!(rows >= 100 && worst_value < REFERENCE_ERROR && worst_pdf < REFERENCE_ERROR);
}

#[test]
fn the_white_furnace_is_one_within_a_percent_at_every_roughness_and_angle() {
    let polar = GaussLegendre::new(48);
    for masking in Masking::ALL {
        let (mut least, mut most) = (f64::MAX, 0.0f64);
        for alpha in alphas().map(Vec2::splat) {
            for wo in views(0.4) {
                let once = single(wo, alpha, masking);
                let more = smooth_albedo(&polar, 1, |wi| multiple(wo, wi, alpha, Vec3::ONE, masking).x);
                assert!(once <= 1.0 + 1e-4, "single scattering gains: {once} at {alpha} {wo}");
                assert!((once + more - 1.0).abs() <= FURNACE_ERROR, "{masking:?} {alpha} {wo}: {once} + {more}");
                least = least.min(once + more);
                most = most.max(once + more);
            }
        }
        println!("{masking:?}: {least:.4} to {most:.4}");
    }
}

#[test]
fn the_white_furnace_of_grooves_hardly_gains_and_loses_a_bounded_share() {
    let polar = GaussLegendre::new(32);
    for masking in Masking::ALL {
        for alpha in ANISOTROPIC {
            let (mut least, mut most) = (f64::MAX, 0.0f64);
            for wo in [0.0, 0.4, 0.8, 1.2, 1.45, 1.57].into_iter().flat_map(views) {
                let total = single(wo, alpha, masking)
                    + smooth_albedo(&polar, 32, |wi| multiple(wo, wi, alpha, Vec3::ONE, masking).x);
                least = least.min(total);
                most = most.max(total);
            }
            println!("{masking:?} {alpha}: {least:.4} to {most:.4}");
            // The table knows the plane of the view and the one across; in between it is an estimate.
            let ratio = alpha.min_element() / alpha.max_element();
            let loss = if ratio >= 0.3 { 0.05 } else { 0.13 };
            // Separable masking hardly depends on the width along, so that the estimate is worst for the finest
            // grooves.
            let gain = if ratio < 0.1 && masking == Masking::Separable { 0.03 } else { FURNACE_ERROR };
            assert!(most <= 1.0 + gain && least >= 1.0 - loss, "{masking:?} {alpha}: {least} {most}");
        }
    }
}

#[test]
fn the_table_follows_a_finer_integration_between_its_nodes() {
    let fine = reflection::Rule::new(160, 96);
    let mut random = Random::new(6);
    let (mut worst_table, mut worst_rule) = (0.0f64, 0.0f64);
    for _ in 0..200 {
        let u = random.point3();
        // Crowded at grazing and at small widths.
        let (mu, alpha) = (u.x * u.x, (0.032 + 0.968 * u.y).powi(2));
        let truth = reflection::loss_with(mu.into(), alpha.into(), alpha.into(), &fine);
        let rough = reflection::loss(mu.into(), alpha.into(), alpha.into());
        for masking in Masking::ALL {
            let loss = 1.0 - f64::from(albedo::albedo(mu, alpha, masking));
            worst_table = worst_table.max((loss - truth[masking as usize]).abs());
            worst_rule = worst_rule.max((rough[masking as usize] - truth[masking as usize]).abs());
        }
    }
    println!("largest error of the loss: table {worst_table:.1e}, integration at a node {worst_rule:.1e}");
    assert!(worst_table < 8e-3 && worst_rule < 3e-3);
}

#[test]
fn the_table_is_complete_and_in_range() {
    let flat = AlbedoTable::get().flat();
    assert_eq!(flat.len(), 2 * albedo::ALBEDO_STRIDE as usize);
    assert!(flat.iter().all(|x| x.is_finite() && *x >= 0.0));
    assert!((albedo::ALBEDO_ROOT_MIN.powi(4) / ALPHA_MIN - 1.0).abs() < 1e-6);
    for masking in Masking::ALL {
        for alpha in [-1.0, 0.0, 0.5, 2.0, f32::NAN] {
            for mu in [-1.0, 0.0, 0.5, 1.0, 2.0] {
                assert!((0.0..=1.0).contains(&albedo::albedo(mu, alpha, masking)), "{mu} {alpha}");
            }
            assert!((0.0..=1.0).contains(&albedo::albedo_mean(alpha, masking)));
        }
    }
}

#[test]
fn tabulated_cosines_give_the_albedo_of_any_curve() {
    let curve = |x: f64| DVec3::new(0.5 + 0.5 * (1.0 - x).powi(5), x, (1.0 - x).powi(5));
    let samples = reflection::sample_curve(|x| curve(x.into()).as_vec3());
    for alpha in [0.001, 0.05, 0.3, 1.0] {
        for mu in [0.0, 0.01, 0.2, 0.7, 1.0] {
            let weights = reflection::CosineWeights::new(mu, alpha);
            for masking in Masking::ALL {
                let direct = reflection::directional_albedo(mu, alpha, masking, curve).as_vec3();
                let tabulated = weights[masking as usize].albedo(&samples);
                // h^2 F'' / 8 of the linear curve.
                assert!(direct.distance(tabulated) < 3e-4, "{alpha} {mu}: {direct} {tabulated}");
                let w = Vec3::new((1.0 - mu * mu).sqrt() as f32, 0.0, mu as f32);
                let ratio = albedo::schlick_ratio(w, Vec2::splat(alpha as f32), masking);
                let e = albedo::albedo(mu as f32, alpha as f32, masking);
                assert!((ratio * e - direct.z).abs() < 6e-3, "{alpha} {mu}: {} {}", ratio * e, direct.z);
            }
        }
    }
}

#[test]
fn the_integrated_albedo_is_that_of_the_f32_brdf() {
    let fresnel = Fresnel::rescaled(Vec3::new(0.2, 1.0, 3.0), Vec3::new(3.0, 2.0, 3.0));
    for alpha in [0.001f32, 0.1, 0.5, 1.0] {
        for wo in views(0.0).step_by(3) {
            for masking in Masking::ALL {
                let truth = reflection::directional_albedo(wo.z.into(), alpha.into(), masking, |x| {
                    fresnel.eval(x as f32).as_dvec3()
                });
                let sampled = sampled_albedo(96, |u| sample(wo, Vec2::splat(alpha), &fresnel, masking, u));
                assert!((truth.x - sampled).abs() < 4e-3, "{alpha} {wo}: {} {sampled}", truth.x);
            }
        }
    }
}

#[test]
fn the_brdf_is_reciprocal_and_finite() {
    let fresnel = Fresnel::rescaled(Vec3::new(0.2, 1.0, 3.0), Vec3::new(3.0, 2.0, 3.0));
    for masking in Masking::ALL {
        for alpha in alphas().step_by(3).map(Vec2::splat).chain(ANISOTROPIC) {
            let metal = Conductor {
                alpha,
                fresnel: &fresnel,
                fresnel_mean: fresnel.mean(),
                masking,
                multiple_scattering: true,
            };
            assert_reciprocal("single", |wo, wi| eval(wo, wi, alpha, &fresnel, masking));
            assert_reciprocal("multiple", |wo, wi| multiple(wo, wi, alpha, Vec3::ONE, masking));
            assert_finite("metal", |wo, wi| metal.eval(wo, wi));
        }
        for alpha in [0.0, -1.0, 1e-30, f32::NAN, f32::INFINITY].map(Vec2::splat) {
            assert_finite("metal", |wo, wi| eval(wo, wi, alpha, &fresnel, masking));
            assert_finite("density", |wo, wi| Vec3::splat(pdf(wo, wi, alpha)));
        }
    }
}

/// Views from the normal to near the horizon, each at its own azimuth.
fn sampler_views() -> [Vec3; 4] {
    [direction(0.0, 0.0), direction(45.0, 0.7), direction(80.0, 2.0), direction(89.5, 4.0)]
}

#[test]
fn visible_normals_are_drawn_from_their_density() {
    let mut cases = Vec::new();
    for alpha in [Vec2::splat(ALPHA_MIN), Vec2::splat(0.3), Vec2::ONE, Vec2::new(0.5, 0.05)] {
        for wo in sampler_views() {
            let grid = if alpha.min_element() < 0.2 {
                SphereGrid::around(Vec3::Z, f64::from(alpha.max_element()))
            } else {
                // Between view and normal: visible normals end at a great circle, which must keep off the pole.
                SphereGrid { axis: (wo + Vec3::Z).normalize(), ..SphereGrid::uniform() }
            };
            cases.push(SamplerCase {
                name: format!("normals {alpha} {wo}"),
                sample: Box::new(move |u| Some(sample_wm(wo, alpha, u.truncate()))),
                pdf: Box::new(move |wm| pdf_wm(wo, wm, alpha)),
                grid,
            });
        }
    }
    assert_samplers(&cases);
}

#[test]
fn reflections_are_drawn_from_their_density() {
    let mut cases = Vec::new();
    let widths = [Vec2::splat(ALPHA_MIN), Vec2::splat(0.1), Vec2::ONE, Vec2::new(0.5, 0.05), Vec2::new(0.02, 0.3)];
    for alpha in widths {
        for wo in sampler_views() {
            cases.push(SamplerCase {
                name: format!("reflection {alpha} {wo}"),
                sample: Box::new(move |u| sample(wo, alpha, &WHITE, Masking::Correlated, u.truncate()).map(|s| s.wi)),
                pdf: Box::new(move |wi| pdf(wo, wi, alpha)),
                grid: lobe_grid(wo, alpha),
            });
        }
    }
    assert_samplers(&cases);
}

#[test]
fn the_whole_metal_is_drawn_from_its_density() {
    let mut cases = Vec::new();
    for alpha in [Vec2::splat(0.3), Vec2::ONE, Vec2::new(0.3, 1.0)] {
        for wo in [direction(20.0, 1.0), direction(85.0, 3.0)] {
            let metal = Conductor {
                alpha,
                fresnel: &WHITE,
                fresnel_mean: Vec3::ONE,
                masking: Masking::Separable,
                multiple_scattering: true,
            };
            cases.push(SamplerCase {
                name: format!("metal {alpha} {wo}"),
                sample: Box::new(move |u| metal.sample(wo, u).map(|s| s.wi)),
                pdf: Box::new(move |wi| metal.pdf(wo, wi)),
                grid: lobe_grid(wo, alpha),
            });
        }
    }
    assert_samplers(&cases);
}

#[test]
fn samples_carry_the_value_and_the_density_of_their_direction() {
    let mut random = Random::new(8);
    let metal = Conductor {
        alpha: Vec2::new(0.2, 0.4),
        fresnel: &WHITE,
        fresnel_mean: Vec3::ONE,
        masking: Masking::Correlated,
        multiple_scattering: true,
    };
    for wo in views(1.0) {
        for _ in 0..200 {
            if let Some(Sample { wi, value, pdf }) = metal.sample(wo, random.point3()) {
                assert_eq!((value, pdf), (metal.eval(wo, wi), metal.pdf(wo, wi)));
                assert!(pdf > 0.0 && pdf.is_finite() && (wi.length() - 1.0).abs() < 1e-6);
            }
        }
        assert_eq!(metal.sample(-wo, Vec3::splat(0.5)), None);
    }
}
