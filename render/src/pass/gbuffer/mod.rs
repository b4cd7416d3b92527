//! The G-buffer: per pixel what a surface is, textures looked up, and its depth.

use glam::UVec2;

use crate::device::Gpu;
use crate::pass::{MeshKind, MeshPipelines, cleared, target};
use crate::scene::{GpuScene, VERTEX_ATTRIBUTES, VERTEX_STRIDE, Variant};
use crate::shader;

/// Format of the four packed targets.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
/// Reversed: 1 at the near plane, 0 infinitely far away.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Vertices as all mesh pipelines read them.
pub const VERTEX_LAYOUT: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: VERTEX_STRIDE,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &VERTEX_ATTRIBUTES,
};

/// Depth test of all mesh pipelines.
pub fn depth_state(write: bool) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(write),
        depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

/// The targets of one size.
pub struct GBuffer {
    /// Packed words, see `texel.wgsl`. The second ones are those of the catcher where there is no surface.
    pub words: [wgpu::TextureView; 4],
    /// Reversed depth.
    pub depth: wgpu::TextureView,
}

impl GBuffer {
    /// Allocates the targets.
    pub fn new(gpu: &Gpu, size: UVec2) -> GBuffer {
        let view = |label, format| target(gpu, label, size, format).create_view(&Default::default());
        GBuffer { words: std::array::from_fn(|_| view("gbuffer", FORMAT)), depth: view("depth", DEPTH_FORMAT) }
    }
}

/// Pipelines, one for each [`crate::scene::Variant`].
pub struct GBufferPass {
    pipelines: MeshPipelines,
}

impl GBufferPass {
    /// Compiles nothing yet.
    pub fn new(gpu: &Gpu, layouts: &[Option<&wgpu::BindGroupLayout>]) -> GBufferPass {
        let target = wgpu::ColorTargetState { format: FORMAT, blend: None, write_mask: wgpu::ColorWrites::ALL };
        let kind = MeshKind {
            shader: &shader::GBUFFER,
            depth: depth_state(true),
            targets: Some(vec![Some(target); 4]),
            constants: Vec::new(),
            both_sides: false,
        };
        GBufferPass { pipelines: MeshPipelines::new(&gpu.device, layouts, kind) }
    }

    /// Compiles the variant that every scene has.
    pub fn warm_up(&self) {
        self.pipelines.get(Variant::ALL[0]);
    }

    /// Draws all opaque and masked instances.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &GBuffer,
        scene: &GpuScene,
        scene_group: &wgpu::BindGroup,
    ) {
        let attachments = buffer.words.each_ref().map(cleared);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("gbuffer"),
            color_attachments: &attachments,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &buffer.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        scene.bind(&mut pass, scene_group);
        scene.draw_all(&mut pass, &self.pipelines, |draw| !draw.blended);
    }
}
