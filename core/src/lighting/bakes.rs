//! Preparations in files that people name: `.bake`.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::json;

use super::prepared::{Origin, Prepared};
use crate::file::{Container, FileError, Kind};

/// The kind of file.
pub const KIND: Kind = Kind { id: "bake", version: 1 };

/// Largest file that is read.
const MAX_BYTES: u64 = 16 << 30;

/// A preparation with where it comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Bake {
    /// What it was made of.
    pub about: About,
    /// What frames look up.
    pub prepared: Prepared,
}

/// What a file says of its preparation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// What it was made of.
    pub origin: Origin,
    /// Relative standard error of what was drawn by chance, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// Seeds and paths per direction of the runs that it is the mean of; empty for a single run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<[u32; 2]>,
}

impl Bake {
    /// Writes the file, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        let header = json!({ "about": self.about, "software": concat!("Burnish ", env!("CARGO_PKG_VERSION")) });
        Container::of_arrays(KIND, header, self.prepared.flat()).write(path)
    }

    /// Reads a file; any damage is found.
    pub fn read(path: &Path) -> Result<Bake, FileError> {
        let damaged = |reason: &str| FileError::new(path, reason, "bake it anew");
        let container = Container::read(path, KIND, MAX_BYTES)?;
        let about = container.header.get("about").cloned().unwrap_or_default();
        let about =
            serde_json::from_value(about).map_err(|e| damaged(&format!("does not say what it was made of ({e})")))?;
        let prepared = Prepared::of_flat(container.into_arrays()).ok_or_else(|| damaged("lacks a part"))?;
        Ok(Bake { about, prepared })
    }

    /// Whether frames of a scene, whose preparation would be of `origin`, can look it up: a notice for people where it is of another state,
    /// an error where it cannot be used.
    pub fn fits(&self, path: &Path, origin: &Origin) -> Result<Option<String>, FileError> {
        let own = &self.about.origin;
        if own.method != origin.method {
            let remedy = format!("choose --method {}, or bake with --method {}", own.method, origin.method);
            return Err(FileError::new(
                path,
                format!("was baked for the method {}, not {}", own.method, origin.method),
                remedy,
            ));
        }
        if own.revision != origin.revision {
            return Err(FileError::new(path, "was baked by another version of the method", "bake it anew"));
        }
        let parts = own.other_parts(origin);
        if parts.contains(&"geometry") {
            return Err(FileError::new(
                path,
                "was baked of a scene with other geometry",
                "bake it anew, or name its scene",
            ));
        }
        if parts.is_empty() {
            return Ok(None);
        }
        let list = parts.join(", ");
        Ok(Some(format!("{}: baked with other {list}; light between surfaces is that of the bake", path.display())))
    }
}
