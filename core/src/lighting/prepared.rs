//! What methods compute before their first frame, and where it is kept.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec3;
use half::f16;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::method::{Method, MethodError, MethodId, MethodInfo};
use crate::file::{Array, Container, Element, FileError, Kind};
use crate::job::Handle;
use crate::param::{Affects, Settings};
use crate::reference::World;
use crate::scene::Scene;
use crate::scene::fingerprint::{self, Digest};

/// The kind of file.
pub const KIND: Kind = Kind { id: "prepared", version: 1 };

/// Largest file that is read.
const MAX_BYTES: u64 = 16 << 30;

/// Parts of a scene that a preparation depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reads {
    /// Meshes and instances.
    pub geometry: bool,
    /// Materials with their curves and images.
    pub materials: bool,
    /// Punctual lights.
    pub lights: bool,
    /// The environment as it lights the scene.
    pub environment: bool,
    /// The map of the environment, however it is turned and scaled.
    pub sky: bool,
    /// Probes.
    pub probes: bool,
}

impl Reads {
    /// Nothing: there is no preparation, or the same one for every scene.
    pub const NOTHING: Reads =
        Reads { geometry: false, materials: false, lights: false, environment: false, sky: false, probes: false };
    /// The whole scene, but for probes.
    pub const ALL: Reads =
        Reads { geometry: true, materials: true, lights: true, environment: true, sky: true, probes: false };

    /// Each part with its name for people.
    pub fn parts(self) -> [(&'static str, bool); 6] {
        [
            ("geometry", self.geometry),
            ("materials", self.materials),
            ("lights", self.lights),
            ("environment", self.environment),
            ("map of the environment", self.sky),
            ("probes", self.probes),
        ]
    }
}

/// What a method computed: named arrays of numbers, and parts that are alike, such as probes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prepared {
    arrays: Vec<(String, Array)>,
    parts: Vec<Prepared>,
    /// See [`Prepared::is_fleeting`].
    fleeting: bool,
}

impl Prepared {
    /// That of a method that needs none.
    pub fn nothing() -> Prepared {
        Prepared::default()
    }

    /// The same with parts, each of which is a preparation by itself.
    #[must_use]
    pub fn with_parts(self, parts: Vec<Prepared>) -> Prepared {
        Prepared { parts, ..self }
    }

    /// The same with each of its parts made into another.
    #[must_use]
    pub fn map_parts(self, change: impl FnMut(Prepared) -> Prepared) -> Prepared {
        Prepared { parts: self.parts.into_iter().map(change).collect(), ..self }
    }

    /// The same, which is not to be kept where `is`.
    #[must_use]
    pub fn fleeting(self, is: bool) -> Prepared {
        Prepared { fleeting: is, ..self }
    }

    /// It, or a part of it, is made in a moment and depends on what made it, such as a graphics device: it is made again where another would be
    /// read.
    pub fn is_fleeting(&self) -> bool {
        self.fleeting || self.parts.iter().any(Prepared::is_fleeting)
    }

    /// Its parts.
    pub fn parts(&self) -> &[Prepared] {
        &self.parts
    }

    /// The same with one array more; names must differ.
    pub fn with<T: Element>(mut self, name: &str, values: Vec<T>) -> Prepared {
        debug_assert!(self.arrays.iter().all(|(known, _)| known != name), "{name} twice");
        self.arrays.push((name.into(), T::array(values)));
        self
    }

    /// The numbers of an array of 32-bit floats; empty where there is none of that name.
    pub fn floats(&self, name: &str) -> &[f32] {
        match self.arrays.iter().find(|(known, _)| known == name) {
            Some((_, Array::F32(values))) => values,
            _ => &[],
        }
    }

    /// The numbers of an array of 16-bit floats; empty where there is none of that name.
    pub fn halves(&self, name: &str) -> &[f16] {
        match self.arrays.iter().find(|(known, _)| known == name) {
            Some((_, Array::F16(values))) => values,
            _ => &[],
        }
    }

    /// The numbers of an array of whole numbers; empty where there is none of that name.
    pub fn whole(&self, name: &str) -> &[u32] {
        match self.arrays.iter().find(|(known, _)| known == name) {
            Some((_, Array::U32(values))) => values,
            _ => &[],
        }
    }

    /// The `index`th three floats of an array; zero beyond its end.
    pub fn vector(&self, name: &str, index: usize) -> Vec3 {
        self.floats(name).get(3 * index..3 * index + 3).map_or(Vec3::ZERO, Vec3::from_slice)
    }

    /// Memory that it keeps.
    pub fn bytes(&self) -> u64 {
        let own: u64 = self.arrays.iter().map(|(_, array)| array.bytes() as u64).sum();
        own + self.parts.iter().map(Prepared::bytes).sum::<u64>()
    }

    /// There was nothing to prepare.
    pub fn is_nothing(&self) -> bool {
        self.arrays.is_empty() && self.parts.is_empty()
    }

    /// All arrays in one list, those of parts as `PART/NAME`.
    pub(super) fn flat(&self) -> Vec<(String, Array)> {
        let of_part = |(place, part): (usize, &Prepared)| {
            let named = move |(name, array)| (format!("{place}/{name}"), array);
            part.flat().into_iter().map(named).collect::<Vec<_>>()
        };
        let parts = self.parts.iter().enumerate().flat_map(of_part);
        self.arrays.iter().cloned().chain(parts).collect()
    }

    /// The inverse of [`Prepared::flat`]; `None` where a part is missing before another.
    pub(super) fn of_flat(arrays: Vec<(String, Array)>) -> Option<Prepared> {
        let mut whole = Prepared::nothing();
        let mut of_parts: Vec<Vec<(String, Array)>> = Vec::new();
        for (name, array) in arrays {
            let Some((part, rest)) = name.split_once('/') else {
                whole.arrays.push((name, array));
                continue;
            };
            let place: usize = part.parse().ok().filter(|place| *place <= of_parts.len())?;
            if place == of_parts.len() {
                of_parts.push(Vec::new());
            }
            of_parts[place].push((rest.to_string(), array));
        }
        whole.parts = of_parts.into_iter().map(Prepared::of_flat).collect::<Option<_>>()?;
        Some(whole)
    }
}

/// What a preparation is made for, but for the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    method: MethodId,
    settings: Vec<(&'static str, Option<String>)>,
}

impl Asked {
    /// By a method with settings, of which those that affect it count.
    pub fn by(method: &dyn Method, settings: &Settings) -> Asked {
        let affecting = settings.iter().filter(|(spec, _)| spec.affects == Affects::Prepare);
        let texts = affecting.map(|(spec, _)| (spec.key, settings.text(spec.key))).collect();
        Asked { method: method.info().id, settings: texts }
    }
}

/// All that a preparation depends on, in words and hashes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// Id of the method.
    pub method: String,
    /// Its [`MethodInfo::revision`].
    pub revision: u32,
    /// The settings that affect it, as text.
    pub settings: BTreeMap<String, String>,
    /// Hashes of the parts of the scene that it reads, by [`Reads::parts`].
    pub scene: BTreeMap<String, String>,
}

impl Origin {
    /// That of a preparation by a method. Hashes the scene, see [`fingerprint::Fingerprint::new`].
    pub fn of(method: &dyn Method, settings_given: &Settings, scene: &Scene) -> Origin {
        use fingerprint::{environment, geometry, lights, materials, probes, sky};
        let MethodInfo { reads, revision, .. } = method.info();
        let Asked { method: id, settings } = Asked::by(method, settings_given);
        let scene = &*method.seen(scene, settings_given);
        let digests: [fn(&Scene) -> Digest; 6] = [geometry, materials, lights, environment, sky, probes];
        let read = reads.parts().into_iter().zip(digests).filter(|((_, reads), _)| *reads);
        Origin {
            method: id.0.into(),
            revision: *revision,
            settings: settings.into_iter().map(|(key, text)| (key.into(), text.unwrap_or_default())).collect(),
            scene: read.map(|((name, _), digest)| (name.into(), digest(scene).to_string())).collect(),
        }
    }

    /// Hash of it.
    pub fn key(&self) -> String {
        // Maps of text are always written.
        let text = serde_json::to_vec(self).unwrap_or_default();
        blake3::hash(&text).to_hex().to_string()
    }

    /// Names of the parts of the scene in which another differs.
    pub fn other_parts<'a>(&'a self, other: &'a Origin) -> Vec<&'a str> {
        other_names(&self.scene, &other.scene)
    }

    /// Names of the settings in which another differs.
    pub fn other_settings<'a>(&'a self, other: &'a Origin) -> Vec<&'a str> {
        other_names(&self.settings, &other.settings)
    }
}

/// Names whose texts differ, or are in one only.
fn other_names<'a>(a: &'a BTreeMap<String, String>, b: &'a BTreeMap<String, String>) -> Vec<&'a str> {
    let names: BTreeSet<&str> = a.keys().chain(b.keys()).map(String::as_str).collect();
    names.into_iter().filter(|name| a.get(*name) != b.get(*name)).collect()
}

/// Hash of all that a preparation depends on: the method with its revision, the settings that affect it, the parts of the
/// scene that it reads.
pub fn key(method: &dyn Method, settings: &Settings, scene: &Scene) -> String {
    Origin::of(method, settings, scene).key()
}

/// A folder of preparations, or none. Who has one does not wait twice for the same.
#[derive(Clone, Debug, Default)]
pub struct Store {
    folder: Option<PathBuf>,
    /// What was given for a method, whatever the scene.
    given: Option<(MethodId, Arc<Prepared>)>,
}

impl Store {
    /// Keeps nothing.
    pub fn none() -> Store {
        Store::default()
    }

    /// In a folder, which is made when there is something to keep.
    pub fn within(folder: &Path) -> Store {
        Store { folder: Some(folder.into()), given: None }
    }

    /// The same, but a method has what is given here, also where that is of another state of the scene.
    #[must_use]
    pub fn giving(self, method: MethodId, prepared: Arc<Prepared>) -> Store {
        Store { given: Some((method, prepared)), ..self }
    }

    /// What was kept under a key; damaged files count as none.
    pub fn read(&self, key: &str) -> Option<Prepared> {
        let path = self.path(key).filter(|path| path.exists())?;
        let container = Container::read(&path, KIND, MAX_BYTES).ok()?;
        if container.header.get("key")?.as_str()? != key {
            return None;
        }
        Prepared::of_flat(container.into_arrays())
    }

    /// Keeps a preparation, unless it is [fleeting](Prepared::is_fleeting).
    pub fn keep(&self, key: &str, prepared: &Prepared) -> Result<(), FileError> {
        if prepared.is_fleeting() {
            return Ok(());
        }
        let (Some(folder), Some(path)) = (&self.folder, self.path(key)) else { return Ok(()) };
        let remedy = "free some space, or allow writing there";
        std::fs::create_dir_all(folder).map_err(|e| FileError::new(folder, e.to_string(), remedy))?;
        let header = json!({ "key": key, "software": concat!("Burnish ", env!("CARGO_PKG_VERSION")) });
        Container::of_arrays(KIND, header, prepared.flat()).write(&path)
    }

    /// The preparation of a scene under its [`key`]: read, or computed and kept. One that cannot be kept is given all the same.
    pub fn prepare(
        &self,
        key: &str,
        method: &dyn Method,
        world: &World,
        settings: &Settings,
        job: &Handle,
    ) -> Result<Arc<Prepared>, MethodError> {
        if let Some((_, given)) = self.given.as_ref().filter(|(id, _)| *id == method.info().id) {
            return Ok(given.clone());
        }
        if let Some(prepared) = self.read(key) {
            return Ok(Arc::new(prepared));
        }
        let prepared = method.prepare(world, settings, job)?;
        if !prepared.is_nothing() {
            // It is made again next time.
            let _ = self.keep(key, &prepared);
        }
        Ok(Arc::new(prepared))
    }

    fn path(&self, key: &str) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(format!("{key}.prepared")))
    }
}
