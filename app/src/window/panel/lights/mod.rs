//! The lights of the document: a list with switches, what the selected one is like, presets.

mod light;
mod list;
mod presets;

use eframe::egui;

use super::Context;
use super::row::section;
use crate::window::aids::Source;
use crate::window::preparations::shows_sources;
use crate::window::widget::{choice_ui, columns, name_ui};

/// The lights panel.
#[derive(Default)]
pub struct LightsPanel {
    presets: presets::PresetSection,
}

impl LightsPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        section(ui, "Lights", |ui| list::ui(ui, context.session));
        if let Some(name) = context.session.selection.lights.first().cloned() {
            section(ui, "Light", |ui| light::ui(ui, context.session, &name));
        }
        section(ui, "Shown light", |ui| source_ui(ui, context));
        section(ui, "Lighting presets", |ui| self.presets.ui(ui, context));
    }
}

/// The choice of the light that the picture shows.
pub fn source_ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    let sources = Source::of_scene(context.session.scene());
    let titles: Vec<String> = sources.iter().map(Source::title).collect();
    let chosen = sources.iter().position(|source| source == context.aids.source()).unwrap_or(0);
    ui.horizontal(|ui| {
        let [names, controls] = columns(ui);
        let name = name_ui(ui, "Show light of", chosen != 0, names);
        let hover = "The light of one source alone, with all that it does in the scene; what all sources give adds up to the \
                     picture. Nothing of the document changes.";
        let picked = choice_ui(ui, "Show light of", &titles, chosen, controls, Some(&name), hover);
        if let Some(source) = picked.and_then(|picked| sources.get(picked)) {
            context.aids.show(source.clone());
        }
    });
    let compared = context.compare.view().is_some();
    if chosen != 0 && (compared || !shows_sources(context.session.layers()) && !context.reference.is_on()) {
        let text = match compared {
            true => "Comparisons show all light.",
            false => "Methods on the processor show all light; the reference shows it alone.",
        };
        ui.label(egui::RichText::new(text).small().color(ui.visuals().warn_fg_color));
    }
}
