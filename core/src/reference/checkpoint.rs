//! A film on disk, with what its samples came from: how a picture goes on after a pause, or after a power cut.
//!
//! Nothing but the film is stored: who goes on brings the scene, the view and the settings, and a [`Key`] tells whether
//! they are the same. Then the picture has the bytes that it would have had without the interruption.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, UVec2};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::waves::MetalWaves;
use super::{Film, Options, Pixel, Rejected, View, World};
use crate::file::{Container, FileError, Kind};
use crate::scene::fingerprint::{self, Fingerprint};
use crate::surface::ggx::Masking;

/// The kind of file.
pub const KIND: Kind = Kind { id: "reference-checkpoint", version: 1 };

/// Raised when the same scene, view, settings and seed give other samples than before, so that a film is not continued
/// with samples of another program.
pub const REVISION: u32 = 2;

/// Largest file that is read: that of the largest picture.
const MAX_BYTES: u64 = 4 << 30;

const REMEDY: &str = "go on with what it was made from, name another checkpoint, or remove it to begin anew";

/// What the samples of a film depend on, in words and hashes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Key {
    revision: u32,
    geometry: String,
    materials: String,
    lights: String,
    environment: String,
    /// Only where the eye sees something else than the environment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    background: Option<String>,
    camera: String,
    width: u32,
    height: u32,
    seed: u32,
    bounces: u32,
    /// As text: JSON knows no infinity.
    clamp: String,
    masking: String,
    multiple_scattering: bool,
    /// Whose light is shown.
    contribution: String,
    /// Hash of the metals when wavelengths are traced.
    wavelengths: Option<String>,
}

/// What stands in the header.
#[derive(Serialize, Deserialize)]
struct Header {
    software: String,
    key: Key,
    samples: u32,
    first_rejected: Option<RejectedEntry>,
}

#[derive(Serialize, Deserialize)]
struct RejectedEntry {
    sample: u32,
    pixel: [u32; 2],
}

impl Key {
    /// That of another seed.
    pub fn with_seed(&self, seed: u32) -> Key {
        Key { seed, ..self.clone() }
    }

    /// That of a tracing. Hashes the scene, see [`Fingerprint::new`].
    pub fn new(world: &World, view: &View) -> Key {
        let Fingerprint { geometry, materials, lights, environment, background } = Fingerprint::new(world.scene());
        let View { camera, size, seed } = view;
        let Options { bounces, clamp, masking, multiple_scattering, contribution } = *world.options();
        Key {
            revision: REVISION,
            geometry: geometry.to_string(),
            materials: materials.to_string(),
            lights: lights.to_string(),
            environment: environment.to_string(),
            background: background.map(|digest| digest.to_string()),
            camera: fingerprint::camera(camera).to_string(),
            width: size.x,
            height: size.y,
            seed: *seed,
            bounces,
            clamp: clamp.to_string(),
            masking: masking_word(masking).into(),
            multiple_scattering,
            contribution: contribution.word(),
            wavelengths: world.wavelengths().map(hash_of_metals),
        }
    }

    /// What differs between a file's key and this one, in words.
    fn differences(&self, file: &Key) -> Vec<String> {
        let mut list = Vec::new();
        let mut hash = |what: &str, here: &str, there: &str| {
            if here != there {
                list.push(what.to_string());
            }
        };
        hash("the geometry", &self.geometry, &file.geometry);
        hash("the materials", &self.materials, &file.materials);
        hash("the lights", &self.lights, &file.lights);
        hash("the environment", &self.environment, &file.environment);
        let seen = |key: &Key| key.background.clone().unwrap_or_default();
        hash("the background", &seen(self), &seen(file));
        hash("the camera", &self.camera, &file.camera);
        let mut word = |what: &str, here: String, there: String| {
            if here != there {
                list.push(format!("the {what} ({there} there, {here} here)"));
            }
        };
        let size = |key: &Key| format!("{}x{}", key.width, key.height);
        let switch = |on: bool| if on { "on" } else { "off" }.to_string();
        word("size", size(self), size(file));
        word("seed", self.seed.to_string(), file.seed.to_string());
        word("bounces", self.bounces.to_string(), file.bounces.to_string());
        word("clamp", self.clamp.clone(), file.clamp.clone());
        word("masking", self.masking.clone(), file.masking.clone());
        word("multiple scattering", switch(self.multiple_scattering), switch(file.multiple_scattering));
        word("light shown", self.contribution.clone(), file.contribution.clone());
        word("wavelengths", switch(self.wavelengths.is_some()), switch(file.wavelengths.is_some()));
        word("revision of the path tracer", self.revision.to_string(), file.revision.to_string());
        if let (Some(here), Some(there)) = (&self.wavelengths, &file.wavelengths)
            && here != there
        {
            list.push("the n and k of the metals".into());
        }
        list
    }
}

/// Each metal after a 1, materials without one as a 0.
fn hash_of_metals(metals: &[Option<Arc<MetalWaves>>]) -> String {
    let mut hasher = blake3::Hasher::new();
    for metal in metals {
        hasher.update(&[metal.is_some().into()]);
        let numbers = metal.iter().flat_map(|metal| metal.entries().as_flattened());
        numbers.for_each(|number| _ = hasher.update(&number.to_le_bytes()));
    }
    hasher.finalize().to_hex().to_string()
}

/// As settings name it.
pub(super) fn masking_word(masking: Masking) -> &'static str {
    match masking {
        Masking::Correlated => "correlated",
        Masking::Separable => "separable",
    }
}

/// Writes a film, whole or not at all.
pub fn write(path: &Path, film: &Film, key: &Key) -> Result<(), FileError> {
    let header = Header {
        software: concat!("Burnish ", env!("CARGO_PKG_VERSION")).into(),
        key: key.clone(),
        samples: film.samples(),
        first_rejected: film.first_rejected().map(|r| RejectedEntry { sample: r.sample, pixel: r.pixel.to_array() }),
    };
    // Words and numbers always have a JSON.
    let header = serde_json::to_value(header).unwrap_or(Value::Null);
    let words = |of: fn(&Pixel) -> u32| film.pixels().iter().map(of).collect::<Vec<u32>>();
    let vectors = |of: fn(&Pixel) -> DVec3| film.pixels().iter().flat_map(|p| of(p).to_array()).collect::<Vec<f64>>();
    let clamped: Vec<f64> = film.pixels().iter().map(|p| p.clamped).collect();
    Container::new(KIND, header)
        .with("count", words(|p| p.count))
        .with("rejected", words(|p| p.rejected))
        .with("hits", words(|p| p.hits))
        .with("instance", words(|p| p.instance))
        .with("material", words(|p| p.material))
        .with("mean", vectors(|p| p.mean))
        .with("deviations", vectors(|p| p.deviations))
        .with("normal", vectors(|p| p.normal))
        .with("albedo", vectors(|p| p.albedo))
        .with("clamped", clamped)
        .write(path)
}

/// Reads the film of a tracing with the same key; one of any other is refused with what differs.
pub fn read(path: &Path, key: &Key) -> Result<Film, FileError> {
    let mut file = Container::read(path, KIND, MAX_BYTES)?;
    let header: Header = serde_json::from_value(file.header.take())
        .map_err(|e| FileError::new(path, format!("has a description that makes no sense ({e})"), REMEDY))?;
    let differences = key.differences(&header.key);
    if !differences.is_empty() {
        let reason = format!("is the checkpoint of another picture; what differs: {}", differences.join(", "));
        return Err(FileError::new(path, reason, REMEDY));
    }
    let film = read_film(&mut file, &header, UVec2::new(key.width, key.height));
    film.map_err(|reason| FileError::new(path, reason, REMEDY))
}

fn read_film(file: &mut Container, header: &Header, size: UVec2) -> Result<Film, String> {
    let count = size.x as usize * size.y as usize;
    let mut pixels = vec![Pixel::default(); count];
    let mut words = |file: &mut Container, name: &str, set: fn(&mut Pixel, u32)| -> Result<(), String> {
        let values: Vec<u32> = file.take(name, count)?;
        pixels.iter_mut().zip(values).for_each(|(pixel, value)| set(pixel, value));
        Ok(())
    };
    words(file, "count", |p, v| p.count = v)?;
    words(file, "rejected", |p, v| p.rejected = v)?;
    words(file, "hits", |p, v| p.hits = v)?;
    words(file, "instance", |p, v| p.instance = v)?;
    words(file, "material", |p, v| p.material = v)?;
    let mut vectors = |file: &mut Container, name: &str, set: fn(&mut Pixel, DVec3)| -> Result<(), String> {
        let values: Vec<f64> = file.take(name, 3 * count)?;
        let (values, _) = values.as_chunks::<3>();
        pixels.iter_mut().zip(values).for_each(|(pixel, value)| set(pixel, DVec3::from_array(*value)));
        Ok(())
    };
    vectors(file, "mean", |p, v| p.mean = v)?;
    vectors(file, "deviations", |p, v| p.deviations = v)?;
    vectors(file, "normal", |p, v| p.normal = v)?;
    vectors(file, "albedo", |p, v| p.albedo = v)?;
    let clamped: Vec<f64> = file.take("clamped", count)?;
    pixels.iter_mut().zip(clamped).for_each(|(pixel, value)| pixel.clamped = value);

    let first = header.first_rejected.as_ref();
    let first = first.map(|r| Rejected { sample: r.sample, pixel: UVec2::from_array(r.pixel) });
    Film::from_parts(size, header.samples, pixels, first).ok_or_else(|| "has counts that do not fit each other".into())
}

#[cfg(test)]
#[path = "checkpoint_tests.rs"]
mod tests;
