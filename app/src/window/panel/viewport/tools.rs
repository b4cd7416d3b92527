//! What the left button does in the picture: handles on what is selected, and lights that are put by their effect.

use burnish_core::document::{TransformEntry, center_of};
use eframe::egui;
use glam::{Quat, Vec3};

use super::gizmo::{Change, Gizmo, Mode, Sight};
use crate::window::panel::Context;
use crate::window::session::Session;

/// A tool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Tool {
    /// Selects, and moves the camera.
    #[default]
    Select,
    /// Handles that move.
    Move,
    /// Handles that turn.
    Rotate,
    /// Handles that scale.
    Scale,
}

impl Tool {
    /// All of them, in the order of their buttons.
    pub const ALL: [Tool; 4] = [Tool::Select, Tool::Move, Tool::Rotate, Tool::Scale];

    /// On its button.
    pub fn title(self) -> &'static str {
        match self {
            Tool::Select => "Select",
            Tool::Move => "Move",
            Tool::Rotate => "Turn",
            Tool::Scale => "Scale",
        }
    }

    /// What it does.
    pub fn help(self) -> &'static str {
        match self {
            Tool::Select => "A click selects, a drag moves the camera.",
            Tool::Move => "Handles on what is selected move it; with Ctrl in steps.",
            Tool::Rotate => "Handles on what is selected turn it; with Ctrl by 15 degrees.",
            Tool::Scale => "Handles on what is selected scale it; with Ctrl in steps.",
        }
    }

    fn mode(self) -> Option<Mode> {
        match self {
            Tool::Select => None,
            Tool::Move => Some(Mode::Move),
            Tool::Rotate => Some(Mode::Rotate),
            Tool::Scale => Some(Mode::Scale),
        }
    }
}

/// The tool in use, with what a drag began from.
#[derive(Default)]
pub struct Tools {
    /// Which one.
    pub tool: Tool,
    gizmo: Gizmo,
    held: Held,
}

/// What is dragged, as it was before.
#[derive(Default)]
enum Held {
    #[default]
    Nothing,
    Objects(Vec<(String, TransformEntry)>),
}

impl Tools {
    /// Shows the handles of the tool on what is selected.
    pub fn ui(&mut self, ui: &mut egui::Ui, sight: &Sight, context: &mut Context<'_>) {
        let Some(mode) = self.tool.mode() else { return };
        let Some((at, name)) = selected_place(context.session) else { return };
        let moved = self.gizmo.ui(ui, sight, mode, at, &name);
        if moved.began {
            self.held = Held::of(context.session);
        }
        if let Some(change) = moved.change {
            self.held.apply(context.session, change);
        }
        if moved.ended {
            self.held = Held::Nothing;
            context.session.seal();
        }
    }
}

/// Where the handles stand, and what they hold in words.
fn selected_place(session: &Session) -> Option<(Vec3, String)> {
    let scene = session.scene();
    let keys = session.resolved().object_keys.iter().zip(&scene.instances);
    let chosen = keys.filter(|(key, _)| session.selection.objects.contains(key)).map(|(_, instance)| instance);
    let centers: Vec<Vec3> =
        chosen.clone().filter_map(|instance| Some(center_of(instance, scene.meshes.get(instance.mesh)?))).collect();
    let at = centers.iter().sum::<Vec3>() / centers.len().max(1) as f32;
    let name = chosen.map(|instance| instance.name.as_str()).next()?;
    Some((at, if centers.len() == 1 { name.into() } else { format!("{} objects", centers.len()) }))
}

impl Held {
    fn of(session: &Session) -> Held {
        let document = session.document();
        Held::Objects(session.selection.objects.iter().map(|key| (key.clone(), document.transform(key))).collect())
    }

    /// Changes what is held from how it was.
    fn apply(&self, session: &mut Session, change: Change) {
        match self {
            Held::Nothing => {}
            Held::Objects(objects) => {
                let label = match change {
                    Change::Move(_) => "Move object",
                    Change::Rotate(_) => "Turn object",
                    Change::Scale(_) => "Scale object",
                };
                session.edit(label, "", |document| {
                    for (key, before) in objects {
                        document.set_transform(key, changed(before, change));
                    }
                });
            }
        }
    }
}

/// A transform after a drag.
fn changed(before: &TransformEntry, change: Change) -> TransformEntry {
    let mut after = before.clone();
    match change {
        Change::Move(by) => {
            for (value, by) in after.by.iter_mut().zip(by.to_array()) {
                *value = tidy(*value + f64::from(by));
            }
        }
        Change::Rotate(by) => {
            let turned: Quat = by * before.rotation();
            after.set_rotation(turned);
            after.rotate_deg = after.rotate_deg.map(tidy);
        }
        Change::Scale(by) => {
            for (value, by) in after.scale.iter_mut().zip(by.to_array()) {
                *value = tidy(*value * f64::from(by));
            }
        }
    }
    after
}

/// Numbers that people read: a tenth of a millimetre, or of a thousandth of a degree, is enough.
fn tidy(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
