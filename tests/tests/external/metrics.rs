//! Our error measures against numpy and the published FLIP.
//!
//! Needs a Python with the packages `flip-evaluator` and `numpy`: that of `BURNISH_PYTHON`, else `python3`.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;

use burnish_core::math::sampling::Random;
use burnish_core::measure::{Errors, errors};
use burnish_core::picture::Picture;
use burnish_core::reference::{self, Control, Film, Pass, World};
use burnish_core::scene::gallery;
use burnish_tests::{Need, flip_python, scratch_folder, trial};
use glam::{UVec2, Vec3, Vec4};
use libtest_mimic::Trial;
use serde_json::{Value, json};

/// Largest difference of a measure, relative where it is above 1e-4.
const TOLERANCE: f64 = 1e-3;

pub fn trial_of_metrics() -> Trial {
    trial("numpy and the published FLIP find the same errors", &[Need::Flip], same_errors)
}

struct Pair {
    name: &'static str,
    reference: Picture,
    picture: Picture,
    exposure_ev: f32,
}

fn same_errors() {
    let folder = scratch_folder("metrics");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/external/metrics.py");
    let mut command = Command::new(flip_python().expect("a Python with flip-evaluator"));
    let mut child = command.arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("Python starts");
    let pairs = pairs();
    assert_eq!(pairs.len(), 10);
    {
        let mut requests = child.stdin.take().expect("its input");
        for (i, pair) in pairs.iter().enumerate() {
            let file = |picture: &Picture, which: &str| {
                let path = folder.join(format!("{i}-{which}"));
                let floats = picture.texels.iter().flat_map(|t| t.truncate().to_array());
                std::fs::write(&path, floats.flat_map(f32::to_le_bytes).collect::<Vec<u8>>()).expect("a file");
                path
            };
            let request = json!({
                "width": pair.reference.width,
                "height": pair.reference.height,
                "reference": file(&pair.reference, "reference"),
                "picture": file(&pair.picture, "picture"),
                "exposure": pair.exposure_ev,
            });
            writeln!(requests, "{request}").expect("Python listens");
        }
    }
    let output = child.wait_with_output().expect("Python ends");
    let answers: Vec<Value> = String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}")))
        .collect();
    assert_eq!(answers.len(), pairs.len(), "Python stopped early");
    let mut worst = 0.0_f64;
    for (pair, answer) in pairs.iter().zip(&answers) {
        let all = vec![true; pair.reference.texels.len()];
        let found = errors(&pair.reference, &pair.picture, pair.exposure_ev, &[&all]).expect("errors");
        let Errors { relmse, flip, flip_p99, bias, difference, worst: most } = found[0].expect("pixels");
        let ours = [
            ("relmse", relmse),
            ("flip", flip),
            ("flip_p99", flip_p99),
            ("bias", bias),
            ("difference", difference),
            ("worst", most),
        ];
        for (measure, ours) in ours {
            let theirs = answer[measure].as_f64().unwrap_or(f64::NAN);
            let apart = (ours - theirs).abs() / theirs.abs().max(1e-4);
            worst = worst.max(apart);
            assert!(apart <= TOLERANCE, "{}: {measure}: {ours} here, {theirs} there", pair.name);
        }
        println!("{}: relMSE {relmse:.5}, FLIP {flip:.5}", pair.name);
    }
    println!("largest difference {worst:.1e}");
}

fn pairs() -> Vec<Pair> {
    let pair = |name, reference, picture, exposure_ev| Pair { name, reference, picture, exposure_ev };
    let (few, many) = (traced("gallery:workbench", 2, 1), traced("gallery:workbench", 64, 0));
    let noise = noisy(7, 97, 61, 0.2);
    let slope = Picture::from_fn(80, 50, |x, y| Vec4::new(0.01 * x as f32, 0.02 * y as f32, 0.4, 1.0));
    let stripes = |shift: u32| {
        Picture::from_fn(
            90,
            40,
            move |x, _| if ((x + shift) / 6).is_multiple_of(2) { Vec4::ONE } else { Vec4::splat(0.03) },
        )
    };
    let scaled = |picture: &Picture, by: Vec3| Picture {
        texels: picture.texels.iter().map(|t| (t.truncate() * by).extend(1.0)).collect(),
        ..picture.clone()
    };
    vec![
        pair("traced, few paths", many.clone(), few.clone(), 0.0),
        pair("traced, two stops up", many.clone(), few, 2.0),
        pair("traced, too bright", many.clone(), scaled(&many, Vec3::splat(1.1)), 0.0),
        pair("traced, wrong hue", many.clone(), scaled(&many, Vec3::new(1.05, 1.0, 0.9)), -1.0),
        pair("noise", slope.clone(), added(&slope, 3, 0.05), 0.0),
        pair("fine noise on noise", noise.clone(), added(&noise, 4, 0.01), 0.0),
        pair("shifted stripes", stripes(0), stripes(1), 0.0),
        pair("blurred stripes", stripes(0), blurred(&stripes(0)), 0.0),
        pair("brighter than the screen", scaled(&slope, Vec3::splat(9.0)), scaled(&slope, Vec3::splat(7.0)), -2.0),
        pair("dark", scaled(&slope, Vec3::splat(0.02)), scaled(&noisy(9, 80, 50, 1.0), Vec3::splat(0.01)), 0.0),
    ]
}

fn traced(scene: &str, samples: u32, seed: u32) -> Picture {
    let mut scene = gallery::open(scene).expect("a scene");
    scene.environment.get_or_insert_with(|| Arc::new(gallery::studio()));
    let camera = scene.cameras[0].clone();
    let world = World::new(&Arc::new(scene), reference::Options::default());
    let size = UVec2::new(96, 54);
    let mut film = Film::new(size);
    let view = reference::View { camera, size, seed };
    assert_eq!(reference::trace(&world, &view, &mut film, samples, &Control::default()), Pass::Whole);
    film.picture()
}

fn noisy(seed: u64, width: u32, height: u32, amount: f32) -> Picture {
    added(&Picture::filled(width, height, Vec4::splat(0.5)), seed, amount)
}

/// The picture with even noise of so much, never negative.
fn added(picture: &Picture, seed: u64, amount: f32) -> Picture {
    let mut random = Random::new(seed);
    let mut texel = |t: &Vec4| (t.truncate() + amount * (random.point3() - 0.5)).max(Vec3::ZERO).extend(1.0);
    Picture { texels: picture.texels.iter().map(&mut texel).collect(), ..picture.clone() }
}

fn blurred(picture: &Picture) -> Picture {
    let at = |x: u32, y: u32| picture.texels[(y * picture.width + x.min(picture.width - 1)) as usize];
    Picture::from_fn(picture.width, picture.height, |x, y| (at(x.saturating_sub(1), y) + at(x, y) + at(x + 1, y)) / 3.0)
}
