//! Lights the G-buffer with lamps and the `classical` environment, and shows the environment behind it.

use std::sync::OnceLock;

use crate::device::Gpu;
use crate::pass::environment::{EnvironmentMaps, cube_sampler, cube_view};
use crate::pass::gbuffer::GBuffer;
use crate::pass::shadow::{self, Shadows};
use crate::pass::{attachment, buffer_entry, cleared, fullscreen_pipeline, texture_entry};
use crate::shader;

/// Layout of what `shade.wgsl` reads at group 2.
///
/// With the eleven textures of a material the forward pass reads 16, as many as every adapter allows: a further map must
/// share one of these.
pub fn light_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let float = wgpu::TextureSampleType::Float { filterable: true };
    let cube = wgpu::TextureViewDimension::Cube;
    let fragment = wgpu::ShaderStages::FRAGMENT;
    let storage = wgpu::BufferBindingType::Storage { read_only: true };
    let sampler = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: fragment,
        ty: wgpu::BindingType::Sampler(ty),
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("light"),
        entries: &[
            texture_entry(0, float, cube),
            texture_entry(1, float, cube),
            texture_entry(2, float, cube),
            sampler(3, wgpu::SamplerBindingType::Filtering),
            texture_entry(4, wgpu::TextureSampleType::Depth, wgpu::TextureViewDimension::D2Array),
            sampler(5, wgpu::SamplerBindingType::Comparison),
            buffer_entry(6, fragment, storage),
            buffer_entry(7, fragment, storage),
            buffer_entry(8, fragment, storage),
            texture_entry(9, float, cube),
            buffer_entry(10, fragment, storage),
            buffer_entry(11, fragment, storage),
            buffer_entry(12, fragment, wgpu::BufferBindingType::Uniform),
        ],
    })
}

/// Group 2 for these lights, this environment, these tables and places of probes.
pub fn light_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    maps: &EnvironmentMaps,
    shadows: &Shadows,
    (tables, places): (&wgpu::Buffer, &wgpu::Buffer),
) -> wgpu::BindGroup {
    let cubes = [&maps.radiance, &maps.prefiltered, &maps.irradiance, &maps.dimmed].map(cube_view);
    let cube_sampler = cube_sampler(&gpu.device);
    let shadow_sampler = shadow::sampler(&gpu.device);
    let resources = [
        wgpu::BindingResource::TextureView(&cubes[0]),
        wgpu::BindingResource::TextureView(&cubes[1]),
        wgpu::BindingResource::TextureView(&cubes[2]),
        wgpu::BindingResource::Sampler(&cube_sampler),
        wgpu::BindingResource::TextureView(&shadows.maps),
        wgpu::BindingResource::Sampler(&shadow_sampler),
        shadows.lights.as_entire_binding(),
        shadows.clip_from_world.as_entire_binding(),
        tables.as_entire_binding(),
        wgpu::BindingResource::TextureView(&cubes[3]),
        maps.sources.as_entire_binding(),
        shadows.unlit.as_entire_binding(),
        places.as_entire_binding(),
    ];
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("light"), layout, entries: &entries })
}

/// The largest radiance that a target holds, for `shade.wgsl`: halves overflow at 65 520.
pub fn frame_constants(format: wgpu::TextureFormat) -> Vec<(&'static str, f64)> {
    if format == wgpu::TextureFormat::Rgba16Float { vec![("frame_max", 65_000.0)] } else { Vec::new() }
}

/// The pipelines and the layout of the G-buffer as textures.
pub struct ClassicalPass {
    device: wgpu::Device,
    layout: wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
    /// The driver compiles for the processor.
    software: bool,
    layouts: [wgpu::BindGroupLayout; 4],
    module: OnceLock<wgpu::ShaderModule>,
    /// By their variants.
    pipelines: [OnceLock<wgpu::RenderPipeline>; 16],
}

/// What a picture needs of the shader. A software driver compiles less in a part of the time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Variant {
    /// Samples lobes, as often as the view says; else they are looked up once.
    pub sampled: bool,
    /// Sums lights with an area.
    pub areas: bool,
    /// Leaves to probes what they know.
    pub probed: bool,
    /// Leaves the environment to another pass.
    pub mapped: bool,
}

impl ClassicalPass {
    /// Compiles nothing yet. The targets are of `format`.
    pub fn new(
        gpu: &Gpu,
        scene_layout: &wgpu::BindGroupLayout,
        light_layout: &wgpu::BindGroupLayout,
        background_layout: &wgpu::BindGroupLayout,
        format: wgpu::TextureFormat,
    ) -> ClassicalPass {
        let device = &gpu.device;
        let flat = wgpu::TextureViewDimension::D2;
        let words = |binding| texture_entry(binding, wgpu::TextureSampleType::Uint, flat);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("gbuffer read"),
            entries: &[words(0), words(1), words(2), words(3), texture_entry(4, wgpu::TextureSampleType::Depth, flat)],
        });
        ClassicalPass {
            device: device.clone(),
            format,
            software: gpu.is_software(),
            layouts: [scene_layout.clone(), layout.clone(), light_layout.clone(), background_layout.clone()],
            layout,
            module: OnceLock::new(),
            pipelines: Default::default(),
        }
    }

    /// The pipeline of a variant. Blocks while it is compiled.
    pub fn pipeline(&self, Variant { sampled, areas, probed, mapped }: Variant) -> &wgpu::RenderPipeline {
        let [sampled_bit, areas_bit, probed_bit, mapped_bit] = [sampled, areas, probed, mapped].map(usize::from);
        self.pipelines[sampled_bit + 2 * areas_bit + 4 * probed_bit + 8 * mapped_bit].get_or_init(|| {
            let module = self.module.get_or_init(|| shader::CLASSICAL.module(&self.device));
            let layouts = self.layouts.each_ref().map(Some);
            let mut constants = frame_constants(self.format);
            let switches = [
                ("sampled", sampled),
                ("areas", areas),
                ("probed", probed),
                ("mapped", mapped),
                ("discards", self.software),
            ];
            constants.extend(switches.map(|(name, on)| (name, f64::from(u8::from(on)))));
            fullscreen_pipeline(&self.device, "classical", &layouts, module, self.format, &constants)
        })
    }

    /// The layout of the G-buffer as group 1.
    pub fn gbuffer_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The G-buffer as group 1.
    pub fn group(&self, gpu: &Gpu, buffer: &GBuffer) -> wgpu::BindGroup {
        let views = buffer.words.iter().chain([&buffer.depth]);
        let entries: Vec<_> = views
            .enumerate()
            .map(|(i, view)| wgpu::BindGroupEntry {
                binding: i as u32,
                resource: wgpu::BindingResource::TextureView(view),
            })
            .collect();
        let descriptor =
            wgpu::BindGroupDescriptor { label: Some("gbuffer read"), layout: &self.layout, entries: &entries };
        gpu.device.create_bind_group(&descriptor)
    }

    /// Writes every pixel of some rows of a target.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        groups: [&wgpu::BindGroup; 4],
        variant: Variant,
        rows: std::ops::Range<u32>,
    ) {
        let whole = rows.start == 0 && rows.end == target.texture().height();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("classical"),
            color_attachments: &[if whole { cleared(target) } else { attachment(target, wgpu::LoadOp::Load) }],
            ..Default::default()
        });
        pass.set_pipeline(self.pipeline(variant));
        pass.set_scissor_rect(0, rows.start, target.texture().width(), rows.end - rows.start);
        for (index, group) in groups.into_iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.draw(0..3, 0..1);
    }
}
