//! The choice of a lighting method, and the document as a method with certain settings shows it, as a side of the comparison.

use std::sync::Arc;

use super::edit::store;
use super::{Document, LightingEntry, SHARED_SETTINGS, Side};
use crate::lighting::MethodId;
use crate::param::{self, Settings};
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
            let _ = store(&[*spec], stored, spec.key, value);
        }
        entry
    }
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
    use crate::param::ParamValue;

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
