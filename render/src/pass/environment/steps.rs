//! The device's part of building the cubes: a list of tasks that is worked off in slices of any size.

use burnish_core::lighting::classical::{self, CubeSizes, IRRADIANCE_FACE};

use super::plan::{Dimmed, Patch, Plan, padded};
use super::resources::{cube, face_of, level_view, map_texture, source_buffer, tile_count};
use super::{EnvironmentMaps, EnvironmentPass, TILE, cube_view};
use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::EnvironmentStep;

/// Workgroups that every adapter takes at once.
const GROUPS_MAX: u32 = 65_535;

/// The work that is left and what came of it so far.
pub(super) struct Steps {
    plan: Plan,
    maps: EnvironmentMaps,
    /// The map in layers of rows.
    map: wgpu::Texture,
    /// Stands in for what a task does not read; a texture must not be read and written at once.
    blank: wgpu::Texture,
    no_sources: wgpu::Buffer,
    tasks: Vec<Task>,
    /// The task that is next, and how much of it is done.
    next: usize,
    units_done: u32,
    cost_done: f32,
}

/// Equal pieces of work.
struct Task {
    work: Work,
    units: u32,
    /// Nanoseconds that a piece takes on two cores of a software rasteriser.
    unit_cost: f32,
}

enum Work {
    /// Brings the map to the device, a layer a unit.
    Upload,
    /// Darkens the map, a patch a unit, or takes that back.
    Patch(Part, Light),
    /// Copies a level of a cube, a face a unit.
    Copy { from: (wgpu::Texture, u32), to: (wgpu::Texture, u32) },
    /// Computes a level of a cube, a tile a unit.
    Compute(Compute),
}

#[derive(Clone, Copy)]
enum Part {
    Shading,
    Prefilter,
}

#[derive(Clone, Copy, PartialEq)]
enum Light {
    Dimmed,
    Full,
}

struct Compute {
    kernel: Kernel,
    input: Input,
    target: (wgpu::Texture, u32),
    lobe: Lobe,
    /// Numbers of the tiles from an index on; all where there is no list.
    tiles: Option<(wgpu::Buffer, u32)>,
}

/// Entry points of the shader.
#[derive(Clone, Copy)]
pub(super) enum Kernel {
    FromEquirectangular,
    Downsample,
    Prefilter,
    Irradiance,
}

/// What a kernel reads.
enum Input {
    /// The equirectangular map.
    Map,
    /// One level of a cube, texel by texel.
    Level(wgpu::Texture, u32),
    /// A whole cube, filtered.
    Cube(wgpu::Texture),
}

/// The lobe that a kernel filters with.
#[derive(Clone)]
struct Lobe {
    alpha: f32,
    samples: u32,
    /// Bright sources that are added, and how many.
    sources: Option<(wgpu::Buffer, u32)>,
}

impl Lobe {
    const NONE: Lobe = Lobe { alpha: 1.0, samples: 0, sources: None };
}

// Nanoseconds on two cores of llvmpipe: a byte copied, a texel of each kind of level, a sample, a source, a load.
const COPY_COST: f32 = 0.3;
const UPLOAD_COST: f32 = 1.0;
const PATCH_COST: f32 = 20_000.0;
const FILL_COST: f32 = 240.0;
const DOWNSAMPLE_COST: f32 = 60.0;
const SAMPLE_COST: f32 = 28.0;
const SOURCE_COST: f32 = 2.0;
const IRRADIANCE_COST: f32 = 8.0;

const TILE_TEXELS: f32 = (TILE * TILE) as f32;

impl Steps {
    /// Allocates the cubes and lists the work.
    pub fn new(gpu: &Gpu, plan: Plan) -> Result<Steps, RenderError> {
        let CubeSizes { radiance: face, prefiltered, .. } = plan.sizes;
        let levels = plan.sizes.levels();
        let sources = &plan.shading.sources;
        let maps = EnvironmentMaps {
            radiance: cube(gpu, "radiance", face, levels),
            dimmed: cube(gpu, "dimmed radiance", face, levels),
            sources: source_buffer(gpu, sources, plan.scale),
            source_count: sources.len() as u32,
            wide_alpha: plan.wide_alpha,
            prefiltered: cube(gpu, "prefiltered", prefiltered, plan.sizes.prefiltered_levels()),
            irradiance: cube(gpu, "irradiance", IRRADIANCE_FACE, 1),
            scale: plan.scale,
        };
        let mut steps = Steps {
            map: map_texture(gpu, &plan)?,
            blank: cube(gpu, "blank", 1, 1),
            no_sources: source_buffer(gpu, &[], 1.0),
            tasks: Vec::new(),
            next: 0,
            units_done: 0,
            cost_done: 0.0,
            plan,
            maps,
        };
        steps.list(gpu);
        Ok(steps)
    }

    /// The whole work, in order.
    fn list(&mut self, gpu: &Gpu) {
        let layer = self.map.width() * self.map.height() * 16;
        self.push(Work::Upload, self.map.depth_or_array_layers(), layer as f32 * UPLOAD_COST);
        let radiance = self.maps.radiance.clone();
        self.fill(&radiance, None);
        let sizes = self.plan.sizes;
        let level = sizes.levels() - 1 - sizes.irradiance_source.ilog2();
        let irradiance = (self.maps.irradiance.clone(), 0);
        let loads = 6 * sizes.irradiance_source.pow(2);
        self.compute(
            Kernel::Irradiance,
            Input::Level(radiance.clone(), level),
            irradiance,
            loads as f32 * IRRADIANCE_COST,
        );
        let dimmed = self.maps.dimmed.clone();
        self.fill_dimmed(gpu, &dimmed, Part::Shading);
        // Lobes are filtered from what is left without the brightest texels, which are added one by one.
        let without_texels = cube(gpu, "radiance without its brightest texels", sizes.radiance, sizes.levels());
        self.push(Work::Patch(Part::Shading, Light::Full), self.plan.shading.patches.len() as u32, PATCH_COST);
        self.fill_dimmed(gpu, &without_texels, Part::Prefilter);
        self.prefilter(gpu, &without_texels);
    }

    /// All levels of a cube of radiance from the map, or only the listed tiles of each.
    fn fill(&mut self, cube: &wgpu::Texture, listed: Option<(&wgpu::Buffer, &[Vec<u32>])>) {
        let mut first = 0;
        for level in 0..cube.mip_level_count() {
            let (kernel, input, cost) = match level.checked_sub(1) {
                None => (Kernel::FromEquirectangular, Input::Map, FILL_COST),
                Some(finer) => (Kernel::Downsample, Input::Level(cube.clone(), finer), DOWNSAMPLE_COST),
            };
            let target = (cube.clone(), level);
            let Some((buffer, tiles)) = listed else {
                self.compute(kernel, input, target, cost);
                continue;
            };
            let count = tiles.get(level as usize).map_or(0, |tiles| tiles.len() as u32);
            let tiles = Some((buffer.clone(), first));
            let compute = Compute { kernel, input, target, lobe: Lobe::NONE, tiles };
            self.push(Work::Compute(compute), count, cost * TILE_TEXELS);
            first += count;
        }
    }

    /// A cube of the map with one of its parts dimmed: a copy in which the tiles that see it are computed again.
    fn fill_dimmed(&mut self, gpu: &Gpu, cube: &wgpu::Texture, part: Part) {
        for level in 0..cube.mip_level_count() {
            self.copy((&self.maps.radiance.clone(), level), (cube, level));
        }
        let dimmed = self.part(part);
        let (patches, tiles) = (dimmed.patches.len() as u32, dimmed.tiles.clone());
        let mut list = tiles.concat();
        list.resize(list.len().max(1), 0);
        let buffer = gpu.buffer("tiles", bytemuck::cast_slice(&list), wgpu::BufferUsages::STORAGE);
        self.push(Work::Patch(part, Light::Dimmed), patches, PATCH_COST);
        self.fill(cube, Some((&buffer, &tiles)));
    }

    /// The prefiltered levels.
    fn prefilter(&mut self, gpu: &Gpu, without_texels: &wgpu::Texture) {
        let (radiance, prefiltered) = (self.maps.radiance.clone(), self.maps.prefiltered.clone());
        let sources = &self.plan.prefilter.sources;
        let bright = (source_buffer(gpu, sources, self.plan.scale), sources.len() as u32);
        let levels = prefiltered.mip_level_count();
        // Level 0 is the mirror.
        let mirror = (self.plan.sizes.radiance / self.plan.sizes.prefiltered).ilog2();
        self.copy((&radiance, mirror), (&prefiltered, 0));
        for level in 1..levels {
            let roughness = classical::roughness(level as f32, levels as f32);
            let alpha = roughness * roughness;
            let samples = classical::prefilter_samples(level);
            // To a lobe narrower than a texel none is a point; its samples are dense enough to find every texel.
            let wide = alpha >= classical::block_angle(self.plan.environment.width, 1);
            let (from, sources) = if wide { (without_texels, Some(bright.clone())) } else { (&radiance, None) };
            let cost = SAMPLE_COST * samples as f32 + SOURCE_COST * sources.as_ref().map_or(0.0, |s| s.1 as f32);
            let lobe = Lobe { alpha, samples, sources };
            let target = (prefiltered.clone(), level);
            let units = tile_count(&target);
            let compute =
                Compute { kernel: Kernel::Prefilter, input: Input::Cube(from.clone()), target, lobe, tiles: None };
            self.push(Work::Compute(compute), units, cost * TILE_TEXELS);
        }
    }

    fn compute(&mut self, kernel: Kernel, input: Input, target: (wgpu::Texture, u32), texel_cost: f32) {
        let units = tile_count(&target);
        let compute = Compute { kernel, input, target, lobe: Lobe::NONE, tiles: None };
        self.push(Work::Compute(compute), units, texel_cost * TILE_TEXELS);
    }

    fn copy(&mut self, from: (&wgpu::Texture, u32), to: (&wgpu::Texture, u32)) {
        let edge = (to.0.width() >> to.1).max(1);
        let work = Work::Copy { from: (from.0.clone(), from.1), to: (to.0.clone(), to.1) };
        self.push(work, 6, (edge * edge * 8) as f32 * COPY_COST);
    }

    fn push(&mut self, work: Work, units: u32, unit_cost: f32) {
        if units > 0 {
            self.tasks.push(Task { work, units, unit_cost });
        }
    }

    fn part(&self, part: Part) -> &Dimmed {
        match part {
            Part::Shading => &self.plan.shading,
            Part::Prefilter => &self.plan.prefilter,
        }
    }

    /// The cubes, complete once `slice` says that there is no more.
    pub fn into_maps(self) -> EnvironmentMaps {
        self.maps
    }

    /// The share that is submitted, by its cost.
    pub fn fraction(&self) -> f32 {
        let total: f32 = self.tasks.iter().map(|task| task.units as f32 * task.unit_cost).sum();
        if total > 0.0 { (self.cost_done / total).min(1.0) } else { 1.0 }
    }

    /// Submits work of about that cost, at least one piece of it. True while there is more.
    pub fn slice(&mut self, gpu: &Gpu, pass: &EnvironmentPass, cost: f32) -> bool {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let (mut left, mut encoded) = (cost, false);
        while let Some(task) = self.tasks.get(self.next) {
            let writes = matches!(task.work, Work::Upload | Work::Patch(..));
            // What the queue writes happens before what the encoder holds.
            if left <= 0.0 || (encoded && writes) {
                break;
            }
            let open = (task.units - self.units_done).min(GROUPS_MAX);
            let count = ((left / task.unit_cost) as u32).clamp(1, open);
            let units = self.units_done..self.units_done + count;
            self.encode(gpu, pass, &mut encoder, &task.work, units);
            encoded |= !writes;
            left -= count as f32 * task.unit_cost;
            self.cost_done += count as f32 * task.unit_cost;
            self.units_done += count;
            if self.units_done == task.units {
                self.next += 1;
                self.units_done = 0;
            }
        }
        gpu.queue.submit([encoder.finish()]);
        self.next < self.tasks.len()
    }

    fn encode(
        &self,
        gpu: &Gpu,
        pass: &EnvironmentPass,
        encoder: &mut wgpu::CommandEncoder,
        work: &Work,
        units: std::ops::Range<u32>,
    ) {
        match work {
            Work::Upload => units.for_each(|layer| self.upload_layer(gpu, layer)),
            Work::Patch(part, light) => {
                let units = units.start as usize..units.end as usize;
                for patch in self.part(*part).patches.get(units).unwrap_or_default() {
                    self.upload_patch(gpu, patch, *light);
                }
            }
            Work::Copy { from, to } => {
                let edge = (to.0.width() >> to.1).max(1);
                let size = wgpu::Extent3d { width: edge, height: edge, depth_or_array_layers: units.len() as u32 };
                encoder.copy_texture_to_texture(face_of(from, units.start), face_of(to, units.start), size);
            }
            Work::Compute(compute) => self.dispatch(gpu, pass, encoder, compute, units),
        }
    }

    /// A layer of the map; rows below its last are black.
    fn upload_layer(&self, gpu: &Gpu, layer: u32) {
        let (width, rows) = (self.map.width() as usize, self.map.height() as usize);
        let texels = &self.plan.environment.texels;
        let start = (layer as usize * rows * width).min(texels.len());
        let end = (start + rows * width).min(texels.len());
        let mut bytes: Vec<[f32; 4]> = Vec::with_capacity(rows * width);
        bytes.extend(padded(&texels[start..end]));
        bytes.resize(rows * width, [0.0; 4]);
        self.write(gpu, [0, 0, layer], [self.map.width(), self.map.height()], &bytes);
    }

    fn upload_patch(&self, gpu: &Gpu, patch: &Patch, light: Light) {
        let environment = &self.plan.environment;
        let layer_rows = self.map.height();
        for row in 0..patch.height {
            let y = patch.y + row;
            let texels: Vec<[f32; 4]> = match light {
                Light::Dimmed => {
                    let start = (row * patch.width) as usize;
                    patch.texels.iter().skip(start).take(patch.width as usize).copied().collect()
                }
                Light::Full => {
                    let start = (y * environment.width + patch.x) as usize;
                    padded(&environment.texels[start..start + patch.width as usize]).collect()
                }
            };
            self.write(gpu, [patch.x, y % layer_rows, y / layer_rows], [patch.width, 1], &texels);
        }
    }

    fn write(&self, gpu: &Gpu, [x, y, z]: [u32; 3], [width, height]: [u32; 2], texels: &[[f32; 4]]) {
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x, y, z }, ..self.map.as_image_copy() },
            bytemuck::cast_slice(texels),
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 16), rows_per_image: Some(height) },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
    }

    fn dispatch(
        &self,
        gpu: &Gpu,
        pass: &EnvironmentPass,
        encoder: &mut wgpu::CommandEncoder,
        compute: &Compute,
        units: std::ops::Range<u32>,
    ) {
        let Compute { kernel, input, target, lobe, tiles } = compute;
        let params = EnvironmentStep {
            levels: self.plan.sizes.levels() as f32,
            alpha: lobe.alpha,
            samples: lobe.samples,
            scale: 1.0 / self.plan.scale,
            sources: lobe.sources.as_ref().map_or(0, |(_, count)| *count),
            first_tile: tiles.as_ref().map_or(0, |(_, first)| *first) + units.start,
            listed: u32::from(tiles.is_some()),
            rows: self.plan.environment.height,
        };
        let params = gpu.buffer("environment step", bytemuck::bytes_of(&params), wgpu::BufferUsages::UNIFORM);
        let level = match input {
            Input::Level(texture, level) => level_view(texture, *level),
            _ => level_view(&self.blank, 0),
        };
        let cube = match input {
            Input::Cube(texture) => cube_view(texture),
            _ => cube_view(&self.blank),
        };
        let map = self.map.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let sources = lobe.sources.as_ref().map_or(&self.no_sources, |(buffer, _)| buffer);
        let tiles = tiles.as_ref().map_or(&self.no_sources, |(buffer, _)| buffer);
        let target_view = level_view(&target.0, target.1);
        let resources = [
            params.as_entire_binding(),
            wgpu::BindingResource::TextureView(&map),
            wgpu::BindingResource::TextureView(&level),
            wgpu::BindingResource::TextureView(&cube),
            wgpu::BindingResource::Sampler(&pass.sampler),
            wgpu::BindingResource::TextureView(&target_view),
            sources.as_entire_binding(),
            tiles.as_entire_binding(),
        ];
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("environment step"),
            layout: &pass.layout,
            entries: &entries,
        });
        let mut pass_encoder = encoder.begin_compute_pass(&Default::default());
        pass_encoder.set_pipeline(pass.pipeline(*kernel));
        pass_encoder.set_bind_group(0, &group, &[]);
        pass_encoder.dispatch_workgroups(units.len() as u32, 1, 1);
    }
}
