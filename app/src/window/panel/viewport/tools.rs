//! What the left button does in the picture: handles on what is selected, and lights that are put by their effect.

use std::sync::Arc;

use burnish_core::document::{LightEntry, Shape, TransformEntry};
use burnish_core::scene::Scene;
use eframe::egui::{self, Pos2, Vec2};
use glam::{Quat, Vec3};

use super::gizmo::{Change, Gizmo, Mode, Sight};
use super::{lamps, probes};
use crate::window::lights;
use crate::window::panel::Context;
use crate::window::session::Session;

/// Degrees that a light goes around its subject for each point of a drag.
const ORBIT_DEG: f64 = 0.4;

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
    /// Puts the highlight of a light.
    Highlight,
    /// Puts the shadow that a light throws.
    Shadow,
    /// Leads a light around the subject.
    Orbit,
}

impl Tool {
    /// All of them, in the order of their buttons.
    pub const ALL: [Tool; 7] =
        [Tool::Select, Tool::Move, Tool::Rotate, Tool::Scale, Tool::Highlight, Tool::Shadow, Tool::Orbit];

    /// On its button.
    pub fn title(self) -> &'static str {
        match self {
            Tool::Select => "Select",
            Tool::Move => "Move",
            Tool::Rotate => "Turn",
            Tool::Scale => "Scale",
            Tool::Highlight => "Highlight",
            Tool::Shadow => "Shadow",
            Tool::Orbit => "Orbit",
        }
    }

    /// What it does.
    pub fn help(self) -> &'static str {
        match self {
            Tool::Select => "A click selects, a drag moves the camera.",
            Tool::Move => "Handles on what is selected move it; with Ctrl in steps.",
            Tool::Rotate => "Handles on what is selected turn it; with Ctrl by 15 degrees.",
            Tool::Scale => "Handles on what is selected scale it; with Ctrl in steps.",
            Tool::Highlight => {
                "Drag over a surface: the selected light moves so that its highlight is under the pointer."
            }
            Tool::Shadow => {
                "Drag over a surface: the selected light moves so that the subject's shadow falls under the pointer."
            }
            Tool::Orbit => "Drag: the selected light goes around the subject.",
        }
    }

    /// Drags in the picture put the selected light.
    pub fn places_light(self) -> bool {
        matches!(self, Tool::Highlight | Tool::Shadow | Tool::Orbit)
    }

    fn mode(self) -> Option<Mode> {
        match self {
            Tool::Select | Tool::Highlight | Tool::Shadow | Tool::Orbit => None,
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
    middle: Option<Middle>,
}

/// What is dragged, as it was before.
#[derive(Default)]
enum Held {
    #[default]
    Nothing,
    Objects(Vec<(String, TransformEntry)>),
    Lights(Vec<LightEntry>),
}

impl Tools {
    /// Shows the lights, and the handles of the tool on what is selected.
    pub fn ui(&mut self, ui: &mut egui::Ui, sight: &Sight, context: &mut Context<'_>) {
        lamps::ui(ui, sight, context.session);
        let prepared = context.preparations.prepared(context.session.layers());
        let prepared = prepared.as_ref().and_then(|prepared| prepared.first());
        probes::ui(ui, sight, context.session, &context.aids.probes, prepared.map(Arc::as_ref));
        let Some(mode) = self.tool.mode() else { return };
        let Some((at, name)) = self.selected_place(context.session) else { return };
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

impl Tools {
    /// Puts the selected light by a drag that is at a point of the picture and moved by so many points. Says what is in
    /// the way.
    pub fn place_light(&self, session: &mut Session, sight: &Sight, at: Pos2, by: Vec2) -> Result<(), &'static str> {
        let Some(name) = session.selection.lights.first().cloned() else {
            return Err("Select a light first, in the Lights panel or by its mark in the picture.");
        };
        let center = session.subject_bounds().center();
        if self.tool == Tool::Orbit {
            let (yaw, pitch) = (f64::from(by.x) * ORBIT_DEG, f64::from(-by.y) * ORBIT_DEG);
            lights::set(session, "Orbit light", &name, |light| light.orbit(center, yaw, pitch));
            return Ok(());
        }
        let ray = sight.ray(at);
        // Beside all surfaces nothing changes: the hand may come back.
        let Some(picked) = session.scene().pick(ray) else { return Ok(()) };
        match self.tool {
            Tool::Highlight => lights::set(session, "Place highlight", &name, |light| {
                light.put_highlight(picked.position, picked.normal, -ray.direction);
            }),
            Tool::Shadow => lights::set(session, "Place shadow", &name, |light| {
                light.put_shadow(picked.position, center);
            }),
            _ => {}
        }
        Ok(())
    }
}

/// Selected objects of a scene with their middle, which is measured once: that visits every vertex.
struct Middle {
    scene: Arc<Scene>,
    objects: Vec<String>,
    at: Vec3,
    name: String,
}

impl Middle {
    /// `None` where no object is selected.
    fn of(session: &Session) -> Option<Middle> {
        let (scene, objects) = (session.scene().clone(), session.selection.objects.clone());
        let keys = session.resolved().object_keys.iter().zip(&scene.instances);
        let chosen: Vec<_> = keys.filter(|(key, _)| objects.contains(key)).map(|(_, instance)| instance).collect();
        let centers =
            chosen.iter().filter_map(|instance| Some(instance.bounds(scene.meshes.get(instance.mesh)?).center()));
        let centers: Vec<Vec3> = centers.collect();
        let at = centers.iter().sum::<Vec3>() / centers.len().max(1) as f32;
        let first = chosen.first()?.name.clone();
        let name = if centers.len() == 1 { first } else { format!("{} objects", centers.len()) };
        Some(Middle { scene: scene.clone(), objects, at, name })
    }

    fn is_of(&self, session: &Session) -> bool {
        Arc::ptr_eq(&self.scene, session.scene()) && self.objects == session.selection.objects
    }
}

impl Tools {
    /// Where the handles stand, and what they hold in words. A selected light comes before objects.
    fn selected_place(&mut self, session: &Session) -> Option<(Vec3, String)> {
        if let Some(name) = session.selection.lights.first() {
            return Some((lights::entry(session, name)?.place(), name.clone()));
        }
        if self.middle.as_ref().is_none_or(|middle| !middle.is_of(session)) {
            self.middle = Middle::of(session);
        }
        self.middle.as_ref().map(|middle| (middle.at, middle.name.clone()))
    }
}

impl Held {
    fn of(session: &Session) -> Held {
        if !session.selection.lights.is_empty() {
            let chosen = |light: &LightEntry| session.selection.lights.contains(&light.name);
            return Held::Lights(lights::entries(session).into_iter().filter(chosen).collect());
        }
        let document = session.document();
        Held::Objects(session.selection.objects.iter().map(|key| (key.clone(), document.transform(key))).collect())
    }

    /// Changes what is held from how it was.
    fn apply(&self, session: &mut Session, change: Change) {
        match self {
            Held::Nothing => {}
            Held::Lights(before) => {
                let label = match change {
                    Change::Move(_) => "Move light",
                    Change::Rotate(_) => "Turn light",
                    Change::Scale(_) => "Scale light",
                };
                let model = lights::model(session);
                session.edit(label, "", |document| {
                    for light in before {
                        let after = changed_light(light, change);
                        document.edit_light(&model, &light.name, |light| *light = after);
                    }
                });
            }
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

/// A light after a drag.
fn changed_light(before: &LightEntry, change: Change) -> LightEntry {
    let mut after = before.clone();
    match change {
        Change::Move(by) => {
            for (value, by) in after.position.iter_mut().zip(by.to_array()) {
                *value = tidy(*value + f64::from(by));
            }
        }
        Change::Rotate(by) => after.turn(by),
        // Width along its x, height along its y; what has one size follows the largest change.
        Change::Scale(by) => {
            let farthest = by.to_array().into_iter().max_by(|a, b| a.ln().abs().total_cmp(&b.ln().abs()));
            let factor = f64::from(farthest.unwrap_or(1.0));
            after.shape = match after.shape {
                Shape::Rectangle { width, height } => {
                    let local = after.rotation().inverse();
                    let along = |axis: Vec3| {
                        let share: Vec3 = (local.inverse() * axis).abs();
                        f64::from(share.dot(by) / share.element_sum().max(1e-6))
                    };
                    Shape::Rectangle { width: tidy(width * along(Vec3::X)), height: tidy(height * along(Vec3::Y)) }
                }
                other => other.scaled(factor),
            };
        }
    }
    after
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
