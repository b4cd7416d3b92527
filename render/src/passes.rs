//! The compiled pipelines of all passes, independent of any scene and shared by everything that draws on a device.

use std::sync::Arc;

use burnish_core::surface::ggx::albedo::AlbedoTable;

use crate::device::Gpu;
use crate::pass::accumulate::AccumulatePass;
use crate::pass::catcher::CatcherPass;
use crate::pass::classical::{ClassicalPass, Variant, light_layout};
use crate::pass::display::DisplayPass;
use crate::pass::environment::{EnvironmentPass, background_layout};
use crate::pass::forward::ForwardPass;
use crate::pass::gbuffer::GBufferPass;
use crate::pass::probe::ProbePass;
use crate::pass::radiance_map::RadianceMapPass;
use crate::pass::scene_layout;
use crate::pass::shadow::ShadowPass;
use crate::scene::material_layout;

/// A device and every pipeline on it, compiled when first needed. Compiling takes long: share it in an `Arc`.
pub struct Passes {
    pub(crate) gpu: Gpu,
    pub(crate) scene_layout: wgpu::BindGroupLayout,
    pub(crate) material_layout: wgpu::BindGroupLayout,
    pub(crate) light_layout: wgpu::BindGroupLayout,
    pub(crate) background_layout: wgpu::BindGroupLayout,
    pub(crate) environment: EnvironmentPass,
    pub(crate) shadow: ShadowPass,
    pub(crate) gbuffer: GBufferPass,
    pub(crate) classical: ClassicalPass,
    pub(crate) probe: ProbePass,
    pub(crate) radiance_map: RadianceMapPass,
    pub(crate) catcher: CatcherPass,
    pub(crate) forward: ForwardPass,
    pub(crate) accumulate: AccumulatePass,
    pub(crate) display: DisplayPass,
}

impl Passes {
    /// Compiles what environments need.
    pub fn new(gpu: &Gpu) -> Passes {
        let device = &gpu.device;
        let material_layout = material_layout(device);
        let scene_layout = scene_layout(device);
        let light_layout = light_layout(device);
        let background_layout = background_layout(device);
        let mesh = [Some(&scene_layout), Some(&material_layout)];
        let lit = [Some(&scene_layout), Some(&material_layout), Some(&light_layout)];
        let format = frame_format(gpu);
        let classical = ClassicalPass::new(gpu, &scene_layout, &light_layout, &background_layout, format);
        Passes {
            gpu: gpu.clone(),
            environment: EnvironmentPass::new(gpu),
            shadow: ShadowPass::new(gpu, &mesh),
            gbuffer: GBufferPass::new(gpu, &mesh),
            probe: ProbePass::new(gpu, &scene_layout, classical.gbuffer_layout(), format),
            radiance_map: RadianceMapPass::new(gpu, &scene_layout, classical.gbuffer_layout(), format),
            classical,
            catcher: CatcherPass::new(gpu, &scene_layout, &light_layout, &background_layout),
            forward: ForwardPass::new(gpu, &lit, format),
            accumulate: AccumulatePass::new(gpu),
            display: DisplayPass::new(gpu),
            scene_layout,
            material_layout,
            light_layout,
            background_layout,
        }
    }

    /// Makes in another thread, while a scene is loaded, what the first pictures will need.
    pub(crate) fn warm_up(self: &Arc<Passes>) {
        let passes = self.clone();
        let compile = move || {
            AlbedoTable::get();
            passes.classical.pipeline(Variant { sampled: false, ..Variant::default() });
            passes.gbuffer.warm_up();
            passes.classical.pipeline(Variant { sampled: true, ..Variant::default() });
        };
        // Where there is no thread to be had it is compiled when it is needed.
        let _ = std::thread::Builder::new().name("pipelines".into()).spawn(compile);
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }
}

/// Full floats where they can be blended: a sun in the background is beyond the range of halves.
pub(crate) fn frame_format(gpu: &Gpu) -> wgpu::TextureFormat {
    if gpu.has(wgpu::Features::FLOAT32_BLENDABLE) {
        wgpu::TextureFormat::Rgba32Float
    } else {
        wgpu::TextureFormat::Rgba16Float
    }
}
