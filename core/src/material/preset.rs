//! Metal presets: measured optical constants, and the reflectance curves made from them.
//!
//! A preset holds n and k over wavelength with their source, one file each in `presets/metals`. What renders is made
//! here by spectral integration; nothing in a file is already a colour.

mod check;
mod fits;
mod library;
mod text;

pub(crate) use check::Header;
pub use check::{FORMAT, REQUIRED_RANGE_NM, VERSION, reaches_required};
pub use fits::{Cheapest, Fit, Fits, FormChoice, SAMPLED_NM, Tolerance};
pub(super) use library::hint;
pub use library::{IDS, find, library};

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::color::rgb;
use crate::color::spectrum::interpolate;
use crate::file::{FileError, read_bounded};
use crate::surface::fresnel::{Form, Fresnel, exact};

/// Longest id, in characters.
const MAX_ID: usize = 64;

/// The first of `id-2`, `id-3` ... that is not taken; as short as ids must be.
pub fn numbered_id(id: &str, taken: impl Fn(&str) -> bool) -> String {
    let mut ids = (2u64..).map(|number| {
        let suffix = format!("-{number}");
        let stem: String = id.chars().take(MAX_ID - suffix.len()).collect();
        stem + &suffix
    });
    ids.find(|candidate| !taken(candidate)).unwrap_or_default()
}

/// Largest preset file that is read and written.
const MAX_BYTES: u64 = 4 << 20;

/// Measured optical constants of a metal, with where they come from. Fields that this version does not know are kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Preset {
    /// Always [`FORMAT`].
    pub format: String,
    /// Of the format, [`VERSION`].
    pub version: u32,
    /// Unique name such as `Au`: letters, digits, `.`, `-`, `_`.
    pub id: String,
    /// Name for people.
    pub name: String,
    /// Chemical symbol or formula, where there is one.
    #[serde(default)]
    pub symbol: Option<String>,
    /// Words to find it by.
    #[serde(default)]
    pub tags: Vec<String>,
    /// Who measured it, and where the numbers were taken from.
    pub source: Source,
    /// What was measured, and how the table was made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// What speaks against trusting the numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warning: Option<String>,
    /// Wavelengths in vacuum, nm, strictly increasing.
    pub wavelength_nm: Vec<f64>,
    /// Real part of the refractive index at each wavelength, above 0.
    pub n: Vec<f64>,
    /// Extinction coefficient at each wavelength, 0 or more (index n + ik).
    pub k: Vec<f64>,
    /// Numbers and errors of the run-time forms; made anew where they are absent or not of this table.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "fits::lenient")]
    pub fits: Option<Fits>,
    /// Fields of other versions.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// Where a measurement comes from. Absent where the source of the table does not say.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Authors of the measurement.
    #[serde(default)]
    pub author: Option<String>,
    /// Year of publication.
    #[serde(default)]
    pub year: Option<u32>,
    /// Title of the publication.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Journal with volume and pages, or report.
    #[serde(default)]
    pub journal: Option<String>,
    /// Digital object identifier, without a resolver's address.
    #[serde(default)]
    pub doi: Option<String>,
    /// Where the numbers of the table were copied from.
    #[serde(default)]
    pub table: Option<String>,
    /// Licence of that table.
    #[serde(default)]
    pub licence: Option<String>,
    /// More, such as an address.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

impl Source {
    /// Author, year, journal and identifier, as far as they are known.
    pub fn citation(&self) -> String {
        let Source { author, year, journal, doi, .. } = self;
        let parts =
            [author.clone(), year.map(|y| y.to_string()), journal.clone(), doi.as_ref().map(|d| format!("doi:{d}"))];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// Why there is no preset. Its text names file, field and remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PresetError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not JSON, or a field is missing or of the wrong kind.
    #[error("{}: {reason}; write it as presets/README.md shows", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// Field and place.
        reason: String,
    },
    /// A field has a value that no metal has.
    #[error("{origin}: field `{field}` {reason}; {remedy}")]
    Field {
        /// File or id.
        origin: String,
        /// Name of the field.
        field: &'static str,
        /// What is wrong with it.
        reason: String,
        /// What to do.
        remedy: &'static str,
    },
    /// Its file would be larger than one that is read.
    #[error(
        "{}: would have {bytes} bytes, over the limit of {}; shorten its texts or thin its table out",
        path.display(),
        MAX_BYTES
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
    },
    /// No preset of that name.
    #[error("no preset `{wanted}`; {hint}, or name a .json file")]
    Unknown {
        /// What was asked for.
        wanted: String,
        /// Names that come near, or all.
        hint: String,
    },
}

impl Preset {
    /// Reads and checks a file.
    pub fn read(path: &Path) -> Result<Preset, PresetError> {
        let bytes = read_bounded(path, MAX_BYTES)?;
        let json = |reason: String| PresetError::Json { path: path.into(), reason };
        let text = String::from_utf8(bytes).map_err(|e| json(format!("is not UTF-8 text ({e})")))?;
        // Editors on Windows put a byte order mark in front, which JSON does not know.
        let preset: Preset =
            serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|e| json(e.to_string()))?;
        preset.check(&path.display().to_string())?;
        Ok(preset)
    }

    /// Index at a wavelength in nm: n and k, each linear between its entries.
    pub fn index_at(&self, wavelength_nm: f64) -> (f64, f64) {
        let at = |values: &[f64]| interpolate(&self.wavelength_nm, values, wavelength_nm);
        (at(&self.n), at(&self.k))
    }

    /// Exact reflectance at one wavelength, 0 to 1.
    pub fn reflectance(&self, wavelength_nm: f64, cos_theta: f64) -> f64 {
        let (n, k) = self.index_at(wavelength_nm);
        exact(n, k, cos_theta)
    }

    /// Exact reflectance as linear Rec.709 under D65, not clamped: saturated metals leave [0, 1] (the red of gold is
    /// 1.037).
    pub fn unclamped(&self, cos_theta: f64) -> DVec3 {
        rgb::integrate(|nm| self.reflectance(nm, cos_theta))
    }

    /// [`Preset::unclamped`] at normal incidence.
    pub fn unclamped_f0(&self) -> DVec3 {
        self.unclamped(1.0)
    }

    /// `((n - 1) / (n + 1))^2` integrated to linear Rec.709: F0 without extinction, not clamped.
    pub fn schlick_f0(&self) -> DVec3 {
        rgb::integrate(|nm| {
            let (n, _) = self.index_at(nm);
            ((n - 1.0) / (n + 1.0)).powi(2)
        })
    }

    /// The stored numbers and errors of every form; none where they are absent or of another table.
    pub fn stored_fits(&self) -> Option<&Fits> {
        self.fits.as_ref().filter(|fits| fits.belong_to(self))
    }

    /// Numbers and errors of every form: the stored ones, else made now, which takes about a tenth of a second.
    pub fn fits(&self) -> Cow<'_, Fits> {
        self.stored_fits().map_or_else(|| Cow::Owned(Fits::new(self)), Cow::Borrowed)
    }

    /// The reflectance curve for rendering, in [0, 1].
    ///
    /// All forms but `sampled-nk` stand for the reflectance integrated over the spectrum. Averaged n and k are never
    /// used: they can be further off than any approximation.
    pub fn fresnel(&self, form: Form) -> Fresnel {
        let stored = self.stored_fits().filter(|_| form != Form::Spectral);
        let of_stored = |fits: &Fits| fits::curve(form, fits.f0.into(), &fits.forms.get(&form)?.parameters);
        stored.and_then(of_stored).unwrap_or_else(|| fits::made(self, form))
    }
}

/// Reflectance that a renderer may use: no channel gives off more light than it gets.
fn clamped(reflectance: DVec3) -> Vec3 {
    reflectance.clamp(DVec3::ZERO, DVec3::ONE).as_vec3()
}

#[cfg(test)]
mod tests;
