//! Units of the first column of a table, and how a table without one is understood.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use crate::material::preset::reaches_required;

/// Planck's constant times the speed of light, eV nm: `wavelength = HC_EV_NM / energy`. BIPM 2019, to ten digits.
pub const HC_EV_NM: f64 = 1_239.841_984;

/// Unit of the first column of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Unit {
    /// `nm`.
    #[serde(rename = "nm")]
    Nanometre,
    /// `um`, 1000 nm.
    #[serde(rename = "um")]
    Micrometre,
    /// `A`, 0.1 nm.
    #[serde(rename = "A")]
    Angstrom,
    /// `eV`, the photon's energy: 1239.841984 nm over it.
    #[serde(rename = "eV")]
    ElectronVolt,
}

/// A word that is no unit of a table.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no unit of wavelength; there are nm, um, A (angstrom) and eV")]
pub struct UnknownUnit(pub String);

impl Unit {
    /// All of them.
    pub const ALL: [Unit; 4] = [Unit::Nanometre, Unit::Micrometre, Unit::Angstrom, Unit::ElectronVolt];

    /// Vacuum wavelength in nm of a value above 0.
    ///
    /// Scaling by a power of ten leaves digits that the table does not have (413.29999999999995 for 0.4133 um), so ten
    /// are kept; nm are kept as they are.
    pub fn nm(self, value: f64) -> f64 {
        let nm = match self {
            Unit::Nanometre => return value,
            Unit::Micrometre => 1e3 * value,
            Unit::Angstrom => 0.1 * value,
            Unit::ElectronVolt => HC_EV_NM / value,
        };
        // Text and back rounds to decimal digits without an error of its own.
        format!("{nm:.9e}").parse().unwrap_or(nm)
    }

    /// Shortest and longest wavelength, nm, of a table with values from `least` to `greatest`.
    pub(super) fn range_nm(self, (least, greatest): (f64, f64)) -> (f64, f64) {
        let (a, b) = (self.nm(least), self.nm(greatest));
        (a.min(b), a.max(b))
    }

    /// True when a table with values in this range, read in this unit, reaches as far as a preset must.
    pub(super) fn covers(self, range: (f64, f64)) -> bool {
        let (from, to) = self.range_nm(range);
        reaches_required(from, to)
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Unit::Nanometre => "nm",
            Unit::Micrometre => "um",
            Unit::Angstrom => "A",
            Unit::ElectronVolt => "eV",
        })
    }
}

impl FromStr for Unit {
    type Err = UnknownUnit;

    /// Without regard to case; both signs for micro are known.
    fn from_str(text: &str) -> Result<Unit, UnknownUnit> {
        match text.trim().to_lowercase().as_str() {
            "nm" | "nanometre" | "nanometres" | "nanometer" | "nanometers" => Ok(Unit::Nanometre),
            "um" | "\u{b5}m" | "\u{3bc}m" | "micron" | "microns" | "micrometre" | "micrometres" | "micrometer"
            | "micrometers" => Ok(Unit::Micrometre),
            "a" | "\u{e5}" | "angstrom" | "angstroms" | "\u{e5}ngstrom" | "\u{e5}ngstr\u{f6}m" => Ok(Unit::Angstrom),
            "ev" | "electronvolt" | "electronvolts" => Ok(Unit::ElectronVolt),
            _ => Err(UnknownUnit(text.trim().into())),
        }
    }
}

/// Values that are taken for micrometres when nothing names the unit.
const MICROMETRES: std::ops::RangeInclusive<f64> = 0.1..=50.0;

/// Values that are taken for nanometres when nothing names the unit.
const NANOMETRES: std::ops::RangeInclusive<f64> = 100.0..=50_000.0;

/// The unit of values from `least` to `greatest` where nothing names it, with the reason; `None` when they fit none.
pub(super) fn guess(range: (f64, f64)) -> Option<(Unit, String)> {
    let (least, greatest) = range;
    let within = |wanted: &std::ops::RangeInclusive<f64>| wanted.contains(&least) && wanted.contains(&greatest);
    let reason = |from, to| format!("the values, {least} to {greatest}, lie in {from} to {to}");
    if within(&MICROMETRES) {
        Some((Unit::Micrometre, reason("0.1", "50")))
    } else if within(&NANOMETRES) {
        Some((Unit::Nanometre, reason("100", "50000")))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_read_back_from_its_name_and_from_the_usual_spellings() {
        for unit in Unit::ALL {
            assert_eq!(unit.to_string().parse(), Ok(unit));
        }
        for (text, unit) in [
            (" NM ", Unit::Nanometre),
            ("\u{b5}m", Unit::Micrometre),
            ("\u{3bc}m", Unit::Micrometre),
            ("micron", Unit::Micrometre),
            ("\u{c5}", Unit::Angstrom),
            ("EV", Unit::ElectronVolt),
        ] {
            assert_eq!(text.parse(), Ok(unit), "{text}");
        }
        for text in ["", "m", "cm-1", "THz", "keV"] {
            assert!(text.parse::<Unit>().unwrap_err().to_string().contains("eV"), "{text}");
        }
    }

    #[test]
    fn values_become_nanometres_without_digits_that_were_not_there() {
        assert_eq!(Unit::Micrometre.nm(0.4133), 413.3);
        assert_eq!(Unit::Angstrom.nm(5890.0), 589.0);
        assert_eq!(Unit::Nanometre.nm(0.1 + 0.2), 0.1 + 0.2);
        // The photon energy of 620 nm is 2 eV, nearly.
        assert_eq!(Unit::ElectronVolt.nm(2.0), 619.920_992);
        assert_eq!(Unit::ElectronVolt.range_nm((1.0, 2.0)), (619.920_992, 1_239.841_984));
    }

    #[test]
    fn the_wavelength_of_an_electronvolt_follows_from_the_constants_of_the_si() {
        let (h, c, e): (f64, f64, f64) = (6.626_070_15e-34, 299_792_458.0, 1.602_176_634e-19);
        assert!((h * c / e * 1e9 / HC_EV_NM - 1.0).abs() < 5e-10);
    }

    #[test]
    fn values_alone_tell_micrometres_from_nanometres_or_nothing() {
        assert_eq!(guess((0.1879, 1.937)).map(|g| g.0), Some(Unit::Micrometre));
        assert_eq!(guess((380.0, 780.0)).map(|g| g.0), Some(Unit::Nanometre));
        for range in [(0.01, 2.0), (50.0, 900.0), (2.0, 700.0), (200.0, 60_000.0)] {
            assert_eq!(guess(range), None, "{range:?}");
        }
    }
}
