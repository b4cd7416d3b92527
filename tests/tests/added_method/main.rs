//! A method that only this program knows: one file and one call of `register` put it into command line, chart, window and
//! pages. Nothing else is told of it.

mod ambient;
#[path = "../ui/bench.rs"]
#[allow(dead_code, reason = "shared with the tests of the window")]
mod bench;

use std::ffi::OsString;
use std::fs;
use std::path::Path;

use burnish::window::Pane;
use burnish_core::file::read_picture;
use burnish_core::job::Handle;
use burnish_core::lighting::prepared::{Store, key};
use burnish_core::lighting::{self, Method, classical};
use burnish_core::param::{ParamValue, Settings};
use burnish_core::reference::{Options, World};
use burnish_core::scene::gallery;
use burnish_tests::{Need, scratch_folder, trial};
use eframe::egui::Role;
use libtest_mimic::Arguments;

use ambient::Ambient;
use bench::{Bench, Setup};

fn main() {
    assert!(lighting::register(&Ambient), "once");
    let trials = vec![
        trial("an added method is listed once, and no other takes its id", &[], listed),
        trial("it is on the page of methods and in the list for machines", &[], documented),
        trial("it renders with its settings from the command line", &[], rendered),
        trial("what it prepares is kept and made anew when it must be", &[], kept),
        trial("it is charted beside the others", &[Need::Gpu], charted),
        trial("it is chosen, set and prepared in the window, saved and undone", &[], in_the_window),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// Runs a command in process: its exit code and what it said.
fn burnish(args: &[&str]) -> (u8, String, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let exit = burnish::run(args.iter().map(OsString::from), &mut out, &mut err);
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (exit, text(out), text(err))
}

fn path(file: &Path) -> &str {
    file.to_str().expect("a plain name")
}

fn listed() {
    assert!(!lighting::register(&Ambient), "it is there");
    let ids: Vec<&str> = lighting::methods().iter().map(|method| method.info().id.0).collect();
    assert_eq!(ids, ["classical", "impostor", "area-cube", "radiance-map", "reference", "ambient"]);
}

fn documented() {
    let (exit, page, _) = burnish(&["methods", "--markdown"]);
    assert!(exit == 0 && page.contains("## Ambient (`ambient`)") && page.contains("| `rows` | "), "{page}");
    assert!(page.contains("| lamps | filled by lamps with shadows |"), "{page}");
    let (_, json, _) = burnish(&["methods", "--json"]);
    let list: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let found = list.as_array().and_then(|list| list.iter().find(|method| method["id"] == "ambient"));
    let found = found.expect("it is in the list");
    assert_eq!((found["id"].as_str(), found["prepares_from"][0].as_str()), (Some("ambient"), Some("environment")));
    let (_, plain, _) = burnish(&["methods"]);
    assert!(plain.contains("ambient\n  The mean of the environment"), "{plain}");
    let (_, help, _) = burnish(&["render", "--help"]);
    assert!(help.contains("Settings of --method ambient:"), "{help}");
}

fn rendered() {
    let folder = scratch_folder("added-rendered");
    let cache = folder.join("cache");
    let render = |name: &str, more: &[&str]| {
        let file = folder.join(name);
        let fixed = ["render", "gallery:ball", "--method", "ambient", "--size", "32x24", "--out", path(&file)];
        let cache = ["--cache", path(&cache), "--samples", "2"];
        let (exit, _, err) = burnish(&[&fixed[..], &cache, more].concat());
        assert_eq!(exit, 0, "{err}");
        read_picture(&file).expect("a picture").0
    };
    let [one, two] = [render("one.exr", &[]), render("two.exr", &["--set", "gain=2"])];
    let middle = |picture: &burnish_core::picture::Picture| picture.texels[12 * 32 + 16].truncate();
    assert!(middle(&one).min_element() > 0.0);
    assert!((middle(&two) / middle(&one) - 2.0).abs().max_element() < 1e-5, "{} {}", middle(&one), middle(&two));
    // The sky behind is not the method's.
    assert_eq!(one.texels[0], two.texels[0]);
    assert_eq!(fs::read_dir(&cache).expect("a folder").count(), 1, "both have one preparation");

    let refused = |more: &[&str], words: &str| {
        let file = folder.join("none.exr");
        let (exit, _, err) =
            burnish(&[&["render", "gallery:ball", "--method", "ambient", "--out", path(&file)], more].concat());
        assert!(exit == 2 && err.contains(words), "{exit}: {err}");
    };
    refused(&["--set", "gian=2"], "gain, rows");
    refused(&["--set", "rows=65"], "1 to 64");
    refused(&["--checkpoint", "x"], "--checkpoint does not go with --method ambient");
    refused(&["--spp-jitter", "4"], "--method classical");
}

fn kept() {
    let folder = scratch_folder("added-kept");
    let mut scene = gallery::open("ball").expect("in the gallery");
    scene.environment = Some(gallery::studio().into());
    let world = |scene: &burnish_core::scene::Scene| World::new(&scene.clone().into(), Options::default());
    let mut settings = Settings::new(Ambient.info().params);
    let (store, job) = (Store::within(&folder), Handle::default());
    let prepare_in = |store: &Store, settings: &Settings, scene: &burnish_core::scene::Scene| {
        store.prepare(&key(&Ambient, settings, scene), &Ambient, &world(scene), settings, &job)
    };
    let prepare = |settings: &Settings, scene: &burnish_core::scene::Scene| prepare_in(&store, settings, scene);
    let files = || fs::read_dir(&folder).map_or(0, Iterator::count);
    let first = prepare(&settings, &scene).expect("an environment");
    assert!(first.bytes() == 12 && files() == 1);

    // Neither a setting of frames nor an edit of what it does not read makes another.
    settings.set_value("gain", ParamValue::Number(3.0)).expect("in range");
    scene.materials[0].roughness = 0.77;
    let before = key(&Ambient, &settings, &scene);
    assert_eq!(store.read(&before).as_ref(), Some(&*first));
    settings.set_value("rows", ParamValue::Integer(5)).expect("in range");
    assert!(store.read(&key(&Ambient, &settings, &scene)).is_none());
    let other = prepare(&settings, &scene).expect("an environment");
    assert!(other != first && files() == 2);

    // A damaged file is none, and is written again.
    let file = folder.join(format!("{before}.prepared"));
    let mut bytes = fs::read(&file).expect("it was kept");
    let last = bytes.len() - 40;
    bytes[last] ^= 1;
    fs::write(&file, &bytes).expect("the folder can be written");
    settings.set_value("rows", ParamValue::Integer(64)).expect("in range");
    assert!(store.read(&before).is_none());
    assert_eq!(prepare(&settings, &scene).as_ref(), Ok(&first));
    assert_eq!(store.read(&before).as_ref(), Some(&*first));

    job.cancel();
    scene.environment = None;
    let error = prepare_in(&Store::none(), &settings, &scene).unwrap_err();
    assert_eq!(error.to_string(), "cancelled");
    let error = Ambient.prepare(&world(&scene), &settings, &Handle::default()).unwrap_err();
    assert!(error.to_string().contains("--env"), "{error}");
}

fn charted() {
    let folder = scratch_folder("added-charted");
    let [cache, csv, svg, html] = ["cache", "a.csv", "a.svg", "a.html"].map(|name| folder.join(name));
    let files =
        ["--cache", path(&cache), "--csv", path(&csv), "--out", path(&svg), "--html", path(&html), "--size", "32x18"];
    let fixed = ["chart", "gallery:ball", "--methods", "ambient,reference", "--samples", "8"];
    let (exit, out, err) =
        burnish(&[&fixed[..], &["--sweep", "gain=1,2", "--sweep", "reference.samples=1"], &files].concat());
    assert_eq!(exit, 0, "{err}");
    assert_eq!(out.lines().filter(|line| line.contains(" ambient ")).count(), 2, "{out}");
    let table = fs::read_to_string(&csv).expect("a table");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|column| *column == name).expect("a column");
    let number = |row: usize, name: &str| -> f64 { rows[row][column(name)].parse().expect("a number") };
    assert_eq!(rows.len(), 4);
    assert!(rows[1].contains(&"ambient") && rows[1].contains(&"gain=1 rows=64"), "{table}");
    // Light from everywhere is no good stand-in, and twice of it a worse one.
    assert!(number(2, "frame_relmse") > number(1, "frame_relmse") && number(1, "frame_relmse") > 0.0, "{table}");
    assert_eq!(number(1, "memory_bytes"), 12.0);
    assert!(fs::read_to_string(&html).expect("a page").contains("The mean of the environment from everywhere."));
    assert!(fs::read_to_string(&svg).expect("a chart").contains("ambient"));
}

fn in_the_window() {
    let mut bench =
        Bench::new(Setup { name: "added-window", scene: Some("gallery:ball"), size: [1280.0, 2000.0], drawn: false });
    let method = |bench: &Bench| bench.session().document().lighting.live_method().info().id.0;
    assert_eq!(method(&bench), classical::ID);
    bench.workbench().show_panel(Pane::Environment);
    bench.until_shown("Lighting method");
    bench.click_role(Role::ComboBox, "Method");
    bench.click("Ambient");
    assert_eq!(method(&bench), ambient::ID);
    bench.until_shown("prepared");
    bench.slide("Gain", 2.5);
    let gain = |bench: &Bench| bench.session().document().lighting.settings().get("gain");
    assert_eq!(gain(&bench), Some(ParamValue::Number(2.5)));
    bench.until_shown(
        "ambient; no lamps; environment: approximate; indirect diffuse: nothing; indirect glossy: nothing",
    );
    assert!(bench.text().contains("\"method\": \"ambient\""), "it is saved: {}", bench.text());
    // It refines while nothing changes: a picture of many samples was not begun anew.
    bench.until("it is drawn", |w| w.reference().shown().is_some_and(|look| look.samples >= 8));
    bench.until_shown(
        "ambient; no lamps; environment: approximate; indirect diffuse: nothing; indirect glossy: nothing",
    );
    // Its settings wait while another is chosen.
    bench.click_role(Role::ComboBox, "Method");
    bench.click("Classical");
    assert_eq!((method(&bench), gain(&bench)), (classical::ID, None));
    bench.workbench().session_mut().undo();
    bench.workbench().session_mut().redo();
    bench.workbench().session_mut().undo();
    assert_eq!((method(&bench), gain(&bench)), (ambient::ID, Some(ParamValue::Number(2.5))));
}
