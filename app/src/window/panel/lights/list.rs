//! All lights with their switches, and what is done with the selected ones.

use burnish_core::document::{LightEntry, Shape};
use eframe::egui::{self, RichText, Role, WidgetInfo};

use crate::window::lights::{self, LightAct};
use crate::window::session::Session;
use crate::window::widget::name_widget;

/// Shows the list.
pub fn ui(ui: &mut egui::Ui, session: &mut Session) {
    buttons_ui(ui, session);
    let all = lights::entries(session);
    if all.is_empty() {
        ui.weak("No lights: only the environment and what glows shine.");
    }
    let mut group = String::new();
    // Lights of a group stand together, in the order of the groups' first lights.
    for (place, light) in in_groups(&all) {
        if light.group != group {
            group.clone_from(&light.group);
            if !group.is_empty() {
                group_ui(ui, session, &group, &all);
            }
        }
        ui.push_id(place, |ui| light_ui(ui, session, light));
    }
}

/// The lights with those of a group together, with their places in the list.
fn in_groups(all: &[LightEntry]) -> Vec<(usize, &LightEntry)> {
    let first = |group: &str| all.iter().position(|light| light.group == group).unwrap_or(0);
    let mut ordered: Vec<(usize, &LightEntry)> = all.iter().enumerate().collect();
    // Those without a group come first.
    ordered.sort_by_key(|(place, light)| (!light.group.is_empty(), first(&light.group), *place));
    ordered
}

fn buttons_ui(ui: &mut egui::Ui, session: &mut Session) {
    ui.horizontal_wrapped(|ui| {
        let add = ui.menu_button("Add light", |ui| {
            for shape in Shape::all(lights::radius(session)) {
                if ui.button(format!("Add {}", shape.title().to_lowercase())).clicked() {
                    lights::act(session, LightAct::Add(shape));
                    ui.close();
                }
            }
        });
        add.response.on_hover_text("A new light shines on the subject from the upper left of its front.");
        let chosen = !session.selection.lights.is_empty();
        let mut button = |ui: &mut egui::Ui, text: &str, hover: &str, act: LightAct| {
            let button = ui.add_enabled(chosen, egui::Button::new(text));
            name_widget(&button, &format!("{text} light"));
            if button.on_hover_text(hover).on_disabled_hover_text("Select a light first.").clicked() {
                lights::act(session, act);
            }
        };
        button(ui, "Duplicate", "A copy in the same place.", LightAct::Duplicate);
        button(ui, "Delete", "Remove the selected lights.", LightAct::Remove);
        ui.add_enabled_ui(chosen, |ui| {
            ui.menu_button("Mirror", |ui| {
                for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                    if ui.button(format!("Mirror light in {letter}")).clicked() {
                        lights::act(session, LightAct::Mirror(axis));
                        ui.close();
                    }
                }
            })
            .response
            .on_hover_text("To the other side of the subject.");
        });
    });
}

/// A title with switches for all lights of a group.
fn group_ui(ui: &mut egui::Ui, session: &mut Session, group: &str, all: &[LightEntry]) {
    let members: Vec<&LightEntry> = all.iter().filter(|light| light.group == group).collect();
    let (solo, muted) = (members.iter().all(|light| light.solo), members.iter().all(|light| light.muted));
    ui.horizontal(|ui| {
        let of = format!("group {group}");
        if switch_ui(ui, "S", solo, &format!("Solo {of}")) {
            lights::set_group(session, "Solo light", group, |light| light.solo = !solo);
        }
        if switch_ui(ui, "M", muted, &format!("Mute {of}")) {
            lights::set_group(session, "Mute light", group, |light| light.muted = !muted);
        }
        let label = ui.selectable_label(false, RichText::new(group).strong());
        if label.on_hover_text("Selects all lights of the group.").clicked() {
            session.selection.lights = members.iter().map(|light| light.name.clone()).collect();
        }
    });
}

fn light_ui(ui: &mut egui::Ui, session: &mut Session, light: &LightEntry) {
    let name = &light.name;
    ui.horizontal(|ui| {
        if switch_ui(ui, "S", light.solo, &format!("Solo {name}")) {
            lights::set(session, "Solo light", name, |light| light.solo = !light.solo);
            session.seal();
        }
        if switch_ui(ui, "M", light.muted, &format!("Mute {name}")) {
            lights::set(session, "Mute light", name, |light| light.muted = !light.muted);
            session.seal();
        }
        let chosen = session.selection.lights.contains(name);
        let text = if light.muted { RichText::new(name).weak() } else { RichText::new(name) };
        let response = ui.selectable_label(chosen, text).on_hover_text(strength(light));
        response.widget_info(|| WidgetInfo::selected(Role::ListItem, true, chosen, format!("Light {name}")));
        if response.clicked() {
            let add = ui.input(|input| input.modifiers.command || input.modifiers.shift);
            lights::select(session, name, add);
        }
        ui.weak(light.shape.title().to_lowercase());
    });
}

/// What it is and how strong.
fn strength(light: &LightEntry) -> String {
    format!("{}, {:.4} {}", light.shape.title(), light.power, light.unit().symbol())
}

/// A small switch with a letter; true when it was clicked.
fn switch_ui(ui: &mut egui::Ui, letter: &str, on: bool, name: &str) -> bool {
    let button = ui.add(egui::Button::selectable(on, RichText::new(letter).small()).min_size(egui::vec2(18.0, 0.0)));
    name_widget(&button, name);
    button.on_hover_text(name).clicked()
}
