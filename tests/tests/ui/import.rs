//! Optical constants come in: dropped, pasted, looked at, corrected, kept.

use burnish::window::Request;
use burnish_core::material::Reflectance;
use burnish_core::material::preset::{Preset, find};
use burnish_tests::trial;
use eframe::egui::{Event, Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT, Queryable};
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

const IMPORT: &str = "Import";

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a_dropped_table_is_looked_at_kept_and_put_on_a_material", &[], dropped),
        trial("a_pasted_table_with_a_fault_is_corrected_in_the_window", &[], pasted),
        trial("a_broken_file_is_refused_by_line_with_a_remedy", &[], broken),
        trial("the_unit_of_a_table_can_be_overruled", &[], overruled),
        trial("two_halves_are_one_table_and_presets_of_ours_need_no_look", &[], halves_and_presets),
    ]
}

fn bench(name: &str) -> Bench {
    let mut bench = Bench::new(Setup { name, scene: Some("gallery:workbench"), size: [1280.0, 900.0], drawn: false });
    bench.until_shown("Search presets");
    bench
}

/// Gold of the library as rows of a first column in some unit, n and k.
fn gold(header: &str, unit: impl Fn(f64) -> f64) -> String {
    let gold = find("Au").expect("it is there");
    let rows = gold.wavelength_nm.iter().zip(gold.n.iter().zip(&gold.k));
    let rows: Vec<String> = rows.map(|(nm, (n, k))| format!("{},{n},{k}", unit(*nm))).collect();
    format!("{header}\n{}\n", rows.join("\n"))
}

fn write(bench: &Bench, name: &str, text: &str) -> std::path::PathBuf {
    let path = bench.folder.join(name);
    std::fs::write(&path, text).expect("the folder can be written");
    path
}

/// Metals among the user's files.
fn own(bench: &Bench) -> Vec<Preset> {
    let Ok(entries) = std::fs::read_dir(bench.folder.join("user/presets/metals")) else { return Vec::new() };
    entries.map(|entry| Preset::read(&entry.expect("it can be listed").path()).expect("it is a preset")).collect()
}

fn metal_of(bench: &Bench, material: usize) -> Option<String> {
    match &bench.session().scene().materials[material].reflectance {
        Reflectance::Preset { id, .. } => Some(id.clone()),
        Reflectance::BaseColor => None,
    }
}

/// Waits for what a table turned out to be, and for the window to stand where its size puts it.
#[track_caller]
fn shown(bench: &mut Bench, label: &str) {
    bench.until_shown(label);
    bench.window.run_steps(5);
}

fn is_shown(bench: &Bench, text: &str) -> bool {
    bench.window.query_all_by_label_contains(text).next().is_some()
}

#[track_caller]
fn rename(bench: &mut Bench, field: &str, text: &str) {
    bench.window.get_by_label(field).set_text_value_accesskit(text);
    bench.window.run_steps(3);
}

fn dropped() {
    let mut bench = bench("import-dropped");
    let path = write(&bench, "my gold.csv", &gold("wavelength_nm,n,k", |nm| nm));
    bench.drop_file(&path);
    shown(&mut bench, "Plot of n and k over wavelength");
    for text in ["From ", "columns", "41 rows, 380 to 780 nm", "by the header", "Outside of Rec.709", "Cheapest form:"]
    {
        assert!(is_shown(&bench, text), "{text}");
    }
    assert!(own(&bench).is_empty(), "nothing comes in before it was looked at");
    rename(&mut bench, "Id of the metal", "no id!");
    assert!(is_shown(&bench, "inner `.`"), "a bad id is told");
    rename(&mut bench, "Id of the metal", "My-gold");
    rename(&mut bench, "Name of the metal", "My own gold");
    bench.click_role(Role::Button, IMPORT);
    bench.window.get_by_label("Search presets").set_text_value_accesskit("my own");
    bench.until_shown("My own gold");
    let kept = own(&bench);
    assert_eq!(kept.iter().map(|metal| metal.id.as_str()).collect::<Vec<_>>(), ["My-gold"]);
    assert!(kept[0].fits.as_ref().is_some_and(|fits| fits.belong_to(&kept[0])), "it is kept with its fits");
    assert!(bench.window.query_by_label("Delete preset").is_some(), "it is told about");
    assert_eq!(metal_of(&bench, 0), None, "it was imported, not assigned");

    bench.window.get_by_label("Search presets").set_text_value_accesskit("");
    bench.click_role(Role::ComboBox, "Show presets");
    bench.click("Own");
    assert!(bench.window.query_by_role_and_label(Role::Button, "Gold").is_none());
    bench.click_role(Role::Button, "My own gold");
    assert_eq!(metal_of(&bench, 0).as_deref(), Some("My-gold"));
}

fn pasted() {
    let mut bench = bench("import-pasted");
    let text = gold("nm,n,k", |nm| nm).replace("400,1.46836,", "400,1.4.6836,");
    bench.window.event(Event::Paste(text.clone()));
    shown(&mut bench, "Nothing can be imported:");
    assert!(is_shown(&bench, "Line 4"), "the line is told");
    bench.window.get_by_label("Pasted text").set_text_value_accesskit(&text.replace("1.4.6836", "1.46836"));
    bench.window.run_steps(3);
    bench.click("Read again");
    shown(&mut bench, "Plot of n and k over wavelength");
    rename(&mut bench, "Name of the metal", "Gold of the paper");
    bench.click_role(Role::Button, "Import and assign");
    bench.until("it is assigned", |w| {
        w.session().document().materials[0].preset.as_ref().is_some_and(|used| used.id == "pasted")
    });
    // What is pasted into a field is for the field, and prose is for nobody.
    bench.window.event(Event::Paste("a text\nof two lines".into()));
    bench.window.get_by_label("Search presets").focus();
    bench.window.run_steps(2);
    bench.window.event(Event::Paste(gold("nm,n,k", |nm| nm)));
    bench.window.run_steps(3);
    assert!(bench.window.query_by_label("Import optical constants").is_none());
}

fn broken() {
    let mut bench = bench("import-broken");
    let path = write(&bench, "bad.csv", &gold("wavelength_nm,n,k", |nm| nm).replace("500,0.97112,", "500,-0.97112,"));
    bench.drop_file(&path);
    shown(&mut bench, "Nothing can be imported:");
    assert!(is_shown(&bench, "Line 14") && is_shown(&bench, "Remedy: "), "line and remedy are told");
    assert!(bench.window.get_by_role_and_label(Role::Button, IMPORT).accesskit_node().is_disabled());
    bench.keys(Modifiers::NONE, Key::Escape);
    assert!(!is_shown(&bench, "Nothing can be imported:"), "it is closed");
    assert!(own(&bench).is_empty() && metal_of(&bench, 0).is_none());
}

fn overruled() {
    let mut bench = bench("import-unit");
    // Energies that lie where wavelengths in micrometres do.
    let path = write(&bench, "ev.txt", &gold("# of a spectrometer", |nm| 1239.841984 / nm));
    bench.workbench().ask(Request::ImportPreset(path));
    shown(&mut bench, "Nothing can be imported:");
    bench.click_role(Role::ComboBox, "Unit");
    bench.click("eV");
    shown(&mut bench, "Plot of n and k over wavelength");
    bench.until("it was read again", |workbench| !workbench.is_busy());
    assert!(is_shown(&bench, "380 to 780 nm"));
    bench.click_role(Role::Button, IMPORT);
    bench.window.get_by_label("Search presets").set_text_value_accesskit("ev");
    bench.until_shown("ev");
    let kept = own(&bench);
    let ends = kept[0].wavelength_nm.first().zip(kept[0].wavelength_nm.last()).expect("there are entries");
    assert!((ends.0 - 380.0).abs() < 1e-5 && (ends.1 - 780.0).abs() < 1e-5, "{ends:?}");
}

fn halves_and_presets() {
    let mut bench = bench("import-halves");
    let gold = find("Au").expect("it is there");
    let half = |values: &[f64]| -> String {
        gold.wavelength_nm.iter().zip(values).map(|(nm, value)| format!("{nm} {value}\n")).collect()
    };
    let n = write(&bench, "Mine.eta.spd", &half(&gold.n));
    let k = write(&bench, "Mine.k.spd", &half(&gold.k));
    bench.workbench().ask(Request::ImportPreset(n));
    bench.workbench().ask(Request::ImportPreset(k));
    shown(&mut bench, "Plot of n and k over wavelength");
    bench.click_role(Role::Button, IMPORT);
    bench.until("nothing waits", |workbench| !workbench.is_busy());
    assert!(bench.window.query_by_label("Import optical constants").is_none(), "one table was two files");

    let preset = Preset { id: "Theirs".into(), fits: None, ..gold };
    let path = write(&bench, "theirs.json", &preset.to_text().expect("it is text"));
    bench.drop_file(&path);
    bench.until("it is assigned", |w| {
        w.session().document().materials[0].preset.as_ref().is_some_and(|used| used.id == "Theirs")
    });
    assert!(own(&bench).iter().all(|metal| metal.fits.is_some()), "each is kept with its fits");
}
