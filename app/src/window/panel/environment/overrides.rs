//! Objects that another method lights than the rest of the scene.

use burnish_core::document::{OverrideEntry, mixed_methods};
use burnish_core::reference;
use eframe::egui::{self, RichText, Role, WidgetInfo};

use super::row_ui;
use crate::window::session::Session;
use crate::window::widget::{choice_ui, columns, name_ui};

/// Label of the step that gives objects another method.
const LABEL: &str = "Method of object";

/// A row for each such object, and a button that makes the selected ones such.
pub fn ui(ui: &mut egui::Ui, session: &mut Session) {
    let document = session.document().clone();
    let overrides = &document.lighting.overrides;
    egui::CollapsingHeader::new("Objects lit otherwise").default_open(!overrides.is_empty()).show(ui, |ui| {
        for (key, entry) in overrides {
            ui.push_id(key, |ui| override_ui(ui, session, key, entry));
        }
        let chosen = session.selection.objects.iter().filter(|key| !overrides.contains_key(*key));
        let chosen: Vec<String> = chosen.cloned().collect();
        let button = ui.add_enabled(!chosen.is_empty(), egui::Button::new("Light the selection otherwise").small());
        let hover = "The path tracer lights the selected objects; choose another method here. The whole picture is then \
                     drawn on the processor.";
        if button.on_hover_text(hover).on_disabled_hover_text("Select objects first.").clicked() {
            session.edit(LABEL, "", |document| {
                chosen.iter().for_each(|key| document.lighting.override_object(key, Some(reference::ID)));
            });
        }
    });
}

/// The method of an object, with what can be set for it alone.
fn override_ui(ui: &mut egui::Ui, session: &mut Session, key: &str, entry: &OverrideEntry) {
    let methods: Vec<_> = mixed_methods().collect();
    let titles: Vec<&str> = methods.iter().map(|method| method.info().title).collect();
    let chosen = methods.iter().position(|method| method.info().id.0 == entry.method);
    let place = session.resolved().object_keys.iter().position(|known| known == key);
    let name = place.map_or(key, |place| &session.scene().instances[place].name).to_string();
    ui.horizontal(|ui| {
        let [names, controls] = columns(ui);
        name_ui(ui, &name, true, names);
        let width = controls - 24.0;
        let hover = "The method that lights this object.";
        let picked =
            choice_ui(ui, &format!("Method of {name}"), &titles, chosen.unwrap_or(usize::MAX), width, None, hover);
        if let Some(method) = picked.and_then(|picked| methods.get(picked)) {
            session.edit(LABEL, key, |document| {
                document.lighting.override_object(key, Some(method.info().id.0));
            });
        }
        let leave = ui.small_button("x").on_hover_text("Light it as the scene.");
        leave.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Light {name} as the scene")));
        if leave.clicked() {
            session.edit(LABEL, key, |document| document.lighting.override_object(key, None));
        }
    });
    if place.is_none() || chosen.is_none() {
        let text = if place.is_none() { "no such object" } else { "a method that cannot light one object" };
        ui.label(RichText::new(text).small().color(ui.visuals().warn_fg_color));
        return;
    }
    let settings = entry.settings();
    for spec in entry.specs() {
        let Some(value) = settings.get(spec.key) else { continue };
        row_ui(ui, session, (spec, spec.label), value, |document, value| {
            if let Some(entry) = document.lighting.overrides.get_mut(key) {
                // The widget gives values in range only.
                let _ = entry.set(spec.key, value);
            }
        });
    }
}
