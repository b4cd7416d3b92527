//! Draws views of a scene: G-buffer, lighting, blended surfaces, jittered accumulation.

use burnish_core::lighting::classical;
use burnish_core::material::Material;
use burnish_core::math::sampling;
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::scene::{Camera, Projection, Scene};
use burnish_core::surface::ggx::Masking;
use glam::camera::rh::proj::directx as proj;
use glam::{Mat4, UVec2, Vec2, Vec3, Vec4};

use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::ViewData;
use crate::pass::accumulate::{AccumulatePass, Sums};
use crate::pass::classical::{ClassicalPass, light_group, light_layout};
use crate::pass::environment::{EnvironmentMaps, EnvironmentPass};
use crate::pass::forward::ForwardPass;
use crate::pass::gbuffer::{GBuffer, GBufferPass};
use crate::pass::shadow::{ShadowPass, Shadows};
use crate::pass::{scene_layout, target};
use crate::readback::read_texture;
use crate::scene::{GpuScene, material_layout};
use crate::tables::Tables;

/// What to draw.
#[derive(Clone, Debug)]
pub struct View {
    /// Pixels.
    pub size: UVec2,
    /// From where.
    pub camera: Camera,
    /// Settings of the `classical` method.
    pub settings: Settings,
    /// Frames that are averaged, each moved by a part of a pixel; 1 samples the centres.
    pub jitter_frames: u32,
}

/// Compiled pipelines; independent of the scene.
struct Passes {
    scene_layout: wgpu::BindGroupLayout,
    light_layout: wgpu::BindGroupLayout,
    gbuffer: GBufferPass,
    shadow: ShadowPass,
    classical: ClassicalPass,
    forward: ForwardPass,
    accumulate: AccumulatePass,
}

/// Textures of one picture size.
struct Targets {
    size: UVec2,
    gbuffer: GBuffer,
    gbuffer_group: wgpu::BindGroup,
    frame: wgpu::TextureView,
    sums: Sums,
}

/// A scene on the device, ready to be drawn.
///
/// Environment cubes and shadow maps are made once; [`Renderer::set_materials`] writes factors and the tables of metals
/// only.
pub struct Renderer {
    gpu: Gpu,
    scene: Scene,
    passes: Passes,
    gpu_scene: GpuScene,
    maps: EnvironmentMaps,
    shadows: Shadows,
    masking: Masking,
    lights: wgpu::BindGroup,
    targets: Option<Targets>,
}

/// Full floats where they can be blended: a sun in the background is beyond the range of halves.
fn frame_format(gpu: &Gpu) -> wgpu::TextureFormat {
    if gpu.has(wgpu::Features::FLOAT32_BLENDABLE) {
        wgpu::TextureFormat::Rgba32Float
    } else {
        wgpu::TextureFormat::Rgba16Float
    }
}

fn tables_buffer(gpu: &Gpu, tables: &Tables) -> wgpu::Buffer {
    gpu.buffer("tables", bytemuck::cast_slice(&tables.floats), wgpu::BufferUsages::STORAGE)
}

impl Renderer {
    /// Uploads the scene and prepares its environment and shadows. The scene must be valid and have an environment.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Renderer, RenderError> {
        let environment = scene.environment.as_ref().ok_or(RenderError::NoEnvironment)?;
        let device = &gpu.device;
        let materials = material_layout(device);
        let scene_layout = scene_layout(device);
        let light_layout = light_layout(device);
        let mesh = [Some(&scene_layout), Some(&materials)];
        let lit = [Some(&scene_layout), Some(&materials), Some(&light_layout)];
        let format = frame_format(gpu);
        let passes = Passes {
            gbuffer: GBufferPass::new(gpu, &mesh),
            shadow: ShadowPass::new(gpu, &mesh),
            classical: ClassicalPass::new(gpu, &scene_layout, &light_layout, format),
            forward: ForwardPass::new(gpu, &lit, format),
            accumulate: AccumulatePass::new(gpu),
            scene_layout,
            light_layout,
        };
        let masking = Masking::Correlated;
        let tables = Tables::new(scene, masking);
        let gpu_scene = GpuScene::new(gpu, &materials, scene, &tables)?;
        let maps = EnvironmentPass::new(gpu).build(gpu, environment)?;
        let shadows = passes.shadow.build(gpu, &scene.lights, scene.bounds(), &gpu_scene, &passes.scene_layout);
        let lights = light_group(gpu, &passes.light_layout, &maps, &shadows, &tables_buffer(gpu, &tables));
        gpu.check()?;
        let scene = scene.clone();
        Ok(Renderer { gpu: gpu.clone(), scene, passes, gpu_scene, maps, shadows, masking, lights, targets: None })
    }

    /// Names of lights that cast no shadow because there are more than the shadow maps hold.
    pub fn unshadowed_lights(&self) -> &[String] {
        &self.shadows.unshadowed
    }

    /// The cubes of the environment, for measuring them.
    pub fn environment_maps(&self) -> &EnvironmentMaps {
        &self.maps
    }

    /// Takes over the factors and reflectances of materials, in the order of the scene's; more than it has are ignored.
    /// Textures, alpha modes and sidedness stay as they were uploaded.
    pub fn set_materials(&mut self, materials: &[Material]) {
        for (old, new) in self.scene.materials.iter_mut().zip(materials) {
            let (alpha_mode, double_sided) = (old.alpha_mode, old.double_sided);
            *old = Material { alpha_mode, double_sided, ..new.clone().with_textures_of(old) };
        }
        self.refresh_tables();
    }

    fn refresh_tables(&mut self) {
        let tables = Tables::new(&self.scene, self.masking);
        self.gpu_scene.update_materials(&self.gpu, &self.scene, &tables);
        let buffer = tables_buffer(&self.gpu, &tables);
        self.lights = light_group(&self.gpu, &self.passes.light_layout, &self.maps, &self.shadows, &buffer);
    }

    /// Draws the view and returns scene-linear radiance.
    pub fn render(&mut self, view: &View) -> Result<Picture, RenderError> {
        let allowed = self.gpu.device.limits().max_texture_dimension_2d;
        let (width, height) = (view.size.x, view.size.y);
        if width == 0 || height == 0 || width.max(height) > allowed {
            return Err(RenderError::Size { width, height, allowed });
        }
        let settings = classical::FrameSettings::new(&view.settings);
        if settings.masking != self.masking {
            self.masking = settings.masking;
            self.refresh_tables();
        }
        let mut targets = match self.targets.take() {
            Some(targets) if targets.size == view.size => targets,
            _ => self.allocate(view.size),
        };
        let frames = view.jitter_frames.max(1);
        for frame in 0..frames {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            if frame == 0 {
                targets.sums.clear(&mut encoder);
            }
            self.encode_frame(&mut encoder, view, &settings, frame, frames, &mut targets);
            self.gpu.queue.submit([encoder.finish()]);
            self.gpu.check()?;
        }
        let bytes = read_texture(&self.gpu, targets.sums.texture(), 0, 0)?;
        self.targets = Some(targets);
        let (floats, _) = bytes.as_chunks::<16>();
        let scale = 1.0 / frames as f32;
        let texels = floats.iter().map(|texel| bytemuck::pod_read_unaligned::<Vec4>(texel) * scale).collect();
        Ok(Picture { width, height, texels })
    }

    fn allocate(&self, size: UVec2) -> Targets {
        let gbuffer = GBuffer::new(&self.gpu, size);
        Targets {
            size,
            gbuffer_group: self.passes.classical.group(&self.gpu, &gbuffer),
            gbuffer,
            frame: target(&self.gpu, "frame", size, frame_format(&self.gpu)).create_view(&Default::default()),
            sums: Sums::new(&self.gpu, size),
        }
    }

    fn encode_frame(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &View,
        settings: &classical::FrameSettings,
        frame: u32,
        frames: u32,
        targets: &mut Targets,
    ) {
        let data = self.view_data(view, settings, frame, frames);
        let uniform = self.gpu.buffer("view", bytemuck::bytes_of(&data), wgpu::BufferUsages::UNIFORM);
        let scene = self.gpu_scene.group(&self.gpu.device, &self.passes.scene_layout, &uniform);
        self.passes.gbuffer.encode(encoder, &targets.gbuffer, &self.gpu_scene, &scene);
        self.passes.classical.encode(encoder, &targets.frame, [&scene, &targets.gbuffer_group, &self.lights]);
        let groups = [&scene, &self.lights];
        let depth = &targets.gbuffer.depth;
        self.passes.forward.encode(encoder, &targets.frame, depth, &self.gpu_scene, groups, data.viewer);
        self.passes.accumulate.encode(&self.gpu, encoder, &targets.frame, &mut targets.sums);
    }

    fn view_data(&self, view: &View, settings: &classical::FrameSettings, frame: u32, frames: u32) -> ViewData {
        let size = view.size.as_vec2();
        let jitter = if frames == 1 {
            Vec2::ZERO
        } else {
            sampling::hammersley(frame, frames) + Vec2::splat(0.5 / frames as f32) - 0.5
        };
        let clip_from_world = clip_from_world(&view.camera, size, jitter);
        let (rotation, strength) = self.scene.environment.as_ref().map_or((0.0, 1.0), |e| (e.rotation, e.strength));
        ViewData {
            clip_from_world,
            world_from_clip: clip_from_world.inverse(),
            viewer: viewer(&view.camera),
            environment_cos: rotation.cos(),
            environment_sin: rotation.sin(),
            environment_scale: self.maps.scale * strength,
            environment_mips: self.maps.radiance.mip_level_count() as f32,
            size,
            light_count: self.shadows.light_count,
            samples: settings.samples,
            masking: settings.masking as u32,
            multiple_scattering: u32::from(settings.multiple_scattering),
            frame,
            prefiltered_mips: self.maps.prefiltered.mip_level_count() as f32,
            source_count: self.maps.source_count,
            wide_alpha: self.maps.wide_alpha,
            pad0: 0,
            pad1: 0,
        }
    }
}

/// Reversed depth: 1 at the near plane; 0 infinitely far away, or at the far plane of an orthographic camera.
/// `jitter` moves the picture by a part of a pixel.
pub fn clip_from_world(camera: &Camera, size: Vec2, jitter: Vec2) -> Mat4 {
    let aspect = size.x / size.y;
    let clip_from_view = match camera.projection {
        Projection::Perspective { yfov, near } => proj::perspective_infinite_reverse(yfov, aspect, near),
        // Far and near are exchanged: depth is reversed.
        Projection::Orthographic { ymag, near, far } => {
            proj::orthographic(-ymag * aspect, ymag * aspect, -ymag, ymag, far, near)
        }
    };
    let moved = Mat4::from_translation(Vec3::new(2.0 * jitter.x / size.x, -2.0 * jitter.y / size.y, 0.0));
    moved * clip_from_view * Mat4::from(camera.world_from_view.inverse())
}

/// The viewer as a homogeneous point: a direction when orthographic.
fn viewer(camera: &Camera) -> Vec4 {
    match camera.projection {
        Projection::Perspective { .. } => Vec3::from(camera.world_from_view.translation).extend(1.0),
        Projection::Orthographic { .. } => camera.world_from_view.transform_vector3(Vec3::Z).extend(0.0),
    }
}
