//! Textures and buffers that the cubes of an environment are made in.

use burnish_core::lighting::classical::Source;
use bytemuck::Zeroable;

use super::plan::Plan;
use super::{FORMAT, TILE};
use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::SourceData;

/// Rows of the map in a layer of its texture, which is uploaded as a whole; more where the map has very many.
const LAYER_ROWS: u32 = 32;
/// Layers that every adapter allows.
const LAYERS_MAX: u32 = 256;

/// Tiles of all faces of a level.
pub(super) fn tile_count((texture, level): &(wgpu::Texture, u32)) -> u32 {
    6 * (texture.width() >> level).div_ceil(TILE).max(1).pow(2)
}

/// Where to copy from or to, from a face of a level on.
pub(super) fn face_of((texture, level): &(wgpu::Texture, u32), face: u32) -> wgpu::TexelCopyTextureInfo<'_> {
    wgpu::TexelCopyTextureInfo {
        mip_level: *level,
        origin: wgpu::Origin3d { x: 0, y: 0, z: face },
        ..texture.as_image_copy()
    }
}

pub(super) fn level_view(texture: &wgpu::Texture, level: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        base_mip_level: level,
        mip_level_count: Some(1),
        ..Default::default()
    })
}

pub(super) fn cube(gpu: &Gpu, label: &str, face: u32, levels: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: face, height: face, depth_or_array_layers: 6 },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// The sources for the shader; never empty.
pub(super) fn source_buffer(gpu: &Gpu, sources: &[Source], scale: f32) -> wgpu::Buffer {
    let mut data: Vec<SourceData> = sources
        .iter()
        .map(|s| SourceData { direction: s.direction, pad0: 0, power: s.power / scale, pad1: 0 })
        .collect();
    data.resize(data.len().max(1), SourceData::zeroed());
    gpu.buffer(
        "bright sources",
        bytemuck::cast_slice(&data),
        wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    )
}

/// Room for the map as floats, in layers of rows: a layer is written at once, a large texture would first be cleared.
pub(super) fn map_texture(gpu: &Gpu, plan: &Plan) -> Result<wgpu::Texture, RenderError> {
    let environment = &plan.environment;
    let allowed = gpu.device.limits().max_texture_dimension_2d;
    if environment.width.max(environment.height) > allowed {
        return Err(RenderError::TooLarge {
            what: format!("environment `{}`, pixels across", environment.name),
            bytes: u64::from(environment.width.max(environment.height)),
            allowed: u64::from(allowed),
        });
    }
    let rows = LAYER_ROWS.max(environment.height.div_ceil(LAYERS_MAX));
    Ok(gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("equirectangular"),
        size: wgpu::Extent3d {
            width: environment.width,
            height: rows,
            depth_or_array_layers: environment.height.div_ceil(rows),
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    }))
}
