//! Shadows of lamps on the ground of the background: the blocked share of its light, for `classical` to darken it by.

use std::ops::Range;
use std::sync::OnceLock;

use crate::device::Gpu;
use crate::pass::gbuffer::{FORMAT, GBuffer};
use crate::pass::{attachment, fullscreen_pipeline, texture_entry};
use crate::shader;

/// The pipelines, and the layout of the words that tell where surfaces are.
pub struct CatcherPass {
    device: wgpu::Device,
    layouts: [wgpu::BindGroupLayout; 4],
    /// Without lights that have an area, and with them.
    pipelines: [OnceLock<wgpu::RenderPipeline>; 2],
}

impl CatcherPass {
    /// Compiles nothing yet.
    pub fn new(
        gpu: &Gpu,
        scene_layout: &wgpu::BindGroupLayout,
        light_layout: &wgpu::BindGroupLayout,
        background_layout: &wgpu::BindGroupLayout,
    ) -> CatcherPass {
        let words = texture_entry(0, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2);
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("catcher"), entries: &[words] });
        CatcherPass {
            device: gpu.device.clone(),
            layouts: [scene_layout.clone(), layout, light_layout.clone(), background_layout.clone()],
            pipelines: Default::default(),
        }
    }

    fn pipeline(&self, areas: bool) -> &wgpu::RenderPipeline {
        self.pipelines[usize::from(areas)].get_or_init(|| {
            let module = shader::CATCHER.module(&self.device);
            let layouts = self.layouts.each_ref().map(Some);
            let constants = [("areas", f64::from(u8::from(areas)))];
            fullscreen_pipeline(&self.device, "catcher", &layouts, &module, FORMAT, &constants)
        })
    }

    /// What it reads of the G-buffer, as group 1.
    pub fn group(&self, gpu: &Gpu, buffer: &GBuffer) -> wgpu::BindGroup {
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("catcher"),
            layout: &self.layouts[1],
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&buffer.words[0]),
            }],
        })
    }

    /// Writes the second words of the G-buffer where the ground is seen, in some rows; `areas` where lights have one.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &GBuffer,
        groups: [&wgpu::BindGroup; 4],
        areas: bool,
        rows: Range<u32>,
    ) {
        let target = &buffer.words[1];
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("catcher"),
            color_attachments: &[attachment(target, wgpu::LoadOp::Load)],
            ..Default::default()
        });
        pass.set_pipeline(self.pipeline(areas));
        pass.set_scissor_rect(0, rows.start, target.texture().width(), rows.end - rows.start);
        for (index, group) in groups.into_iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.draw(0..3, 0..1);
    }
}
