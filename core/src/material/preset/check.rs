//! What a preset must satisfy.

use super::{MAX_ID, Preset, PresetError};
use crate::surface::fresnel::INDEX_MAX;

/// The `format` of a preset.
pub const FORMAT: &str = "burnish-metal";

/// The `version` that is read.
pub const VERSION: u32 = 1;

/// Wavelengths that a table must reach, nm. Beyond them the ends are held: of the light of D65 that enters red, green
/// and blue, less than 0.5 % each lies outside.
pub const REQUIRED_RANGE_NM: (f64, f64) = (400.0, 700.0);

/// What may be missing at either end, nm: photon energies of rounded numbers end a little inside.
const RANGE_SLACK_NM: f64 = 0.5;

/// True for a table from `first` to `last` nm that reaches [`REQUIRED_RANGE_NM`], give or take half a nanometre.
pub fn reaches_required(first: f64, last: f64) -> bool {
    first <= REQUIRED_RANGE_NM.0 + RANGE_SLACK_NM && last >= REQUIRED_RANGE_NM.1 - RANGE_SLACK_NM
}

/// What a text must be to pass [`is_id`].
const ID_REMEDY: &str = "use 1 to 64 letters, digits, `-`, `_` and inner `.`";

/// True for what may name a file of `presets`.
fn is_id(id: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
    !id.is_empty() && id.len() <= MAX_ID && !id.starts_with('.') && id.chars().all(allowed)
}

/// What the files of `presets` begin with.
pub(crate) struct Header<'a> {
    pub format: (&'a str, &'a str),
    pub version: (u32, u32),
    pub id: &'a str,
    pub name: &'a str,
    /// What to do about a wrong format, and about a name that is empty.
    pub remedies: [&'static str; 2],
}

impl Header<'_> {
    /// What is wrong: field, reason and remedy. `format` and `version` stand beside what they must be.
    pub(crate) fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let [set_format, give_name] = self.remedies;
        if self.format.0 != self.format.1 {
            return Some(("format", format!("is `{}`", self.format.0), set_format));
        }
        if self.version.0 != self.version.1 {
            return Some(("version", format!("is {}", self.version.0), "this program reads version 1"));
        }
        if !is_id(self.id) {
            return Some(("id", format!("is `{}`", self.id), ID_REMEDY));
        }
        self.name.trim().is_empty().then(|| ("name", "is empty".into(), give_name))
    }
}

impl Preset {
    /// Refuses what cannot be a metal; `origin` (file or id) starts the message.
    pub fn check(&self, origin: &str) -> Result<(), PresetError> {
        let fault =
            |field, reason: String, remedy| Err(PresetError::Field { origin: origin.into(), field, reason, remedy });
        let header = Header {
            format: (&self.format, FORMAT),
            version: (self.version, VERSION),
            id: &self.id,
            name: &self.name,
            remedies: ["set it to `burnish-metal`", "name the metal"],
        };
        if let Some((field, reason, remedy)) = header.fault() {
            return fault(field, reason, remedy);
        }
        self.check_table(origin)
    }

    /// Lengths, order, range and values of the table.
    fn check_table(&self, origin: &str) -> Result<(), PresetError> {
        let fault =
            |field, reason: String, remedy| Err(PresetError::Field { origin: origin.into(), field, reason, remedy });
        let count = self.wavelength_nm.len();
        for (field, values) in [("n", &self.n), ("k", &self.k)] {
            if values.len() != count {
                let reason = format!("has {} values for {count} wavelengths", values.len());
                return fault(field, reason, "give one value per wavelength");
            }
        }
        let mut last = 0.0;
        for (i, &nm) in self.wavelength_nm.iter().enumerate() {
            if !(nm.is_finite() && nm > last) {
                let reason = format!("is {nm} at entry {i}, after {last}");
                return fault("wavelength_nm", reason, "list positive wavelengths in nm, each above the one before");
            }
            last = nm;
        }
        let first = self.wavelength_nm.first().copied().unwrap_or(f64::INFINITY);
        if !reaches_required(first, last) {
            let reason = format!("covers {first} to {last} nm");
            return fault("wavelength_nm", reason, "cover 400 to 700 nm at least, better 380 to 780 nm");
        }
        let most = f64::from(INDEX_MAX);
        if let Some((i, n)) = self.n.iter().enumerate().find(|(_, n)| !(**n > 0.0 && **n <= most)) {
            return fault("n", format!("is {n} at entry {i}"), "give values above 0, at most 1000");
        }
        if let Some((i, k)) = self.k.iter().enumerate().find(|(_, k)| !(**k >= 0.0 && **k <= most)) {
            return fault("k", format!("is {k} at entry {i}"), "give values of 0 to 1000 (the index is n + ik)");
        }
        Ok(())
    }
}
