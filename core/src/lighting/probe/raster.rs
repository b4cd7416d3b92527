//! Light of probes that is drawn by lookups, on a graphics device where there is one, else by paths with direct light only.

use std::fmt;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::Site;
use super::trace::panorama;
use crate::job::Handle;
use crate::lighting::MethodError;
use crate::math::cube::{self, mirrored};
use crate::reference::{Options, World};
use crate::scene::{Environment, ProbeSource};

/// Bounces of paths that bring direct light only.
const DIRECT: u32 = 1;
/// Most paths for a texel where nothing draws it.
const PATHS: u32 = 8;
/// Drawn texels along the edge of a face for one of the probe: small bright things fall between fewer.
const TIMES: u32 = 4;
/// Edge of a drawn face from which on there are fewer.
const MANY: u32 = 512;

/// Draws what is seen from a place, in a moment and without noise. Who has a graphics device gives one to a [`World`].
pub trait Raster: fmt::Debug + Send + Sync {
    /// Scene-linear radiance around a place, `6 * edge * edge` texels by faces, rows, texels as a [`DistanceCube`](super::DistanceCube)
    /// has them: the scene of a world as a camera sees it by `classical`, with the sky.
    fn faces(&self, around: &World, middle: Vec3, edge: u32, job: &Handle) -> Result<Vec<Vec3>, MethodError>;
}

/// What is seen from a probe in direct light, as an equirectangular map four times as wide as a face.
pub(super) fn light(around: &World, site: &Site, job: &Handle) -> Result<Environment, MethodError> {
    let Site { middle, face, .. } = *site;
    let edge = drawn_edge(face);
    match around.raster().map(|raster| raster.faces(around, middle, edge, job)) {
        Some(Ok(faces)) if faces.len() as u32 == 6 * edge * edge => return unfolded(face, edge, &faces, job),
        Some(Err(MethodError::Cancelled)) => return Err(MethodError::Cancelled),
        // A device that fails says so where it draws the picture; what is drawn here can be traced instead.
        Some(Ok(_) | Err(MethodError::Unfit(_))) | None => {}
    }
    let (around, paths) = traced(around, site);
    panorama(&around, middle, (face, paths), job)
}

/// The world for paths of a site and how many a texel gets: few of direct light, where the light is to be drawn but nobody does.
pub(super) fn traced(around: &World, site: &Site) -> (World, u32) {
    match site.source {
        ProbeSource::Traced => (around.clone(), site.paths),
        ProbeSource::Raster => {
            let options = Options { bounces: DIRECT, ..*around.options() };
            (around.updated(around.scene(), options), site.paths.min(PATHS))
        }
    }
}

/// Texels along the edge of a drawn face for a probe with `face` of them.
fn drawn_edge(face: u32) -> u32 {
    (TIMES * face).min(MANY).max(face)
}

/// Means of drawn faces over the texels of an equirectangular map. A texel of a face counts by its solid angle, wherever it lies:
/// between texels radiance is linear, and points are closer than these.
fn unfolded(face: u32, edge: u32, faces: &[Vec3], job: &Handle) -> Result<Environment, MethodError> {
    let (width, height) = (4 * face, 2 * face);
    let grid = Environment::new("probe", width, height, Vec::new());
    let mut texels = vec![Vec3::ZERO; (width * height) as usize];
    texels.par_chunks_mut(width as usize).enumerate().try_for_each(|(y, row)| {
        if job.is_cancelled() {
            return Err(MethodError::Cancelled);
        }
        for (x, texel) in row.iter_mut().enumerate() {
            let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
            let points = points(edge, face, grid.texel_direction(x as u32, y as u32, Vec2::splat(0.5)));
            for i in 0..points * points {
                let inside = (Vec2::new((i % points) as f32, (i / points) as f32) + 0.5) / points as f32;
                let direction = grid.texel_direction(x as u32, y as u32, inside);
                // Rows are shorter toward the poles.
                let area = direction.x.hypot(direction.z);
                sum += area * between(edge, faces, direction);
                weight += area;
            }
            *texel = sum / weight;
        }
        Ok(())
    })?;
    Ok(Environment { texels: texels.into(), ..grid })
}

/// Points along the edge of a texel of the map: 0.6 texels of a face apart. With p from the middle of a face (1 at its edge) its texels
/// are `2 / edge` radians wide there, and `2 / (edge (1 + |p|^2))` toward the corners; those of the map `pi / (2 face)`.
fn points(edge: u32, face: u32, direction: Vec3) -> u32 {
    let (_, p) = cube::face_point(mirrored(direction));
    (1.3 * (1.0 + p.length_squared()) * edge as f32 / face as f32).ceil().max(2.0) as u32
}

/// Radiance in a direction, linear between the middles of texels of one face.
fn between(edge: u32, faces: &[Vec3], direction: Vec3) -> Vec3 {
    let (side, p) = cube::face_point(mirrored(direction));
    let last = edge as f32 - 1.0;
    let at = ((0.5 * p + 0.5) * edge as f32 - 0.5).clamp(Vec2::ZERO, Vec2::splat(last));
    let low = at.floor();
    let high = (low + 1.0).min(Vec2::splat(last));
    let texel = |x: f32, y: f32| faces[((side * edge + y as u32) * edge + x as u32) as usize];
    let t = at - low;
    let top = texel(low.x, low.y).lerp(texel(high.x, low.y), t.x);
    let bottom = texel(low.x, high.y).lerp(texel(high.x, high.y), t.x);
    top.lerp(bottom, t.y)
}

#[cfg(test)]
#[path = "raster_tests.rs"]
mod tests;
