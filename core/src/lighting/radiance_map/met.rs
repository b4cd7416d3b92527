//! Surfaces as rays find them where textures are not at hand: by their means.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::material::{Looked, TextureRef};
use crate::reference::mean_texel;
use crate::scene::Scene;

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
        let Looked { color, metallic, alpha, dielectric_f0, dielectric_f90, coat, coat_alpha } =
            Looked::new(m, Vec3::ONE, mean);
        let emission = m.emission * mean(m.emission_texture, true).xyz();
        let base_color = color.clamp(Vec3::ZERO, Vec3::ONE);
        let lit = MetSurface { base_color, metallic, alpha, emission, dielectric_f0, dielectric_f90, coat, coat_alpha };
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
