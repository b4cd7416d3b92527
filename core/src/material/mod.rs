//! Materials: what a surface is made of, before textures are looked up.

pub mod finish;
mod looked;
pub mod params;
pub mod preset;
mod reflection;
pub mod saved;
mod texture;

use std::sync::Arc;

use glam::{Mat3, Vec3};

use crate::surface::fresnel::Fresnel;
use crate::surface::layered::Lobe;
use crate::surface::{blinn_phong, micro_normal};

pub use looked::Looked;
pub use reflection::ReflectionModel;
pub use texture::TextureRole;

/// A metallic-roughness material with coat and anisotropy; every factor multiplies its texture. Linear Rec.709.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name for people; slots are found by it.
    pub name: String,
    /// Diffuse albedo of a dielectric, F0 of a metal.
    pub base_color: Vec3,
    /// RGB base colour (sRGB encoded), alpha opacity.
    pub base_color_texture: Option<TextureRef>,
    /// Opacity factor.
    pub opacity: f32,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// Artist value 0..1; alpha of GGX is its square.
    pub roughness: f32,
    /// G roughness, B metallic.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Shape of the reflection of metal and dielectric.
    pub reflection_model: ReflectionModel,
    /// Exponent of Blinn-Phong, 0 to [`blinn_phong::EXPONENT_MAX`]; stands for roughness and anisotropy there.
    pub exponent: f32,
    /// How the metal part reflects.
    pub reflectance: Reflectance,
    /// Tangent-space normals.
    pub normal_texture: Option<TextureRef>,
    /// Factor on the x and y of the normal texture.
    pub normal_scale: f32,
    /// R ambient occlusion.
    pub occlusion_texture: Option<TextureRef>,
    /// 0 ignores the occlusion texture, 1 applies it fully.
    pub occlusion_strength: f32,
    /// Emitted radiance, strength included.
    pub emission: Vec3,
    /// RGB (sRGB encoded).
    pub emission_texture: Option<TextureRef>,
    /// How opacity is used.
    pub alpha_mode: AlphaMode,
    /// Seen and lit from both sides.
    pub double_sided: bool,
    /// Shows the base colour as emission and nothing else (KHR_materials_unlit).
    pub unlit: bool,
    /// Index of refraction of the dielectric part.
    pub ior: f32,
    /// Strength of the dielectric reflection.
    pub specular: f32,
    /// A strength.
    pub specular_texture: Option<TextureRef>,
    /// Tint of the dielectric F0.
    pub specular_color: Vec3,
    /// RGB (sRGB encoded).
    pub specular_color_texture: Option<TextureRef>,
    /// Weight of the clear coat.
    pub coat: f32,
    /// R weight.
    pub coat_texture: Option<TextureRef>,
    /// Artist roughness of the coat.
    pub coat_roughness: f32,
    /// G roughness.
    pub coat_roughness_texture: Option<TextureRef>,
    /// Normals of the coat; the geometric normal when absent.
    pub coat_normal_texture: Option<TextureRef>,
    /// Factor on the x and y of the coat normal texture.
    pub coat_normal_scale: f32,
    /// Strength s of the anisotropy: alpha_b = r^2, alpha_t = mix(r^2, 1, s^2).
    pub anisotropy: f32,
    /// Radians counter-clockwise from the tangent.
    pub anisotropy_rotation: f32,
    /// RG direction in [-1, 1], B strength.
    pub anisotropy_texture: Option<TextureRef>,
    /// Procedural bumps under the coat.
    pub micro_normal: micro_normal::Kind,
    /// Size of a bump in millimetres of the object at the size at which it stands in the scene.
    pub micro_size_mm: f32,
    /// Root mean square slope of the bumps, 0..1.
    pub micro_depth: f32,
}

/// Where the reflectance of the metal part comes from.
#[derive(Clone, Debug, Default)]
pub enum Reflectance {
    /// The base colour is F0 of the rescaled (Schlick) form, as glTF defines it.
    #[default]
    BaseColor,
    /// A preset: the base colour and metallic values and textures are bypassed, the surface is metal throughout.
    Preset {
        /// Id such as `Au`.
        id: String,
        /// The Fresnel curve in the form chosen for rendering.
        fresnel: Arc<Fresnel>,
    },
}

/// How opacity is used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Ignored.
    #[default]
    Opaque,
    /// Cut where below the value.
    Mask {
        /// Least opacity that is shown.
        cutoff: f32,
    },
    /// Blended over what is behind.
    Blend,
}

/// A texture of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Index into `Scene::images`.
    pub image: usize,
    /// Wrapping and filters.
    pub sampler: Sampler,
    /// Texture coordinate set, 0 or 1.
    pub uv_set: u8,
    /// KHR_texture_transform as one matrix on `(u, v, 1)`.
    pub transform: Mat3,
}

/// How texels are read outside and between their centres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Across.
    pub wrap_u: Wrap,
    /// Down.
    pub wrap_v: Wrap,
    /// When magnified.
    pub magnify: Filter,
    /// When minified.
    pub minify: Filter,
    /// Between mip levels; `None` reads the largest only.
    pub mip: Option<Filter>,
}

/// What lies outside [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Repeats.
    #[default]
    Repeat,
    /// Repeats, every second one mirrored.
    Mirror,
    /// The edge texel goes on.
    Clamp,
}

/// Between texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The nearest.
    Nearest,
    /// Weighted by distance.
    #[default]
    Linear,
}

impl Default for Material {
    /// The material of glTF when a primitive names none, except that it is not metallic.
    fn default() -> Material {
        Material {
            name: "default".into(),
            base_color: Vec3::ONE,
            base_color_texture: None,
            opacity: 1.0,
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            reflection_model: ReflectionModel::Ggx,
            exponent: 32.0,
            reflectance: Reflectance::BaseColor,
            normal_texture: None,
            normal_scale: 1.0,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emission: Vec3::ZERO,
            emission_texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            ior: 1.5,
            specular: 1.0,
            specular_texture: None,
            specular_color: Vec3::ONE,
            specular_color_texture: None,
            coat: 0.0,
            coat_texture: None,
            coat_roughness: 0.0,
            coat_roughness_texture: None,
            coat_normal_texture: None,
            coat_normal_scale: 1.0,
            anisotropy: 0.0,
            anisotropy_rotation: 0.0,
            anisotropy_texture: None,
            micro_normal: micro_normal::Kind::None,
            micro_size_mm: 5.0,
            micro_depth: 0.2,
        }
    }
}

impl Material {
    /// The lobe of metal and dielectric.
    pub fn lobe(&self) -> Lobe {
        match self.reflection_model {
            ReflectionModel::Ggx => Lobe::Ggx,
            ReflectionModel::BlinnPhong(variant) => {
                Lobe::BlinnPhong { exponent: blinn_phong::clamp_exponent(self.exponent), variant }
            }
        }
    }
}
