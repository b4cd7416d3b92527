//! The factors of a material, in groups.

use burnish_core::document::MaterialEntry;
use burnish_core::material::params::{self, PARAMS};
use burnish_core::material::{AlphaMode, Material, ReflectionModel};
use burnish_core::param::{self, ParamSpec, ParamValue};
use burnish_core::surface::micro_normal;
use eframe::egui;

use super::Context;
use crate::window::widget::{Change, ParamEdit, param_ui};

/// A group of factors.
struct Group {
    title: &'static str,
    keys: &'static [&'static str],
    /// Open when nobody has opened or closed it.
    open: bool,
}

const GROUPS: &[Group] = &[
    Group { title: "Base", keys: &["base-color"], open: true },
    Group { title: "Metal and roughness", keys: &["metallic", "roughness"], open: true },
    Group { title: "Anisotropy", keys: &["anisotropy", "anisotropy-rotation"], open: true },
    Group { title: "Reflection model", keys: &["reflection-model", "exponent"], open: false },
    Group { title: "Bumps", keys: &["micro-normal", "micro-size", "micro-depth"], open: false },
    Group { title: "Coat", keys: &["coat", "coat-roughness", "coat-normal-scale"], open: false },
    Group { title: "Dielectric", keys: &["ior", "specular", "specular-color"], open: false },
    Group { title: "Emission", keys: &["emission-color", "emission-strength"], open: false },
    Group { title: "Normal and occlusion", keys: &["normal-scale", "occlusion-strength"], open: false },
    Group { title: "Alpha", keys: &["opacity", "alpha-mode", "alpha-cutoff", "double-sided", "unlit"], open: false },
];

/// Shows all groups.
pub fn factors_ui(ui: &mut egui::Ui, context: &mut Context<'_>, index: usize) {
    let Some(entry) = context.session.document().materials.get(index).cloned() else { return };
    let Some(material) = context.session.scene().materials.get(index).cloned() else { return };
    let base = context.session.resolved().base.get(index).cloned().unwrap_or_default();
    for group in GROUPS {
        let rows: Vec<(&ParamSpec, ParamValue, ParamValue)> = (group.keys.iter())
            .filter_map(|key| {
                let spec = param::find(PARAMS, key).ok()?;
                Some((spec, shown(&entry, &material, key)?, params::get(&base, key)?))
            })
            .collect();
        let changed = rows.iter().filter(|(_, value, base)| value != base).count();
        let title = match changed {
            0 => group.title.to_string(),
            count => format!("{} ({count} changed)", group.title),
        };
        egui::CollapsingHeader::new(title).id_salt(group.title).default_open(group.open).show(ui, |ui| {
            for (spec, value, base) in rows {
                let counts = counts(spec.key, &entry, &material);
                let edit = ui.scope(|ui| {
                    if !counts {
                        ui.multiply_opacity(0.6);
                    }
                    param_ui(ui, spec, value, base)
                });
                take(context, index, (&entry, spec, base), edit.inner);
            }
        });
    }
}

/// The stored value where there is one: colour and strength, mode and cutoff hide one another in the material.
fn shown(entry: &MaterialEntry, material: &Material, key: &str) -> Option<ParamValue> {
    entry.value(key).or_else(|| params::get(material, key))
}

/// False for a factor that changes nothing as the others are.
fn counts(key: &str, entry: &MaterialEntry, material: &Material) -> bool {
    match key {
        "base-color" | "metallic" => entry.preset.is_none(),
        "roughness" | "anisotropy" => material.reflection_model == ReflectionModel::Ggx,
        "anisotropy-rotation" => material.reflection_model == ReflectionModel::Ggx && material.anisotropy > 0.0,
        "exponent" => material.reflection_model != ReflectionModel::Ggx,
        "micro-size" | "micro-depth" => material.micro_normal != micro_normal::Kind::None,
        "coat-roughness" | "coat-normal-scale" => material.coat > 0.0,
        "ior" | "specular" | "specular-color" => entry.preset.is_none() && material.metallic < 1.0,
        "alpha-cutoff" => matches!(material.alpha_mode, AlphaMode::Mask { .. }),
        "opacity" => material.alpha_mode != AlphaMode::Opaque,
        _ => true,
    }
}

/// Takes an edit over into the document.
fn take(
    context: &mut Context<'_>,
    index: usize,
    (entry, spec, base): (&MaterialEntry, &ParamSpec, ParamValue),
    edit: ParamEdit,
) {
    let session = &mut context.session;
    match edit.change {
        Some(Change::Set(value)) if value != base => session.edit(spec.label, &entry.name, |document| {
            // The widget gives only what the setting takes.
            let _ = document.set_value(index, spec.key, value);
        }),
        Some(Change::Set(_) | Change::Reset) => {
            session.edit(spec.label, &entry.name, |document| document.reset_value(index, spec.key));
        }
        None => {}
    }
    if edit.ended {
        session.seal();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_factor_is_in_one_group() {
        let mut shown: Vec<&str> = GROUPS.iter().flat_map(|group| group.keys).copied().collect();
        let mut declared: Vec<&str> = PARAMS.iter().map(|spec| spec.key).collect();
        shown.sort_unstable();
        declared.sort_unstable();
        assert_eq!(shown, declared);
    }
}
