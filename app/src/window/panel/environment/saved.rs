//! Saved points of view, and those of the model.

use burnish_core::document::{CameraEntry, VIEW_LABEL};
use eframe::egui;

use super::Context;
use crate::window::commands::Command;
use crate::window::rename::{Renaming, Typed, rename_ui};
use crate::window::request::Request;
use crate::window::session::Session;

/// The list of cameras.
#[derive(Default)]
pub struct SavedSection {
    /// The camera that is being renamed, by its place.
    renamed: Option<Renaming<usize>>,
}

/// What was clicked in the list.
enum Action {
    Recall(CameraEntry),
    Replace(usize),
    StartRename(usize),
    Rename(usize, String),
    Delete(usize),
}

impl SavedSection {
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        if ui.button("Save camera").on_hover_text("Keep this point of view under a name.").clicked() {
            context.requests.push(Request::Command(Command::SaveCamera));
        }
        let document = context.session.document().clone();
        if document.cameras.is_empty() {
            ui.weak("No saved cameras");
        }
        let mut action = None;
        for (place, camera) in document.cameras.iter().enumerate() {
            self.camera_ui(ui, place, camera, &mut action);
        }
        model_cameras_ui(ui, context.session, &mut action);
        if let Some(action) = action {
            self.act(action, context.session);
        }
    }

    fn camera_ui(&mut self, ui: &mut egui::Ui, place: usize, camera: &CameraEntry, action: &mut Option<Action>) {
        match rename_ui(ui, &mut self.renamed, &place, "Name of the camera") {
            Typed::Elsewhere => {}
            Typed::Typing => return,
            Typed::Done(name) => {
                *action = Some(Action::Rename(place, name));
                return;
            }
        }
        ui.horizontal(|ui| {
            let name = &camera.name;
            if ui.button(name).on_hover_text("Look from here.").clicked() {
                *action = Some(Action::Recall(camera.clone()));
            }
            ui.menu_button("...", |ui| {
                if ui.button("Replace by this view").clicked() {
                    *action = Some(Action::Replace(place));
                }
                if ui.button("Rename").clicked() {
                    *action = Some(Action::StartRename(place));
                }
                if ui.button("Delete").clicked() {
                    *action = Some(Action::Delete(place));
                }
            })
            .response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Change camera {name}")));
        });
    }

    fn act(&mut self, action: Action, session: &mut Session) {
        match action {
            Action::Recall(camera) => session.edit(VIEW_LABEL, "", |document| {
                document.view.camera = CameraEntry { name: String::new(), ..camera };
            }),
            Action::Replace(place) => session.edit("Replace camera", "", |document| {
                let view = document.view.camera.clone();
                if let Some(camera) = document.cameras.get_mut(place) {
                    *camera = CameraEntry { name: camera.name.clone(), ..view };
                }
            }),
            Action::StartRename(place) => {
                self.renamed = session.document().cameras.get(place).map(|camera| Renaming::new(place, &camera.name));
            }
            Action::Rename(place, name) => {
                self.renamed = None;
                session.edit("Rename camera", "", |document| document.rename_camera(place, &name));
            }
            Action::Delete(place) => session.edit("Delete camera", "", |document| {
                if place < document.cameras.len() {
                    document.cameras.remove(place);
                }
            }),
        }
    }
}

/// The cameras that came with the model.
fn model_cameras_ui(ui: &mut egui::Ui, session: &Session, action: &mut Option<Action>) {
    let cameras = &session.scene().cameras;
    if cameras.is_empty() {
        return;
    }
    ui.weak("Cameras of the model");
    ui.horizontal_wrapped(|ui| {
        for (place, camera) in cameras.iter().enumerate() {
            let name = if camera.name.is_empty() { format!("camera {}", place + 1) } else { camera.name.clone() };
            if ui.button(name).on_hover_text("Look from where the model says.").clicked() {
                *action = Some(Action::Recall(CameraEntry::from_camera(camera, session.scene().bounds())));
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::document;

    #[test]
    fn cameras_are_recalled_replaced_renamed_and_deleted_as_steps() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        let mut section = SavedSection::default();
        let start = session.document().cameras.len();
        session.edit("Save camera", "", |document| {
            let camera = document.view.camera.clone();
            document.save_camera("Camera", &camera);
            document.save_camera("Camera", &camera);
        });
        let saved = session.document().cameras[start].clone();
        session.edit(VIEW_LABEL, "", |document| document.view.camera.orbit(30.0, 0.0));
        section.act(Action::Recall(saved.clone()), &mut session);
        assert_eq!(session.document().view.camera.yaw_deg, saved.yaw_deg);
        assert_eq!(session.document().view.camera.name, "");
        section.act(Action::Rename(start + 1, "Camera".into()), &mut session);
        assert_eq!(session.document().cameras[start + 1].name, "Camera 2", "a name that is taken gets a number");
        section.act(Action::Rename(start + 1, "Top".into()), &mut session);
        section.act(Action::Delete(start), &mut session);
        section.act(Action::Delete(99), &mut session);
        assert_eq!(session.document().cameras.len(), start + 1);
        assert_eq!(session.document().cameras[start].name, "Top");
        assert_eq!(session.undo().as_deref(), Some("Delete camera"));
    }
}
