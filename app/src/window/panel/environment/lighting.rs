//! Settings of the lighting method.

use burnish_core::document::SHARED_SETTINGS;
use burnish_core::lighting::classical;
use burnish_core::param::Settings;
use burnish_core::reference;
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

/// A row for every setting of the path tracer that is its own.
pub fn reference_ui(ui: &mut egui::Ui, session: &mut Session) {
    let hover =
        "Path tracing with next-event estimation. Masking and multiple scattering are those of the method above.";
    ui.label(reference::ID).on_hover_text(hover);
    let settings: Settings = session.document().lighting.reference_settings();
    // The method has settings of the same names.
    ui.push_id(reference::ID, |ui| {
        for (spec, value) in settings.iter().filter(|(spec, _)| !SHARED_SETTINGS.contains(&spec.key)) {
            row_ui(
                ui,
                session,
                (spec, &format!("Reference {}", spec.label.to_lowercase())),
                value,
                |document, value| {
                    // The widget gives values in range only.
                    let _ = document.set_reference(spec.key, value);
                },
            );
        }
    });
}
