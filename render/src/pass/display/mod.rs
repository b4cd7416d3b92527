//! The display transform: exposure, tone map and sRGB encoding into 8 bits; false colours and marks of clipping instead.

use burnish_core::color::tone::{ToneMap, exposure_factor};
use burnish_core::measure::view::DisplayMode;

use crate::device::Gpu;
use crate::layout::types::DisplayData;
use crate::pass::{buffer_entry, cleared, fullscreen_pipeline, texture_entry};
use crate::shader;

/// Plain bytes that hold the encoded values; nothing may decode or encode them once more.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// How a picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// Display transform.
    pub tone: ToneMap,
    /// Factor on the radiance before it, as a power of two.
    pub exposure_ev: f32,
    /// The picture, or what judges its exposure.
    pub mode: DisplayMode,
}

/// What is shown.
#[derive(Clone, Copy)]
pub struct Shown<'a> {
    /// A sum of frames.
    pub sum: &'a wgpu::TextureView,
    /// How many they are.
    pub frames: u32,
    /// The sum of another picture of the same size with its frames, and its weight in what is shown, 0 to 1.
    pub before: Option<(&'a wgpu::TextureView, u32, f32)>,
}

/// The pipeline.
pub struct DisplayPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl DisplayPass {
    /// Compiles the pipeline.
    pub fn new(gpu: &Gpu) -> DisplayPass {
        let device = &gpu.device;
        let float = wgpu::TextureSampleType::Float { filterable: false };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("display"),
            entries: &[
                buffer_entry(0, wgpu::ShaderStages::FRAGMENT, wgpu::BufferBindingType::Uniform),
                texture_entry(1, float, wgpu::TextureViewDimension::D2),
                texture_entry(2, float, wgpu::TextureViewDimension::D2),
            ],
        });
        let module = shader::DISPLAY.module(device);
        let pipeline = fullscreen_pipeline(device, "display", &[Some(&layout)], &module, FORMAT, &[]);
        DisplayPass { layout, pipeline }
    }

    /// Shows the mean of frames.
    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        Shown { sum, frames, before }: Shown<'_>,
        output: &wgpu::TextureView,
        Display { tone, exposure_ev, mode }: Display,
    ) {
        let exposure = exposure_factor(exposure_ev);
        let (sum_before, frames_before, weight) = before.unwrap_or((sum, 1, 0.0));
        let factor = exposure * (1.0 - weight) / frames.max(1) as f32;
        let before = exposure * weight / frames_before.max(1) as f32;
        let data = DisplayData { factor, tone: tone.number(), mode: mode.number(), before };
        let uniform = gpu.buffer("display", bytemuck::bytes_of(&data), wgpu::BufferUsages::UNIFORM);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("display"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(sum) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(sum_before) },
            ],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("display"),
            color_attachments: &[cleared(output)],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}
