//! Lighting presets: lights around a subject, as they are kept in files and put into documents.
//!
//! A file in `presets/lighting` states lights for a subject that fills a sphere of radius 1 about the origin, its front toward
//! +z. In a document they stand around its subject, larger or smaller with it, and give it the same illuminance.

use std::path::Path;
use std::sync::LazyLock;

use glam::Vec3;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{Document, EnvironmentEntry, LightEntry};
use crate::file::read_bounded;
use crate::material::preset::Header;
use crate::scene::photometry::Unit;
use crate::scene::{Bounds, Scene};

/// The `format` of a preset.
pub const FORMAT: &str = "burnish-lighting";
/// The `version` that is read.
pub const VERSION: u32 = 1;
/// Most lights of a preset.
const MOST: usize = 64;
/// Largest file in bytes.
const MAX_BYTES: usize = 1 << 20;

/// Lights around a subject. Fields that this version does not know are kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightingPreset {
    /// Always `burnish-lighting`.
    pub format: String,
    /// Of the format, 1.
    pub version: u32,
    /// Unique name such as `three-point`: letters, digits, `.`, `-`, `_`.
    pub id: String,
    /// Name for people.
    pub name: String,
    /// What it is for.
    #[serde(default)]
    pub note: String,
    /// Strength and turn of the environment that is there; the rest of the entry counts for nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub environment: Option<EnvironmentEntry>,
    /// Around a sphere of radius 1 about the origin; powers are those for this size.
    pub lights: Vec<LightEntry>,
    /// Fields of other versions.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// Why there is no preset. Its text names file, field and remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PresetError {
    /// The file cannot be read.
    #[error("{0}")]
    File(String),
    /// None of that name.
    #[error("no such lighting; known: {known}; or the path of a .json file")]
    Unknown {
        /// What was asked for.
        wanted: String,
        /// Ids of the program.
        known: String,
    },
    /// It is not JSON, or a field is missing or of the wrong kind.
    #[error("{origin}: {reason}; write it as presets/README.md shows")]
    Json {
        /// File or id.
        origin: String,
        /// Field and place.
        reason: String,
    },
    /// A field has a value that no preset has.
    #[error("{origin}: field `{field}` {reason}; {remedy}")]
    Field {
        /// File or id.
        origin: String,
        /// Name of the field.
        field: String,
        /// What is wrong with it.
        reason: String,
        /// What to do.
        remedy: &'static str,
    },
}

/// The files of `presets/lighting`, in the order in which people look for them.
const FILES: &[(&str, &str)] = &[
    ("three-point.json", include_str!("../../../presets/lighting/three-point.json")),
    ("top-softbox.json", include_str!("../../../presets/lighting/top-softbox.json")),
    ("strip-pair.json", include_str!("../../../presets/lighting/strip-pair.json")),
    ("rim.json", include_str!("../../../presets/lighting/rim.json")),
    ("window.json", include_str!("../../../presets/lighting/window.json")),
    ("overcast.json", include_str!("../../../presets/lighting/overcast.json")),
    ("sunset.json", include_str!("../../../presets/lighting/sunset.json")),
    ("jewellery-tent.json", include_str!("../../../presets/lighting/jewellery-tent.json")),
    ("car-gallery.json", include_str!("../../../presets/lighting/car-gallery.json")),
];

/// Parsed once. A file with a fault would be left out; a test shows that none has one.
static LIBRARY: LazyLock<Vec<LightingPreset>> =
    LazyLock::new(|| FILES.iter().filter_map(|(file, text)| LightingPreset::parse(text, file).ok()).collect());

/// An id made of a name: its letters and digits, with `-` between.
fn id_of(name: &str) -> String {
    let plain =
        name.to_lowercase().chars().map(|c| if c.is_ascii_alphanumeric() { c } else { ' ' }).collect::<String>();
    let id: String = plain.split_whitespace().collect::<Vec<_>>().join("-").chars().take(64).collect();
    let id = id.trim_matches('-');
    if id.is_empty() { "lights".into() } else { id.into() }
}

/// Middle and radius of what a preset stands around; of a sphere of 1 m where there is nothing.
fn sphere(subject: Bounds) -> (Vec3, f64) {
    let radius = f64::from(subject.radius());
    (subject.center(), if radius > 0.0 && radius.is_finite() { radius } else { 1.0 })
}

/// A light of a preset for a subject that is so many times larger, with the same illuminance.
fn scaled(light: &LightEntry, factor: f64) -> LightEntry {
    let by_size = matches!(light.unit(), Unit::Lumen | Unit::Candela | Unit::Watt) && light.shape.has_place();
    LightEntry {
        shape: light.shape.scaled(factor),
        position: light.position.map(|metres| metres * factor),
        power: if by_size { light.power * factor * factor } else { light.power },
        range: light.range.map(|metres| metres * factor),
        ..light.clone()
    }
}

impl LightingPreset {
    /// Those that come with the program.
    pub fn library() -> &'static [LightingPreset] {
        &LIBRARY
    }

    /// One of the program by its id or name, without regard to case, else that of a file.
    pub fn find(wanted: &str) -> Result<LightingPreset, PresetError> {
        let lower = wanted.trim().to_lowercase();
        let is_meant = |preset: &&LightingPreset| preset.id == lower || preset.name.to_lowercase() == lower;
        if let Some(preset) = LIBRARY.iter().find(is_meant) {
            return Ok(preset.clone());
        }
        if !lower.ends_with(".json") {
            let known = LIBRARY.iter().map(|preset| preset.id.as_str()).collect::<Vec<_>>().join(", ");
            return Err(PresetError::Unknown { wanted: wanted.into(), known });
        }
        LightingPreset::read(Path::new(wanted))
    }

    /// Reads and checks a file.
    pub fn read(path: &Path) -> Result<LightingPreset, PresetError> {
        let origin = path.display().to_string();
        let bytes = read_bounded(path, MAX_BYTES as u64).map_err(|e| PresetError::File(e.to_string()))?;
        let text = String::from_utf8(bytes)
            .map_err(|e| PresetError::Json { origin: origin.clone(), reason: e.to_string() })?;
        LightingPreset::parse(&text, &origin)
    }

    /// Reads and checks the text of a file; `origin` (file or id) starts the message.
    pub fn parse(text: &str, origin: &str) -> Result<LightingPreset, PresetError> {
        let json = |reason: String| PresetError::Json { origin: origin.into(), reason };
        if text.len() > MAX_BYTES {
            return Err(json(format!("has {} bytes, more than any preset", text.len())));
        }
        let preset: LightingPreset = serde_json::from_str(text).map_err(|e| json(e.to_string()))?;
        preset.check(origin)?;
        Ok(preset)
    }

    /// The text of a file.
    pub fn to_text(&self) -> String {
        // Its values are all of kinds that JSON has.
        serde_json::to_string_pretty(self).map(|text| text + "\n").unwrap_or_default()
    }

    /// Refuses what cannot be a preset; `origin` (file or id) starts the message.
    pub fn check(&self, origin: &str) -> Result<(), PresetError> {
        let fault = |field: &str, reason: String, remedy| {
            Err(PresetError::Field { origin: origin.into(), field: field.into(), reason, remedy })
        };
        let header = Header {
            format: (&self.format, FORMAT),
            version: (self.version, VERSION),
            id: &self.id,
            name: &self.name,
            remedies: ["set it to `burnish-lighting`", "name the preset"],
        };
        if let Some((field, reason, remedy)) = header.fault() {
            return fault(field, reason, remedy);
        }
        if let Some(Err(reason)) = self.environment.as_ref().map(|environment| environment.check("")) {
            return fault("environment", reason, "take a number in that range");
        }
        if self.lights.len() > MOST {
            return fault("lights", format!("has {}", self.lights.len()), "leave at most 64");
        }
        for (place, light) in self.lights.iter().enumerate() {
            let field = |name: &str| format!("lights[{place}].{name}");
            if light.name.trim().is_empty() || self.lights[..place].iter().any(|other| other.name == light.name) {
                return fault(&field("name"), format!("is `{}`", light.name), "give each light a name of its own");
            }
            let kind = light.kind();
            if Unit::of_symbol(&light.unit).is_none_or(|unit| unit.per_base(&kind).is_none()) {
                let units: Vec<&str> = Unit::of_kind(&kind).map(Unit::symbol).collect();
                let reason = format!("is `{}`, which such a light has not ({})", light.unit, units.join(", "));
                return fault(&field("unit"), reason, "take one of these, or give the light a size");
            }
            if !(light.power.is_finite() && light.power >= 0.0) {
                return fault(&field("power"), format!("is {}", light.power), "take a number from 0 on");
            }
        }
        Ok(())
    }

    /// The lights around a subject.
    pub fn lights_around(&self, subject: Bounds) -> Vec<LightEntry> {
        let (center, radius) = sphere(subject);
        let place = |light: &LightEntry| {
            let mut light = scaled(light, radius);
            light.set_place(light.place() + center);
            light
        };
        self.lights.iter().map(place).collect()
    }

    /// The lights of a document around its subject as a preset, the inverse of [`Document::apply_lighting`].
    pub fn of_document(name: &str, document: &Document, model: &Scene, subject: Bounds) -> LightingPreset {
        let (center, radius) = sphere(subject);
        let place = |mut light: LightEntry| {
            light.set_place(light.place() - center);
            // Objects of this model mean nothing to another.
            light.unlit.clear();
            scaled(&light, 1.0 / radius)
        };
        LightingPreset {
            format: FORMAT.into(),
            version: VERSION,
            id: id_of(name),
            name: name.into(),
            note: String::new(),
            environment: Some(EnvironmentEntry {
                rotation_deg: document.environment.rotation_deg,
                strength: document.environment.strength,
                ..EnvironmentEntry::default()
            }),
            lights: document.light_entries(model).into_iter().map(place).collect(),
            other: Map::new(),
        }
    }
}

impl Document {
    /// Lights the subject by a preset: its lights replace all others; the environment gets its strength and turn and stays what
    /// it is otherwise.
    pub fn apply_lighting(&mut self, preset: &LightingPreset, subject: Bounds) {
        self.lights = Some(preset.lights_around(subject));
        if let Some(environment) = &preset.environment {
            self.environment.strength = environment.strength;
            self.environment.rotation_deg = environment.rotation_deg;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::gallery;

    #[test]
    fn every_file_is_sound_and_lights_something() {
        for (file, text) in FILES {
            let preset = LightingPreset::parse(text, file).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(format!("{}.json", preset.id), *file);
            assert_eq!(LightingPreset::parse(&preset.to_text(), file).unwrap(), preset);
            assert!(!preset.note.is_empty() && !preset.lights.is_empty(), "{file}");
            // All lights together on the side that faces each, as they reach a subject of any size.
            let lux = |lights: &[LightEntry], radius: f64| -> f64 {
                lights.iter().map(|light| light.illuminance(f64::from(light.place().length()).max(0.1 * radius))).sum()
            };
            let small = Bounds { min: Vec3::splat(-0.01), max: Vec3::splat(0.01) };
            let around = preset.lights_around(small);
            let [one, other] = [lux(&preset.lights, 1.0), lux(&around, f64::from(small.radius()))];
            assert!((one / other - 1.0).abs() < 1e-4 && one > 1.0, "{file}: {one} and {other} lx");
        }
        assert_eq!(LightingPreset::library().len(), FILES.len());
    }

    #[test]
    fn a_document_gives_back_the_preset_that_it_was_lit_by() {
        let model = gallery::open("workbench").unwrap();
        let subject = Bounds { min: Vec3::new(1.0, 0.0, -0.5), max: Vec3::new(1.4, 0.9, 0.5) };
        for preset in LightingPreset::library() {
            let mut document = Document::new("gallery:workbench".into());
            document.environment.made = Some(crate::document::MadeEntry::Studio(Default::default()));
            document.environment.tint = [1.0, 0.5, 0.25];
            let around = document.environment.clone();
            document.apply_lighting(preset, subject);
            assert_eq!((&document.environment.made, document.environment.tint), (&around.made, around.tint));
            assert_eq!(Some(document.environment.strength), preset.environment.as_ref().map(|e| e.strength));
            let back = LightingPreset::of_document("My set, 2", &document, &model, subject);
            assert_eq!((back.id.as_str(), back.lights.len()), ("my-set-2", preset.lights.len()));
            for (a, b) in back.lights.iter().zip(&preset.lights) {
                assert!((a.place() - b.place()).length() < 1e-4, "{} {}", preset.id, a.name);
                assert!((a.power / b.power - 1.0).abs() < 1e-5 && a.unit == b.unit);
                assert!((a.direction() - b.direction()).length() < 1e-5);
            }
        }
    }

    #[test]
    fn faults_name_file_field_and_remedy() {
        let good = LightingPreset::library()[0].to_text();
        for (from, to, needles) in [
            ("burnish-lighting", "burnish-finish", ["format", "burnish-lighting"]),
            ("\"rotation_deg\"", "\"tint\": [-1, 1, 1], \"rotation_deg\"", ["environment", "tint"]),
            ("\"version\": 1", "\"version\": 2", ["version", "reads version 1"]),
            ("\"unit\": \"nit\"", "\"unit\": \"lx\"", ["lights[0].unit", "nit"]),
            ("\"three-point\"", "\"../etc\"", ["id", "x.json"]),
            ("\"power\":", "\"power\": \"much\", \"p\":", ["x.json", "expected f64"]),
        ] {
            assert!(good.contains(from), "{from}");
            let error = LightingPreset::parse(&good.replacen(from, to, 1), "x.json").unwrap_err().to_string();
            assert!(needles.iter().all(|needle| error.contains(needle)), "{error}");
        }
        let twice = good.replace("\"Fill\"", "\"Key\"");
        assert!(LightingPreset::parse(&twice, "x.json").unwrap_err().to_string().contains("name of its own"));
    }
}
