//! The status line.

use eframe::egui;

use super::Context;

/// The line.
#[derive(Default)]
pub struct StatusLine {}

impl StatusLine {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("Status");
    }
}
