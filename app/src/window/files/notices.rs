//! What is said about files: banners above the panels, work that goes on, what importers noticed, recovered documents.

use burnish_core::document::{Missing, MissingKind};
use eframe::egui::{self, Align2, Button, ScrollArea};

use super::load::{Notices, name_of};
use super::recovery::Found;

/// What a banner asks for.
pub enum Action {
    Reload(String),
    Ignore(String),
    Relink(Missing),
    PutAway(String),
}

/// Height of the rows of banners; more are scrolled.
const MAX_HEIGHT: f32 = 96.0;

/// A row for each changed and each missing file.
pub fn banner_ui(ui: &mut egui::Ui, changed: &[String], missing: &[Missing]) -> Vec<Action> {
    let mut actions = Vec::new();
    if changed.is_empty() && missing.is_empty() {
        return actions;
    }
    egui::Panel::top("files").show(ui, |ui| {
        ScrollArea::vertical().max_height(MAX_HEIGHT).auto_shrink([false, true]).show(ui, |ui| {
            for path in changed {
                let name = name_of(path);
                row_ui(ui, &format!("{name} changed on disk"), path, |ui| {
                    if button(ui, "Reload", &format!("Reload {name}"), "Read it again; edits stay").clicked() {
                        actions.push(Action::Reload(path.clone()));
                    }
                    if button(ui, "Ignore", &format!("Ignore {name}"), "Keep what was read").clicked() {
                        actions.push(Action::Ignore(path.clone()));
                    }
                });
            }
            for file in missing {
                let name = name_of(&file.path);
                let instead = match file.kind {
                    MissingKind::Model => "balls stand in for it",
                    MissingKind::Environment => "the studio lights the scene instead",
                    MissingKind::Texture => "its slot is empty",
                };
                row_ui(ui, &format!("{name} is missing: {instead}"), &file.reason, |ui| {
                    if button(ui, "Relink...", &format!("Relink {name}"), "Say where the file is now").clicked() {
                        actions.push(Action::Relink(file.clone()));
                    }
                    if button(ui, "Hide", &format!("Hide {name}"), "Put this message away").clicked() {
                        actions.push(Action::PutAway(file.path.clone()));
                    }
                });
            }
        });
    });
    actions
}

fn row_ui(ui: &mut egui::Ui, text: &str, hover: &str, buttons: impl FnOnce(&mut egui::Ui)) {
    ui.horizontal(|ui| {
        ui.colored_label(ui.visuals().warn_fg_color, "\u{26a0}");
        ui.add(egui::Label::new(text).truncate()).on_hover_text(hover);
        buttons(ui);
    });
}

/// A button whose name for assistive technology also says what it is about.
fn button(ui: &mut egui::Ui, text: &str, name: &str, hover: &str) -> egui::Response {
    let response = ui.add(Button::new(text).small()).on_hover_text(hover);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
    response
}

/// Says that a document is being read; true when it shall not be.
pub fn loading_ui(ctx: &egui::Context, label: &str) -> bool {
    let modal = egui::Modal::new(egui::Id::unique("loading")).show(ctx, |ui| {
        ui.set_width(300.0);
        ui.label(format!("{label}..."));
        ui.add_space(8.0);
        ui.button("Cancel").on_hover_text("Keep what is open").clicked()
    });
    modal.inner || ctx.input(|input| input.key_pressed(egui::Key::Escape)) && modal.is_top_modal
}

/// Shows work beside which one can go on, with its fraction; returns the label of what shall end.
pub fn work_ui(ctx: &egui::Context, works: &[(String, Option<f32>)]) -> Option<String> {
    if works.is_empty() {
        return None;
    }
    let mut ended = None;
    let place = egui::vec2(12.0, -36.0);
    egui::Area::new(egui::Id::unique("work")).anchor(Align2::LEFT_BOTTOM, place).show(ctx, |ui| {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            for (label, fraction) in works {
                ui.horizontal(|ui| {
                    ui.label(format!("{label}..."));
                    if let Some(fraction) = fraction {
                        ui.add(egui::ProgressBar::new(*fraction).desired_width(120.0).show_percentage());
                    }
                    if button(ui, "Cancel", &format!("Cancel {label}"), "End this; nothing is changed").clicked() {
                        ended = Some(label.clone());
                    }
                });
            }
        });
    });
    ended
}

/// Lists what an importer left out, repaired or guessed.
pub fn window_ui(ctx: &egui::Context, open: &mut bool, notices: &Notices) {
    egui::Window::new("Notices").open(open).default_size([460.0, 220.0]).show(ctx, |ui| {
        if notices.lines.is_empty() {
            ui.label("Nothing was left out, repaired or guessed in the files that were read.");
            return;
        }
        ui.label(format!("What was left out, repaired or guessed when {} was read:", notices.title));
        ui.add_space(4.0);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for line in &notices.lines {
                ui.label(line);
                ui.separator();
            }
        });
    });
}

/// What the user wants with a document that was not saved.
pub enum Offer {
    Recover,
    Discard,
    Later,
}

/// Offers a document that a crash left behind; `None` while there is no answer.
pub fn offer_ui(ctx: &egui::Context, found: &Found) -> Option<Offer> {
    let mut answer = None;
    egui::Modal::new(egui::Id::unique("recovery")).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading("Recover unsaved changes?");
        ui.add_space(4.0);
        ui.label(format!("Burnish ended without saving `{}`. Its edits were kept {}.", found.title, found.age()));
        if let Some(path) = &found.snapshot().path {
            ui.weak(path.display().to_string());
        }
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            let recover = ui.button("Recover").on_hover_text("Open it with its edits; the saved file stays as it is");
            if ui.memory(|memory| memory.focused().is_none()) {
                recover.request_focus();
            }
            if recover.clicked() {
                answer = Some(Offer::Recover);
            }
            if ui.button("Discard").on_hover_text("Delete the unsaved edits for good").clicked() {
                answer = Some(Offer::Discard);
            }
            if ui.button("Later").on_hover_text("Ask again at the next start").clicked() {
                answer = Some(Offer::Later);
            }
        });
    });
    answer
}
