//! Light and distances as a probe records them.

use std::sync::Arc;

use glam::{UVec2, Vec2, Vec3};
use rayon::prelude::*;

use super::behind;
use super::bounds::bounds;
use super::distances::DistanceCube;
use super::raster;
use super::seen::surroundings;
use super::{Site, Sites};
use crate::job::Handle;
use crate::lighting::impostor::Extent;
use crate::lighting::{MethodError, Prepared, classical};
use crate::math::sampling::hammersley;
use crate::reference::World;
use crate::scene::{Environment, ProbeSource};

/// Paths that are traced between two looks at the job.
const ROW_PATHS: u32 = 1 << 14;

/// Records the probes of a scene, one part of the result for each. The same for any number of threads.
pub fn prepare(world: &World, sites: &Sites, job: &Handle) -> Result<Prepared, MethodError> {
    let mut parts = Vec::with_capacity(sites.list.len());
    let mut around: Option<(&[u32], World)> = None;
    let share = |done: usize| done as f32 / sites.list.len() as f32;
    for site in &sites.list {
        let world = match around.take() {
            // Most often all serve the same.
            Some((served, around)) if served == site.served => around,
            _ => world.updated(&Arc::new(surroundings(world.scene(), &site.served)), *world.options()),
        };
        parts.push(record(&world, site, &job.part(share(parts.len()), share(parts.len() + 1)))?);
        job.set_progress(share(parts.len()));
        around = Some((&site.served, world));
    }
    Ok(Prepared::nothing().with_parts(parts))
}

/// How far away everything around a place is.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// The place.
    pub middle: Vec3,
    /// What the distances say as a whole.
    pub extent: Extent,
    face: u32,
    inverse: Vec<f32>,
    bounds: Vec<f32>,
    /// Shares of the directions that see the sky, and surfaces from behind.
    shares: [f32; 2],
}

impl Surroundings {
    /// What is seen from a place, with `face` texels along the edge of a face.
    pub fn seen(around: &World, middle: Vec3, face: u32) -> Surroundings {
        Surroundings::seen_while(around, middle, face, &Handle::default())
    }

    /// The same; of a job that is cancelled nothing that counts.
    fn seen_while(around: &World, middle: Vec3, face: u32, job: &Handle) -> Surroundings {
        let (inverse, shares) = distances(around, middle, face, job);
        Surroundings { middle, extent: extent(&inverse, face), face, bounds: bounds(face, &inverse), inverse, shares }
    }

    /// The distances.
    pub fn distances(&self) -> DistanceCube<'_> {
        DistanceCube::new(self.face, &self.inverse, &self.bounds)
    }
}

/// Records one; `around` is the scene without what it serves.
fn record(around: &World, site: &Site, job: &Handle) -> Result<Prepared, MethodError> {
    let Site { middle, half, face, .. } = *site;
    let Surroundings { inverse, bounds, extent, shares, .. } = Surroundings::seen_while(around, middle, face, job);
    let whole = job;
    let job = &if site.layers < 2 { job.clone() } else { job.part(0.0, 0.5) };
    let map = match site.source {
        ProbeSource::Traced => panorama(around, middle, (face, site.paths), job)?,
        ProbeSource::Raster => raster::light(around, site, job)?,
    };
    let first = layer(&map, Layer { middle, half, face, inverse, bounds, extent }, job)?
        .with("served", site.served.clone())
        .with("shares", shares.to_vec())
        .fleeting(site.source == ProbeSource::Raster);
    if site.layers < 2 {
        return Ok(first);
    }
    Ok(first.with_parts(vec![second(around, site, &map, &whole.part(0.5, 1.0))?]))
}

/// What is known of a layer of surfaces but for their light.
struct Layer {
    middle: Vec3,
    half: Vec3,
    face: u32,
    inverse: Vec<f32>,
    bounds: Vec<f32>,
    extent: Extent,
}

/// A layer with its light filtered.
fn layer(map: &Environment, layer: Layer, job: &Handle) -> Result<Prepared, MethodError> {
    let Layer { middle, half, face, inverse, bounds, extent } = layer;
    let Extent { near, far, radius, low, high } = extent;
    let numbers = [middle, Vec3::new(near, far, radius), low, high, half];
    Ok(classical::prepare_map(map, job)?
        .with("distances", inverse)
        .with("bounds", bounds)
        .with("probe", numbers.iter().flat_map(|v| v.to_array()).collect::<Vec<f32>>())
        .with("face", vec![face]))
}

/// The layer behind the first one; `front` is the light of that, which takes its place where there is nothing behind.
fn second(around: &World, site: &Site, front: &Environment, job: &Handle) -> Result<Prepared, MethodError> {
    let Site { middle, half, face, .. } = *site;
    let inverse = behind::distances(around, middle, face, job);
    // No view shows what is hidden.
    let (around, paths) = raster::traced(around, site);
    let (extent, bounds) = (extent(&inverse, face), bounds(face, &inverse));
    let map = map(front, paths, job, |place, direction, path| {
        let from = behind::behind(&around, middle, direction)?.from;
        Some(around.along(middle + from * direction, direction, place, path).radiance)
    })?;
    layer(&map, Layer { middle, half, face, inverse, bounds, extent }, job)
}

/// What is kept of the distances, and the shares of the texels that are sky and that see a surface from behind.
fn distances(around: &World, middle: Vec3, face: u32, job: &Handle) -> (Vec<f32>, [f32; 2]) {
    let texel = |i: u32| {
        if job.is_cancelled() {
            return (0.0, false);
        }
        let (side, y, x) = (i / (face * face), i / face % face, i % face);
        let met = around.sighted(middle, DistanceCube::direction(face, side, x, y));
        let behind = met.is_some_and(|met| met.from_behind && !met.two_sided);
        (DistanceCube::kept(face, x, y, met.map(|met| met.distance)), behind)
    };
    let (inverse, behind): (Vec<f32>, Vec<bool>) = (0..6 * face * face).into_par_iter().map(texel).unzip();
    let share = |count: usize| count as f32 / inverse.len() as f32;
    let sky = share(inverse.iter().filter(|inverse| **inverse == 0.0).count());
    let behind = share(behind.iter().filter(|behind| **behind).count());
    (inverse, [sky, behind])
}

/// What the distances say as a whole; a room of 1 m where there is only sky, which no ray meets.
fn extent(inverse: &[f32], face: u32) -> Extent {
    let cube = DistanceCube::new(face, inverse, &[]);
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
    // Between the middles of texels a wall comes nearer, and a corner goes farther.
    let texel = 1.0 / face.max(1) as f32;
    let (near, far) = (near / (1.0 + 2.0 * texel * texel).sqrt(), far * (1.0 + texel));
    Extent { near, far, radius: (sum / f64::from(count)) as f32, low: low.min(Vec3::ZERO), high: high.max(Vec3::ZERO) }
}

/// The light of the surroundings as an equirectangular map, four times as wide as a face of the cube.
pub(super) fn panorama(
    around: &World,
    middle: Vec3,
    (face, paths): (u32, u32),
    job: &Handle,
) -> Result<Environment, MethodError> {
    let (width, height) = (4 * face, 2 * face);
    let black = Environment::new("probe", width, height, vec![Vec3::ZERO; (width * height) as usize]);
    map(&black, paths, job, |place, direction, path| Some(around.along(middle, direction, place, path).radiance))
}

/// A map of what `light` sends from directions, means of so many paths a texel; where it is `None` that of `otherwise`, whose
/// texels it has.
fn map(
    otherwise: &Environment,
    paths: u32,
    job: &Handle,
    light: impl Fn(UVec2, Vec3, u32) -> Option<Vec3> + Sync,
) -> Result<Environment, MethodError> {
    let (width, height) = (otherwise.width, otherwise.height);
    let mut texels = otherwise.texels.to_vec();
    let row = (ROW_PATHS / paths.max(1)).clamp(1, width) as usize;
    let done = std::sync::atomic::AtomicUsize::new(0);
    texels.par_chunks_mut(row).enumerate().try_for_each(|(chunk, part)| {
        if job.is_cancelled() {
            return Err(MethodError::Cancelled);
        }
        for (i, texel) in part.iter_mut().enumerate() {
            let place = (chunk * row + i) as u32;
            let (x, y) = (place % width, place / width);
            let other = *texel;
            let light = (0..paths).map(|path| {
                let place = hammersley(path, paths) + Vec2::splat(0.5 / paths as f32);
                light(UVec2::new(x, y), otherwise.texel_direction(x, y, place), path).unwrap_or(other)
            });
            // What is no number is left out, as a film does.
            *texel = light.filter(|light| light.is_finite()).sum::<Vec3>() / paths.max(1) as f32;
        }
        let done = done.fetch_add(part.len(), std::sync::atomic::Ordering::Relaxed);
        job.set_progress(0.8 * done as f32 / (width * height) as f32);
        Ok(())
    })?;
    Ok(Environment { texels: texels.into(), ..otherwise.clone() })
}
