//! Lighting presets: those of the program and the user's own, with a ball under each.

use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::document::LightingPreset;
use burnish_core::material::params::Values;
use burnish_core::param::ParamValue;
use burnish_core::scene::Bounds;
use eframe::egui::{self, Color32, Role, Sense, TextureId, WidgetInfo, pos2, vec2};

use crate::window::lights;
use crate::window::panel::Context;
use crate::window::request::{Purpose, Request};
use crate::window::thumbnails::Subject;
use crate::window::user_lightings::Own;
use crate::window::widget::name_input;

/// Points of a ball.
const BALL: f32 = 56.0;
/// Points of a place in the grid.
const TILE: egui::Vec2 = vec2(84.0, 78.0);
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
    /// With the user's own as they were listed last.
    items: Option<(Arc<Vec<Own>>, Vec<Item>)>,
    name: String,
}

impl PresetSection {
    /// Shows them.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let listing = context.lightings.listing().clone();
        if self.items.as_ref().is_none_or(|(known, _)| !Arc::ptr_eq(known, &listing)) {
            let library = LightingPreset::library().iter().map(|preset| item(preset.clone(), None));
            let own = listing.iter().map(|(path, preset)| item(preset.clone(), Some(path.clone())));
            let items = library.chain(own).collect();
            self.items = Some((listing, items));
        }
        let Some((_, items)) = &self.items else { return };
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(2.0, 2.0);
            for item in items {
                let ball = context.thumbnails.get(&item.subject).map(|ball| ball.id());
                let tile = tile_ui(ui, item, ball);
                if tile.clicked() {
                    lights::apply(context.session, &item.preset);
                }
                if let Some(path) = &item.path {
                    tile.context_menu(|ui| {
                        let hover = "Removes its file; documents keep the lights.";
                        if ui.button("Delete lighting preset").on_hover_text(hover).clicked() {
                            context.lightings.remove(path);
                            ui.close();
                        }
                    });
                }
            }
        });
        let words = "A click lights the subject by a preset: all lights are replaced, the environment gets its strength. A right click on one of your own deletes it.";
        ui.add(egui::Label::new(egui::RichText::new(words).small().weak()).wrap());
        self.own_ui(ui, context);
    }

    /// Keeps the lights as a preset, and brings presets in and out.
    fn own_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 70.0).max(40.0);
            let field = egui::TextEdit::singleline(&mut self.name).hint_text("name").desired_width(width);
            let field = ui.add(field).on_hover_text("Name of a preset of the lights as they are now.");
            name_input(&field, "Lighting preset name", &self.name);
            let ready = !self.name.trim().is_empty() && context.lightings.has_folder();
            let save = ui.add_enabled(ready, egui::Button::new("Keep")).on_hover_text("Keep these lights as a preset.");
            save.widget_info(|| WidgetInfo::labeled(Role::Button, ready, "Keep lighting preset"));
            if save.clicked() {
                context.lightings.keep(lights::preset(context.session, self.name.trim()));
            }
        });
        ui.horizontal(|ui| {
            let mut button = |text: &str, hover: &str, purpose: Purpose| {
                if ui.button(text).on_hover_text(hover).clicked() {
                    context.requests.push(Request::PickFile(purpose));
                }
            };
            let hover = "Light the subject by a preset from a file, and keep it with your own.";
            button("Import lighting preset...", hover, Purpose::ImportLighting);
            button("Export...", "Write these lights as a preset for others.", Purpose::ExportLighting);
        });
    }
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

/// A ball with its name.
fn tile_ui(ui: &mut egui::Ui, item: &Item, ball: Option<TextureId>) -> egui::Response {
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
    response.on_hover_text(format!("{}{own}", item.preset.note))
}

impl Subject {
    /// The box of the ball.
    pub const BOUNDS: Bounds = Bounds { min: glam::Vec3::splat(-0.0289), max: glam::Vec3::splat(0.0289) };
}
