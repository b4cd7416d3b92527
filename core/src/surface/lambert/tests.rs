use glam::Vec3;

use super::*;
use crate::math::statistics::SphereGrid;
use crate::surface::facts::{SamplerCase, assert_samplers};

#[test]
fn the_sampler_draws_from_its_density_and_its_weight_is_the_albedo() {
    let albedo = Vec3::new(0.2, 0.5, 1.0);
    assert_samplers(&[SamplerCase {
        name: "lambert".into(),
        sample: Box::new(move |u| sample(albedo, u.truncate()).map(|s| s.wi)),
        pdf: Box::new(pdf),
        grid: SphereGrid::uniform(),
    }]);
    let s = sample(albedo, Vec2::new(0.3, 0.8)).unwrap();
    assert!((s.value * s.wi.z / s.pdf).distance(albedo) < 1e-6);
}
