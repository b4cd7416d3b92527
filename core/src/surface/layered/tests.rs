use glam::{Vec2, Vec3};

use super::*;
use crate::math::quadrature::GaussLegendre;
use crate::surface::blinn_phong::Variant;
use crate::surface::facts::*;

/// Half metal, half glass over white, under a coat.
fn everything(alpha: Vec2, masking: Masking) -> Surface<'static> {
    Surface {
        base_color: Vec3::ONE,
        metallic: 0.5,
        alpha,
        lobe: Lobe::Ggx,
        fresnel: &WHITE,
        fresnel_mean: Vec3::ONE,
        dielectric_f0: Vec3::splat(0.04),
        dielectric_f90: 1.0,
        coat: 0.7,
        coat_alpha: 0.2,
        masking,
        multiple_scattering: true,
    }
}

#[test]
fn a_surface_of_one_material_is_that_material() {
    let alpha = Vec2::new(0.3, 0.2);
    let (wo, wi) = (direction(40.0, 0.5), direction(50.0, 3.0));
    let bare = Surface { coat: 0.0, ..everything(alpha, Masking::Correlated) };
    let metal = Surface { metallic: 1.0, ..bare };
    let conductor = ggx::Conductor {
        alpha,
        fresnel: &WHITE,
        fresnel_mean: Vec3::ONE,
        masking: bare.masking,
        multiple_scattering: true,
    };
    let expected = conductor.eval(wo, wi) * wi.z;
    assert!(response(&metal, wo, wi, wo, wi).distance(expected) < 1e-6);
    let glass = Surface { metallic: 0.0, ..bare };
    let Surface { dielectric_f0, dielectric_f90, base_color, masking, .. } = bare;
    let expected = dielectric::eval(wo, wi, alpha, dielectric_f0, dielectric_f90, base_color, masking) * wi.z;
    assert!(response(&glass, wo, wi, wo, wi).distance(expected) < 1e-6);
}

#[test]
fn nothing_returns_more_light_than_it_gets() {
    let polar = GaussLegendre::new(96);
    for masking in Masking::ALL {
        // Wide lobes only, which a fixed quadrature resolves.
        for alpha in [Vec2::splat(0.3), Vec2::ONE, Vec2::new(1.0, 0.4)] {
            for metallic in [0.0, 0.5, 1.0] {
                let surface = Surface { metallic, ..everything(alpha, masking) };
                for wo in views(0.3) {
                    let total = smooth_albedo(&polar, 96, |wi| response(&surface, wo, wi, wo, wi).x / wi.z);
                    assert!(total < 1.01 && total > 0.8, "{masking:?} {alpha} {metallic} {wo}: {total}");
                }
            }
        }
    }
}

#[test]
fn the_whole_is_reciprocal_and_finite_also_under_a_tilted_coat() {
    let tilt = crate::math::frame::Frame::new(direction(12.0, 1.0));
    for alpha in [Vec2::splat(0.0), Vec2::splat(0.3), Vec2::new(1.0, 0.05)] {
        for masking in Masking::ALL {
            let surface = everything(alpha, masking);
            assert_reciprocal("layered", |wo, wi| response(&surface, wo, wi, wo, wi) / wi.z);
            assert_finite("layered", |wo, wi| response(&surface, wo, wi, tilt.to_local(wo), tilt.to_local(wi)));
        }
    }
}

/// The same with a power of the cosine.
fn powers(exponent: f32, variant: Variant) -> Surface<'static> {
    let lobe = Lobe::BlinnPhong { exponent, variant };
    Surface { alpha: lobe.alpha(Vec2::ZERO), lobe, ..everything(Vec2::ONE, Masking::Correlated) }
}

#[test]
fn under_a_power_of_the_cosine_nothing_returns_more_light_than_it_gets() {
    let polar = GaussLegendre::new(96);
    for exponent in [0.0, 2.0, 8.0, 32.0] {
        for (metallic, coat) in [(0.0, 0.0), (0.0, 0.7), (0.5, 0.7), (1.0, 0.0)] {
            for variant in [Variant::Exact, Variant::Microfacet] {
                let surface = Surface { metallic, coat, ..powers(exponent, variant) };
                // Between opposite grazing directions microfacets peak without bound, which the nodes miss.
                let least = if variant == Variant::Exact { 0.0 } else { 0.1 };
                for wo in views(0.3).filter(|wo| wo.z > least) {
                    let total = smooth_albedo(&polar, 96, |wi| response(&surface, wo, wi, wo, wi).x / wi.z);
                    // Microfacets without masking reflect more at grazing half vectors than their base is told.
                    let most = if variant == Variant::Exact { 1.01 } else { 1.06 };
                    let least = if metallic == 0.0 && coat == 0.0 { 0.95 } else { 0.0 };
                    assert!(total > least && total < most, "{variant:?} {exponent} {metallic} {coat} {wo}: {total}");
                }
            }
        }
    }
}

#[test]
fn other_lobes_scatter_once_and_are_reciprocal_and_finite() {
    for exponent in [0.0, 8.0, 1e5] {
        for variant in Variant::ALL {
            let surface = powers(exponent, variant);
            let once = Surface { multiple_scattering: false, ..surface };
            let (wo, wi) = (direction(40.0, 0.5), direction(50.0, 3.0));
            assert_eq!(base(&surface, wo, wi), base(&once, wo, wi));
            if variant != Variant::Unnormalized {
                assert_reciprocal("layered", |wo, wi| base(&surface, wo, wi));
            }
            assert_finite("layered", |wo, wi| response(&surface, wo, wi, wo, wi));
        }
    }
}

#[test]
fn an_older_shader_is_its_own_formula() {
    let surface = Surface { metallic: 0.0, coat: 0.0, ..powers(10.0, Variant::Unnormalized) };
    let (wo, wi) = (direction(40.0, 0.5), direction(50.0, 3.0));
    let wm = (wo + wi).normalize();
    let ks = schlick(surface.dielectric_f0, surface.dielectric_f90, wi.dot(wm));
    let expected = surface.base_color * wi.z + ks * wm.z.powi(10);
    assert!((response(&surface, wo, wi, wo, wi) - expected).abs().max_element() < 1e-5);
}
