//! The command line, in process: exit codes, one-line messages, JSON, pictures.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use burnish_core::color::rgb::srgb_from_linear;
use burnish_core::color::tone::ToneMap;
use burnish_core::file::{Encoding, read_picture, write_exr, write_png};
use burnish_core::picture::Picture;
use burnish_tests::{Need, repository, scratch_folder, trial};
use glam::Vec4;
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
        trial("presets lists every file of the folder", &[], presets_lists_every_file),
        trial("a picture compared with itself is equal", &[], a_picture_equals_itself),
        trial("a difference over the threshold is exit code 1", &[], a_difference_over_the_threshold),
        trial("pictures that cannot be compared are refused in words", &[], incomparable_pictures),
        trial("a picture that cannot be saved is refused before it is rendered", &[], an_unwritable_picture),
        trial("a reader that goes away early is no failure", &[], a_closed_pipe),
        trial("a full disk is exit code 4", &[], a_full_disk),
    ]
}

fn with_an_adapter() -> Vec<Trial> {
    vec![
        trial("doctor finds the adapter", &[Need::Gpu], doctor_finds_the_adapter),
        trial("render writes a png of the asked size that shows the scene", &[Need::Gpu], render_writes_a_png),
        trial(
            "an exr holds the radiance, and a png without tone map shows it times 2^EV",
            &[Need::Gpu],
            render_writes_an_exr,
        ),
        trial("every example of the README runs", &[Need::Gpu], readme_examples_run),
        trial("a metal goes to the slot that is named", &[Need::Gpu], a_metal_on_a_slot),
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
        for command in ["render", "info", "presets", "compare", "doctor", "Exit codes"] {
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

/// A grey ramp with a little blue, 64 by 48.
fn ramp() -> Picture {
    Picture::from_fn(64, 48, |x, y| Vec4::new(x as f32 / 63.0, 0.5, y as f32 / 47.0, 1.0))
}

fn a_picture_equals_itself() {
    let folder = scratch_folder("equal");
    let (png, exr) = (folder.join("a.png"), folder.join("a.exr"));
    write_png(&ramp(), &png, ToneMap::None, 0.0).expect("a writable folder");
    write_exr(&ramp(), &exr).expect("a writable folder");
    for file in [&png, &exr] {
        let result = burnish(&["compare", text(file), text(file), "--threshold", "0", "--json"]).json();
        assert_eq!((result["flip"].as_f64(), result["relmse"].as_f64()), (Some(0.0), Some(0.0)));
    }
}

fn a_difference_over_the_threshold() {
    let folder = scratch_folder("different");
    let (a, b, diff) = (folder.join("a.exr"), folder.join("b.exr"), folder.join("diff.png"));
    let reference = ramp();
    let mut brighter = ramp();
    brighter.texels.iter_mut().for_each(|t| *t = (1.5 * *t).with_w(1.0));
    write_exr(&reference, &a).expect("a writable folder");
    write_exr(&brighter, &b).expect("a writable folder");

    let result = burnish(&["compare", text(&a), text(&b), "--json"]).json();
    let relmse = result["relmse"].as_f64().expect("a number");
    let flip = result["flip"].as_f64().expect("a number");
    // Each channel is off by half of r: the mean of 0.25 r^2 / (r^2 + 0.01).
    let terms = reference.texels.iter().flat_map(|t| [t.x, t.y, t.z]).map(|r| 0.25 * r * r / (r * r + 0.01));
    let expected = f64::from(terms.sum::<f32>()) / (3 * reference.texels.len()) as f64;
    assert!((relmse - expected).abs() < 1e-4, "{relmse} against {expected}");
    assert!((0.01..1.0).contains(&flip), "{flip}");

    for (metric, value) in [("flip", flip), ("relmse", relmse)] {
        let at = |threshold: f64, more: &[&str]| {
            let threshold = threshold.to_string();
            let args = ["compare", text(&a), text(&b), "--metric", metric, "--threshold", &threshold];
            burnish(&[&args, more].concat())
        };
        at(value * 1.01, &[]).succeeded();
        at(value * 0.99, &["--out", text(&diff)]).failed(DIFFERENCE, &["a.exr", metric]);
    }
    let (picture, _) = read_picture(&diff).expect("the difference was written");
    assert_eq!((picture.width, picture.height), (64, 48));
    assert!(picture.texels.iter().any(|t| t.max_element() > 0.1));
}

fn incomparable_pictures() {
    let folder = scratch_folder("incomparable");
    let (exr, png, small) = (folder.join("a.exr"), folder.join("a.png"), folder.join("small.exr"));
    write_exr(&ramp(), &exr).expect("a writable folder");
    write_png(&ramp(), &png, ToneMap::None, 0.0).expect("a writable folder");
    write_exr(&Picture::filled(3, 2, Vec4::ONE), &small).expect("a writable folder");
    burnish(&["compare", text(&small), text(&exr)]).failed(INPUT, &["small.exr", "3 x 2", "64 x 48"]);
    burnish(&["compare", text(&png), text(&exr)]).failed(INPUT, &["a.png", "a.exr"]);
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

/// A 32 by 16 environment in the Radiance format, one grey for all directions: prepared in no time, unlike the studio.
fn grey_environment(folder: &Path) -> PathBuf {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n".to_vec();
    // Mantissas of 128 / 256 times 2^(129 - 128).
    bytes.extend([128, 128, 128, 129].repeat(16 * 32));
    let file = folder.join("studio.hdr");
    fs::write(&file, bytes).expect("a writable folder");
    file
}

/// Renders with few frames at a small size; `more` arguments come last.
fn render(out: &Path, more: &[&str]) -> Outcome {
    burnish(&[&["render", "--size", "96x64", "--spp-jitter", "2", "--out", text(out)], more].concat())
}

fn render_writes_a_png() {
    let file = scratch_folder("png").join("w.png");
    let outcome = render(&file, &[]).succeeded();
    assert!(outcome.out.contains("w.png") && outcome.out.contains("96x64"), "{}", outcome.out);
    let (picture, encoding) = read_picture(&file).expect("a picture");
    assert_eq!((picture.width, picture.height, encoding), (96, 64, Encoding::Display));
    assert!(picture.is_opaque());
    let levels: std::collections::BTreeSet<u32> = picture.texels.iter().map(|t| (255.0 * t.y) as u32).collect();
    assert!(levels.len() > 20, "a workbench has light and shade: {} levels of green", levels.len());
}

fn render_writes_an_exr() {
    let folder = scratch_folder("exr");
    let (exr, png) = (folder.join("w.exr"), folder.join("w.png"));
    let environment = grey_environment(&folder);
    render(&exr, &["--env", text(&environment)]).succeeded();
    render(&png, &["--env", text(&environment), "--exposure", "1", "--tone", "none"]).succeeded();
    let (radiance, encoding) = read_picture(&exr).expect("a picture");
    assert_eq!((radiance.width, radiance.height, encoding), (96, 64, Encoding::Linear));
    assert!(radiance.texels.iter().all(|t| t.is_finite() && t.min_element() >= 0.0));

    let (shown, _) = read_picture(&png).expect("a picture");
    for (i, (radiance, shown)) in radiance.texels.iter().zip(&shown.texels).enumerate() {
        let expected = 255.0 * srgb_from_linear(2.0 * radiance.truncate());
        let found = 255.0 * srgb_from_linear(shown.truncate());
        // Half a step is the rounding; the rest leaves room for the order of sums on the adapter.
        assert!(expected.distance(found) < 1.5, "pixel {i}: {expected} shown as {found}");
    }
}

fn a_metal_on_a_slot() {
    let folder = scratch_folder("metal");
    let model = triangle(&folder);
    // Straight in front of the triangle, whose lower left half of the picture it fills.
    let environment = grey_environment(&folder);
    let view = ["--camera", "0.3,0.3,1,0.3,0.3,0,20", "--env", text(&environment)];
    let middle = |name: &str, more: &[&str]| {
        let file = folder.join(name);
        render(&file, &[&[text(&model)], &view[..], more].concat()).succeeded();
        let (picture, _) = read_picture(&file).expect("a picture");
        picture.texels[32 * 96 + 48].truncate()
    };
    let gold = middle("gold.exr", &["--metal", "Au:red"]);
    let silver = middle("silver.exr", &["--metal", "Au", "--metal", "Ag:#0"]);
    assert!(gold.x > 1.5 * gold.z, "gold is yellow: {gold}");
    assert!(silver.x < 1.3 * silver.z && silver.z > gold.z, "silver is grey: {silver}");
}

fn an_unwritable_picture() {
    let file = scratch_folder("unwritable").join("absent/w.png");
    render(&file, &[]).failed(RESOURCES, &["w.png", "absent", "create it"]);
    assert!(!file.exists());
}

/// The lines that start with `./dev run` and a command, with files in a folder of the test and small pictures.
fn readme_examples_run() {
    let folder = scratch_folder("readme");
    fs::create_dir_all(folder.join("docs/images")).expect("a writable folder");
    fs::write(folder.join("model.glb"), TRIANGLE).expect("a writable folder");
    let environment = grey_environment(&folder);
    let readme = fs::read_to_string(repository().join("README.md")).expect("the README");
    let examples: Vec<&str> = readme.lines().filter_map(|line| line.strip_prefix("    ./dev run ")).collect();
    let mut run = 0;
    for example in examples.iter().filter(|line| line.starts_with(|c: char| c.is_ascii_lowercase())) {
        let mut args: Vec<String> = example.split_whitespace().map(String::from).collect();
        let is_file = |arg: &str| [".png", ".exr", ".glb", ".hdr"].iter().any(|ending| arg.ends_with(ending));
        for arg in args.iter_mut().filter(|arg| is_file(arg)) {
            *arg = text(&folder.join(&*arg)).into();
        }
        if args[0] == "render" {
            match args.iter().position(|arg| arg == "--size") {
                Some(option) => args[option + 1] = "48x27".into(),
                None => args.extend(["--size".into(), "48x27".into()]),
            }
            args.extend(["--spp-jitter".into(), "1".into()]);
            if !args.contains(&"--env".into()) {
                args.extend(["--env".into(), text(&environment).into()]);
            }
        }
        let outcome = burnish(&args.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(outcome.exit, OK, "{example}: {}", outcome.err);
        run += 1;
    }
    assert!(run >= 8, "only {run} examples were found");
    for picture in ["docs/images/workbench.png", "copper.png", "workbench.exr", "brass.png", "diff.png"] {
        assert!(folder.join(picture).is_file(), "{picture}");
    }
}
