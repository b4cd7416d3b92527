//! The objects of the model with their materials; below them materials, lights and cameras.
//!
//! Only the rows that are seen are laid out, so that thousands of objects cost no more than a screenful.

mod placement;
mod rows;

use burnish_core::document::CameraEntry;
use eframe::egui::{self, Modifiers};

use super::Context;
use crate::window::commands::Command;
use crate::window::edits;
use crate::window::request::Request;
use crate::window::session::Session;
use rows::{Row, Section};

/// From this many objects on there is a field to search in.
const SEARCH_FROM: usize = 10;

/// The tree.
#[derive(Default)]
pub struct SceneTree {
    query: String,
    /// Where a range of Shift+clicks begins.
    anchor: Option<usize>,
    renaming: Option<Renaming>,
    closed: Vec<Section>,
    /// The selection when the list was last shown: another one is scrolled to.
    seen: Vec<String>,
}

/// A name that is being typed.
struct Renaming {
    object: usize,
    text: String,
    /// The field has not been shown yet.
    fresh: bool,
}

/// What was done to a row.
enum Action {
    /// An object was clicked.
    Select(usize, Modifiers),
    /// An object was clicked for its menu.
    SelectForMenu(usize),
    /// Objects with a material.
    SelectUsers(usize),
    /// Shows or hides an object.
    Toggle(usize),
    /// Gives an object a material.
    Assign(usize, usize),
    /// Begins to rename an object.
    BeginRename(usize),
    /// Ends it, with the name or without.
    EndRename(bool),
    /// A material was clicked.
    Inspect(usize),
    /// A camera of the model was clicked.
    LookThrough(usize),
    /// Opens or closes a section.
    Fold(Section),
    /// A command of the menu.
    Command(Command),
}

impl SceneTree {
    /// Begins to rename the first of the selected objects.
    pub fn rename(&mut self, session: &Session) {
        let Some(key) = session.selection.objects.first() else { return };
        if let Some(object) = session.resolved().object_keys.iter().position(|known| known == key) {
            self.begin_rename(session, object);
        }
    }

    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let scene = context.session.scene().clone();
        if scene.instances.len() >= SEARCH_FROM || !self.query.is_empty() {
            let field = egui::TextEdit::singleline(&mut self.query).hint_text("Search");
            let field = ui.add(field.desired_width(f32::INFINITY));
            field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SearchInput, true, "Search the scene"));
        }
        if context.session.selection.objects.len() == 1 {
            egui::Panel::bottom("placement").show(ui, |ui| placement::ui(ui, context.session));
        }
        let rows = rows::list(context.session, &self.query, &self.closed);
        let mut actions = Vec::new();
        let mut area = egui::ScrollArea::vertical().auto_shrink(false);
        if let Some(row) = self.row_to_reveal(context.session, &rows) {
            let stride = rows::HEIGHT + ui.spacing().item_spacing.y;
            area = area.vertical_scroll_offset((row as f32 * stride - 0.4 * ui.available_height()).max(0.0));
        }
        area.show_rows(ui, rows::HEIGHT, rows.len(), |ui, range| {
            for row in rows.get(range).into_iter().flatten() {
                rows::ui(ui, *row, context.session, &mut self.renaming, &mut actions);
            }
        });
        for action in actions {
            self.act(action, context, &rows);
        }
        self.seen.clone_from(&context.session.selection.objects);
    }

    /// The row of an object that was selected elsewhere or is renamed.
    fn row_to_reveal(&self, session: &Session, rows: &[Row]) -> Option<usize> {
        let object = match &self.renaming {
            Some(Renaming { object, fresh: true, .. }) => *object,
            _ if session.selection.objects != self.seen => {
                let key = session.selection.objects.first()?;
                session.resolved().object_keys.iter().position(|known| known == key)?
            }
            _ => return None,
        };
        rows.iter().position(|row| *row == Row::Object(object))
    }

    fn act(&mut self, action: Action, context: &mut Context<'_>, rows: &[Row]) {
        let session = &mut *context.session;
        match action {
            Action::Select(object, modifiers) => self.select(session, object, modifiers, rows),
            Action::SelectForMenu(object) => {
                let selected = session.resolved().object_keys.get(object);
                if selected.is_some_and(|key| !session.selection.objects.contains(key)) {
                    self.select(session, object, Modifiers::NONE, rows);
                }
            }
            Action::SelectUsers(material) => {
                let users = session.resolved().object_keys.iter().zip(&session.scene().instances);
                let users = users.filter(|(_, instance)| instance.material == material).map(|(key, _)| key.clone());
                session.selection.objects = users.collect();
                session.selection.material = material;
            }
            Action::Toggle(object) => toggle(session, object),
            Action::Assign(object, material) => assign(session, object, material),
            Action::BeginRename(object) => self.begin_rename(session, object),
            Action::EndRename(keep) => {
                if let Some(renaming) = self.renaming.take().filter(|_| keep) {
                    rename(session, renaming.object, renaming.text.trim());
                }
            }
            Action::Inspect(material) => {
                session.selection.objects.clear();
                session.selection.material = material;
            }
            Action::LookThrough(camera) => look_through(session, camera),
            Action::Fold(section) => match self.closed.iter().position(|closed| *closed == section) {
                Some(place) => _ = self.closed.remove(place),
                None => self.closed.push(section),
            },
            Action::Command(command) => context.requests.push(Request::Command(command)),
        }
        // What is selected here needs no scrolling to.
        self.seen.clone_from(&context.session.selection.objects);
    }

    /// Plain clicks select one object, Ctrl adds or removes it, Shift selects the rows from the last click on.
    fn select(&mut self, session: &mut Session, object: usize, modifiers: Modifiers, rows: &[Row]) {
        let Some(key) = session.resolved().object_keys.get(object).cloned() else { return };
        let place = |object: usize| rows.iter().position(|row| *row == Row::Object(object));
        let range = self.anchor.filter(|_| modifiers.shift).and_then(|anchor| Some((place(anchor)?, place(object)?)));
        if let Some((from, to)) = range {
            let keys = &session.resolved().object_keys;
            let between = rows.get(from.min(to)..=from.max(to)).into_iter().flatten();
            let selected = between.filter_map(|row| match row {
                Row::Object(object) => keys.get(*object).cloned(),
                _ => None,
            });
            session.selection.objects = selected.collect();
        } else if modifiers.command {
            match session.selection.objects.iter().position(|known| *known == key) {
                Some(place) => _ = session.selection.objects.remove(place),
                None => session.selection.objects.push(key),
            }
            self.anchor = Some(object);
        } else {
            session.selection.objects = vec![key];
            self.anchor = Some(object);
        }
        let material = session.scene().instances.get(object).map(|instance| instance.material);
        if let Some(material) = material.filter(|material| *material < session.document().materials.len()) {
            session.selection.material = material;
        }
    }

    fn begin_rename(&mut self, session: &Session, object: usize) {
        let name = session.scene().instances.get(object).map(|instance| instance.name.clone());
        self.renaming = name.map(|text| Renaming { object, text, fresh: true });
        // The row must be in the list.
        self.closed.retain(|section| *section != Section::Objects);
        self.query.clear();
    }
}

fn toggle(session: &mut Session, object: usize) {
    let resolved = session.resolved();
    let (Some(key), Some(instance)) = (resolved.object_keys.get(object), resolved.scene.instances.get(object)) else {
        return;
    };
    let (key, hidden) = (key.clone(), instance.visible);
    session.edit(if hidden { "Hide" } else { "Show" }, &key, |document| {
        document.edit_object(&key, |object| object.hidden = hidden);
    });
    session.seal();
}

fn assign(session: &mut Session, object: usize, material: usize) {
    let Some(key) = session.resolved().object_keys.get(object).cloned() else { return };
    let Some(name) = session.document().materials.get(material).map(|entry| entry.name.clone()) else { return };
    // A row of a selection speaks for all of it.
    let all = session.selection.objects.contains(&key);
    let objects = if all { session.selection.objects.clone() } else { vec![key] };
    let target = format!("{name} on {}", edits::names(&objects));
    session.edit("Assign material", &target, |document| document.assign_material(&objects, &name));
    session.seal();
    session.selection.material = material;
}

/// An empty name gives the model's back.
fn rename(session: &mut Session, object: usize, name: &str) {
    let Some(key) = session.resolved().object_keys.get(object).cloned() else { return };
    let model = session.sources().models.get(&session.document().scene);
    let own = model.and_then(|model| model.instances.get(object)).is_some_and(|instance| instance.name == name);
    let name = (!name.is_empty() && !own).then(|| name.to_string());
    session.edit("Rename", &key, |document| document.edit_object(&key, |object| object.name = name));
    session.seal();
}

fn look_through(session: &mut Session, camera: usize) {
    let scene = session.scene().clone();
    let Some(camera) = scene.cameras.get(camera) else { return };
    let entry = CameraEntry { name: String::new(), ..CameraEntry::from_camera(camera, scene.bounds()) };
    session.edit("Look through camera", &camera.name, |document| document.view.camera = entry);
    session.seal();
}
