//! Materials kept for other documents: factors and a metal in one small file, without textures.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::Material;
use super::params::{self, PARAMS};
use super::preset::{self, FormChoice, Preset};
use crate::file::{FileError, read_bounded, write_atomic};
use crate::param::{self, ParamValue};

/// The `format` of a saved material.
pub const FORMAT: &str = "burnish-material";
/// The `version` that is read and written.
pub const VERSION: u32 = 1;
/// Largest file that is read: the table of an embedded metal may be long.
const MAX_BYTES: u64 = 4 << 20;
/// Longest name, in characters.
pub const NAME_MAX: usize = 80;

/// A material that stands alone. Fields that this version does not know are kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedMaterial {
    /// Always [`FORMAT`].
    pub format: String,
    /// Of the format, [`VERSION`].
    pub version: u32,
    /// Name for people.
    pub name: String,
    /// Words to find it by.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tags: Vec<String>,
    /// The metal that replaces its reflectance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub metal: Option<SavedMetal>,
    /// Factors by the keys of [`PARAMS`] where they differ from the default material.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub values: Map<String, Value>,
    /// Fields of other versions.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// The metal of a saved material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedMetal {
    /// Id such as `Au`.
    pub id: String,
    /// Fresnel form; that of the scene when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fresnel: Option<String>,
    /// The metal itself where it does not come with the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub constants: Option<Box<Preset>>,
}

/// Why there is no saved material. Its text names file, field and remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SavedError {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not JSON, or a field is missing or of the wrong kind.
    #[error("{}: {reason}; save the material anew in Burnish", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// Field and place.
        reason: String,
    },
    /// A field has a value that no material has.
    #[error("{origin}: field `{field}` {reason}; {remedy}")]
    Field {
        /// File or name.
        origin: String,
        /// Name of the field.
        field: String,
        /// What is wrong with it.
        reason: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The embedded metal is not one.
    #[error(transparent)]
    Metal(#[from] preset::PresetError),
}

impl SavedMaterial {
    /// Keeps the factors of a material; a factor out of its declared range is left at its default.
    pub fn new(name: &str, tags: Vec<String>, material: &Material, metal: Option<SavedMetal>) -> SavedMaterial {
        let mut values = Map::new();
        for spec in PARAMS {
            let value = params::get(material, spec.key).filter(|value| spec.accepts(*value));
            if let Some(value) = value.filter(|value| *value != spec.default()) {
                values.insert(spec.key.into(), spec.json(value));
            }
        }
        let (format, version) = (FORMAT.into(), VERSION);
        SavedMaterial { format, version, name: name.trim().into(), tags, metal, values, other: Map::new() }
    }

    /// Reads and checks a file.
    pub fn read(path: &Path) -> Result<SavedMaterial, SavedError> {
        let bytes = read_bounded(path, MAX_BYTES)?;
        let json = |reason: String| SavedError::Json { path: path.into(), reason };
        let text = String::from_utf8(bytes).map_err(|e| json(format!("is not UTF-8 text ({e})")))?;
        let saved: SavedMaterial =
            serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|e| json(e.to_string()))?;
        saved.check(&path.display().to_string())?;
        Ok(saved)
    }

    /// Writes the file as a whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), SavedError> {
        self.check(&path.display().to_string())?;
        let text = serde_json::to_string_pretty(self)
            .map_err(|e| SavedError::Json { path: path.into(), reason: e.to_string() })?;
        Ok(write_atomic(path, format!("{text}\n").as_bytes())?)
    }

    /// Refuses what cannot be a material; `origin` (file or name) starts the message.
    pub fn check(&self, origin: &str) -> Result<(), SavedError> {
        let fault = |field: &str, reason: String, remedy| {
            Err(SavedError::Field { origin: origin.into(), field: field.into(), reason, remedy })
        };
        if self.format != FORMAT {
            return fault("format", format!("is `{}`", self.format), "set it to `burnish-material`");
        }
        if self.version != VERSION {
            return fault("version", format!("is {}", self.version), "this program reads version 1");
        }
        if self.name.trim().is_empty() || self.name.chars().count() > NAME_MAX {
            return fault("name", format!("is `{}`", self.name), "give it a name of 1 to 80 characters");
        }
        for (key, json) in &self.values {
            if let Err(error) = param::find(PARAMS, key).and_then(|spec| spec.from_json(json)) {
                return fault(&format!("values.{key}"), format!("is refused ({error})"), "mend or remove the field");
            }
        }
        let Some(metal) = &self.metal else { return Ok(()) };
        if let Some(form) = metal.fresnel.as_ref().filter(|form| !FormChoice::IDS.contains(&form.as_str())) {
            return fault(
                "metal.fresnel",
                format!("is `{form}`"),
                "use `cheapest`, `spectral` or another form of presets/README.md, or leave it out",
            );
        }
        match &metal.constants {
            Some(constants) if constants.id != metal.id => {
                let reason = format!("is `{}` and `metal.id` is `{}`", constants.id, metal.id);
                fault("metal.constants.id", reason, "write the same id in both places")
            }
            Some(constants) => Ok(constants.check(&format!("{origin}: field `metal.constants`"))?),
            None if preset::library().iter().any(|known| known.id == metal.id) => Ok(()),
            None => {
                let remedy = "name a metal that comes with Burnish, or add its `constants`";
                fault("metal.id", format!("is `{}`", metal.id), remedy)
            }
        }
    }

    /// The value of a factor, that of the default material where nothing is stored.
    pub fn value(&self, key: &str) -> Option<ParamValue> {
        let spec = param::find(PARAMS, key).ok()?;
        self.values.get(key).and_then(|json| spec.from_json(json).ok()).or(Some(spec.default()))
    }

    /// The constants of its metal.
    pub fn constants(&self) -> Option<&Preset> {
        let metal = self.metal.as_ref()?;
        metal.constants.as_deref().or_else(|| preset::library().iter().find(|known| known.id == metal.id))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::testing::Folder;

    fn brushed() -> SavedMaterial {
        let material = Material { roughness: 0.3, anisotropy: 0.75, coat: 0.5, ..Material::default() };
        let metal = SavedMetal { id: "Au".into(), fresnel: Some("rescaled".into()), constants: None };
        SavedMaterial::new("Brushed gold", vec!["jewellery".into()], &material, Some(metal))
    }

    #[test]
    fn a_material_comes_back_from_its_file() {
        let folder = Folder::new();
        let path = folder.join("gold.json");
        let mut saved = brushed();
        saved.other.insert("later".into(), 7.into());
        saved.write(&path).unwrap();
        assert_eq!(SavedMaterial::read(&path), Ok(saved.clone()));
        assert_eq!(saved.value("roughness"), Some(ParamValue::Number(0.3)));
        assert_eq!(saved.value("ior"), Some(ParamValue::Number(1.5)));
        assert_eq!(saved.values.len(), 3, "only what differs is stored");
        assert_eq!(saved.constants().map(|metal| metal.name.as_str()), Some("Gold"));
    }

    #[test]
    fn an_embedded_metal_comes_along() {
        let own = Preset { id: "My-Au".into(), ..preset::find("Au").unwrap() };
        let metal = SavedMetal { id: own.id.clone(), fresnel: None, constants: Some(Box::new(own.clone())) };
        let saved = SavedMaterial::new("Mine", Vec::new(), &Material::default(), Some(metal));
        assert_eq!(saved.check("test"), Ok(()));
        let text = serde_json::to_string(&saved).unwrap();
        assert_eq!(serde_json::from_str::<SavedMaterial>(&text).unwrap().constants(), Some(&own));
    }

    #[test]
    fn what_no_material_has_is_refused_by_the_name_of_its_field() {
        let metal = |id: &str| SavedMetal { id: id.into(), fresnel: None, constants: None };
        let cases: [(&str, SavedMaterial); 6] = [
            ("`format`", SavedMaterial { format: "burnish-metal".into(), ..brushed() }),
            ("`version`", SavedMaterial { version: 2, ..brushed() }),
            ("`name`", SavedMaterial { name: "  ".into(), ..brushed() }),
            ("`values.roughness`", {
                let mut saved = brushed();
                saved.values.insert("roughness".into(), 2.into());
                saved
            }),
            ("`values.shine`", {
                let mut saved = brushed();
                saved.values.insert("shine".into(), 1.into());
                saved
            }),
            ("`metal.id`", SavedMaterial { metal: Some(metal("Unobtainium")), ..brushed() }),
        ];
        for (field, saved) in cases {
            let error = saved.check("mine.json").unwrap_err().to_string();
            assert!(error.starts_with("mine.json") && error.contains(field), "{error}");
        }
        let other = SavedMetal { constants: Some(Box::new(preset::find("Ag").unwrap())), ..metal("Au") };
        let error = SavedMaterial { metal: Some(other), ..brushed() }.check("mine.json").unwrap_err().to_string();
        assert!(error.contains("metal.constants.id"), "{error}");
        let form = SavedMetal { fresnel: Some("shiny".into()), ..metal("Au") };
        let error = SavedMaterial { metal: Some(form), ..brushed() }.check("mine.json").unwrap_err().to_string();
        assert!(error.contains("metal.fresnel"), "{error}");
    }

    #[test]
    fn text_that_is_no_material_is_refused_with_file_and_field() {
        let folder = Folder::new();
        let path = folder.join("a.json");
        for (text, part) in [("", "EOF"), ("{}", "format"), ("[1]", "a.json")] {
            write_atomic(&path, text.as_bytes()).unwrap();
            let error = SavedMaterial::read(&path).unwrap_err().to_string();
            assert!(error.contains("a.json") && error.contains(part), "{error}");
        }
    }
}
