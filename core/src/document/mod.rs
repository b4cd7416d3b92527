//! The document: what is saved of a session at the workbench, how it is edited, undone, and turned into a scene.
//!
//! A document refers to a model and an environment by path and holds what was changed: materials, assignments, names,
//! cameras, view. [`open`] reads it with its sources, [`resolve`] makes the [`Scene`](crate::scene::Scene) that is
//! drawn, [`History`] undoes. No window and no GPU here: the command line uses the same functions.

mod by_method;
mod camera;
mod difference;
mod edit;
mod environment;
mod format;
mod history;
mod keys;
mod light;
mod lighting_preset;
mod lights;
mod maps;
mod open;
mod paths;
mod probe;
mod resolve;
mod shape;
mod snapshot;
mod transform;

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::lighting::{self, Method, classical};
use crate::material::TextureRole;
use crate::material::preset::{FormChoice, Preset};
use crate::param::{self, ParamSpec, ParamValue, Settings};
use crate::reference;
use crate::surface::fresnel::Form;

pub use by_method::mixed_methods;
pub use difference::{Difference, Part, Place, differences};
pub use edit::{Assigned, free};
pub use environment::{BackgroundEntry, EnvironmentEntry, GroundEntry, MadeEntry, SkyEntry, SoftBoxEntry, StudioEntry};
pub use format::{DocumentError, FORMAT, MAX_BYTES, VERSION};
pub use history::{History, Step, VIEW_LABEL};
pub use keys::{material_keys, object_keys};
pub use light::LightEntry;
pub use lighting_preset::{LightingPreset, PresetError};
pub use lights::{entries_of, shining};
pub use open::{
    Missing, MissingKind, Opened, Sources, is_document, load_image, load_map, load_model, open, placeholder, reload,
};
pub use paths::{absolute, relative};
pub use probe::{PATHS as PROBE_PATHS, ProbeEntry, RESOLUTIONS as PROBE_RESOLUTIONS};
pub use resolve::{Curves, Resolved, resolve};
pub use shape::Shape;
pub use snapshot::{CompareEntry, Side, SideEntry, Snapshot};
pub use transform::TransformEntry;

/// Scene of a new document.
pub const DEFAULT_SCENE: &str = "gallery:workbench";

/// Everything that is saved. Paths are absolute in memory and relative to the file on disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Document {
    /// Path of the model, or `gallery:NAME`.
    pub scene: String,
    /// Keys of the instances that the picture is about; empty for all.
    #[serde(default)]
    pub subject: Vec<String>,
    /// All materials, those of the model first.
    #[serde(default, with = "shared")]
    pub materials: Vec<Arc<MaterialEntry>>,
    /// Objects that do not have the material of the model.
    #[serde(default)]
    pub assignments: Vec<Assignment>,
    /// Objects that were renamed, hidden or moved.
    #[serde(default)]
    pub objects: Vec<ObjectEntry>,
    /// Metals in use that do not come with the program.
    #[serde(default, with = "shared", skip_serializing_if = "Vec::is_empty")]
    pub presets: Vec<Arc<Preset>>,
    /// Light from infinitely far away.
    #[serde(default)]
    pub environment: EnvironmentEntry,
    /// Lights other than the environment; those of the model when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lights: Option<Vec<LightEntry>>,
    /// Places from which methods record the surroundings of objects; the method's own when empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probes: Vec<ProbeEntry>,
    /// Saved points of view.
    #[serde(default)]
    pub cameras: Vec<CameraEntry>,
    /// How light is computed.
    #[serde(default)]
    pub lighting: LightingEntry,
    /// What the viewport shows.
    #[serde(default)]
    pub view: ViewEntry,
    /// States that were kept under names.
    #[serde(default, with = "shared", skip_serializing_if = "Vec::is_empty")]
    pub snapshots: Vec<Arc<Snapshot>>,
    /// Which of them are compared.
    #[serde(default, skip_serializing_if = "is_default")]
    pub compare: CompareEntry,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// A material: one of the model or the default one, with what was changed about it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MaterialEntry {
    /// Unique in the document.
    pub name: String,
    /// Key of the material of the model that it starts from; the default material when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// The metal that replaces its reflectance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<PresetUse>,
    /// Changed factors by the keys of [`crate::material::params::PARAMS`].
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub values: Map<String, Value>,
    /// Changed textures by role, see [`role_key`].
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub textures: BTreeMap<String, TextureChoice>,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// A metal on a material.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PresetUse {
    /// Id such as `Au`.
    pub id: String,
    /// Fresnel form, one of [`FormChoice::IDS`](crate::material::preset::FormChoice::IDS); that of the lighting settings when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fresnel: Option<String>,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// What stands in a texture slot instead of the model's texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TextureChoice {
    /// Nothing.
    None,
    /// A PNG or JPEG file.
    File(String),
    /// An image of the model by its place in the list.
    Image(usize),
}

/// Which material an object has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Assignment {
    /// Key of the object.
    pub object: String,
    /// Name of the material.
    pub material: String,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// Changes to an object of the model.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObjectEntry {
    /// Its key, see [`object_keys`].
    pub key: String,
    /// Name for people instead of the model's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Not drawn.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hidden: bool,
    /// Where it was put instead of its place in the model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transform: Option<TransformEntry>,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// A point of view that turns about a target: +y is up, the front of a model looks along +z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CameraEntry {
    /// Unique among the saved cameras.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// What it turns about, metres.
    pub target: [f64; 3],
    /// From the target, metres, above 0.
    pub distance: f64,
    /// Degrees about +y from the front.
    pub yaw_deg: f64,
    /// Degrees above the horizon, -90 to 90.
    pub pitch_deg: f64,
    /// Degrees about the line of sight.
    #[serde(default)]
    pub roll_deg: f64,
    /// Full vertical angle, 1 to 170 degrees. An orthographic view shows what this angle covers at the target.
    pub yfov_deg: f64,
    /// Parallel instead of perspective.
    #[serde(default)]
    pub orthographic: bool,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// The lighting method with its settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightingEntry {
    /// Id of the method.
    pub method: String,
    /// Changed settings by key.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub settings: Map<String, Value>,
    /// Changed settings of the methods that were chosen before, by id.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub other_settings: BTreeMap<String, Map<String, Value>>,
    /// Objects that another method lights, by key.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub overrides: BTreeMap<String, OverrideEntry>,
    /// Changed settings of the [reference](mod@reference) by key, without those that it shares with the method.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub reference: Map<String, Value>,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// The method that lights an object other than the rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OverrideEntry {
    /// Id of the method.
    pub method: String,
    /// Changed settings by key.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub settings: Map<String, Value>,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// What the viewport shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewEntry {
    /// From where.
    #[serde(default)]
    pub camera: CameraEntry,
    /// Factor on the radiance before the tone map, as a power of two.
    #[serde(default)]
    pub exposure_ev: f64,
    /// Name of a [`crate::color::tone::ToneMap`].
    #[serde(default = "default_tone")]
    pub tone: String,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// Shared values are written like others.
mod shared {
    use std::sync::Arc;

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<T: Serialize, S: Serializer>(list: &[Arc<T>], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(list.iter().map(Arc::as_ref))
    }

    pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(from: D) -> Result<Vec<Arc<T>>, D::Error> {
        Ok(Vec::<T>::deserialize(from)?.into_iter().map(Arc::new).collect())
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn one() -> f64 {
    1.0
}

fn default_tone() -> String {
    crate::color::tone::ToneMap::default().id().into()
}

impl Default for LightingEntry {
    fn default() -> Self {
        LightingEntry {
            method: classical::ID.into(),
            settings: Map::new(),
            other_settings: BTreeMap::new(),
            overrides: BTreeMap::new(),
            reference: Map::new(),
            other: Map::new(),
        }
    }
}

impl Default for ViewEntry {
    fn default() -> Self {
        ViewEntry { camera: CameraEntry::default(), exposure_ev: 0.0, tone: default_tone(), other: Map::new() }
    }
}

/// Settings that the reference shares with the lighting method: both are about the same surface.
pub const SHARED_SETTINGS: [&str; 2] = ["masking", "multiple-scattering"];

impl LightingEntry {
    /// The live method: that of the id, `classical` where this version knows none of it or it is the reference, which is
    /// shown beside every method.
    pub fn live_method(&self) -> &'static dyn Method {
        lighting::find(&self.method).filter(|found| found.info().id.0 != reference::ID).unwrap_or(&classical::Classical)
    }

    /// This version has no live method of that id.
    pub fn is_unknown(&self) -> bool {
        self.live_method().info().id.0 != self.method
    }

    /// The settings of the method, defaults where nothing or nonsense is stored.
    pub fn settings(&self) -> Settings {
        read_settings(self.live_method().info().params, &self.settings)
    }

    /// The settings of the reference, see [`LightingEntry::settings`]; the shared ones are those of the method.
    pub fn reference_settings(&self) -> Settings {
        let mut settings = read_settings(reference::PARAMS, &self.reference);
        let method = self.settings();
        for key in SHARED_SETTINGS {
            if let Some(value) = method.get(key) {
                // A test holds the two declarations together.
                let _ = settings.set_value(key, value);
            }
        }
        settings
    }

    /// The form in which the reference traces metals; its cheapest keeps the tolerances of the method.
    pub fn reference_form(&self) -> FormChoice {
        let text = self.reference_settings().text("fresnel").unwrap_or_default();
        let tolerance = classical::tolerance(&self.settings());
        FormChoice::read(&text, tolerance).unwrap_or(FormChoice::Of(Form::Spectral))
    }
}

fn read_settings(specs: &'static [ParamSpec], stored: &Map<String, Value>) -> Settings {
    let mut settings = Settings::new(specs);
    for (key, json) in stored {
        if let Ok(value) = param::find(specs, key).and_then(|spec| spec.from_json(json)) {
            // Found and accepted above.
            let _ = settings.set_value(key, value);
        }
    }
    settings
}

impl MaterialEntry {
    /// The stored value of a factor; `None` where it is that of the source, or nonsense.
    pub fn value(&self, key: &str) -> Option<ParamValue> {
        let spec = param::find(crate::material::params::PARAMS, key).ok()?;
        spec.from_json(self.values.get(key)?).ok()
    }
}

/// Name of a texture slot in documents, such as `base-color`.
pub fn role_key(role: TextureRole) -> String {
    role.name().replace(' ', "-")
}

#[cfg(test)]
mod tests;
