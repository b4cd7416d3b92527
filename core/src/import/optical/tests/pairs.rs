//! Two files, one of n and one of k.

use super::*;
use crate::file::testing::Folder;

fn halves() -> (String, String) {
    (gold(|w, n, _| format!("{:.1} {n}", 1e3 * w)), gold(|w, _, k| format!("{:.1} {k}", 1e3 * w)))
}

fn read_in(folder: &Folder, name: &str) -> Result<Imported, OpticalError> {
    read(&folder.join(name), &Options::default())
}

#[test]
fn given_one_file_the_other_is_found_beside_it() {
    let (n, k) = halves();
    for (real, imaginary, id) in [
        ("Au.eta.spd", "Au.k.spd", "Au"),
        ("metal-Au-eta.spd", "metal-Au-k.spd", "metal-Au"),
        ("Au_n.spd", "Au_k.spd", "Au"),
    ] {
        let folder = Folder::new();
        std::fs::write(folder.join(real), &n).unwrap();
        std::fs::write(folder.join(imaginary), &k).unwrap();
        for (given, other) in [(real, imaginary), (imaginary, real)] {
            let imported = read_in(&folder, given).unwrap();
            is_gold(&imported);
            let report = &imported.report;
            assert_eq!((report.format, report.unit, report.rows), (Format::Pair, Unit::Nanometre, 28));
            assert_eq!((imported.preset.id.as_str(), report.other.as_deref()), (id, Some(other)));
            assert!(texts(&report.notes).contains(&format!("was read from {other}")), "{:?}", report.notes);
        }
    }
}

#[test]
fn files_that_name_their_columns_or_are_in_micrometres_are_pairs_too() {
    let folder = Folder::new();
    std::fs::write(folder.join("n.txt"), "wl,n\n0.4,1\n0.7,2\n0.8,2\n").unwrap();
    std::fs::write(folder.join("k.txt"), "# Gold\n0.3 1\n0.9 4\n").unwrap();
    let imported = read_in(&folder, "k.txt").unwrap();
    assert_eq!(imported.preset.wavelength_nm, [400.0, 700.0, 800.0]);
    assert_eq!(imported.preset.n, [1.0, 2.0, 2.0]);
    assert_eq!(imported.preset.note.as_deref(), Some("Gold"));
}

#[test]
fn three_columns_need_no_other_file() {
    let folder = Folder::new();
    std::fs::write(folder.join("Au.eta.spd"), gold(|w, n, k| format!("{w} {n} {k}"))).unwrap();
    let imported = read_in(&folder, "Au.eta.spd").unwrap();
    is_gold(&imported);
    assert_eq!(imported.report.other, None);
}

#[test]
fn a_missing_or_faulty_other_file_is_named() {
    let (n, k) = halves();
    let folder = Folder::new();
    std::fs::write(folder.join("Au.eta.spd"), &n).unwrap();
    std::fs::write(folder.join("Au.spd"), &n).unwrap();
    let refused = |name: &str, words: &[&str]| {
        let error = read_in(&folder, name).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{words:?}: {error}");
    };
    refused("Au.eta.spd", &["Au.eta.spd: holds n alone, and Au.k.spd is not beside it", "put Au.k.spd into the same"]);
    refused("Au.spd", &["Au.spd: has two columns: n or k is missing"]);
    refused("Ag.spd", &["Ag.spd: cannot be read"]);
    std::fs::write(folder.join("Au.k.spd"), k.replace("548.6 2.455", "548.6 x")).unwrap();
    refused("Au.eta.spd", &["Au.k.spd: line 9: column 2: 'x' is not a number"]);
    std::fs::write(folder.join("Au.k.spd"), k.replace("548.6", &" ".repeat(MAX_LINE_CHARS))).unwrap();
    refused("Au.eta.spd", &["Au.k.spd: line 9: has more than 10000 characters"]);
    std::fs::write(folder.join("Au.k.spd"), k.replace(" 2.455", " -2.455")).unwrap();
    refused("Au.eta.spd", &["Au.k.spd: line 9: k is -2.455"]);
    std::fs::write(folder.join("Au.k.spd"), gold(|w, n, k| format!("{w} {n} {k}"))).unwrap();
    refused("Au.eta.spd", &["Au.k.spd: does not have two columns"]);
    std::fs::write(folder.join("Au.k.spd"), format!("wl n\n{n}")).unwrap();
    refused("Au.eta.spd", &["Au.k.spd: holds n, as Au.eta.spd does"]);
    std::fs::write(folder.join("Au.eta.spd"), format!("wl_nm n\n{n}")).unwrap();
    std::fs::write(folder.join("Au.k.spd"), format!("wl_um k\n{k}")).unwrap();
    refused("Au.eta.spd", &["Au.k.spd: is in um, Au.eta.spd in nm"]);
}

#[test]
fn a_file_in_latin_1_is_read_and_a_workbook_is_not() {
    let folder = Folder::new();
    let text = format!("Wavelength (\u{b5}m);n;k\n{}", gold(|w, n, k| format!("{w};{n};{k}")));
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    std::fs::write(folder.join("Au.csv"), latin).unwrap();
    let imported = read_in(&folder, "Au.csv").unwrap();
    is_gold(&imported);
    assert!(texts(&imported.report.notes).contains("Latin-1"));
    std::fs::write(folder.join("Au.xlsx"), b"PK\x03\x04").unwrap();
    let error = read_in(&folder, "Au.xlsx").unwrap_err().to_string();
    assert!(error.contains("Au.xlsx: is a ZIP archive, not a table; save it as text"), "{error}");
    let preset = concat!(env!("CARGO_MANIFEST_DIR"), "/../presets/metals/Ti.json");
    assert_eq!(read(Path::new(preset), &Options::default()).unwrap().report.format, Format::Preset);
}
