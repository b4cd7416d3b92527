//! Every sampler of a surface draws from the density that it claims.

use glam::Vec3;

use super::super::bsdf::Bsdf;
use super::super::point::Point;
use super::super::waves::Waves;
use super::*;
use crate::material::ReflectionModel;
use crate::math::sampling::Random;
use crate::math::statistics::{SphereGrid, sidak, sphere_chi_square};
use crate::scene::gallery::shape;
use crate::surface::blinn_phong::Variant;
use crate::trace::{Accel, Ray};

/// The materials, and how wide their narrowest lobe is.
fn cases() -> Vec<(&'static str, Material, f32)> {
    let metal = |roughness| even_metal(Vec3::new(0.9, 0.6, 0.3), roughness);
    let power = |exponent, variant| Material {
        reflection_model: ReflectionModel::BlinnPhong(variant),
        exponent,
        ..Material::default()
    };
    let dull = power(32.0, Variant::Exact);
    vec![
        ("matte", matte(Vec3::splat(0.5)), 1.0),
        ("metal", metal(0.5), 1.0),
        ("smooth metal", metal(0.2), 0.04),
        ("brushed metal", Material { anisotropy: 0.7, anisotropy_rotation: 0.6, ..metal(0.4) }, 1.0),
        ("plastic", Material { roughness: 0.5, ..Material::default() }, 1.0),
        ("mixed", Material { metallic: 0.4, roughness: 0.6, base_color: Vec3::splat(0.5), ..Material::default() }, 1.0),
        ("coated", Material { coat: 0.7, coat_roughness: 0.5, ..metal(0.7) }, 1.0),
        ("power of the cosine", Material { exponent: 5.0, metallic: 1.0, ..dull.clone() }, 1.0),
        ("high power", Material { exponent: 1000.0, metallic: 1.0, ..dull.clone() }, 0.04),
        ("plastic by a power", dull.clone(), 1.0),
        ("coated power", Material { coat: 0.5, coat_roughness: 0.5, metallic: 0.7, ..dull }, 1.0),
        ("microfacets by a power", Material { metallic: 1.0, ..power(20.0, Variant::Microfacet) }, 1.0),
        ("older shader", power(20.0, Variant::Unnormalized), 1.0),
        ("coated plastic", Material { coat: 1.0, coat_roughness: 0.4, roughness: 0.8, ..Material::default() }, 1.0),
    ]
}

#[test]
fn directions_of_whole_surfaces_follow_their_density() {
    let views = [Vec3::new(0.1, 0.2, 1.0), Vec3::new(-0.8, 0.4, 0.5), Vec3::new(0.3, -1.0, 0.08)];
    let cases = cases();
    let level = sidak(0.01, cases.len() * views.len());
    for (name, material, width) in cases {
        let scene = Arc::new(scene([(shape::plane(2.0, 2.0), Material { double_sided: true, ..material })]));
        let world = World::new(&scene, Options::default());
        for (seed, view) in views.into_iter().enumerate() {
            let wo = view.normalize();
            let ray = Ray { origin: wo, direction: -wo, t_max: f32::INFINITY };
            let hit = Accel::new(&scene).closest(&ray, |_| true).unwrap();
            let point = Point::new(&world, &hit, wo, Waves::Rgb);
            let bsdf = Bsdf::new(&world, &point, wo);
            let grid = match width < 0.1 {
                true => SphereGrid::around(Vec3::new(-wo.x, -wo.y, wo.z), f64::from(width)),
                false => SphereGrid::uniform(),
            };
            let mut random = Random::new(70 + seed as u64);
            let draw = || bsdf.sample(random.point3()).map(|sample| sample.wi);
            let test = sphere_chi_square(grid, 500_000, &|w| f64::from(bsdf.eval(w).1), draw);
            println!("{name} {view}: p {:.4}, mass {:.5}, {} cells", test.p_value, test.mass, test.degrees + 1);
            assert!(test.p_value > level && test.mass < 1.001 && test.degrees > 20, "{name} {view}: {test:?}");
        }
    }
}

#[test]
fn the_weight_of_a_direction_is_response_over_density() {
    for (name, material, _) in cases() {
        let scene = Arc::new(scene([(shape::plane(2.0, 2.0), Material { double_sided: true, ..material })]));
        let world = World::new(&scene, Options::default());
        let wo = Vec3::new(0.5, 0.3, 0.7).normalize();
        let ray = Ray { origin: wo, direction: -wo, t_max: f32::INFINITY };
        let hit = Accel::new(&scene).closest(&ray, |_| true).unwrap();
        let point = Point::new(&world, &hit, wo, Waves::Rgb);
        let bsdf = Bsdf::new(&world, &point, wo);
        let mut random = Random::new(3);
        for _ in 0..1000 {
            let Some(sample) = bsdf.sample(random.point3()) else { continue };
            let (value, pdf) = bsdf.eval(sample.wi);
            assert!((sample.pdf - pdf).abs() <= 1e-5 * pdf, "{name}");
            assert!((value - sample.weight * pdf).abs().max_element() <= 1e-5 * value.max_element(), "{name}");
            // No lobe is drawn far too seldom.
            assert!(sample.weight.max_element() < 4.0, "{name}: {}", sample.weight);
        }
    }
}
