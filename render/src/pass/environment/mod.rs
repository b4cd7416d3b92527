//! Cubes of an environment: radiance with box-filtered mips, radiance prefiltered with the GGX lobe, irradiance.
//!
//! They hold half floats of `radiance / scale`, so that a sun does not overflow them.

mod coarse;
mod refine;

use burnish_core::lighting::classical;
use burnish_core::scene::Environment;
use bytemuck::Zeroable;
use glam::Vec3;
use wgpu::util::DeviceExt;

use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::{EnvironmentStep, SourceData};
use crate::shader;

pub use coarse::downsampled;
pub use refine::{Progress, Refinement};

/// Largest value stored in a cube.
const STORED_MAX: f32 = 60_000.0;
/// Largest edge of a face; beyond it the cubes cost more memory than the eye gains.
const FACE_MAX: u32 = 1024;
/// Smallest edge of a face: below it there would be too few levels to tell one roughness from another.
const FACE_MIN: u32 = 64;
/// Edge of the coarsest prefiltered level: its lobe is a hemisphere wide.
const COARSEST: u32 = 8;
/// Edge of a face of the irradiance cube.
const IRRADIANCE_FACE: u32 = 16;
/// Edge of the level of radiance from which irradiance is summed.
const IRRADIANCE_SOURCE: u32 = 32;
/// Format of all cubes.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// The cubes of one environment.
pub struct EnvironmentMaps {
    /// Box-filtered radiance over scale, all levels.
    pub radiance: wgpu::Texture,
    /// GGX-filtered radiance over scale; level widths by `classical::roughness`.
    pub prefiltered: wgpu::Texture,
    /// Radiance over scale without the light of the sources.
    pub dimmed: wgpu::Texture,
    /// `SourceData` of the brightest blocks of texels, never empty.
    pub sources: wgpu::Buffer,
    /// How many of them count.
    pub source_count: u32,
    /// Width from which they are points to a lobe.
    pub wide_alpha: f32,
    /// Irradiance over scale.
    pub irradiance: wgpu::Texture,
    /// Factor from a texel to radiance.
    pub scale: f32,
}

/// Pipelines that build [`EnvironmentMaps`].
pub struct EnvironmentPass {
    layout: wgpu::BindGroupLayout,
    from_equirectangular: wgpu::ComputePipeline,
    downsample: wgpu::ComputePipeline,
    prefilter: wgpu::ComputePipeline,
    copy: wgpu::ComputePipeline,
    irradiance: wgpu::ComputePipeline,
    sampler: wgpu::Sampler,
}

impl EnvironmentPass {
    /// Compiles the pipelines.
    pub fn new(gpu: &Gpu) -> EnvironmentPass {
        let device = &gpu.device;
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("environment"),
            entries: &layout_entries(),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("environment"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = shader::ENVIRONMENT.module(device);
        let pipeline = |entry: &str| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            })
        };
        EnvironmentPass {
            from_equirectangular: pipeline("from_equirectangular"),
            downsample: pipeline("downsample"),
            prefilter: pipeline("prefilter"),
            copy: pipeline("copy"),
            irradiance: pipeline("irradiance"),
            sampler: cube_sampler(device),
            layout,
        }
    }

    /// Small cubes of the map: a first picture of the right brightness, until a [`Refinement`] is through.
    pub fn coarse(&self, gpu: &Gpu, environment: &Environment) -> Result<EnvironmentMaps, RenderError> {
        self.build(gpu, &downsampled(environment))
    }

    /// Builds the cubes; the work is submitted, not awaited.
    pub fn build(&self, gpu: &Gpu, environment: &Environment) -> Result<EnvironmentMaps, RenderError> {
        let face = (environment.width / 2).next_power_of_two().clamp(FACE_MIN, FACE_MAX);
        let levels = face.ilog2() + 1;
        let prefiltered_levels = levels - COARSEST.ilog2();
        let largest = environment.texels.iter().map(|c| c.max_element()).fold(0.0, f32::max);
        let scale = (largest / STORED_MAX).max(1.0);
        let block = classical::shading_block(environment.width);
        let blocks = classical::split(environment, block, classical::SHADING_SOURCES);
        let maps = EnvironmentMaps {
            radiance: cube(gpu, "radiance", face, levels),
            dimmed: cube(gpu, "dimmed radiance", face, levels),
            sources: source_buffer(gpu, &blocks.sources, scale),
            source_count: blocks.sources.len() as u32,
            wide_alpha: classical::wide_alpha(environment.width, block),
            prefiltered: cube(gpu, "prefiltered", face, prefiltered_levels),
            irradiance: cube(gpu, "irradiance", IRRADIANCE_FACE, 1),
            scale,
        };
        let steps = Steps {
            pass: self,
            gpu,
            blank: &cube(gpu, "blank", 1, 1),
            blank_map: &upload(gpu, &Environment::new("blank", 1, 1, vec![Vec3::ZERO]))?,
            no_sources: &source_buffer(gpu, &[], scale),
            levels,
            scale,
        };
        steps.fill(&maps.radiance, environment)?;
        steps.fill(&maps.dimmed, &blocks.dimmed)?;
        steps.run(&self.copy, Input::Level(&maps.radiance, 0), (&maps.prefiltered, 0), Lobe::NONE);
        // Lobes are filtered from what is left without the brightest texels, which are added one by one. To a lobe
        // narrower than a texel none is a point; its samples are dense enough to find every texel.
        let texels = classical::split(environment, 1, classical::PREFILTER_SOURCES);
        let without_texels = cube(gpu, "radiance without its brightest texels", face, levels);
        steps.fill(&without_texels, &texels.dimmed)?;
        let bright = source_buffer(gpu, &texels.sources, scale);
        for level in 1..prefiltered_levels {
            let roughness = classical::roughness(level as f32, prefiltered_levels as f32);
            let alpha = roughness * roughness;
            let samples = classical::prefilter_samples(level);
            let wide = alpha >= classical::block_angle(environment.width, 1);
            let (from, sources) =
                if wide { (&without_texels, Some((&bright, texels.sources.len()))) } else { (&maps.radiance, None) };
            let lobe = Lobe { alpha, samples, sources };
            steps.run(&self.prefilter, Input::Cube(from), (&maps.prefiltered, level), lobe);
        }
        let coarse = levels - 1 - IRRADIANCE_SOURCE.min(face).ilog2();
        steps.run(&self.irradiance, Input::Level(&maps.radiance, coarse), (&maps.irradiance, 0), Lobe::NONE);
        Ok(maps)
    }
}

/// Linear in all directions; cubes are seamless by themselves.
pub fn cube_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("cube"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// A view of all levels as a cube.
pub fn cube_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::Cube),
        ..Default::default()
    })
}

/// What a step reads.
enum Input<'a> {
    /// An equirectangular map.
    Map(&'a wgpu::TextureView),
    /// One level of a cube, texel by texel.
    Level(&'a wgpu::Texture, u32),
    /// A whole cube, filtered.
    Cube(&'a wgpu::Texture),
}

/// The lobe that a step filters with.
struct Lobe<'a> {
    alpha: f32,
    samples: u32,
    /// Bright sources that are added, and how many.
    sources: Option<(&'a wgpu::Buffer, usize)>,
}

impl Lobe<'_> {
    const NONE: Lobe<'static> = Lobe { alpha: 1.0, samples: 0, sources: None };
}

/// What all steps of one build share.
struct Steps<'a> {
    pass: &'a EnvironmentPass,
    gpu: &'a Gpu,
    /// Stands in for what a step does not read; a texture must not be read and written at once.
    blank: &'a wgpu::Texture,
    blank_map: &'a wgpu::TextureView,
    no_sources: &'a wgpu::Buffer,
    levels: u32,
    scale: f32,
}

impl Steps<'_> {
    /// Fills all levels of a cube of radiance from a map.
    fn fill(&self, cube: &wgpu::Texture, map: &Environment) -> Result<(), RenderError> {
        let map = upload(self.gpu, map)?;
        self.run(&self.pass.from_equirectangular, Input::Map(&map), (cube, 0), Lobe::NONE);
        for level in 1..cube.mip_level_count() {
            self.run(&self.pass.downsample, Input::Level(cube, level - 1), (cube, level), Lobe::NONE);
        }
        Ok(())
    }

    fn run(&self, pipeline: &wgpu::ComputePipeline, input: Input, target: (&wgpu::Texture, u32), lobe: Lobe) {
        let device = &self.gpu.device;
        let params = EnvironmentStep {
            levels: self.levels as f32,
            alpha: lobe.alpha,
            samples: lobe.samples,
            scale: 1.0 / self.scale,
            sources: lobe.sources.map_or(0, |(_, count)| count as u32),
            pad0: 0,
            pad1: 0,
            pad2: 0,
        };
        let params = self.gpu.buffer("environment step", bytemuck::bytes_of(&params), wgpu::BufferUsages::UNIFORM);
        let level = match input {
            Input::Level(texture, level) => level_view(texture, level),
            _ => level_view(self.blank, 0),
        };
        let cube = match input {
            Input::Cube(texture) => cube_view(texture),
            _ => cube_view(self.blank),
        };
        let map = if let Input::Map(map) = input { map } else { self.blank_map };
        let sources = lobe.sources.map_or(self.no_sources, |(buffer, _)| buffer);
        let target_view = level_view(target.0, target.1);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("environment step"),
            layout: &self.pass.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: params.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(map) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(&level) },
                wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::TextureView(&cube) },
                wgpu::BindGroupEntry { binding: 4, resource: wgpu::BindingResource::Sampler(&self.pass.sampler) },
                wgpu::BindGroupEntry { binding: 5, resource: wgpu::BindingResource::TextureView(&target_view) },
                wgpu::BindGroupEntry { binding: 6, resource: sources.as_entire_binding() },
            ],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            let groups = (target.0.width() >> target.1).max(1).div_ceil(8);
            pass.dispatch_workgroups(groups, groups, 6);
        }
        // One submission a step: a long step must not be held against the next by a watchdog.
        self.gpu.queue.submit([encoder.finish()]);
    }
}

fn level_view(texture: &wgpu::Texture, level: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}

fn cube(gpu: &Gpu, label: &str, face: u32, levels: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: face, height: face, depth_or_array_layers: 6 },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// The sources for the shader; never empty.
fn source_buffer(gpu: &Gpu, sources: &[classical::Source], scale: f32) -> wgpu::Buffer {
    let mut data: Vec<SourceData> = sources
        .iter()
        .map(|s| SourceData { direction: s.direction, pad0: 0, power: s.power / scale, pad1: 0 })
        .collect();
    data.resize(data.len().max(1), SourceData::zeroed());
    gpu.buffer("bright sources", bytemuck::cast_slice(&data), wgpu::BufferUsages::STORAGE)
}

/// The map as floats; it is dropped once the cubes are built.
fn upload(gpu: &Gpu, environment: &Environment) -> Result<wgpu::TextureView, RenderError> {
    let allowed = gpu.device.limits().max_texture_dimension_2d;
    if environment.width.max(environment.height) > allowed {
        return Err(RenderError::TooLarge {
            what: format!("environment `{}`, pixels across", environment.name),
            bytes: u64::from(environment.width.max(environment.height)),
            allowed: u64::from(allowed),
        });
    }
    let texels: Vec<[f32; 4]> = environment.texels.iter().map(|c| [c.x, c.y, c.z, 1.0]).collect();
    let texture = gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("equirectangular"),
            size: wgpu::Extent3d { width: environment.width, height: environment.height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(&texels),
    );
    Ok(texture.create_view(&Default::default()))
}

fn layout_entries() -> [wgpu::BindGroupLayoutEntry; 7] {
    let texture = |dimension, filterable| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension: dimension,
        multisampled: false,
    };
    let kinds = [
        wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        texture(wgpu::TextureViewDimension::D2, false),
        texture(wgpu::TextureViewDimension::D2Array, false),
        texture(wgpu::TextureViewDimension::Cube, true),
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: FORMAT,
            view_dimension: wgpu::TextureViewDimension::D2Array,
        },
        wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
    ];
    let mut binding = 0;
    kinds.map(|ty| {
        let entry = wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None };
        binding += 1;
        entry
    })
}
