//! Measured optical constants that become presets.

use std::fs;
use std::path::Path;

use burnish_tests::{repository, scratch_folder};
use serde_json::Value;

use crate::{INPUT, RESOURCES, USAGE, burnish, text};

/// Gold, rows of P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972): um, n, k.
const GOLD: &str = "0.3679 1.48 1.895\n0.3974 1.47 1.952\n0.4133 1.46 1.958\n0.4305 1.45 1.948\n0.4509 1.38 1.914\n\
    0.4714 1.31 1.849\n0.4959 1.04 1.833\n0.5209 0.62 2.081\n0.5486 0.43 2.455\n0.5821 0.29 2.863\n0.6168 0.21 3.272\n\
    0.6595 0.14 3.697\n0.7045 0.13 4.103\n0.7560 0.14 4.542\n0.8211 0.16 5.083\n";

fn write(path: &Path, text: &str) {
    fs::write(path, text).expect("the folder is writable");
}

fn read(path: &Path) -> Value {
    let text = fs::read_to_string(path).expect("the preset was written");
    serde_json::from_str(&text).expect("JSON")
}

pub fn a_table_becomes_a_preset_that_renders() {
    let folder = scratch_folder("fit");
    let (table, preset) = (folder.join("my gold.txt"), folder.join("gold.json"));
    write(&table, GOLD);
    let words = burnish(&["fit", text(&table), "--out", text(&preset), "--name", "Gold"]).succeeded().out;
    for word in ["my-gold, Gold", "unit      um, guessed", "367.9 to 821.1 nm", "clamped", "gulbrandsen", "cheapest  "]
    {
        assert!(words.contains(word), "`{word}` is missing in: {words}");
    }
    let written = read(&preset);
    assert_eq!((&written["id"], &written["name"]), (&"my-gold".into(), &"Gold".into()));
    assert_eq!(written["n"][0], 1.48);
    // The same measurement, interpolated, is the gold that comes with the program.
    for (channel, expected) in [1.0373, 0.7284, 0.3648].into_iter().enumerate() {
        let f0 = written["fits"]["f0"][channel].as_f64().expect("a reflectance");
        assert!((f0 - expected).abs() < 2e-3, "{f0} against {expected}");
    }
    // A form that errs less costs more.
    let cheapest = |tolerance: &str| {
        let fitted = burnish(&["fit", text(&preset), "--relative", tolerance, "--delta-e", "100", "--json"]).json();
        let position = |form: &Value| {
            let forms = fitted[0]["forms"].as_array().expect("forms");
            forms.iter().position(|f| f["form"] == *form).expect("one of the forms")
        };
        position(&fitted[0]["cheapest"]["form"])
    };
    assert_eq!(cheapest("1"), 0);
    assert!(cheapest("0.1") <= cheapest("0.01") && cheapest("0.01") <= cheapest("0"));
    assert_eq!(cheapest("0"), 12, "only the spectral table is without error");
}

pub fn a_preset_is_fitted_anew_into_its_own_file() {
    let folder = scratch_folder("refit");
    let (iron, copy) = (repository().join("presets/metals/Fe.json"), folder.join("Fe.json"));
    let mut stale = read(&iron);
    stale["fits"]["of"] = "0-0".into();
    write(&copy, &stale.to_string());
    let refit = || burnish(&["fit", text(&copy), "--out", text(&copy)]).succeeded();
    refit();
    let (mut fresh, mut kept) = (read(&copy), read(&iron));
    assert_eq!(fresh["fits"]["of"], kept["fits"]["of"]);
    let forms = fresh["fits"]["forms"].as_object().expect("forms");
    assert_eq!(forms.len(), 13);
    for (form, fit) in forms {
        let error = |fit: &Value| fit["relative"].as_f64().expect("a number");
        // The fifth digit hangs on the order of single precision operations.
        let difference = error(fit) - error(&kept["fits"]["forms"][form]);
        assert!(difference.abs() < 1e-5, "{form}: {difference}");
    }
    // All else is as it was, and stays so.
    for preset in [&mut fresh, &mut kept] {
        preset.as_object_mut().expect("an object").remove("fits");
    }
    assert_eq!(fresh, kept);
    let once = fs::read(&copy).expect("written");
    refit();
    assert_eq!(fs::read(&copy).expect("written"), once);
}

pub fn a_pair_of_spectra_and_several_files_are_fitted() {
    let folder = scratch_folder("spectra");
    let column = |i: usize| -> String {
        let row = |line: &str| {
            let fields: Vec<&str> = line.split(' ').collect();
            format!("{} {}\n", fields[0], fields[i])
        };
        GOLD.lines().map(row).collect()
    };
    let (eta, k, database) = (folder.join("Au.eta.spd"), folder.join("Au.k.spd"), folder.join("Johnson.yml"));
    write(&eta, &column(1));
    burnish(&["fit", text(&eta)]).failed(INPUT, &["Au.eta.spd", "Au.k.spd is not beside it"]);
    write(&k, &column(2));
    let rows: String = GOLD.lines().map(|line| format!("        {line}\n")).collect();
    write(&database, &format!("REFERENCES: A.\nDATA:\n  - type: tabulated nk\n    data: |\n{rows}"));
    let fitted = burnish(&["fit", text(&eta), text(&database), "--json"]).json();
    assert_eq!((&fitted[0]["id"], &fitted[1]["id"]), (&"Au".into(), &"Johnson".into()));
    assert_eq!(fitted[0]["f0"], fitted[1]["f0"]);
    assert_eq!(fitted[1]["report"]["format"], "refractive-index-info");
    assert_eq!(fitted[0]["forms"].as_array().map(Vec::len), Some(13));

    // One that cannot be read does not keep the others from being told.
    let mixed = burnish(&["fit", text(&folder.join("none.csv")), text(&k)]).failed(INPUT, &["none.csv"]);
    assert!(mixed.out.contains("cheapest"), "{}", mixed.out);
}

pub fn tables_that_make_no_sense_are_refused() {
    let folder = scratch_folder("misfit");
    let table = folder.join("Au.csv");
    write(&table, &GOLD.replace("0.43 2.455", "0.43 -2.455"));
    burnish(&["fit", text(&table)]).failed(INPUT, &["Au.csv: line 9: k is -2.455"]);
    write(&table, GOLD);
    burnish(&["fit", text(&table), "--unit", "eV"]).failed(INPUT, &["Au.csv", "if the unit is wrong, say --unit um"]);
    burnish(&["fit", text(&table), "--unit", "inch"]).failed(USAGE, &["--unit", "nm, um, A (angstrom) and eV"]);
    burnish(&["fit", text(&table), "--relative", "2"]).failed(USAGE, &["--relative", "0 to 1"]);
    burnish(&["fit", text(&table), text(&table), "--id", "x"]).failed(USAGE, &["--id", "one file"]);
    burnish(&["fit", text(&table), "--id", "a/b"]).failed(INPUT, &["field `id` is `a/b`"]);
    burnish(&["fit"]).failed(USAGE, &["FILE"]);
}

pub fn another_preset_is_not_written_over() {
    let folder = scratch_folder("overwrite");
    let (table, preset, other) = (folder.join("Au.csv"), folder.join("x.json"), folder.join("notes.txt"));
    write(&table, GOLD);
    let named = |id: &str, out: &Path| burnish(&["fit", text(&table), "--id", id, "--out", text(out)]);
    named("mine", &preset).succeeded();
    named("mine", &preset).succeeded();
    named("yours", &preset).failed(INPUT, &["x.json", "holds the preset `mine`, not `yours`"]);
    write(&other, "keep me");
    named("mine", &other).failed(INPUT, &["notes.txt", "is no preset and is not written over"]);
    assert_eq!(fs::read_to_string(&other).expect("kept"), "keep me");
    assert!(named("Au", &folder.join("y.json")).succeeded().out.contains("`Au` is the id of a metal that comes"));
}

pub fn a_preset_that_cannot_be_written_is_no_fault_of_the_table() {
    let folder = scratch_folder("unwritable");
    let (table, target) = (folder.join("Au.csv"), folder.join("none/x.json"));
    let fit = || burnish(&["fit", text(&table), "--id", "mine", "--out", text(&target)]);
    write(&table, GOLD);
    fit().failed(RESOURCES, &["x.json", "create the folder"]);
    assert!(!folder.join("none").exists());
    // The table is looked at first.
    write(&table, "400 1\n");
    fit().failed(INPUT, &["Au.csv"]);
}
