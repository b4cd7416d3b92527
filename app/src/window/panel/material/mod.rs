//! The material inspector: which material, its metal, its finish, its factors, its textures.

mod factors;
mod finish;
mod header;
mod metal;
mod textures;

use eframe::egui;

use super::{Context, DraggedPreset};
use crate::window::request::Request;
use header::Header;
use textures::Textures;

/// The inspector.
#[derive(Default)]
pub struct MaterialPanel {
    header: Header,
    textures: Textures,
}

impl MaterialPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let index = context.session.selection.material;
        if context.session.material().is_none() {
            ui.weak("The document has no material.");
            return;
        }
        let MaterialPanel { header, textures } = self;
        let shown = ui.scope(|ui| {
            // The scroll bar floats over what reaches the edge.
            ui.set_max_width(ui.available_width() - 10.0);
            ui.spacing_mut().indent = 12.0;
            header.ui(ui, context, index);
            ui.separator();
            metal::metal_ui(ui, context, index);
            finish::finish_ui(ui, context, index);
            ui.separator();
            factors::factors_ui(ui, context, index);
            textures.ui(ui, context, index);
        });
        drop_ui(ui, &shown.response, context, index);
    }
}

/// A preset that is dropped anywhere on the inspector is for its material.
fn drop_ui(ui: &egui::Ui, response: &egui::Response, context: &mut Context<'_>, index: usize) {
    let response = ui.interact(response.rect, response.id.with("drop"), egui::Sense::hover());
    if response.dnd_hover_payload::<DraggedPreset>().is_some() {
        let stroke = ui.visuals().selection.stroke;
        ui.painter().rect_stroke(response.rect, 3.0, stroke, egui::StrokeKind::Inside);
    }
    if let Some(preset) = response.dnd_release_payload::<DraggedPreset>() {
        let preset = preset.0.clone();
        context.requests.push(Request::AssignPreset { preset, materials: vec![index] });
    }
}
