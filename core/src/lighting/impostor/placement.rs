//! Where probes are put so that what they serve is shown with no more than some error.

use std::sync::Arc;

use glam::Vec3;
use rayon::prelude::*;

use super::study::apart;
use super::{Effort, solve};
use crate::job::Handle;
use crate::lighting::MethodError;
use crate::lighting::probe::{Surroundings, surroundings};
use crate::math::sampling::hammersley;
use crate::reference::{Options, World};
use crate::scene::Scene;

/// Most probes that are placed.
const MOST: usize = 8;
/// Points of the served surfaces at which errors are measured.
const POINTS: usize = 600;
/// Directions from each.
const RAYS: u32 = 8;
/// Texels along the edge of a face of the distances that errors are measured with.
const FACE: u32 = 64;
/// Rounds in which points are given to the nearest place and places moved to the middle of theirs.
const ROUNDS: usize = 20;

/// Places of probes, and what they leave.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// Metres.
    pub places: Vec<Vec3>,
    /// Degrees by which 95 % of the rays from the served surfaces are wrong at most.
    pub p95: f32,
}

/// Finds the fewest places, at most 8, from which 95 % of the rays that leave the served surfaces are found to within `bound` degrees;
/// where no number does, those with the least error. Each instance index is in range.
pub fn place(
    scene: &Scene,
    served: &[usize],
    bound: f32,
    effort: &Effort,
    job: &Handle,
) -> Result<Placement, MethodError> {
    let points = points(scene, served);
    let indices: Vec<u32> = served.iter().map(|i| *i as u32).collect();
    let around = World::new(&Arc::new(surroundings(scene, &indices)), Options::default());
    let mut best: Option<Placement> = None;
    for count in 1..=MOST.min(points.len()) {
        if job.is_cancelled() {
            return Err(MethodError::Cancelled);
        }
        job.set_progress((count - 1) as f32 / MOST as f32);
        let places = spread(&points, count);
        let p95 = error(&around, &points, &places, effort);
        if best.as_ref().is_none_or(|best| p95 < best.p95) {
            best = Some(Placement { places, p95 });
        }
        if p95 <= bound {
            break;
        }
    }
    best.ok_or_else(|| MethodError::Unfit("there is no surface to place a probe for; show the objects first".into()))
}

/// Points of the surfaces with their normals, evenly over the vertices.
fn points(scene: &Scene, served: &[usize]) -> Vec<(Vec3, Vec3)> {
    let meshes: Vec<_> =
        served.iter().map(|i| (&scene.instances[*i], &scene.meshes[scene.instances[*i].mesh])).collect();
    let all: usize = meshes.iter().map(|(_, mesh)| mesh.positions.len()).sum();
    let step = all.div_ceil(POINTS).max(1);
    let each = meshes.into_iter().flat_map(|(instance, mesh)| {
        let turned = instance.world_from_local.matrix3.inverse().transpose();
        (0..mesh.positions.len()).map(move |i| {
            let normal = Vec3::from(turned * glam::Vec3A::from(mesh.normals[i])).normalize_or(Vec3::Y);
            (instance.world_from_local.transform_point3(mesh.positions[i]), normal)
        })
    });
    each.step_by(step).collect()
}

/// Middles of so many groups of points: those farthest from each other first, then moved to the middle of the points that are
/// nearest to them (Lloyd 1982, Least squares quantization in PCM).
fn spread(points: &[(Vec3, Vec3)], count: usize) -> Vec<Vec3> {
    let middle = points.iter().map(|(p, _)| *p).sum::<Vec3>() / points.len() as f32;
    let mut places = vec![middle];
    while places.len() < count {
        let distance = |p: Vec3| places.iter().map(|place| place.distance_squared(p)).fold(f32::INFINITY, f32::min);
        let farthest = points.iter().map(|(p, _)| *p).max_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        places.extend(farthest);
    }
    for _ in 0..ROUNDS {
        let mut sums = vec![(Vec3::ZERO, 0.0); places.len()];
        for (p, _) in points {
            let nearest = nearest(&places, *p);
            sums[nearest] = (sums[nearest].0 + *p, sums[nearest].1 + 1.0);
        }
        let moved: Vec<Vec3> =
            places.iter().zip(sums).map(|(old, (sum, n))| if n > 0.0 { sum / n } else { *old }).collect();
        if moved == places {
            break;
        }
        places = moved;
    }
    places
}

fn nearest(places: &[Vec3], p: Vec3) -> usize {
    let near =
        (0..places.len()).min_by(|a, b| places[*a].distance_squared(p).total_cmp(&places[*b].distance_squared(p)));
    near.unwrap_or(0)
}

/// Degrees of 95 % of the rays.
fn error(around: &World, points: &[(Vec3, Vec3)], places: &[Vec3], effort: &Effort) -> f32 {
    let seen: Vec<Surroundings> = places.iter().map(|place| Surroundings::seen(around, *place, FACE)).collect();
    let of = |(index, (p, normal)): (usize, &(Vec3, Vec3))| {
        let seen = &seen[nearest(places, *p)];
        let frame = crate::math::frame::Frame::new(*normal);
        let x = *p - seen.middle;
        let along = |ray: u32| {
            // Evenly over the hemisphere, turned from point to point.
            let u = hammersley(ray, RAYS);
            let (sin, cos) = (std::f32::consts::TAU * (u.y + 0.618_034 * index as f32)).sin_cos();
            let z = (u.x + 0.5 / RAYS as f32).min(1.0);
            let level = (1.0 - z * z).max(0.0).sqrt();
            let r = frame.to_world(Vec3::new(level * cos, level * sin, z));
            let found = solve(&seen.distances(), &seen.extent, x, r, effort);
            let wanted = around.distance(*p + 1e-4 * r, r).map_or(r, |t| x + t * r);
            apart(found.direction(x, r), wanted)
        };
        (0..RAYS).map(along).collect::<Vec<f32>>()
    };
    let mut all: Vec<f32> = points.par_iter().enumerate().flat_map_iter(of).collect();
    all.sort_by(f32::total_cmp);
    all.get(all.len() * 95 / 100).copied().unwrap_or(0.0)
}
