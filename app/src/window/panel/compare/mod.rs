//! What A and B are, the snapshots, and the list of what differs.

mod list;
mod sides;
mod snapshots;

use eframe::egui;

use super::Context;

/// The panel.
#[derive(Default)]
pub struct ComparePanel {
    snapshots: snapshots::SnapshotList,
    list: list::DifferenceList,
}

impl ComparePanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        section(ui, "Sides", |ui| sides::ui(ui, context));
        section(ui, "Snapshots", |ui| self.snapshots.ui(ui, context));
        section(ui, "Differences", |ui| self.list.ui(ui, context));
    }
}

fn section(ui: &mut egui::Ui, title: &str, contents: impl FnOnce(&mut egui::Ui)) {
    egui::CollapsingHeader::new(title).default_open(true).show_unindented(ui, contents);
    ui.add_space(4.0);
}
