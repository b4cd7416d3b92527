//! Baked radiance maps on the device, and what rays find of materials there.

use std::sync::Arc;

use burnish_core::lighting::Prepared;
use burnish_core::lighting::radiance_map::{self, Look, MetSurface};
use burnish_core::scene::Scene;
use glam::{UVec3, Vec3, Vec4};

use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::{MAP_BOX, MAP_SMOOTH, MAP_UNGUARDED, MapData, MetData};
use crate::pass::radiance_map::RadianceMapPass;
use crate::scene::check_size;

/// Directions of a map, at most: as many as its setting takes.
const MOST_DIRECTIONS: usize = 1024;

/// Lists of directions, one drawn in each cell: pixels and frames take turns, so that errors of few do not add up over the picture.
const LISTS: u32 = 256;

/// The map of a preparation: one buffer of words, since shaders read few buffers.
pub(crate) struct GpuMap {
    pub prepared: Arc<Prepared>,
    pub words: wgpu::Buffer,
    /// Where things are in it; [`GpuMap::data`] adds how they are looked up.
    shape: MapData,
    /// Directions and areas of their cells, for shaders.
    with_areas: wgpu::Buffer,
    /// What the numbers of each group are multiplied by; 0 for those that are dark.
    scales: [f32; 3],
}

impl GpuMap {
    pub fn new(gpu: &Gpu, prepared: &Arc<Prepared>) -> Result<GpuMap, RenderError> {
        let unfit = || RenderError::Preparation("it holds no radiance map; prepare it again".into());
        let directions = radiance_map::baked_directions(prepared).ok_or_else(unfit)?;
        let (positions, normals) = (prepared.floats("positions"), prepared.floats("normals"));
        let (starts, neighbours) = (prepared.whole("starts"), prepared.whole("neighbours"));
        let size = prepared.whole("cells");
        let places = positions.len() / 3;
        let cells = size.iter().map(|count| *count as usize).product::<usize>();
        let is_whole = places > 0
            && normals.len() == positions.len()
            && neighbours.len() == radiance_map::SET * places
            && size.len() == 3
            && starts.len() == cells + 1;
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
        let (mut scales, mut firsts) = ([0.0; 3], [0; 3]);
        for (group, name) in radiance_map::GROUPS.iter().enumerate() {
            let light = prepared.halves(name);
            if light.is_empty() {
                continue;
            }
            if light.len() != 3 * places * directions.len() {
                return Err(unfit());
            }
            scales[group] = prepared.floats(&format!("{name} scale")).first().copied().unwrap_or(1.0);
            let pair = |pair: &[half::f16]| {
                u32::from(pair[0].to_bits()) | u32::from(pair.get(1).map_or(0, |h| h.to_bits())) << 16
            };
            let packed: Vec<u32> = light.chunks(2).map(pair).collect();
            firsts[group] = place(&packed);
        }
        let mut lists: Vec<Vec4> = Vec::with_capacity(LISTS as usize * directions.len());
        for list in 0..LISTS {
            // Steps of the plastic number and of the golden ratio.
            let turn = (list as f32 * Vec3::new(0.754_877_7, 0.569_840_3, 0.618_034)).fract();
            lists.extend(directions.drawn_all(turn).map(|drawn| drawn.direction.extend(drawn.pdf)));
        }
        let drawn = place(bytemuck::cast_slice(&lists));
        // Shaders read a word more than the last.
        place(&[0]);
        check_size(gpu, "radiance map", 4 * words.len() as u64)?;
        let shape = MapData {
            low: prepared.vector("grid", 0),
            edge: prepared.vector("grid", 1).x,
            size: UVec3::from_slice(size),
            places: places as u32,
            directions: directions.len() as u32,
            reach: directions.reach(),
            flags: 0,
            lobes: 0,
            factors: Vec3::ZERO,
            below: 0.0,
            strengths: Vec3::ONE,
            starts,
            neighbours,
            positions,
            normals,
            environment: firsts[0],
            lamps: firsts[1],
            glow: firsts[2],
            drawn,
            lists: LISTS,
        };
        let words = gpu.buffer("radiance map", bytemuck::cast_slice(&words), wgpu::BufferUsages::STORAGE);
        let with_areas: Vec<Vec4> = (0..directions.len()).map(|k| directions.with_area(k)).collect();
        let with_areas = vectors(gpu, &with_areas);
        Ok(GpuMap { prepared: prepared.clone(), words, shape, with_areas, scales })
    }

    /// Group 3 of a frame: how it is looked up.
    pub fn look(&self, gpu: &Gpu, pass: &RadianceMapPass, look: &Look) -> wgpu::BindGroup {
        pass.look(gpu, &self.data(look), &self.with_areas)
    }

    /// What shaders are told of it.
    fn data(&self, look: &Look) -> MapData {
        let flags =
            [(look.smooth, MAP_SMOOTH), (look.filter.box_shaped, MAP_BOX), (look.filter.unguarded, MAP_UNGUARDED)];
        let strengths = Vec3::from(look.strengths);
        MapData {
            flags: flags.into_iter().filter(|(on, _)| *on).map(|(_, flag)| flag).sum(),
            lobes: look.lobes,
            factors: strengths * Vec3::from(self.scales),
            strengths,
            below: look.below,
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
