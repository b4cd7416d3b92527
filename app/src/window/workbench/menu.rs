//! The ways to commands: menus and keys.

use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};

use super::Workbench;
use crate::window::commands::{Command, Entry, Menu, TABLE};
use crate::window::request::Request;

impl Workbench {
    /// Commands whose keys were pressed; those without a modifier only while no text is edited.
    pub(super) fn shortcuts(&mut self, ui: &egui::Ui) {
        // A dialog has the keys for itself; only the palette's own takes it away again.
        let modal = ui.memory(|memory| memory.top_modal_layer().is_some());
        let typing = ui.ctx().egui_wants_keyboard_input();
        // `Ctrl+=` stands for `Ctrl++` where plus needs Shift.
        let plus = KeyboardShortcut::new(Modifiers::COMMAND, Key::Equals);
        let second = Command::ScaleUp.entry().map(|entry| (plus, entry));
        let mut keys: Vec<(KeyboardShortcut, &Entry)> =
            TABLE.iter().filter_map(|entry| Some((entry.shortcut?, entry))).chain(second).collect();
        // Keys match although more modifiers are held: those with Shift go first.
        keys.sort_by_key(|(shortcut, _)| !shortcut.modifiers.shift);
        for (shortcut, entry) in keys {
            let function_key = matches!(shortcut.logical_key, Key::F1);
            let blocked =
                modal && entry.command != Command::Palette || shortcut.modifiers.is_none() && !function_key && typing;
            // Alt belongs to window managers and navigation, and is in no shortcut.
            if !blocked && ui.input_mut(|input| !input.modifiers.alt && input.consume_shortcut(&shortcut)) {
                self.requests.push(Request::Command(entry.command));
            }
        }
    }

    pub(super) fn menu_ui(&mut self, ui: &mut egui::Ui) {
        egui::MenuBar::new().ui(ui, |ui| {
            for menu in Menu::ALL {
                ui.menu_button(menu.title(), |ui| {
                    for (index, entry) in TABLE.iter().filter(|entry| entry.menu == menu).enumerate() {
                        if entry.begins_group() && index > 0 {
                            ui.separator();
                        }
                        self.menu_entry_ui(ui, entry);
                    }
                });
            }
        });
    }

    fn menu_entry_ui(&mut self, ui: &mut egui::Ui, entry: &Entry) {
        let obstacle = self.obstacle(entry.command);
        let mut button = match self.is_on(entry.command) {
            Some(on) => egui::Button::selectable(on, entry.title),
            None => egui::Button::new(entry.title),
        };
        if let Some(shortcut) = &entry.shortcut {
            button = button.shortcut_text(ui.ctx().format_shortcut(shortcut));
        }
        let response = ui.add_enabled(obstacle.is_none(), button).on_hover_text(entry.help);
        if let Some(reason) = obstacle {
            response.on_disabled_hover_text(reason);
        } else if response.clicked() {
            self.requests.push(Request::Command(entry.command));
        }
    }
}
