//! Surfaces as rays find them where textures are not at hand: by their means.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::material::{Reflectance, TextureRef};
use crate::reference::mean_texel;
use crate::scene::Scene;
use crate::surface::dielectric;

/// A material with the means of its textures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetSurface {
    /// Linear Rec.709.
    pub base_color: Vec3,
    /// 0 to 1.
    pub metallic: f32,
    /// Widths of the lobe, those of the mean roughness.
    pub alpha: Vec2,
    /// Radiance.
    pub emission: Vec3,
    /// Reflectance of the dielectric at normal incidence.
    pub dielectric_f0: Vec3,
    /// At grazing incidence.
    pub dielectric_f90: f32,
    /// Share of the surface that is coated.
    pub coat: f32,
    /// Width of the coat's lobe.
    pub coat_alpha: f32,
}

impl MetSurface {
    /// That of a material of a scene.
    pub fn of(scene: &Scene, material: usize) -> MetSurface {
        let m = &scene.materials[material];
        let mean = |texture: Option<TextureRef>, color| mean_texel(scene, texture, color).unwrap_or(Vec4::ONE);
        let rough = mean(m.metallic_roughness_texture, false);
        let color = m.base_color * mean(m.base_color_texture, true).xyz();
        let squared = |roughness: f32| roughness.clamp(0.0, 1.0).powi(2);
        let across = squared(m.roughness * rough.y);
        let strength = (m.anisotropy * mean(m.anisotropy_texture, false).z).clamp(0.0, 1.0);
        let along = across + (1.0 - across) * strength * strength;
        let weight = (m.specular * mean(m.specular_texture, false).w).clamp(0.0, 1.0);
        let tint = m.specular_color * mean(m.specular_color_texture, true).xyz();
        let is_metal = matches!(m.reflectance, Reflectance::Preset { .. });
        let lit = MetSurface {
            base_color: color.clamp(Vec3::ZERO, Vec3::ONE),
            metallic: if is_metal { 1.0 } else { (m.metallic * rough.z).clamp(0.0, 1.0) },
            alpha: m.lobe().alpha(Vec2::new(along, across)),
            emission: m.emission * mean(m.emission_texture, true).xyz(),
            dielectric_f0: dielectric::f0(m.ior, weight, tint),
            dielectric_f90: weight,
            coat: (m.coat * mean(m.coat_texture, false).x).clamp(0.0, 1.0),
            coat_alpha: squared(m.coat_roughness * mean(m.coat_roughness_texture, false).y),
        };
        if !m.unlit {
            return lit;
        }
        // It shows its colour and reflects nothing.
        let (zero, none) = (Vec3::ZERO, 0.0);
        MetSurface {
            base_color: zero,
            metallic: none,
            emission: color,
            dielectric_f0: zero,
            dielectric_f90: none,
            coat: none,
            ..lit
        }
    }

    /// Whether some of its points may be smoother than a width.
    pub fn may_be_smooth(scene: &Scene, material: usize, below: f32) -> bool {
        let m = &scene.materials[material];
        let smooth = |roughness: f32, texture: Option<TextureRef>| texture.is_some() || roughness * roughness < below;
        smooth(m.roughness, m.metallic_roughness_texture)
            || (m.coat > 0.0 && smooth(m.coat_roughness, m.coat_roughness_texture))
    }
}
