//! The start page: the default workbench, recent documents, a path.

use std::collections::BTreeMap;
use std::path::Path;

use burnish_core::document::DEFAULT_SCENE;
use eframe::egui::{self, Align, Button, Key, Layout, RichText, ScrollArea, TextEdit, Vec2};

use super::Context;
use crate::window::request::{Purpose, Request};

/// Width of the column.
const WIDTH: f32 = 560.0;
/// Height of a button.
const HEIGHT: f32 = 34.0;

/// The page.
#[derive(Default)]
pub struct StartPage {
    path: String,
    fault: Option<String>,
    /// Whether the recent documents are there, asked once.
    present: BTreeMap<String, bool>,
}

impl StartPage {
    /// Shows the page; true when it shall be closed. `is_covered` is true under a dialog.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, is_covered: bool) -> bool {
        let mut close = !is_covered && ui.input(|input| input.key_pressed(Key::Escape));
        ui.painter().rect_filled(ui.max_rect(), 0.0, ui.visuals().panel_fill);
        let height = ui.available_height();
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let width = WIDTH.min(ui.available_width() - 40.0);
            let side = 0.5 * (ui.available_width() - width);
            ui.add_space((0.14 * height).max(16.0));
            ui.horizontal_top(|ui| {
                ui.add_space(side);
                ui.vertical(|ui| {
                    ui.set_width(width);
                    ui.spacing_mut().item_spacing.y = 8.0;
                    ui.label(RichText::new("Burnish").size(30.0).strong());
                    ui.label(RichText::new("A workbench for the look of metals").weak());
                    ui.add_space(14.0);
                    close |= self.first_ui(ui, context);
                    self.path_ui(ui, context);
                    ui.add_space(14.0);
                    self.recent_ui(ui, context);
                });
            });
        });
        close
    }

    /// The default workbench and the dialog.
    fn first_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) -> bool {
        let mut close = false;
        ui.horizontal(|ui| {
            let size = Vec2::new(0.5 * (ui.available_width() - ui.spacing().item_spacing.x), HEIGHT);
            let untouched = context.session.document().scene == DEFAULT_SCENE && context.session.path.is_none();
            let workbench = ui.add_sized(size, Button::new("Default workbench"));
            if workbench.on_hover_text("A ball and a bench, in a room with three lamps").clicked() {
                // It is open behind the page unless something else was opened since.
                if untouched {
                    close = true;
                } else {
                    context.requests.push(Request::OpenScene(DEFAULT_SCENE.into()));
                }
            }
            let open = ui.add_sized(size, Button::new("Open..."));
            if open.on_hover_text("A model (glTF, OBJ) or a document").clicked() {
                context.requests.push(Request::PickFile(Purpose::Scene));
            }
        });
        close
    }

    fn path_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        ui.horizontal(|ui| {
            let label = ui.label("Path");
            let width = ui.available_width() - 70.0;
            let field =
                TextEdit::singleline(&mut self.path).hint_text(".gltf  .glb  .obj  .burnish").desired_width(width);
            let field = ui.add(field).labelled_by(label.id);
            if field.changed() {
                self.fault = None;
            }
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let clicked = ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add_enabled(!self.path.trim().is_empty(), Button::new("Open")).clicked()
            });
            if entered || clicked.inner {
                self.open_path(context);
            }
        });
        if let Some(fault) = &self.fault {
            ui.colored_label(ui.visuals().error_fg_color, fault);
        }
    }

    fn open_path(&mut self, context: &mut Context<'_>) {
        let path = crate::window::files::typed_path(&self.path);
        if path.is_file() || self.path.trim().starts_with("gallery:") {
            context.requests.push(Request::OpenScene(path.to_string_lossy().into_owned()));
        } else if !self.path.trim().is_empty() {
            self.fault = Some(format!("There is no file {}; check the name and the folder", path.display()));
        }
    }

    fn recent_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        ui.label(RichText::new("Recent").strong());
        if context.preferences.recent.is_empty() {
            ui.weak("Documents and models that you open are listed here. Files can also be dropped onto the window.");
            return;
        }
        let mut gone = None;
        for path in context.preferences.recent.clone() {
            let in_gallery = path.starts_with("gallery:");
            let is_there =
                *self.present.entry(path.clone()).or_insert_with(|| in_gallery || Path::new(&path).is_file());
            let file = Path::new(&path).file_name().filter(|_| !in_gallery);
            let name = file.map_or_else(|| path.clone(), |name| name.to_string_lossy().into_owned());
            let folder = Path::new(&path).parent().filter(|_| !in_gallery);
            let folder = folder.map_or_else(|| "built-in scene".into(), |folder| folder.display().to_string());
            let folder = if is_there { folder } else { format!("missing from {folder}") };
            let button = Button::new(name).right_text(RichText::new(folder).weak()).truncate();
            let size = Vec2::new(ui.available_width(), 26.0);
            let row = ui.add_enabled_ui(is_there, |ui| ui.add(button.min_size(size))).inner;
            if row.on_hover_text(&path).on_disabled_hover_text(format!("{path} is not there")).clicked() {
                context.requests.push(Request::OpenScene(path.clone()));
            }
            if !is_there {
                gone.get_or_insert(path);
            }
        }
        if gone.is_some() && ui.small_button("Forget missing files").clicked() {
            context.preferences.recent.retain(|path| self.present.get(path) != Some(&false));
        }
    }
}
