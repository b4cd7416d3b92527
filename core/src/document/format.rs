//! Documents as files: JSON with format and version, paths relative to the file.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Map, Value};

use super::snapshot::{Snapshot, each_texture_path};
use super::{CameraEntry, Document, EnvironmentEntry, MaterialEntry, ProbeEntry, ViewEntry, absolute, relative};
use crate::file::{FileError, read_bounded, write_atomic};
use crate::material::preset::Preset;

/// Value of the field `format`.
pub const FORMAT: &str = "burnish-document";
/// Value of the field `version`; older ones are brought up when read, newer ones refused.
pub const VERSION: u64 = 1;
/// Largest document that is read.
pub const MAX_BYTES: u64 = 64 << 20;

/// Why there is no document. Its text names file, field and remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DocumentError {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not a document.
    #[error("{}: {reason}; {remedy}", path.display())]
    Invalid {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the field.
        reason: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The scene that it is about cannot be read.
    #[error("{0}")]
    Source(String),
}

impl Document {
    /// Reads a document; its paths become absolute.
    pub fn read(path: &Path) -> Result<Document, DocumentError> {
        let bytes = read_bounded(path, MAX_BYTES)?;
        let invalid = |reason: String, remedy| DocumentError::Invalid { path: path.into(), reason, remedy };
        let text = std::str::from_utf8(&bytes)
            .map_err(|e| invalid(format!("is not UTF-8 text ({e})"), "open a file that Burnish saved"))?;
        let json = serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|e| {
            invalid(format!("is not JSON ({e})"), "open a file that Burnish saved, or its recovery file")
        })?;
        Document::from_json(json, path)
    }

    /// Reads a document from JSON; `path` serves messages, and its folder the paths inside.
    pub fn from_json(json: Value, path: &Path) -> Result<Document, DocumentError> {
        let invalid = |reason: String, remedy| DocumentError::Invalid { path: path.into(), reason, remedy };
        let Value::Object(mut fields) = json else {
            return Err(invalid("is no JSON object".into(), "open a file that Burnish saved"));
        };
        if fields.remove("format").as_ref().and_then(Value::as_str) != Some(FORMAT) {
            let reason = format!("field `format` is not \"{FORMAT}\"");
            return Err(invalid(reason, "open a file that Burnish saved"));
        }
        match fields.remove("version").as_ref().and_then(Value::as_u64) {
            Some(VERSION) => {}
            Some(newer) if newer > VERSION => {
                let reason = format!("has version {newer}, this program reads up to {VERSION}");
                return Err(invalid(reason, "update Burnish"));
            }
            _ => return Err(invalid("field `version` is no known number".into(), "set it to 1")),
        }
        let mut document: Document = serde_json::from_value(Value::Object(fields))
            .map_err(|e| invalid(e.to_string(), "mend the field, or open an older copy"))?;
        document.check().map_err(|reason| invalid(reason, "mend the field, or open an older copy"))?;
        let folder = folder_of(path);
        document.each_path(|stored| *stored = absolute(stored, &folder));
        document.share_snapshots();
        Ok(document)
    }

    /// The document as text, paths relative to `folder`.
    pub fn to_text(&self, folder: &Path) -> String {
        let mut document = self.clone();
        document.each_path(|path| *path = relative(path, folder));
        let mut fields = Map::new();
        fields.insert("format".into(), FORMAT.into());
        fields.insert("version".into(), VERSION.into());
        // A document is plain data with text keys: it always becomes an object.
        if let Ok(Value::Object(rest)) = serde_json::to_value(&document) {
            fields.extend(rest);
        }
        format!("{:#}\n", Value::Object(fields))
    }

    /// Writes the file as a whole or not at all. What could not be read again is refused: the file stays as it was.
    pub fn save(&self, path: &Path) -> Result<(), DocumentError> {
        self.check().map_err(|reason| DocumentError::Invalid {
            path: path.into(),
            reason,
            remedy: "nothing was written; mend it, or undo to before it, then save again",
        })?;
        Ok(write_atomic(path, self.to_text(&folder_of(path)).as_bytes())?)
    }

    /// What no program would have written, although it is JSON of the right shape.
    fn check(&self) -> Result<(), String> {
        let state = State {
            materials: &self.materials,
            presets: &self.presets,
            probes: &self.probes,
            environment: &self.environment,
            view: &self.view,
        };
        state.check("")?;
        for (place, camera) in self.cameras.iter().enumerate() {
            check_camera(&format!("cameras[{place}]"), camera)?;
        }
        let mut names = BTreeSet::new();
        for (place, snapshot) in self.snapshots.iter().enumerate() {
            if !names.insert(snapshot.name.as_str()) {
                return Err(format!("two snapshots are called `{}`", snapshot.name));
            }
            let Snapshot { materials, presets, probes, environment, view, .. } = &**snapshot;
            State { materials, presets, probes, environment, view }.check(&format!("snapshots[{place}]."))?;
        }
        Ok(())
    }

    /// Visits every path of a file; names of the gallery are none.
    fn each_path(&mut self, mut visit: impl FnMut(&mut String)) {
        if !self.scene.starts_with("gallery:") {
            visit(&mut self.scene);
        }
        if let Some(source) = &mut self.environment.source {
            visit(source);
        }
        each_texture_path(&mut self.materials, &mut visit);
        for snapshot in &mut self.snapshots {
            Snapshot::each_path(snapshot, &mut visit);
        }
    }
}

/// What a document and its snapshots have in common.
struct State<'a> {
    materials: &'a [Arc<MaterialEntry>],
    presets: &'a [Arc<Preset>],
    probes: &'a [ProbeEntry],
    environment: &'a EnvironmentEntry,
    view: &'a ViewEntry,
}

impl State<'_> {
    /// See [`Document::check`]; `place` is what its fields follow.
    fn check(&self, place: &str) -> Result<(), String> {
        let State { materials, presets, probes, environment, view } = self;
        environment.check(place)?;
        let numbers = [("view.exposure_ev", view.exposure_ev, -64.0..=64.0)];
        for (field, value, range) in numbers {
            if !range.contains(&value) {
                let (start, end) = (range.start(), range.end());
                return Err(format!("field `{place}{field}` is {value}; it takes {start} to {end}"));
            }
        }
        check_camera(&format!("{place}view.camera"), &view.camera)?;
        let mut names = BTreeSet::new();
        for material in *materials {
            if !names.insert(material.name.as_str()) {
                return Err(format!("two materials are called `{}`", material.name));
            }
        }
        let mut names = BTreeSet::new();
        for probe in *probes {
            if !names.insert(probe.name.as_str()) {
                return Err(format!("two probes are called `{}`", probe.name));
            }
        }
        for preset in *presets {
            preset.check(&format!("field `{place}presets`")).map_err(|e| e.to_string())?;
        }
        Ok(())
    }
}

/// Numbers of a camera that no view has. JSON has no word for those that are not finite.
fn check_camera(field: &str, camera: &CameraEntry) -> Result<(), String> {
    let [x, y, z] = camera.target;
    let finite = [
        ("target", x),
        ("target", y),
        ("target", z),
        ("distance", camera.distance),
        ("yaw_deg", camera.yaw_deg),
        ("pitch_deg", camera.pitch_deg),
        ("roll_deg", camera.roll_deg),
        ("yfov_deg", camera.yfov_deg),
    ];
    if let Some((name, value)) = finite.into_iter().find(|(_, value)| !value.is_finite()) {
        return Err(format!("field `{field}.{name}` is {value}; it takes finite numbers"));
    }
    if camera.distance <= 0.0 {
        return Err(format!("field `{field}.distance` is {}; it takes numbers above 0", camera.distance));
    }
    if !(1.0..=170.0).contains(&camera.yfov_deg) {
        return Err(format!("field `{field}.yfov_deg` is {}; it takes 1 to 170", camera.yfov_deg));
    }
    Ok(())
}

/// The folder of a file, absolute where the current folder is known.
fn folder_of(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.into());
    path.parent().map(Path::to_path_buf).unwrap_or_default()
}
