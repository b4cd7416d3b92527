//! Sums jittered frames in 32-bit floats.

use glam::UVec2;

use crate::device::Gpu;
use crate::pass::{cleared, fullscreen_pipeline, target, texture_entry};
use crate::shader;

/// Format of the sum.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Two sums of one size: one is read while the other is written.
pub struct Sums {
    textures: [wgpu::Texture; 2],
    /// Which of them holds the sum so far.
    current: usize,
}

impl Sums {
    /// Allocates both.
    pub fn new(gpu: &Gpu, size: UVec2) -> Sums {
        Sums { textures: std::array::from_fn(|_| target(gpu, "sum", size, FORMAT)), current: 0 }
    }

    /// The sum so far.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.textures[self.current]
    }

    /// Gives the sum away. What takes its place is cleared before it is added to.
    pub fn take(&mut self, gpu: &Gpu) -> wgpu::Texture {
        let size = self.texture().size();
        let fresh = target(gpu, "sum", UVec2::new(size.width, size.height), FORMAT);
        std::mem::replace(&mut self.textures[self.current], fresh)
    }

    /// Takes a sum back.
    pub fn put(&mut self, sum: wgpu::Texture) {
        self.textures[self.current] = sum;
    }

    /// Starts from zero.
    pub fn clear(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let view = self.texture().create_view(&Default::default());
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("clear sum"),
            color_attachments: &[cleared(&view)],
            ..Default::default()
        });
    }
}

/// The pipeline.
pub struct AccumulatePass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl AccumulatePass {
    /// Compiles the pipeline.
    pub fn new(gpu: &Gpu) -> AccumulatePass {
        let device = &gpu.device;
        let float = wgpu::TextureSampleType::Float { filterable: false };
        let entry = |binding| texture_entry(binding, float, wgpu::TextureViewDimension::D2);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("accumulate"),
            entries: &[entry(0), entry(1)],
        });
        let module = shader::ACCUMULATE.module(device);
        let pipeline = fullscreen_pipeline(device, "accumulate", &[Some(&layout)], &module, FORMAT, &[]);
        AccumulatePass { layout, pipeline }
    }

    /// Adds `frame` to the sum.
    pub fn encode(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, frame: &wgpu::TextureView, sums: &mut Sums) {
        let before = sums.texture().create_view(&Default::default());
        sums.current = 1 - sums.current;
        let after = sums.texture().create_view(&Default::default());
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("accumulate"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(frame) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&before) },
            ],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("accumulate"),
            color_attachments: &[cleared(&after)],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}
