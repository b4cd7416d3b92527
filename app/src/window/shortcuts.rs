//! The shortcut page: all keys from the table of commands, and what the mouse does in the viewport.

use eframe::egui;

use super::commands::{Menu, TABLE};
use super::preferences::Navigation;

/// Shows the page until it is closed.
pub fn ui(ctx: &egui::Context, open: &mut bool, navigation: Navigation) {
    let height = ctx.content_rect().height();
    let window = egui::Window::new("Shortcuts").open(open).collapsible(false).resizable(false);
    window.pivot(egui::Align2::CENTER_CENTER).default_pos(ctx.content_rect().center()).show(ctx, |ui| {
        egui::ScrollArea::vertical().max_height((height - 160.0).max(120.0)).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                ui.vertical(keys_ui);
                ui.add_space(24.0);
                ui.vertical(|ui| gestures_ui(ui, navigation));
            });
        });
    });
}

fn keys_ui(ui: &mut egui::Ui) {
    for menu in Menu::ALL {
        let entries = TABLE.iter().filter(|entry| entry.menu == menu);
        let with_keys: Vec<_> = entries.filter_map(|entry| Some((entry, entry.shortcut?))).collect();
        if with_keys.is_empty() {
            continue;
        }
        ui.strong(menu.title());
        egui::Grid::new(menu.title()).num_columns(2).min_col_width(90.0).show(ui, |ui| {
            for (entry, shortcut) in with_keys {
                ui.monospace(ui.ctx().format_shortcut(&shortcut));
                ui.label(entry.title).on_hover_text(entry.help);
                ui.end_row();
            }
        });
        ui.add_space(6.0);
    }
}

fn gestures_ui(ui: &mut egui::Ui, navigation: Navigation) {
    ui.strong("Mouse in the viewport");
    egui::Grid::new("gestures").num_columns(2).min_col_width(90.0).show(ui, |ui| {
        for (gesture, effect) in turning(navigation).iter().chain(COMMON) {
            ui.monospace(*gesture);
            ui.label(*effect);
            ui.end_row();
        }
    });
    ui.add_space(6.0);
    ui.strong("Lists");
    egui::Grid::new("lists").num_columns(2).min_col_width(90.0).show(ui, |ui| {
        for (gesture, effect) in LISTS {
            ui.monospace(*gesture);
            ui.label(*effect);
            ui.end_row();
        }
    });
}

/// What every navigation has.
const COMMON: &[(&str, &str)] = &[
    ("Click", "Select the object and its material"),
    ("Wheel", "Zoom"),
    ("Shift+Right drag", "Turn the environment"),
    ("Shift+Wheel", "Exposure"),
];

const LISTS: &[(&str, &str)] = &[
    ("Click", "Select"),
    ("Ctrl+Click", "Select or leave out"),
    ("Shift+Click", "Select up to here"),
    ("Double-click", "Rename an object, apply a preset"),
    ("Right-click", "More"),
];

/// What turns, shifts and zooms.
fn turning(navigation: Navigation) -> &'static [(&'static str, &'static str)] {
    match navigation {
        Navigation::Burnish => {
            &[("Left drag", "Turn"), ("Middle drag", "Shift"), ("Ctrl+Right drag", "Shift"), ("Right drag", "Zoom")]
        }
        Navigation::Blender => &[("Middle drag", "Turn"), ("Shift+Middle drag", "Shift"), ("Ctrl+Middle drag", "Zoom")],
        Navigation::Maya => &[
            ("Alt+Left drag", "Turn"),
            ("Ctrl+Left drag", "Turn"),
            ("Alt+Middle drag", "Shift"),
            ("Middle drag", "Shift"),
            ("Alt+Right drag", "Zoom"),
            ("Right drag", "Zoom"),
        ],
    }
}
