//! Baked radiance maps on the device, and what rays find of materials there.

use std::sync::Arc;

use burnish_core::lighting::Prepared;
use burnish_core::lighting::radiance_map::{self, Grid, LISTS, Look, MetSurface, Part};
use burnish_core::scene::Scene;
use glam::{Vec3, Vec4};

use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::{
    MAP_ALL, MAP_BOX, MAP_FILTER, MAP_FLOATS, MAP_NOTHING, MAP_QUERY, MAP_SEARCH, MAP_SMOOTH, MAP_UNGUARDED, MapData,
    MetData,
};
use crate::pass::radiance_map::RadianceMapPass;
use crate::scene::check_size;

/// Directions of a map, at most: as many as its setting takes.
const MOST_DIRECTIONS: usize = 1024;

/// The map of a preparation: one buffer of words, since shaders read few buffers.
pub(crate) struct GpuMap {
    pub prepared: Arc<Prepared>,
    pub words: wgpu::Buffer,
    /// Where things are in it; [`GpuMap::data`] adds how they are looked up.
    shape: MapData,
    /// Directions and areas of their cells, for shaders.
    with_areas: wgpu::Buffer,
}

impl GpuMap {
    pub fn new(gpu: &Gpu, prepared: &Arc<Prepared>) -> Result<GpuMap, RenderError> {
        let unfit = || RenderError::Preparation("it holds no radiance map; prepare it again".into());
        let directions = radiance_map::baked_directions(prepared).ok_or_else(unfit)?;
        let (positions, normals) = (prepared.floats("positions"), prepared.floats("normals"));
        let neighbours = prepared.whole("neighbours");
        let (grid, starts) = Grid::of(prepared).ok_or_else(unfit)?;
        let places = positions.len() / 3;
        let is_whole = places > 0 && normals.len() == positions.len() && neighbours.len() == radiance_map::SET * places;
        if !is_whole || directions.len() > MOST_DIRECTIONS {
            return Err(unfit());
        }
        let mut words: Vec<u32> = Vec::new();
        let mut place = |numbers: &[u32]| {
            let first = words.len() as u32;
            words.extend_from_slice(numbers);
            first
        };
        let [starts, neighbours] = [starts, neighbours].map(&mut place);
        let [positions, normals] = [positions, normals].map(|floats| place(bytemuck::cast_slice(floats)));
        let (mut scales, mut firsts, mut flags) = ([0.0; 3], [0; 3], 0);
        for (group, name) in radiance_map::GROUPS.iter().enumerate() {
            let (light, floats) = (prepared.halves(name), prepared.floats(name));
            if light.is_empty() && floats.is_empty() {
                continue;
            }
            if light.len() + floats.len() != 3 * places * directions.len() {
                return Err(unfit());
            }
            scales[group] = prepared.floats(&format!("{name} scale")).first().copied().unwrap_or(1.0);
            let pair = |pair: &[half::f16]| {
                u32::from(pair[0].to_bits()) | u32::from(pair.get(1).map_or(0, |h| h.to_bits())) << 16
            };
            firsts[group] = match floats {
                [] => place(&light.chunks(2).map(pair).collect::<Vec<u32>>()),
                floats => place(bytemuck::cast_slice(floats)),
            };
            flags |= if floats.is_empty() { 0 } else { MAP_FLOATS };
        }
        let all = (0..LISTS).flat_map(|list| directions.drawn(list));
        let lists: Vec<Vec4> = all.map(|drawn| drawn.direction.extend(drawn.pdf)).collect();
        let drawn = place(bytemuck::cast_slice(&lists));
        // Shaders read a word more than the last.
        place(&[0]);
        check_size(gpu, "radiance map", 4 * words.len() as u64)?;
        let shape = MapData {
            low: grid.low,
            edge: grid.edge,
            size: grid.size,
            places: places as u32,
            directions: directions.len() as u32,
            reach: directions.reach(),
            flags,
            lobes: 0,
            environment_color: Vec3::ONE,
            environment: firsts[0],
            lamps_color: Vec3::ONE,
            lamps: firsts[1],
            glow_color: Vec3::ONE,
            glow: firsts[2],
            scales: Vec3::from(scales),
            below: 0.0,
            starts,
            neighbours,
            positions,
            normals,
            drawn,
            lists: LISTS,
            part: MAP_ALL,
            pad0: 0,
        };
        let words = gpu.buffer("radiance map", bytemuck::cast_slice(&words), wgpu::BufferUsages::STORAGE);
        let with_areas: Vec<Vec4> = (0..directions.len()).map(|k| directions.with_area(k)).collect();
        let with_areas = vectors(gpu, &with_areas);
        Ok(GpuMap { prepared: prepared.clone(), words, shape, with_areas })
    }

    /// Group 3 of a frame: how it is looked up.
    pub fn look(&self, gpu: &Gpu, pass: &RadianceMapPass, look: &Look) -> wgpu::BindGroup {
        pass.look(gpu, &self.data(look), &self.with_areas)
    }

    /// What shaders are told of it.
    fn data(&self, look: &Look) -> MapData {
        let flags =
            [(look.smooth, MAP_SMOOTH), (look.filter.box_shaped, MAP_BOX), (look.filter.unguarded, MAP_UNGUARDED)];
        let flags = flags.into_iter().filter(|(on, _)| *on).map(|(_, flag)| flag).sum::<u32>();
        let [environment_color, lamps_color, glow_color] = look.strengths;
        let is_on = Vec3::from(look.strengths.map(|color| if color == Vec3::ZERO { 0.0 } else { 1.0 }));
        MapData {
            flags: self.shape.flags | flags,
            lobes: look.lobes,
            environment_color,
            lamps_color,
            glow_color,
            scales: is_on * self.shape.scales,
            below: look.below,
            part: match look.part {
                Part::All => MAP_ALL,
                Part::Nothing => MAP_NOTHING,
                Part::Query => MAP_QUERY,
                Part::Search => MAP_SEARCH,
                Part::Filter => MAP_FILTER,
            },
            ..self.shape
        }
    }
}

/// Vectors of as many directions as there may be, as a uniform.
fn vectors(gpu: &Gpu, of: &[Vec4]) -> wgpu::Buffer {
    let mut all = of.to_vec();
    all.resize(MOST_DIRECTIONS, Vec4::ZERO);
    gpu.buffer("directions", bytemuck::cast_slice(&all), wgpu::BufferUsages::UNIFORM)
}

/// What rays find of each material.
pub(crate) fn met(gpu: &Gpu, scene: &Scene) -> wgpu::Buffer {
    let of = |material: usize| {
        let MetSurface { base_color, metallic, alpha, emission, dielectric_f0, dielectric_f90, coat, coat_alpha } =
            MetSurface::of(scene, material);
        MetData { base_color, metallic, emission, dielectric_f90, dielectric_f0, coat, alpha, coat_alpha, pad0: 0 }
    };
    // Never empty.
    let mut list: Vec<MetData> = (0..scene.materials.len()).map(of).collect();
    list.push(bytemuck::Zeroable::zeroed());
    gpu.buffer("met surfaces", bytemuck::cast_slice(&list), wgpu::BufferUsages::STORAGE)
}
