//! A list of rays at once: for tests, and for views that show how far a method is from what a ray meets.

use std::sync::OnceLock;

use burnish_core::trace::{Hit, Ray};
use bytemuck::Zeroable;
use wgpu::{BufferBindingType, BufferUsages};

use super::TraceTree;
use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::{HIT_NONE, HitData, RayData};
use crate::pass::buffer_entry;
use crate::readback::read_buffer;
use crate::shader;

/// Rays of a dispatch: few enough for one to end before drivers take a device for hung.
const RAYS: usize = 1 << 18;

/// Threads of a workgroup of `pass.wgsl`.
const GROUP: u32 = 64;

/// The pipelines.
pub struct TracePass {
    gpu: Gpu,
    /// Tree; rays and hits.
    layouts: [wgpu::BindGroupLayout; 2],
    module: OnceLock<wgpu::ShaderModule>,
    closest: OnceLock<wgpu::ComputePipeline>,
    occluded: OnceLock<wgpu::ComputePipeline>,
}

impl TracePass {
    /// Compiles nothing yet.
    pub fn new(gpu: &Gpu) -> TracePass {
        let storage = |binding, read_only| {
            buffer_entry(binding, wgpu::ShaderStages::COMPUTE, BufferBindingType::Storage { read_only })
        };
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("rays"),
            entries: &[storage(0, true), storage(1, false)],
        });
        TracePass {
            gpu: gpu.clone(),
            layouts: [TraceTree::layout(&gpu.device), layout],
            module: OnceLock::new(),
            closest: OnceLock::new(),
            occluded: OnceLock::new(),
        }
    }

    /// The nearest hit of each ray, of several at the same distance that of the first instance and triangle.
    pub fn closest(&self, tree: &TraceTree, rays: &[Ray]) -> Result<Vec<Option<Hit>>, RenderError> {
        let pipeline = self.closest.get_or_init(|| self.pipeline("closest"));
        let hit = |hit: &HitData| {
            let HitData { t, instance, triangle, barycentric, .. } = *hit;
            (instance != HIT_NONE).then_some(Hit { t, instance, triangle, barycentric })
        };
        Ok(self.run(pipeline, tree, rays)?.iter().map(hit).collect())
    }

    /// For each ray whether there is a hit.
    pub fn occluded(&self, tree: &TraceTree, rays: &[Ray]) -> Result<Vec<bool>, RenderError> {
        let pipeline = self.occluded.get_or_init(|| self.pipeline("occluded"));
        Ok(self.run(pipeline, tree, rays)?.iter().map(|hit| hit.instance != HIT_NONE).collect())
    }

    fn pipeline(&self, entry: &'static str) -> wgpu::ComputePipeline {
        let device = &self.gpu.device;
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("trace"),
            bind_group_layouts: &self.layouts.each_ref().map(Some),
            ..Default::default()
        });
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: Some(&layout),
            module: self.module.get_or_init(|| shader::TRACE.module(device)),
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        })
    }

    fn run(
        &self,
        pipeline: &wgpu::ComputePipeline,
        tree: &TraceTree,
        rays: &[Ray],
    ) -> Result<Vec<HitData>, RenderError> {
        let mut hits = Vec::with_capacity(rays.len());
        for rays in rays.chunks(RAYS) {
            let bytes = self.dispatch(pipeline, tree, rays)?;
            hits.extend(bytes.chunks_exact(size_of::<HitData>()).map(bytemuck::pod_read_unaligned::<HitData>));
        }
        Ok(hits)
    }

    fn dispatch(
        &self,
        pipeline: &wgpu::ComputePipeline,
        tree: &TraceTree,
        rays: &[Ray],
    ) -> Result<Vec<u8>, RenderError> {
        let Gpu { device, queue, .. } = &self.gpu;
        let data = |ray: &Ray| {
            let Ray { origin, direction, t_max } = *ray;
            RayData { origin, t_max, direction, ..RayData::zeroed() }
        };
        let data: Vec<RayData> = rays.iter().map(data).collect();
        let rays = self.gpu.buffer("rays", bytemuck::cast_slice(&data), BufferUsages::STORAGE);
        let hits = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("hits"),
            size: (data.len() * size_of::<HitData>()) as u64,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("rays"),
            layout: &self.layouts[1],
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: rays.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: hits.as_entire_binding() },
            ],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, tree.group(), &[]);
            pass.set_bind_group(1, &group, &[]);
            pass.dispatch_workgroups((data.len() as u32).div_ceil(GROUP), 1, 1);
        }
        queue.submit([encoder.finish()]);
        Ok(read_buffer(&self.gpu, &hits)?)
    }
}
