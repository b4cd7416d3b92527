//! Sound files, cut and changed byte by byte: whatever comes, an answer and no panic.

use super::*;
use crate::math::sampling::Random;

/// Random changes per file, besides every cut.
const ROUNDS: usize = 3000;

/// What replaces a byte: what the formats are made of, and what they are not.
const BYTES: &[u8] = b"0123456789.,;:-+eE \t\n\r\"'#/%|{}[]nk\xb5\xc3\xff\x01";

fn examine(bytes: &[u8], name: &str) {
    let Ok((text, _)) = decode(bytes) else { return };
    match parse(&text, name, &Options::default()) {
        Ok(Imported { preset, report }) => {
            preset.check(name).unwrap();
            assert_eq!(report.points, preset.n.len());
            assert!(report.visible_points >= 2 || report.format == Format::Preset);
        }
        Err(error) => {
            assert!(!error.faults.is_empty() && error.faults.len() <= 10);
            assert!(error.faults.iter().all(|f| f.file == name && !f.remedy.is_empty()), "{error}");
        }
    }
}

fn survive(source: &str, name: &str, seed: u64) {
    for end in 0..source.len() {
        examine(&source.as_bytes()[..end], name);
    }
    let mut random = Random::new(seed);
    let mut below = |limit: usize| (random.bits() % limit as u64) as usize;
    for _ in 0..ROUNDS {
        let mut bytes = source.as_bytes().to_vec();
        for _ in 0..=below(3) {
            let at = below(bytes.len());
            match below(4) {
                0 => bytes[at] ^= 1 << below(8),
                1 => bytes[at] = BYTES[below(BYTES.len())],
                2 => bytes.insert(at, BYTES[below(BYTES.len())]),
                _ => drop(bytes.remove(at)),
            }
        }
        examine(&bytes, name);
    }
}

#[test]
fn mutated_columns_never_panic() {
    let rows = gold(|w, n, k| format!("{w},{n},{k}"));
    survive(&format!("# gold\nWavelength (um),n,k\n{rows}"), "a.csv", 1);
    survive(&gold(|w, n, k| format!("{w}\t{n}\t{k}")).replace('.', ","), "a.txt", 2);
    survive("energy_eV n k\n3.2 1 2\n2.5 1 2\n2.0 1 2\n1.6 1 2\n", "a.dat", 3);
}

#[test]
fn mutated_blocks_never_panic() {
    let n = gold(|w, n, _| format!("{w},{n}"));
    let k = gold(|w, _, k| format!("{w},{k}"));
    survive(&format!("wl,n\n{n}\nwl,k\n{k}"), "a.csv", 4);
    survive(&n, "a.eta.spd", 5);
}

#[test]
fn mutated_database_files_never_panic() {
    survive(&database::table(), "a.yml", 6);
    let formula = "REFERENCES: \"a <b>c</b> <a href=\\\"https://doi.org/10.1/x\\\">d (1999)</a>\"\nDATA:\n  - type: formula 4\n    \
                   wavelength_range: 0.3 1.2\n    coefficients: 2 0.3 1 0.2 2 0.4 0 5 1 0.1 3\n  - type: tabulated k\n    \
                   data: |\n        0.3 0.1\n        0.9 0.2\n";
    assert!(parse(formula, "a.yml", &Options::default()).is_ok());
    survive(formula, "a.yml", 7);
}

#[test]
fn mutated_presets_never_panic() {
    survive(include_str!("../../../../../presets/metals/Ti.json"), "Ti.json", 8);
}
