use std::sync::Arc;

use glam::UVec2;

use super::*;
use crate::lighting::Drawing;
use crate::lighting::radiance_map::GROUPS;
use crate::reference::{Options, View};
use crate::scene::{Environment, Scene, gallery};

fn settings(given: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(PARAMS);
    for (key, value) in [("points", "3000"), ("paths", "8")].iter().chain(given) {
        settings.set(key, value).unwrap();
    }
    settings
}

fn world(name: &str, change: impl FnOnce(&mut Scene)) -> World {
    let mut scene = gallery::open(name).unwrap();
    change(&mut scene);
    World::new(&Arc::new(scene), Options::default())
}

fn baked(world: &World, settings: &Settings) -> Prepared {
    RadianceMap.prepare(world, settings, &Handle::default()).unwrap()
}

const PIXELS: u32 = 32;

/// Every pixel of the first camera whose first surface is wanted: drawn by the method, and traced.
fn pixels(world: &World, prepared: &Prepared, settings: &Settings, subject: bool) -> Vec<(Vec3, Vec3)> {
    let drawing = Drawing::new(&RadianceMap, world, prepared, settings).unwrap();
    let view = View { camera: world.scene().cameras[0].clone(), size: UVec2::splat(PIXELS), seed: 0 };
    let wanted = |pixel: UVec2| {
        let first = world.sample(&view, pixel, 0).first;
        first.is_some_and(|first| !subject || world.scene().subject.contains(&(first.instance as usize)))
    };
    let all = (0..PIXELS * PIXELS).map(|i| UVec2::new(i % PIXELS, i / PIXELS)).filter(|pixel| wanted(*pixel));
    all.map(|pixel| {
        let mean = |sample: &dyn Fn(u32) -> Vec3, n: u32| (0..n).map(sample).sum::<Vec3>() / n as f32;
        let drawn = mean(&|index| drawing.sample(&view, pixel, index).radiance, 16);
        (drawn, mean(&|index| world.sample(&view, pixel, index).radiance, 64))
    })
    .collect()
}

/// Mean |a - b| over mean b, and mean a over mean b.
fn errors(pixels: &[(Vec3, Vec3)]) -> (f32, f32) {
    assert!(pixels.len() > 50, "{} pixels", pixels.len());
    let sum = |of: &dyn Fn(&(Vec3, Vec3)) -> f32| pixels.iter().map(of).sum::<f32>();
    let traced = sum(&|(_, b)| b.element_sum());
    (sum(&|(a, b)| (*a - *b).abs().element_sum()) / traced, sum(&|(a, _)| a.element_sum()) / traced)
}

#[test]
fn an_even_field_lights_every_surface_evenly() {
    // A white furnace: a ball that reflects all light in light of one radiance is not to be seen.
    let world = world("ball?material=white&roughness=1", |scene| {
        scene.environment = Some(Arc::new(Environment::new("even", 4, 2, vec![Vec3::ONE; 8])));
        scene.lights.clear();
        let subject = scene.subject.clone();
        scene.instances.iter_mut().enumerate().for_each(|(i, instance)| instance.visible = subject.contains(&i));
        for material in &mut scene.materials {
            (material.base_color, material.metallic, material.emission) = (Vec3::ONE, 0.0, Vec3::ZERO);
        }
    });
    for (spread, directions) in [("fibonacci", "64"), ("fibonacci", "18"), ("halton", "18"), ("halton", "64")] {
        let settings = settings(&[("spread", spread), ("directions", directions)]);
        let prepared = baked(&world, &settings);
        let (apart, ratio) = errors(&pixels(&world, &prepared, &settings, true));
        println!("{spread} {directions}: apart {apart}, ratio {ratio}");
        assert!(apart < 0.02 && (ratio - 1.0).abs() < 0.005, "{spread} {directions}: {apart} {ratio}");
    }
}

#[test]
fn light_of_a_room_is_that_of_paths() {
    for (name, most) in [("room?roughness=0.6", 0.12), ("room?material=white&roughness=0.5", 0.1)] {
        let world = world(name, |_| ());
        let settings = settings(&[]);
        let prepared = baked(&world, &settings);
        let (subject, whole) =
            (pixels(&world, &prepared, &settings, true), pixels(&world, &prepared, &settings, false));
        let ((apart, ratio), (all_apart, all_ratio)) = (errors(&subject), errors(&whole));
        println!("{name}: subject {apart} {ratio}, all {all_apart} {all_ratio}");
        assert!(apart < most && (ratio - 1.0).abs() < 0.04, "{name}: {apart} {ratio}");
        assert!(all_apart < 0.2 && (all_ratio - 1.0).abs() < 0.04, "{name}: {all_apart} {all_ratio}");
    }
}

#[test]
fn smooth_metals_trace_rays_to_the_map() {
    let world = world("room?roughness=0", |_| ());
    let settings = settings(&[]);
    let prepared = baked(&world, &settings);
    let (apart, ratio) = errors(&pixels(&world, &prepared, &settings, true));
    println!("{apart} {ratio}");
    assert!(apart < 0.15 && (ratio - 1.0).abs() < 0.05, "{apart} {ratio}");
}

#[test]
fn groups_of_light_add_up_and_are_scaled_without_a_bake() {
    let world = world("room?roughness=0.5", |_| ());
    let of = |given: &[(&str, &str)]| {
        let settings = settings(given);
        let prepared = baked(&world, &settings);
        let sum = |pixels: Vec<(Vec3, Vec3)>| pixels.iter().map(|(a, _)| a.element_sum()).sum::<f32>();
        sum(pixels(&world, &prepared, &settings, true))
    };
    let (all, dark, bright) =
        (of(&[]), of(&[("glow-strength", "0"), ("environment-strength", "0")]), of(&[("glow-strength", "3")]));
    let environment = of(&[("glow-strength", "0")]);
    assert!(dark.abs() < 1e-4 * all, "{dark} {all}");
    assert!((bright - (environment + 3.0 * (all - environment))).abs() < 1e-3 * bright, "{environment} {all} {bright}");
}

#[test]
fn gathered_light_is_that_of_whole_paths_with_less_noise() {
    // A polished ball throws light that paths seldom find.
    let world = world("room?roughness=0.2&material=Cu", |_| ());
    let of = |gather: &str, seed: &str| {
        let settings = settings(&[("points", "1500"), ("gather", gather), ("seed", seed)]);
        let prepared = baked(&world, &settings);
        let map = Map::of(&prepared, &settings).unwrap();
        let floor = (0..400).map(|i| Vec3::new(0.09 * (i % 20) as f32 - 0.85, -0.999, 0.09 * (i / 20) as f32 - 0.85));
        let light = |at: Vec3| map.directions.irradiance(&map.arriving(at, Vec3::Y), Vec3::Y);
        floor.map(light).collect::<Vec<f32>>()
    };
    let sum = |light: &[f32]| light.iter().sum::<f32>();
    let apart = |gather: &str| {
        let [a, b] = ["1", "2"].map(|seed| of(gather, seed));
        let squared: f32 = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum();
        ((squared / a.iter().map(|a| a * a).sum::<f32>()).sqrt(), 0.5 * (sum(&a) + sum(&b)))
    };
    let ((noise, all), (gathered_noise, gathered)) = (apart("0"), apart("1"));
    println!("{noise} {gathered_noise}, {}", gathered / all);
    assert!((gathered / all - 1.0).abs() < 0.02 && gathered_noise < 0.9 * noise, "{noise} {gathered_noise}");
}

#[test]
fn what_frames_make_of_light_does_not_change_a_bake() {
    let world = world("room", |_| ());
    let of = |given: &[(&str, &str)]| {
        let few = [("points", "300"), ("paths", "2"), ("directions", "18")];
        baked(&world, &settings(&[&few, given].concat()))
    };
    assert_eq!(
        of(&[]),
        of(&[("glow-strength", "3"), ("lamps-tint", "0,1,0"), ("filter", "box"), ("trace-below", "0")])
    );
}

#[test]
fn light_is_tinted_without_a_bake() {
    let world = world("room?roughness=0.5", |_| ());
    let settings_of = |given: &[(&str, &str)]| {
        settings(&[&[("points", "1000"), ("paths", "1"), ("environment-strength", "0")], given].concat())
    };
    let prepared = baked(&world, &settings_of(&[]));
    let of = |given: &[(&str, &str)]| {
        let settings = settings_of(given);
        Map::of(&prepared, &settings).unwrap().arriving(Vec3::new(0.3, -0.999, 0.1), Vec3::Y)
    };
    let (white, red) = (of(&[]), of(&[("glow-tint", "1,0,0.5")]));
    assert!(white.iter().any(|light| light.y > 0.0));
    for (white, red) in white.iter().zip(&red) {
        assert!(
            (*red - *white * Vec3::new(1.0, 0.0, 0.5)).abs().max_element() < 1e-4 * white.max_element(),
            "{white} {red}"
        );
    }
}

#[test]
fn a_bake_is_the_same_on_any_number_of_threads_and_ends_when_it_is_told() {
    let world = world("room", |_| ());
    let settings = settings(&[("points", "600"), ("paths", "1")]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| baked(&world, &settings))
    };
    assert_eq!(on(1), on(3));
    let job = Handle::default();
    job.cancel();
    assert_eq!(RadianceMap.prepare(&world, &settings, &job), Err(MethodError::Cancelled));
    let empty = World::new(&Arc::new(Scene::default()), Options::default());
    let error = RadianceMap.prepare(&empty, &settings, &Handle::default()).unwrap_err();
    assert!(error.to_string().contains("no surfaces"), "{error}");
}

#[test]
fn a_map_knows_its_directions_and_what_is_no_map_is_not_used() {
    let world = world("room", |_| ());
    let prepared = baked(&world, &settings(&[("points", "600"), ("paths", "1"), ("directions", "18")]));
    let map = Map::of(&prepared, &settings(&[])).unwrap();
    assert_eq!((map.directions.len(), map.directions.spread()), (18, Spread::Fibonacci));
    assert!(Map::of(&Prepared::nothing(), &settings(&[])).is_none());
    let many = Prepared::nothing().with("directions", vec![0, u32::MAX]);
    assert!(Map::of(&many, &settings(&[])).is_none(), "more directions than any bake has");
    // Cut short.
    let cut = prepared.halves(GROUPS[2])[3..].to_vec();
    assert!(Map::of(&Prepared::nothing().with(GROUPS[2], cut), &settings(&[])).is_none());
    // Places that are not there, in an array of the right size.
    let mut arrays = prepared.flat();
    for (name, array) in &mut arrays {
        if name == "neighbours" {
            *array = crate::file::Array::U32(vec![u32::MAX - 9; prepared.whole("neighbours").len()]);
        }
    }
    let hostile = Prepared::of_flat(arrays).unwrap();
    let map = Map::of(&hostile, &settings(&[])).unwrap();
    assert!(map.arriving(Vec3::new(0.0, -1.0, 0.0), Vec3::Y).iter().all(|light| light.is_finite()));
    assert_eq!(map.apart(Vec3::new(0.0, -1.0, 0.0), Vec3::Y, Vec3::Y), [Vec3::ZERO; 3]);
}
