//! Commands that move the camera.

use burnish_core::document::{CameraEntry, VIEW_LABEL};
use burnish_core::scene::{Bounds, Instance};

use crate::window::commands::Command;
use crate::window::session::Session;

/// Does a command about the camera, for a picture of `aspect` (width by height).
pub fn command(command: Command, session: &mut Session, aspect: f32) {
    match command {
        Command::Frame => frame(session, true, aspect),
        Command::FrameAll => frame(session, false, aspect),
        Command::ViewFront => look(session, 0.0, 0.0),
        Command::ViewRight => look(session, 90.0, 0.0),
        Command::ViewTop => look(session, 0.0, 90.0),
        Command::Orthographic => move_camera(session, |camera| camera.orthographic = !camera.orthographic),
        Command::SaveCamera => session.edit("Save camera", "", |document| {
            let camera = document.view.camera.clone();
            document.save_camera("Camera", &camera);
        }),
        _ => {}
    }
}

/// Changes the camera as a part of the running movement.
pub fn move_camera(session: &mut Session, change: impl FnOnce(&mut CameraEntry)) {
    session.edit(VIEW_LABEL, "", |document| change(&mut document.view.camera));
}

fn look(session: &mut Session, yaw_deg: f64, pitch_deg: f64) {
    move_camera(session, |camera| {
        *camera = CameraEntry { yaw_deg, pitch_deg, roll_deg: 0.0, ..camera.clone() };
    });
}

/// Shows the selected objects, or all where none is selected or wanted.
fn frame(session: &mut Session, selected: bool, aspect: f32) {
    let chosen = selected && !session.selection.objects.is_empty();
    let bounds = bounds_of(session, |key, instance| match chosen {
        true => session.selection.objects.iter().any(|selected| selected == key),
        false => instance.visible,
    });
    if !bounds.is_empty() {
        move_camera(session, |camera| *camera = camera.framing(bounds, aspect));
    }
}

fn bounds_of(session: &Session, wanted: impl Fn(&str, &Instance) -> bool) -> Bounds {
    let scene = session.scene();
    let mut bounds = Bounds::EMPTY;
    for (key, instance) in session.resolved().object_keys.iter().zip(&scene.instances) {
        let Some(mesh) = scene.meshes.get(instance.mesh).filter(|_| wanted(key, instance)) else { continue };
        for position in &mesh.positions {
            bounds = bounds.including(instance.world_from_local.transform_point3(*position));
        }
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::document;

    fn session() -> Session {
        Session::new(document::open("gallery:workbench").unwrap(), None)
    }

    #[test]
    fn framing_the_selection_goes_nearer_than_framing_all() {
        let mut session = session();
        command(Command::FrameAll, &mut session, 1.5);
        let all = session.document().view.camera.clone();
        session.selection.objects = session.resolved().object_keys.iter().take(1).cloned().collect();
        command(Command::Frame, &mut session, 1.5);
        let one = session.document().view.camera.clone();
        assert!(one.distance <= all.distance && one != all);
        assert_eq!(one.yaw_deg, all.yaw_deg);
    }

    #[test]
    fn views_look_along_the_axes_and_a_run_of_them_is_one_step() {
        let mut session = session();
        let before = session.document().view.camera.clone();
        for (view, forward) in [
            (Command::ViewFront, glam::Vec3::NEG_Z),
            (Command::ViewRight, glam::Vec3::NEG_X),
            (Command::ViewTop, glam::Vec3::NEG_Y),
        ] {
            command(view, &mut session, 1.5);
            let camera = session.document().view.camera.camera();
            let looks = camera.world_from_view.transform_vector3(glam::Vec3::NEG_Z);
            assert!(looks.distance(forward) < 1e-5, "{view:?} looks along {looks}");
        }
        assert_eq!(session.undo().as_deref(), Some(VIEW_LABEL));
        assert_eq!(session.document().view.camera, before);
    }

    #[test]
    fn a_saved_camera_is_kept_under_a_name_of_its_own() {
        let mut session = session();
        command(Command::SaveCamera, &mut session, 1.5);
        command(Command::SaveCamera, &mut session, 1.5);
        let names: Vec<_> = session.document().cameras.iter().map(|camera| camera.name.clone()).collect();
        assert_eq!(names[names.len() - 2..], ["Camera".to_string(), "Camera 2".to_string()]);
    }
}
