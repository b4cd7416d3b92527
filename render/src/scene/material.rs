//! Materials on the device: their factors in a buffer, their textures in bind groups.

use std::sync::Arc;

use burnish_core::material::{AlphaMode, Material, Reflectance, Sampler, TextureRef, TextureRole};
use burnish_core::scene::{Image, Scene};
use burnish_core::surface::micro_normal;
use glam::{Vec2, Vec4};

use crate::device::Gpu;
use crate::layout::types::{
    MATERIAL_BLEND, MATERIAL_LOBE_SHIFT, MATERIAL_MASK, MATERIAL_PRESET, MATERIAL_UNLIT, MaterialData, TEXTURE_COUNT,
    TextureSlot,
};
use crate::tables::Tables;
use crate::textures::TextureCache;

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

/// The factors of all materials; never empty.
pub(crate) fn material_list(scene: &Scene, tables: &Tables) -> Vec<MaterialData> {
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
    let (lobe, exponent) = m.lobe().numbers();
    flags |= lobe << MATERIAL_LOBE_SHIFT;
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
        fresnel_f0: fresnel.numbers[0],
        fresnel_table: fresnel.table,
        fresnel_c0: fresnel.numbers[1],
        albedo_table: fresnel.albedo_table,
        fresnel_c1: fresnel.numbers[2],
        micro_normal: m.micro_normal as u32,
        fresnel_c2: fresnel.numbers[3],
        micro_size: 1e-3 * m.micro_size_mm,
        fresnel_c3: fresnel.numbers[4],
        micro_depth: m.micro_depth,
        fresnel_mean: fresnel.mean,
        exponent,
        textures: std::array::from_fn(|i| match textures[i] {
            Some(texture) if !bypassed(m, TextureRole::ALL[i]) => TextureSlot::new(texture),
            _ => TextureSlot::absent(),
        }),
    }
}

/// True where bumps change a pixel.
pub(crate) fn is_bumpy(m: &Material) -> bool {
    m.micro_normal != micro_normal::Kind::None && m.micro_depth > 0.0
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

/// What a bind group of textures is made from.
#[derive(Clone)]
struct Bound([Option<(Arc<Image>, bool, Sampler)>; TEXTURE_COUNT]);

impl PartialEq for Bound {
    fn eq(&self, other: &Bound) -> bool {
        self.0.iter().zip(&other.0).all(|(a, b)| match (a, b) {
            (Some(a), Some(b)) => Arc::ptr_eq(&a.0, &b.0) && (a.1, a.2) == (b.1, b.2),
            (None, None) => true,
            _ => false,
        })
    }
}

impl Bound {
    fn new(scene: &Scene, material: &Material) -> Bound {
        let textures = material.textures();
        Bound(std::array::from_fn(|i| {
            let texture = textures[i]?;
            Some((scene.images.get(texture.image)?.clone(), TextureRole::ALL[i].is_color(), texture.sampler))
        }))
    }
}

/// Bind groups of textures; materials with the same textures share one.
pub(crate) struct MaterialGroups {
    layout: wgpu::BindGroupLayout,
    textures: TextureCache,
    known: Vec<(Bound, wgpu::BindGroup)>,
}

impl MaterialGroups {
    pub fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> MaterialGroups {
        MaterialGroups { layout: layout.clone(), textures: TextureCache::new(gpu), known: Vec::new() }
    }

    /// One group a material. What the scene does not use any more is forgotten; images in its list are kept.
    pub fn of(&mut self, gpu: &Gpu, scene: &Scene) -> Vec<wgpu::BindGroup> {
        let mut used: Vec<(Bound, wgpu::BindGroup)> = Vec::new();
        let groups = scene.materials.iter().map(|material| {
            let bound = Bound::new(scene, material);
            let found = used.iter().chain(&self.known).find(|(known, _)| *known == bound);
            if let Some((_, group)) = found {
                let group = group.clone();
                used.push((bound, group.clone()));
                return group;
            }
            let group = create_group(gpu, &self.layout, &bound, &mut self.textures);
            used.push((bound, group.clone()));
            group
        });
        let groups = groups.collect();
        self.known = used;
        self.textures.retain(&scene.images);
        groups
    }
}

fn create_group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, bound: &Bound, cache: &mut TextureCache) -> wgpu::BindGroup {
    let bound = bound.0.each_ref().map(|texture| match texture {
        Some((image, is_color, sampler)) => (cache.view(gpu, image, *is_color), cache.sampler(gpu, *sampler)),
        None => (cache.white(), cache.sampler(gpu, Default::default())),
    });
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
