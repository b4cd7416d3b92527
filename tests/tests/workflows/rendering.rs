//! Pictures that are rendered.

use std::fs;
use std::path::{Path, PathBuf};

use burnish_core::color::rgb::srgb_from_linear;
use burnish_core::file::{Encoding, read_picture};
use burnish_tests::{repository, scratch_folder};

use super::{OK, Outcome, RESOURCES, TRIANGLE, USAGE, burnish, text, triangle};

/// A 32 by 16 environment in the Radiance format, one grey for all directions: prepared in no time, unlike the studio.
pub fn grey_environment(folder: &Path) -> PathBuf {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n".to_vec();
    // Mantissas of 128 / 256 times 2^(129 - 128).
    bytes.extend([128, 128, 128, 129].repeat(16 * 32));
    let file = folder.join("studio.hdr");
    fs::write(&file, bytes).expect("a writable folder");
    file
}

/// A grey sky with a sun in one texel, a million times as bright.
fn field_with_a_sun(folder: &Path) {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 128\n".to_vec();
    let sun = bytes.len() + 4 * (20 * 128 + 40);
    bytes.extend([128, 128, 128, 129].repeat(64 * 128));
    bytes[sun + 3] += 20;
    fs::write(folder.join("field.hdr"), bytes).expect("a writable folder");
}

/// Renders with few frames at a small size; `more` arguments come last.
pub fn render(out: &Path, more: &[&str]) -> Outcome {
    burnish(&[&["render", "--size", "96x64", "--spp-jitter", "2", "--out", text(out)], more].concat())
}

pub fn render_writes_a_png() {
    let file = scratch_folder("png").join("w.png");
    let outcome = render(&file, &[]).succeeded();
    assert!(outcome.out.contains("w.png") && outcome.out.contains("96x64"), "{}", outcome.out);
    let (picture, encoding) = read_picture(&file).expect("a picture");
    assert_eq!((picture.width, picture.height, encoding), (96, 64, Encoding::Display));
    assert!(picture.is_opaque());
    let levels: std::collections::BTreeSet<u32> = picture.texels.iter().map(|t| (255.0 * t.y) as u32).collect();
    assert!(levels.len() > 20, "a workbench has light and shade: {} levels of green", levels.len());
}

pub fn render_writes_an_exr() {
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

pub fn a_metal_on_a_slot() {
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

pub fn a_finish_and_a_coat() {
    let folder = scratch_folder("finish");
    let model = triangle(&folder);
    let environment = grey_environment(&folder);
    let view = ["--camera", "0.3,0.3,1,0.3,0.3,0,20", "--env", text(&environment), "--metal", "Au:red"];
    let picture = |name: &str, more: &[&str]| {
        let file = folder.join(name);
        render(&file, &[&[text(&model)], &view[..], more].concat()).succeeded();
        read_picture(&file).expect("a picture").0.texels
    };
    let mirror = picture("mirror.exr", &["--finish", "mirror"]);
    assert!(picture("slot.exr", &["--finish", "mirror:red"]) == mirror);
    assert!(picture("roughness.exr", &["--finish", "satin", "--roughness", "0"]) == mirror, "a factor comes after");
    assert!(picture("coat.exr", &["--finish", "mirror", "--coat", "Clear lacquer"]) != mirror);
    assert!(picture("none.exr", &["--finish", "mirror", "--coat", "none"]) == mirror);
    for (option, value, parts) in [
        ("--finish", "hamered", ["no finish `hamered`", "did you mean hammered"]),
        ("--coat", "mirror", ["no coat `mirror`", "clear-lacquer"]),
        ("--finish", "cast:absent", ["--finish cast", "absent"]),
    ] {
        render(&folder.join("x.png"), &[text(&model), option, value]).failed(USAGE, &parts);
    }
}

pub fn an_unwritable_picture() {
    let file = scratch_folder("unwritable").join("absent/w.png");
    render(&file, &[]).failed(RESOURCES, &["w.png", "absent", "create it"]);
    assert!(!file.exists());
}

/// The lines that start with `./dev run` and a command, with files in a folder of the test and small pictures.
pub fn readme_examples_run() {
    let folder = scratch_folder("readme");
    fs::create_dir_all(folder.join("docs/images")).expect("a writable folder");
    fs::write(folder.join("model.glb"), TRIANGLE).expect("a writable folder");
    fs::write(folder.join("gold.csv"), "nm,n,k\n400,1.47,1.95\n500,0.97,1.87\n600,0.25,3.07\n700,0.13,4.06\n")
        .expect("a writable folder");
    let environment = grey_environment(&folder);
    field_with_a_sun(&folder);
    let readme = fs::read_to_string(repository().join("README.md")).expect("the README");
    let examples: Vec<&str> = readme.lines().filter_map(|line| line.strip_prefix("    ./dev run ")).collect();
    let mut run = 0;
    for example in examples.iter().filter(|line| line.starts_with(|c: char| c.is_ascii_lowercase())) {
        let mut args: Vec<String> = example.split_whitespace().map(String::from).collect();
        let is_file = |arg: &str| {
            ["png", "exr", "glb", "hdr", "html", "csv", "svg", "json", "checkpoint", "bake", "shard"]
                .iter()
                .any(|end| arg.ends_with(&format!(".{end}")))
        };
        for arg in args.iter_mut().filter(|arg| is_file(arg)) {
            *arg = text(&folder.join(&*arg)).into();
        }
        // A preset's file with the slot it is for.
        for arg in args.iter_mut().filter(|arg| arg.contains(".json:")) {
            *arg = text(&folder.join(&*arg)).into();
        }
        for arg in args.iter_mut().filter(|arg| arg.ends_with(".burnish")) {
            *arg = text(&repository().join(&*arg)).into();
        }
        if args.iter().take(2).any(|arg| arg == "export") {
            // A folder has no ending to know it by.
            let out = args.iter().position(|arg| arg == "--out").expect("a place to write to") + 1;
            args[out] = text(&folder.join(&args[out])).into();
        }
        if args[0] == "snapshot" {
            args.extend(["--size".into(), "320x200".into()]);
        }
        if args[0] == "chart" {
            let cache: String = text(&folder.join("measured")).into();
            args.extend(["--size", "32x18", "--samples", "4", "--cache"].map(String::from));
            args.extend([cache, "--env".into(), text(&environment).into()]);
        }
        if args[0] == "render" {
            match args.iter().position(|arg| arg == "--size") {
                Some(option) => args[option + 1] = "48x27".into(),
                None => args.extend(["--size".into(), "48x27".into()]),
            }
            if !args.contains(&"reference".into()) {
                args.extend(["--spp-jitter".into(), "1".into()]);
            }
            if !args.contains(&"--env".into()) {
                args.extend(["--env".into(), text(&environment).into()]);
            }
        }
        let outcome = burnish(&args.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(outcome.exit, OK, "{example}: {}", outcome.err);
        run += 1;
    }
    assert!(run >= 8, "only {run} examples were found");
    for picture in [
        "docs/images/workbench.png",
        "docs/images/window.png",
        "docs/images/light.png",
        "docs/images/lights.png",
        "copper.png",
        "hammered.png",
        "workbench.exr",
        "truth.png",
        "truth.exr",
        "truth.checkpoint",
        "brass.png",
        "diff.png",
        "forms.csv",
        "forms.html",
        "copper.glb",
        "copper.exr",
        "scenes/bowls.glb",
    ] {
        assert!(folder.join(picture).is_file(), "{picture}");
    }
}
