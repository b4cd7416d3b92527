//! Where a preset comes from, and what can be done with it.

use burnish_core::material::preset::Preset;
use burnish_core::material::saved::SavedMaterial;
use eframe::egui;

use super::item::{Content, Item};
use crate::window::icon::{Icon, icon_button};
use crate::window::panel::Context;
use crate::window::widget::name_input;

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
}

/// Where a preset comes from, and what speaks against it.
pub fn origin_ui(ui: &mut egui::Ui, item: &Item) {
    ui.spacing_mut().item_spacing.y = 2.0;
    match &item.content {
        Content::Metal(metal) => {
            ui.strong(title(metal));
            ui.small(origin(metal));
            ui.small(range(metal));
            if let Some(warning) = &metal.warning {
                ui.colored_label(ui.visuals().warn_fg_color, egui::RichText::new(warning).small());
            }
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

fn origin(metal: &Preset) -> String {
    let source = &metal.source;
    let year = source.year.map(|year| year.to_string());
    let doi = source.doi.as_ref().map(|doi| format!("doi:{doi}"));
    let parts = [source.author.clone(), year, source.journal.clone(), doi];
    let known: Vec<String> = parts.into_iter().flatten().collect();
    if known.is_empty() { "Source not stated".into() } else { known.join(", ") }
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
        let unknown = Preset { source: Default::default(), ..gold };
        assert_eq!(origin(&unknown), "Source not stated");
    }
}
