//! Materials with the extensions that Burnish shows.

use ::gltf::json::Root;
use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::json::material::{AlphaMode as JsonAlphaMode, Material as Json, NormalTexture};
use ::gltf::json::texture::Info;
use ::gltf::json::validation::Checked;
use glam::{Vec3, Vec4, Vec4Swizzles};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::element;
use super::texture::{Asked, Images};
use crate::import::report::Report;
use crate::material::{AlphaMode, Material, TextureRef};

/// The materials of a file.
pub(super) struct Materials {
    /// As in the file, then the default one if a primitive needs it.
    pub list: Vec<Material>,
    /// Index of the default material; past the end when no primitive needs it.
    pub default: usize,
}

/// What a material asks of the meshes that wear it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Uses {
    /// Texture coordinate sets that its textures read.
    pub uv_sets: [bool; 2],
    /// The set along which tangents run.
    pub tangent_uv: usize,
}

/// KHR_materials_clearcoat, which the `gltf` crate does not know.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Clearcoat {
    clearcoat_factor: f32,
    clearcoat_texture: Option<Info>,
    clearcoat_roughness_factor: f32,
    clearcoat_roughness_texture: Option<Info>,
    clearcoat_normal_texture: Option<NormalTexture>,
}

/// KHR_materials_anisotropy, which the `gltf` crate does not know.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Anisotropy {
    anisotropy_strength: f32,
    anisotropy_rotation: f32,
    anisotropy_texture: Option<Info>,
}

impl Materials {
    pub fn uses(&self, index: usize) -> Uses {
        let Some(m) = self.list.get(index) else { return Uses { uv_sets: [false; 2], tangent_uv: 0 } };
        let directional = m.normal_texture.or(m.anisotropy_texture).or(m.coat_normal_texture);
        let all = m.textures();
        let set = |set: u8| all.iter().flatten().any(|t| t.uv_set == set);
        Uses { uv_sets: [set(0), set(1)], tangent_uv: directional.map_or(0, |t| usize::from(t.uv_set)) }
    }
}

/// Reads all materials; a value out of range is brought into it with a notice.
pub(super) fn read_all(root: &Root, images: &Images, report: &mut Report) -> Materials {
    let mut list = Vec::with_capacity(root.materials.len() + 1);
    for (i, json) in root.materials.iter().enumerate() {
        let at = element("material", i, json.name.as_deref());
        let name = json.name.clone().filter(|n| !n.is_empty()).unwrap_or_else(|| format!("material {i}"));
        let mut reader = Reader { root, images, at: &at, report };
        let material = reader.material(json, name);
        list.push(material);
    }
    let default = list.len();
    if root.meshes.iter().flat_map(|m| &m.primitives).any(|p| p.material.is_none()) {
        // A glTF primitive without a material is of a rough white metal (glTF 2.0, 3.9.1 with 5.22).
        list.push(Material { metallic: 1.0, ..Material::default() });
    }
    Materials { list, default }
}

struct Reader<'a> {
    root: &'a Root,
    images: &'a Images,
    at: &'a str,
    report: &'a mut Report,
}

impl Reader<'_> {
    fn material(&mut self, json: &Json, name: String) -> Material {
        let pbr = &json.pbr_metallic_roughness;
        let color = Vec4::from(pbr.base_color_factor.0);
        let normal = json.normal_texture.as_ref();
        let mut material = Material {
            name,
            base_color: self.color("baseColorFactor", color.xyz(), 1.0),
            base_color_texture: self.info("base colour", pbr.base_color_texture.as_ref()),
            opacity: self.unit("baseColorFactor alpha", color.w),
            metallic: self.unit("metallicFactor", pbr.metallic_factor.0),
            roughness: self.unit("roughnessFactor", pbr.roughness_factor.0),
            metallic_roughness_texture: self.info("metallic-roughness", pbr.metallic_roughness_texture.as_ref()),
            normal_texture: self.normal("normal", normal),
            normal_scale: self.number("normal scale", normal.map_or(1.0, |n| n.scale), f32::MIN, f32::MAX, 1.0),
            emission: self.color("emissiveFactor", Vec3::from(json.emissive_factor.0), f32::MAX),
            emission_texture: self.info("emissive", json.emissive_texture.as_ref()),
            double_sided: json.double_sided,
            alpha_mode: self.alpha_mode(json),
            ..Material::default()
        };
        if let Some(occlusion) = &json.occlusion_texture {
            let others = occlusion.extensions.as_ref().map(|e| &e.others);
            let transform = self.transform(others);
            let asked =
                Asked { texture: occlusion.index.value(), uv_set: occlusion.tex_coord, transform: transform.as_ref() };
            material.occlusion_texture = self.images.texture(self.root, &asked, self.at, "occlusion", self.report);
            material.occlusion_strength = self.unit("occlusion strength", occlusion.strength.0);
        }
        self.extensions(json, &mut material);
        material
    }

    fn alpha_mode(&mut self, json: &Json) -> AlphaMode {
        match json.alpha_mode {
            Checked::Valid(JsonAlphaMode::Opaque) => AlphaMode::Opaque,
            Checked::Valid(JsonAlphaMode::Blend) => AlphaMode::Blend,
            Checked::Valid(JsonAlphaMode::Mask) => {
                let cutoff = json.alpha_cutoff.unwrap_or_default().0;
                AlphaMode::Mask { cutoff: self.number("alphaCutoff", cutoff, 0.0, f32::MAX, 0.5) }
            }
            Checked::Invalid => {
                self.report.notice(self.at, "the alpha mode is unknown; the material is shown opaque");
                AlphaMode::Opaque
            }
        }
    }

    fn extensions(&mut self, json: &Json, m: &mut Material) {
        let Some(extensions) = &json.extensions else { return };
        m.unlit = extensions.unlit.is_some();
        if let Some(ior) = &extensions.ior {
            // An index of 0 is the extension's own way to ask for total reflection (5.2 of its text).
            let least = if ior.ior.0 == 0.0 { 0.0 } else { 1.0 };
            m.ior = self.number("ior", ior.ior.0, least, f32::MAX, 1.5);
        }
        if let Some(strength) = &extensions.emissive_strength {
            let strength = self.number("emissiveStrength", strength.emissive_strength.0, 0.0, f32::MAX, 1.0);
            m.emission = self.color("emissive strength times factor", m.emission * strength, f32::MAX);
        }
        if let Some(specular) = &extensions.specular {
            m.specular = self.unit("specularFactor", specular.specular_factor.0);
            m.specular_texture = self.info("specular", specular.specular_texture.as_ref());
            m.specular_color = self.color("specularColorFactor", specular.specular_color_factor.0.into(), f32::MAX);
            m.specular_color_texture = self.info("specular colour", specular.specular_color_texture.as_ref());
        }
        if let Some(coat) = self.extension::<Clearcoat>(&extensions.others, "KHR_materials_clearcoat") {
            let normal = coat.clearcoat_normal_texture.as_ref();
            m.coat = self.unit("clearcoatFactor", coat.clearcoat_factor);
            m.coat_texture = self.info("clearcoat", coat.clearcoat_texture.as_ref());
            m.coat_roughness = self.unit("clearcoatRoughnessFactor", coat.clearcoat_roughness_factor);
            m.coat_roughness_texture = self.info("clearcoat roughness", coat.clearcoat_roughness_texture.as_ref());
            m.coat_normal_texture = self.normal("clearcoat normal", normal);
            let scale = normal.map_or(1.0, |n| n.scale);
            m.coat_normal_scale = self.number("clearcoat normal scale", scale, f32::MIN, f32::MAX, 1.0);
        }
        if let Some(anisotropy) = self.extension::<Anisotropy>(&extensions.others, "KHR_materials_anisotropy") {
            m.anisotropy = self.unit("anisotropyStrength", anisotropy.anisotropy_strength);
            let rotation = anisotropy.anisotropy_rotation;
            m.anisotropy_rotation = self.number("anisotropyRotation", rotation, f32::MIN, f32::MAX, 0.0);
            m.anisotropy_texture = self.info("anisotropy", anisotropy.anisotropy_texture.as_ref());
        }
    }

    /// An extension's own fields; one that does not parse is left out with a notice.
    fn extension<T: DeserializeOwned>(&mut self, others: &Map<String, Value>, name: &str) -> Option<T> {
        let value = others.get(name)?;
        match T::deserialize(value) {
            Ok(extension) => Some(extension),
            Err(error) => {
                self.report.notice(self.at, format!("{name} is left out: {error}"));
                None
            }
        }
    }

    fn info(&mut self, what: &str, info: Option<&Info>) -> Option<TextureRef> {
        let info = info?;
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        let asked = Asked { texture: info.index.value(), uv_set: info.tex_coord, transform };
        self.images.texture(self.root, &asked, self.at, what, self.report)
    }

    fn normal(&mut self, what: &str, json: Option<&NormalTexture>) -> Option<TextureRef> {
        let json = json?;
        let transform = self.transform(json.extensions.as_ref().map(|e| &e.others));
        let asked = Asked { texture: json.index.value(), uv_set: json.tex_coord, transform: transform.as_ref() };
        self.images.texture(self.root, &asked, self.at, what, self.report)
    }

    /// The texture transform of normal and occlusion textures, which the crate leaves unparsed.
    fn transform(&mut self, others: Option<&Map<String, Value>>) -> Option<TextureTransform> {
        self.extension(others?, "KHR_texture_transform")
    }

    fn unit(&mut self, what: &str, value: f32) -> f32 {
        self.number(what, value, 0.0, 1.0, 1.0)
    }

    /// The value within `least..=greatest`; `instead` of NaN.
    fn number(&mut self, what: &str, value: f32, least: f32, greatest: f32, instead: f32) -> f32 {
        let kept = if value.is_nan() { instead } else { value.clamp(least, greatest) };
        if kept != value {
            self.report.notice(self.at, format!("{what} was {value}; {kept} is used"));
        }
        kept
    }

    /// The colour with every part within `0..=greatest`; 0 instead of NaN.
    fn color(&mut self, what: &str, value: Vec3, greatest: f32) -> Vec3 {
        let kept = Vec3::from(value.to_array().map(|v| if v.is_nan() { 0.0 } else { v.clamp(0.0, greatest) }));
        if kept != value {
            self.report.notice(self.at, format!("{what} was {value}; {kept} is used"));
        }
        kept
    }
}
