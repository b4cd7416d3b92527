//! Shadow maps of the lights: one layer for a spot or directional light, six for a point or a sphere, five for a
//! rectangle, seen from the middle of the light.
//!
//! They are rendered once for a scene and kept until what casts shadows or the places of the lights change.

mod casters;
mod lights;

use burnish_core::scene::{Bounds, Scene};
use glam::Mat4;

use crate::device::Gpu;
use crate::layout::types::{LightData, SHADOW_NONE, ViewData};
use crate::pass::gbuffer::{DEPTH_FORMAT, depth_state};
use crate::pass::{MeshKind, MeshPipelines};
use crate::scene::GpuScene;
use crate::shader;
use casters::Caster;

/// Edge of a shadow map in texels, while there are few.
pub const RESOLUTION: u32 = 2048;
/// Layers that have it; more share the memory of these, 400 MB.
const LAYERS_FULL: u32 = 24;
/// Layers that are allocated at most, as many as every adapter allows; lights after that cast no shadow.
pub const LAYERS_MAX: u32 = 256;

/// Edge of each of so many maps: halved until all fit the memory.
fn resolution(layers: usize) -> u32 {
    let mut edge = RESOLUTION;
    while layers as u64 * u64::from(edge).pow(2) > u64::from(LAYERS_FULL) * u64::from(RESOLUTION).pow(2) {
        edge /= 2;
    }
    edge
}

/// The lights of a scene with their maps.
pub struct Shadows {
    pub(crate) lights: wgpu::Buffer,
    pub(crate) light_count: u32,
    /// A bit for each light and instance that it leaves out, `unlit_words` words a light; none where all are lit.
    pub(crate) unlit: wgpu::Buffer,
    pub(crate) unlit_words: u32,
    /// Lights have an area.
    pub(crate) has_areas: bool,
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
        let mut matrices = Vec::new();
        let mut unshadowed = Vec::new();
        let mut layers = Vec::new();
        for light in &scene.lights {
            let views = if light.shadows { lights::views(light, bounds) } else { Vec::new() };
            let fits = matrices.len() + views.len() <= LAYERS_MAX as usize;
            layers.push(if fits && !views.is_empty() { matrices.len() as u32 } else { SHADOW_NONE });
            if fits {
                matrices.extend(views);
            } else {
                unshadowed.push(light.name.clone());
            }
        }
        let edge = resolution(matrices.len());
        let each = scene.lights.iter().zip(&layers);
        let mut data: Vec<LightData> = each.map(|(light, layer)| lights::data(light, bounds, *layer, edge)).collect();
        let light_count = data.len() as u32;
        if data.is_empty() {
            data.push(bytemuck::Zeroable::zeroed());
        }
        let storage = wgpu::BufferUsages::STORAGE;
        let lights = gpu.buffer("lights", bytemuck::cast_slice(&data), storage);
        let (words, unlit_words) = lights::unlit(scene);
        let has_areas = scene.lights.iter().any(|light| !light.kind.is_sharp());
        let unlit = gpu.buffer("unlit", bytemuck::cast_slice(&words), storage);
        let casters = casters::list(scene);
        if let Some(before) = before.filter(|before| before.matrices == matrices && before.casters == casters) {
            return Shadows {
                lights,
                light_count,
                unlit,
                unlit_words,
                has_areas,
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
            unlit,
            unlit_words,
            has_areas,
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
    let edge = if layers == 0 { 1 } else { resolution(layers) };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_maps_are_smaller_and_all_fit_the_memory() {
        assert_eq!([0, 24, 25, 96, 97, LAYERS_MAX as usize].map(resolution), [2048, 2048, 1024, 1024, 512, 512]);
    }
}
