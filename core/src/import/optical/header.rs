//! The words above a column, and what they mean.

use super::Unit;

/// What a column holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Role {
    /// Wavelength or photon energy; the unit where it is named.
    At(Option<Unit>),
    /// Wavelength, energy, frequency or wavenumber in a unit that is not read.
    Foreign(String),
    /// Real part of the index.
    N,
    /// Imaginary part.
    K,
    /// Something else.
    Other,
}

/// A column with its words.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    pub role: Role,
    pub text: String,
}

/// Words for wavelength.
const WAVELENGTH: &[&str] = &["wavelength", "wavelengths", "wl", "wvl", "lambda", "lam", "\u{3bb}", "wave"];

/// Words for photon energy, which is in eV where nothing else is said.
const ENERGY: &[&str] = &["energy", "photonenergy", "hv", "h\u{3bd}"];

/// Words for the real part.
const REAL: &[&str] = &["n", "eta", "ior", "refractive", "refraction", "re", "real"];

/// Words for the imaginary part.
const IMAGINARY: &[&str] = &["k", "kappa", "extinction", "im", "imag", "imaginary"];

/// Words that say that a column is about another one, not the quantity itself.
const DERIVED: &[&str] =
    &["err", "error", "std", "sigma", "unc", "uncertainty", "delta", "eps", "epsilon", "absorption", "group"];

/// Units and quantities that are not read.
const FOREIGN: &[&str] = &[
    "m",
    "mm",
    "cm",
    "pm",
    "hz",
    "thz",
    "ghz",
    "mev",
    "kev",
    "j",
    "cm1",
    "wavenumber",
    "number",
    "frequency",
    "omega",
];

/// Words without a meaning of their own, by which a header with blanks between columns is divided.
const FILLER: &[&str] = &["photon", "index", "coefficient", "of", "part", "in", "vacuum", "the"];

/// The columns of a header whose fields are divided by a comma, semicolon or tab. A unit that stands alone belongs to
/// the field before: `Wavelength, µm, n, k` are three columns.
pub(super) fn columns(fields: &[String]) -> Vec<Column> {
    let mut columns: Vec<Column> = Vec::new();
    for field in fields {
        match (lone_unit(field), columns.last_mut()) {
            (Some(unit), Some(Column { role: role @ Role::At(None), text })) => {
                *role = Role::At(Some(unit));
                *text = format!("{text}, {}", field.trim());
            }
            (Some(unit), None) => columns.push(Column { role: Role::At(Some(unit)), text: field.trim().into() }),
            _ => columns.push(Column { role: role(field), text: field.trim().into() }),
        }
    }
    columns
}

/// The columns of a header with blanks between them, where a column may have several words.
pub(super) fn columns_of_words(text: &str) -> Vec<Column> {
    let words: Vec<String> = text.split_whitespace().map(String::from).collect();
    let mut merged: Vec<Column> = Vec::new();
    for column in columns(&words) {
        let filler = words_of(&column.text).iter().all(|word| FILLER.contains(&word.as_str()));
        match merged.last_mut() {
            _ if filler => {}
            // `refractive index n` are three words about one column.
            Some(last) if last.role == column.role && column.role != Role::Other => {
                last.text = format!("{} {}", last.text, column.text);
            }
            _ => merged.push(column),
        }
    }
    merged
}

/// The unit, where the field is nothing else.
fn lone_unit(field: &str) -> Option<Unit> {
    let inner = field.trim().trim_matches(['(', ')', '[', ']']);
    // `A` alone is rather absorbance than angstrom.
    if inner.eq_ignore_ascii_case("a") && inner == field.trim() { None } else { inner.parse().ok() }
}

fn role(field: &str) -> Role {
    let words = words_of(field);
    let has = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    let unit = || words.iter().find_map(|word| word.parse().ok());
    let about_wavelength = has(WAVELENGTH);
    let about_energy = has(ENERGY) || field.trim().eq_ignore_ascii_case("e") || unit() == Some(Unit::ElectronVolt);
    if has(DERIVED) {
        Role::Other
    } else if has(FOREIGN) && !has(REAL) && !has(IMAGINARY) {
        Role::Foreign(field.trim().into())
    } else if about_energy {
        Role::At(Some(Unit::ElectronVolt))
    } else if about_wavelength {
        Role::At(unit())
    } else if has(IMAGINARY) {
        Role::K
    } else if has(REAL) {
        Role::N
    } else {
        Role::Other
    }
}

/// Runs of letters and digits in lower case; `cm-1` is one word.
fn words_of(field: &str) -> Vec<String> {
    let lower = field.to_lowercase().replace("cm^-1", "cm1").replace("cm-1", "cm1");
    lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(String::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roles(header: &[&str]) -> Vec<Role> {
        let fields: Vec<String> = header.iter().map(|f| f.to_string()).collect();
        columns(&fields).into_iter().map(|c| c.role).collect()
    }

    const NM: Role = Role::At(Some(Unit::Nanometre));
    const UM: Role = Role::At(Some(Unit::Micrometre));
    const EV: Role = Role::At(Some(Unit::ElectronVolt));

    #[test]
    fn the_usual_headers_are_understood() {
        assert_eq!(roles(&["wavelength_nm", "n", "k"]), [NM, Role::N, Role::K]);
        assert_eq!(roles(&["Wavelength, \u{b5}m", "n", "k"]), [UM, Role::N, Role::K]);
        assert_eq!(roles(&["Wavelength", " \u{3bc}m", "n", "k"]), [UM, Role::N, Role::K]);
        assert_eq!(roles(&["k", "n", "lambda (nm)"]), [Role::K, Role::N, NM]);
        assert_eq!(roles(&["wl", "n"]), [Role::At(None), Role::N]);
        assert_eq!(roles(&["energy_eV", "eta", "kappa"]), [EV, Role::N, Role::K]);
        assert_eq!(roles(&["E", "n", "k"]), [EV, Role::N, Role::K]);
        assert_eq!(roles(&["nm", "Re(n)", "Im(n)"]), [NM, Role::N, Role::K]);
        assert_eq!(roles(&["\u{3bb}/nm", "refractive index", "extinction coefficient"]), [NM, Role::N, Role::K]);
        assert_eq!(roles(&["Wavelength [\u{c5}]", "n", "k"]), [Role::At(Some(Unit::Angstrom)), Role::N, Role::K]);
    }

    #[test]
    fn what_is_not_n_or_k_is_not_taken_for_it() {
        assert_eq!(
            roles(&["wl", "n", "n_err", "k", "A"]),
            [Role::At(None), Role::N, Role::Other, Role::K, Role::Other]
        );
        assert!(matches!(roles(&["wavenumber (cm-1)", "n"])[0], Role::Foreign(_)));
        assert!(matches!(roles(&["Wavelength (m)", "n"])[0], Role::Foreign(_)));
        assert!(matches!(roles(&["wave number", "n"])[0], Role::Foreign(_)));
        assert!(matches!(roles(&["energy_keV", "n"])[0], Role::Foreign(_)));
        assert_eq!(roles(&["eps1", "Re(eps)"])[1], Role::Other);
    }

    #[test]
    fn a_header_of_words_is_divided_by_what_they_mean() {
        let roles = |text| columns_of_words(text).into_iter().map(|c| c.role).collect::<Vec<_>>();
        assert_eq!(roles("Wavelength (nm)   n   k"), [NM, Role::N, Role::K]);
        assert_eq!(roles("Photon energy [eV] refractive index extinction coefficient"), [EV, Role::N, Role::K]);
        assert_eq!(roles("wl value"), [Role::At(None), Role::Other]);
    }
}
