//! The numbers of a material with its textures looked up: at a point, or in the mean.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::{Material, Reflectance, TextureRef};
use crate::surface::dielectric;

/// What lobes are made of, in linear Rec.709.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Looked {
    /// Of the base; above 1 only where an unlit surface is so bright.
    pub color: Vec3,
    /// 0 to 1.
    pub metallic: f32,
    /// Widths of the lobe along the tangent and across.
    pub alpha: Vec2,
    /// Reflectance of the dielectric at normal incidence.
    pub dielectric_f0: Vec3,
    /// At grazing incidence.
    pub dielectric_f90: f32,
    /// Share of the surface that is coated.
    pub coat: f32,
    /// Width of the coat's lobe.
    pub coat_alpha: f32,
}

impl Looked {
    /// Those of a material under the colour of its corners. `look` finds a texture, as a colour where it is told so; white where there is none.
    pub fn new(m: &Material, corners: Vec3, look: impl Fn(Option<TextureRef>, bool) -> Vec4) -> Looked {
        let rough = look(m.metallic_roughness_texture, false);
        let color = m.base_color * corners * look(m.base_color_texture, true).xyz();
        let roughness = (m.roughness * rough.y).clamp(0.0, 1.0);
        let coat_roughness = (m.coat_roughness * look(m.coat_roughness_texture, false).y).clamp(0.0, 1.0);
        let strength = (m.anisotropy * look(m.anisotropy_texture, false).z).clamp(0.0, 1.0);
        let along = roughness * roughness + (1.0 - roughness * roughness) * strength * strength;
        let weight = (m.specular * look(m.specular_texture, false).w).clamp(0.0, 1.0);
        let tint = m.specular_color * look(m.specular_color_texture, true).xyz();
        let is_metal = matches!(m.reflectance, Reflectance::Preset { .. });
        Looked {
            color,
            metallic: if is_metal { 1.0 } else { (m.metallic * rough.z).clamp(0.0, 1.0) },
            alpha: m.lobe().alpha(Vec2::new(along, roughness * roughness)),
            dielectric_f0: dielectric::f0(m.ior, weight, tint),
            dielectric_f90: weight,
            coat: (m.coat * look(m.coat_texture, false).x).clamp(0.0, 1.0),
            coat_alpha: coat_roughness * coat_roughness,
        }
    }
}
