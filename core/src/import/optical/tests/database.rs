//! Files of the refractiveindex.info database.

use super::*;

const HEAD: &str = "# this file is part of refractiveindex.info database\n# waived via CC0 1.0\n\nREFERENCES: |\n    \
    P. B. Johnson and R. W. Christy.\n    Optical constants of the noble metals.\n    \
    [*Phys. Rev. B* **6**, 4370-4379 (1972)](https://doi.org/10.1103/PhysRevB.6.4370)\nCOMMENTS: |\n    Room <i>temperature</i>\n";

const TAIL: &str = "CONDITIONS:\n    temperature: 293\nPROPERTIES:\n    thermal_dispersion:\n      - type: formula A\n        \
    coefficients: 1.86e-06 1.31e-08\n    nd: 1.5168\n";

fn database(data: &str) -> Result<Imported, OpticalError> {
    parse(&format!("{HEAD}DATA:\n{data}{TAIL}"), "Johnson.yml", &Options::default())
}

pub fn table() -> String {
    let rows = gold(|w, n, k| format!("        {w} {n} {k}"));
    format!("{HEAD}DATA:\n  - type: tabulated nk\n    data: |\n{rows}{TAIL}")
}

#[track_caller]
fn refused(data: &str, words: &[&str]) {
    let error = database(data).expect_err(data).to_string();
    for word in words {
        assert!(error.contains(word), "`{word}` is missing in: {error}");
    }
}

#[test]
fn a_tabulated_metal_comes_with_its_source() {
    let imported = parse(&table(), "Johnson.yml", &Options::default()).unwrap();
    is_gold(&imported);
    let Imported { preset, report } = imported;
    assert_eq!((report.format, report.unit, report.rows), (Format::RefractiveIndexInfo, Unit::Micrometre, 14));
    assert_eq!(report.unit_origin, UnitOrigin::Definition);
    assert_eq!((report.warnings.len(), preset.id.as_str()), (0, "Johnson"));
    assert_eq!(preset.note.as_deref(), Some("Room temperature"));
    let Source { author, year, journal, doi, licence, table, .. } = &preset.source;
    assert_eq!(author.as_deref(), Some("P. B. Johnson and R. W. Christy"));
    assert_eq!((*year, journal.as_deref()), (Some(1972), Some("Phys. Rev. B 6, 4370-4379")));
    assert_eq!((doi.as_deref(), licence.as_deref()), (Some("10.1103/PhysRevB.6.4370"), Some("CC0-1.0")));
    assert!(table.as_deref().unwrap().contains("Johnson.yml"));
}

#[test]
fn older_files_with_quotes_and_another_indent_are_read() {
    let rows = gold(|w, n, k| format!("    {w} {n} {k}"));
    let text = format!(
        "REFERENCES: \"A. B. Gold. On gold,\n  <a href=\\\"https://doi.org/10.1/x\\\"><i>J.</i> <b>1</b>, 2 (1999)</a>\"\n\
         COMMENTS: 'it''s: gold'\nDATA:\n- type: 'tabulated nk'\n  data: |\n{rows}SPECS:\n    n_absolute: true\n"
    );
    let imported = parse(&text, "Gold.yml", &Options::default()).unwrap();
    is_gold(&imported);
    assert_eq!(imported.preset.note.as_deref(), Some("it's: gold"));
    assert_eq!(imported.preset.source.author.as_deref(), Some("A. B. Gold"));
    assert_eq!(imported.preset.source.year, Some(1999));
}

#[test]
fn long_references_and_comments_are_cut_and_said() {
    let line = format!("    {}\n", "\u{e9}".repeat(1500));
    let long = line.repeat(1000);
    let text = table().replace("REFERENCES: |\n", &format!("REFERENCES: |\n{long}"));
    let text = text.replace("COMMENTS: |\n", &format!("COMMENTS: |\n{long}"));
    let imported = parse(&text, "Johnson.yml", &Options::default()).unwrap();
    is_gold(&imported);
    let Imported { preset, report } = imported;
    for text in [preset.note.as_deref(), preset.source.other["reference"].as_str()] {
        assert_eq!(text.map(|text| text.chars().count()), Some(MAX_NOTE_CHARS));
    }
    let notes = texts(&report.notes);
    for words in ["line 4: REFERENCES has more than 2000 characters", "line 1008: COMMENTS has more than 2000"] {
        assert!(notes.contains(words), "`{words}` is missing in: {notes}");
    }
}

#[test]
fn n_and_k_in_two_tables_are_put_on_one_grid() {
    let imported = database(
        "  - type: tabulated n\n    data: |\n        0.40 1.0\n        0.50 2.0\n        0.80 5.0\n  - type: tabulated k\n    \
         data: |\n        0.30 1.0\n        0.60 4.0\n        0.75 4.0\n",
    )
    .unwrap();
    let Preset { wavelength_nm, n, k, .. } = imported.preset;
    assert_eq!(wavelength_nm, [400.0, 500.0, 600.0, 750.0]);
    assert_eq!(n, [1.0, 2.0, 3.0, 4.5]);
    assert!(k.iter().zip([2.0, 3.0, 4.0, 4.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{k:?}");
}

#[test]
fn a_formula_without_k_is_a_dielectric() {
    let imported = database(
        "  - type: formula 2 \n    wavelength_range: 0.3 2.5\n    coefficients: 0 1.03961212 0.00600069867 0.231792344 \
         0.0200179144 1.01046945 103.560653\n",
    )
    .unwrap();
    let preset = &imported.preset;
    // n_d of N-BK7; the grid is linear over 5 nm.
    assert!((preset.index_at(587.5618).0 - 1.5168).abs() < 1e-5);
    assert!(preset.k.iter().all(|k| *k == 0.0));
    assert_eq!((preset.wavelength_nm[0], preset.wavelength_nm.len()), (300.0, 142));
    assert_eq!(imported.report.range_nm, (300.0, 2500.0));
    assert!(texts(&imported.report.warnings).contains("a dielectric, not a metal"));
}

#[test]
fn a_formula_is_joined_with_a_table_of_k() {
    let imported = database(
        "  - type: formula 5\n    range: 0.35 0.85\n    coefficients: 1.5 0.1 1\n  - type: tabulated k\n    data: |\n        \
         0.38 1.0\n        0.5012 2.0\n        0.78 3.0\n",
    )
    .unwrap();
    let preset = &imported.preset;
    assert_eq!((preset.wavelength_nm[0], preset.wavelength_nm.last()), (380.0, Some(&780.0)));
    let (n, k) = preset.index_at(501.2);
    assert!((n - 1.550_12).abs() < 1e-12 && k == 2.0, "{n} {k}");
    assert_eq!(imported.report.warnings, []);
}

#[test]
fn a_file_that_is_not_laid_out_so_is_refused_by_line() {
    let nk = "  - type: tabulated nk\n    data: |\n        0.4 1 2\n        0.7 1 2\n";
    assert!(database(nk).is_ok());
    refused("", &["gives no n"]);
    refused("  - type: tabulated k\n    data: |\n        0.4 1\n        0.7 1\n", &["gives no n"]);
    refused(&nk.repeat(2), &["line 15: gives n a second time", "line 15: gives k a second time"]);
    refused(&nk.repeat(17), &["line 75: DATA has more than 16 entries; keep one of n and one of k"]);
    let keys: String = (0..31).map(|i| format!("    key{i}: x\n")).collect();
    refused(&(nk.to_string() + &keys), &["line 45: the entry has more than 32 keys"]);
    refused(&nk.replace("0.7 1 2", "0.7 1"), &["line 14: has 2 numbers; `tabulated nk` has 3 in a row"]);
    refused(&nk.replace("0.7 1 2", "0.7 1 2 3"), &["line 14: has 4 numbers"]);
    refused(&nk.replace("0.7 1 2", "0.7 1,0 2"), &["line 14: '1,0' is not a number"]);
    refused(&nk.replace("0.7 1 2", "0.7 .nan 2"), &["line 14: '.nan' is not a number"]);
    refused(&nk.replace("0.7 1 2", "0.3 1 2"), &["covers 300 to 400 nm"]);
    refused(&nk.replace("0.7 1 2", "0.4 1 2"), &["line 14: repeats 0.4"]);
    refused(&nk.replace("data: |", "data: 0.4 1 2"), &["line 12: `data` is not followed by `|`"]);
    refused(&nk.replace("data: |", "data: >"), &["line 12: `data` is not followed by `|`"]);
    refused(&nk.replace("        0.7", "    0.7"), &["line 14: '0.7 1 2' is no key with a value"]);
    refused(&nk.replace("    data", "   data"), &["line 12: 'data: |' is not expected under DATA"]);
    refused(&nk.replace("    data", "\tdata"), &["line 12: '\\tdata: |' is no key at the margin"]);
    refused(&nk.replace("tabulated nk", "tabulated n2"), &["line 11: the type 'tabulated n2' is not read"]);
    refused(&nk.replace("tabulated nk", "&a tabulated nk"), &["line 11: the type"]);
    refused(&nk.replace("tabulated nk", "\"tabulated nk"), &["quote after type is not closed"]);
    refused(&(nk.to_string() + "    type: tabulated n\n"), &["line 15: `type` stands there twice"]);
    refused("  - type: tabulated nk\n", &["line 11: `tabulated nk` has no rows"]);
}

#[test]
fn a_formula_that_cannot_be_evaluated_is_refused() {
    let data = "  - type: formula 1\n    wavelength_range: 0.3 2.5\n    coefficients: 0 0.6961663 0.0684043\n";
    assert!(database(data).is_ok());
    refused(&data.replace("formula 1", "formula 12"), &["line 11: `formula 12` is not known"]);
    refused(&data.replace("formula 1", "formula A"), &["the type 'formula A' is not read", "formula 9"]);
    refused(&data.replace(" 0.0684043", ""), &["`formula 1` cannot have 2 coefficients"]);
    refused(&data.replace("0.3 2.5", "2.5 0.3"), &["2.5 to 0.3 um, which is no range"]);
    refused(&data.replace("wavelength_range", "where"), &["has no wavelength_range"]);
    refused(&data.replace("0 0.69", "-9 0.69"), &["gives no refractive index at 0.3 um"]);
    refused(&data.replace("0.0684043", "x"), &["line 13: 'x' is not a number"]);
}

#[test]
fn what_stands_at_the_margin_must_be_a_key() {
    let text = |line: &str| format!("{line}\n{}", table());
    for line in ["just words", "[1, 2]", "REFERENCES"] {
        let error = parse(&text(line), "x.yml", &Options::default()).unwrap_err().to_string();
        assert!(error.contains("x.yml: line 1:") && error.contains("no key at the margin"), "{error}");
    }
    let twice = parse(&(table() + &table()), "x.yml", &Options::default()).unwrap_err().to_string();
    assert!(twice.contains("a second DATA"), "{twice}");
    assert!(parse(&text("%YAML 1.2\n---"), "x.yml", &Options::default()).is_ok());
}
