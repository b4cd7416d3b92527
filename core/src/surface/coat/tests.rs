use glam::Vec3;

use super::*;
use crate::surface::facts::*;

#[test]
fn what_the_coat_reflects_and_what_passes_it_sum_to_one() {
    let fresnel = crate::surface::fresnel::Fresnel::Rescaled { f0: Vec3::splat(F0) };
    for masking in Masking::ALL {
        for alpha in alphas() {
            for wo in views(0.0) {
                let reflected = sampled_albedo(48, |u| ggx::sample(wo, Vec2::splat(alpha), &fresnel, masking, u));
                let passed = f64::from(transmission(wo, alpha, 1.0, masking));
                assert!((reflected + passed - 1.0).abs() < 0.01, "{alpha} {wo}: {reflected} {passed}");
            }
        }
    }
}

#[test]
fn no_coat_lets_all_light_pass_and_a_smooth_one_reflects_four_percent_of_it() {
    assert_eq!(transmission(direction(70.0, 0.0), 0.3, 0.0, Masking::Correlated), 1.0);
    assert!((transmission(Vec3::Z, 0.0, 1.0, Masking::Correlated) - 0.96).abs() < 1e-4);
}

#[test]
fn the_reflection_is_reciprocal_and_finite() {
    for alpha in [0.0, 0.1, 1.0] {
        for masking in Masking::ALL {
            assert_reciprocal("coat", |wo, wi| Vec3::splat(eval(wo, wi, alpha, masking)));
            assert_finite("coat", |wo, wi| Vec3::splat(eval(wo, wi, alpha, masking)));
            assert_finite("passed", |wo, _| Vec3::splat(transmission(wo, alpha, 1.0, masking)));
        }
    }
}
