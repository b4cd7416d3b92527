//! The list of snapshots.

use burnish_core::document::{Document, Side};
use eframe::egui;

use super::Context;
use crate::window::commands::Command;
use crate::window::rename::{Renaming, Typed, rename_ui};
use crate::window::request::Request;
use crate::window::session::Session;

/// The list.
#[derive(Default)]
pub struct SnapshotList {
    /// The one that is being renamed, by its name.
    renamed: Option<Renaming<String>>,
}

/// What was clicked.
enum Action {
    Restore(String),
    Replace(String),
    Show(String, Side),
    StartRename(String),
    Rename(String, String),
    Delete(String),
}

impl SnapshotList {
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        if ui.button("Take snapshot").on_hover_text("Keep the document as it is now under a name.").clicked() {
            context.requests.push(Request::Command(Command::TakeSnapshot));
        }
        let document = context.session.document().clone();
        if document.snapshots.is_empty() {
            ui.weak("No snapshots");
        }
        let mut action = None;
        for snapshot in &document.snapshots {
            self.row_ui(ui, &document, &snapshot.name, &mut action);
        }
        if let Some(action) = action {
            self.act(action, context.session);
        }
    }

    fn row_ui(&mut self, ui: &mut egui::Ui, document: &Document, name: &str, action: &mut Option<Action>) {
        match rename_ui(ui, &mut self.renamed, name, "Name of the snapshot") {
            Typed::Elsewhere => {}
            Typed::Typing => return,
            Typed::Done(new) => {
                *action = Some(Action::Rename(name.into(), new));
                return;
            }
        }
        ui.horizontal(|ui| {
            let restore = ui.button(name).on_hover_text("Go back to this state, the point of view included.");
            restore.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Restore {name}")));
            if restore.clicked() {
                *action = Some(Action::Restore(name.into()));
            }
            let menu = ui.menu_button("...", |ui| {
                for (title, chosen) in [
                    ("Show as A", Action::Show(name.into(), Side::A)),
                    ("Show as B", Action::Show(name.into(), Side::B)),
                    ("Replace by the document", Action::Replace(name.into())),
                    ("Rename", Action::StartRename(name.into())),
                    ("Delete", Action::Delete(name.into())),
                ] {
                    if ui.button(title).clicked() {
                        *action = Some(chosen);
                    }
                }
            });
            let label = format!("Change snapshot {name}");
            menu.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            let of = |side: &Side| document.compare.side(*side).snapshot.as_deref() == Some(name);
            for side in Side::ALL.into_iter().filter(of) {
                ui.weak(format!("side {}", side.letter()));
            }
        });
    }

    fn act(&mut self, action: Action, session: &mut Session) {
        session.seal();
        match action {
            Action::Restore(name) => session.edit("Restore snapshot", &name, |document| {
                if let Some(snapshot) = document.snapshot(&name).cloned() {
                    document.restore(&snapshot);
                }
            }),
            Action::Replace(name) => {
                session.edit("Replace snapshot", &name, |document| document.replace_snapshot(&name));
            }
            Action::Show(name, side) => session.edit("Choose side", side.letter(), |document| {
                document.compare.side_mut(side).snapshot = Some(name);
            }),
            Action::StartRename(name) => self.renamed = Some(Renaming::new(name.clone(), &name)),
            Action::Rename(old, new) => {
                self.renamed = None;
                session.edit("Rename snapshot", &old, |document| document.rename_snapshot(&old, &new));
            }
            Action::Delete(name) => {
                session.edit("Delete snapshot", &name, |document| document.remove_snapshot(&name));
            }
        }
        session.seal();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::document;

    #[test]
    fn snapshots_are_restored_replaced_renamed_and_deleted_as_steps() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        let mut list = SnapshotList::default();
        session.edit("Take snapshot", "", |document| _ = document.add_snapshot("one"));
        session.edit("Exposure", "", |document| document.view.exposure_ev = 2.0);
        list.act(Action::Restore("one".into()), &mut session);
        assert_eq!(session.document().view.exposure_ev, 0.0);
        session.undo();
        list.act(Action::Replace("one".into()), &mut session);
        assert_eq!(session.document().snapshot("one").unwrap().view.exposure_ev, 2.0);
        list.act(Action::Show("one".into(), Side::B), &mut session);
        list.act(Action::Rename("one".into(), "bright".into()), &mut session);
        assert_eq!(session.document().compare.b.snapshot.as_deref(), Some("bright"));
        list.act(Action::Delete("bright".into()), &mut session);
        assert!(session.document().snapshots.is_empty());
        let labels = ["Delete snapshot", "Rename snapshot", "Choose side", "Replace snapshot", "Exposure"];
        for label in labels {
            assert_eq!(session.undo().as_deref(), Some(label));
        }
    }

    #[test]
    fn a_snapshot_that_is_restored_has_the_scene_of_its_time() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        session.edit("Take snapshot", "", |document| _ = document.add_snapshot("one"));
        let before = session.scene().materials[0].roughness;
        let value = burnish_core::param::ParamValue::Number(0.9);
        session.edit("Roughness", "", |document| _ = document.set_value(0, "roughness", value));
        assert_ne!(session.scene().materials[0].roughness, before);
        SnapshotList::default().act(Action::Restore("one".into()), &mut session);
        assert_eq!(session.scene().materials[0].roughness, before);
    }
}
