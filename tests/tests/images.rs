//! Rendered pictures of our own scenes against accepted ones, judged by FLIP.
//!
//! A picture that differs is written next to its difference under the folder that the failure names.
//! `BURNISH_ACCEPT=1` accepts what is rendered.

#[path = "images/area.rs"]
mod area;
#[path = "images/background.rs"]
mod background;
#[path = "images/bumps.rs"]
mod bumps;
#[path = "images/catcher.rs"]
mod catcher;
#[path = "images/environment.rs"]
mod environment;
#[path = "images/fade.rs"]
mod fade;
#[path = "images/losses.rs"]
mod losses;
#[path = "images/plate.rs"]
mod plate;
#[path = "images/processor.rs"]
mod processor;
#[path = "images/raster.rs"]
mod raster;
#[path = "images/viewport.rs"]
mod viewport;

use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::file::{read_picture, write_png};
use burnish_core::lighting::classical::PARAMS;
use burnish_core::measure::{PIXELS_PER_DEGREE, flip};
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::scene::{Scene, gallery};
use burnish_render::{Gpu, Renderer, View};
use burnish_tests::{Need, repository, scenes, scratch_folder, trial};
use glam::UVec2;
use libtest_mimic::{Arguments, Trial};

const SIZE: UVec2 = UVec2::new(320, 180);
/// Enough to soften edges; the accepted pictures were made with as many.
const FRAMES: u32 = 4;
/// Mean FLIP. Software rasterisers of other processor makers differ by 2 to 3 grey levels.
const TOLERANCE: f64 = 0.01;

fn main() {
    let mut arguments = Arguments::from_args();
    // Each rasterises on all processors by itself.
    arguments.test_threads.get_or_insert(1);
    let mut trials = vec![picture("workbench", || gallery::open("gallery:workbench").expect("a gallery scene"))];
    trials.push(trial("a normal map bends the normal as the mesh would, on both sides", &[Need::Gpu], both_sides));
    trials.push(trial("a lost device is an error from then on", &[Need::Gpu], lost_device));
    trials.extend(scenes::ALL.iter().map(|(name, build)| picture(name, *build)));
    trials.extend(area::trials());
    trials.extend(background::trials());
    trials.extend(bumps::trials());
    trials.extend(catcher::trials());
    trials.extend(environment::trials());
    trials.extend(fade::trials());
    trials.extend(losses::trials());
    trials.extend(plate::trials());
    trials.extend(raster::trials());
    trials.extend(processor::trials());
    trials.extend(viewport::trials());
    libtest_mimic::run(&arguments, trials).exit();
}

fn picture(name: &'static str, build: fn() -> Scene) -> Trial {
    trial(name, &[Need::Gpu], move || compare(name, build()))
}

fn both_sides() {
    // One lookup: the sampled lobe reflects each lamp by itself, where a rounded normal shows twice as much.
    let mut settings = Settings::new(PARAMS);
    settings.set("samples", "0").expect("a setting");
    let [mapped, shaped] =
        [true, false].map(|mapped| render(&scenes::bent_square(mapped), usize::MAX, settings.clone()));
    assert_eq!(mapped.len(), 2);
    for (side, (mapped, shaped)) in ["front", "back"].iter().zip(mapped.iter().zip(&shaped)) {
        for (a, b) in mapped.texels.iter().zip(&shaped.texels) {
            // Rounding of the half floats and of the packed normals that both go through.
            assert!(a.abs_diff_eq(*b, 0.01 * b.max_element()), "{a} is not {b}, seen from the {side}");
        }
    }
}

fn lost_device() {
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    let scene = scenes::bent_square(false);
    let mut renderer = Renderer::new(&gpu, &scene).unwrap_or_else(|e| panic!("{e}"));
    let camera = scene.cameras[0].clone();
    let view = View { size: SIZE, camera, settings: Settings::new(PARAMS), jitter_frames: 1 };
    renderer.render(&view).unwrap_or_else(|e| panic!("{e}"));
    gpu.device.destroy();
    for _ in 0..2 {
        let error = renderer.render(&view).expect_err("nothing is drawn without a device");
        assert!(error.to_string().contains("the graphics device failed"), "{error}");
    }
}

/// The scene from its first so many cameras.
fn render(scene: &Scene, cameras: usize, settings: Settings) -> Vec<Picture> {
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    let mut renderer = Renderer::new(&gpu, scene).unwrap_or_else(|e| panic!("{e}"));
    let pictures = scene.cameras.iter().take(cameras).map(|camera| {
        let view = View { size: SIZE, camera: camera.clone(), settings: settings.clone(), jitter_frames: FRAMES };
        renderer.render(&view).unwrap_or_else(|e| panic!("{e}"))
    });
    pictures.collect()
}

fn compare(name: &str, mut scene: Scene) {
    scene.environment.get_or_insert_with(|| Arc::new(gallery::studio()));
    let rendered = render(&scene, 1, Settings::new(PARAMS)).pop().expect("a camera");

    let accepted_path = repository().join("tests/data/images").join(format!("{name}.png"));
    if std::env::var_os("BURNISH_ACCEPT").is_some() {
        write_png(&rendered, &accepted_path, ToneMap::Neutral, 0.0).unwrap_or_else(|e| panic!("{e}"));
        return;
    }
    // Both sides as a file holds them.
    let folder = scratch_folder(&format!("images-{name}"));
    let actual_path = folder.join("actual.png");
    write_png(&rendered, &actual_path, ToneMap::Neutral, 0.0).unwrap_or_else(|e| panic!("{e}"));
    let read = |path: &PathBuf| read_picture(path).unwrap_or_else(|e| panic!("{e}")).0;
    let error = flip(&read(&accepted_path), &read(&actual_path), 0.0, PIXELS_PER_DEGREE);
    let error = error.unwrap_or_else(|e| panic!("{e}"));
    if error.mean > TOLERANCE {
        let difference = folder.join("difference.png");
        write_png(&error.picture(), &difference, ToneMap::None, 0.0).unwrap_or_else(|e| panic!("{e}"));
        panic!(
            "mean FLIP {:.4} is over {TOLERANCE}; see {}; accept with BURNISH_ACCEPT=1 cargo test --test images",
            error.mean,
            folder.display()
        );
    }
    let _ = std::fs::remove_dir_all(&folder);
}
