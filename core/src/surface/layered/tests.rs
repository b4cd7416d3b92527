use glam::{Vec2, Vec3};

use super::*;
use crate::math::quadrature::GaussLegendre;
use crate::surface::facts::*;

/// Half metal, half glass over white, under a coat.
fn everything(alpha: Vec2, masking: Masking) -> Surface<'static> {
    Surface {
        base_color: Vec3::ONE,
        metallic: 0.5,
        alpha,
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
