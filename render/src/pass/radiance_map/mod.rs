//! Adds the light of a baked map to all surfaces.

use std::sync::OnceLock;

use crate::device::Gpu;
use crate::layout::types::MapData;
use crate::pass::classical::frame_constants;
use crate::pass::environment::{EnvironmentMaps, cube_sampler, cube_view};
use crate::pass::shadow::Shadows;
use crate::pass::{added, attachment, buffer_entry, fullscreen_pipeline, texture_entry};
use crate::radiance_map::GpuMap;
use crate::shader;

/// The pipelines, with and without rays, each compiled when first drawn with.
pub struct RadianceMapPass {
    device: wgpu::Device,
    format: wgpu::TextureFormat,
    layouts: [wgpu::BindGroupLayout; 4],
    module: OnceLock<wgpu::ShaderModule>,
    pipelines: [OnceLock<wgpu::RenderPipeline>; 2],
}

impl RadianceMapPass {
    /// Compiles nothing yet. The targets are of `format`, which can be blended.
    pub fn new(
        gpu: &Gpu,
        scene_layout: &wgpu::BindGroupLayout,
        gbuffer_layout: &wgpu::BindGroupLayout,
        format: wgpu::TextureFormat,
    ) -> RadianceMapPass {
        let device = &gpu.device;
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let storage = |binding| buffer_entry(binding, fragment, wgpu::BufferBindingType::Storage { read_only: true });
        let sampler = wgpu::BindGroupLayoutEntry {
            binding: 1,
            visibility: fragment,
            ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            count: None,
        };
        let float = wgpu::TextureSampleType::Float { filterable: true };
        let map = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("radiance map"),
            entries: &[
                texture_entry(0, float, wgpu::TextureViewDimension::Cube),
                sampler,
                storage(2),
                storage(3),
                storage(4),
                storage(5),
                storage(6),
                storage(7),
            ],
        });
        let look = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("radiance map look"),
            entries: &[0, 1].map(|binding| buffer_entry(binding, fragment, wgpu::BufferBindingType::Uniform)),
        });
        RadianceMapPass {
            device: device.clone(),
            format,
            layouts: [scene_layout.clone(), gbuffer_layout.clone(), map, look],
            module: OnceLock::new(),
            pipelines: Default::default(),
        }
    }

    /// The pipeline whose smooth surfaces send rays, or that without. Blocks while it is compiled.
    fn pipeline(&self, traced: bool) -> &wgpu::RenderPipeline {
        self.pipelines[usize::from(traced)].get_or_init(|| {
            let module = self.module.get_or_init(|| shader::RADIANCE_MAP.module(&self.device));
            let mut constants = frame_constants(self.format);
            constants.push(("traced", f64::from(u8::from(traced))));
            let layouts = self.layouts.each_ref().map(Some);
            fullscreen_pipeline(&self.device, "radiance map", &layouts, module, added(self.format), &constants)
        })
    }

    /// A map in a scene as group 2.
    pub(crate) fn group(
        &self,
        gpu: &Gpu,
        map: &GpuMap,
        met: &wgpu::Buffer,
        trees: &wgpu::Buffer,
        (environment, shadows, tables): (&EnvironmentMaps, &Shadows, &wgpu::Buffer),
    ) -> wgpu::BindGroup {
        let cube = cube_view(&environment.radiance);
        let sampler = cube_sampler(&gpu.device);
        let resources = [
            wgpu::BindingResource::TextureView(&cube),
            wgpu::BindingResource::Sampler(&sampler),
            tables.as_entire_binding(),
            shadows.lights.as_entire_binding(),
            shadows.unlit.as_entire_binding(),
            trees.as_entire_binding(),
            met.as_entire_binding(),
            map.words.as_entire_binding(),
        ];
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let layout = &self.layouts[2];
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("radiance map"),
            layout,
            entries: &entries,
        })
    }

    /// How it is looked up, as group 3, with its directions.
    pub(crate) fn look(&self, gpu: &Gpu, data: &MapData, directions: &wgpu::Buffer) -> wgpu::BindGroup {
        let buffer = gpu.buffer("radiance map look", bytemuck::bytes_of(data), wgpu::BufferUsages::UNIFORM);
        let entries: Vec<_> = (0..)
            .zip([&buffer, directions])
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("radiance map look"),
            layout: &self.layouts[3],
            entries: &entries,
        })
    }

    /// Adds to some rows of a target.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        groups: [&wgpu::BindGroup; 4],
        traced: bool,
        rows: std::ops::Range<u32>,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("radiance map"),
            color_attachments: &[attachment(target, wgpu::LoadOp::Load)],
            ..Default::default()
        });
        pass.set_pipeline(self.pipeline(traced));
        pass.set_scissor_rect(0, rows.start, target.texture().width(), rows.end - rows.start);
        for (index, group) in groups.into_iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.draw(0..3, 0..1);
    }
}
