//! The path tracer against Mitsuba 3, through our own export: an independent judge of both.
//!
//! Needs a Python with the packages `mitsuba` and `numpy`: that of `BURNISH_PYTHON`, else `python3`. Compared are masking
//! apart for light and view, single scattering and one index per channel, which is what Mitsuba has.
//! `BURNISH_ORACLE=4` takes four times as many paths, `BURNISH_MITSUBA_VARIANT` names another variant than `scalar_rgb`.

mod cost;
mod maps;
mod scenes;
mod server;
mod statistics;

use std::sync::Arc;

use burnish_core::export::mitsuba;
use burnish_core::math::sampling::Random;
use burnish_core::param::Settings;
use burnish_core::reference::{self, Control, Film, Pass, World};
use burnish_core::scene::{Camera, Environment, Scene};
use burnish_tests::{Need, trial};
use glam::{UVec2, Vec3};
use libtest_mimic::Trial;

use server::Server;
use statistics::{Batches, Comparison};

/// Least and most independent pictures of each renderer.
const BATCHES: [u32; 2] = [64, 1024];
/// Pixels of a picture.
const SIZE: UVec2 = UVec2::new(48, 36);
/// Least share of pixels and channels within three standard deviations of each other.
const WITHIN: f64 = 0.995;
/// Largest relative difference of the means of two pictures.
const MEAN: f64 = 0.003;
/// Most surfaces on the way.
const BOUNCES: u32 = 64;
/// Largest relative difference of the environment, which both look up in f32.
const RADIANCE: f32 = 1e-4;

pub fn trials() -> Vec<Trial> {
    let mut trials = vec![trial("Mitsuba sees the same environment", &[Need::Mitsuba], same_environment)];
    for entry in scenes::ALL {
        let name = format!("Mitsuba agrees: {}", entry.name);
        trials.push(trial(name.leak(), &[Need::Mitsuba], || same_picture(entry)));
    }
    trials.extend(maps::trials());
    trials.push(cost::trial());
    trials
}

/// Settings that mean the same to both.
fn options() -> reference::Options {
    let mut settings = Settings::new(reference::PARAMS);
    let chosen = [("masking", "separable"), ("multiple-scattering", "off"), ("bounces", &BOUNCES.to_string())];
    for (key, value) in chosen {
        settings.set(key, value).expect("a setting of the path tracer");
    }
    reference::Options::new(&settings)
}

/// The camera of a scene, for Mitsuba.
fn view(scene: &Scene, size: UVec2) -> mitsuba::View<'_> {
    mitsuba::View { camera: &scene.cameras[0], size, samples: 16, bounces: BOUNCES }
}

/// A picture of ours.
fn traced(world: &World, camera: &Camera, size: UVec2, samples: u32, seed: u32) -> Vec<Vec3> {
    let view = reference::View { camera: camera.clone(), size, seed };
    let mut film = Film::new(size);
    let pass = reference::trace(world, &view, &mut film, samples, &Control::default());
    assert_eq!(pass, Pass::Whole);
    assert!(film.pixels().iter().all(|pixel| pixel.rejected == 0), "samples that are no numbers");
    film.pixels().iter().map(|pixel| pixel.mean.as_vec3()).collect()
}

/// Factor on the number of paths.
fn effort() -> u32 {
    std::env::var("BURNISH_ORACLE").ok().and_then(|text| text.parse().ok()).unwrap_or(1).max(1)
}

/// Pictures of both renderers.
struct Pair<'a> {
    server: &'a mut Server,
    scene: Arc<Scene>,
    world: World,
    size: UVec2,
    samples: u32,
    ours: Batches,
    theirs: Batches,
}

impl<'a> Pair<'a> {
    fn new(server: &'a mut Server, scene: &Arc<Scene>, size: UVec2, samples: u32) -> Pair<'a> {
        let variant = std::env::var("BURNISH_MITSUBA_VARIANT").unwrap_or_else(|_| "scalar_rgb".into());
        server.load(scene, &view(scene, size), &variant);
        let world = World::new(scene, options());
        let scene = scene.clone();
        Pair { server, scene, world, size, samples, ours: Batches::default(), theirs: Batches::default() }
    }

    /// Renders the least number of pictures of each, then more until the difference of the means is known to `noise`,
    /// relative to them, or there are most.
    fn compare(&mut self, [least, most]: [u32; 2], noise: f64) -> Comparison {
        let mut comparison = self.until(least);
        while comparison.noise[0].hypot(comparison.noise[1]) > noise && self.ours.count() < most {
            comparison = self.until(2 * self.ours.count());
        }
        comparison
    }

    /// Renders until there are so many pictures of each.
    fn until(&mut self, batches: u32) -> Comparison {
        for seed in self.ours.count() + 1..=batches {
            self.ours.add(&traced(&self.world, &self.scene.cameras[0], self.size, self.samples, seed));
            self.theirs.add(&self.server.render(self.samples, seed).0);
        }
        Comparison::new(&self.ours, &self.theirs)
    }
}

fn same_picture(entry: &scenes::Entry) {
    let scene = Arc::new((entry.build)());
    scene.validate().expect("a sound scene");
    let mut server = Server::start(&format!("oracle-{}", entry.name.replace(' ', "-")));
    let mut pair = Pair::new(&mut server, &scene, SIZE, entry.samples * effort());
    let c = pair.compare(BATCHES, MEAN / 4.0);
    println!("{}: {c}", entry.name);
    keep(entry.name, &pair.ours, &pair.theirs);
    assert!(c.within >= WITHIN, "{} of the pixels agree", c.within);
    assert!(c.mean <= MEAN, "the means differ by {}", c.mean);
}

/// Writes both pictures where `BURNISH_ORACLE_OUT` says.
fn keep(name: &str, ours: &Batches, theirs: &Batches) {
    let Some(folder) = std::env::var_os("BURNISH_ORACLE_OUT") else { return };
    for (who, batches) in [("ours", ours), ("mitsuba", theirs)] {
        let texels = batches.mean().iter().map(|mean| mean.as_vec3().extend(1.0)).collect();
        let picture = burnish_core::picture::Picture { width: SIZE.x, height: SIZE.y, texels };
        let file = std::path::Path::new(&folder).join(format!("{}-{who}.exr", name.replace(' ', "-")));
        burnish_core::file::write_exr(&picture, &file).expect("a writable folder");
    }
}

fn same_environment() {
    let mut random = Random::new(5);
    let directions: Vec<Vec3> = (0..4000).map(|_| direction(&mut random)).collect();
    let mut server = Server::start("oracle-environment");
    let mut noise = |width: u32, height: u32| {
        let texels = (0..width * height).map(|_| random.point3() + 0.05).collect();
        Environment { rotation: 2.1, strength: 1.7, ..Environment::new("noise", width, height, texels) }
    };
    // Rounded coordinates tell in proportion to the number of texels: the large map has few edges.
    for map in [noise(16, 8), noise(7, 5), noise(1, 1), Environment::clone(&scenes::sky())] {
        let mut scene = scenes::gold_ball();
        scene.environment = Some(Arc::new(map.clone()));
        server.load(&scene, &view(&scene, SIZE), "scalar_rgb");
        let found = server.environment(&directions);
        let mut worst = 0.0_f32;
        for (direction, found) in directions.iter().zip(found) {
            let expected = map.radiance(*direction);
            worst = worst.max(((found - expected) / expected).abs().max_element());
        }
        let Environment { name, width, height, .. } = map;
        println!("{name} of {width} x {height}: {worst:e} off at most");
        assert!(worst < RADIANCE, "{name} of {width} x {height}: {worst}");
    }
}

/// Evenly over the sphere.
fn direction(random: &mut Random) -> Vec3 {
    let [x, y] = random.point2().to_array();
    let z = 1.0 - 2.0 * x;
    let (sin, cos) = (std::f32::consts::TAU * y).sin_cos();
    Vec3::new(cos, sin, 0.0) * ((1.0 - z) * (1.0 + z)).sqrt() + z * Vec3::Z
}
