//! Reflectance against angle.

use eframe::egui;

use super::Context;

/// The plot.
#[derive(Default)]
pub struct ReflectancePanel {}

impl ReflectancePanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("Reflectance");
    }
}
