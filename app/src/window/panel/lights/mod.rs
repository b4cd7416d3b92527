//! The lights of the document: a list with switches, what the selected one is like, presets.

mod light;
mod list;
mod presets;

use eframe::egui;

use super::Context;
use super::row::section;

/// The lights panel.
#[derive(Default)]
pub struct LightsPanel {
    presets: presets::PresetSection,
}

impl LightsPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        section(ui, "Lights", |ui| list::ui(ui, context.session));
        if let Some(name) = context.session.selection.lights.first().cloned() {
            section(ui, "Light", |ui| light::ui(ui, context.session, &name));
        }
        section(ui, "Lighting presets", |ui| self.presets.ui(ui, context));
    }
}
