//! Blended surfaces over the lit picture, from far to near, lit by the same functions.

use glam::{Vec3, Vec4};

use crate::device::Gpu;
use crate::pass::classical::frame_constants;
use crate::pass::gbuffer::depth_state;
use crate::pass::{MeshKind, MeshPipelines, attachment};
use crate::scene::{Draw, GpuScene};
use crate::shader;

/// Pipelines, one for each [`crate::scene::Variant`].
pub struct ForwardPass {
    pipelines: MeshPipelines,
    /// With lights that have an area.
    with_areas: MeshPipelines,
}

impl ForwardPass {
    /// Compiles nothing yet. The targets are of `format`.
    pub fn new(gpu: &Gpu, layouts: &[Option<&wgpu::BindGroupLayout>], format: wgpu::TextureFormat) -> ForwardPass {
        let target = wgpu::ColorTargetState {
            format,
            blend: Some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::COLOR,
        };
        let constants = |areas: f64| [frame_constants(format), vec![("areas", areas)]].concat();
        let kind = |areas: f64| MeshKind {
            shader: &shader::FORWARD,
            depth: depth_state(false),
            targets: Some(vec![Some(target.clone())]),
            constants: constants(areas),
            both_sides: false,
        };
        let [pipelines, with_areas] = [0.0, 1.0].map(|areas| MeshPipelines::new(&gpu.device, layouts, kind(areas)));
        ForwardPass { pipelines, with_areas }
    }

    /// Draws the blended instances sorted by the distance of their centres from the viewer (homogeneous, see
    /// `ViewData`); `areas` where lights have one. Nothing is encoded when there is none.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        scene: &GpuScene,
        groups: [&wgpu::BindGroup; 2],
        (viewer, areas): (Vec4, bool),
    ) {
        let mut draws: Vec<&Draw> = scene.draws.iter().filter(|d| d.blended).collect();
        if draws.is_empty() {
            return;
        }
        let nearness = |p: Vec3| {
            if viewer.w == 0.0 { viewer.truncate().dot(p) } else { -viewer.truncate().distance_squared(p) }
        };
        draws.sort_by(|a, b| nearness(a.center).total_cmp(&nearness(b.center)));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("forward"),
            color_attachments: &[attachment(target, wgpu::LoadOp::Load)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        let pipelines = if areas { &self.with_areas } else { &self.pipelines };
        let [scene_group, light_group] = groups;
        scene.bind(&mut pass, scene_group);
        pass.set_bind_group(2, light_group, &[]);
        for draw in draws {
            pass.set_pipeline(pipelines.get(draw.variant));
            scene.draw(&mut pass, draw);
        }
    }
}
