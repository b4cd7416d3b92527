//! The picture, and how the mouse moves it.

use eframe::egui;

use super::Context;
use crate::window::commands::Command;
use crate::window::session::Session;

/// The viewport.
#[derive(Default)]
pub struct ViewportPanel {}

impl ViewportPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let _ = &context.session;
        ui.label("Viewport");
    }

    /// Moves the camera.
    pub fn command(&mut self, command: Command, session: &mut Session) {
        let _ = (command, session);
    }
}
