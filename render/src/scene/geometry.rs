//! Vertices and indices of all meshes in one buffer each.

use std::sync::Arc;

use burnish_core::scene::Mesh;
use glam::{Vec2, Vec3, Vec4};

use crate::device::Gpu;
use crate::error::RenderError;

/// Floats of a vertex: position 3, normal 3, tangent 4, two coordinates of 2, colour 4.
const VERTEX_FLOATS: usize = 18;

/// Bytes of a vertex.
pub const VERTEX_STRIDE: u64 = 4 * VERTEX_FLOATS as u64;

/// Attributes of a vertex, in the order of `VertexIn`.
pub const VERTEX_ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Float32x2, 5 => Float32x4];

/// The meshes of a scene on the device.
pub struct Geometry {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) ranges: Vec<Range>,
    meshes: Vec<Arc<Mesh>>,
}

/// Where a mesh lies in the buffers.
#[derive(Clone, Debug)]
pub(crate) struct Range {
    pub indices: std::ops::Range<u32>,
    pub base_vertex: i32,
    /// Middle of its box, in its own space.
    pub center: Vec3,
}

impl Geometry {
    /// Uploads the meshes. Fails when a buffer would be larger than the device allows.
    pub fn new(gpu: &Gpu, meshes: &[Arc<Mesh>]) -> Result<Geometry, RenderError> {
        let vertex_count: u64 = meshes.iter().map(|m| m.positions.len() as u64).sum();
        let index_count: u64 = meshes.iter().map(|m| m.indices.len() as u64).sum();
        let allowed = gpu.device.limits().max_buffer_size;
        for (what, bytes) in [("vertices", vertex_count * VERTEX_STRIDE), ("indices", index_count * 4)] {
            if bytes > allowed {
                return Err(RenderError::TooLarge { what: what.into(), bytes, allowed });
            }
        }
        let mut vertices: Vec<f32> = Vec::with_capacity(vertex_count as usize * VERTEX_FLOATS);
        let mut indices: Vec<u32> = Vec::with_capacity(index_count as usize);
        let mut ranges = Vec::with_capacity(meshes.len());
        for mesh in meshes {
            let (first, base_vertex) = (indices.len() as u32, (vertices.len() / VERTEX_FLOATS) as i32);
            let center = push_vertices(&mut vertices, mesh);
            indices.extend(&mesh.indices);
            ranges.push(Range { indices: first..indices.len() as u32, base_vertex, center });
        }
        // A buffer of size 0 is not allowed; a scene may be empty.
        vertices.resize(vertices.len().max(VERTEX_FLOATS), 0.0);
        indices.resize(indices.len().max(3), 0);
        Ok(Geometry {
            vertices: gpu.buffer("vertices", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            indices: gpu.buffer("indices", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
            ranges,
            meshes: meshes.to_vec(),
        })
    }

    /// True when it was made from these very meshes.
    pub fn holds(&self, meshes: &[Arc<Mesh>]) -> bool {
        self.meshes.len() == meshes.len() && self.meshes.iter().zip(meshes).all(|(a, b)| Arc::ptr_eq(a, b))
    }
}

/// Appends the vertices of a mesh; gives the middle of its box.
fn push_vertices(vertices: &mut Vec<f32>, mesh: &Mesh) -> Vec3 {
    let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for (i, &p) in mesh.positions.iter().enumerate() {
        min = min.min(p);
        max = max.max(p);
        let normal = mesh.normals.get(i).copied().unwrap_or(Vec3::Y);
        let tangent = mesh.tangents.get(i).copied().unwrap_or(Vec4::new(1.0, 0.0, 0.0, 1.0));
        let uv = |set: usize| mesh.uvs[set].get(i).copied().unwrap_or(Vec2::ZERO);
        vertices.extend(p.to_array());
        vertices.extend(normal.to_array());
        vertices.extend(tangent.to_array());
        vertices.extend(uv(0).to_array());
        vertices.extend(uv(1).to_array());
        vertices.extend(mesh.colors.get(i).copied().unwrap_or(Vec4::ONE).to_array());
    }
    if mesh.positions.is_empty() { Vec3::ZERO } else { 0.5 * (min + max) }
}
