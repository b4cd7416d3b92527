//! Light as it arrives at places, by directions.

use std::sync::Arc;

use glam::{UVec2, Vec2, Vec3};
use half::f16;
use rayon::prelude::*;

use super::directions::Directions;
use super::near::{self, Near};
use super::points::{Place, Surfaces};
use crate::job::Handle;
use crate::lighting::probe::surroundings;
use crate::lighting::{MethodError, Prepared};
use crate::math::sampling::{hammersley, pcg, unit};
use crate::reference::World;

/// Where light comes from; each is kept apart, so that it can be tinted without another bake.
pub const GROUPS: [&str; 3] = ["environment", "lamps", "glow"];
/// Places between two looks at the job.
const BLOCK: u32 = 256;
/// Samples of the environment's direct light for each direction of a place.
const SKY_SAMPLES: u32 = 4;
/// Share of paths that meet surfaces from behind, from which a place is taken to be inside of something.
const INSIDE: f32 = 0.5;
/// Largest number that half floats hold.
const LARGEST: f32 = 65_504.0;

/// What is baked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// Places.
    pub points: u32,
    /// Paths in the cell of a direction, of each place.
    pub paths: u32,
    /// Chooses the random numbers.
    pub seed: u32,
}

/// Bakes the light of a scene. The same for any number of threads.
pub fn bake(world: &World, directions: &Directions, asked: Asked, job: &Handle) -> Result<Prepared, MethodError> {
    let scene = world.scene();
    let surfaces = Surfaces::new(scene);
    let places: Vec<Place> = (0..asked.points).filter_map(|i| surfaces.place(i, asked.points)).collect();
    if places.is_empty() {
        return Err(MethodError::Unfit("the scene has no surfaces: there is nothing to bake; open a model".into()));
    }
    // As surfaces see it: behind everything is the environment, lamps are added at each point.
    let around = world.updated(&Arc::new(surroundings(scene, &[])), *world.options());
    let cells = Cells::new(directions);
    let done = std::sync::atomic::AtomicUsize::new(0);
    let blocks: Vec<Vec<Light>> = places
        .par_chunks(BLOCK as usize)
        .enumerate()
        .map(|(block, places)| {
            let first = block as u32 * BLOCK;
            let of = |(i, place): (usize, &Place)| {
                if job.is_cancelled() {
                    return Err(MethodError::Cancelled);
                }
                Ok(arriving(&around, &cells, place, first + i as u32, asked))
            };
            let lit = places.iter().enumerate().map(of).collect::<Result<Vec<_>, _>>()?;
            let done = done.fetch_add(places.len(), std::sync::atomic::Ordering::Relaxed) + places.len();
            job.set_progress(done as f32 / asked.points.max(1) as f32);
            Ok(lit)
        })
        .collect::<Result<_, MethodError>>()?;
    // What lies inside of a body is dark, and would darken what is beside it.
    let all = places.into_iter().zip(blocks.into_iter().flatten());
    let (places, lit): (Vec<Place>, Vec<Light>) = all.filter(|(_, light)| light.inside < INSIDE).unzip();
    if places.is_empty() {
        return Err(MethodError::Unfit(
            "all surfaces are seen from behind only: turn the normals of the model around, or make its materials double-sided".into(),
        ));
    }
    Ok(stored(&places, &lit, directions, surfaces.area()))
}

/// What arrives at a place.
#[derive(Clone, Debug, PartialEq)]
struct Light {
    /// Mean radiance in each cell, by [`GROUPS`].
    groups: [Vec<Vec3>; 3],
    /// Share of the paths that met a surface from behind.
    inside: f32,
}

/// Puts places and light in the order of a grid, with their neighbours.
fn stored(places: &[Place], lit: &[Light], directions: &Directions, area: f64) -> Prepared {
    let positions: Vec<Vec3> = places.iter().map(|place| place.position).collect();
    let grid = near::Grid::around(&positions, area);
    let order = grid.order(&positions);
    let numbers = |of: &dyn Fn(&Place) -> Vec3| -> Vec<f32> {
        order.iter().flat_map(|i| of(&places[*i as usize]).to_array()).collect()
    };
    let (positions, normals) = (numbers(&|place| place.position), numbers(&|place| place.normal));
    let starts = grid.starts(&positions);
    let neighbours = Near::new(&positions, &normals, grid, &starts, &[]).neighbours();
    let mut prepared = Prepared::nothing();
    for (group, name) in GROUPS.iter().enumerate() {
        let most = lit.iter().flat_map(|light| &light.groups[group]).map(|l| l.max_element()).fold(0.0, f32::max);
        if most <= 0.0 {
            continue;
        }
        // A sun of a map is brighter than half floats can tell.
        let scale = (most / LARGEST).max(1.0);
        let of_place = |i: &u32| lit[*i as usize].groups[group].iter().flat_map(|light| (*light / scale).to_array());
        let halves: Vec<f16> = order.iter().flat_map(of_place).map(f16::from_f32).collect();
        prepared = prepared.with(name, halves).with(&format!("{name} scale"), vec![scale]);
    }
    let [low, edge] = [grid.low.to_array(), [grid.edge, 0.0, 0.0]];
    prepared
        .with("directions", vec![directions.spread() as u32, directions.len() as u32])
        .with("positions", positions)
        .with("normals", normals)
        .with("grid", [low, edge].concat())
        .with("cells", grid.size.to_array().to_vec())
        .with("starts", starts)
        .with("neighbours", neighbours)
}

/// Directions with what fills a cell of which a place sees nothing.
struct Cells<'a> {
    directions: &'a Directions,
    /// For each the others, the nearest first.
    around: Vec<Vec<usize>>,
}

impl<'a> Cells<'a> {
    fn new(directions: &'a Directions) -> Cells<'a> {
        Cells { directions, around: (0..directions.len()).map(|k| directions.around(k)).collect() }
    }
}

/// Mean radiance that arrives at a place in each cell, over the part of it above the surface, by [`GROUPS`]. Cells below have that of the nearest cell: they
/// are asked for where the surface bends.
fn arriving(world: &World, cells: &Cells<'_>, place: &Place, index: u32, asked: Asked) -> Light {
    let Cells { directions, around } = cells;
    let count = directions.len();
    let mut light: [Vec<Vec3>; 3] = std::array::from_fn(|_| vec![Vec3::ZERO; count]);
    // Solid angle of the part above the surface.
    let mut above = vec![0.0f32; count];
    let (mut behind, mut paths) = (0u32, 0u32);
    let draws_sky = world.draws_sky();
    let seed = pcg(pcg(asked.seed).wrapping_add(index));
    for k in 0..count {
        let turn =
            Vec2::new(unit(pcg(seed.wrapping_add(2 * k as u32))), unit(pcg(seed.wrapping_add(2 * k as u32 + 1))));
        for path in 0..asked.paths {
            let u = (hammersley(path, asked.paths) + turn).fract();
            let drawn = directions.draw(k, u);
            if drawn.direction.dot(place.geometric) <= 0.0 {
                continue;
            }
            let share = 1.0 / (drawn.pdf * asked.paths as f32);
            above[k] += share;
            let number = k as u32 * asked.paths + path;
            let found = world.along_apart(
                place.origin(drawn.direction),
                drawn.direction,
                UVec2::new(index, asked.seed),
                number,
            );
            paths += 1;
            behind += u32::from(found.from_behind);
            for (group, (sum, part)) in light.iter_mut().zip(found.by_source).enumerate() {
                // What is seen of a sky that is drawn is added below.
                let is_drawn = group == 0 && found.escaped && draws_sky;
                sum[k] += share * if part.is_finite() && !is_drawn { part } else { Vec3::ZERO };
            }
        }
    }
    // The environment's own light, by where it is bright.
    let samples = if draws_sky { SKY_SAMPLES * count as u32 } else { 0 };
    for sample in 0..samples {
        let turn = Vec2::new(unit(pcg(seed ^ 0x5bd1_e995)), unit(pcg(seed ^ 0x27d4_eb2f)));
        let u = (hammersley(sample, samples) + turn).fract();
        let Some((direction, light_over_pdf)) = world.sky_drawn(u) else { continue };
        if direction.dot(place.geometric) > 0.0 && world.distance(place.origin(direction), direction).is_none() {
            light[0][directions.nearest(direction)] += light_over_pdf / samples as f32;
        }
    }
    let seen = |k: usize| above[k] > 0.02 * directions.solid_angle(k);
    for sum in &mut light {
        for k in 0..count {
            sum[k] /= if seen(k) { above[k] } else { 1.0 };
        }
        let known: Vec<Vec3> = sum.clone();
        for k in (0..count).filter(|k| !seen(*k)) {
            let from = around[k].iter().copied().find(|other| seen(*other));
            sum[k] = from.map_or(Vec3::ZERO, |other| known[other]);
        }
    }
    Light { groups: light, inside: behind as f32 / paths.max(1) as f32 }
}
