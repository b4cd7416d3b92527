//! The Fresnel forms of the presets on the command line: list, table, report.

use std::collections::BTreeMap;
use std::fs;

use burnish_core::material::preset;
use burnish_core::surface::fresnel::Form;
use burnish_tests::scratch_folder;
use serde_json::Value;

use crate::{INPUT, RESOURCES, USAGE, burnish, text};

fn number(row: &Value, column: &str) -> f64 {
    row[column].as_f64().unwrap_or_else(|| panic!("no number `{column}` in {row}"))
}

pub fn the_list_gives_colours_in_other_spaces() {
    let presets = burnish(&["presets", "--space", "acescg", "--json"]).json();
    let find = |id: &str| presets.as_array().expect("a list").iter().find(|p| p["id"] == id).expect("a metal").clone();
    let (gold, silver) = (find("Au"), find("Ag"));
    // Gold lies within ACEScg; in Rec.709 its red is 1.037, and clamping it can just be seen.
    for (channel, known) in [0.900, 0.747, 0.417].into_iter().enumerate() {
        let found = gold["f0_in_space"][channel].as_f64().expect("a number");
        assert!((found - known).abs() < 0.003, "{gold}");
    }
    assert!(number(&gold, "clip_delta_e") > 0.5 && number(&silver, "clip_delta_e") == 0.0);
    assert!(gold["space"] == "acescg" && gold["warning"].is_null() && find("Zn")["warning"].is_string());
    assert!(gold["form"].as_str().is_some_and(|form| form.parse::<Form>().is_ok()), "{gold}");

    let words = burnish(&["presets", "--space", "rec2020"]).succeeded().out;
    assert!(words.contains("unclamped Rec.2020"), "{words}");
    let line = words.lines().find(|line| line.starts_with("Au ")).expect("gold");
    assert!(line.contains(" 1.25 "), "the clamp of gold: {line}");
}

pub fn the_table_has_a_row_for_each_metal_and_form() {
    let file = scratch_folder("forms").join("forms.csv");
    let json = burnish(&["presets", "--table", "--csv", text(&file), "--json"]).json();
    let rows = json.as_array().expect("a list");
    assert_eq!(rows.len(), preset::library().len() * Form::ALL.len());
    let mut chosen: BTreeMap<&str, usize> = BTreeMap::new();
    for row in rows {
        let id = row["preset"].as_str().expect("an id");
        *chosen.entry(id).or_default() += usize::from(row["chosen"] == true);
        assert!(number(row, "relative") >= 0.0 && number(row, "delta_e") >= number(row, "delta_e_mean"), "{row}");
        assert!(number(row, "nanoseconds") > 0.0 && number(row, "time_ratio") > 0.0, "{row}");
        if row["chosen"] == true {
            assert!(number(row, "relative") <= 0.01 && number(row, "delta_e") <= 1.0, "{row}");
            assert!(row["reason"].as_str().is_some_and(|reason| reason.contains('%')), "{row}");
        }
    }
    assert!(chosen.len() == preset::library().len() && chosen.values().all(|count| *count == 1), "{chosen:?}");

    let csv = fs::read_to_string(&file).expect("the table");
    let mut lines = csv.lines();
    let columns: Vec<&str> = lines.next().expect("a heading").split(',').collect();
    let mut of_json: Vec<&str> = rows[0].as_object().expect("columns").keys().map(String::as_str).collect();
    assert!(of_json.iter().all(|column| columns.contains(column)), "{columns:?} against {of_json:?}");
    of_json.dedup();
    assert_eq!((columns.len(), lines.clone().count()), (of_json.len(), rows.len()));
    for (line, row) in lines.zip(rows) {
        let start = format!("{},{},", row["preset"].as_str().unwrap_or(""), row["form"].as_str().unwrap_or(""));
        assert!(line.starts_with(&start), "{line}");
    }
}

pub fn the_tolerance_decides_which_form_is_chosen() {
    let chosen = |args: &[&str]| -> Vec<String> {
        let presets = burnish(&[&["presets", "--json"], args].concat()).json();
        let forms = presets.as_array().expect("a list").iter().map(|p| p["form"].as_str().expect("a form").to_string());
        forms.collect()
    };
    let all = |forms: &[String], form: Form| forms.iter().all(|f| f == form.id());
    assert!(all(&chosen(&["--relative", "1", "--delta-e", "100"]), Form::ALL[0]), "anything does: the cheapest");
    assert!(all(&chosen(&["--relative", "0"]), Form::Spectral), "nothing does: the truth");
    assert_ne!(chosen(&[]), chosen(&["--relative", "0.03"]));
    assert_ne!(chosen(&["--relative", "0.03"]), chosen(&["--relative", "0.03", "--delta-e", "0.2"]));

    let words = burnish(&["presets", "--table", "--relative", "0.03"]).succeeded().out;
    for form in Form::ALL {
        assert!(words.contains(form.id()), "{form}");
    }
    assert!(words.contains("within 3 %"), "{words}");
}

pub fn the_report_is_one_sound_page() {
    let file = scratch_folder("report").join("report.html");
    let out = burnish(&["fresnel-report", "--out", text(&file)]).succeeded().out;
    assert!(out.contains("report.html"), "{out}");
    let page = fs::read_to_string(&file).expect("the page");
    assert!(page.len() < 5_000_000, "{} bytes", page.len());
    for metal in preset::library() {
        for place in [format!("id=\"preset-{}\"", metal.id), format!("href=\"#preset-{}\"", metal.id)] {
            assert!(page.contains(&place), "{place}");
        }
    }
    for outside in ["http:", "https:", " src=", "<script", "<link", "<img", "@import"] {
        assert!(!page.contains(outside), "the page asks for something else: {outside}");
    }
    let bodies = ["NaN", ">inf", "-inf"];
    assert!(bodies.iter().all(|bad| !page.contains(bad)), "a number is none");
    assert_sound(&page);
}

/// Every tag is closed in order, ids are unique, links within the page lead somewhere, and drawings say what they show.
fn assert_sound(page: &str) {
    let mut open: Vec<&str> = Vec::new();
    let (mut ids, mut links) = (Vec::new(), Vec::new());
    for piece in page.split('<').skip(1) {
        let (tag, _) = piece.split_once('>').unwrap_or_else(|| panic!("an open tag: {piece}"));
        let name = tag.split([' ', '\n']).next().unwrap_or_default();
        let value =
            |key: &str| tag.split_once(&format!(" {key}=\"")).and_then(|(_, rest)| rest.split_once('"')).map(|v| v.0);
        ids.extend(value("id"));
        links.extend(value("href"));
        if name == "svg" {
            assert!(value("aria-label").is_some_and(|l| !l.is_empty()) || tag.contains("aria-hidden"), "{tag}");
        }
        match name.strip_prefix('/') {
            Some(closed) => assert_eq!(open.pop(), Some(closed), "after {}", ids.last().unwrap_or(&"the start")),
            None if tag.ends_with('/') || ["!doctype", "meta", "br"].contains(&name) => {}
            None => open.push(name),
        }
    }
    assert!(open.is_empty(), "not closed: {open:?}");
    let count = ids.len();
    assert!(links.iter().all(|link| ids.iter().any(|id| link.strip_prefix('#') == Some(id))), "{links:?}");
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count, "an id occurs twice");
}

pub fn a_report_on_some_metals() {
    let folder = scratch_folder("some");
    let file = folder.join("some.html");
    burnish(&["fresnel-report", "--out", text(&file), "--metal", "Au", "--metal", "iron", "--metal", "Au"]).succeeded();
    let page = fs::read_to_string(&file).expect("the page");
    assert_eq!(page.matches("<article ").count(), 2, "each once");
    assert!(page.contains("id=\"preset-Fe\"") && page.contains("1.037"));
    assert_sound(&page);

    burnish(&["fresnel-report", "--out", text(&file), "--metal", "Unobtainium"]).failed(USAGE, &["Unobtainium", "Au"]);
    burnish(&["fresnel-report", "--out", text(&file), "--metal", "none.json"]).failed(INPUT, &["none.json"]);
    let nowhere = folder.join("none/report.html");
    burnish(&["fresnel-report", "--out", text(&nowhere), "--metal", "Au"])
        .failed(RESOURCES, &["report.html", "folder"]);
    burnish(&["presets", "--space", "p3"]).failed(USAGE, &["p3", "rec2020"]);
    burnish(&["presets", "--csv", "x.csv"]).failed(USAGE, &["--table"]);
    burnish(&["presets", "--relative", "2"]).failed(USAGE, &["--relative", "0 to 1"]);
}

pub fn times_stand_beside_the_published_ones() {
    let report = burnish(&["fresnel-times", "--json"]).json();
    let errors = report["errors"].as_array().expect("a list");
    assert_eq!(errors.len(), 4);
    for row in errors {
        // Other measurements than the published ones: the same within a factor of three.
        let found = row["relative"].as_array().expect("three").iter().filter_map(Value::as_f64).fold(0.0, f64::max);
        let ratio = found / number(row, "published");
        assert!((0.3..3.0).contains(&ratio), "{row}");
    }
    let times = report["times"].as_array().expect("a list");
    assert_eq!(times.len(), Form::ALL.len());
    for row in times {
        assert!(number(row, "cpu_ns") > 0.0 && number(row, "cpu_relative") > 0.0, "{row}");
        assert!(row["gpu_ns"].as_f64().is_some_and(|ns| ns >= 0.0), "{row}");
    }
    burnish(&["fresnel-times", "--metal", "missing.json"]).failed(INPUT, &["missing.json"]);
}

pub fn balls_in_even_light_show_the_curve_of_every_form() {
    let file = scratch_folder("balls").join("balls.exr");
    let mut arguments = vec!["fresnel-balls", "--out", text(&file), "--even", "--roughness", "0", "--ball", "64"];
    arguments.extend(["--metal", "Cr"]);
    arguments.extend(Form::ALL.iter().flat_map(|form| ["--form", form.id()]));
    burnish(&arguments).succeeded();
    let (picture, _) = burnish_core::file::read_picture(&file).expect("a picture");
    assert_eq!((picture.width, picture.height), (64, 64 * Form::ALL.len() as u32));
    let chromium = preset::find("Cr").expect("a metal");
    for (row, form) in Form::ALL.into_iter().enumerate() {
        let curve = chromium.fresnel(form);
        // Of the row through the middle; 64 pixels are 2.1 radii. The last pixel is seen under 72 degrees.
        for x in [32, 40, 48, 56, 60] {
            let share = (x as f32 + 0.5 - 32.0) / 32.0 * 1.05;
            let expected = curve.eval((1.0 - share * share).sqrt());
            let found = picture.texels[(32 + 64 * row) * 64 + x].truncate();
            // Half a pixel up and the width of a pixel.
            assert!((found - expected).abs().max_element() < 0.015, "{form} {x}: {found} {expected}");
        }
    }
    // The difference that the table tells of is one to be seen: the first row is brighter before its rim.
    let [rescaled, spectral] = [Form::Rescaled, Form::Spectral].map(|form| form as usize);
    let at = |row: usize| picture.texels[(32 + 64 * row) * 64 + 60].x;
    assert!(at(rescaled) > at(spectral) + 0.02, "{} {}", at(rescaled), at(spectral));
}
