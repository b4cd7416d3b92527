//! Light and view: HDRI, exposure, tone map, camera, navigation, settings of the lighting method.

mod camera;
mod light;
mod lighting;
mod overrides;
mod saved;

use burnish_core::document::Document;
use burnish_core::param::{ParamSpec, ParamValue};
use eframe::egui;

use super::Context;
use crate::window::session::Session;
use crate::window::widget::{Change, param_ui};

/// The environment panel.
#[derive(Default)]
pub struct EnvironmentPanel {
    light: light::LightSection,
    saved: saved::SavedSection,
}

impl EnvironmentPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        section(ui, "Environment light", |ui| self.light.ui(ui, context));
        section(ui, "Exposure and tone", |ui| light::tone_ui(ui, context.session));
        section(ui, "Camera", |ui| camera::ui(ui, context.session));
        section(ui, "Saved cameras", |ui| self.saved.ui(ui, context));
        section(ui, "Lighting method", |ui| lighting::ui(ui, context));
        if context.reference.is_on() || context.compare.view().is_some() {
            section(ui, "Reference settings", |ui| lighting::reference_ui(ui, context.session));
        }
        section(ui, "Navigation", |ui| camera::navigation_ui(ui, context.preferences));
    }
}

fn section(ui: &mut egui::Ui, title: &str, contents: impl FnOnce(&mut egui::Ui)) {
    egui::CollapsingHeader::new(title).default_open(true).show_unindented(ui, contents);
    ui.add_space(4.0);
}

/// A row for a value of the document: `set` writes a new one as the step `label`.
fn row_ui(
    ui: &mut egui::Ui,
    session: &mut Session,
    (spec, label): (&ParamSpec, &str),
    value: ParamValue,
    set: impl FnOnce(&mut Document, ParamValue),
) {
    let edit = param_ui(ui, spec, value, spec.default());
    match edit.change {
        Some(Change::Set(value)) => session.edit(label, "", |document| set(document, value)),
        Some(Change::Reset) => session.edit(label, "", |document| set(document, spec.default())),
        None => {}
    }
    // A run of camera moves is one step, whatever moves it.
    if edit.ended && label != burnish_core::document::VIEW_LABEL {
        session.seal();
    }
}

/// The number of a value that is one.
fn number(value: ParamValue) -> f64 {
    match value {
        ParamValue::Number(number) => number,
        ParamValue::Integer(number) => number as f64,
        _ => 0.0,
    }
}
