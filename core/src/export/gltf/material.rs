//! Materials, textures and pictures.

use glam::{Mat3, Vec3};
use serde_json::{Map, Value, json};

use super::Writer;
use crate::export::{Loss, image};
use crate::file::FileError;
use crate::material::{AlphaMode, Filter, Material, Reflectance, ReflectionModel, Sampler, TextureRef, Wrap};
use crate::scene::Texels;
use crate::surface::micro_normal;

/// A texture transform is told as offset, turn and scale up to this difference of its matrix.
const SHEAR: f32 = 1e-5;

impl Writer<'_> {
    /// All materials, in their order.
    pub fn materials(&mut self) -> Vec<Value> {
        let scene = self.scene;
        scene.materials.iter().enumerate().map(|(i, material)| self.material(i, material)).collect()
    }

    fn material(&mut self, index: usize, m: &Material) -> Value {
        let element = format!("material {index} '{}'", m.name);
        let (color, metallic) = self.reflectance(&element, m);
        let mut pbr = json!({
            "baseColorFactor": [color.x, color.y, color.z, m.opacity],
            "metallicFactor": metallic,
            "roughnessFactor": m.roughness,
        });
        let base = m.base_color_texture.filter(|_| !is_opaque_metal(m));
        self.texture(&mut pbr, "baseColorTexture", base, &element);
        self.texture(&mut pbr, "metallicRoughnessTexture", m.metallic_roughness_texture, &element);
        let mut json = json!({ "name": m.name, "pbrMetallicRoughness": pbr });
        self.texture(&mut json, "normalTexture", m.normal_texture, &element);
        if m.normal_texture.is_some() {
            json["normalTexture"]["scale"] = m.normal_scale.into();
        }
        self.texture(&mut json, "occlusionTexture", m.occlusion_texture, &element);
        if m.occlusion_texture.is_some() {
            json["occlusionTexture"]["strength"] = m.occlusion_strength.into();
        }
        self.texture(&mut json, "emissiveTexture", m.emission_texture, &element);
        let mut extensions = Map::new();
        let strength = m.emission.max_element();
        json["emissiveFactor"] = json!((m.emission / strength.max(1.0)).to_array());
        if strength > 1.0 {
            self.extend(&mut extensions, "KHR_materials_emissive_strength", json!({ "emissiveStrength": strength }));
        }
        match m.alpha_mode {
            AlphaMode::Opaque => {}
            AlphaMode::Mask { cutoff } => {
                json["alphaMode"] = "MASK".into();
                json["alphaCutoff"] = cutoff.into();
            }
            AlphaMode::Blend => json["alphaMode"] = "BLEND".into(),
        }
        if m.double_sided {
            json["doubleSided"] = true.into();
        }
        self.extensions_of(&element, m, &mut extensions);
        if !extensions.is_empty() {
            json["extensions"] = extensions.into();
        }
        json
    }

    /// Base colour and metalness that stand for the reflectance.
    fn reflectance(&mut self, element: &str, m: &Material) -> (Vec3, f32) {
        let Reflectance::Preset { id, fresnel } = &m.reflectance else { return (m.base_color, m.metallic) };
        let f0 = fresnel.f0().clamp(Vec3::ZERO, Vec3::ONE);
        let what = format!("the curve of {id} became its reflectance at normal incidence with Schlick's rise to white");
        self.report.note(element, Loss::Approximated, what);
        if m.metallic_roughness_texture.is_some() {
            let what = "the metalness of its texture counts again";
            self.report.note(element, Loss::Approximated, what);
        }
        (f0, 1.0)
    }

    fn extensions_of(&mut self, element: &str, m: &Material, extensions: &mut Map<String, Value>) {
        if m.unlit {
            self.extend(extensions, "KHR_materials_unlit", json!({}));
        }
        if m.ior != 1.5 {
            self.extend(extensions, "KHR_materials_ior", json!({ "ior": m.ior }));
        }
        let is_plain = m.specular == 1.0 && m.specular_color == Vec3::ONE;
        if !is_plain || m.specular_texture.is_some() || m.specular_color_texture.is_some() {
            let color = m.specular_color.to_array();
            let mut specular = json!({ "specularFactor": m.specular, "specularColorFactor": color });
            self.texture(&mut specular, "specularTexture", m.specular_texture, element);
            self.texture(&mut specular, "specularColorTexture", m.specular_color_texture, element);
            self.extend(extensions, "KHR_materials_specular", specular);
        }
        if m.coat > 0.0 {
            let mut coat = json!({ "clearcoatFactor": m.coat, "clearcoatRoughnessFactor": m.coat_roughness });
            self.texture(&mut coat, "clearcoatTexture", m.coat_texture, element);
            self.texture(&mut coat, "clearcoatRoughnessTexture", m.coat_roughness_texture, element);
            self.texture(&mut coat, "clearcoatNormalTexture", m.coat_normal_texture, element);
            if m.coat_normal_texture.is_some() {
                coat["clearcoatNormalTexture"]["scale"] = m.coat_normal_scale.into();
            }
            self.extend(extensions, "KHR_materials_clearcoat", coat);
        }
        if m.anisotropy > 0.0 {
            let (strength, rotation) = (m.anisotropy, m.anisotropy_rotation);
            let mut anisotropy = json!({ "anisotropyStrength": strength, "anisotropyRotation": rotation });
            self.texture(&mut anisotropy, "anisotropyTexture", m.anisotropy_texture, element);
            self.extend(extensions, "KHR_materials_anisotropy", anisotropy);
        }
        if m.reflection_model != ReflectionModel::Ggx {
            self.report.note(element, Loss::Approximated, "Blinn-Phong became GGX of its roughness");
        }
        if m.micro_normal != micro_normal::Kind::None {
            self.report.note(element, Loss::Dropped, "procedural bumps");
        }
    }

    fn extend(&mut self, extensions: &mut Map<String, Value>, name: &'static str, value: Value) {
        self.extensions.insert(name);
        extensions.insert(name.into(), value);
    }

    /// Adds a reference to a texture where there is one.
    fn texture(&mut self, to: &mut Value, key: &str, texture: Option<TextureRef>, element: &str) {
        let Some(TextureRef { image, sampler, uv_set, transform }) = texture else { return };
        let sampler = place(&mut self.samplers, sampler_json(sampler));
        let index = place(&mut self.textures, json!({ "source": image, "sampler": sampler }));
        let mut info = json!({ "index": index, "texCoord": uv_set });
        if transform != Mat3::IDENTITY {
            let (transform, is_exact) = decomposed(&transform);
            if !is_exact {
                self.report.note(element, Loss::Approximated, format!("the shear of {key} is left out"));
            }
            self.extensions.insert("KHR_texture_transform");
            info["extensions"] = json!({ "KHR_texture_transform": transform });
        }
        to[key] = info;
    }

    /// The pictures, as PNG.
    pub fn images(&mut self) -> Result<Vec<Value>, FileError> {
        let mut list = Vec::new();
        for picture in &self.scene.images {
            let (width, height) = (picture.width, picture.height);
            let bytes = match &picture.texels {
                Texels::Unorm8(texels) => image::png_rgba(&picture.name, width, height, texels, false)?,
                Texels::Unorm16(texels) => {
                    let bytes: Vec<u8> = texels.iter().flat_map(|v| v.to_be_bytes()).collect();
                    image::png_rgba(&picture.name, width, height, &bytes, true)?
                }
            };
            let view = self.buffer.view(&bytes, None);
            list.push(json!({ "name": picture.name, "bufferView": view, "mimeType": "image/png" }));
        }
        Ok(list)
    }
}

/// A preset reflects by its curve alone; its base colour would only tint it elsewhere, and has no alpha to tell.
pub(super) fn is_opaque_metal(m: &Material) -> bool {
    matches!(m.reflectance, Reflectance::Preset { .. }) && m.alpha_mode == AlphaMode::Opaque
}

/// The place of a value in a list, which it is added to where it is new.
fn place(list: &mut Vec<Value>, value: Value) -> usize {
    list.iter().position(|known| *known == value).unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}

fn sampler_json(sampler: Sampler) -> Value {
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::Mirror => 33648,
        Wrap::Clamp => 33071,
    };
    let magnify = if sampler.magnify == Filter::Nearest { 9728 } else { 9729 };
    let minify = match (sampler.minify, sampler.mip) {
        (Filter::Nearest, None) => 9728,
        (Filter::Linear, None) => 9729,
        (Filter::Nearest, Some(Filter::Nearest)) => 9984,
        (Filter::Linear, Some(Filter::Nearest)) => 9985,
        (Filter::Nearest, Some(Filter::Linear)) => 9986,
        (Filter::Linear, Some(Filter::Linear)) => 9987,
    };
    json!({ "magFilter": magnify, "minFilter": minify, "wrapS": wrap(sampler.wrap_u), "wrapT": wrap(sampler.wrap_v) })
}

/// Offset, turn and scale of a texture transform; false where it shears as well.
fn decomposed(m: &Mat3) -> (Value, bool) {
    let (x, y, offset) = (m.x_axis.truncate(), m.y_axis.truncate(), m.z_axis.truncate());
    // Counter-clockwise as seen in the picture, whose v axis points down.
    let rotation = (-x.y).atan2(x.x);
    let (sin, cos) = rotation.sin_cos();
    let scale = [x.length(), y.x * sin + y.y * cos];
    let rebuilt = glam::Vec2::new(sin, cos) * scale[1];
    let is_exact = (rebuilt - y).length() <= SHEAR * y.length().max(1e-6);
    (json!({ "offset": offset.to_array(), "rotation": rotation, "scale": scale }), is_exact)
}
