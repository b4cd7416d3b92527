//! What is read, what is refused with which words, and that nothing panics.

mod columns;
mod database;
mod mutation;
mod pairs;
mod refused;

use super::*;

/// Gold, rows of P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972): um, n, k.
const GOLD: [(f64, f64, f64); 14] = [
    (0.3679, 1.48, 1.895),
    (0.3974, 1.47, 1.952),
    (0.4133, 1.46, 1.958),
    (0.4305, 1.45, 1.948),
    (0.4509, 1.38, 1.914),
    (0.4714, 1.31, 1.849),
    (0.4959, 1.04, 1.833),
    (0.5209, 0.62, 2.081),
    (0.5486, 0.43, 2.455),
    (0.5821, 0.29, 2.863),
    (0.6168, 0.21, 3.272),
    (0.6595, 0.14, 3.697),
    (0.7045, 0.13, 4.103),
    (0.7560, 0.14, 4.542),
];

/// The rows of [`GOLD`], each written by `row`.
fn gold(row: impl Fn(f64, f64, f64) -> String) -> String {
    GOLD.iter().map(|(um, n, k)| row(*um, *n, *k) + "\n").collect()
}

fn plain(text: &str) -> Result<Imported, OpticalError> {
    parse(text, "Au.csv", &Options::default())
}

/// Reads a text that must be sound.
#[track_caller]
fn sound(text: &str) -> Imported {
    plain(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The table is that of [`GOLD`].
#[track_caller]
fn is_gold(imported: &Imported) {
    let Preset { wavelength_nm, n, k, .. } = &imported.preset;
    let expected_nm: Vec<f64> = GOLD.iter().map(|row| Unit::Micrometre.nm(row.0)).collect();
    assert_eq!(wavelength_nm, &expected_nm);
    assert_eq!(n, &GOLD.map(|row| row.1));
    assert_eq!(k, &GOLD.map(|row| row.2));
    assert_eq!((imported.report.points, imported.report.visible_points), (14, 13));
}

fn texts(findings: &[Finding]) -> String {
    findings.iter().map(|f| format!("{f}\n")).collect()
}
