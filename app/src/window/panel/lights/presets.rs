//! Lighting presets: those of the program and the user's own, with a ball under each.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::document::LightingPreset;
use burnish_core::file::write_atomic;
use burnish_core::material::params::Values;
use burnish_core::param::ParamValue;
use burnish_core::scene::Bounds;
use eframe::egui::{self, Color32, Role, Sense, TextureId, WidgetInfo, pos2, vec2};

use crate::window::files::typed_path;
use crate::window::lights;
use crate::window::panel::Context;
use crate::window::request::{Request, Requests};
use crate::window::session::Session;
use crate::window::thumbnails::Subject;
use crate::window::widget::name_input;

/// Points of a ball.
const BALL: f32 = 56.0;
/// Points of a place in the grid.
const TILE: egui::Vec2 = vec2(84.0, 78.0);
/// Most of the user's own that are listed.
const MOST: usize = 200;
/// Roughness of the balls: lamps are seen as shapes, with soft edges.
const ROUGHNESS: f64 = 0.18;

/// A preset with its ball.
struct Item {
    preset: LightingPreset,
    subject: Arc<Subject>,
    /// Its file, for the user's own.
    path: Option<PathBuf>,
}

/// The presets.
#[derive(Default)]
pub struct PresetSection {
    /// Read when they are first shown, and after every change.
    items: Option<Vec<Item>>,
    name: String,
    path: String,
}

impl PresetSection {
    /// Shows them.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let folder = context.own.folder().map(|folder| folder.join("lighting"));
        let items = self.items.get_or_insert_with(|| list(folder.as_deref(), context.requests));
        let mut chosen = None;
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(2.0, 2.0);
            for (place, item) in items.iter().enumerate() {
                let ball = context.thumbnails.get(&item.subject).map(|ball| ball.id());
                if tile_ui(ui, item, ball) {
                    chosen = Some(place);
                }
            }
        });
        if let Some(item) = chosen.and_then(|place| items.get(place)) {
            apply(context.session, &item.preset);
        }
        ui.label(
            egui::RichText::new("A click lights the subject by a preset: all lights are replaced.").small().weak(),
        );
        self.own_ui(ui, context, folder.as_deref());
    }

    /// Keeps the lights as a preset, and brings presets in and out.
    fn own_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, folder: Option<&Path>) {
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 70.0).max(40.0);
            let field = egui::TextEdit::singleline(&mut self.name).hint_text("name").desired_width(width);
            let field = ui.add(field).on_hover_text("Name of a preset of the lights as they are now.");
            name_input(&field, "Lighting preset name", &self.name);
            let ready = !self.name.trim().is_empty() && folder.is_some();
            let save = ui.add_enabled(ready, egui::Button::new("Keep")).on_hover_text("Keep these lights as a preset.");
            save.widget_info(|| WidgetInfo::labeled(Role::Button, ready, "Keep lighting preset"));
            if let (true, Some(folder)) = (save.clicked(), folder) {
                let preset = of_session(context.session, self.name.trim());
                self.write(&preset, &folder.join(format!("{}.json", preset.id)), context.requests);
            }
        });
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 130.0).max(40.0);
            let field =
                egui::TextEdit::singleline(&mut self.path).hint_text("path of a .json file").desired_width(width);
            let field = ui.add(field).on_hover_text("File of a lighting preset, to be brought in or written.");
            name_input(&field, "Lighting preset file", &self.path);
            let named = !self.path.trim().is_empty();
            let mut button = |text: &str, name: &str, hover: &str| {
                let button = ui.add_enabled(named, egui::Button::new(text)).on_hover_text(hover);
                button.widget_info(|| WidgetInfo::labeled(Role::Button, named, name));
                button.clicked()
            };
            if button("Import", "Import lighting preset", "Light the subject by it, and keep it with your own.") {
                self.import(context, folder);
            }
            if button("Export", "Export lighting preset", "Write these lights as a preset.") {
                let path = typed_path(&self.path);
                let stem = path.file_stem().map_or("lights".into(), |stem| stem.to_string_lossy().into_owned());
                self.write(&of_session(context.session, &stem), &path, context.requests);
            }
        });
    }

    fn import(&mut self, context: &mut Context<'_>, folder: Option<&Path>) {
        let path = typed_path(&self.path);
        match LightingPreset::read(&path).map_err(|e| e.to_string()) {
            Ok(preset) => {
                apply(context.session, &preset);
                if let Some(folder) = folder {
                    self.write(&preset, &folder.join(format!("{}.json", preset.id)), context.requests);
                }
            }
            Err(fault) => context.requests.push(Request::Error(fault)),
        }
    }

    fn write(&mut self, preset: &LightingPreset, path: &Path, requests: &mut Requests) {
        let folder = path.parent().map(std::fs::create_dir_all);
        let written = match folder {
            Some(Err(error)) => Err(format!("{}: {error}; take a folder where you may write", path.display())),
            _ => write_atomic(path, preset.to_text().as_bytes()).map_err(|error| error.to_string()),
        };
        requests.push(match written {
            Ok(()) => Request::Notice(format!("Kept lighting preset `{}` in {}", preset.name, path.display())),
            Err(fault) => Request::Error(fault),
        });
        self.items = None;
    }
}

/// The lights of the session as a preset of a name.
fn of_session(session: &Session, name: &str) -> LightingPreset {
    let (model, subject) = (lights::model(session), session.subject_bounds());
    LightingPreset::of_document(name, session.document(), &model, subject)
}

/// Lights the subject by a preset, as one step.
fn apply(session: &mut Session, preset: &LightingPreset) {
    let subject = session.subject_bounds();
    session.seal();
    session.edit("Lighting preset", &preset.name, |document| document.apply_lighting(preset, subject));
    session.seal();
    session.selection.lights.clear();
}

/// All presets; files with a fault are told.
fn list(folder: Option<&Path>, requests: &mut Requests) -> Vec<Item> {
    let mut items: Vec<Item> = LightingPreset::library().iter().map(|preset| item(preset.clone(), None)).collect();
    let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
    let mut paths: Vec<PathBuf> = entries.into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "json"));
    paths.sort();
    for path in paths.into_iter().take(MOST) {
        match LightingPreset::read(&path).map_err(|e| e.to_string()) {
            Ok(preset) => items.push(item(preset, Some(path))),
            Err(fault) => requests.push(Request::Error(fault)),
        }
    }
    items
}

fn item(preset: LightingPreset, path: Option<PathBuf>) -> Item {
    let values = Values::from([
        ("metallic", ParamValue::Number(1.0)),
        ("base-color", ParamValue::Color([0.9; 3])),
        ("roughness", ParamValue::Number(ROUGHNESS)),
    ]);
    let shining = burnish_core::document::shining(&preset.lights_around(Subject::BOUNDS), &[]);
    let strength = preset.environment.as_ref().map_or(1.0, |environment| environment.strength);
    let subject = Arc::new(Subject::new(values, None).under(shining, strength as f32));
    Item { preset, subject, path }
}

/// A ball with its name; true when it was clicked.
fn tile_ui(ui: &mut egui::Ui, item: &Item, ball: Option<TextureId>) -> bool {
    let (rect, response) = ui.allocate_exact_size(TILE, Sense::click());
    let name = &item.preset.name;
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Light by {name}")));
    if response.hovered() {
        ui.painter().rect_filled(rect, 4.0, ui.visuals().widgets.hovered.weak_bg_fill);
    }
    let middle = pos2(rect.center().x, rect.top() + 0.5 * BALL + 3.0);
    let place = egui::Rect::from_center_size(middle, vec2(BALL, BALL));
    match ball {
        Some(texture) => {
            let uv = egui::Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture, place, uv, Color32::WHITE);
        }
        None => _ = ui.painter().circle_filled(middle, 0.46 * BALL, ui.visuals().faint_bg_color),
    }
    let line = pos2(rect.center().x, place.bottom() + 9.0);
    let font = egui::FontId::proportional(11.0);
    ui.painter_at(rect).text(line, egui::Align2::CENTER_CENTER, name, font, ui.visuals().text_color());
    let own = item.path.as_ref().map(|path| format!("\n{}", path.display())).unwrap_or_default();
    response.on_hover_text(format!("{}{own}", item.preset.note)).clicked()
}

impl Subject {
    /// The box of the ball.
    pub const BOUNDS: Bounds = Bounds { min: glam::Vec3::splat(-0.0289), max: glam::Vec3::splat(0.0289) };
}
