//! The steps that undo takes back and redo does again.

use eframe::egui;

use super::Context;

/// The history list.
#[derive(Default)]
pub struct HistoryPanel {}

impl HistoryPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("History");
    }
}
