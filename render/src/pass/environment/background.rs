//! The background on the device: its map, and where it is seen.

use std::sync::Arc;

use burnish_core::scene::{Environment, Scene};
use glam::{Vec3, Vec4};

use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::BackgroundData;
use crate::pass::{buffer_entry, texture_entry};

/// Group 3 of the pass that fills what no surface covers.
pub fn background_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let float = wgpu::TextureSampleType::Float { filterable: false };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("background"),
        entries: &[
            texture_entry(0, float, wgpu::TextureViewDimension::D2),
            buffer_entry(1, wgpu::ShaderStages::FRAGMENT, wgpu::BufferBindingType::Uniform),
        ],
    })
}

/// The background of a scene. Turned and scaled copies of one map share its texture.
pub struct BackgroundMap {
    /// See [`background_layout`].
    pub group: wgpu::BindGroup,
    /// It has a ground on which the scene throws shadows.
    pub catches: bool,
    view: wgpu::TextureView,
    /// What the texture holds; `None` for nothing.
    map: Option<(Arc<[Vec3]>, u32)>,
}

impl BackgroundMap {
    /// That of a valid scene; takes over from `before` what did not change.
    pub fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        scene: &Scene,
        before: Option<&BackgroundMap>,
    ) -> Result<BackgroundMap, RenderError> {
        let map = scene.background.map.as_deref();
        let held = map.map(|map| (map.texels.clone(), map.width));
        let same = |old: &&BackgroundMap| match (&old.map, &held) {
            (Some((a, v)), Some((b, w))) => Arc::ptr_eq(a, b) && v == w,
            (None, None) => true,
            _ => false,
        };
        let view = match before.filter(same) {
            Some(old) => old.view.clone(),
            None => texture(gpu, map)?,
        };
        let uniform = gpu.buffer("background", bytemuck::bytes_of(&data(scene)), wgpu::BufferUsages::UNIFORM);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("background"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
                wgpu::BindGroupEntry { binding: 1, resource: uniform.as_entire_binding() },
            ],
        });
        let catches = scene.background.ground.is_some_and(|ground| ground.shadows);
        Ok(BackgroundMap { group, catches, view, map: held })
    }
}

fn data(scene: &Scene) -> BackgroundData {
    let background = &scene.background;
    let (scale, rotation) = background.map.as_ref().map_or((Vec3::ONE, 0.0), |map| (map.scale(), map.rotation));
    let ground = background.ground.as_ref();
    BackgroundData {
        scale,
        mapped: u32::from(background.map.is_some()),
        center: ground.map_or(Vec3::ZERO, |ground| ground.center()),
        height: ground.map_or(0.0, |ground| ground.height),
        cos: rotation.cos(),
        sin: rotation.sin(),
        radius: ground.map_or(0.0, |ground| ground.radius),
        pad0: 0,
    }
}

/// The map as floats, or one black texel.
fn texture(gpu: &Gpu, map: Option<&Environment>) -> Result<wgpu::TextureView, RenderError> {
    let (width, height) = map.map_or((1, 1), |map| (map.width.max(1), map.height.max(1)));
    let allowed = gpu.device.limits().max_texture_dimension_2d;
    if width.max(height) > allowed {
        return Err(RenderError::TooLarge {
            what: "background, pixels across".into(),
            bytes: u64::from(width.max(height)),
            allowed: u64::from(allowed),
        });
    }
    let mut texels: Vec<Vec4> = map.iter().flat_map(|map| map.texels.iter()).map(|t| t.extend(1.0)).collect();
    texels.resize((width * height) as usize, Vec4::W);
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("background"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    gpu.queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&texels),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: None },
        size,
    );
    Ok(texture.create_view(&Default::default()))
}
