//! Settings of the lighting method.

use burnish_core::lighting::classical;
use burnish_core::param::Settings;
use eframe::egui;

use super::row_ui;
use crate::window::session::Session;

/// A row for every setting that the method declares.
pub fn ui(ui: &mut egui::Ui, session: &mut Session) {
    ui.label(classical::ID).on_hover_text("Environment maps prefiltered or sampled per pixel, shadow-mapped lamps.");
    let settings: Settings = session.document().lighting.settings();
    let rows: Vec<_> = settings.iter().collect();
    for (spec, value) in rows {
        row_ui(ui, session, (spec, spec.label), value, |document, value| {
            // The widget gives values in range only.
            let _ = document.set_lighting(spec.key, value);
        });
    }
    debug_assert!(settings.iter().count() == classical::PARAMS.len());
}
