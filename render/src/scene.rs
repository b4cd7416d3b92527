//! The scene in GPU memory: vertices, instances, materials with their textures, and how they are drawn.

use burnish_core::material::{AlphaMode, Material, Reflectance, TextureRef, TextureRole};
use burnish_core::scene::Scene;
use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::{
    InstanceData, MATERIAL_BLEND, MATERIAL_MASK, MATERIAL_PRESET, MATERIAL_UNLIT, MaterialData, TEXTURE_COUNT,
    TextureSlot,
};
use crate::tables::Tables;
use crate::textures::TextureCache;

/// Bytes of a vertex: position 3, normal 3, tangent 4, two coordinates of 2, colour 4 floats.
pub const VERTEX_STRIDE: u64 = 18 * 4;

/// Attributes of a vertex, in the order of `VertexIn`.
pub const VERTEX_ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Float32x2, 5 => Float32x4];

/// One call of the device: a range of indices of one instance.
#[derive(Clone, Debug)]
pub struct Draw {
    /// Index of the instance, also `instance_index`.
    pub instance: u32,
    /// Index of the material.
    pub material: usize,
    /// Range in the index buffer.
    pub indices: std::ops::Range<u32>,
    /// Added to every index.
    pub base_vertex: i32,
    /// Which pipeline variant draws it.
    pub variant: Variant,
    /// Drawn by the forward pass.
    pub blended: bool,
    /// Needs the fragment stage to write depth.
    pub masked: bool,
    /// World centre, for sorting.
    pub center: Vec3,
}

/// Rasteriser state of a draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    /// Drawn from both sides.
    pub double_sided: bool,
    /// The transform turns the winding round.
    pub mirrored: bool,
}

impl Variant {
    /// All of them; `index` gives the place in this list.
    pub const ALL: [Variant; 4] = [
        Variant { double_sided: false, mirrored: false },
        Variant { double_sided: false, mirrored: true },
        Variant { double_sided: true, mirrored: false },
        Variant { double_sided: true, mirrored: true },
    ];

    /// Place in [`Variant::ALL`].
    pub fn index(self) -> usize {
        2 * usize::from(self.double_sided) + usize::from(self.mirrored)
    }

    /// Culling and winding.
    pub fn primitive(self) -> wgpu::PrimitiveState {
        wgpu::PrimitiveState {
            front_face: if self.mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
            cull_mode: if self.double_sided { None } else { Some(wgpu::Face::Back) },
            ..Default::default()
        }
    }
}

/// Buffers and bind groups of a scene.
pub struct GpuScene {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) instances: wgpu::Buffer,
    pub(crate) materials: wgpu::Buffer,
    pub(crate) material_groups: Vec<wgpu::BindGroup>,
    pub(crate) draws: Vec<Draw>,
}

/// Layout of the textures and samplers of a material (bind group 1).
pub fn material_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let textures = (0..TEXTURE_COUNT as u32).map(|binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    });
    let samplers = (0..TEXTURE_COUNT as u32).map(|i| wgpu::BindGroupLayoutEntry {
        binding: TEXTURE_COUNT as u32 + i,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        count: None,
    });
    let entries: Vec<_> = textures.chain(samplers).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("material"), entries: &entries })
}

impl GpuScene {
    /// Uploads a valid scene. Fails when a buffer would be larger than the device allows.
    pub fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        scene: &Scene,
        tables: &Tables,
    ) -> Result<GpuScene, RenderError> {
        let (vertices, indices, ranges) = merge_meshes(gpu, scene)?;
        let mut draws = Vec::with_capacity(scene.instances.len());
        let mut instances = Vec::with_capacity(scene.instances.len().max(1));
        for (index, instance) in scene.instances.iter().enumerate() {
            instances.push(instance_data(instance.world_from_local.into(), instance.material));
            let material = &scene.materials[instance.material];
            let (first_index, count, base_vertex, center) = ranges[instance.mesh];
            let mirrored = instance.world_from_local.matrix3.determinant() < 0.0;
            draws.push(Draw {
                instance: index as u32,
                material: instance.material,
                indices: first_index..first_index + count,
                base_vertex,
                variant: Variant { double_sided: material.double_sided, mirrored },
                blended: material.alpha_mode == AlphaMode::Blend,
                masked: matches!(material.alpha_mode, AlphaMode::Mask { .. }),
                center: instance.world_from_local.transform_point3(center),
            });
        }
        if instances.is_empty() {
            instances.push(instance_data(Mat4::IDENTITY, 0));
        }
        check_size(gpu, "instances", size_of_val(instances.as_slice()) as u64)?;
        let materials = material_list(scene, tables);
        check_size(gpu, "materials", size_of_val(materials.as_slice()) as u64)?;
        check_size(gpu, "tables of metals", size_of_val(tables.floats.as_slice()) as u64)?;
        let storage = wgpu::BufferUsages::STORAGE;
        let mut cache = TextureCache::new(gpu);
        let material_groups =
            scene.materials.iter().map(|m| material_group(gpu, layout, scene, m, &mut cache)).collect();
        Ok(GpuScene {
            vertices,
            indices,
            instances: gpu.buffer("instances", bytemuck::cast_slice(&instances), storage),
            materials: gpu.buffer("materials", bytemuck::cast_slice(&materials), storage),
            material_groups,
            draws,
        })
    }

    /// Writes the factors of all materials anew; textures stay.
    pub fn update_materials(&self, gpu: &Gpu, scene: &Scene, tables: &Tables) {
        gpu.queue.write_buffer(&self.materials, 0, bytemuck::cast_slice(&material_list(scene, tables)));
    }
}

fn check_size(gpu: &Gpu, what: &str, bytes: u64) -> Result<(), RenderError> {
    let limits = gpu.device.limits();
    let allowed = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
    if bytes > allowed {
        return Err(RenderError::TooLarge { what: what.into(), bytes, allowed });
    }
    Ok(())
}

/// Per mesh: first index, index count, first vertex, centre.
type Range = (u32, u32, i32, Vec3);

fn merge_meshes(gpu: &Gpu, scene: &Scene) -> Result<(wgpu::Buffer, wgpu::Buffer, Vec<Range>), RenderError> {
    let vertex_count: u64 = scene.meshes.iter().map(|m| m.positions.len() as u64).sum();
    let index_count: u64 = scene.meshes.iter().map(|m| m.indices.len() as u64).sum();
    let allowed = gpu.device.limits().max_buffer_size;
    for (what, bytes) in [("vertices", vertex_count * VERTEX_STRIDE), ("indices", index_count * 4)] {
        if bytes > allowed {
            return Err(RenderError::TooLarge { what: what.into(), bytes, allowed });
        }
    }
    let mut vertices: Vec<f32> = Vec::with_capacity(vertex_count as usize * 18);
    let mut indices: Vec<u32> = Vec::with_capacity(index_count as usize);
    let mut ranges = Vec::with_capacity(scene.meshes.len());
    for mesh in &scene.meshes {
        let first_vertex = (vertices.len() / 18) as i32;
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
        let center = if mesh.positions.is_empty() { Vec3::ZERO } else { 0.5 * (min + max) };
        ranges.push((indices.len() as u32, mesh.indices.len() as u32, first_vertex, center));
        indices.extend(&mesh.indices);
    }
    // A buffer of size 0 is not allowed; a scene may be empty.
    vertices.resize(vertices.len().max(18), 0.0);
    indices.resize(indices.len().max(3), 0);
    Ok((
        gpu.buffer("vertices", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
        gpu.buffer("indices", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
        ranges,
    ))
}

/// Transform of an instance with its inverse transpose for normals.
fn instance_data(world_from_local: Mat4, material: usize) -> InstanceData {
    let linear = Mat3::from_mat4(world_from_local);
    // Cofactors times the sign of the determinant: the inverse transpose up to a positive factor, without dividing.
    let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    InstanceData {
        world_from_local,
        normal0: (sign * y.cross(z)).extend(sign),
        normal1: (sign * z.cross(x)).extend(0.0),
        normal2: (sign * x.cross(y)).extend(0.0),
        material: material as u32,
        pad0: 0,
        pad1: 0,
        pad2: 0,
    }
}

fn material_list(scene: &Scene, tables: &Tables) -> Vec<MaterialData> {
    let mut list: Vec<_> =
        scene.materials.iter().enumerate().map(|(i, material)| material_data(material, i, tables)).collect();
    if list.is_empty() {
        list.push(material_data(&Material::default(), usize::MAX, tables));
    }
    list
}

fn material_data(m: &Material, index: usize, tables: &Tables) -> MaterialData {
    let mut flags = 0;
    let mut alpha_cutoff = 0.0;
    match m.alpha_mode {
        AlphaMode::Opaque => {}
        AlphaMode::Mask { cutoff } => {
            flags |= MATERIAL_MASK;
            alpha_cutoff = cutoff;
        }
        AlphaMode::Blend => flags |= MATERIAL_BLEND,
    }
    if m.unlit {
        flags |= MATERIAL_UNLIT;
    }
    if matches!(m.reflectance, Reflectance::Preset { .. }) {
        flags |= MATERIAL_PRESET;
    }
    let fresnel = tables.fresnel(index);
    let textures = m.textures();
    MaterialData {
        base_color: m.base_color,
        opacity: m.opacity,
        emission: m.emission,
        metallic: m.metallic,
        specular_color: m.specular_color,
        specular: m.specular,
        roughness: m.roughness,
        normal_scale: m.normal_scale,
        occlusion_strength: m.occlusion_strength,
        alpha_cutoff,
        coat: m.coat,
        coat_roughness: m.coat_roughness,
        coat_normal_scale: m.coat_normal_scale,
        ior: m.ior,
        anisotropy: m.anisotropy,
        anisotropy_rotation: m.anisotropy_rotation,
        flags,
        fresnel_form: fresnel.form,
        fresnel_f0: fresnel.f0,
        fresnel_table: fresnel.table,
        fresnel_n: fresnel.n,
        albedo_table: fresnel.albedo_table,
        fresnel_k: fresnel.k,
        pad0: 0,
        fresnel_mean: fresnel.mean,
        pad1: 0,
        textures: std::array::from_fn(|i| match textures[i] {
            Some(texture) if !bypassed(m, TextureRole::ALL[i]) => TextureSlot::new(texture),
            _ => TextureSlot::absent(),
        }),
    }
}

/// A preset bypasses the base colour's texture, but a mask in its alpha still cuts.
fn bypassed(m: &Material, role: TextureRole) -> bool {
    let preset = matches!(m.reflectance, Reflectance::Preset { .. });
    role == TextureRole::BaseColor && preset && m.alpha_mode == AlphaMode::Opaque
}

impl TextureSlot {
    fn absent() -> TextureSlot {
        bytemuck::Zeroable::zeroed()
    }

    fn new(texture: TextureRef) -> TextureSlot {
        let m = texture.transform;
        TextureSlot {
            matrix: Vec4::new(m.x_axis.x, m.x_axis.y, m.y_axis.x, m.y_axis.y),
            offset: Vec2::new(m.z_axis.x, m.z_axis.y),
            uv_set: u32::from(texture.uv_set),
            present: 1,
        }
    }
}

fn material_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    scene: &Scene,
    material: &Material,
    cache: &mut TextureCache,
) -> wgpu::BindGroup {
    let bound: Vec<_> = TextureRole::ALL
        .iter()
        .zip(material.textures())
        .map(|(role, texture)| match texture {
            Some(t) => {
                let view = cache.view(gpu, t.image, &scene.images[t.image], role.is_color());
                (view, cache.sampler(gpu, t.sampler))
            }
            None => (cache.white(), cache.sampler(gpu, Default::default())),
        })
        .collect();
    let mut entries = Vec::with_capacity(2 * TEXTURE_COUNT);
    for (i, (view, sampler)) in bound.iter().enumerate() {
        let binding = i as u32;
        entries.push(wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) });
        entries.push(wgpu::BindGroupEntry {
            binding: TEXTURE_COUNT as u32 + binding,
            resource: wgpu::BindingResource::Sampler(sampler),
        });
    }
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("material"), layout, entries: &entries })
}

impl GpuScene {
    /// Binds group 0 and the vertex and index buffers.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass, scene_group: &wgpu::BindGroup) {
        pass.set_bind_group(0, scene_group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
    }

    /// Draws one instance with its textures at group 1.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass, draw: &Draw) {
        pass.set_bind_group(1, &self.material_groups[draw.material], &[]);
        pass.draw_indexed(draw.indices.clone(), draw.base_vertex, draw.instance..draw.instance + 1);
    }

    /// Group 0 with the given view.
    pub(crate) fn group(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        view: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scene"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: self.instances.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: self.materials.as_entire_binding() },
            ],
        })
    }
}
