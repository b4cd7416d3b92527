//! Rows of the scene tree: which there are, and how one is drawn.

use eframe::egui::{self, Key, RichText, Role, WidgetInfo};

use super::{Action, Renaming};
use crate::window::commands::Command;
use crate::window::session::Session;

/// Height of every row.
pub const HEIGHT: f32 = 20.0;
/// Width of the eye before a name.
const EYE_WIDTH: f32 = 20.0;

/// A part of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    Objects,
    Materials,
    Lights,
    Cameras,
}

/// A line of the list, by place in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// Heading with the number of rows below it.
    Heading(Section, usize),
    Object(usize),
    Material(usize),
    Light(usize),
    Camera(usize),
}

/// All rows whose name holds the query; closed sections are their heading only.
pub fn list(session: &Session, query: &str, closed: &[Section]) -> Vec<Row> {
    let scene = session.scene();
    let query = query.trim().to_lowercase();
    let matches = |name: &str| query.is_empty() || name.to_lowercase().contains(&query);
    let mut rows = Vec::new();
    let mut section = |section: Section, found: Vec<Row>, always: bool| {
        if always || !found.is_empty() {
            rows.push(Row::Heading(section, found.len()));
        }
        if !closed.contains(&section) {
            rows.extend(found);
        }
    };
    fn places<'a>(names: impl Iterator<Item = &'a str>, matches: impl Fn(&str) -> bool) -> Vec<usize> {
        names.enumerate().filter(|(_, name)| matches(name)).map(|(place, _)| place).collect()
    }
    let objects = places(scene.instances.iter().map(|instance| instance.name.as_str()), matches);
    section(Section::Objects, objects.into_iter().map(Row::Object).collect(), true);
    let materials = places(session.document().materials.iter().map(|entry| entry.name.as_str()), matches);
    section(Section::Materials, materials.into_iter().map(Row::Material).collect(), false);
    let lights = places(scene.lights.iter().map(|light| light.name.as_str()), matches);
    section(Section::Lights, lights.into_iter().map(Row::Light).collect(), false);
    let cameras = places(scene.cameras.iter().map(|camera| camera.name.as_str()), matches);
    section(Section::Cameras, cameras.into_iter().map(Row::Camera).collect(), false);
    rows
}

/// Draws a row and notes what was done to it.
pub fn ui(ui: &mut egui::Ui, row: Row, session: &Session, renaming: &mut Option<Renaming>, actions: &mut Vec<Action>) {
    let size = egui::vec2(ui.available_width(), HEIGHT);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_min_size(size);
        ui.spacing_mut().item_spacing.x = 3.0;
        ui.push_id(salt(row), |ui| match row {
            Row::Heading(section, count) => heading_ui(ui, section, count, actions),
            Row::Object(object) => match renaming {
                Some(renaming) if renaming.object == object => rename_ui(ui, renaming, actions),
                _ => object_ui(ui, object, session, actions),
            },
            Row::Material(material) => material_ui(ui, material, session, actions),
            Row::Light(light) => light_ui(ui, light, session),
            Row::Camera(camera) => camera_ui(ui, camera, session, actions),
        });
    });
}

fn salt(row: Row) -> (&'static str, usize) {
    match row {
        Row::Heading(section, _) => ("heading", section as usize),
        Row::Object(place) => ("object", place),
        Row::Material(place) => ("material", place),
        Row::Light(place) => ("light", place),
        Row::Camera(place) => ("camera", place),
    }
}

fn heading_ui(ui: &mut egui::Ui, section: Section, count: usize, actions: &mut Vec<Action>) {
    let title = match section {
        Section::Objects => "Objects",
        Section::Materials => "Materials",
        Section::Lights => "Lights of the model",
        Section::Cameras => "Cameras of the model",
    };
    let text = RichText::new(format!("{title} ({count})")).strong();
    let heading = ui.add(egui::Button::new(text).frame(false).truncate());
    if heading.on_hover_text("Click to fold or unfold").clicked() {
        actions.push(Action::Fold(section));
    }
}

fn named(name: &str) -> &str {
    if name.is_empty() { "(no name)" } else { name }
}

/// A row of a list that takes the width up to `reserved`.
fn name_ui(ui: &mut egui::Ui, text: RichText, selected: bool, reserved: f32) -> egui::Response {
    let name = text.text().to_string();
    let width = (ui.available_width() - reserved).max(24.0);
    // Text on the right, though empty, keeps the name on the left.
    let button = egui::Button::selectable(selected, text).truncate().right_text("");
    let button = button.min_size(egui::vec2(width, HEIGHT));
    let row = ui.allocate_ui(egui::vec2(width, HEIGHT), |ui| ui.add(button)).inner;
    row.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, &name));
    row
}

fn object_ui(ui: &mut egui::Ui, object: usize, session: &Session, actions: &mut Vec<Action>) {
    let resolved = session.resolved();
    let (Some(instance), Some(key)) = (resolved.scene.instances.get(object), resolved.object_keys.get(object)) else {
        return;
    };
    let name = named(&instance.name);
    let verb = if instance.visible { "Hide" } else { "Show" };
    let eye = eye_ui(ui, instance.visible);
    eye.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("{verb} {name}")));
    if eye.on_hover_text(format!("{verb} this object")).clicked() {
        actions.push(Action::Toggle(object));
    }
    // A narrow panel shows names only: the material is in the context menu then.
    let combo_width = if ui.available_width() > 140.0 { (0.42 * ui.available_width()).min(150.0) } else { 0.0 };
    let text = if instance.visible { RichText::new(name) } else { RichText::new(name).weak() };
    let selected = session.selection.objects.contains(key);
    let row = name_ui(ui, text, selected, combo_width + 4.0);
    if row.double_clicked() {
        actions.push(Action::BeginRename(object));
    } else if row.clicked() {
        actions.push(Action::Select(object, ui.input(|input| input.modifiers)));
    }
    if row.secondary_clicked() {
        actions.push(Action::SelectForMenu(object));
    }
    row.context_menu(|ui| menu_ui(ui, object, instance.material, session, actions));
    if combo_width > 0.0 {
        combo_ui(ui, object, session, combo_width, actions);
    }
}

/// An open or a closed eye to click.
fn eye_ui(ui: &mut egui::Ui, open: bool) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(egui::vec2(EYE_WIDTH, HEIGHT), egui::Sense::click());
    let visuals = ui.style().interact(&response);
    let shade = if open || response.hovered() { 1.0 } else { 0.6 };
    let stroke = egui::Stroke::new(1.2, visuals.fg_stroke.color.gamma_multiply(shade));
    let (center, half) = (rect.center(), egui::vec2(6.0, 3.5));
    let lid = |up: f32| {
        let point = |i: u8| {
            let x = f32::from(i) / 6.0 - 1.0;
            center + egui::vec2(half.x * x, up * half.y * (1.0 - x * x))
        };
        egui::Shape::line((0..=12).map(point).collect(), stroke)
    };
    ui.painter().add(lid(1.0));
    if open {
        ui.painter().add(lid(-1.0));
        ui.painter().circle_filled(center, 2.0, stroke.color);
    }
    response
}

/// The material of an object.
fn combo_ui(ui: &mut egui::Ui, object: usize, session: &Session, width: f32, actions: &mut Vec<Action>) {
    let scene = session.scene();
    let Some(instance) = scene.instances.get(object) else { return };
    let own = scene.materials.get(instance.material).map_or("", |material| material.name.as_str());
    let combo = egui::ComboBox::from_id_salt("material").selected_text(RichText::new(named(own)).small());
    let combo = combo.width(width).truncate().show_ui(ui, |ui| {
        for (index, entry) in session.document().materials.iter().enumerate() {
            if ui.selectable_label(index == instance.material, named(&entry.name)).clicked() {
                actions.push(Action::Assign(object, index));
            }
        }
    });
    let label = format!("Material of {}", named(&instance.name));
    combo.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, &label));
    combo.response.on_hover_text(format!("{label}: {}", named(own)));
}

fn menu_ui(ui: &mut egui::Ui, object: usize, material: usize, session: &Session, actions: &mut Vec<Action>) {
    for command in [Command::Rename, Command::Hide, Command::Isolate, Command::ShowAll, Command::Frame] {
        let Some(entry) = command.entry() else { continue };
        let mut button = egui::Button::new(entry.title);
        if let Some(shortcut) = &entry.shortcut {
            button = button.shortcut_text(ui.ctx().format_shortcut(shortcut));
        }
        if ui.add_enabled(command.is_enabled(session), button).on_hover_text(entry.help).clicked() {
            actions.push(Action::Command(command));
        }
    }
    ui.separator();
    if ui.button("Select all with this material").clicked() {
        actions.push(Action::SelectUsers(material));
    }
    ui.menu_button("Give a material", |ui| {
        egui::ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
            for (index, entry) in session.document().materials.iter().enumerate() {
                if ui.selectable_label(index == material, named(&entry.name)).clicked() {
                    actions.push(Action::Assign(object, index));
                    ui.close();
                }
            }
        });
    });
}

fn rename_ui(ui: &mut egui::Ui, renaming: &mut Renaming, actions: &mut Vec<Action>) {
    ui.add_space(EYE_WIDTH);
    let field = ui.add(egui::TextEdit::singleline(&mut renaming.text).desired_width(f32::INFINITY));
    field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Name of the object"));
    if std::mem::take(&mut renaming.fresh) {
        field.request_focus();
    } else if field.lost_focus() || !field.has_focus() {
        actions.push(Action::EndRename(!ui.input(|input| input.key_pressed(Key::Escape))));
    }
}

fn material_ui(ui: &mut egui::Ui, material: usize, session: &Session, actions: &mut Vec<Action>) {
    let Some(entry) = session.document().materials.get(material) else { return };
    ui.add_space(EYE_WIDTH);
    let metal = entry.preset.as_ref().map(|used| used.id.as_str()).unwrap_or_default();
    let selected = session.selection.material == material;
    let button = egui::Button::selectable(selected, named(&entry.name)).truncate();
    let button = button.right_text(RichText::new(metal).weak());
    let row = ui.add_sized([ui.available_width(), HEIGHT], button);
    row.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, format!("Material {}", named(&entry.name))));
    if row.clicked() || row.secondary_clicked() {
        actions.push(Action::Inspect(material));
    }
    row.context_menu(|ui| {
        if ui.button("Select the objects that have it").clicked() {
            actions.push(Action::SelectUsers(material));
        }
        for command in
            [Command::DuplicateMaterial, Command::CopyMaterial, Command::PasteMaterial, Command::RemoveMaterial]
        {
            let Some(entry) = command.entry() else { continue };
            let button = ui.add_enabled(command.is_enabled(session), egui::Button::new(entry.title));
            if button.on_hover_text(entry.help).clicked() {
                actions.push(Action::Command(command));
            }
        }
    });
    row.on_hover_text("Show it in the material panel");
}

fn light_ui(ui: &mut egui::Ui, light: usize, session: &Session) {
    let Some(light) = session.scene().lights.get(light) else { return };
    ui.add_space(EYE_WIDTH + 6.0);
    ui.add(egui::Label::new(named(&light.name)).truncate());
    ui.weak(light.kind.label());
}

fn camera_ui(ui: &mut egui::Ui, camera: usize, session: &Session, actions: &mut Vec<Action>) {
    let Some(camera_of_model) = session.scene().cameras.get(camera) else { return };
    ui.add_space(EYE_WIDTH);
    let row = name_ui(ui, RichText::new(named(&camera_of_model.name)), false, 0.0);
    if row.on_hover_text("Look through this camera").clicked() {
        actions.push(Action::LookThrough(camera));
    }
}

#[cfg(test)]
mod tests {
    use burnish_core::document::{DEFAULT_SCENE, open};

    use super::*;

    #[test]
    fn a_search_leaves_what_holds_its_letters_and_closed_sections_keep_their_heading() {
        let session = Session::new(open(DEFAULT_SCENE).unwrap(), None);
        let all = list(&session, "", &[]);
        let objects = session.scene().instances.len();
        assert_eq!(all.first(), Some(&Row::Heading(Section::Objects, objects)));
        assert!(all.len() > objects + session.document().materials.len());
        assert_eq!(list(&session, "no such name", &[]), [Row::Heading(Section::Objects, 0)]);
        let closed = list(&session, "", &[Section::Objects]);
        assert_eq!(closed.len(), all.len() - objects);
        let name = session.scene().instances[0].name.to_uppercase();
        assert!(list(&session, &name, &[]).contains(&Row::Object(0)));
    }
}
