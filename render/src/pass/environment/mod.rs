//! Cubes of an environment: radiance with box-filtered mips, radiance prefiltered with the GGX lobe, irradiance.
//!
//! They hold half floats of `radiance / scale`, so that a sun does not overflow them.

mod background;
mod coarse;
mod plan;
mod refine;
mod resources;
mod steps;
mod uploaded;

use burnish_core::scene::Environment;

use crate::device::Gpu;
use crate::error::RenderError;
use crate::shader;

pub use background::{BackgroundMap, background_layout};
pub use coarse::downsampled;
use plan::Plan;
pub use refine::{Progress, Refinement};
use steps::{Kernel, Steps};

/// Edge of a workgroup, a square of texels.
const TILE: u32 = 8;
/// Nanoseconds of a software rasteriser that one submission takes where nobody waits for a frame.
const SLICE_COST: f32 = 1e8;
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
            irradiance: pipeline("irradiance"),
            sampler: cube_sampler(device),
            layout,
        }
    }

    /// Small cubes of the map: a first picture of the right brightness, until a [`Refinement`] is through.
    pub fn coarse(&self, gpu: &Gpu, environment: &Environment) -> Result<EnvironmentMaps, RenderError> {
        self.run(gpu, Plan::coarse(&downsampled(environment)))
    }

    /// Builds the cubes; the work is submitted, not awaited.
    pub fn build(&self, gpu: &Gpu, environment: &Environment) -> Result<EnvironmentMaps, RenderError> {
        self.run(gpu, Plan::new(environment))
    }

    fn run(&self, gpu: &Gpu, plan: Plan) -> Result<EnvironmentMaps, RenderError> {
        let mut steps = Steps::new(gpu, plan)?;
        // Many submissions: a long one might be held against the program by a watchdog.
        while steps.slice(gpu, self, SLICE_COST) {}
        Ok(steps.into_maps())
    }

    fn pipeline(&self, kernel: Kernel) -> &wgpu::ComputePipeline {
        match kernel {
            Kernel::FromEquirectangular => &self.from_equirectangular,
            Kernel::Downsample => &self.downsample,
            Kernel::Prefilter => &self.prefilter,
            Kernel::Irradiance => &self.irradiance,
        }
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

fn layout_entries() -> [wgpu::BindGroupLayoutEntry; 8] {
    let texture = |dimension, filterable| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension: dimension,
        multisampled: false,
    };
    let storage = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let kinds = [
        wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        texture(wgpu::TextureViewDimension::D2Array, false),
        texture(wgpu::TextureViewDimension::D2Array, false),
        texture(wgpu::TextureViewDimension::Cube, true),
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: FORMAT,
            view_dimension: wgpu::TextureViewDimension::D2Array,
        },
        storage,
        storage,
    ];
    let mut binding = 0;
    kinds.map(|ty| {
        let entry = wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None };
        binding += 1;
        entry
    })
}
