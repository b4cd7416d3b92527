//! The textures of a material as one list, for whoever treats them alike.

use super::{Material, TextureRef};

/// What a texture of a material stands for. The number is its place in lists and in shaders (`TEXTURE_` constants).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum TextureRole {
    /// RGB base colour, alpha opacity.
    BaseColor,
    /// G roughness, B metallic.
    MetallicRoughness,
    /// Tangent-space normals.
    Normal,
    /// R ambient occlusion.
    Occlusion,
    /// RGB emission.
    Emission,
    /// A strength of the dielectric reflection.
    Specular,
    /// RGB tint of the dielectric F0.
    SpecularColor,
    /// R weight of the coat.
    Coat,
    /// G roughness of the coat.
    CoatRoughness,
    /// Normals of the coat.
    CoatNormal,
    /// RG direction, B strength of the anisotropy.
    Anisotropy,
}

impl TextureRole {
    /// All roles, each at the place of its number.
    pub const ALL: [TextureRole; 11] = [
        TextureRole::BaseColor,
        TextureRole::MetallicRoughness,
        TextureRole::Normal,
        TextureRole::Occlusion,
        TextureRole::Emission,
        TextureRole::Specular,
        TextureRole::SpecularColor,
        TextureRole::Coat,
        TextureRole::CoatRoughness,
        TextureRole::CoatNormal,
        TextureRole::Anisotropy,
    ];

    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            TextureRole::BaseColor => "base color",
            TextureRole::MetallicRoughness => "metallic roughness",
            TextureRole::Normal => "normal",
            TextureRole::Occlusion => "occlusion",
            TextureRole::Emission => "emission",
            TextureRole::Specular => "specular",
            TextureRole::SpecularColor => "specular color",
            TextureRole::Coat => "coat",
            TextureRole::CoatRoughness => "coat roughness",
            TextureRole::CoatNormal => "coat normal",
            TextureRole::Anisotropy => "anisotropy",
        }
    }

    /// True where the texels are colours, encoded in sRGB; the others are numbers.
    pub fn is_color(self) -> bool {
        matches!(self, TextureRole::BaseColor | TextureRole::Emission | TextureRole::SpecularColor)
    }
}

impl Material {
    /// The textures, each at the place of its role's number.
    pub fn textures(&self) -> [Option<TextureRef>; TextureRole::ALL.len()] {
        [
            self.base_color_texture,
            self.metallic_roughness_texture,
            self.normal_texture,
            self.occlusion_texture,
            self.emission_texture,
            self.specular_texture,
            self.specular_color_texture,
            self.coat_texture,
            self.coat_roughness_texture,
            self.coat_normal_texture,
            self.anisotropy_texture,
        ]
    }

    /// The slot of a role.
    pub fn texture_mut(&mut self, role: TextureRole) -> &mut Option<TextureRef> {
        match role {
            TextureRole::BaseColor => &mut self.base_color_texture,
            TextureRole::MetallicRoughness => &mut self.metallic_roughness_texture,
            TextureRole::Normal => &mut self.normal_texture,
            TextureRole::Occlusion => &mut self.occlusion_texture,
            TextureRole::Emission => &mut self.emission_texture,
            TextureRole::Specular => &mut self.specular_texture,
            TextureRole::SpecularColor => &mut self.specular_color_texture,
            TextureRole::Coat => &mut self.coat_texture,
            TextureRole::CoatRoughness => &mut self.coat_roughness_texture,
            TextureRole::CoatNormal => &mut self.coat_normal_texture,
            TextureRole::Anisotropy => &mut self.anisotropy_texture,
        }
    }

    /// The same material with the textures of another.
    pub fn with_textures_of(self, other: &Material) -> Material {
        Material {
            base_color_texture: other.base_color_texture,
            metallic_roughness_texture: other.metallic_roughness_texture,
            normal_texture: other.normal_texture,
            occlusion_texture: other.occlusion_texture,
            emission_texture: other.emission_texture,
            specular_texture: other.specular_texture,
            specular_color_texture: other.specular_color_texture,
            coat_texture: other.coat_texture,
            coat_roughness_texture: other.coat_roughness_texture,
            coat_normal_texture: other.coat_normal_texture,
            anisotropy_texture: other.anisotropy_texture,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Sampler;

    #[test]
    fn roles_stand_at_their_numbers() {
        for (place, role) in TextureRole::ALL.into_iter().enumerate() {
            assert_eq!(role as usize, place);
        }
    }

    #[test]
    fn textures_of_another_material_replace_all() {
        let texture =
            |image| Some(TextureRef { image, sampler: Sampler::default(), uv_set: 0, transform: glam::Mat3::IDENTITY });
        let textured = Material {
            base_color_texture: texture(0),
            metallic_roughness_texture: texture(1),
            normal_texture: texture(2),
            occlusion_texture: texture(3),
            emission_texture: texture(4),
            specular_texture: texture(5),
            specular_color_texture: texture(6),
            coat_texture: texture(7),
            coat_roughness_texture: texture(8),
            coat_normal_texture: texture(9),
            anisotropy_texture: texture(10),
            ..Material::default()
        };
        for role in TextureRole::ALL {
            let slot = textured.clone().texture_mut(role).map(|t| t.image);
            assert_eq!(slot, Some(role as usize), "{role:?}");
        }
        let taken = Material::default().with_textures_of(&textured).textures();
        let images: Vec<_> = taken.iter().flatten().map(|t| t.image).collect();
        assert_eq!(images, (0..TextureRole::ALL.len()).collect::<Vec<_>>());
    }
}
