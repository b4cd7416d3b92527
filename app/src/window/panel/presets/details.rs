//! Where a preset comes from, what speaks against it, how it is rendered, and what can be done with it.

use burnish_core::color::gamut::{self, Clip};
use burnish_core::material::preset::Preset;
use burnish_core::material::saved::SavedMaterial;
use eframe::egui;
use glam::DVec3;

use super::forms::{FormSettings, forms_ui, line};
use super::item::{Content, Item, f0};
use crate::window::icon::{self, Icon, icon_button};
use crate::window::panel::Context;
use crate::window::widget::{name_input, screen_color};

/// Name, buttons, origin.
pub fn selected_ui(ui: &mut egui::Ui, item: &Item, name: &mut Option<String>, context: &mut Context<'_>) {
    ui.horizontal(|ui| {
        let favourites = &mut context.preferences.favourites;
        let is_favourite = favourites.contains(&item.key);
        let (sign, label) = match is_favourite {
            true => (Icon::Star, "Remove from favorites"),
            false => (Icon::StarOutline, "Add to favorites"),
        };
        let size = egui::Vec2::splat(ui.spacing().interact_size.y);
        let star = icon_button(ui, sign, size, label);
        if star.clicked() {
            match is_favourite {
                true => favourites.retain(|key| *key != item.key),
                false => favourites.push(item.key.clone()),
            }
        }
        if let Some(path) = &item.path {
            if ui.button("Rename").on_hover_text("Give your preset another name").clicked() {
                *name = Some(item.name().into());
            }
            let hover = "Remove the file from your presets; documents that use it keep it";
            if ui.button("Delete preset").on_hover_text(hover).clicked() {
                context.own.remove(path);
            }
        }
    });
    if let (Some(path), Some(text)) = (&item.path, name.as_mut()) {
        let field = ui.text_edit_singleline(text);
        name_input(&field, "Preset name", text);
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if entered && !text.trim().is_empty() {
            context.own.rename(path, text);
        }
        if field.lost_focus() {
            *name = None;
        } else if !field.has_focus() {
            field.request_focus();
        }
    }
    origin_ui(ui, item);
    if let Content::Metal(metal) = &item.content {
        f0_ui(ui, f0(metal));
        if let Some(fits) = metal.stored_fits() {
            forms_ui(ui, fits, FormSettings::new(&context.session.document().lighting.settings()));
        }
    }
}

/// Colour at normal incidence, and what of it a screen and a renderer cannot show.
pub fn f0_ui(ui: &mut egui::Ui, f0: DVec3) {
    let shown = f0.clamp(DVec3::ZERO, DVec3::ONE);
    ui.horizontal_wrapped(|ui| {
        let (place, _) = ui.allocate_exact_size(egui::vec2(22.0, 12.0), egui::Sense::hover());
        ui.painter().rect_filled(place, 2.0, screen_color(shown.as_vec3()));
        let hover = "Reflectance at normal incidence: linear Rec.709 under D65";
        ui.small(format!("F0 {:.3} {:.3} {:.3}", shown.x, shown.y, shown.z)).on_hover_text(hover);
    });
    if let Some(clip) = gamut::clip(f0) {
        let [r, g, b] = clip.unclamped.to_array();
        let hover = format!(
            "Its color is outside of Rec.709: {r:.3} {g:.3} {b:.3} before it is clamped. The difference is CIEDE2000."
        );
        line(ui, format!("Outside of Rec.709: {}, clipped by ΔE {:.2}", beyond(&clip), clip.delta_e))
            .on_hover_text(hover);
    }
}

/// `R 1.037`: the channels that are clipped.
fn beyond(clip: &Clip) -> String {
    let (before, after) = (clip.unclamped.to_array(), clip.clamped.to_array());
    let channels = ["R", "G", "B"].into_iter().zip(before.into_iter().zip(after));
    let clipped = channels.filter(|(_, (before, after))| before != after);
    clipped.map(|(name, (before, _))| format!("{name} {before:.3}")).collect::<Vec<_>>().join(", ")
}

/// What speaks against trusting something, with the sign of a warning.
pub fn warning_ui(ui: &mut egui::Ui, text: &str) {
    ui.horizontal_top(|ui| {
        let (place, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), egui::Sense::hover());
        icon::paint(ui.painter(), Icon::Warning, place.center(), 5.5, ui.visuals().warn_fg_color);
        line(ui, format!("Warning: {text}"));
    });
}

/// Where a preset comes from, and what speaks against it.
pub fn origin_ui(ui: &mut egui::Ui, item: &Item) {
    ui.spacing_mut().item_spacing.y = 2.0;
    match &item.content {
        Content::Metal(metal) => {
            ui.add(egui::Label::new(egui::RichText::new(title(metal)).strong()).wrap());
            if let Some(warning) = &metal.warning {
                warning_ui(ui, warning);
            }
            line(ui, origin(metal)).on_hover_text(citation(metal));
            line(ui, range(metal));
        }
        Content::Material(material) => {
            ui.strong(format!("{}, saved material", material.name));
            ui.small(factors(material));
        }
    }
}

/// `Gold (Au)`, so that it is told apart from the ball of that name.
pub fn title(metal: &Preset) -> String {
    format!("{} ({})", metal.name, metal.symbol.as_deref().unwrap_or(&metal.id))
}

/// What is shown of a note that stands in for a source.
const NOTE_CHARS: usize = 160;

fn origin(metal: &Preset) -> String {
    let known = metal.source.citation();
    if !known.is_empty() {
        return known;
    }
    // The comment of an imported table often names who measured it.
    match metal.note.as_deref().filter(|note| !note.trim().is_empty()) {
        Some(note) if note.chars().count() > NOTE_CHARS => {
            format!("{}...", note.chars().take(NOTE_CHARS).collect::<String>())
        }
        Some(note) => note.into(),
        None => "Source not stated".into(),
    }
}

/// All that is known of the source.
fn citation(metal: &Preset) -> String {
    let source = &metal.source;
    let table = source.table.as_ref().map(|table| format!("Table: {table}"));
    let licence = source.licence.as_ref().map(|licence| format!("Licence of the table: {licence}"));
    let parts = [source.title.clone(), table, licence, metal.note.clone()];
    let known: Vec<String> = parts.into_iter().flatten().collect();
    if known.is_empty() { "Nothing more is stated in the file".into() } else { known.join("\n") }
}

fn range(metal: &Preset) -> String {
    let ends = metal.wavelength_nm.first().zip(metal.wavelength_nm.last());
    let (from, to) = ends.map_or((0.0, 0.0), |(from, to)| (*from, *to));
    format!("n and k from {from} to {to} nm, {} entries", metal.wavelength_nm.len())
}

fn factors(material: &SavedMaterial) -> String {
    let metal = material.constants().map_or("no metal".into(), title);
    let tags = if material.tags.is_empty() { String::new() } else { format!("; tags: {}", material.tags.join(", ")) };
    format!("{metal}; {} factors{tags}", material.values.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::preset;

    #[test]
    fn the_origin_names_author_year_doi_and_range() {
        let gold = preset::find("Au").unwrap();
        let text = format!("{}\n{}", origin(&gold), range(&gold));
        for part in ["Johnson and R. W. Christy", "1972", "doi:10.1103/PhysRevB.6.4370", "380 to 780 nm"] {
            assert!(text.contains(part), "{text}");
        }
        assert!(citation(&gold).contains("Licence of the table: CC0-1.0"), "{}", citation(&gold));
        let noted = Preset { source: Default::default(), note: Some("From my bench. ".repeat(20)), ..gold.clone() };
        assert!(origin(&noted).starts_with("From my bench.") && origin(&noted).chars().count() == NOTE_CHARS + 3);
        let unknown = Preset { source: Default::default(), note: None, ..gold };
        assert_eq!(origin(&unknown), "Source not stated");
    }

    #[test]
    fn what_is_clipped_is_named_by_channel() {
        let clip = gamut::clip(f0(&preset::find("Au").unwrap())).unwrap();
        assert_eq!(beyond(&clip), "R 1.037");
    }
}
