//! The metal of a material: which, in which form, and what it bypasses.

use std::sync::LazyLock;

use burnish_core::material::preset::{Cheapest, FormChoice, Preset};
use burnish_core::material::{Material, TextureRole};
use burnish_core::surface::fresnel::Form;
use eframe::egui;

use super::Context;
use crate::window::panel::presets::{ERRORS, errors, line, title};
use crate::window::widget::{choice_ui, name_ui, reset_ui};

/// What the Fresnel forms are.
static FORMS_HELP: LazyLock<String> = LazyLock::new(|| {
    let line = |form: Form| format!("\n{form}: {}", form.help());
    let lines: String = Form::ALL.into_iter().map(line).collect();
    format!(
        "How the reflectance of the metal changes with the angle.\ncheapest: the first of these within the tolerances \
         of the lighting settings{lines}"
    )
});

/// Shows the metal.
pub fn metal_ui(ui: &mut egui::Ui, context: &mut Context<'_>, index: usize) {
    let document = context.session.document().clone();
    let Some(entry) = document.materials.get(index) else { return };
    let Some(used) = &entry.preset else {
        ui.weak("No metal: the base color counts. Click a preset, or drop one here.");
        return;
    };
    let metal = document.metal(&used.id);
    // Names of alloys are longer than the panel is wide: they break, they do not push it open.
    ui.horizontal_wrapped(|ui| {
        match metal {
            Some(metal) => ui.strong(format!("Metal: {}", title(metal))),
            None => ui.colored_label(ui.visuals().error_fg_color, format!("Unknown metal `{}`", used.id)),
        };
        let hover = "Take the metal off: the base color counts again";
        if ui.small_button("Remove metal").on_hover_text(hover).clicked() {
            context.session.seal();
            context.session.edit("Remove metal", &entry.name, |document| document.clear_preset(index));
            context.session.seal();
        }
    });
    form_ui(ui, context, index, &entry.name, used.fresnel.as_deref());
    if let Some(metal) = metal {
        errors_ui(ui, metal, document.form_choice(used.fresnel.as_deref()));
    }
    let texts = context.session.scene().materials.get(index).map(overrides).unwrap_or_default();
    for text in texts {
        line(ui, format!("• {text}"));
    }
}

/// The Fresnel form, with that of the scene as the one that nobody chose.
fn form_ui(ui: &mut egui::Ui, context: &mut Context<'_>, index: usize, material: &str, form: Option<&str>) {
    let of_scene = context.session.document().lighting.settings().text("fresnel").unwrap_or_default();
    let mut words = vec![format!("scene: {of_scene}")];
    words.extend(FormChoice::IDS.map(String::from));
    let place =
        form.map_or(0, |form| FormChoice::IDS.iter().position(|known| *known == form).map_or(0, |place| place + 1));
    let mut picked = None;
    ui.horizontal(|ui| {
        let gap = ui.spacing().item_spacing.x;
        let name =
            name_ui(ui, "Fresnel form", place != 0, 0.36 * ui.available_width()).on_hover_text(FORMS_HELP.as_str());
        let width = ui.available_width() - 18.0 - 2.0 * gap;
        picked = choice_ui(ui, "Fresnel form", &words, place, width, Some(&name), &FORMS_HELP);
        if reset_ui(ui, "Fresnel form", place != 0) {
            picked = Some(0);
        }
    });
    if let Some(picked) = picked {
        let form = picked.checked_sub(1).and_then(|place| FormChoice::IDS.get(place)).copied();
        context.session.edit("Fresnel form", material, |document| document.set_fresnel(index, form));
        context.session.seal();
    }
}

/// How far the form is from the truth, and why it was chosen. Nothing for metals that were not fitted yet.
fn errors_ui(ui: &mut egui::Ui, metal: &Preset, choice: FormChoice) {
    let Some(fits) = metal.stored_fits() else { return };
    let Cheapest { form, reason } = match choice {
        FormChoice::Cheapest(tolerance) => fits.cheapest(tolerance),
        FormChoice::Of(form) => Cheapest { form, reason: form.help().into() },
    };
    let Some(fit) = fits.forms.get(&form) else { return };
    let mut hover = format!("{reason}.\n{ERRORS}");
    hover.extend(fit.note.iter().map(|note| format!("\n{note}")));
    line(ui, format!("{form}: {}", errors(fit))).on_hover_text(hover);
}

/// What of the material does not count under a metal.
fn overrides(material: &Material) -> Vec<&'static str> {
    let has = |role: TextureRole| material.textures().get(role as usize).is_some_and(Option::is_some);
    let mut texts = Vec::new();
    if has(TextureRole::BaseColor) {
        texts.push("The textured base color is bypassed by the metal; its alpha counts");
    } else {
        texts.push("The base color is bypassed by the metal");
    }
    if has(TextureRole::MetallicRoughness) {
        texts.push("The metallic channel is bypassed by the metal; the roughness channel counts");
    }
    texts
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::{Sampler, TextureRef};

    #[test]
    fn a_bypassed_texture_is_told() {
        let plain = Material::default();
        assert_eq!(overrides(&plain), ["The base color is bypassed by the metal"]);
        let texture = TextureRef { image: 0, sampler: Sampler::default(), uv_set: 0, transform: glam::Mat3::IDENTITY };
        let textured = Material {
            base_color_texture: Some(texture),
            metallic_roughness_texture: Some(texture),
            ..Material::default()
        };
        let texts = overrides(&textured).join("\n");
        assert!(texts.contains("textured base color is bypassed") && texts.contains("metallic channel"), "{texts}");
    }
}
