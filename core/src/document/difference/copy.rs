//! How a state takes over from another what differs in a place.

use std::sync::Arc;

use serde_json::Value;

use super::{Part, Place};
use crate::document::{Assigned, Assignment, Document, EnvironmentEntry, Side, Snapshot};

impl Document {
    /// Lets a side take over what another state has in a place. The document itself changes where the side shows it as it
    /// is now, else the snapshot of the side.
    pub fn copy_to_side(&mut self, side: Side, place: &Place, from: &Document) {
        let Some(snapshot) = self.snapshot_of(side).cloned() else { return self.copy_place(place, from) };
        let mut state = self.clone();
        state.restore(&snapshot);
        state.copy_place(place, from);
        let changed = Snapshot { other: snapshot.other.clone(), ..state.state(&snapshot.name) };
        if let Some(own) = self.snapshots.iter_mut().find(|own| own.name == snapshot.name) {
            *own = Arc::new(changed);
        }
    }

    /// Takes over what another state has in a place.
    fn copy_place(&mut self, place: &Place, from: &Document) {
        let setting = |to: &mut serde_json::Map<String, Value>, of: &serde_json::Map<String, Value>, key: &str| match of
            .get(key)
        {
            Some(value) => _ = to.insert(key.into(), value.clone()),
            None => _ = to.remove(key),
        };
        match place {
            Place::Material(name, part) => self.copy_part(name, part, from),
            Place::Assignment(object) => {
                let new: Option<&Assignment> = from.assignments.iter().find(|a| a.object == *object);
                self.assignments.retain(|assignment| assignment.object != *object);
                self.assignments.extend(new.cloned());
            }
            Place::Object(key) => {
                let new = from.objects.iter().find(|entry| entry.key == *key).cloned();
                self.objects.retain(|entry| entry.key != *key);
                self.objects.extend(new);
            }
            Place::Light(name) => self.copy_light(name, from),
            Place::Probe(name) => {
                let new = from.probe(name).cloned();
                match (self.probe_mut(name), new) {
                    (Some(own), Some(new)) => *own = new,
                    (None, Some(new)) => self.probes.push(new),
                    (_, None) => self.remove_probe(name),
                }
            }
            Place::Map => self.environment.source.clone_from(&from.environment.source),
            Place::Rotation => self.environment.rotation_deg = from.environment.rotation_deg,
            Place::Strength => self.environment.strength = from.environment.strength,
            Place::Tint => self.environment.tint = from.environment.tint,
            Place::Made => self.environment.made.clone_from(&from.environment.made),
            Place::Background => {
                let (to, from) = (&mut self.environment, &from.environment);
                to.background.clone_from(&from.background);
                to.background_blur_deg = from.background_blur_deg;
                to.ground.clone_from(&from.ground);
            }
            Place::Sun => {
                let EnvironmentEntry { sun_split, sun_strength, .. } = from.environment;
                (self.environment.sun_split, self.environment.sun_strength) = (sun_split, sun_strength);
            }
            Place::Method => self.lighting.choose(&from.lighting.method),
            Place::Lighting(key) => setting(&mut self.lighting.settings, &from.lighting.settings, key),
            Place::Override(key) => match from.lighting.overrides.get(key) {
                Some(entry) => _ = self.lighting.overrides.insert(key.clone(), entry.clone()),
                None => _ = self.lighting.overrides.remove(key),
            },
            Place::Reference(key) => setting(&mut self.lighting.reference, &from.lighting.reference, key),
            Place::Camera => self.view.camera = from.view.camera.clone(),
            Place::Exposure => self.view.exposure_ev = from.view.exposure_ev,
            Place::Tone => self.view.tone.clone_from(&from.view.tone),
        }
    }

    /// Takes over a light, all of them where only one of the states has lights of its own.
    fn copy_light(&mut self, name: &str, from: &Document) {
        let (Some(own), Some(theirs)) = (&mut self.lights, &from.lights) else {
            return self.lights.clone_from(&from.lights);
        };
        let new = theirs.iter().find(|light| light.name == name);
        match (own.iter().position(|light| light.name == name), new) {
            (Some(place), Some(new)) => own[place] = new.clone(),
            (Some(place), None) => _ = own.remove(place),
            (None, Some(new)) => own.push(new.clone()),
            (None, None) => {}
        }
    }

    fn copy_part(&mut self, name: &str, part: &Part, from: &Document) {
        let source = from.materials.iter().find(|entry| entry.name == name);
        let index = self.materials.iter().position(|entry| entry.name == name);
        let (Some(source), Some(index)) = (source, index) else {
            // Only one of them has it.
            match (source, index) {
                (Some(source), None) => self.materials.push(source.clone()),
                (None, Some(index)) => _ = self.remove_material(index),
                _ => {}
            }
            return;
        };
        let used = source.preset.as_ref();
        match (part, used.and_then(|used| from.metal(&used.id))) {
            (Part::Metal, Some(metal)) => self.assign_preset(index, metal, Assigned::KeepTextures),
            (Part::Metal, None) => {
                if let Some(entry) = self.material_mut(index) {
                    entry.preset = used.cloned();
                }
            }
            (Part::Form, _) => self.set_fresnel(index, used.and_then(|used| used.fresnel.as_deref())),
            (Part::Factor(key), _) => {
                let Some(entry) = self.material_mut(index) else { return };
                match source.values.get(key) {
                    Some(value) => _ = entry.values.insert(key.clone(), value.clone()),
                    None => _ = entry.values.remove(key),
                }
            }
            (Part::Texture(role), _) => {
                let Some(entry) = self.material_mut(index) else { return };
                match source.textures.get(role) {
                    Some(choice) => _ = entry.textures.insert(role.clone(), choice.clone()),
                    None => _ = entry.textures.remove(role),
                }
            }
            (Part::Whole, _) => {}
        }
    }
}
