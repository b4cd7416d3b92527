//! What is done with lights: edits of the document with their labels, and where lights are about.

use std::sync::Arc;

use burnish_core::document::{LightEntry, LightingPreset, Shape};
use burnish_core::scene::Scene;
use glam::Vec3;

use super::session::Session;

/// An act on the selected lights, but for the first one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightAct {
    /// A new one.
    Add(Shape),
    /// A copy of each.
    Duplicate,
    /// None of them.
    Remove,
    /// To the other side of the subject along an axis.
    Mirror(usize),
    /// At the middle of the subject.
    Aim,
}

/// The model that the document is about, whose lights count until one is edited.
pub fn model(session: &Session) -> Arc<Scene> {
    let known = session.sources().models.get(&session.document().scene);
    known.cloned().unwrap_or_else(|| session.scene().clone())
}

/// The lights of the document.
pub fn entries(session: &Session) -> Vec<LightEntry> {
    session.document().light_entries(&model(session))
}

/// A light by its name.
pub fn entry(session: &Session, name: &str) -> Option<LightEntry> {
    session.document().light(&model(session), name)
}

/// Its radius in metres.
pub fn radius(session: &Session) -> f64 {
    let radius = f64::from(session.subject_bounds().radius());
    if radius > 0.0 && radius.is_finite() { radius } else { 1.0 }
}

/// Changes a light.
pub fn set(session: &mut Session, label: &str, name: &str, change: impl FnOnce(&mut LightEntry)) {
    let model = model(session);
    session.edit(label, name, |document| document.edit_light(&model, name, change));
}

/// Changes all lights of a group.
pub fn set_group(session: &mut Session, label: &str, group: &str, change: impl Fn(&mut LightEntry)) {
    let model = model(session);
    session.edit(label, group, |document| {
        document.edit_lights(&model, |lights| {
            lights.iter_mut().filter(|light| light.group == group).for_each(&change);
        });
    });
    session.seal();
}

/// Selects a light, or adds it to those that are selected, or takes it off.
pub fn select(session: &mut Session, name: &str, add: bool) {
    let lights = &mut session.selection.lights;
    match lights.iter().position(|known| known == name) {
        Some(place) if add => _ = lights.remove(place),
        None if add => lights.push(name.into()),
        _ => *lights = vec![name.into()],
    }
}

/// Does an act as one step.
pub fn act(session: &mut Session, act: LightAct) {
    session.seal();
    let (model, bounds) = (model(session), session.subject_bounds());
    let chosen = session.selection.lights.clone();
    let target = chosen.join(", ");
    let center: Vec3 = bounds.center();
    match act {
        LightAct::Add(shape) => {
            let mut name = String::new();
            session.edit("Add light", shape.title(), |document| name = document.add_light(&model, shape, bounds));
            session.selection.lights = vec![name];
        }
        LightAct::Duplicate => {
            let mut copies = Vec::new();
            session.edit("Duplicate light", &target, |document| {
                copies = chosen.iter().filter_map(|name| document.duplicate_light(&model, name)).collect();
            });
            session.selection.lights = copies;
        }
        LightAct::Remove => {
            session.edit("Delete light", &target, |document| document.remove_lights(&model, &chosen));
            session.selection.lights.clear();
        }
        LightAct::Mirror(axis) => each(session, "Mirror light", &chosen, |light| light.mirror(axis, center)),
        LightAct::Aim => each(session, "Aim light", &chosen, |light| light.aim(center)),
    }
    session.seal();
}

/// The lights of the session as a preset of a name.
pub fn preset(session: &Session, name: &str) -> LightingPreset {
    LightingPreset::of_document(name, session.document(), &model(session), session.subject_bounds())
}

/// Lights the subject by a preset, as one step.
pub fn apply(session: &mut Session, preset: &LightingPreset) {
    let subject = session.subject_bounds();
    session.seal();
    session.edit("Lighting preset", &preset.name, |document| document.apply_lighting(preset, subject));
    session.seal();
    session.selection.lights.clear();
}

fn each(session: &mut Session, label: &str, names: &[String], change: impl Fn(&mut LightEntry)) {
    let model = model(session);
    session.edit(label, &names.join(", "), |document| {
        names.iter().for_each(|name| document.edit_light(&model, name, &change));
    });
}

#[cfg(test)]
mod tests {
    use burnish_core::document;

    use super::*;

    #[test]
    fn acts_are_steps_with_labels_and_undo_takes_them_back() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        let before = entries(&session);
        act(&mut session, LightAct::Add(Shape::Rectangle { width: 0.2, height: 0.3 }));
        let name = session.selection.lights[0].clone();
        assert_eq!(entries(&session).len(), before.len() + 1);
        let placed = entry(&session, &name).unwrap();
        act(&mut session, LightAct::Mirror(0));
        let center = session.subject_bounds().center();
        assert!((entry(&session, &name).unwrap().place().x + placed.place().x - 2.0 * center.x).abs() < 1e-4);
        act(&mut session, LightAct::Duplicate);
        assert_ne!(session.selection.lights[0], name);
        act(&mut session, LightAct::Remove);
        assert!(session.selection.lights.is_empty());
        let labels: Vec<_> = session.history().past().iter().map(|step| step.label.clone()).collect();
        assert_eq!(labels, ["Add light", "Mirror light", "Duplicate light", "Delete light"]);
        for _ in 0..4 {
            session.undo();
        }
        assert_eq!(entries(&session), before);
        assert!(session.document().lights.is_none());
    }

    #[test]
    fn lights_of_a_group_are_switched_together() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        for shape in [Shape::Point, Shape::Sphere { radius: 0.1 }] {
            act(&mut session, LightAct::Add(shape));
            let name = session.selection.lights[0].clone();
            set(&mut session, "Group", &name, |light| light.group = "new".into());
        }
        set_group(&mut session, "Mute light", "new", |light| light.muted = true);
        assert_eq!(entries(&session).iter().filter(|light| light.muted).count(), 2);
        assert_eq!(session.scene().lights.len(), entries(&session).len() - 2);
    }
}
