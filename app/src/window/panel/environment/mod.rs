//! Light and view: environment, background, exposure, tone map, camera, navigation, settings of the lighting method.

mod background;
mod camera;
mod light;
mod lighting;
mod map;
mod overrides;
mod probes;
mod saved;
mod sky;
mod studio;
mod tone;

pub use tone::expose;

use eframe::egui;

use super::Context;
use super::row::{number, row_ui, section};

/// The environment panel.
#[derive(Default)]
pub struct EnvironmentPanel {
    light: light::LightSection,
    saved: saved::SavedSection,
    probes: probes::ProbesSection,
}

impl EnvironmentPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        section(ui, "Environment light", |ui| self.light.ui(ui, context));
        section(ui, "Background", |ui| background::ui(ui, context.session));
        section(ui, "Exposure and tone", |ui| tone::ui(ui, context.session));
        section(ui, "Camera", |ui| camera::ui(ui, context.session));
        section(ui, "Saved cameras", |ui| self.saved.ui(ui, context));
        section(ui, "Lighting method", |ui| lighting::ui(ui, context));
        if context.session.document().lighting.live_method().info().reads.probes {
            section(ui, "Probes", |ui| self.probes.ui(ui, context));
        }
        if context.reference.is_on() || context.compare.view().is_some() {
            section(ui, "Reference settings", |ui| lighting::reference_ui(ui, context.session));
        }
        section(ui, "Navigation", |ui| camera::navigation_ui(ui, context.preferences));
    }
}
