//! Shadow maps of the punctual lights: one layer for a spot or directional light, six for a point light.
//!
//! They are rendered once for a scene and kept until what casts shadows or the places of the lights change.

mod casters;

use burnish_core::scene::{Bounds, Light, LightKind, Scene};
use glam::camera::rh::{proj::directx as proj, view};
use glam::{Mat4, Vec3};

use crate::device::Gpu;
use crate::layout::types::{LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT, LightData, SHADOW_NONE, ViewData};
use crate::pass::gbuffer::{DEPTH_FORMAT, depth_state};
use crate::pass::{MeshKind, MeshPipelines};
use crate::scene::GpuScene;
use crate::shader;
use casters::Caster;

/// Edge of a shadow map in texels.
pub const RESOLUTION: u32 = 2048;
/// Layers that are allocated at most; lights after that cast no shadow.
pub const LAYERS_MAX: u32 = 24;
/// Widest cone that one map can hold.
const SPOT_ANGLE_MAX: f32 = 1.4;

/// The lights of a scene with their maps.
pub struct Shadows {
    pub(crate) lights: wgpu::Buffer,
    pub(crate) light_count: u32,
    pub(crate) clip_from_world: wgpu::Buffer,
    pub(crate) maps: wgpu::TextureView,
    /// Lights that got no map because there are too many.
    pub unshadowed: Vec<String>,
    /// What the maps show: from where, and what.
    matrices: Vec<Mat4>,
    casters: Vec<Caster>,
}

/// Pipelines that fill the maps.
pub struct ShadowPass {
    opaque: MeshPipelines,
    masked: MeshPipelines,
}

impl ShadowPass {
    /// Compiles nothing yet.
    pub fn new(gpu: &Gpu, layouts: &[Option<&wgpu::BindGroupLayout>]) -> ShadowPass {
        let pipelines = |masked: bool| {
            let kind = MeshKind {
                shader: &shader::SHADOW,
                depth: wgpu::DepthStencilState {
                    // Depth is reversed: away from the light is down.
                    bias: wgpu::DepthBiasState { constant: 0, slope_scale: -1.5, clamp: 0.0 },
                    ..depth_state(true)
                },
                targets: masked.then(Vec::new),
                constants: Vec::new(),
                // What blocks light does not depend on which side is shown.
                both_sides: true,
            };
            MeshPipelines::new(&gpu.device, layouts, kind)
        };
        ShadowPass { opaque: pipelines(false), masked: pipelines(true) }
    }

    /// The lights with their maps, which are rendered only where `before` does not hold the same.
    pub(crate) fn build(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        bounds: Bounds,
        on_gpu: &GpuScene,
        scene_layout: &wgpu::BindGroupLayout,
        before: Option<&Shadows>,
    ) -> Shadows {
        let mut data = Vec::new();
        let mut matrices = Vec::new();
        let mut unshadowed = Vec::new();
        // Lights with an area are not drawn live yet.
        for light in scene.lights.iter().filter(|light| light.kind.is_punctual()) {
            let views = light_views(light, bounds);
            let fits = matrices.len() + views.len() <= LAYERS_MAX as usize;
            let layer = if fits && !views.is_empty() { matrices.len() as u32 } else { SHADOW_NONE };
            if layer == SHADOW_NONE {
                unshadowed.push(light.name.clone());
            } else {
                matrices.extend(views);
            }
            data.push(light_data(light, bounds, layer));
        }
        let light_count = data.len() as u32;
        if data.is_empty() {
            data.push(bytemuck::Zeroable::zeroed());
        }
        let storage = wgpu::BufferUsages::STORAGE;
        let lights = gpu.buffer("lights", bytemuck::cast_slice(&data), storage);
        let casters = casters::list(scene);
        if let Some(before) = before.filter(|before| before.matrices == matrices && before.casters == casters) {
            return Shadows {
                lights,
                light_count,
                unshadowed,
                matrices,
                casters,
                clip_from_world: before.clip_from_world.clone(),
                maps: before.maps.clone(),
            };
        }
        let maps = create_maps(gpu, matrices.len());
        for (layer, matrix) in matrices.iter().enumerate() {
            self.render_layer(gpu, &maps, layer as u32, *matrix, on_gpu, scene_layout);
        }
        let stored = if matrices.is_empty() { &[Mat4::IDENTITY] } else { matrices.as_slice() };
        Shadows {
            lights,
            light_count,
            unshadowed,
            clip_from_world: gpu.buffer("shadow matrices", bytemuck::cast_slice(stored), storage),
            maps: maps.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            }),
            matrices,
            casters,
        }
    }

    fn render_layer(
        &self,
        gpu: &Gpu,
        maps: &wgpu::Texture,
        layer: u32,
        clip_from_world: Mat4,
        scene: &GpuScene,
        scene_layout: &wgpu::BindGroupLayout,
    ) {
        let view = ViewData { clip_from_world, ..bytemuck::Zeroable::zeroed() };
        let uniform = gpu.buffer("light view", bytemuck::bytes_of(&view), wgpu::BufferUsages::UNIFORM);
        let group = scene.group(&gpu.device, scene_layout, &uniform);
        let target = maps.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadow"),
                color_attachments: &[],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &target,
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            scene.bind(&mut pass, &group);
            scene.draw_all(&mut pass, &self.opaque, |draw| !draw.blended && !draw.masked);
            scene.draw_all(&mut pass, &self.masked, |draw| draw.masked);
        }
        gpu.queue.submit([encoder.finish()]);
    }
}

fn create_maps(gpu: &Gpu, layers: usize) -> wgpu::Texture {
    let edge = if layers == 0 { 1 } else { RESOLUTION };
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow maps"),
        size: wgpu::Extent3d { width: edge, height: edge, depth_or_array_layers: layers.max(1) as u32 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Reads the maps; lit where the point is not behind the stored depth.
pub fn sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::GreaterEqual),
        ..Default::default()
    })
}

/// The axis of an upright camera that looks along `direction`.
fn up_for(direction: Vec3) -> Vec3 {
    if direction.y.abs() > 0.99 { Vec3::Z } else { Vec3::Y }
}

/// One clip-from-world matrix a layer, depth reversed.
fn light_views(light: &Light, bounds: Bounds) -> Vec<Mat4> {
    let radius = bounds.radius().max(1e-6);
    // A thousandth of the scene: nearer casters are inside the lamp.
    let near = radius * 1e-3;
    let toward = |direction: Vec3| view::look_to_mat4(light.position, direction, up_for(direction));
    match light.kind {
        LightKind::Point => [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z]
            .map(|d| proj::perspective_infinite_reverse(std::f32::consts::FRAC_PI_2, 1.0, near) * toward(d))
            .to_vec(),
        LightKind::Spot { outer_angle, .. } => {
            let angle = 2.0 * outer_angle.clamp(1e-3, SPOT_ANGLE_MAX);
            vec![proj::perspective_infinite_reverse(angle, 1.0, near) * toward(light.direction)]
        }
        LightKind::Directional { .. } => {
            let eye = bounds.center() - light.direction * (2.0 * radius);
            let view = view::look_to_mat4(eye, light.direction, up_for(light.direction));
            // Far and near are exchanged: depth is reversed.
            vec![proj::orthographic(-radius, radius, -radius, radius, 4.0 * radius, 0.0) * view]
        }
        LightKind::Rectangle { .. } | LightKind::Sphere { .. } => Vec::new(),
    }
}

fn light_data(light: &Light, bounds: Bounds, shadow_layer: u32) -> LightData {
    let (kind, spot_scale, spot_offset, extent) = match light.kind {
        LightKind::Point | LightKind::Rectangle { .. } | LightKind::Sphere { .. } => (LIGHT_POINT, 0.0, 1.0, 2.0),
        LightKind::Spot { inner_angle, outer_angle } => {
            // KHR_lights_punctual, "Inner and Outer Cone Angles".
            let scale = 1.0 / (inner_angle.cos() - outer_angle.cos()).max(1e-3);
            (LIGHT_SPOT, scale, -outer_angle.cos() * scale, 2.0 * outer_angle.clamp(1e-3, SPOT_ANGLE_MAX).tan())
        }
        LightKind::Directional { .. } => (LIGHT_DIRECTIONAL, 0.0, 1.0, 2.0 * bounds.radius()),
    };
    LightData {
        position: light.position,
        kind,
        direction: light.direction,
        range: if light.range.is_finite() { light.range } else { 0.0 },
        intensity: light.intensity,
        spot_scale,
        spot_offset,
        shadow_layer,
        shadow_texel: extent / RESOLUTION as f32,
        pad0: 0,
    }
}
