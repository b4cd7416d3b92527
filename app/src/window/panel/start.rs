//! The start page.

use eframe::egui;

use super::Context;

/// The page.
#[derive(Default)]
pub struct StartPage {}

impl StartPage {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("Start");
    }
}
