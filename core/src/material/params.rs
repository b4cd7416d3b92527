//! The factors of a material as declared settings: what the inspector shows and documents store.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};

use super::{AlphaMode, Material, ReflectionModel};
use crate::param::{Affects, ParamKind, ParamSpec, ParamValue};
use crate::surface::{blinn_phong, micro_normal};

/// Values by key.
pub type Values = BTreeMap<&'static str, ParamValue>;

const fn number(key: &'static str, label: &'static str, max: f64, default: f64, help: &'static str) -> ParamSpec {
    let kind = ParamKind::Number { min: 0.0, max, default };
    ParamSpec { key, label, unit: "", kind, help, affects: Affects::Frame }
}

const fn color(key: &'static str, label: &'static str, help: &'static str) -> ParamSpec {
    let kind = ParamKind::Color { max: 1.0, default: [1.0; 3] };
    ParamSpec { key, label, unit: "linear Rec.709", kind, help, affects: Affects::Frame }
}

const fn toggle(key: &'static str, label: &'static str, help: &'static str) -> ParamSpec {
    ParamSpec { key, label, unit: "", kind: ParamKind::Toggle { default: false }, help, affects: Affects::Frame }
}

/// Every factor of [`Material`], in the order in which people look for them.
pub const PARAMS: &[ParamSpec] = &[
    color("base-color", "Base color", "Diffuse albedo of a dielectric, reflectance at normal incidence of a metal."),
    number("metallic", "Metallic", 1.0, 0.0, "0 is a dielectric, 1 a metal."),
    number("roughness", "Roughness", 1.0, 1.0, "0 is a mirror, 0.1 satin, 0.5 dull; alpha of GGX is its square."),
    number("anisotropy", "Anisotropy", 1.0, 0.0, "Stretches highlights: 0 is round, 1 the finest brushing."),
    ParamSpec {
        unit: "deg",
        kind: ParamKind::Number { min: -180.0, max: 180.0, default: 0.0 },
        ..number(
            "anisotropy-rotation",
            "Anisotropy rotation",
            180.0,
            0.0,
            "Direction of the brushing, counter-clockwise from the tangent.",
        )
    },
    ParamSpec {
        kind: ParamKind::Choice { options: &ReflectionModel::IDS, default: 0 },
        ..number(
            "reflection-model",
            "Reflection model",
            1.0,
            0.0,
            "Shape of highlights. ggx: microfacets of roughness and anisotropy. blinn-phong: a power of the cosine, as in \
             older renderers, which darkens toward the rim. approximate, unnormalized and microfacet reproduce its \
             published forms, not all of which keep the energy.",
        )
    },
    ParamSpec {
        kind: ParamKind::Number { min: 0.0, max: blinn_phong::EXPONENT_MAX as f64, default: 32.0 },
        ..number(
            "exponent",
            "Exponent",
            1.0,
            32.0,
            "Narrowness of a Blinn-Phong highlight, in the place of roughness: 8 is chalky, 32 dull, 512 polished.",
        )
    },
    ParamSpec {
        kind: ParamKind::Choice { options: &micro_normal::Kind::IDS, default: 0 },
        ..number(
            "micro-normal",
            "Bumps",
            1.0,
            0.0,
            "Relief of the finish: grain of blasting, bumps of a cast skin, dents of a hammer. Needs no texture coordinates.",
        )
    },
    ParamSpec {
        unit: "mm",
        kind: ParamKind::Number { min: 0.01, max: 1000.0, default: 5.0 },
        ..number(
            "micro-size",
            "Bump size",
            1000.0,
            5.0,
            "Width of a bump or dent. Bumps finer than two pixels are shown as roughness.",
        )
    },
    number(
        "micro-depth",
        "Bump depth",
        1.0,
        0.2,
        "Root mean square slope of the bumps: 0.1 is planished, 0.2 hammered, 0.4 rough-cast.",
    ),
    number("coat", "Coat", 1.0, 0.0, "Weight of a clear lacquer (index 1.5) over everything."),
    number("coat-roughness", "Coat roughness", 1.0, 0.0, "Roughness of the lacquer."),
    ParamSpec {
        kind: ParamKind::Number { min: 1.0, max: 3.0, default: 1.5 },
        ..number("ior", "Index of refraction", 3.0, 1.5, "Of the dielectric part: 1.33 water, 1.5 glass, 2.42 diamond.")
    },
    number("specular", "Specular", 1.0, 1.0, "Strength of the dielectric reflection."),
    color("specular-color", "Specular color", "Tint of the dielectric reflection at normal incidence."),
    color("emission-color", "Emission color", "Colour of the emitted light."),
    ParamSpec {
        unit: "nit",
        ..number("emission-strength", "Emission strength", 1e6, 0.0, "Largest channel of the emitted radiance.")
    },
    number("normal-scale", "Normal strength", 4.0, 1.0, "Factor on the slopes of the normal texture."),
    number("coat-normal-scale", "Coat normal strength", 4.0, 1.0, "Factor on the slopes of the coat's normals."),
    number("occlusion-strength", "Occlusion strength", 1.0, 1.0, "0 ignores the occlusion texture."),
    number("opacity", "Opacity", 1.0, 1.0, "Factor on the alpha of the base colour; shown by mask and blend."),
    ParamSpec {
        kind: ParamKind::Choice { options: &["opaque", "mask", "blend"], default: 0 },
        ..number("alpha-mode", "Alpha mode", 1.0, 0.0, "How opacity is used: not at all, cut, or blended.")
    },
    number("alpha-cutoff", "Alpha cutoff", 1.0, 0.5, "Mask hides what is less opaque."),
    toggle("double-sided", "Double sided", "Seen and lit from behind as well."),
    toggle("unlit", "Unlit", "Shows the base colour as it is, without light."),
];

/// The value of a factor; `None` for a key that [`PARAMS`] does not declare.
pub fn get(material: &Material, key: &str) -> Option<ParamValue> {
    let number = |v: f32| ParamValue::Number(shortest(v));
    Some(match key {
        "base-color" => color_value(material.base_color),
        "metallic" => number(material.metallic),
        "roughness" => number(material.roughness),
        "anisotropy" => number(material.anisotropy),
        "anisotropy-rotation" => number(wrapped_degrees(material.anisotropy_rotation)),
        "reflection-model" => ParamValue::Choice(material.reflection_model.index()),
        "exponent" => number(material.exponent),
        "micro-normal" => ParamValue::Choice(material.micro_normal as usize),
        "micro-size" => number(material.micro_size_mm),
        "micro-depth" => number(material.micro_depth),
        "coat" => number(material.coat),
        "coat-roughness" => number(material.coat_roughness),
        "ior" => number(material.ior),
        "specular" => number(material.specular),
        "specular-color" => color_value(material.specular_color),
        "emission-color" => {
            let strength = material.emission.max_element();
            color_value(if strength > 0.0 { material.emission / strength } else { Vec3::ONE })
        }
        "emission-strength" => number(material.emission.max_element()),
        "normal-scale" => number(material.normal_scale),
        "coat-normal-scale" => number(material.coat_normal_scale),
        "occlusion-strength" => number(material.occlusion_strength),
        "opacity" => number(material.opacity),
        "alpha-mode" => ParamValue::Choice(match material.alpha_mode {
            AlphaMode::Opaque => 0,
            AlphaMode::Mask { .. } => 1,
            AlphaMode::Blend => 2,
        }),
        "alpha-cutoff" => match material.alpha_mode {
            AlphaMode::Mask { cutoff } => number(cutoff),
            _ => ParamValue::Number(0.5),
        },
        "double-sided" => ParamValue::Toggle(material.double_sided),
        "unlit" => ParamValue::Toggle(material.unlit),
        _ => return None,
    })
}

/// Writes values over those of a material; keys and kinds that [`PARAMS`] does not declare are left out.
pub fn apply(material: &mut Material, values: &Values) {
    // Colour and strength, mode and cutoff make one field each: read before either is written, and left alone where
    // neither is.
    let given = |keys: [&str; 2]| keys.iter().any(|key| values.contains_key(key));
    let merged = |key: &str| values.get(key).copied().or_else(|| get(material, key));
    let pair = (merged("emission-color"), merged("emission-strength"));
    let emission = match pair {
        (Some(ParamValue::Color(c)), Some(ParamValue::Number(s))) if given(["emission-color", "emission-strength"]) => {
            (s * DVec3::from(c)).as_vec3()
        }
        _ => material.emission,
    };
    let alpha_mode = match (merged("alpha-mode"), merged("alpha-cutoff")) {
        (Some(ParamValue::Choice(1)), Some(ParamValue::Number(c))) => AlphaMode::Mask { cutoff: c as f32 },
        (Some(ParamValue::Choice(2)), _) => AlphaMode::Blend,
        (Some(ParamValue::Choice(_)), _) => AlphaMode::Opaque,
        _ => material.alpha_mode,
    };
    for (key, value) in values {
        match *value {
            ParamValue::Number(v) => set_number(material, key, v as f32),
            ParamValue::Color(c) => match *key {
                "base-color" => material.base_color = DVec3::from(c).as_vec3(),
                "specular-color" => material.specular_color = DVec3::from(c).as_vec3(),
                _ => {}
            },
            ParamValue::Toggle(on) => match *key {
                "double-sided" => material.double_sided = on,
                "unlit" => material.unlit = on,
                _ => {}
            },
            ParamValue::Choice(index) => set_choice(material, key, index),
            // No setting of a material is one.
            ParamValue::Integer(_) | ParamValue::Vector(_) => {}
        }
    }
    material.emission = emission;
    material.alpha_mode = alpha_mode;
}

fn set_choice(material: &mut Material, key: &str, index: usize) {
    match key {
        "reflection-model" => {
            material.reflection_model = ReflectionModel::ALL.get(index).copied().unwrap_or_default();
        }
        "micro-normal" => material.micro_normal = micro_normal::Kind::ALL.get(index).copied().unwrap_or_default(),
        _ => {}
    }
}

fn set_number(material: &mut Material, key: &str, value: f32) {
    let field = match key {
        "metallic" => &mut material.metallic,
        "roughness" => &mut material.roughness,
        "anisotropy" => &mut material.anisotropy,
        "anisotropy-rotation" => {
            material.anisotropy_rotation = value.to_radians();
            return;
        }
        "exponent" => &mut material.exponent,
        "micro-size" => &mut material.micro_size_mm,
        "micro-depth" => &mut material.micro_depth,
        "coat" => &mut material.coat,
        "coat-roughness" => &mut material.coat_roughness,
        "ior" => &mut material.ior,
        "specular" => &mut material.specular,
        "normal-scale" => &mut material.normal_scale,
        "coat-normal-scale" => &mut material.coat_normal_scale,
        "occlusion-strength" => &mut material.occlusion_strength,
        "opacity" => &mut material.opacity,
        _ => return,
    };
    *field = value;
}

fn color_value(c: Vec3) -> ParamValue {
    ParamValue::Color(c.to_array().map(shortest))
}

/// The decimal number that reads back as this f32: 0.1, not 0.10000000149.
fn shortest(v: f32) -> f64 {
    v.to_string().parse().unwrap_or(f64::from(v))
}

/// Degrees from -180 to 180.
fn wrapped_degrees(radians: f32) -> f32 {
    let degrees = radians.to_degrees();
    if degrees.abs() <= 180.0 { degrees } else { (degrees + 180.0).rem_euclid(360.0) - 180.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_declared_factor_is_read_and_written() {
        for spec in PARAMS {
            let other = match spec.kind {
                ParamKind::Number { min, max, .. } => ParamValue::Number(0.5 * (min + max.min(2.0)) + 0.125),
                ParamKind::Integer { min, .. } => ParamValue::Integer(min),
                ParamKind::Choice { .. } => ParamValue::Choice(1),
                ParamKind::Toggle { default } => ParamValue::Toggle(!default),
                ParamKind::Color { .. } => ParamValue::Color([0.25, 1.0, 0.5]),
                ParamKind::Vector { max, .. } => ParamValue::Vector(max),
            };
            let mut values = Values::from([(spec.key, other)]);
            // What only shows together with its partner.
            match spec.key {
                "emission-color" => _ = values.insert("emission-strength", ParamValue::Number(2.0)),
                "alpha-cutoff" => _ = values.insert("alpha-mode", ParamValue::Choice(1)),
                _ => {}
            }
            let mut material = Material::default();
            apply(&mut material, &values);
            assert_eq!(get(&material, spec.key), Some(other), "{}", spec.key);
        }
    }

    #[test]
    fn the_declared_defaults_are_those_of_the_default_material() {
        for spec in PARAMS {
            assert_eq!(get(&Material::default(), spec.key), Some(spec.default()), "{}", spec.key);
        }
    }

    #[test]
    fn no_values_change_nothing() {
        let before = Material { emission: Vec3::new(3.0, 1.0, 0.0), ..Material::default() };
        let mut after = before.clone();
        apply(&mut after, &Values::new());
        assert_eq!(after.emission, before.emission);
    }
}
