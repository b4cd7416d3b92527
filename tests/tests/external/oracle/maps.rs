//! A ball under each environment of the trial data.

use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::import::load_environment;
use burnish_core::scene::Scene;
use burnish_tests::scenes::stage::Stage;
use burnish_tests::{Need, data_folder, trial};
use glam::{Affine3A, UVec2, Vec3};
use libtest_mimic::Trial;

use super::server::Server;
use super::{Pair, effort, scenes};

/// Pixels of a picture, which the ball fills to its corners.
const SIZE: UVec2 = UVec2::new(64, 64);
/// Paths through a pixel of a picture.
const SAMPLES: u32 = 64;
/// Least and most pictures of each renderer.
const BATCHES: [u32; 2] = [16, 256];
/// Noise of the difference of the means at which there are enough: small lamps in smooth balls take many.
const NOISE: f64 = 0.002;
/// Largest relative difference of the means.
const MEAN: f64 = 0.01;
const METALS: [&str; 2] = ["Au", "Al"];
const ROUGHNESSES: [f32; 3] = [0.05, 0.3, 0.8];

/// One for each map.
pub fn trials() -> Vec<Trial> {
    const NEEDS: &[Need] = &[Need::Mitsuba, Need::Data];
    let folder = data_folder().map(|data| data.join("hdri"));
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    let is_map = |path: &PathBuf| path.extension().is_some_and(|end| end == "hdr" || end == "exr");
    let mut maps: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_map).collect();
    maps.sort();
    if maps.is_empty() {
        return vec![trial("Mitsuba agrees under the maps", NEEDS, || panic!("there are no maps"))];
    }
    let test = |map: PathBuf| {
        let name = format!("Mitsuba agrees under {}", map.file_name().unwrap_or_default().to_string_lossy());
        trial(name.leak(), NEEDS, move || balls(map))
    };
    maps.into_iter().map(test).collect()
}

/// Balls of every metal and roughness under one map.
fn balls(map: PathBuf) {
    let name = map.file_stem().unwrap_or_default().to_string_lossy().to_string();
    let (environment, _) = load_environment(&map).expect("a map");
    let environment = Arc::new(environment);
    let mut server = Server::start(&format!("oracle-{name}"));
    let mut failed = Vec::new();
    for id in METALS {
        for roughness in ROUGHNESSES {
            let mut scene = ball(id, roughness);
            scene.environment = Some(environment.clone());
            let mut pair = Pair::new(&mut server, &Arc::new(scene), SIZE, SAMPLES * effort());
            let c = pair.compare(BATCHES, NOISE);
            println!("{name}, {id}, roughness {roughness}: {c}");
            if c.mean > MEAN {
                failed.push((id, roughness, c.mean));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

fn ball(id: &str, roughness: f32) -> Scene {
    let mut stage = Stage::new("ball");
    let material = stage.material(scenes::metal(id, roughness));
    stage.put(scenes::ball(1.0), material, Affine3A::IDENTITY);
    // Near enough that the silhouette lies outside of the picture's corners.
    stage.finish(Vec3::new(0.0, 0.0, 4.0), 0.3)
}
