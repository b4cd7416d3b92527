//! Light and view: HDRI, rotation, strength, exposure, tone map, camera.

use eframe::egui;

use super::Context;

/// The environment panel.
#[derive(Default)]
pub struct EnvironmentPanel {}

impl EnvironmentPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("Environment");
    }
}
