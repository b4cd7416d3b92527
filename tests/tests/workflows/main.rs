//! The command line, in process: exit codes, one-line messages, JSON, pictures.

mod baking;
mod chart;
mod comparing;
mod documents;
mod environment;
mod exporting;
mod fitting;
mod forms;
mod reference;
mod rendering;

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use burnish_tests::{Need, repository, scratch_folder, trial};
use libtest_mimic::{Arguments, Trial};
use serde_json::Value;

const OK: u8 = 0;
const DIFFERENCE: u8 = 1;
const USAGE: u8 = 2;
const INPUT: u8 = 3;
const RESOURCES: u8 = 4;

fn main() {
    let mut trials = free_of_the_gpu();
    trials.extend(with_an_adapter());
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn free_of_the_gpu() -> Vec<Trial> {
    vec![
        trial("help lists every command and ends well", &[], help_lists_every_command),
        trial("without a display the window is refused in one line", &[], a_window_without_a_display),
        trial("what makes no sense is refused in one line with exit code 2", &[], usage_errors),
        trial("a file that cannot be read is named in one line with exit code 3", &[], unreadable_files),
        trial("info describes the workbench in words and in JSON", &[], info_describes_the_workbench),
        trial("info reads a model file", &[], info_reads_a_model),
        trial("environment makes skies and studios and takes suns out of maps", &[], environment::made_and_split),
        trial("environment refuses what is no number or no studio", &[], environment::refused),
        trial("presets lists every file of the folder", &[], presets_lists_every_file),
        trial("presets gives colours in other spaces", &[], forms::the_list_gives_colours_in_other_spaces),
        trial("the table of forms has a row for each metal", &[], forms::the_table_has_a_row_for_each_metal_and_form),
        trial("the tolerance decides which form is chosen", &[], forms::the_tolerance_decides_which_form_is_chosen),
        trial("the report on forms is one sound page", &[], forms::the_report_is_one_sound_page),
        trial("a report on some metals names what it cannot use", &[], forms::a_report_on_some_metals),
        trial("a picture compared with itself is equal", &[], comparing::a_picture_equals_itself),
        trial("a difference over the threshold is exit code 1", &[], comparing::a_difference_over_the_threshold),
        trial("pictures that cannot be compared are refused in words", &[], comparing::incomparable_pictures),
        trial("a picture that cannot be saved is refused before it is rendered", &[], rendering::an_unwritable_picture),
        trial("a reader that goes away early is no failure", &[], a_closed_pipe),
        trial("info describes a document as it was edited", &[], documents::info_describes_a_document),
        trial("render lights objects as the document says", &[], documents::render_lights_objects_otherwise),
        trial("a document with a missing file is not rendered", &[], documents::a_missing_file_is_not_rendered),
        trial("a scene is exported with a report", &[], exporting::a_scene_is_exported_with_a_report),
        trial("scenes of the gallery are written as glb", &[], exporting::scenes_of_the_gallery_are_written_as_glb),
        trial(
            "a document is written as glb and read again",
            &[],
            exporting::a_document_is_written_as_glb_and_read_again,
        ),
        trial("what a glb cannot be is refused by name", &[], exporting::what_a_glb_cannot_be_is_refused_by_name),
        trial("a full disk is exit code 4", &[], a_full_disk),
        trial(
            "a chart is the same twice and kept in between",
            &[Need::Gpu],
            chart::a_chart_is_the_same_twice_and_kept_in_between,
        ),
        trial("a chart has each scene under each preset of lights", &[Need::Gpu], chart::presets_replace_the_lights),
        trial("what cannot be measured is told", &[], chart::what_cannot_be_measured_is_told),
        trial("shards are merged to the bytes of a whole", &[], baking::shards_are_merged_to_the_bytes_of_a_whole),
        trial("a picture is lit by what was baked", &[], baking::a_picture_is_lit_by_what_was_baked),
        trial("what the parts of a frame cost is told", &[], baking::what_the_parts_of_a_frame_cost_is_told),
        trial("the page of methods is that of the program", &[], the_page_of_methods),
        trial("threads do not change a traced file", &[], reference::threads_do_not_change_a_file),
        trial(
            "a traced picture that goes on is the uninterrupted one",
            &[],
            reference::a_picture_that_goes_on_is_the_uninterrupted_one,
        ),
        trial(
            "a checkpoint that does not fit is refused by name",
            &[],
            reference::a_checkpoint_that_does_not_fit_is_refused,
        ),
        trial(
            "a checkpoint that cannot be written costs no picture",
            &[],
            reference::a_checkpoint_that_cannot_be_written_costs_no_picture,
        ),
        trial("samples, time and error end a traced picture", &[], reference::every_end_ends_a_picture),
        trial(
            "the reference writes png and layers and reads settings",
            &[],
            reference::the_reference_writes_png_and_layers_and_reads_settings,
        ),
        trial(
            "a document is traced with its settings and spectral metals",
            &[],
            reference::a_document_is_traced_with_its_settings_and_spectral_metals,
        ),
        trial("options of the other method are refused", &[], reference::options_of_the_other_method_are_refused),
        trial("a table of n and k becomes a preset", &[], fitting::a_table_becomes_a_preset_that_renders),
        trial("a preset is fitted anew into its own file", &[], fitting::a_preset_is_fitted_anew_into_its_own_file),
        trial(
            "pairs of spectra and several files are fitted",
            &[],
            fitting::a_pair_of_spectra_and_several_files_are_fitted,
        ),
        trial("tables that make no sense are refused by line", &[], fitting::tables_that_make_no_sense_are_refused),
        trial("another preset is not written over", &[], fitting::another_preset_is_not_written_over),
        trial(
            "a preset that cannot be written is exit code 4",
            &[],
            fitting::a_preset_that_cannot_be_written_is_no_fault_of_the_table,
        ),
    ]
}

fn the_page_of_methods() {
    let page = fs::read_to_string(repository().join("docs/methods.md")).expect("the page");
    let now = burnish(&["methods", "--markdown"]).succeeded().out;
    assert!(page == now, "make it anew: burnish methods --markdown > docs/methods.md");
}

fn with_an_adapter() -> Vec<Trial> {
    vec![
        trial(
            "times of forms stand beside the published ones",
            &[Need::Gpu],
            forms::times_stand_beside_the_published_ones,
        ),
        trial(
            "balls in even light show the curve of every form",
            &[Need::Gpu],
            forms::balls_in_even_light_show_the_curve_of_every_form,
        ),
        trial("doctor finds the adapter", &[Need::Gpu], doctor_finds_the_adapter),
        trial(
            "render writes a png of the asked size that shows the scene",
            &[Need::Gpu],
            rendering::render_writes_a_png,
        ),
        trial(
            "an exr holds the radiance, and a png without tone map shows it times 2^EV",
            &[Need::Gpu],
            rendering::render_writes_an_exr,
        ),
        trial("every example of the README runs", &[Need::Gpu], rendering::readme_examples_run),
        trial("render shows a document as it was saved", &[Need::Gpu], documents::render_shows_a_document),
        trial("a metal goes to the slot that is named", &[Need::Gpu], rendering::a_metal_on_a_slot),
        trial(
            "a finish and a coat go where they are named, and unknown ones are refused",
            &[Need::Gpu],
            rendering::a_finish_and_a_coat,
        ),
    ]
}

/// What a command printed and how it ended.
struct Outcome {
    exit: u8,
    out: String,
    err: String,
}

fn burnish(args: &[&str]) -> Outcome {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let exit = burnish::run(args.iter().map(OsString::from), &mut out, &mut err);
    let text = |bytes| String::from_utf8(bytes).expect("the output is UTF-8");
    Outcome { exit, out: text(out), err: text(err) }
}

impl Outcome {
    #[track_caller]
    fn succeeded(self) -> Outcome {
        assert_eq!(self.exit, OK, "{}", self.err);
        self
    }

    /// Ended with `exit` and one line on the error stream that holds all `words`.
    #[track_caller]
    fn failed(self, exit: u8, words: &[&str]) -> Outcome {
        assert_eq!(self.exit, exit, "out: {}\nerr: {}", self.out, self.err);
        assert_eq!(self.err.trim_end().lines().count(), 1, "not one line: {}", self.err);
        assert!(self.err.starts_with("burnish: "), "{}", self.err);
        for word in words {
            assert!(self.err.contains(word), "`{word}` is missing in: {}", self.err);
        }
        self
    }

    #[track_caller]
    fn json(self) -> Value {
        let outcome = self.succeeded();
        serde_json::from_str(&outcome.out).unwrap_or_else(|e| panic!("{e}: {}", outcome.out))
    }
}

fn text(path: &Path) -> &str {
    path.to_str().expect("scratch paths are UTF-8")
}

fn help_lists_every_command() {
    for args in [&["--help"], &["help"]] {
        let help = burnish(args).succeeded().out;
        for command in ["render", "info", "presets", "fresnel-report", "compare", "doctor", "Exit codes"] {
            assert!(help.contains(command), "{command} is missing in: {help}");
        }
    }
    assert!(burnish(&["--version"]).succeeded().out.contains(env!("CARGO_PKG_VERSION")));
    for option in ["--metal", "--spp-jitter", "--camera", "--tone"] {
        assert!(burnish(&["render", "--help"]).succeeded().out.contains(option), "{option}");
    }
}

fn a_window_without_a_display() {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    // With a display a window would open, and would have to be closed by hand.
    if cfg!(target_os = "linux") && !["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(set) {
        burnish(&[]).failed(RESOURCES, &["display", "burnish render"]);
        burnish(&["gallery:workbench"]).failed(RESOURCES, &["display"]);
    }
    burnish(&["none/absent.glb"]).failed(INPUT, &["absent.glb"]);
    burnish(&["gallery:workbench", "--env", "absent.hdr"]).failed(INPUT, &["absent.hdr"]);
}

fn usage_errors() {
    let cases: &[(&[&str], &[&str])] = &[
        (&["rendr"], &["rendr", "render"]),
        (&["render"], &["--out"]),
        (&["render", "--out", "x.jpg"], &["--out", "jpg", ".png or .exr"]),
        (&["render", "--out", "x.png", "--size", "0x9"], &["--size", "8192"]),
        (&["render", "--out", "x.png", "--roughness", "NaN"], &["--roughness", "0 to 1"]),
        (&["render", "--out", "x.png", "--exposure", "99"], &["--exposure", "-32 to 32"]),
        (&["render", "--out", "x.png", "--spp-jitter", "0"], &["--spp-jitter", "1"]),
        (&["render", "--out", "x.png", "--tone", "film"], &["--tone", "neutral"]),
        (&["render", "--out", "x.exr", "--tone", "agx"], &["--tone", ".exr"]),
        (&["render", "--out", "x.png", "--set", "samples"], &["--set", "key=value"]),
        (&["render", "--out", "x.png", "--set", "samples=-3"], &["samples", "0 to 1024"]),
        (&["render", "--out", "x.png", "--set", "sample=3"], &["sample", "there are", "masking"]),
        (&["render", "--out", "x.png", "--camera", "1,2,3"], &["--camera", "seven numbers"]),
        (&["render", "--out", "x.png", "--camera", "nowhere"], &["nowhere", "there are: #0"]),
        (&["render", "--out", "x.png", "--metal", "Unobtainium"], &["Unobtainium", "Au"]),
        (&["render", "--out", "x.png", "--metal", "Au:lid"], &["lid", "there are: #0"]),
        (&["info", "a.glb", "b.glb"], &["b.glb"]),
        (&["compare", "a.png"], &["<B>"]),
        (&["compare", "a.png", "b.png", "--threshold", "-1"], &["--threshold"]),
        (&["compare", "a.png", "b.png", "--metric", "psnr"], &["--metric", "flip", "relmse"]),
    ];
    for (args, words) in cases {
        burnish(args).failed(USAGE, words);
    }
}

fn unreadable_files() {
    let folder = scratch_folder("unreadable");
    let absent = folder.join("absent.glb");
    burnish(&["info", text(&absent)]).failed(INPUT, &["absent.glb"]);
    burnish(&["render", text(&absent), "--out", "x.png"]).failed(INPUT, &["absent.glb"]);
    burnish(&["info", text(&folder)]).failed(INPUT, &["unreadable"]);
    burnish(&["info", "gallery:garage"]).failed(INPUT, &["garage", "workbench"]);

    let page = folder.join("page.glb");
    fs::write(&page, "<html>not found</html>").expect("the folder is writable");
    burnish(&["info", text(&page)]).failed(INPUT, &["page.glb"]);
    burnish(&["render", "--env", text(&page), "--out", "x.png"]).failed(INPUT, &["page.glb"]);
    burnish(&["compare", text(&page), text(&page)]).failed(INPUT, &["page.glb"]);
}

fn info_describes_the_workbench() {
    let words = burnish(&["info"]).succeeded().out;
    let info = burnish(&["info", "gallery:workbench", "--json"]).json();
    let materials = info["materials"].as_array().expect("a list of materials");
    assert!(!materials.is_empty());
    for material in materials {
        assert!(words.contains(material["name"].as_str().expect("materials have names")));
    }
    assert!(info["triangles"].as_u64().expect("a count") > 1000);
    assert!(words.contains(&format!("triangles    {}", info["triangles"])));
    let [min, max] = [0, 1].map(|i| info["bounds"][i][1].as_f64().expect("metres"));
    assert!(min < max && max - min < 100.0, "a room, not a city: {min} to {max}");
}

/// A triangle with one red material, its vertices in the file.
const TRIANGLE: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"leaf"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"metallicFactor":0.25}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

fn triangle(folder: &Path) -> PathBuf {
    let file = folder.join("triangle.gltf");
    fs::write(&file, TRIANGLE).expect("the folder is writable");
    file
}

fn info_reads_a_model() {
    let file = triangle(&scratch_folder("info"));
    let info = burnish(&["info", text(&file), "--json"]).json();
    assert_eq!((&info["triangles"], &info["instances"]), (&1.into(), &1.into()));
    assert_eq!(info["materials"][0]["name"], "red");
    assert_eq!(info["materials"][0]["metallic"], 0.25);
    assert_eq!(info["bounds"][1][0], 1.0);
}

fn presets_lists_every_file() {
    let files = fs::read_dir(repository().join("presets/metals")).expect("the folder of presets");
    let mut ids: Vec<String> = files
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "json"))
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    ids.sort();
    let presets = burnish(&["presets", "--json"]).json();
    let presets = presets.as_array().expect("a list");
    let mut listed: Vec<_> = presets.iter().map(|p| p["id"].as_str().expect("an id").to_string()).collect();
    listed.sort();
    assert!(listed.len() >= 12 && listed == ids, "{listed:?} against {ids:?}");
    for preset in presets {
        for channel in 0..3 {
            let f0 = preset["f0"][channel].as_f64().expect("a reflectance");
            let unclamped = preset["f0_unclamped"][channel].as_f64().expect("a reflectance");
            assert!((0.0..=1.0).contains(&f0) && (f0 - unclamped.clamp(0.0, 1.0)).abs() < 1e-6, "{preset}");
        }
    }
    let words = burnish(&["presets"]).succeeded().out;
    assert!(ids.iter().all(|id| words.contains(id)), "{words}");
}

/// A stream that fails in a chosen way.
struct Failing(std::io::ErrorKind);

impl std::io::Write for Failing {
    fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
        Err(self.0.into())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Err(self.0.into())
    }
}

fn a_closed_pipe() {
    for args in [["info", "--json"], ["presets", "--json"], ["help", "render"]] {
        let mut err = Vec::new();
        let mut out = Failing(std::io::ErrorKind::BrokenPipe);
        assert_eq!(burnish::run(args.map(OsString::from), &mut out, &mut err), OK, "{args:?}");
        assert!(err.is_empty(), "{args:?}");
    }
}

fn a_full_disk() {
    let mut err = Vec::new();
    let mut out = Failing(std::io::ErrorKind::StorageFull);
    assert_eq!(burnish::run(["info".into()], &mut out, &mut err), RESOURCES);
    assert_eq!(String::from_utf8_lossy(&err).lines().count(), 1);
}

fn doctor_finds_the_adapter() {
    let doctor = burnish(&["doctor"]).succeeded().out;
    assert!(doctor.contains("accepted") && doctor.contains("texture"), "{doctor}");
}
