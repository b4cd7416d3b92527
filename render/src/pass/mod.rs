//! One folder per pass: its pipelines in Rust beside its entry points in WGSL.

pub mod accumulate;
pub mod catcher;
pub mod classical;
pub mod display;
pub mod environment;
pub mod forward;
pub mod gbuffer;
pub mod probe;
pub mod radiance_map;
pub mod shadow;

use std::sync::OnceLock;

use crate::device::Gpu;
use crate::pass::gbuffer::VERTEX_LAYOUT;
use crate::scene::Variant;
use crate::shader::Shader;

/// Layout of what every drawing pass binds at group 0: view, instances, materials.
pub fn scene_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let storage = wgpu::BufferBindingType::Storage { read_only: true };
    let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("scene"),
        entries: &[
            buffer_entry(0, both, wgpu::BufferBindingType::Uniform),
            buffer_entry(1, both, storage),
            buffer_entry(2, both, storage),
        ],
    })
}

/// A buffer without dynamic offset.
pub(crate) fn buffer_entry(
    binding: u32,
    visibility: wgpu::ShaderStages,
    ty: wgpu::BufferBindingType,
) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

/// A texture read by the fragment stage.
pub(crate) fn texture_entry(
    binding: u32,
    sample_type: wgpu::TextureSampleType,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false },
        count: None,
    }
}

/// A texture that one pass renders to and another reads.
pub(crate) fn target(gpu: &Gpu, label: &str, size: glam::UVec2, format: wgpu::TextureFormat) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// Attachment that starts from a clear.
pub(crate) fn cleared(view: &wgpu::TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    attachment(view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT))
}

/// Attachment with the given start.
pub(crate) fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
    })
}

/// A target to which a pass adds.
pub(crate) fn added(format: wgpu::TextureFormat) -> wgpu::ColorTargetState {
    let sum = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::ColorTargetState {
        format,
        blend: Some(wgpu::BlendState { color: sum, alpha: sum }),
        write_mask: wgpu::ColorWrites::ALL,
    }
}

/// Pipeline of a pass that covers the target with one triangle.
pub(crate) fn fullscreen_pipeline(
    device: &wgpu::Device,
    label: &str,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    module: &wgpu::ShaderModule,
    target: impl Into<wgpu::ColorTargetState>,
    constants: &[(&str, f64)],
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            targets: &[Some(target.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Pipelines of a pass over meshes, one a [`Variant`], compiled when first drawn with: compiling the largest takes as
/// long as a frame, and most scenes need few.
pub(crate) struct MeshPipelines {
    device: wgpu::Device,
    layout: wgpu::PipelineLayout,
    kind: MeshKind,
    module: OnceLock<wgpu::ShaderModule>,
    variants: [OnceLock<wgpu::RenderPipeline>; Variant::ALL.len()],
}

/// What tells one mesh pass from another.
pub(crate) struct MeshKind {
    pub shader: &'static Shader,
    pub depth: wgpu::DepthStencilState,
    /// Targets of the fragment stage; without one only depth is written.
    pub targets: Option<Vec<Option<wgpu::ColorTargetState>>>,
    pub constants: Vec<(&'static str, f64)>,
    /// Back faces are drawn whatever the material says.
    pub both_sides: bool,
}

impl MeshPipelines {
    pub fn new(device: &wgpu::Device, layouts: &[Option<&wgpu::BindGroupLayout>], kind: MeshKind) -> MeshPipelines {
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(kind.shader.name),
            bind_group_layouts: layouts,
            immediate_size: 0,
        });
        let variants = std::array::from_fn(|_| OnceLock::new());
        MeshPipelines { device: device.clone(), layout, kind, module: OnceLock::new(), variants }
    }

    /// The pipeline of a variant.
    pub fn get(&self, variant: Variant) -> &wgpu::RenderPipeline {
        // Depth has no bumps.
        let colored = self.kind.targets.as_ref().is_some_and(|targets| !targets.is_empty());
        let variant = Variant { bumpy: variant.bumpy && colored, ..variant };
        self.variants[variant.index()].get_or_init(|| self.create(variant))
    }

    fn create(&self, variant: Variant) -> wgpu::RenderPipeline {
        let MeshPipelines { device, layout, kind, module, .. } = self;
        let mut constants = kind.constants.clone();
        constants.push(("bumpy", f64::from(u8::from(variant.bumpy))));
        let module = module.get_or_init(|| kind.shader.module(device));
        let mut primitive = variant.primitive();
        if kind.both_sides {
            primitive.cull_mode = None;
        }
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(kind.shader.name),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(VERTEX_LAYOUT)],
            },
            primitive,
            depth_stencil: Some(kind.depth.clone()),
            multisample: Default::default(),
            fragment: kind.targets.as_ref().map(|targets| wgpu::FragmentState {
                module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
                targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
