//! What a picture of a given error costs, beside Mitsuba. Runs when asked for by name (`--ignored cost`), on a machine that
//! does nothing else, with `--release`.

use std::sync::Arc;
use std::time::Instant;

use burnish_core::reference::World;
use burnish_tests::{Need, trial as plain};
use glam::{DVec3, UVec2, Vec3};
use libtest_mimic::Trial;

use super::server::Server;
use super::statistics::Batches;
use super::{effort, options, scenes, traced, view};

const SIZE: UVec2 = UVec2::new(320, 180);
const SAMPLES: [u32; 2] = [16, 64];
const ROUNDS: u32 = 3;
/// Paths through a pixel of the reference, from each side.
const CONVERGED: u32 = 2048;
/// Worst share of pixels that is left out.
const TRIMMED: f64 = 0.001;
/// Added to squares of the reference, as in relMSE.
const FLOOR: f64 = 0.01;
/// Mitsuba's ways.
const VARIANTS: [&str; 2] = ["llvm_ad_rgb", "scalar_rgb"];

pub fn trial() -> Trial {
    plain("cost of a picture beside Mitsuba", &[Need::Mitsuba], measure).with_ignored_flag(true)
}

/// Mean over the pixels of the squared relative error, mean of the channels, without the worst of them.
fn error(picture: &[Vec3], reference: &[DVec3]) -> f64 {
    let pixel = |(x, r): (&Vec3, &DVec3)| {
        let difference = x.as_dvec3() - *r;
        (difference * difference / (*r * *r + FLOOR)).element_sum() / 3.0
    };
    let mut errors: Vec<f64> = picture.iter().zip(reference).map(pixel).collect();
    errors.sort_by(f64::total_cmp);
    let kept = errors.len() - (errors.len() as f64 * TRIMMED).ceil() as usize;
    errors[..kept].iter().sum::<f64>() / kept.max(1) as f64
}

/// Renders in turn; scenes are read, trees built and kernels compiled before the clock starts.
fn measure() {
    let scene = Arc::new(scenes::three_balls_under_a_sky());
    let camera = &scene.cameras[0];
    let world = World::new(&scene, options());
    let mut servers = VARIANTS.map(|variant| {
        let mut server = Server::start(&format!("cost-{variant}"));
        server.load(&scene, &view(&scene, SIZE), variant);
        server
    });
    // Half of each: neither is judged by itself alone.
    let mut reference = Batches::default();
    let pieces = 8 * effort();
    for piece in 0..pieces {
        reference.add(&traced(&world, camera, SIZE, CONVERGED / 8, 1000 + piece));
        reference.add(&servers[0].render(CONVERGED / 8, 1000 + piece).0);
    }
    let reference = reference.mean();

    println!("{}x{}, {} paths a pixel of both in the reference", SIZE.x, SIZE.y, 2 * pieces * CONVERGED / 8);
    for samples in SAMPLES {
        // The first picture of a size is not like the others: kernels, caches, clocks.
        traced(&world, camera, SIZE, samples, 0);
        servers.iter_mut().for_each(|server| _ = server.render(samples, 0));
        for round in 1..=ROUNDS {
            let tell = |who: &str, picture: &[Vec3], seconds: f64| {
                let error = error(picture, reference);
                println!(
                    "{samples:3} paths, round {round}: {who:11} {seconds:7.3} s, trimmed relMSE {error:.5}, cost {:.4}",
                    error * seconds
                );
            };
            let start = Instant::now();
            let picture = traced(&world, camera, SIZE, samples, round);
            tell("burnish", &picture, start.elapsed().as_secs_f64());
            for (variant, server) in VARIANTS.iter().zip(&mut servers) {
                let (picture, seconds) = server.render(samples, round);
                tell(variant, &picture, seconds);
            }
        }
    }
}
