//! The preset browser.

use eframe::egui;

use super::Context;

/// The browser.
#[derive(Default)]
pub struct PresetsPanel {}

impl PresetsPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("Presets");
    }
}
