//! Adds to surfaces that a probe serves what its surroundings send: by `impostor`, by `area-cube`, or the errors of searches instead.

use std::sync::OnceLock;

use burnish_core::lighting::area_cube::{self, Asked};

use crate::device::Gpu;
use crate::layout::types::{AREA_CUBE_CORRECTED, AREA_CUBE_FEW, AREA_CUBE_MIDDLES, AREA_CUBE_NORMALIZED, EffortData};
use crate::pass::classical::frame_constants;
use crate::pass::environment::{cube_sampler, cube_view};
use crate::pass::{added, attachment, buffer_entry, fullscreen_pipeline, texture_entry};
use crate::probes::{GpuProbe, ProbeLook};
use crate::shader;
use crate::trace::TraceTree;

/// What a pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// The light, or what else needs no trees.
    Light {
        /// Lobes are sampled; else they are looked up once.
        sampled: bool,
    },
    /// Errors of searches; group 3 has the trees.
    Errors,
    /// The light by the method `area-cube`.
    AreaCube,
}

/// The pipelines, each compiled when first drawn with.
pub struct ProbePass {
    device: wgpu::Device,
    format: wgpu::TextureFormat,
    probe_layout: wgpu::BindGroupLayout,
    effort_layout: wgpu::BindGroupLayout,
    error_layout: wgpu::BindGroupLayout,
    scene_layout: wgpu::BindGroupLayout,
    gbuffer_layout: wgpu::BindGroupLayout,
    module: OnceLock<wgpu::ShaderModule>,
    pipelines: [OnceLock<wgpu::RenderPipeline>; 2],
    error: OnceLock<wgpu::RenderPipeline>,
    area_cube: OnceLock<wgpu::RenderPipeline>,
    /// Those of the method `area-cube`.
    tables: OnceLock<wgpu::Buffer>,
}

impl ProbePass {
    /// Compiles nothing yet. The targets are of `format`, which can be blended.
    pub fn new(
        gpu: &Gpu,
        scene_layout: &wgpu::BindGroupLayout,
        gbuffer_layout: &wgpu::BindGroupLayout,
        format: wgpu::TextureFormat,
    ) -> ProbePass {
        let device = &gpu.device;
        let uniform = wgpu::BufferBindingType::Uniform;
        let storage = wgpu::BufferBindingType::Storage { read_only: true };
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let error_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("effort and trees"),
            entries: &[buffer_entry(0, fragment, uniform), buffer_entry(1, fragment, storage)],
        });
        let effort_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("effort"),
            entries: &[buffer_entry(0, fragment, uniform)],
        });
        ProbePass {
            device: device.clone(),
            format,
            probe_layout: probe_layout(device),
            effort_layout,
            error_layout,
            scene_layout: scene_layout.clone(),
            gbuffer_layout: gbuffer_layout.clone(),
            module: OnceLock::new(),
            pipelines: Default::default(),
            error: OnceLock::new(),
            area_cube: OnceLock::new(),
            tables: OnceLock::new(),
        }
    }

    /// The pipeline that samples lobes, or looks them up once. Blocks while it is compiled.
    pub fn pipeline(&self, sampled: bool) -> &wgpu::RenderPipeline {
        self.pipelines[usize::from(sampled)].get_or_init(|| {
            let module = self.module.get_or_init(|| shader::IMPOSTOR.module(&self.device));
            let mut constants = frame_constants(self.format);
            constants.push(("sampled", f64::from(u8::from(sampled))));
            self.compiled(module, &self.effort_layout, &constants)
        })
    }

    /// The pipeline that shows errors.
    fn error_pipeline(&self) -> &wgpu::RenderPipeline {
        self.error.get_or_init(|| {
            let module = shader::IMPOSTOR_ERROR.module(&self.device);
            self.compiled(&module, &self.error_layout, &[])
        })
    }

    /// The pipeline of the method `area-cube`.
    fn area_cube_pipeline(&self) -> &wgpu::RenderPipeline {
        self.area_cube.get_or_init(|| {
            let module = shader::AREA_CUBE.module(&self.device);
            self.compiled(&module, &self.effort_layout, &frame_constants(self.format))
        })
    }

    fn compiled(
        &self,
        module: &wgpu::ShaderModule,
        last: &wgpu::BindGroupLayout,
        constants: &[(&str, f64)],
    ) -> wgpu::RenderPipeline {
        let layouts = [&self.scene_layout, &self.gbuffer_layout, &self.probe_layout, last].map(Some);
        fullscreen_pipeline(&self.device, "probe", &layouts, module, added(self.format), constants)
    }

    /// A probe as group 2.
    pub(crate) fn group(
        &self,
        gpu: &Gpu,
        probe: &GpuProbe,
        places: &wgpu::Buffer,
        tables: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let maps = &probe.maps;
        let cubes = [&maps.radiance, &maps.prefiltered, &maps.irradiance, &maps.dimmed].map(cube_view);
        // Without a second layer nothing looks there.
        let (behind, behind_data) =
            probe.behind.as_ref().map_or((maps, &probe.data), |behind| (&behind.maps, &behind.data));
        let behind_cubes = [&behind.radiance, &behind.prefiltered, &behind.dimmed].map(cube_view);
        let sampler = cube_sampler(&gpu.device);
        let area_tables = self.tables.get_or_init(|| {
            let tables = bytemuck::cast_slice(area_cube::tables::flat());
            gpu.buffer("area-cube tables", tables, wgpu::BufferUsages::STORAGE)
        });
        let resources = [
            wgpu::BindingResource::TextureView(&cubes[0]),
            wgpu::BindingResource::TextureView(&cubes[1]),
            wgpu::BindingResource::TextureView(&cubes[2]),
            wgpu::BindingResource::Sampler(&sampler),
            wgpu::BindingResource::TextureView(&cubes[3]),
            maps.sources.as_entire_binding(),
            tables.as_entire_binding(),
            wgpu::BindingResource::TextureView(&probe.inverse_depths),
            probe.data.as_entire_binding(),
            places.as_entire_binding(),
            probe.coarse.as_entire_binding(),
            area_tables.as_entire_binding(),
            wgpu::BindingResource::TextureView(&probe.inverse_bounds),
            wgpu::BindingResource::TextureView(&behind_cubes[0]),
            wgpu::BindingResource::TextureView(&behind_cubes[1]),
            wgpu::BindingResource::TextureView(&behind_cubes[2]),
            behind_data.as_entire_binding(),
        ];
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        let layout = &self.probe_layout;
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("probe"), layout, entries: &entries })
    }

    /// The settings as group 3, with the trees that errors are told by.
    pub(crate) fn effort(&self, gpu: &Gpu, look: &ProbeLook, trees: Option<&TraceTree>) -> wgpu::BindGroup {
        let Asked { few, corrected, normalized, middles } = look.asked;
        let flags = [
            (few, AREA_CUBE_FEW),
            (corrected, AREA_CUBE_CORRECTED),
            (normalized, AREA_CUBE_NORMALIZED),
            (middles, AREA_CUBE_MIDDLES),
        ];
        let data = EffortData {
            solver: look.effort.solver as u32,
            refinements: look.effort.refinements,
            steps: look.effort.steps,
            tolerance: look.effort.tolerance,
            show: look.show as u32,
            edge: look.edge,
            flags: flags.into_iter().filter(|(on, _)| *on).map(|(_, flag)| flag).sum(),
            pad0: 0,
        };
        let buffer = gpu.buffer("effort", bytemuck::bytes_of(&data), wgpu::BufferUsages::UNIFORM);
        let buffers = [Some(&buffer), trees.map(TraceTree::buffer)].into_iter().flatten();
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("effort"),
            layout: if trees.is_some() { &self.error_layout } else { &self.effort_layout },
            entries: &entries,
        })
    }

    /// Adds to a part of a target: left top corner and size in pixels.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        groups: [&wgpu::BindGroup; 4],
        drawn: Drawn,
        [left, top, width, height]: [u32; 4],
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("probe"),
            color_attachments: &[attachment(target, wgpu::LoadOp::Load)],
            ..Default::default()
        });
        pass.set_pipeline(match drawn {
            Drawn::Light { sampled } => self.pipeline(sampled),
            Drawn::Errors => self.error_pipeline(),
            Drawn::AreaCube => self.area_cube_pipeline(),
        });
        pass.set_scissor_rect(left, top, width, height);
        for (index, group) in groups.into_iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.draw(0..3, 0..1);
    }
}

/// Layout of what `look.wgsl` and `area_cube.wgsl` read at group 2.
fn probe_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let (fragment, cube) = (wgpu::ShaderStages::FRAGMENT, wgpu::TextureViewDimension::Cube);
    let float = |filterable| wgpu::TextureSampleType::Float { filterable };
    let storage = wgpu::BufferBindingType::Storage { read_only: true };
    let sampler = wgpu::BindGroupLayoutEntry {
        binding: 3,
        visibility: fragment,
        ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("probe"),
        entries: &[
            texture_entry(0, float(true), cube),
            texture_entry(1, float(true), cube),
            texture_entry(2, float(true), cube),
            sampler,
            texture_entry(4, float(true), cube),
            buffer_entry(5, fragment, storage),
            buffer_entry(6, fragment, storage),
            texture_entry(7, float(false), wgpu::TextureViewDimension::D2Array),
            buffer_entry(8, fragment, wgpu::BufferBindingType::Uniform),
            buffer_entry(9, fragment, wgpu::BufferBindingType::Uniform),
            buffer_entry(10, fragment, storage),
            buffer_entry(11, fragment, storage),
            texture_entry(12, float(false), wgpu::TextureViewDimension::D2Array),
            texture_entry(13, float(true), cube),
            texture_entry(14, float(true), cube),
            texture_entry(15, float(true), cube),
            buffer_entry(16, fragment, wgpu::BufferBindingType::Uniform),
        ],
    })
}
