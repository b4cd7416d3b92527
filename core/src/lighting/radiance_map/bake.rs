//! Light as it arrives at places, by directions, in blocks of places that can be baked apart.

use std::sync::Arc;

use glam::{UVec2, Vec2, Vec3};
use half::f16;
use rayon::prelude::*;

use super::density::Density;
use super::directions::Directions;
use super::gather;
use super::map::Map;
use super::near::{self, Near};
use super::points::{Place, Surfaces};
use crate::job::Handle;
use crate::lighting::probe::surroundings;
use crate::lighting::{MethodError, Prepared};
use crate::math::sampling::{hammersley, pcg, unit};
use crate::reference::World;

/// Where light comes from; each is kept apart, so that it can be tinted without another bake.
pub const GROUPS: [&str; 3] = ["environment", "lamps", "glow"];
/// Places of a block.
pub const BLOCK: u32 = 256;
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

/// A scene that is ready to be baked.
pub struct Baker<'a> {
    surfaces: Surfaces<'a>,
    /// The scene as surfaces see it: behind everything is the environment, lamps are added at each point.
    around: World,
    cells: Cells<'a>,
    /// A map whose light surfaces reflect; without one paths go on until they end.
    gathered: Option<Map<'a>>,
    /// Where the last places lie, and how many these are.
    density: Option<(Density<'a>, u32)>,
    asked: Asked,
}

/// The light of [`BLOCK`] places, the last block may have fewer. A pure function of scene, directions and what is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its place among all blocks.
    pub index: u32,
    /// Three numbers for each place, metres.
    pub positions: Vec<f32>,
    /// Likewise, unit.
    pub normals: Vec<f32>,
    /// 1 for a place that lies inside of something, whose light nobody asks for.
    pub inside: Vec<u8>,
    /// Three numbers for each direction of each place, by [`GROUPS`]; none where all is dark.
    pub groups: [Vec<f16>; 3],
    /// What they are to be multiplied by: a power of two, so that light of several blocks goes to one factor without rounding.
    pub scales: [f32; 3],
    /// Sums over the places of the squared difference and the squared sum of the irradiance by either half of the paths, see [`noise`].
    pub halves: [f64; 2],
    /// Rays that were cast, as far as 32 bits count.
    pub rays: u32,
}

impl<'a> Baker<'a> {
    /// An error where there are no surfaces.
    pub fn new(world: &'a World, directions: &'a Directions, asked: Asked) -> Result<Baker<'a>, MethodError> {
        let scene = world.scene();
        let surfaces = Surfaces::new(scene);
        if surfaces.area() <= 0.0 || asked.points == 0 {
            return Err(MethodError::Unfit("the scene has no surfaces: there is nothing to bake; open a model".into()));
        }
        let around = world.updated(&Arc::new(surroundings(scene, &[])), *world.options());
        Ok(Baker { surfaces, around, cells: Cells::new(directions), gathered: None, density: None, asked })
    }

    /// The same that gathers light from a map that was baked before.
    #[must_use]
    pub fn gathering(self, map: Option<Map<'a>>) -> Baker<'a> {
        Baker { gathered: map, ..self }
    }

    /// The same that puts a share of the places where light varies.
    #[must_use]
    pub fn denser(self, density: Option<Density<'a>>, share: f32) -> Baker<'a> {
        let dense = (share * self.asked.points as f32) as u32;
        Baker { density: density.map(|density| (density, dense.min(self.asked.points))), ..self }
    }

    /// Place number `number`.
    fn place(&self, number: u32) -> Option<Place> {
        let (surfaces, points) = (&self.surfaces, self.asked.points);
        match &self.density {
            Some((density, dense)) if number >= points - dense => density.place(surfaces, number),
            Some((_, dense)) => surfaces.place(number, points - dense),
            None => surfaces.place(number, points),
        }
    }

    /// Blocks in all.
    pub fn blocks(&self) -> u32 {
        self.asked.points.div_ceil(BLOCK)
    }

    /// Area of all surfaces, square metres.
    pub fn area(&self) -> f64 {
        self.surfaces.area()
    }

    /// The light of a block.
    pub fn block(&self, index: u32, job: &Handle) -> Result<Block, MethodError> {
        let numbers = index * BLOCK..((index + 1) * BLOCK).min(self.asked.points);
        let mut block = Block {
            index,
            positions: Vec::new(),
            normals: Vec::new(),
            inside: Vec::new(),
            groups: Default::default(),
            scales: [0.0; 3],
            halves: [0.0; 2],
            rays: 0,
        };
        let mut lit: Vec<Light> = Vec::new();
        for number in numbers {
            if job.is_cancelled() {
                return Err(MethodError::Cancelled);
            }
            let Some(place) = self.place(number) else { continue };
            let light = arriving(self, &place, number);
            block.positions.extend(place.position.to_array());
            block.normals.extend(place.normal.to_array());
            block.rays = block.rays.saturating_add(light.rays);
            let is_inside = light.inside >= INSIDE;
            block.inside.push(u8::from(is_inside));
            if !is_inside {
                let [one, other] = light.halves.map(f64::from);
                block.halves[0] += (one - other).powi(2);
                block.halves[1] += (one + other).powi(2);
            }
            lit.push(light);
        }
        for (group, (halves, scale)) in block.groups.iter_mut().zip(&mut block.scales).enumerate() {
            let most = lit.iter().flat_map(|light| &light.groups[group]).map(|l| l.max_element()).fold(0.0, f32::max);
            if most > 0.0 {
                *scale = scale_of(most);
                let all = lit.iter().flat_map(|light| &light.groups[group]);
                *halves = all.flat_map(|light| (*light / *scale).to_array()).map(f16::from_f32).collect();
            }
        }
        Ok(block)
    }
}

/// The least power of two, at least 1, that brings a number into the range of half floats: a sun of a map is brighter than they can tell.
fn scale_of(most: f32) -> f32 {
    let mut scale = 1.0;
    while most / scale > LARGEST {
        scale *= 2.0;
    }
    scale
}

/// Relative standard error of the irradiance at a place, from how far the halves of the paths of all places are apart; `None` where each
/// direction has one path.
pub fn noise(blocks: &[Block]) -> Option<f64> {
    let [apart, all] = blocks.iter().fold([0.0, 0.0], |[a, b], block| [a + block.halves[0], b + block.halves[1]]);
    (all > 0.0 && apart > 0.0).then(|| (apart / all).sqrt())
}

/// How much of the light that arrives at surfaces another scene of the same geometry changes: root mean square of the difference of irradiance
/// over the root of its mean square, over some places. Halves of the paths are multiplied, so that noise is not taken for light.
pub fn age(then: &World, now: &World, directions: &Directions, seed: u32) -> Option<f32> {
    const PLACES: u32 = 192;
    let asked = Asked { points: PLACES, paths: 4, seed };
    let bakers = [Baker::new(then, directions, asked).ok()?, Baker::new(now, directions, asked).ok()?];
    let of = |number: u32| {
        let mut lit = bakers.iter().filter_map(|baker| {
            let place = baker.place(number)?;
            let light = arriving(baker, &place, number);
            (light.inside < INSIDE).then_some(light.halves.map(f64::from))
        });
        let ([a, b], [new_a, new_b]) = (lit.next()?, lit.next()?);
        Some(((new_a - a) * (new_b - b), a * b))
    };
    let found: Vec<(f64, f64)> = (0..PLACES).into_par_iter().filter_map(of).collect();
    let sum = |of: fn(&(f64, f64)) -> f64| found.iter().map(of).sum::<f64>();
    let all = sum(|(_, all)| *all);
    (all > 0.0).then(|| (sum(|(changed, _)| *changed).max(0.0) / all).sqrt() as f32)
}

/// What arrives at a place.
#[derive(Clone, Debug, PartialEq)]
struct Light {
    /// Mean radiance in each cell, by [`GROUPS`].
    groups: [Vec<Vec3>; 3],
    /// Share of the paths that met a surface from behind.
    inside: f32,
    /// Irradiance by the paths of even and of odd number, in any unit; equal where there is one path.
    halves: [f32; 2],
    /// See [`Block::rays`].
    rays: u32,
}

/// All blocks, in their order, as a map for lookups: places in the order of a grid, with their neighbours.
pub fn assembled(blocks: &[Block], directions: &Directions, area: f64) -> Result<Prepared, MethodError> {
    // What lies inside of a body is dark, and would darken what is beside it.
    let kept: Vec<(usize, usize)> = (0..blocks.len())
        .flat_map(|b| (0..blocks[b].inside.len()).map(move |i| (b, i)))
        .filter(|(b, i)| blocks[*b].inside[*i] == 0)
        .collect();
    if kept.is_empty() {
        return Err(MethodError::Unfit(
            "all surfaces are seen from behind only: turn the normals of the model around, or make its materials double-sided".into(),
        ));
    }
    let vector = |of: fn(&Block) -> &[f32], (b, i): (usize, usize)| Vec3::from_slice(&of(&blocks[b])[3 * i..]);
    let positions: Vec<Vec3> = kept.iter().map(|at| vector(|block| &block.positions, *at)).collect();
    let normals: Vec<Vec3> = kept.iter().map(|at| vector(|block| &block.normals, *at)).collect();
    let mut groups: Vec<Group> = Vec::new();
    for (group, name) in GROUPS.iter().enumerate() {
        let scale = blocks.iter().map(|block| block.scales[group]).fold(0.0, f32::max);
        if scale <= 0.0 {
            continue;
        }
        let numbers = 3 * directions.len();
        let mut light = Vec::with_capacity(kept.len() * numbers);
        for (b, i) in &kept {
            let block = &blocks[*b];
            match block.groups[group].get(i * numbers..(i + 1) * numbers) {
                // A power of two.
                Some(of_place) => {
                    let factor = block.scales[group] / scale;
                    light.extend(of_place.iter().map(|half| f16::from_f32(half.to_f32() * factor)));
                }
                None => light.resize(light.len() + numbers, f16::ZERO),
            }
        }
        groups.push(Group { name, light, scale });
    }
    Ok(ordered(&positions, &normals, &groups, directions, area))
}

/// The light of a group, in the order of the places.
pub(super) struct Group {
    pub name: &'static str,
    pub light: Vec<f16>,
    pub scale: f32,
}

/// Puts places and light in the order of a grid, with their neighbours.
pub(super) fn ordered(
    positions: &[Vec3],
    normals: &[Vec3],
    groups: &[Group],
    directions: &Directions,
    area: f64,
) -> Prepared {
    let grid = near::Grid::around(positions, area);
    let order = grid.order(positions);
    let numbers = |of: &[Vec3]| -> Vec<f32> { order.iter().flat_map(|i| of[*i as usize].to_array()).collect() };
    let (positions, normals) = (numbers(positions), numbers(normals));
    let starts = grid.starts(&positions);
    let neighbours = Near::new(&positions, &normals, grid, &starts, &[]).neighbours();
    let mut prepared = Prepared::nothing();
    for Group { name, light, scale } in groups {
        let count = 3 * directions.len();
        let halves: Vec<f16> =
            order.iter().flat_map(|i| &light[*i as usize * count..(*i as usize + 1) * count]).copied().collect();
        prepared = prepared.with(name, halves).with(&format!("{name} scale"), vec![*scale]);
    }
    let [low, edge] = [grid.low.to_array(), [grid.edge, area as f32, 0.0]];
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
fn arriving(baker: &Baker<'_>, place: &Place, index: u32) -> Light {
    let Baker { around: world, cells: Cells { directions, around }, gathered, asked, .. } = baker;
    let gathered = gathered.as_ref();
    let count = directions.len();
    let mut light: [Vec<Vec3>; 3] = std::array::from_fn(|_| vec![Vec3::ZERO; count]);
    // Solid angle of the part above the surface.
    let mut above = vec![0.0f32; count];
    let (mut behind, mut paths) = (0u32, 0u32);
    let mut halves = [0.0f32; 2];
    let (mut rays, mut number) = (0u32, 0u32);
    let seed = pcg(pcg(asked.seed).wrapping_add(index));
    let counts = paths_of_cells(directions, gathered, place, asked.paths);
    let samples = if world.draws_sky() { SKY_SAMPLES * count as u32 } else { 0 };
    // The sky is met by paths and drawn by where it is bright: densities of both add up.
    let density_of_sky = |k: usize, direction: Vec3| {
        let drawn = if samples > 0 { samples as f32 * world.sky_density(direction) } else { 0.0 };
        counts[k] as f32 * directions.pdf(k, direction) + drawn
    };
    for k in 0..count {
        let turn =
            Vec2::new(unit(pcg(seed.wrapping_add(2 * k as u32))), unit(pcg(seed.wrapping_add(2 * k as u32 + 1))));
        for path in 0..counts[k] {
            let u = (hammersley(path, counts[k]) + turn).fract();
            let drawn = directions.draw(k, u);
            number += 1;
            if drawn.direction.dot(place.geometric) <= 0.0 {
                continue;
            }
            let share = 1.0 / (drawn.pdf * counts[k] as f32);
            above[k] += share;
            let (origin, pixel) = (place.origin(drawn.direction), UVec2::new(index, asked.seed));
            let found = match gathered {
                Some(map) => gather::along(world, map, origin, drawn.direction, pixel, number),
                None => world.along_apart(origin, drawn.direction, pixel, number),
            };
            paths += 1;
            rays = rays.saturating_add(found.rays);
            behind += u32::from(found.from_behind);
            let cosine = drawn.direction.dot(place.normal).max(0.0);
            let half = &mut halves[(path % 2) as usize];
            for (group, (sum, part)) in light.iter_mut().zip(found.by_source).enumerate() {
                let is_sky = group == 0 && found.escaped;
                let share = if is_sky { 1.0 / density_of_sky(k, drawn.direction) } else { share };
                let part = if part.is_finite() { share * part } else { Vec3::ZERO };
                sum[k] += part;
                *half += cosine * part.element_sum();
            }
        }
    }
    for sample in 0..samples {
        let turn = Vec2::new(unit(pcg(seed ^ 0x5bd1_e995)), unit(pcg(seed ^ 0x27d4_eb2f)));
        let u = (hammersley(sample, samples) + turn).fract();
        let Some((direction, radiance)) = world.sky_drawn(u) else { continue };
        if direction.dot(place.geometric) <= 0.0 {
            continue;
        }
        rays = rays.saturating_add(1);
        if world.distance(place.origin(direction), direction).is_none() {
            let k = directions.nearest(direction);
            let part = radiance / density_of_sky(k, direction);
            light[0][k] += part;
            halves[(sample % 2) as usize] += direction.dot(place.normal).max(0.0) * part.element_sum();
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
    if asked.paths < 2 {
        halves = [halves[0]; 2];
    }
    Light { groups: light, inside: behind as f32 / paths.max(1) as f32, halves, rays }
}

/// Paths of each cell: more where a map that was baked before knows bright light, and half of `paths` everywhere. As many in all as of even numbers.
fn paths_of_cells(directions: &Directions, gathered: Option<&Map<'_>>, place: &Place, paths: u32) -> Vec<u32> {
    let count = directions.len();
    let Some(map) = gathered else { return vec![paths; count] };
    let known = map.arriving(place.position, place.normal);
    let is_above = |k: &usize| directions.get(*k).dot(place.geometric) > 0.0;
    let bright = |k: usize| known[k].element_sum().max(0.0) * directions.solid_angle(k);
    let cells = (0..count).filter(is_above);
    let (all, sum) = cells.fold((0, 0.0), |(all, sum), k| (all + 1, sum + bright(k)));
    if sum <= 0.0 || !sum.is_finite() {
        return vec![paths; count];
    }
    let least = paths.div_ceil(2);
    let more = ((paths - least) * all) as f32 / sum;
    (0..count).map(|k| least + if is_above(&k) { (more * bright(k)) as u32 } else { 0 }).collect()
}
