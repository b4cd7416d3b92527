//! Columns of numbers in the ways in which they are written.

use super::*;

#[test]
fn every_separator_and_order_of_columns_gives_the_same_metal() {
    let comma = |x: f64| x.to_string().replace('.', ",");
    let layouts = [
        format!("wavelength_um,n,k\n{}", gold(|w, n, k| format!("{w},{n},{k}"))),
        format!("Wavelength (um); n ; k\n{}", gold(|w, n, k| format!("{} ; {} ; {}", comma(w), comma(n), comma(k)))),
        format!("k\tn\tlambda [\u{b5}m]\n{}", gold(|w, n, k| format!("{}\t{}\t{}", comma(k), comma(n), comma(w)))),
        format!("\"Wavelength, \u{3bc}m\",\"n\",\"k\"\r\n{}", gold(|w, n, k| format!("\"{w}\",{n},{k}\r"))),
        format!("\u{feff}Wavelength, \u{b5}m,n,k\n{}", gold(|w, n, k| format!("{w},{n},{k}"))),
        format!("% gold\n// in the dark\nwl n k # um?\n{}", gold(|w, n, k| format!(" {w}  {n} {k}  # row"))),
        format!("sample,wl_um,n,n_err,k,\n{}", gold(|w, n, k| format!("Au,{w},{n},0.02,{k},"))),
        format!("# wl n k\n{}", gold(|w, n, k| format!("{w} {n} {k}"))),
        gold(|w, n, k| format!("{w}e0 {n} +{k}")),
        gold(|w, n, k| format!("{w},\t{n},\t{k}")),
    ];
    for text in layouts {
        let imported = sound(&text);
        is_gold(&imported);
        assert_eq!((imported.report.format, imported.report.rows), (Format::Columns, 14), "{text}");
        assert_eq!(imported.report.unit, Unit::Micrometre);
    }
}

#[test]
fn the_report_says_how_the_unit_is_known() {
    let origin = |text: &str, options: &Options| {
        let imported = parse(text, "Au.csv", options).unwrap();
        (imported.report.unit_origin.to_string(), texts(&imported.report.warnings))
    };
    let none = Options::default();
    let rows = gold(|w, n, k| format!("{w} {n} {k}"));
    assert_eq!(origin(&rows, &none).0, "guessed: the values, 0.3679 to 0.756, lie in 0.1 to 50");
    let header = format!("# gold\nwl_um n k\n{rows}");
    assert_eq!(origin(&header, &none).0, "by the header `wl_um` in line 2");
    let asked = Options { unit: Some(Unit::Micrometre), ..none.clone() };
    assert_eq!(origin(&header, &asked), ("as asked for".into(), String::new()));
    let wrong_header = format!("wl_nm n k\n{rows}");
    assert!(origin(&wrong_header, &asked).1.contains("is in nm by the header `wl_nm`"));
    let nm = gold(|w, n, k| format!("{} {n} {k}", 1e3 * w));
    assert!(origin(&nm, &none).0.contains("367.9 to 756"));
}

#[test]
fn photon_energies_become_wavelengths_in_increasing_order() {
    // As in the paper: 0.64 to 6.60 eV; here the rows of the visible range.
    let rows = [(1.64, 0.14, 4.542), (1.76, 0.13, 4.103), (2.14, 0.29, 2.863), (2.5, 1.04, 1.833), (3.12, 1.47, 1.952)];
    let text: String = rows.iter().map(|(e, n, k)| format!("{e};{n};{k}\n")).collect();
    for (header, unit) in [("energy_eV;n;k\n", None), ("", Some(Unit::ElectronVolt))] {
        let options = Options { unit, ..Options::default() };
        let imported = parse(&(header.to_string() + &text), "Au.csv", &options).unwrap();
        let Preset { wavelength_nm, n, k, .. } = &imported.preset;
        let from_back: Vec<f64> = rows.iter().rev().map(|row| HC_EV_NM / row.0).collect();
        assert!(wavelength_nm.iter().zip(&from_back).all(|(a, b)| (a / b - 1.0).abs() < 1e-9), "{wavelength_nm:?}");
        assert_eq!((n[0], k[0], n[4]), (1.47, 1.952, 0.14));
        assert!(texts(&imported.report.notes).contains("turned round"));
    }
    // Read as micrometres the table would end in the infrared.
    let error = plain(&text).unwrap_err().to_string();
    assert!(error.contains("covers 1640 to 3120 nm, nothing of the visible range"), "{error}");
    assert!(error.contains("say --unit eV"), "{error}");
}

#[test]
fn a_table_with_long_wavelengths_first_is_turned_round() {
    let rows: Vec<String> = gold(|w, n, k| format!("{w} {n} {k}")).lines().rev().map(String::from).collect();
    let imported = sound(&rows.join("\n"));
    is_gold(&imported);
    assert!(texts(&imported.report.notes).contains("long wavelengths first"));
}

#[test]
fn two_blocks_of_an_export_are_put_on_one_grid() {
    let text = "wl,n\n0.40,1.0\n0.50,2.0\n0.60,2.0\n0.80,4.0\n\nwl,k\n0.39,3.0\n0.55,3.0\n0.75,5.0\n";
    let imported = sound(text);
    let Preset { wavelength_nm, n, k, .. } = &imported.preset;
    assert_eq!(wavelength_nm, &[400.0, 500.0, 550.0, 600.0, 750.0]);
    assert_eq!(n, &[1.0, 2.0, 2.0, 2.0, 3.5]);
    assert_eq!(k, &[3.0, 3.0, 3.0, 3.5, 5.0]);
    let report = &imported.report;
    assert_eq!((report.format, report.rows, report.range_nm), (Format::Blocks, 7, (400.0, 750.0)));
    assert_eq!(report.unit_origin, UnitOrigin::Definition);
    assert!(texts(&report.warnings).contains("nothing between 600 and 750 nm"), "{:?}", report.warnings);
}

#[test]
fn an_export_reaches_from_x_rays_to_the_far_infrared() {
    // Values that fit no unit by themselves.
    let rows: String = [0.001, 0.01, 0.35, 0.4, 0.55, 0.7, 0.9, 2.0, 200.0].map(|w| format!("{w}\t1.5\n")).concat();
    let imported = sound(&format!("wl\tn\n{rows}wl\tk\n{rows}"));
    assert_eq!(imported.preset.wavelength_nm, [10.0, 350.0, 400.0, 550.0, 700.0, 900.0, 2000.0]);
    assert_eq!(imported.report.range_nm, (1.0, 200_000.0));
    assert!(texts(&imported.report.notes).contains("2 entries outside of 10 to 2000 nm"));
    let error = plain(&rows.replace("\t1.5", "\t1.5\t2")).unwrap_err().to_string();
    assert!(error.contains("names no unit") && error.contains("--unit nm|um|A|eV"), "{error}");
}

#[test]
fn remarks_above_the_rows_are_skipped_and_said() {
    let text = format!("Gold, evaporated, 1972, after Johnson\n{}", gold(|w, n, k| format!("{w},{n},{k}")));
    let imported = sound(&text);
    is_gold(&imported);
    assert_eq!(texts(&imported.report.notes), "Au.csv: line 1: is no row and no header; it was skipped\n");
}

#[test]
fn comments_become_the_note_and_the_name_of_the_file_the_id() {
    let text = format!("# Gold\n# evaporated\nwl_um,n,k\n{}", gold(|w, n, k| format!("{w},{n},{k}")));
    let preset = parse(&text, "Gold (1972).csv", &Options::default()).unwrap().preset;
    assert_eq!(preset.note.as_deref(), Some("Gold evaporated"));
    assert_eq!((preset.id.as_str(), preset.name.as_str()), ("Gold-1972", "Gold (1972)"));
    assert_eq!(preset.source.table.as_deref(), Some("imported from Gold (1972).csv"));
    let options = Options { id: Some("Au-2".into()), name: Some("Gold".into()), ..Options::default() };
    let preset = parse(&text, "x", &options).unwrap().preset;
    assert_eq!((preset.id.as_str(), preset.name.as_str()), ("Au-2", "Gold"));
}

#[test]
fn what_is_far_from_light_is_left_out_but_for_one_entry_on_each_side() {
    let text: String = (1..=60).map(|i| format!("{} 1 {i}\n", 50 * i)).collect();
    let imported = parse(&text, "x", &Options { unit: Some(Unit::Nanometre), ..Options::default() }).unwrap();
    let nm = &imported.preset.wavelength_nm;
    assert_eq!((nm[0], nm[1], nm[nm.len() - 1], nm.len()), (250.0, 300.0, 1050.0, 17));
    assert_eq!(imported.preset.k[0], 5.0);
    assert_eq!(imported.report.range_nm, (50.0, 3000.0));
}

#[test]
fn a_dielectric_is_read_with_a_warning_that_the_preset_keeps() {
    let imported = sound(&gold(|w, _, _| format!("{w} 1.5 0")));
    assert!(texts(&imported.report.warnings).contains("not a metal"));
    assert!(imported.preset.warning.unwrap().contains("not a metal"));
}

#[test]
fn a_table_that_would_do_in_two_units_is_warned_of() {
    let imported = sound("0.2 1 1\n0.5 1 2\n0.6 1 2\n2.0 1 3\n4.0 1 3\n");
    assert!(texts(&imported.report.warnings).contains("would do in eV too"), "{:?}", imported.report.warnings);
}

#[test]
fn k_of_the_other_sign_is_flipped_when_asked_for_and_not_otherwise() {
    let text = gold(|w, n, k| format!("{w} {n} -{k}"));
    let error = plain(&text).unwrap_err().to_string();
    assert!(error.contains("all k are negative: the file gives n - ik") && error.contains("--flip-k"), "{error}");
    assert_eq!(error.lines().count(), 1);
    let imported = parse(&text, "Au.csv", &Options { flip_k: true, ..Options::default() }).unwrap();
    is_gold(&imported);
    assert!(texts(&imported.report.notes).contains("flipped"));
    let positive = "nm,n,k\n400,1.5,1.9\n700,0.2,4\n";
    let error = parse(positive, "Au.csv", &Options { flip_k: true, ..Options::default() }).unwrap_err().to_string();
    assert!(error.contains("all k are positive") && error.contains("leave --flip-k away"), "{error}");
}

#[test]
fn our_own_preset_passes_through() {
    let gold = crate::material::preset::find("Au").unwrap();
    let text = serde_json::to_string(&gold).unwrap();
    let imported = sound(&text);
    assert_eq!(imported.preset, gold);
    let ImportReport { format, unit, rows, visible_points, .. } = imported.report;
    assert_eq!((format, unit, rows, visible_points), (Format::Preset, Unit::Nanometre, 41, 41));
    let renamed = parse(&text, "x", &Options { id: Some("Au-2".into()), ..Options::default() }).unwrap();
    assert_eq!(renamed.preset.id, "Au-2");
    for options in
        [Options { unit: Some(Unit::Micrometre), ..Options::default() }, Options { flip_k: true, ..Options::default() }]
    {
        assert!(parse(&text, "x", &options).unwrap_err().to_string().contains("by definition"));
    }
    assert!(plain("{\"format\": 1}").unwrap_err().to_string().contains("presets/README.md"));
    let empty = text.replacen("\"Au\"", "\"\"", 1);
    assert!(plain(&empty).unwrap_err().to_string().starts_with("Au.csv: field `id` is ``; use 1 to 64"));
}
