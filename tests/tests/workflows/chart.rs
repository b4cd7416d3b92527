//! `chart`: measurements, what is kept of them, and bad options.

use std::fs;

use burnish_tests::{repository, scratch_folder};

use super::rendering::grey_environment;
use super::{USAGE, burnish, text};

pub fn a_chart_is_the_same_twice_and_kept_in_between() {
    let folder = scratch_folder("chart");
    let sky = grey_environment(&folder);
    let [cache, svg, html] = ["cache", "chart.svg", "chart.html"].map(|name| folder.join(name));
    let measure = |csv: &str, more: &[&str]| {
        let csv = folder.join(csv);
        let sweeps = ["--sweep", "classical.samples=0,2", "--sweep", "reference.samples=1"];
        let files = ["--cache", text(&cache), "--out", text(&svg), "--csv", text(&csv), "--html", text(&html)];
        let size = ["--size", "32x18", "--samples", "8", "--env", text(&sky)];
        let args = [&["chart", "gallery:workbench"], &sweeps[..], &files[..], &size[..], more].concat();
        let told = burnish(&args).succeeded().err;
        let opened = told.contains("opening the graphics device");
        (fs::read_to_string(&csv).expect("a table"), opened)
    };
    let (first, opened) = measure("a.csv", &[]);
    assert!(opened);
    let rows: Vec<Vec<&str>> = first.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 4);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let column = |name: &str| rows[0].iter().position(|column| *column == name).unwrap_or_else(|| panic!("{name}"));
    let number = |row: usize, name: &str| -> f64 { rows[row][column(name)].parse().unwrap_or(f64::NAN) };
    for row in 1..4 {
        assert!(number(row, "frame_ms") > 0.0 && number(row, "frame_ratio") > 0.0, "{first}");
        assert!(number(row, "subject_relmse") > 0.0 && number(row, "frame_flip_floor") > 0.0, "{first}");
    }
    assert!((1..4).all(|row| number(row, "memory_bytes") > 1e4), "{first}");
    // Both candidates of one method look up the same.
    assert_eq!(rows[1][column("prepare_s")], rows[2][column("prepare_s")], "{first}");
    let drawn = fs::read_to_string(&svg).expect("a chart");
    assert!(drawn.starts_with("<svg xmlns") && drawn.contains("samples 2"), "{drawn}");
    assert!(fs::read_to_string(&html).expect("a page").contains("noise of the reference"));

    // Read from the cache, times and all, and no adapter is opened for it.
    assert_eq!(measure("b.csv", &[]), (first.clone(), false));
    // Measured again: errors are the same bytes.
    let (fresh, _) = measure("c.csv", &["--fresh"]);
    let errors = |table: &str| -> Vec<Vec<String>> {
        table.lines().map(|line| line.split(',').skip(column("under_floor")).map(String::from).collect()).collect()
    };
    assert_eq!(errors(&fresh), errors(&first));
    assert_ne!(fresh, first, "times of another run are not the same to the last digit");

    // Of fewer frames the mean is another, and that of the paths is the same.
    let (few, opened) = measure("e.csv", &["--frames", "2"]);
    assert!(opened && errors(&few)[1..3].iter().zip(&errors(&first)[1..3]).all(|(few, many)| few != many), "{few}");
    assert_eq!(errors(&few)[3], errors(&first)[3]);
    let frames = |table: &str| {
        table.lines().nth(1).and_then(|line| line.split(',').nth(column("compared_frames")).map(String::from))
    };
    assert_eq!([frames(&few), frames(&first)], ["2", "16"].map(|frames| Some(frames.into())));

    // Another truth is measured anew and told.
    assert!(rows[1][column("truth_settings")].is_empty());
    let (direct, opened) = measure("d.csv", &["--truth", "bounces=1", "--truth", "clamp=10"]);
    assert!(opened && direct.contains(",bounces=1 clamp=10,"), "{direct}");
    let page = fs::read_to_string(&html).expect("a page");
    assert!(page.contains("reference of 8 paths a pixel, with bounces=1 clamp=10"), "{page}");
}

pub fn presets_replace_the_lights() {
    let folder = scratch_folder("chart-lighting");
    let [cache, csv, dark] = ["cache", "chart.csv", "dark.json"].map(|name| folder.join(name));
    let preset = r#"{ "format": "burnish-lighting", "version": 1, "id": "dark", "name": "Dark", "lights": [],
        "environment": { "strength": 0 } }"#;
    fs::write(&dark, preset).expect("a writable folder");
    let sky = grey_environment(&folder);
    let more = folder.join("more.hdr");
    fs::copy(&sky, &more).expect("a writable folder");
    // The spot of this scene is its only light.
    let scene = "gallery:workbench?room=none";
    let size = ["--size", "32x18", "--samples", "8", "--methods", "reference", "--sweep", "samples=4"];
    let maps = ["--env", text(&sky), "--env", text(&more)];
    let lightings = ["--lighting", "rim", "--lighting", text(&dark)];
    let files = ["--cache", text(&cache), "--csv", text(&csv)];
    burnish(&[&["chart", scene], &size[..], &maps, &lightings, &files].concat()).succeeded();
    let table = fs::read_to_string(&csv).expect("a table");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column = rows[0].iter().position(|column| *column == "frame_relmse").expect("a column");
    let found: Vec<(&str, bool)> = rows[1..].iter().map(|row| (row[0], row[column].parse() == Ok(0.0))).collect();
    let name = |words: &str| format!("{scene} under {words}");
    // Paths of other seeds agree where nothing shines.
    let expected = [
        (name("studio lit by rim"), false),
        (name("studio lit by dark"), true),
        (name("more lit by rim"), false),
        (name("more lit by dark"), true),
    ];
    assert_eq!(found, expected.each_ref().map(|(name, is_black)| (name.as_str(), *is_black)), "{table}");
}

pub fn what_cannot_be_measured_is_told() {
    let refused = |args: &[&str], words: &[&str]| {
        burnish(&[&["chart"], args].concat()).failed(USAGE, words);
    };
    refused(&["--methods", "radiosity"], &["radiosity", "classical, impostor, area-cube, radiance-map, reference"]);
    refused(&["--sweep", "classical.samples=2000"], &["classical.samples=2000", "0 to 1024"]);
    refused(&["--sweep", "samples"], &["[METHOD.]key=a,b,c"]);
    refused(&["--sweep", "smples=1"], &["smples", "samples"]);
    refused(&["--methods", "classical", "--sweep", "reference.bounces=1"], &["reference", "--methods"]);
    refused(&["--truth", "bounces"], &["--truth", "key=value"]);
    refused(&["--truth", "bounce=1"], &["--truth bounce=1", "there are", "clamp"]);
    refused(&["--truth", "bounces=-1"], &["--truth bounces=-1", "0 to 1024"]);
    refused(&["--truth", "samples=4"], &["--truth samples=4", "--samples 4"]);
    refused(&["--lighting", "moon"], &["--lighting moon", "jewellery-tent", ".json"]);
    // Shots are told apart by the ids of presets.
    let file = scratch_folder("chart-presets").join("mine.json");
    let rim = fs::read_to_string(repository().join("presets/lighting/rim.json")).expect("a preset");
    fs::write(&file, rim.replace("Two hard lights", "Two lights")).expect("a writable folder");
    refused(&["--lighting", "all", "--lighting", text(&file)], &["mine.json", "`rim`"]);
    refused(&["--subject", "teapot"], &["teapot", "there are"]);
}
