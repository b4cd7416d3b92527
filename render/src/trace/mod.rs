//! Rays against the triangles of a scene, on the device: the trees of [`Accel`] in a buffer, and the functions of
//! `trace.wgsl` that walk them. See README.md.

mod balance;
mod pass;
mod words;

use burnish_core::trace::Accel;

use crate::device::Gpu;
use crate::error::RenderError;
use crate::pass::buffer_entry;
use crate::scene::check_size;

pub use pass::TracePass;

/// Children of nodes that can wait on the way of a ray; `TRACE_STACK` of `trace.wgsl`.
pub const STACK: usize = 128;

/// The trees of a scene on the device: one storage buffer, as the group that shaders with `trace.wgsl` bind.
pub struct TraceTree {
    group: wgpu::BindGroup,
    buffer: wgpu::Buffer,
    bytes: u64,
}

impl TraceTree {
    /// The layout of [`TraceTree::group`]: the buffer as binding 0, for fragments and compute shaders.
    pub fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
        let stages = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("trace"),
            entries: &[buffer_entry(0, stages, wgpu::BufferBindingType::Storage { read_only: true })],
        })
    }

    /// Uploads the trees. Fails where they are larger than the device binds.
    pub fn new(gpu: &Gpu, accel: &Accel) -> Result<TraceTree, RenderError> {
        let mut flat = accel.flatten();
        balance::fit(&mut flat);
        let bytes = words::bytes(&flat);
        check_size(gpu, "tree of the triangles", bytes)?;
        let words = words::of(&flat);
        let buffer = gpu.buffer("trace", bytemuck::cast_slice(&words), wgpu::BufferUsages::STORAGE);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("trace"),
            layout: &TraceTree::layout(&gpu.device),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Ok(TraceTree { group, buffer, bytes })
    }

    /// For pipelines with [`TraceTree::layout`].
    pub fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    /// The buffer, for groups that bind it beside others.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Memory on the device.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}
