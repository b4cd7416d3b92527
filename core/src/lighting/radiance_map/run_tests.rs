use std::path::PathBuf;
use std::sync::Arc;

use super::*;
use crate::file::testing::Folder;
use crate::lighting::bakes::Bake;
use crate::lighting::radiance_map::{BLOCK, PARAMS, average, merge, whole};
use crate::math::sampling::Random;
use crate::reference::Options;
use crate::scene::gallery;

const POINTS: u32 = 11 * BLOCK + 7;

fn settings(given: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(PARAMS);
    let points = POINTS.to_string();
    for (key, value) in [("points", points.as_str()), ("directions", "16"), ("paths", "1")].iter().chain(given) {
        settings.set(key, value).unwrap();
    }
    settings
}

fn world() -> World {
    World::new(&Arc::new(gallery::open("room").unwrap()), Options::default())
}

fn baked(world: &World, settings: &Settings, shard: [u32; 2]) -> Shard {
    run(world, settings, shard, None, |_| (), &Handle::default()).unwrap()
}

fn bytes(bake: &Bake, folder: &Folder) -> Vec<u8> {
    let path = folder.join("whole.bake");
    bake.write(&path).unwrap();
    assert_eq!(&Bake::read(&path).unwrap(), bake);
    std::fs::read(path).unwrap()
}

#[test]
fn shards_in_any_order_are_the_whole_bit_by_bit() {
    let (world, settings, folder) = (world(), settings(&[("denser", "0.4")]), Folder::new());
    let alone = baked(&world, &settings, [1, 1]);
    let expected = bytes(&whole(&alone.about, &alone.blocks).unwrap(), &folder);
    for of in [1, 3, 8] {
        let mut files: Vec<(PathBuf, Shard)> = Vec::new();
        for which in 1..=of {
            let path = folder.join(format!("{which}.shard"));
            baked(&world, &settings, [which, of]).write(&path).unwrap();
            files.push((path.clone(), Shard::read(&path).unwrap()));
        }
        for turn in 0..of {
            files.rotate_left(1);
            if turn % 2 == 1 {
                files.reverse();
            }
            assert!(bytes(&merge(&files).unwrap(), &folder) == expected, "{of} shards, {turn}");
        }
    }
}

#[test]
fn an_interrupted_bake_goes_on_to_the_same_bytes() {
    let (world, settings, folder) = (world(), settings(&[]), Folder::new());
    let expected = baked(&world, &settings, [1, 1]);
    let path = folder.join("part");
    let mut interruptions = 0;
    let mut begun = None;
    let found = loop {
        let job = Handle::default();
        let keep = |shard: &Shard| {
            shard.write(&path).unwrap();
            // After every group of blocks.
            job.cancel();
        };
        match run(&world, &settings, [1, 1], begun.take(), keep, &job) {
            Ok(found) => break found,
            Err(error) => assert_eq!(error, MethodError::Cancelled),
        }
        interruptions += 1;
        assert!(interruptions < 20);
        begun = Some(Shard::read(&path).unwrap());
    };
    assert!(interruptions >= 1 && found == expected, "{interruptions}");
    // What is of something else is not gone on with.
    let other = baked(&world, &self::settings(&[("seed", "7")]), [1, 1]);
    assert_eq!(run(&world, &settings, [1, 1], Some(other), |_| (), &Handle::default()).unwrap(), expected);
}

#[test]
fn every_damage_of_a_shard_is_found() {
    let (world, folder) = (world(), Folder::new());
    let small = settings(&[("points", "300")]);
    let path = folder.join("x.shard");
    baked(&world, &small, [1, 1]).write(&path).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let mut random = Random::new(77);
    let mut number = |below: usize| ((random.unit() * below as f32) as usize).min(below - 1);
    for trial in 0..200 {
        let mut damaged = whole.clone();
        match trial % 4 {
            0 => damaged[number(whole.len())] ^= 1 << number(8),
            1 => damaged.truncate(number(whole.len())),
            2 => damaged.insert(number(whole.len()), 0),
            _ => {
                let (from, to) = (number(whole.len() - 64), number(whole.len() - 64));
                if whole[from..from + 64] == whole[to..to + 64] {
                    continue;
                }
                damaged.copy_within(from..from + 64, to);
            }
        }
        std::fs::write(&path, damaged).unwrap();
        let error = Shard::read(&path).unwrap_err().to_string();
        assert!(error.contains("x.shard"), "{trial}: {error}");
    }
}

#[test]
fn what_does_not_belong_together_is_refused_by_name() {
    let world = world();
    let part = |name: &str, which: u32, given: &[(&str, &str)]| {
        (PathBuf::from(name), baked(&world, &settings(given), [which, 3]))
    };
    let (a, b, c) = (part("a", 1, &[]), part("b", 2, &[]), part("c", 3, &[]));
    let words = |files: &[(PathBuf, Shard)]| -> String {
        merge(files).unwrap_err().iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert!(merge(&[c.clone(), a.clone(), b.clone()]).is_ok());
    let foreign = part("foreign", 2, &[("seed", "9")]);
    let error = words(&[a.clone(), foreign, c.clone()]);
    assert!(error.contains("foreign: is of another bake than a: seed differ"), "{error}");
    let error = words(&[a.clone(), b.clone(), c.clone(), (PathBuf::from("again"), b.1.clone())]);
    assert!(error.contains("again: has block 1, which b has too"), "{error}");
    let error = words(&[a.clone(), c.clone()]);
    assert!(error.contains("lack") && error.contains("2/3"), "{error}");
    let mut cut = b.clone();
    cut.1.blocks.pop();
    let error = words(&[a, cut, c]);
    assert!(error.contains("b: lacks 1 of its blocks") && error.contains("--shard 2/3"), "{error}");
}

#[test]
fn bakes_of_other_seeds_make_a_mean_with_less_noise_and_the_noise_is_known() {
    let world = world();
    let of = |seed: &str| {
        let shard = baked(&world, &settings(&[("seed", seed), ("paths", "8")]), [1, 1]);
        (PathBuf::from(seed), whole(&shard.about, &shard.blocks).unwrap())
    };
    let (one, two, three) = (of("1"), of("2"), of("3"));
    let mean = average(&[one.clone(), two.clone()]).unwrap();
    assert_eq!(mean.about.runs, [[1, 8], [2, 8]]);
    assert_eq!(mean.about.origin.settings["paths"], "16");
    let light = |bake: &Bake| -> Vec<f32> {
        let scale = bake.prepared.floats("glow scale")[0];
        bake.prepared.halves("glow").iter().map(|half| scale * half.to_f32()).collect()
    };
    let (a, b, m) = (light(&one.1), light(&two.1), light(&mean));
    assert_eq!(a.len(), m.len());
    for ((a, b), m) in a.iter().zip(&b).zip(&m) {
        assert!((0.5 * (a + b) - m).abs() <= 1e-3 * (a + b) + 1e-6, "{a} {b} {m}");
    }
    // Irradiance up to a factor, of each place.
    let irradiance = |bake: &Bake| -> Vec<f32> {
        let directions = super::super::settings::baked_directions(&bake.prepared).unwrap();
        let (light, normals) = (light(bake), &bake.prepared);
        let of = |(place, light): (usize, &[f32])| -> f32 {
            let normal = normals.vector("normals", place);
            let cells = light.as_chunks::<3>().0.iter().enumerate();
            cells
                .map(|(k, l)| {
                    directions.solid_angle(k) * directions.get(k).dot(normal).max(0.0) * l.iter().sum::<f32>()
                })
                .sum()
        };
        light.chunks(3 * directions.len()).enumerate().map(of).collect()
    };
    let apart = |a: &Bake, b: &Bake| {
        let (a, b) = (irradiance(a), irradiance(b));
        let squared: f64 = a.iter().zip(&b).map(|(a, b)| f64::from(a - b).powi(2)).sum();
        let whole: f64 = a.iter().zip(&b).map(|(a, b)| f64::from(0.5 * (a + b)).powi(2)).sum();
        (squared / whole).sqrt()
    };
    let (single, of_mean) = (apart(&one.1, &two.1), apart(&mean, &three.1));
    // The difference of two of variance v has 2 v; that of the mean of two and a third 1.5 v.
    assert!((of_mean / single - 0.75f64.sqrt()).abs() < 0.1, "{single} {of_mean}");
    let noise = one.1.about.noise.unwrap();
    println!("noise told {noise}, found {}", single / 2f64.sqrt());
    // Paths of a cell are spread evenly, which halves of them are less: what is told is no less than what there is.
    assert!(noise > 0.9 * single / 2f64.sqrt() && noise < 1.6 * single / 2f64.sqrt(), "{noise} {single}");
    assert!((mean.about.noise.unwrap() - noise / 2f64.sqrt()).abs() < 0.1 * noise);
    let error = average(&[one.clone(), one]).unwrap_err();
    assert!(error[0].to_string().contains("seed 1"), "{}", error[0]);
}

#[test]
fn the_size_of_stale_light_is_told_and_is_nothing_where_nothing_changed() {
    let room = |change: fn(&mut crate::scene::Scene)| {
        let mut scene = gallery::open("room").unwrap();
        // What glows alone lights it.
        (scene.environment, scene.lights) = (None, Vec::new());
        change(&mut scene);
        World::new(&Arc::new(scene), Options::default())
    };
    let directions = asked_directions(&settings(&[("directions", "32")]));
    let same = room(|_| ());
    let of = |now: &World| super::super::bake::age(&same, now, &directions, 3).unwrap();
    assert!(of(&room(|_| ())) < 1e-6);
    // Twice the light: all of it is new once more.
    let bright = of(&room(|scene| dim_by(scene, 1.0, 2.0)));
    assert!((bright - 1.0).abs() < 0.05, "{bright}");
    // Against what many places and paths tell.
    let dark = room(|scene| dim_by(scene, 0.8, 1.0));
    let told = of(&dark);
    let irradiance = |world: &World| {
        // Both with the same paths, whose noise goes out of the difference.
        let given = [("points", "3000"), ("directions", "32"), ("paths", "16"), ("gather", "0")];
        let shard = baked(world, &settings(&given), [1, 1]);
        let prepared = whole(&shard.about, &shard.blocks).unwrap().prepared;
        let light = prepared.halves("glow").to_vec();
        let of = |(place, light): (usize, &[half::f16])| -> f64 {
            let normal = prepared.vector("normals", place);
            let cells = light.as_chunks::<3>().0.iter().enumerate();
            let of = |(k, l): (usize, &[half::f16; 3])| {
                directions.solid_angle(k)
                    * directions.get(k).dot(normal).max(0.0)
                    * l.iter().map(|l| l.to_f32()).sum::<f32>()
            };
            f64::from(cells.map(of).sum::<f32>())
        };
        light.chunks(3 * directions.len()).enumerate().map(of).collect::<Vec<f64>>()
    };
    let (before, after) = (irradiance(&same), irradiance(&dark));
    let squared: f64 = before.iter().zip(&after).map(|(a, b)| (a - b).powi(2)).sum();
    let expected = (squared / before.iter().map(|a| a * a).sum::<f64>()).sqrt() as f32;
    println!("told {told}, found {expected}");
    assert!((told / expected - 1.0).abs() < 0.2, "{told} {expected}");
}

fn dim_by(scene: &mut crate::scene::Scene, factor: f32, glow: f32) {
    for material in &mut scene.materials {
        material.base_color *= factor;
        material.emission *= glow;
    }
}
