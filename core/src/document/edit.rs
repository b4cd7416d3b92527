//! Edits of a document. None of them knows history: [`History::edit`](super::History::edit) wraps them.

use std::collections::BTreeSet;
use std::sync::Arc;

use serde_json::{Map, Value};

use super::{
    Assignment, CameraEntry, Document, MaterialEntry, ObjectEntry, PresetUse, SHARED_SETTINGS, TextureChoice,
    material_keys, role_key,
};
use crate::material::finish::Finish;
use crate::material::preset::{self, Preset};
use crate::material::saved::SavedMaterial;
use crate::material::{Material, TextureRole, params};
use crate::param::{self, ParamError, ParamSpec, ParamValue};
use crate::reference;
use crate::scene::Scene;

/// What [`Document::assign_preset`] does with the textures of the material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Assigned {
    /// The preset replaces the reflectance only; normals, occlusion, roughness and anisotropy stay.
    #[default]
    KeepTextures,
    /// All textures are cleared.
    ReplaceTextures,
}

impl Document {
    /// Gives every material of the model an entry. Entries stay where they are, also those whose source is gone.
    pub fn sync(&mut self, model: &Scene) {
        let known: BTreeSet<String> = self.materials.iter().filter_map(|entry| entry.source.clone()).collect();
        for key in material_keys(model) {
            if !known.contains(&key) {
                let name = self.free_name(if key.is_empty() { "material" } else { &key });
                let entry = MaterialEntry { name, source: Some(key), ..MaterialEntry::default() };
                self.materials.push(Arc::new(entry));
            }
        }
    }

    /// `name`, or `name 2`, `name 3` ... where it is taken by a material.
    pub fn free_name(&self, name: &str) -> String {
        free(name, |candidate| self.materials.iter().any(|entry| entry.name == candidate))
    }

    /// The material for editing.
    pub fn material_mut(&mut self, index: usize) -> Option<&mut MaterialEntry> {
        self.materials.get_mut(index).map(Arc::make_mut)
    }

    /// Puts a metal on a material. One that does not come with the program is stored in the document, under another
    /// id where its own means another metal already.
    pub fn assign_preset(&mut self, index: usize, metal: &Preset, textures: Assigned) {
        if index >= self.materials.len() {
            return;
        }
        let id = self.keep_metal(metal);
        let Some(entry) = self.material_mut(index) else { return };
        let kept = entry.preset.take().unwrap_or_default();
        entry.preset = Some(PresetUse { id, ..kept });
        entry.set_textures(textures);
    }

    /// Makes the document know a metal; returns the id that means it here. What other materials show stays the same.
    fn keep_metal(&mut self, metal: &Preset) -> String {
        if preset::library().iter().any(|known| known == metal) {
            // The document's own come first: one with the id of a metal of the program makes way.
            if self.presets.iter().any(|own| own.id == metal.id && **own != *metal) {
                self.rename_metal(&metal.id);
            }
            return metal.id.clone();
        }
        let alike = |own: &Preset| own.wavelength_nm == metal.wavelength_nm && own.n == metal.n && own.k == metal.k;
        if let Some(own) = self.presets.iter_mut().find(|own| own.id == metal.id && alike(own)) {
            *own = Arc::new(metal.clone());
            return metal.id.clone();
        }
        if self.metal(&metal.id).is_none() {
            self.presets.push(Arc::new(metal.clone()));
            return metal.id.clone();
        }
        // It may have come before, and got another id then.
        if let Some(own) = self.presets.iter().find(|own| own.name == metal.name && alike(own)) {
            return own.id.clone();
        }
        let id = self.free_metal_id(&metal.id);
        self.presets.push(Arc::new(Preset { id: id.clone(), ..metal.clone() }));
        id
    }

    /// Gives the document's own metal another id, which the materials that have it follow.
    fn rename_metal(&mut self, old: &str) {
        let new = self.free_metal_id(old);
        for own in self.presets.iter_mut().filter(|own| own.id == old) {
            Arc::make_mut(own).id = new.clone();
        }
        let has_it = |entry: &MaterialEntry| entry.preset.as_ref().is_some_and(|used| used.id == old);
        for entry in self.materials.iter_mut().filter(|entry| has_it(entry)) {
            if let Some(used) = &mut Arc::make_mut(entry).preset {
                used.id = new.clone();
            }
        }
    }

    /// The first of `id-2`, `id-3` ... that means no metal.
    fn free_metal_id(&self, id: &str) -> String {
        preset::numbered_id(id, |candidate| self.metal(candidate).is_some())
    }

    /// Makes a material like a saved one; `base` is what its factors start from, see
    /// [`Resolved::base`](super::Resolved::base).
    pub fn assign_saved(&mut self, index: usize, saved: &SavedMaterial, base: &Material, textures: Assigned) {
        let Some(entry) = self.material_mut(index) else { return };
        entry.preset = None;
        entry.values.clear();
        for spec in params::PARAMS {
            if let Some(value) = saved.value(spec.key) {
                entry.set(spec, value, base);
            }
        }
        entry.set_textures(textures);
        if let Some(metal) = saved.constants() {
            self.assign_preset(index, metal, Assigned::KeepTextures);
            self.set_fresnel(index, saved.metal.as_ref().and_then(|metal| metal.fresnel.as_deref()));
        }
    }

    /// Puts a finish or a coat on a material: all factors that one of its kind sets, so that nothing is left of the one
    /// before. `base` is as for [`Document::assign_saved`].
    pub fn assign_finish(&mut self, index: usize, finish: &Finish, base: &Material) {
        let Some(entry) = self.material_mut(index) else { return };
        for (key, value) in finish.values() {
            if let Ok(spec) = param::find(params::PARAMS, key) {
                entry.set(spec, value, base);
            }
        }
    }

    /// A metal in use by its id: the document's own, else that of the program.
    pub fn metal(&self, id: &str) -> Option<&Preset> {
        let own = self.presets.iter().map(Arc::as_ref).find(|metal| metal.id == id);
        own.or_else(|| preset::library().iter().find(|metal| metal.id == id))
    }

    /// Takes the metal off: the base colour counts again.
    pub fn clear_preset(&mut self, index: usize) {
        if let Some(entry) = self.material_mut(index) {
            entry.preset = None;
        }
    }

    /// Sets the Fresnel form of the metal of a material; `None` follows the lighting settings.
    pub fn set_fresnel(&mut self, index: usize, form: Option<&str>) {
        if let Some(preset) = self.material_mut(index).and_then(|entry| entry.preset.as_mut()) {
            preset.fresnel = form.map(Into::into);
        }
    }

    /// Sets a factor of a material; one of the wrong kind or out of range is refused.
    pub fn set_value(&mut self, index: usize, key: &str, value: ParamValue) -> Result<(), ParamError> {
        let spec = param::find(params::PARAMS, key)?;
        let json = spec.json(value);
        spec.from_json(&json)?;
        if let Some(entry) = self.material_mut(index) {
            entry.values.insert(spec.key.into(), json);
        }
        Ok(())
    }

    /// Gives a factor back to the source of the material.
    pub fn reset_value(&mut self, index: usize, key: &str) {
        if let Some(entry) = self.material_mut(index) {
            entry.values.remove(key);
        }
    }

    /// Puts something into a texture slot; `None` gives it back to the model.
    pub fn set_texture(&mut self, index: usize, role: TextureRole, choice: Option<TextureChoice>) {
        let Some(entry) = self.material_mut(index) else { return };
        match choice {
            Some(choice) => _ = entry.textures.insert(role_key(role), choice),
            None => _ = entry.textures.remove(&role_key(role)),
        }
    }

    /// Takes an environment from another file, in snapshots too.
    pub fn replace_map(&mut self, old: &str, new: &str) {
        let replace = |source: &mut Option<String>| {
            if source.as_deref() == Some(old) {
                *source = Some(new.into());
            }
        };
        replace(&mut self.environment.source);
        for snapshot in self.snapshots.iter_mut().filter(|s| s.environment.source.as_deref() == Some(old)) {
            replace(&mut Arc::make_mut(snapshot).environment.source);
        }
    }

    /// Lets every slot with a picture from one file have it from another, in snapshots too.
    pub fn replace_texture_file(&mut self, old: &str, new: &str) {
        let replace = |materials: &mut Vec<Arc<MaterialEntry>>| {
            let has_it = |entry: &MaterialEntry| entry.textures.values().any(|c| *c == TextureChoice::File(old.into()));
            for entry in materials.iter_mut().filter(|entry| has_it(entry)) {
                let choices = Arc::make_mut(entry).textures.values_mut();
                for choice in choices.filter(|choice| **choice == TextureChoice::File(old.into())) {
                    *choice = TextureChoice::File(new.into());
                }
            }
        };
        replace(&mut self.materials);
        for snapshot in &mut self.snapshots {
            replace(&mut Arc::make_mut(snapshot).materials);
        }
    }

    /// Adds a material that starts from the default one; returns its index.
    pub fn add_material(&mut self, name: &str) -> usize {
        let name = self.free_name(name);
        self.materials.push(Arc::new(MaterialEntry { name, ..MaterialEntry::default() }));
        self.materials.len() - 1
    }

    /// Adds a copy of a material; returns its index.
    pub fn duplicate_material(&mut self, index: usize) -> Option<usize> {
        let copied = MaterialEntry::clone(self.materials.get(index)?);
        let name = self.free_name(&copied.name);
        self.materials.push(Arc::new(MaterialEntry { name, ..copied }));
        Some(self.materials.len() - 1)
    }

    /// True for a material that no object was given and that is not the only one from its source.
    pub fn can_remove_material(&self, index: usize) -> bool {
        let Some(entry) = self.materials.get(index) else { return false };
        let assigned = self.assignments.iter().any(|a| a.material == entry.name);
        let first =
            entry.source.is_some() && self.materials.iter().position(|e| e.source == entry.source) == Some(index);
        !assigned && !first
    }

    /// Removes a material where [`Document::can_remove_material`] allows it.
    pub fn remove_material(&mut self, index: usize) -> bool {
        let allowed = self.can_remove_material(index);
        if allowed {
            self.materials.remove(index);
        }
        allowed
    }

    /// Renames a material and what refers to it; a name that is taken gets a number.
    pub fn rename_material(&mut self, index: usize, name: &str) {
        let Some(old) = self.materials.get(index).map(|entry| entry.name.clone()) else { return };
        if name.is_empty() || name == old {
            return;
        }
        let name = self.free_name(name);
        for assignment in self.assignments.iter_mut().filter(|a| a.material == old) {
            assignment.material = name.clone();
        }
        if let Some(entry) = self.material_mut(index) {
            entry.name = name;
        }
    }

    /// Makes a material look like another: everything but its name and source.
    pub fn paste_material(&mut self, index: usize, copied: &MaterialEntry) {
        if let Some(entry) = self.material_mut(index) {
            let (name, source) = (entry.name.clone(), entry.source.clone());
            *entry = MaterialEntry { name, source, ..copied.clone() };
        }
    }

    /// Gives objects a material.
    pub fn assign_material(&mut self, objects: &[String], material: &str) {
        self.assignments.retain(|assignment| !objects.contains(&assignment.object));
        self.assignments.extend(objects.iter().map(|object| Assignment {
            object: object.clone(),
            material: material.into(),
            other: Default::default(),
        }));
    }

    /// Changes what is stored about an object; an entry that says nothing is dropped.
    pub fn edit_object(&mut self, key: &str, change: impl FnOnce(&mut ObjectEntry)) {
        let mut entry = self.objects.iter().find(|entry| entry.key == key).cloned().unwrap_or_default();
        entry.key = key.into();
        change(&mut entry);
        let empty = ObjectEntry { key: key.into(), ..ObjectEntry::default() };
        let place = self.objects.iter().position(|entry| entry.key == key);
        match (place, entry == empty) {
            (Some(place), true) => _ = self.objects.remove(place),
            (Some(place), false) => self.objects[place] = entry,
            (None, true) => {}
            (None, false) => self.objects.push(entry),
        }
    }

    /// Hides all objects but some.
    pub fn isolate(&mut self, all: &[String], kept: &[String]) {
        for key in all {
            self.edit_object(key, |entry| entry.hidden = !kept.contains(key));
        }
    }

    /// Shows all objects.
    pub fn show_all(&mut self) {
        let keys: Vec<String> = self.objects.iter().map(|entry| entry.key.clone()).collect();
        for key in keys {
            self.edit_object(&key, |entry| entry.hidden = false);
        }
    }

    /// Saves a point of view under a name that is free; returns the name.
    pub fn save_camera(&mut self, name: &str, camera: &CameraEntry) -> String {
        let name = free(name, |candidate| self.cameras.iter().any(|camera| camera.name == candidate));
        self.cameras.push(CameraEntry { name: name.clone(), ..camera.clone() });
        name
    }

    /// Renames a saved camera; a name that is taken gets a number.
    pub fn rename_camera(&mut self, place: usize, name: &str) {
        let taken = |candidate: &str| {
            self.cameras.iter().enumerate().any(|(other, camera)| other != place && camera.name == candidate)
        };
        if name.is_empty() {
            return;
        }
        let name = free(name, taken);
        if let Some(camera) = self.cameras.get_mut(place) {
            camera.name = name;
        }
    }

    /// Sets a setting of the lighting method; the default is not stored.
    pub fn set_lighting(&mut self, key: &str, value: ParamValue) -> Result<(), ParamError> {
        let spec = param::find(self.lighting.live_method().info().params, key)?;
        store(spec, &mut self.lighting.settings, value)
    }

    /// Sets a setting of the reference, see [`Document::set_lighting`]; a shared one is set for the method as well.
    pub fn set_reference(&mut self, key: &str, value: ParamValue) -> Result<(), ParamError> {
        if SHARED_SETTINGS.contains(&key) {
            return self.set_lighting(key, value);
        }
        store(param::find(reference::PARAMS, key)?, &mut self.lighting.reference, value)
    }
}

/// Keeps a value unless it is the default.
pub(super) fn store(spec: &ParamSpec, stored: &mut Map<String, Value>, value: ParamValue) -> Result<(), ParamError> {
    let json = spec.json(value);
    if spec.from_json(&json)? == spec.default() {
        stored.remove(spec.key);
    } else {
        stored.insert(spec.key.into(), json);
    }
    Ok(())
}

impl MaterialEntry {
    /// Stores a factor; one that `base` has already is not stored.
    fn set(&mut self, spec: &ParamSpec, value: ParamValue, base: &Material) {
        if params::get(base, spec.key) == Some(value) {
            self.values.remove(spec.key);
        } else {
            self.values.insert(spec.key.into(), spec.json(value));
        }
    }

    /// Clears all textures where they are to be replaced.
    fn set_textures(&mut self, textures: Assigned) {
        if textures == Assigned::ReplaceTextures {
            self.textures = TextureRole::ALL.into_iter().map(|role| (role_key(role), TextureChoice::None)).collect();
        }
    }
}

/// The first of `name`, `name 2`, `name 3` ... that is not taken.
pub fn free(name: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(name) {
        return name.into();
    }
    (2u64..).map(|number| format!("{name} {number}")).find(|candidate| !taken(candidate)).unwrap_or_default()
}
