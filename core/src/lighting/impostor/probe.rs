//! The probe: what is seen from the middle of the objects that it serves, which are left out: their surroundings' light,
//! traced, and how far away they are.

use std::sync::Arc;

use glam::{UVec2, Vec2, Vec3};
use rayon::prelude::*;

use super::Extent;
use super::distances::DistanceCube;
use crate::job::Handle;
use crate::lighting::{MethodError, Prepared, classical};
use crate::material::Reflectance;
use crate::math::sampling::hammersley;
use crate::reference::World;
use crate::scene::{Background, Bounds, Environment, Light, Scene};

/// Paths that are traced between two looks at the job.
const ROW_PATHS: u32 = 1 << 14;

/// The instances that a probe serves: the subject; where that is everything or nothing, the largest metal object. None where
/// there is no surrounding.
pub(super) fn served(scene: &Scene) -> Vec<u32> {
    let seen: Vec<usize> = (0..scene.instances.len()).filter(|i| scene.instances[*i].visible).collect();
    let subject: Vec<usize> = seen.iter().copied().filter(|i| scene.subject.contains(i)).collect();
    let served = match subject.len() {
        0 => largest_metal(scene, &seen).into_iter().collect(),
        all if all == seen.len() => largest_metal(scene, &seen).into_iter().collect(),
        _ => subject,
    };
    if served.len() == seen.len() { Vec::new() } else { served.into_iter().map(|i| i as u32).collect() }
}

fn largest_metal(scene: &Scene, among: &[usize]) -> Option<usize> {
    let is_metal = |i: &usize| {
        let material = &scene.materials[scene.instances[*i].material];
        matches!(material.reflectance, Reflectance::Preset { .. }) || material.metallic >= 0.5
    };
    let size = |i: &usize| bounds(scene, &[*i as u32]).radius();
    among.iter().copied().filter(is_metal).max_by(|a, b| size(a).total_cmp(&size(b)))
}

fn bounds(scene: &Scene, instances: &[u32]) -> Bounds {
    let boxes = instances.iter().map(|i| &scene.instances[*i as usize]);
    boxes.map(|instance| instance.bounds(&scene.meshes[instance.mesh])).fold(Bounds::EMPTY, Bounds::joined)
}

/// The scene without what the probe serves, as surfaces see it: lamps light it but are not seen, as their light is added at
/// each point; behind everything is the environment, whatever the eye sees there.
fn surroundings(scene: &Scene, served: &[u32]) -> Scene {
    let mut around = scene.clone();
    served.iter().for_each(|i| around.instances[*i as usize].visible = false);
    around.background = Background::default();
    around.lights = around.lights.into_iter().map(|light| Light { camera: false, ..light }).collect();
    around
}

/// Traces the probe of a scene. The same for any number of threads.
pub(super) fn prepare(world: &World, face: u32, paths: u32, job: &Handle) -> Result<Prepared, MethodError> {
    let served = served(world.scene());
    if served.is_empty() {
        return Ok(Prepared::nothing());
    }
    let middle = bounds(world.scene(), &served).center();
    let around = World::new(&Arc::new(surroundings(world.scene(), &served)), *world.options());
    let inverse = distances(&around, middle, face);
    let extent = extent(&inverse, face);
    let map = panorama(&around, middle, (face, paths), job)?;
    let Extent { near, far, radius, low, high } = extent;
    let numbers =
        [middle.to_array().to_vec(), vec![near, far, radius], low.to_array().to_vec(), high.to_array().to_vec()];
    Ok(classical::prepare_map(&map, job)?
        .with("served", served)
        .with("distances", inverse)
        .with("probe", numbers.concat())
        .with("face", vec![face]))
}

fn distances(around: &World, middle: Vec3, face: u32) -> Vec<f32> {
    (0..6 * face * face)
        .into_par_iter()
        .map(|i| {
            let (side, y, x) = (i / (face * face), i / face % face, i % face);
            let direction = DistanceCube::direction(face, side, x, y);
            DistanceCube::kept(face, x, y, around.distance(middle, direction))
        })
        .collect()
}

/// What the distances say as a whole; a room of 1 m where there is only sky, which no ray meets.
fn extent(inverse: &[f32], face: u32) -> Extent {
    let cube = DistanceCube::new(face, inverse);
    let (mut near, mut far, mut sum, mut count) = (f32::MAX, 0.0f32, 0.0, 0u32);
    let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
    for i in 0..6 * face * face {
        let direction = DistanceCube::direction(face, i / (face * face), i % face, i / face % face);
        let distance = cube.distance(direction);
        if distance > 0.0 {
            (near, far) = (near.min(distance), far.max(distance));
            (sum, count) = (sum + f64::from(distance), count + 1);
            (low, high) = (low.min(distance * direction), high.max(distance * direction));
        }
    }
    if count == 0 {
        return Extent { near: 1.0, far: 1.0, radius: 1.0, low: Vec3::NEG_ONE, high: Vec3::ONE };
    }
    Extent { near, far, radius: (sum / f64::from(count)) as f32, low: low.min(Vec3::ZERO), high: high.max(Vec3::ZERO) }
}

/// The light of the surroundings as an equirectangular map, four times as wide as a face of the cube.
fn panorama(around: &World, middle: Vec3, (face, paths): (u32, u32), job: &Handle) -> Result<Environment, MethodError> {
    let (width, height) = (4 * face, 2 * face);
    let grid = Environment::new("probe", width, height, Vec::new());
    let mut texels = vec![Vec3::ZERO; (width * height) as usize];
    let row = (ROW_PATHS / paths.max(1)).clamp(1, width) as usize;
    let done = std::sync::atomic::AtomicUsize::new(0);
    texels.par_chunks_mut(row).enumerate().try_for_each(|(chunk, part)| {
        if job.is_cancelled() {
            return Err(MethodError::Cancelled);
        }
        for (i, texel) in part.iter_mut().enumerate() {
            let place = (chunk * row + i) as u32;
            let (x, y) = (place % width, place / width);
            let light = (0..paths).map(|path| {
                let direction = grid.texel_direction(x, y, hammersley(path, paths) + Vec2::splat(0.5 / paths as f32));
                around.along(middle, direction, UVec2::new(x, y), path).radiance
            });
            // What is no number is left out, as a film does.
            *texel = light.filter(|light| light.is_finite()).sum::<Vec3>() / paths.max(1) as f32;
        }
        let done = done.fetch_add(part.len(), std::sync::atomic::Ordering::Relaxed);
        job.set_progress(0.8 * done as f32 / (width * height) as f32);
        Ok(())
    })?;
    Ok(Environment { texels: texels.into(), ..grid })
}

/// A probe that was prepared.
pub(super) struct Probe<'a> {
    pub middle: Vec3,
    pub extent: Extent,
    pub distances: DistanceCube<'a>,
}

impl<'a> Probe<'a> {
    /// The probe that serves an instance.
    pub fn of(prepared: &'a Prepared, instance: u32) -> Option<Probe<'a>> {
        prepared.whole("served").binary_search(&instance).ok()?;
        let [near, far, radius] = prepared.vector("probe", 1).to_array();
        let [low, high] = [2, 3].map(|i| prepared.vector("probe", i));
        Some(Probe {
            middle: prepared.vector("probe", 0),
            extent: Extent { near, far, radius, low, high },
            distances: DistanceCube::new(*prepared.whole("face").first()?, prepared.floats("distances")),
        })
    }
}
