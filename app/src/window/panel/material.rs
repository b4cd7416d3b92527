//! The material inspector.

use eframe::egui;

use super::Context;

/// The inspector.
#[derive(Default)]
pub struct MaterialPanel {}

impl MaterialPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("Material");
    }
}
