//! Finishes and coats: what was done to the surface of a metal, as values of factors.
//!
//! A material is a metal, a finish and a coat. Each finish is one file in `presets/finishes` and states factors by the
//! keys of [`PARAMS`]. Nothing stores which finish a material has: it is found by comparing values, see [`of`].

#[cfg(test)]
mod tests;

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::Material;
use super::params::{self, PARAMS, Values};
use super::preset;
use crate::param::{self, ParamValue};

/// The `format` of a finish.
pub const FORMAT: &str = "burnish-finish";
/// The `version` that is read.
pub const VERSION: u32 = 1;

/// What a file describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// How the metal was worked: roughness, brushing, bumps.
    Finish,
    /// What lies over it.
    Coat,
}

impl Kind {
    /// Both.
    pub const ALL: [Kind; 2] = [Kind::Finish, Kind::Coat];

    /// The factors that it sets, and all of them: what a file leaves out goes to its declared default.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Kind::Finish => {
                &["roughness", "anisotropy", "anisotropy-rotation", "micro-normal", "micro-size", "micro-depth"]
            }
            Kind::Coat => &["coat", "coat-roughness"],
        }
    }

    /// What it is called in messages and files.
    pub fn word(self) -> &'static str {
        match self {
            Kind::Finish => "finish",
            Kind::Coat => "coat",
        }
    }
}

/// A finish or a coat. Fields that this version does not know are kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finish {
    /// Always [`FORMAT`].
    pub format: String,
    /// Of the format, [`VERSION`].
    pub version: u32,
    /// Unique name such as `bead-blasted`: letters, digits, `.`, `-`, `_`.
    pub id: String,
    /// Name for people.
    pub name: String,
    /// Which factors it sets.
    pub kind: Kind,
    /// What it is, and where the values come from.
    pub note: String,
    /// Factors by key, see [`Kind::keys`].
    pub values: Map<String, Value>,
    /// Fields of other versions.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// Why there is no finish. Its text names file, field and remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FinishError {
    /// It is not JSON, or a field is missing or of the wrong kind.
    #[error("{origin}: {reason}; write it as presets/README.md shows")]
    Json {
        /// File or id.
        origin: String,
        /// Field and place.
        reason: String,
    },
    /// A field has a value that no finish has.
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
    /// None of that name.
    #[error("no {} `{wanted}`; {hint}", kind.word())]
    Unknown {
        /// What was looked for.
        kind: Kind,
        /// What was asked for.
        wanted: String,
        /// Names that come near, or all.
        hint: String,
    },
}

/// The files of `presets/finishes`, in the order in which people look for them: from smooth to rough.
const FILES: &[(&str, &str)] = &[
    ("mirror.json", include_str!("../../../presets/finishes/mirror.json")),
    ("polished.json", include_str!("../../../presets/finishes/polished.json")),
    ("satin.json", include_str!("../../../presets/finishes/satin.json")),
    ("brushed.json", include_str!("../../../presets/finishes/brushed.json")),
    ("bead-blasted.json", include_str!("../../../presets/finishes/bead-blasted.json")),
    ("cast.json", include_str!("../../../presets/finishes/cast.json")),
    ("hammered.json", include_str!("../../../presets/finishes/hammered.json")),
    ("none.json", include_str!("../../../presets/finishes/none.json")),
    ("clear-lacquer.json", include_str!("../../../presets/finishes/clear-lacquer.json")),
    ("satin-lacquer.json", include_str!("../../../presets/finishes/satin-lacquer.json")),
];

/// Parsed once. A file with a fault would be left out; a test shows that none has one.
static LIBRARY: LazyLock<Vec<Finish>> =
    LazyLock::new(|| FILES.iter().filter_map(|(file, text)| Finish::parse(text, file).ok()).collect());

/// All finishes and coats, from smooth to rough.
pub fn library() -> &'static [Finish] {
    &LIBRARY
}

/// Those of one kind.
pub fn list(kind: Kind) -> impl Iterator<Item = &'static Finish> {
    library().iter().filter(move |finish| finish.kind == kind)
}

/// Finds one by its id or name, without regard to case.
pub fn find(kind: Kind, wanted: &str) -> Result<&'static Finish, FinishError> {
    let lower = wanted.trim().to_lowercase();
    let found = list(kind).find(|finish| finish.id.to_lowercase() == lower || finish.name.to_lowercase() == lower);
    found.ok_or_else(|| {
        let known: Vec<(&str, &str)> = list(kind).map(|finish| (finish.id.as_str(), finish.name.as_str())).collect();
        FinishError::Unknown { kind, wanted: wanted.into(), hint: preset::hint(&lower, &known) }
    })
}

/// The finish or coat that a material has, by its values; `None` where no file says the same.
pub fn of(material: &Material, kind: Kind) -> Option<&'static Finish> {
    list(kind).find(|finish| finish.is_on(material))
}

impl Finish {
    /// Reads and checks the text of a file; `origin` (file or id) starts the message.
    pub fn parse(text: &str, origin: &str) -> Result<Finish, FinishError> {
        let json = |e: serde_json::Error| FinishError::Json { origin: origin.into(), reason: e.to_string() };
        let finish: Finish = serde_json::from_str(text).map_err(json)?;
        finish.check(origin)?;
        Ok(finish)
    }

    /// Refuses what cannot be a finish; `origin` (file or id) starts the message.
    pub fn check(&self, origin: &str) -> Result<(), FinishError> {
        let fault = |field: &str, reason: String, remedy| {
            Err(FinishError::Field { origin: origin.into(), field: field.into(), reason, remedy })
        };
        let header = preset::Header {
            format: (&self.format, FORMAT),
            version: (self.version, VERSION),
            id: &self.id,
            name: &self.name,
            remedies: ["set it to `burnish-finish`", "name the finish"],
        };
        if let Some((field, reason, remedy)) = header.fault() {
            return fault(field, reason, remedy);
        }
        for (key, json) in &self.values {
            if !self.kind.keys().contains(&key.as_str()) {
                let reason = format!("is no factor of a {}", self.kind.word());
                return fault(&format!("values.{key}"), reason, "remove it; presets/README.md lists the factors");
            }
            if let Err(error) = param::find(PARAMS, key).and_then(|spec| spec.from_json(json)) {
                return fault(&format!("values.{key}"), format!("is refused ({error})"), "mend or remove the field");
            }
        }
        Ok(())
    }

    /// Every factor that it sets, with its value: the default of [`PARAMS`] where the file has none.
    pub fn values(&self) -> Values {
        let specs = self.kind.keys().iter().filter_map(|key| param::find(PARAMS, key).ok());
        let value = |spec: &'static param::ParamSpec| {
            let stored = self.values.get(spec.key).and_then(|json| spec.from_json(json).ok());
            (spec.key, stored.unwrap_or(spec.default()))
        };
        specs.map(value).collect()
    }

    /// Gives a material its factors. What the finish before it set is gone: from hammered to mirror takes the dents off.
    pub fn apply(&self, material: &mut Material) {
        params::apply(material, &self.values());
    }

    /// A material with it would look the same as the material does.
    fn is_on(&self, material: &Material) -> bool {
        let values = self.values();
        let zero = |key: &str| values.get(key) == Some(&ParamValue::Number(0.0));
        let counts = |key: &str| match key {
            "anisotropy-rotation" => !zero("anisotropy"),
            "micro-size" | "micro-depth" => values.get("micro-normal") != Some(&ParamValue::Choice(0)),
            "coat-roughness" => !zero("coat"),
            _ => true,
        };
        // Through a material, as its factors are of another precision than the file's.
        let mut like = material.clone();
        self.apply(&mut like);
        let mut keys = self.kind.keys().iter().filter(|key| counts(key));
        keys.all(|key| params::get(&like, key) == params::get(material, key))
    }
}
