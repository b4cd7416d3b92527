//! The objects of the model.

use eframe::egui;

use super::Context;

/// The tree.
#[derive(Default)]
pub struct SceneTree {}

impl SceneTree {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("Scene");
    }
}
