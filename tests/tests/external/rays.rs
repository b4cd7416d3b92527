//! Rays against foreign models: the trees find what a loop over all triangles finds.

use std::path::{Path, PathBuf};

use burnish_core::import::{ImportOptions, load_scene};
use burnish_core::math::sampling::Random;
use burnish_core::scene::Scene;
use burnish_core::trace::{Accel, Hit, Ray, brute_force, offset};
use glam::Vec3;
use libtest_mimic::{Failed, Trial};

/// Rays for each model.
const RAYS: usize = 10_000;
/// Rays for each of the smallest models.
const MANY_RAYS: usize = 100_000;
/// How many count as smallest.
const SMALLEST: usize = 3;

/// One trial for all models: which are the smallest is known once all are read.
pub fn trial(models: Vec<PathBuf>) -> Trial {
    Trial::test("rays find what a loop over all triangles finds", move || check(&models))
}

fn check(models: &[PathBuf]) -> Result<(), Failed> {
    let read = |path| load_scene(path, &ImportOptions::default()).ok().map(|imported| imported.scene);
    let mut scenes: Vec<(&Path, Scene)> =
        models.iter().filter_map(|path| Some((path.as_path(), read(path)?))).collect();
    scenes.sort_by_key(|(_, scene)| scene.triangle_count());
    if scenes.len() < 2 * SMALLEST {
        return Err(format!("only {} models were read", scenes.len()).into());
    }
    for (place, (path, scene)) in scenes.iter().enumerate() {
        compare(path, scene, if place < SMALLEST { MANY_RAYS } else { RAYS })?;
    }
    Ok(())
}

fn compare(path: &Path, scene: &Scene, count: usize) -> Result<(), Failed> {
    let accel = Accel::new(scene);
    let mut rays = from_around(scene, count / 2);
    let found: Vec<Option<Hit>> = rays.iter().map(|ray| accel.closest(ray, |_| true)).collect();
    let leaving = leaving(&rays, &found, count - rays.len());
    rays.extend(leaving);
    let expected = brute_force(scene, &rays);
    let mut hits = 0;
    for (ray, expected) in rays.iter().zip(&expected) {
        let found = accel.closest(ray, |_| true);
        hits += usize::from(found.is_some());
        if found != *expected {
            return Err(format!("{}: {ray:?}: {found:?} instead of {expected:?}", path.display()).into());
        }
        if accel.occluded(ray, |_| true) != expected.is_some() {
            return Err(format!("{}: {ray:?} is not occluded as it hits", path.display()).into());
        }
    }
    println!("{}: {} triangles, {} rays, {hits} hits", path.display(), scene.triangle_count(), rays.len());
    if hits * 10 < rays.len() { Err(format!("{}: only {hits} hits", path.display()).into()) } else { Ok(()) }
}

/// From a ball around the scene to points of its box.
fn from_around(scene: &Scene, count: usize) -> Vec<Ray> {
    let (bounds, mut random) = (scene.bounds(), Random::new(11));
    let (center, radius) = (bounds.center(), bounds.radius());
    let mut one = || {
        let from = center + 2.0 * radius * (random.point3() - 0.5).normalize_or(Vec3::Y);
        let to = bounds.min + random.point3() * (bounds.max - bounds.min);
        Ray { origin: from, direction: (to - from).normalize_or(Vec3::Y), t_max: f32::INFINITY }
    };
    (0..count).map(|_| one()).collect()
}

/// From points that rays met, in all directions; from around where nothing was met.
fn leaving(rays: &[Ray], found: &[Option<Hit>], count: usize) -> Vec<Ray> {
    let mut random = Random::new(12);
    let met: Vec<Vec3> =
        rays.iter().zip(found).filter_map(|(ray, hit)| Some(ray.origin + hit.as_ref()?.t * ray.direction)).collect();
    let mut one = |i: usize| {
        let direction = (random.point3() - 0.5).normalize_or(Vec3::X);
        let point = met.get(i % met.len().max(1)).copied().unwrap_or(Vec3::ZERO);
        let origin = offset(point, 1e-6 * point.abs(), direction, direction);
        Ray { origin, direction, t_max: f32::INFINITY }
    };
    (0..count).map(&mut one).collect()
}
