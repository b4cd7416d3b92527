//! Facts of the classical method.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::*;
use crate::lighting::prepared::key;
use crate::math::frame::Frame;
use crate::scene::{Environment, gallery};
use crate::surface::blinn_phong::{self, Variant};
use crate::surface::ggx::albedo::schlick_ratio;
use crate::surface::layered::{Lobe, Surface};

const WHITE_METAL: Fresnel = Fresnel::Rescaled { f0: Vec3::ONE };

fn metal(fresnel: &Fresnel, alpha: Vec2) -> Surface<'_> {
    Surface {
        base_color: Vec3::ONE,
        metallic: 1.0,
        alpha,
        lobe: Lobe::Ggx,
        fresnel_mean: fresnel.mean(),
        fresnel,
        dielectric_f0: Vec3::splat(0.04),
        dielectric_f90: 1.0,
        coat: 0.0,
        coat_alpha: 1e-3,
        masking: Masking::Correlated,
        multiple_scattering: true,
    }
}

fn shade(s: &Surface, cos: f32, samples: u32) -> Vec3 {
    let frame = Frame::new(Vec3::Y);
    let to_viewer = frame.to_world(Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos));
    let lobes = Lobes { samples, rotation: Vec2::new(0.3, 0.7) };
    environment(&Constant(1.0), s, MeanFresnel::Schlick, &frame, &frame, to_viewer, 1.0, lobes)
}

/// Table error of the albedo (1e-3) and, when sampled, what 256 points leave of the integral.
const FURNACE: f32 = 0.01;

#[test]
fn a_white_metal_vanishes_in_a_white_environment() {
    for samples in [0, 256] {
        for roughness in [0.1_f32, 0.3, 0.5, 0.7, 0.9, 1.0] {
            for cos in [1.0, 0.7, 0.4, 0.15] {
                let s = metal(&WHITE_METAL, Vec2::splat(roughness * roughness));
                let value = shade(&s, cos, samples);
                assert!((value - 1.0).abs().max_element() < FURNACE, "{value} at {roughness}, {cos}, {samples}");
            }
        }
    }
}

#[test]
fn a_white_dielectric_under_a_coat_reflects_no_more_than_it_gets() {
    for samples in [0, 64] {
        for cos in [1.0, 0.5, 0.1] {
            let s = Surface { metallic: 0.0, coat: 1.0, ..metal(&WHITE_METAL, Vec2::splat(0.25)) };
            let value = shade(&s, cos, samples).max_element();
            assert!((0.5..=1.01).contains(&value), "{value} at {cos}, {samples}");
        }
    }
}

#[test]
fn levels_and_roughness_are_inverse_to_each_other() {
    for i in 0..6 {
        let level_back = level(roughness(i as f32, 6.0), 6.0);
        assert!((level_back - i as f32).abs() < 1e-5);
    }
    assert_eq!(roughness(5.0, 6.0), 1.0);
}

#[test]
fn the_table_of_a_rescaled_curve_equals_its_closed_form() {
    let f0 = Vec3::new(0.9, 0.6, 0.3);
    let table = mean_fresnel_table(&Fresnel::Rescaled { f0 }, Masking::Correlated);
    let (width, height) = (ALBEDO_MU as usize, ALBEDO_ALPHA as usize);
    for j in [0, height / 3, height - 1] {
        for i in [width / 8, width / 2, width - 1] {
            let x = i as f32 / (width - 1) as f32;
            let y = j as f32 / (height - 1) as f32;
            let alpha = (ALBEDO_ROOT_MIN + y * (1.0 - ALBEDO_ROOT_MIN)).powi(4);
            let expected = f0.lerp(
                Vec3::ONE,
                schlick_ratio(Vec3::new((1.0 - x.powi(4)).sqrt(), 0.0, x * x), Vec2::splat(alpha), Masking::Correlated),
            );
            let at = |c: usize| table[(c * height + j) * width + i];
            let got = Vec3::new(at(0), at(1), at(2));
            assert!((got - expected).abs().max_element() < 2e-3, "{got} for {expected} at {i}, {j}");
        }
    }
}

/// A map that is bright on one side: `radiance = 1 + d.x`.
fn tilted() -> Environment {
    let map = Environment::new("tilted", 256, 128, Vec::new());
    let texel = |i: usize| {
        let uv = Vec2::new(((i % 256) as f32 + 0.5) / 256.0, ((i / 256) as f32 + 0.5) / 128.0);
        Vec3::splat(1.0 + map.direction_from_uv(uv).x)
    };
    Environment { texels: (0..256 * 128).map(texel).collect(), ..map.clone() }
}

/// The same radiance from everywhere.
struct Constant(f32);

impl Maps for Constant {
    fn radiance(&self, _: Vec3, _: f32) -> Vec3 {
        Vec3::splat(self.0)
    }
    fn dimmed(&self, direction: Vec3, level: f32) -> Vec3 {
        self.radiance(direction, level)
    }
    fn source_count(&self) -> usize {
        0
    }
    fn source(&self, _: usize) -> Source {
        Source { direction: Vec3::Y, power: Vec3::ZERO }
    }
    fn wide_alpha(&self) -> f32 {
        0.02
    }
    fn prefiltered(&self, _: Vec3, _: f32) -> Vec3 {
        Vec3::splat(self.0)
    }
    fn irradiance(&self, _: Vec3) -> Vec3 {
        Vec3::splat(self.0 * std::f32::consts::PI)
    }
    fn radiance_levels(&self) -> f32 {
        9.0
    }
    fn prefiltered_levels(&self) -> f32 {
        6.0
    }
}

/// `1 + d.x` as formula.
struct Tilted;

impl Maps for Tilted {
    fn radiance(&self, direction: Vec3, _: f32) -> Vec3 {
        Vec3::splat(1.0 + direction.x)
    }
    fn dimmed(&self, direction: Vec3, level: f32) -> Vec3 {
        self.radiance(direction, level)
    }
    fn source_count(&self) -> usize {
        0
    }
    fn source(&self, _: usize) -> Source {
        Source { direction: Vec3::Y, power: Vec3::ZERO }
    }
    fn wide_alpha(&self) -> f32 {
        0.02
    }
    fn prefiltered(&self, _: Vec3, _: f32) -> Vec3 {
        Vec3::ZERO
    }
    fn irradiance(&self, _: Vec3) -> Vec3 {
        Vec3::ZERO
    }
    fn radiance_levels(&self) -> f32 {
        9.0
    }
    fn prefiltered_levels(&self) -> f32 {
        6.0
    }
}

#[test]
fn prefiltering_agrees_with_the_exact_integral() {
    let map = tilted();
    let texels = exact::Texels::new(&map);
    for alpha in [0.05, 0.2, 0.6, 1.0] {
        for normal in [Vec3::X, Vec3::NEG_X, Vec3::new(0.6, 0.8, 0.0)] {
            let exact = texels.prefiltered(normal, alpha).x;
            let got = f64::from(
                prefilter((|d, l| Tilted.radiance(d, l), Tilted.radiance_levels()), normal, alpha, 2048, &[]).x,
            );
            // The map of 256 texels interpolates a sine: 1e-4; 2048 points of the lobe: 1e-3.
            assert!((got - exact).abs() < 3e-3, "{got} for {exact} at alpha {alpha}, {normal}");
        }
    }
}

#[test]
fn a_source_split_off_filters_like_the_map_it_came_from() {
    let mut map = Environment::new("sun", 256, 128, vec![Vec3::splat(0.25); 256 * 128]);
    let sun = 40 * 256 + 70;
    std::sync::Arc::make_mut(&mut map.texels)[sun] = Vec3::new(5000.0, 4000.0, 3000.0);
    let split = split(&map, 1, 256);
    assert_eq!(split.sources.len(), 1);
    assert!((split.dimmed.texels[sun].x - 0.25).abs() < 1e-6);
    let texels = exact::Texels::new(&map);
    let toward = map.texel_direction(70, 40, Vec2::splat(0.5));
    for alpha in [0.2, 0.5, 1.0] {
        let normal = (toward + Vec3::new(0.2, 0.1, 0.0)).normalize();
        let exact = texels.prefiltered(normal, alpha);
        let got =
            prefilter((|_, _| Vec3::splat(0.25), Constant(0.25).radiance_levels()), normal, alpha, 512, &split.sources)
                .as_dvec3();
        // The sun is a point here and a texel of 0.025 rad there: 2nd order in its size over the lobe's width.
        assert!(((got - exact).abs() / exact).max_element() < 0.01, "{got} for {exact} at alpha {alpha}");
    }
}

#[test]
fn the_two_parts_of_a_split_sum_to_the_map() {
    let texels = (0..64 * 32).map(|i| Vec3::new((i % 7) as f32, (i % 11) as f32 * 3.0, (i % 501) as f32)).collect();
    let map = Environment::new("parts", 64, 32, texels);
    let total = |map: &Environment| -> Vec3 {
        let row = |y: u32| (0..map.width).map(move |x| map.texels[(y * map.width + x) as usize]).sum::<Vec3>();
        (0..map.height).map(|y| row(y) * map.texel_solid_angle(y) as f32).sum()
    };
    for block in [1, 3, 4] {
        let split = split(&map, block, 100);
        assert!(split.sources.len() <= 100);
        let sum = total(&split.dimmed) + split.sources.iter().map(|s| s.power).sum::<Vec3>();
        assert!(((sum - total(&map)) / total(&map)).abs().max_element() < 1e-5, "blocks of {block}");
    }
}

#[test]
fn both_ways_to_the_exact_reflection_agree() {
    let map = tilted();
    let texels = exact::Texels::new(&map);
    let to_viewer = Vec3::new(0.3, 0.9, 0.3).normalize();
    let narrow = texels.reflected(Vec3::Y, to_viewer, 0.122, Masking::Separable).x;
    let wide = texels.reflected(Vec3::Y, to_viewer, 0.123, Masking::Separable).x;
    // 5 texels of 2 pi / 256 are 0.1227. Across it the lobe changes by 1e-3 of its width; texel sums carry 1 % of it at this map's size.
    assert!((narrow - wide).abs() < 0.01 * wide, "{narrow} {wide}");
}

#[test]
fn settings_are_read_from_their_declaration() {
    let mut settings = Settings::new(PARAMS);
    assert_eq!(FrameSettings::new(&settings).samples, 16);
    settings.set("samples", "64").unwrap();
    settings.set("masking", "separable").unwrap();
    settings.set("multiple-scattering", "off").unwrap();
    let read = FrameSettings::new(&settings);
    let expected = FrameSettings { samples: 64, masking: Masking::Separable, multiple_scattering: false, ..read };
    assert_eq!(read, expected);
}

#[test]
fn a_power_of_the_cosine_returns_its_albedo_from_a_white_environment() {
    for variant in Variant::ALL {
        for exponent in [0.0, 5.0, 32.0, 512.0, 1e4] {
            let lobe = Lobe::BlinnPhong { exponent, variant };
            let s = Surface { lobe, ..metal(&WHITE_METAL, lobe.alpha(Vec2::ZERO)) };
            for cos in [1.0, 0.7, 0.4, 0.15] {
                let expected = blinn_phong::albedo(cos, exponent, variant);
                // 1024 points of a lobe that the horizon cuts; the fits of `albedo` are within 1.6, 4 and 12 %.
                let bound = if variant == Variant::Unnormalized { 0.14 } else { 0.05 };
                for samples in [0, 1024] {
                    let value = shade(&s, cos, samples).x;
                    assert!((value / expected - 1.0).abs() < bound, "{value} {expected} at {lobe:?}, {cos}, {samples}");
                }
            }
        }
    }
}

#[test]
fn what_is_prepared_depends_on_the_map_alone() {
    let mut scene = gallery::open("ball").unwrap();
    scene.environment = Some(Arc::new(tilted()));
    let settings = Settings::new(PARAMS);
    let before = key(&Classical, &settings, &scene);
    let mut other = settings.clone();
    other.set("fresnel", "spectral").unwrap();
    scene.materials[0].roughness = 0.9;
    let map = Environment { rotation: 1.0, strength: 3.0, ..tilted() };
    scene.environment = Some(Arc::new(map.clone()));
    assert_eq!(key(&Classical, &other, &scene), before);
    let texels = map.texels.iter().map(|texel| 2.0 * texel).collect();
    scene.environment = Some(Arc::new(Environment { texels, ..map }));
    assert_ne!(key(&Classical, &settings, &scene), before);
}
