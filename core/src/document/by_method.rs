//! The choice of a lighting method, of others for some objects, and the document as a method with certain settings shows
//! it, as a side of the comparison.

use std::collections::HashMap;
use std::sync::Arc;

use serde_json::Map;

use super::edit::store;
use super::{Document, LightingEntry, OverrideEntry, SHARED_SETTINGS, Side, read_settings};
use crate::lighting::{self, Layer, Layers, Method, MethodId};
use crate::param::{self, ParamError, ParamSpec, ParamValue, Settings};
use crate::reference;

impl LightingEntry {
    /// Chooses a live method; the settings of the former wait until it is chosen again.
    pub fn choose(&mut self, id: &str) {
        if self.method == id {
            return;
        }
        let settings = self.other_settings.remove(id).unwrap_or_default();
        let former = std::mem::replace(&mut self.settings, settings);
        let method = std::mem::replace(&mut self.method, id.into());
        if !former.is_empty() {
            self.other_settings.insert(method, former);
        }
    }

    /// The same with these settings of a method. A picture of the reference refines by itself: the number of its samples
    /// is no setting of a document.
    pub fn by(&self, method: MethodId, settings: &Settings) -> LightingEntry {
        let mut entry = self.clone();
        let is_reference = method.0 == reference::ID;
        if !is_reference {
            entry.choose(method.0);
        }
        for (spec, value) in settings.iter() {
            let of_reference = is_reference && !SHARED_SETTINGS.contains(&spec.key);
            if of_reference && param::find(reference::PARAMS, spec.key).is_err() {
                continue;
            }
            let stored = if of_reference { &mut entry.reference } else { &mut entry.settings };
            // The value is one that the setting accepted.
            let _ = store(spec, stored, value);
        }
        entry
    }
}

impl LightingEntry {
    /// Lets another method light an object, by its key; `None` leaves it to the method of the scene.
    pub fn override_object(&mut self, key: &str, method: Option<&str>) {
        match method {
            None => _ = self.overrides.remove(key),
            Some(id) if self.overrides.get(key).is_some_and(|entry| entry.method == id) => {}
            Some(id) => {
                let entry = OverrideEntry { method: id.into(), settings: Map::new(), other: Map::new() };
                self.overrides.insert(key.into(), entry);
            }
        }
    }

    /// What lights the objects, of which `object_keys` has the keys in the order of the scene's instances. Overrides of
    /// unknown objects, and by methods that this version cannot mix in, count as none.
    pub fn layers(&self, object_keys: &[String]) -> Layers {
        let layers = Layers::of(self.live_method(), self.settings());
        if self.overrides.is_empty() {
            return layers;
        }
        let places: HashMap<&str, usize> =
            object_keys.iter().zip(0..).map(|(key, place)| (key.as_str(), place)).collect();
        // Objects of one kind share a layer.
        let mut others: Vec<(&OverrideEntry, Layer)> = Vec::new();
        for (key, entry) in &self.overrides {
            let Some(&instance) = places.get(key.as_str()) else { continue };
            if let Some((_, layer)) = others.iter_mut().find(|(known, _)| known.is_like(entry)) {
                layer.instances.push(instance);
            } else if let Some(method) = entry.mixed_method() {
                others.push((entry, Layer { method, settings: entry.settings(), instances: vec![instance] }));
            }
        }
        others.into_iter().fold(layers, |layers, (_, layer)| layers.with(layer))
    }

    /// The settings of the world that [`LightingEntry::layers`] are drawn in: those of the reference where it lights an
    /// object, else those of the method.
    pub fn world_settings(&self) -> Settings {
        let by_paths = self.overrides.values().any(|entry| entry.method == reference::ID);
        if by_paths { self.reference_settings() } else { self.settings() }
    }
}

impl OverrideEntry {
    /// The same light: method and settings are equal.
    fn is_like(&self, other: &OverrideEntry) -> bool {
        self.method == other.method && self.settings == other.settings
    }

    /// The method, if it can light single objects: it draws on the processor.
    pub fn mixed_method(&self) -> Option<&'static dyn Method> {
        lighting::find(&self.method).filter(|method| method.is_on_processor())
    }

    /// The settings that count for one object: not those of the whole scene.
    pub fn specs(&self) -> impl Iterator<Item = &'static ParamSpec> + use<> {
        let method = self.mixed_method().filter(|method| method.info().id.0 != reference::ID);
        let params = method.map_or(&[][..], |method| method.info().params);
        params.iter().filter(|spec| !SHARED_SETTINGS.contains(&spec.key) && !spec.key.starts_with("fresnel"))
    }

    /// Settings of the method, defaults where nothing or nonsense is stored.
    pub fn settings(&self) -> Settings {
        read_settings(self.mixed_method().map_or(&[], |method| method.info().params), &self.settings)
    }

    /// Sets a setting of [`OverrideEntry::specs`].
    pub fn set(&mut self, key: &str, value: ParamValue) -> Result<(), ParamError> {
        let spec = self.specs().find(|spec| spec.key == key);
        let unknown = || {
            let known = self.specs().map(|spec| spec.key).collect::<Vec<_>>().join(", ");
            ParamError::Unknown { key: key.into(), known }
        };
        store(spec.ok_or_else(unknown)?, &mut self.settings, value)
    }
}

/// The methods that can light single objects.
pub fn mixed_methods() -> impl Iterator<Item = &'static dyn Method> {
    lighting::methods().into_iter().filter(|method| method.is_on_processor())
}

impl Document {
    /// Keeps the document as it is now, shown by a method with these settings, as a side, under the side's letter. A
    /// snapshot of that name is replaced; the document itself stays as it is.
    pub fn store_side_by(&mut self, side: Side, method: MethodId, settings: &Settings) {
        let name = side.letter();
        match self.snapshot(name) {
            Some(_) => self.replace_snapshot(name),
            None => _ = self.add_snapshot(name),
        }
        if let Some(snapshot) = self.snapshots.iter_mut().find(|snapshot| snapshot.name == name) {
            let lighting = snapshot.lighting.by(method, settings);
            Arc::make_mut(snapshot).lighting = lighting;
        }
        let entry = self.compare.side_mut(side);
        (entry.snapshot, entry.method) = (Some(name.into()), method.0.into());
    }

    /// A side is a snapshot that is shown by this method with these settings.
    pub fn is_side_by(&self, side: Side, method: MethodId, settings: &Settings) -> bool {
        let shown = self.snapshot_of(side).filter(|_| self.compare.side(side).method == method.0);
        shown.is_some_and(|snapshot| snapshot.lighting.by(method, settings) == snapshot.lighting)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{DEFAULT_SCENE, open};
    use crate::lighting::{METHODS, classical, method};

    fn settings(id: &str, values: &[(&str, &str)]) -> (MethodId, Settings) {
        let info = method::find(METHODS, id).unwrap().info();
        let mut settings = Settings::new(info.params);
        values.iter().for_each(|(key, value)| settings.set(key, value).unwrap());
        (info.id, settings)
    }

    #[test]
    fn a_side_is_the_document_with_the_settings_of_a_method() {
        let mut document = open(DEFAULT_SCENE).unwrap().document;
        document.set_lighting("samples", ParamValue::Integer(8)).unwrap();
        let before = document.lighting.clone();
        let (id, lookups) = settings(classical::ID, &[("samples", "0"), ("masking", "separable")]);
        document.store_side_by(Side::B, id, &lookups);
        assert_eq!(document.lighting, before, "the document stays");
        let shown = document.of_side(Side::B);
        assert_eq!(shown.lighting.settings(), lookups);
        assert_eq!(shown.materials, document.materials);
        assert!(document.is_side_by(Side::B, id, &lookups) && !document.is_side_by(Side::A, id, &lookups));
        let (_, others) = settings(classical::ID, &[("samples", "64")]);
        assert!(!document.is_side_by(Side::B, id, &others));
        document.store_side_by(Side::B, id, &others);
        assert_eq!(document.snapshots.len(), 1, "it is replaced");
        assert_eq!(document.of_side(Side::B).lighting.settings(), others);
    }

    #[test]
    fn an_override_lights_its_object_and_unknown_ones_count_as_none() {
        let opened = open(DEFAULT_SCENE).unwrap();
        let mut lighting = opened.document.lighting.clone();
        let keys: Vec<String> = ["floor", "ball"].map(String::from).into();
        lighting.override_object("ball", Some(classical::ID));
        lighting.override_object("nobody", Some(classical::ID));
        lighting.override_object("floor", Some("of tomorrow"));
        let entry = lighting.overrides.get_mut("ball").unwrap();
        entry.set("samples", ParamValue::Integer(64)).unwrap();
        assert!(entry.set("masking", ParamValue::Choice(1)).unwrap_err().to_string().contains("samples"));
        let layers = lighting.layers(&keys);
        let places: Vec<_> = layers.iter().map(|layer| layer.instances.clone()).collect();
        assert_eq!(places, [vec![], vec![1]]);
        let samples = layers.iter().map(|layer| layer.settings.text("samples").unwrap());
        assert_eq!(samples.collect::<Vec<_>>(), ["16", "64"]);
        assert_eq!(lighting.world_settings(), lighting.settings());
        lighting.override_object("ball", Some(reference::ID));
        assert_eq!(lighting.world_settings(), lighting.reference_settings());
        lighting.override_object("floor", Some(reference::ID));
        let layers = lighting.layers(&keys);
        let places: Vec<_> = layers.iter().map(|layer| layer.instances.clone()).collect();
        assert_eq!(places, [vec![], vec![1, 0]], "objects that are lit alike share a layer");
        assert_eq!(layers.overridden(), 2);
        for key in ["ball", "nobody", "floor"] {
            lighting.override_object(key, None);
        }
        assert_eq!(lighting, opened.document.lighting);
    }

    #[test]
    fn the_reference_takes_its_own_settings_and_the_shared_ones_but_no_number_of_samples() {
        let mut document = open(DEFAULT_SCENE).unwrap().document;
        let (id, few) = settings(reference::ID, &[("samples", "4"), ("bounces", "3"), ("masking", "separable")]);
        document.store_side_by(Side::A, id, &few);
        let shown = document.of_side(Side::A);
        assert!(document.compare.a.is_reference());
        assert_eq!(shown.lighting.method, classical::ID);
        assert_eq!(shown.lighting.reference_settings().text("bounces").as_deref(), Some("3"));
        assert_eq!(shown.lighting.reference_settings().text("masking").as_deref(), Some("separable"));
        assert_eq!(shown.lighting.reference.keys().collect::<Vec<_>>(), ["bounces"]);
    }
}
