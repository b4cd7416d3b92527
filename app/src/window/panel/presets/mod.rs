//! The preset browser: balls to look at, to search, to put on materials.

mod details;
mod forms;
mod item;
mod tile;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use burnish_core::document::Assigned;
use burnish_core::material::preset::Preset;
use eframe::egui;

pub use details::{f0_ui, title, warning_ui};
pub use forms::{ERRORS, FormSettings, errors, forms_ui, line};
use item::{Item, common_tags, list};
pub use item::{assign, f0};

use super::{Context, DraggedPreset};
use crate::window::files::typed_path;
use crate::window::request::{Purpose, Request};
use crate::window::widget::{choice_ui, name_input};

/// What is listed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
enum Filter {
    #[default]
    All,
    Favourites,
    Own,
    Tag(String),
}

/// Most of the panel's height that what is told about a preset takes; more is scrolled.
const DETAILS_SHARE: f32 = 0.5;

/// The browser.
#[derive(Default)]
pub struct PresetsPanel {
    search: String,
    filter: Filter,
    /// Key of the preset whose origin is told.
    selected: Option<String>,
    /// It shall be brought into sight.
    reveals: bool,
    /// The new name that is being typed.
    name: Option<String>,
    /// Points from top to bottom.
    height: f32,
    import: Option<String>,
    items: Vec<Item>,
    /// Of the items, the most frequent first.
    tags: Vec<String>,
    /// What `items` were made of.
    made_of: Option<(u64, Vec<Arc<Preset>>)>,
}

impl PresetsPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        self.refresh(context);
        self.height = ui.available_height();
        self.search_ui(ui);
        egui::Panel::bottom("preset details").resizable(false).show_separator_line(true).show(ui, |ui| {
            self.foot_ui(ui, context);
        });
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.grid_ui(ui, context));
    }

    /// Tells about the preset of a key, and brings it into sight.
    pub fn reveal(&mut self, key: &str) {
        self.select(key);
        self.reveals = true;
    }

    fn select(&mut self, key: &str) {
        self.selected = Some(key.into());
        self.name = None;
    }

    fn refresh(&mut self, context: &Context<'_>) {
        let document = context.session.document();
        let now = (context.own.revision, &document.presets);
        let same = |known: &(u64, Vec<Arc<Preset>>)| {
            let alike = |(a, b): (&Arc<Preset>, &Arc<Preset>)| Arc::ptr_eq(a, b);
            known.0 == now.0 && known.1.len() == now.1.len() && known.1.iter().zip(now.1).all(alike)
        };
        if !self.made_of.as_ref().is_some_and(same) {
            self.items = list(context.own, document);
            self.tags = common_tags(&self.items);
            self.made_of = Some((now.0, now.1.clone()));
        }
    }

    fn search_ui(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 96.0).max(60.0);
            let field = egui::TextEdit::singleline(&mut self.search).hint_text("Search").desired_width(width);
            let field = ui.add(field).on_hover_text("Name, symbol or tag, such as gold, Au or noble");
            name_input(&field, "Search presets", &self.search);
            self.filter_ui(ui);
        });
    }

    fn filter_ui(&mut self, ui: &mut egui::Ui) {
        let tags = self.tags.iter().map(|tag| (tag.clone(), Filter::Tag(tag.clone())));
        let fixed = [("All", Filter::All), ("Favorites", Filter::Favourites), ("Own", Filter::Own)];
        let filters: Vec<(String, Filter)> =
            fixed.into_iter().map(|(name, filter)| (name.to_string(), filter)).chain(tags).collect();
        let names: Vec<&str> = filters.iter().map(|(name, _)| name.as_str()).collect();
        // A tag may have gone with the last preset that had it.
        let place = filters.iter().position(|(_, filter)| *filter == self.filter).unwrap_or(0);
        let hover = "Which presets are listed: all, your favorites, your own, or those with a tag";
        let picked = choice_ui(ui, "Show presets", &names, place, 80.0, None, hover).unwrap_or(place);
        self.filter = filters.get(picked).map(|(_, filter)| filter.clone()).unwrap_or_default();
    }

    fn grid_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let in_use = context.session.material().and_then(|entry| Some(entry.preset.as_ref()?.id.clone()));
        let favourites = context.preferences.favourites.clone();
        let shown = self.items.iter().filter(|item| {
            let kept = match &self.filter {
                Filter::All => true,
                Filter::Favourites => favourites.contains(&item.key),
                Filter::Own => item.is_own(),
                Filter::Tag(tag) => item.tags().contains(tag),
            };
            kept && item.matches(&self.search)
        });
        let mut empty = true;
        let mut picked = None;
        ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
        ui.horizontal_wrapped(|ui| {
            for item in shown {
                empty = false;
                let look = tile::Look {
                    in_use: in_use.as_ref() == Some(&item.key),
                    selected: self.selected.as_ref() == Some(&item.key),
                    favourite: favourites.contains(&item.key),
                };
                let ball = || context.thumbnails.get(&item.subject).map(|ball| ball.id());
                let response = tile::tile_ui(ui, item, ball, look);
                if look.selected && self.reveals {
                    response.scroll_to_me(Some(egui::Align::Center));
                }
                response.dnd_set_drag_payload(DraggedPreset(item.key.clone()));
                if response.double_clicked() {
                    picked = Some((item.key.clone(), context.session.selected_materials()));
                } else if response.clicked() {
                    picked = Some((item.key.clone(), vec![context.session.selection.material]));
                }
                response.on_hover_ui(|ui| details::origin_ui(ui, item));
            }
        });
        self.reveals = false;
        if empty {
            ui.weak(match &self.filter {
                Filter::Own => "No presets of your own yet. Save a material as preset, or import a metal.",
                Filter::Favourites if self.search.is_empty() => "No favorites yet. Select a preset and press its star.",
                _ => "Nothing is found. Try a name, a symbol or a tag.",
            });
        }
        if let Some((preset, materials)) = picked {
            self.select(&preset);
            context.requests.push(Request::AssignPreset { preset, materials });
        }
    }

    /// What is selected, and what assigning does.
    fn foot_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        ui.add_space(2.0);
        let selected = self.selected.clone();
        if let Some(item) = self.items.iter().find(|item| Some(&item.key) == selected.as_ref()).cloned() {
            let height = (DETAILS_SHARE * self.height).max(80.0);
            egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
                details::selected_ui(ui, &item, &mut self.name, context);
            });
            ui.separator();
        }
        let mut replaces = context.own.textures == Assigned::ReplaceTextures;
        let hover = "Off: a preset replaces the reflectance; textures of normals, occlusion, roughness and anisotropy \
                     stay. On: it clears all textures of the material.";
        if ui.checkbox(&mut replaces, "Replace textures").on_hover_text(hover).changed() {
            context.own.textures = if replaces { Assigned::ReplaceTextures } else { Assigned::KeepTextures };
        }
        self.import_ui(ui, context);
    }

    /// Dialog and path field for a preset file.
    fn import_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let mut path = self.import.clone().unwrap_or_default();
        ui.horizontal(|ui| {
            let hover = "Add to your presets: a metal or saved material (.json), or a table of n and k (.csv, .txt, .yml, \
                         .spd). A table can also be dropped or pasted.";
            let button = ui.button("Import...").on_hover_text(hover);
            if button.clicked() {
                context.requests.push(Request::PickFile(Purpose::Preset));
            }
            let width = ui.available_width();
            let field = egui::TextEdit::singleline(&mut path).hint_text("or its path, then Enter").desired_width(width);
            let field = ui.add(field);
            name_input(&field, "Path of a preset", &path);
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if entered && !path.trim().is_empty() {
                context.requests.push(Request::ImportPreset(typed_path(&path)));
                path.clear();
            }
        });
        self.import = Some(path);
    }
}
