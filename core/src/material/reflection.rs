//! The choice of a reflection model.

use crate::surface::blinn_phong::Variant;

/// Shape of the reflection of a material; its coat is always GGX.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReflectionModel {
    /// Microfacets of the material's roughness and anisotropy.
    #[default]
    Ggx,
    /// A power of the cosine, of the material's exponent.
    BlinnPhong(Variant),
}

impl ReflectionModel {
    /// Every model.
    pub const ALL: [ReflectionModel; 5] = [
        ReflectionModel::Ggx,
        ReflectionModel::BlinnPhong(Variant::Exact),
        ReflectionModel::BlinnPhong(Variant::Approximate),
        ReflectionModel::BlinnPhong(Variant::Unnormalized),
        ReflectionModel::BlinnPhong(Variant::Microfacet),
    ];
    /// Their names in files, in the same order.
    pub const IDS: [&'static str; 5] =
        ["ggx", "blinn-phong", "blinn-phong-approximate", "blinn-phong-unnormalized", "blinn-phong-microfacet"];

    /// Place in [`ReflectionModel::ALL`].
    pub fn index(self) -> usize {
        match self {
            ReflectionModel::Ggx => 0,
            // Variants count from 1.
            ReflectionModel::BlinnPhong(variant) => variant as usize,
        }
    }

    /// Name in files.
    pub fn id(self) -> &'static str {
        ReflectionModel::IDS[self.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variant_is_a_model_at_the_place_of_its_name() {
        for (index, model) in ReflectionModel::ALL.into_iter().enumerate() {
            assert_eq!(model.index(), index);
        }
        let variants = Variant::ALL.map(|variant| ReflectionModel::BlinnPhong(variant).id());
        assert_eq!(variants[..], ReflectionModel::IDS[1..]);
    }
}
