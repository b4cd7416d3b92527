//! Truths and records on disk, under hashes of what they depend on.

use std::path::{Path, PathBuf};

use glam::UVec2;
use serde_json::json;

use super::{BenchError, Candidate, Record, Shot, Truth};
use crate::file::{FileError, read_bounded, write_atomic};
use crate::reference::Film;
use crate::reference::checkpoint::{self, Key};

/// Raised when a record of the same inputs would hold other numbers or mean something else.
const REVISION: u32 = 2;

/// Largest record that is read.
const RECORD_BYTES: u64 = 1 << 20;

/// A folder of results, or none.
#[derive(Clone, Debug, Default)]
pub struct Cache {
    folder: Option<PathBuf>,
    /// Nothing is read; what is new is written over what is old.
    fresh: bool,
}

impl Cache {
    /// Keeps nothing.
    pub fn none() -> Cache {
        Cache::default()
    }

    /// In a folder, which is made when there is something to keep.
    pub fn within(folder: &Path) -> Cache {
        Cache { folder: Some(folder.into()), fresh: false }
    }

    /// The same, but reads nothing.
    pub fn fresh(self) -> Cache {
        Cache { fresh: true, ..self }
    }

    /// The film under a key with so many samples: read, or traced and kept.
    pub(super) fn film(
        &self,
        key: &Key,
        samples: u32,
        size: UVec2,
        trace: impl FnOnce(&mut Film) -> Result<(), BenchError>,
    ) -> Result<Film, BenchError> {
        let path = self.path(&film_hash(key, samples), "film");
        let known = path.as_deref().filter(|path| !self.fresh && path.exists());
        // A file that cannot be read is made anew.
        if let Some(film) = known.and_then(|path| checkpoint::read(path, key).ok())
            && film.samples() == samples
        {
            return Ok(film);
        }
        let mut film = Film::new(size);
        trace(&mut film)?;
        if let Some(path) = path {
            self.make_folder()?;
            checkpoint::write(&path, &film, key)?;
        }
        Ok(film)
    }

    /// Hash of all that a record depends on.
    pub(super) fn key(
        &self,
        shot: &Shot,
        truth: &Truth,
        candidate: &Candidate,
        machine: &str,
    ) -> Result<String, BenchError> {
        let inputs = json!({
            "revision": REVISION,
            "version": env!("CARGO_PKG_VERSION"),
            "truth": truth.key,
            "name": shot.name,
            "subject": shot.scene.subject,
            "exposure": shot.exposure_ev.to_bits(),
            "compared_frames": shot.compared_frames,
            "method": candidate.method.0,
            "settings": candidate.texts(),
            "machine": machine,
        });
        Ok(blake3::hash(inputs.to_string().as_bytes()).to_hex().to_string())
    }

    /// What was kept under a key.
    pub(super) fn record(&self, key: &str) -> Option<Record> {
        let path = self.path(key, "json").filter(|_| !self.fresh)?;
        serde_json::from_slice(&read_bounded(&path, RECORD_BYTES).ok()?).ok()
    }

    /// Keeps a record.
    pub(super) fn keep(&self, key: &str, record: &Record) -> Result<(), BenchError> {
        let Some(path) = self.path(key, "json") else { return Ok(()) };
        self.make_folder()?;
        let bytes = serde_json::to_vec_pretty(record).map_err(|e| BenchError::Method(e.to_string()))?;
        Ok(write_atomic(&path, &bytes)?)
    }

    fn path(&self, hash: &str, ending: &str) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(format!("{hash}.{ending}")))
    }

    fn make_folder(&self) -> Result<(), FileError> {
        let Some(folder) = &self.folder else { return Ok(()) };
        let remedy = "choose another --cache, or free some space";
        std::fs::create_dir_all(folder).map_err(|e| FileError::new(folder, e.to_string(), remedy))
    }
}

/// Hash of what a film of so many samples depends on.
pub(super) fn film_hash(key: &Key, samples: u32) -> String {
    let inputs = json!({ "key": key, "samples": samples });
    blake3::hash(inputs.to_string().as_bytes()).to_hex().to_string()
}
