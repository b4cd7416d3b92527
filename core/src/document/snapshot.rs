//! Named states of a document, and the two sides that are compared.
//!
//! A snapshot holds what a picture depends on besides the model, the point of view included. It shares its parts with the
//! document that it was taken of.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{
    Assignment, Document, EnvironmentEntry, LightEntry, LightingEntry, MaterialEntry, ObjectEntry, ProbeEntry,
    TextureChoice, ViewEntry, edit::free,
};
use crate::lighting::classical;
use crate::material::preset::Preset;
use crate::reference;

/// A state of the document under a name. Its fields are those of [`Document`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Unique among the snapshots.
    pub name: String,
    /// All materials.
    #[serde(default, with = "super::shared")]
    pub materials: Vec<Arc<MaterialEntry>>,
    /// Objects that do not have the material of the model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assignments: Vec<Assignment>,
    /// Objects that were renamed or hidden.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<ObjectEntry>,
    /// Metals in use that do not come with the program.
    #[serde(default, with = "super::shared", skip_serializing_if = "Vec::is_empty")]
    pub presets: Vec<Arc<Preset>>,
    /// Lights other than the environment; those of the model when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lights: Option<Vec<LightEntry>>,
    /// Places from which methods record the surroundings of objects.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probes: Vec<ProbeEntry>,
    /// Light from infinitely far away.
    #[serde(default)]
    pub environment: EnvironmentEntry,
    /// How light is computed.
    #[serde(default)]
    pub lighting: LightingEntry,
    /// From where, at which exposure.
    #[serde(default)]
    pub view: ViewEntry,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// The two sides of the comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CompareEntry {
    /// Left.
    #[serde(default)]
    pub a: SideEntry,
    /// Right.
    #[serde(default)]
    pub b: SideEntry,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// What a side shows: a state of the document by a method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SideEntry {
    /// Name of a snapshot; the document as it is now when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub snapshot: Option<String>,
    /// Id of the method that computes the light: [`reference::ID`], else the live one.
    pub method: String,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// One of two sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Left.
    A,
    /// Right.
    B,
}

impl Side {
    /// Both.
    pub const ALL: [Side; 2] = [Side::A, Side::B];

    /// Its letter.
    pub fn letter(self) -> &'static str {
        match self {
            Side::A => "A",
            Side::B => "B",
        }
    }

    /// The opposite one.
    pub fn other(self) -> Side {
        match self {
            Side::A => Side::B,
            Side::B => Side::A,
        }
    }
}

impl Default for SideEntry {
    fn default() -> Self {
        SideEntry { snapshot: None, method: classical::ID.into(), other: Map::new() }
    }
}

impl Default for CompareEntry {
    /// The document as it is now, live on the left and path-traced on the right.
    fn default() -> Self {
        let b = SideEntry { method: reference::ID.into(), ..SideEntry::default() };
        CompareEntry { a: SideEntry::default(), b, other: Map::new() }
    }
}

impl CompareEntry {
    /// A side.
    pub fn side(&self, side: Side) -> &SideEntry {
        match side {
            Side::A => &self.a,
            Side::B => &self.b,
        }
    }

    /// A side for editing.
    pub fn side_mut(&mut self, side: Side) -> &mut SideEntry {
        match side {
            Side::A => &mut self.a,
            Side::B => &mut self.b,
        }
    }
}

impl SideEntry {
    /// It is path-traced.
    pub fn is_reference(&self) -> bool {
        self.method == reference::ID
    }
}

impl Document {
    /// A snapshot by its name.
    pub fn snapshot(&self, name: &str) -> Option<&Arc<Snapshot>> {
        self.snapshots.iter().find(|snapshot| snapshot.name == name)
    }

    /// The snapshot that a side shows; `None` for the document as it is now, also where the name means nothing.
    pub fn snapshot_of(&self, side: Side) -> Option<&Arc<Snapshot>> {
        self.snapshot(self.compare.side(side).snapshot.as_deref()?)
    }

    /// The state as it is now, under a name.
    pub fn state(&self, name: &str) -> Snapshot {
        Snapshot {
            name: name.into(),
            materials: self.materials.clone(),
            assignments: self.assignments.clone(),
            objects: self.objects.clone(),
            presets: self.presets.clone(),
            lights: self.lights.clone(),
            probes: self.probes.clone(),
            environment: self.environment.clone(),
            lighting: self.lighting.clone(),
            view: self.view.clone(),
            other: Map::new(),
        }
    }

    /// Goes back to a state. The point of view goes back too; snapshots and saved cameras stay.
    pub fn restore(&mut self, state: &Snapshot) {
        let Snapshot {
            name: _,
            materials,
            assignments,
            objects,
            presets,
            lights,
            probes,
            environment,
            lighting,
            view,
            other: _,
        } = state.clone();
        (self.materials, self.assignments, self.objects, self.presets) = (materials, assignments, objects, presets);
        self.probes = probes;
        (self.lights, self.environment, self.lighting, self.view) = (lights, environment, lighting, view);
    }

    /// What a side is about, with its own point of view.
    pub fn of_side(&self, side: Side) -> Document {
        let mut document = self.clone();
        if let Some(snapshot) = self.snapshot_of(side) {
            document.restore(snapshot);
        }
        document
    }

    /// Keeps the state as it is now under a name, or the next that is free; returns the name.
    pub fn add_snapshot(&mut self, name: &str) -> String {
        let name = self.free_snapshot_name(name, None);
        let snapshot = self.state(&name);
        self.snapshots.push(Arc::new(snapshot));
        name
    }

    /// Keeps the state as it is now in place of that of a snapshot.
    pub fn replace_snapshot(&mut self, name: &str) {
        let state = self.state(name);
        if let Some(snapshot) = self.snapshots.iter_mut().find(|snapshot| snapshot.name == name) {
            let other = snapshot.other.clone();
            *snapshot = Arc::new(Snapshot { other, ..state });
        }
    }

    /// Renames a snapshot and what refers to it; a name that is taken gets a number.
    pub fn rename_snapshot(&mut self, old: &str, new: &str) {
        let Some(place) = self.snapshots.iter().position(|snapshot| snapshot.name == old) else { return };
        if new.is_empty() || new == old {
            return;
        }
        let new = self.free_snapshot_name(new, Some(place));
        if let Some(snapshot) = self.snapshots.get_mut(place) {
            Arc::make_mut(snapshot).name.clone_from(&new);
        }
        for side in Side::ALL {
            let entry = self.compare.side_mut(side);
            if entry.snapshot.as_deref() == Some(old) {
                entry.snapshot = Some(new.clone());
            }
        }
    }

    /// Removes a snapshot; a side that showed it shows the document as it is now.
    pub fn remove_snapshot(&mut self, name: &str) {
        self.snapshots.retain(|snapshot| snapshot.name != name);
        for side in Side::ALL {
            let entry = self.compare.side_mut(side);
            if entry.snapshot.as_deref() == Some(name) {
                entry.snapshot = None;
            }
        }
    }

    /// Keeps the state as it is now as that of a side, under the side's letter. A snapshot of that name is replaced.
    ///
    /// The first side that is stored is shown live, and so is the other: what was changed since is to be seen, not what
    /// the method lacks.
    pub fn store_side(&mut self, side: Side) {
        if self.compare == CompareEntry::default() {
            self.compare.b.method = self.compare.a.method.clone();
        }
        let name = side.letter();
        match self.snapshot(name) {
            Some(_) => self.replace_snapshot(name),
            None => _ = self.add_snapshot(name),
        }
        self.compare.side_mut(side).snapshot = Some(name.into());
    }

    /// Exchanges the sides.
    pub fn swap_sides(&mut self) {
        let CompareEntry { a, b, other: _ } = &mut self.compare;
        std::mem::swap(a, b);
    }

    fn free_snapshot_name(&self, name: &str, except: Option<usize>) -> String {
        free(name, |candidate| {
            self.snapshots.iter().enumerate().any(|(place, other)| Some(place) != except && other.name == candidate)
        })
    }

    /// Lets snapshots share materials with the document where they are equal, as they do until they are written.
    pub(super) fn share_snapshots(&mut self) {
        let Document { snapshots, materials, .. } = self;
        for snapshot in snapshots {
            for (own, current) in Arc::make_mut(snapshot).materials.iter_mut().zip(materials.iter()) {
                if own == current {
                    *own = current.clone();
                }
            }
        }
    }
}

impl Snapshot {
    /// Visits every path of a file in it. What has none stays shared.
    pub(super) fn each_path(snapshot: &mut Arc<Snapshot>, visit: &mut impl FnMut(&mut String)) {
        if snapshot.environment.source.is_some()
            && let Some(source) = &mut Arc::make_mut(snapshot).environment.source
        {
            visit(source);
        }
        if snapshot.materials.iter().any(|entry| has_files(entry)) {
            each_texture_path(&mut Arc::make_mut(snapshot).materials, visit);
        }
    }
}

/// Some slot of it has a picture from a file.
fn has_files(entry: &MaterialEntry) -> bool {
    entry.textures.values().any(|choice| matches!(choice, TextureChoice::File(_)))
}

/// Visits the paths of textures. Materials without any stay shared.
pub(super) fn each_texture_path(materials: &mut [Arc<MaterialEntry>], visit: &mut impl FnMut(&mut String)) {
    for entry in materials.iter_mut().filter(|entry| has_files(entry)) {
        for choice in Arc::make_mut(entry).textures.values_mut() {
            if let TextureChoice::File(path) = choice {
                visit(path);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use serde_json::json;

    use super::*;
    use crate::document::{DEFAULT_SCENE, open};
    use crate::file::testing::Folder;
    use crate::param::ParamValue;

    fn workbench() -> Document {
        open(DEFAULT_SCENE).unwrap().document
    }

    #[test]
    fn a_snapshot_shares_its_materials_with_the_document_and_is_restored() {
        let mut document = workbench();
        let start = document.clone();
        assert_eq!(document.add_snapshot("first"), "first");
        assert!(Arc::ptr_eq(&document.snapshots[0].materials[0], &document.materials[0]));
        document.set_value(0, "roughness", ParamValue::Number(0.9)).unwrap();
        document.view.exposure_ev = 2.0;
        document.view.camera.orbit(40.0, 0.0);
        assert!(Arc::ptr_eq(&document.snapshots[0].materials[1], &document.materials[1]));
        let snapshot = document.snapshot("first").unwrap().clone();
        document.restore(&snapshot);
        document.snapshots.clear();
        assert_eq!(document, start);
    }

    #[test]
    fn sides_follow_the_names_of_their_snapshots() {
        let mut document = workbench();
        assert!(document.compare.b.is_reference() && !document.compare.a.is_reference());
        document.store_side(Side::A);
        assert!(!document.compare.b.is_reference(), "what was changed is to be seen");
        document.compare.b.method = reference::ID.into();
        document.store_side(Side::B);
        document.store_side(Side::B);
        assert_eq!(document.snapshots.len(), 2, "a side that is stored again replaces its snapshot");
        assert!(document.compare.b.is_reference(), "a method that was chosen stays");
        document.rename_snapshot("A", "gold");
        assert_eq!(document.snapshot_of(Side::A).unwrap().name, "gold");
        document.rename_snapshot("gold", "B");
        assert_eq!(document.snapshots[0].name, "B 2", "a name that is taken gets a number");
        document.swap_sides();
        assert_eq!(document.snapshot_of(Side::B).unwrap().name, "B 2");
        document.remove_snapshot("B 2");
        assert!(document.snapshot_of(Side::B).is_none());
        assert_eq!(document.compare.b.snapshot, None);
    }

    #[test]
    fn snapshots_are_read_as_they_were_written_with_fields_they_do_not_know() {
        let folder = Folder::new();
        let path = folder.join("a.burnish");
        let mut document = workbench();
        document.environment.source = Some(folder.join("maps/a.hdr").to_string_lossy().into_owned());
        let file = TextureChoice::File(folder.join("maps/n.png").to_string_lossy().into_owned());
        document.set_texture(0, crate::material::TextureRole::Normal, Some(file));
        document.store_side(Side::A);
        document.environment.source = None;
        document.set_texture(0, crate::material::TextureRole::Normal, None);
        document.save(&path).unwrap();
        let read = Document::read(&path).unwrap();
        assert_eq!(read, document);
        assert!(Arc::ptr_eq(&read.snapshots[0].materials[1], &read.materials[1]), "shared again");
        assert_eq!(read.texture_files().len(), 1);
        assert_eq!(read.maps().len(), 1);

        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("\"maps/a.hdr\"") && text.contains("\"maps/n.png\""), "paths are relative: {text}");
        let mut json: Value = serde_json::from_str(&text).unwrap();
        json["snapshots"][0]["future"] = json!([{ "size": 256 }]);
        json["compare"]["a"]["opacity"] = json!(0.5);
        std::fs::write(&path, json.to_string()).unwrap();
        Document::read(&path).unwrap().save(&path).unwrap();
        let again: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        assert_eq!(again, json);
    }

    #[test]
    fn a_file_of_an_older_version_has_no_snapshots() {
        let document = workbench();
        let mut json: Value = serde_json::from_str(&document.to_text(Path::new("/"))).unwrap();
        assert!(json.get("snapshots").is_none() && json.get("compare").is_none(), "what nobody used is not written");
        json.as_object_mut().unwrap().remove("subject");
        let read = Document::from_json(json, Path::new("/a.burnish")).unwrap();
        assert!(read.snapshots.is_empty());
        assert_eq!(read.compare, CompareEntry::default());
    }

    #[test]
    fn snapshots_that_no_program_wrote_are_refused_in_words() {
        let mut document = workbench();
        document.add_snapshot("one");
        let sound: Value = serde_json::from_str(&document.to_text(Path::new("/"))).unwrap();
        let broken = |change: fn(&mut Value)| {
            let mut json = sound.clone();
            change(&mut json);
            Document::from_json(json, Path::new("/a.burnish")).unwrap_err().to_string()
        };
        let doubled = broken(|j| {
            let one = j["snapshots"][0].clone();
            j["snapshots"].as_array_mut().unwrap().push(one);
        });
        assert!(doubled.contains("two snapshots are called `one`"), "{doubled}");
        let bright = broken(|j| j["snapshots"][0]["view"]["exposure_ev"] = json!(1e9));
        assert!(bright.contains("snapshots[0].view.exposure_ev"), "{bright}");
    }
}
