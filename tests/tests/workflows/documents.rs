//! Documents on the command line.

use std::fs;
use std::path::{Path, PathBuf};

use burnish_core::document::{self, Assigned, Document};
use burnish_core::file::read_picture;
use burnish_core::material::preset;
use burnish_core::param::ParamValue;
use burnish_tests::scratch_folder;

use super::rendering::{grey_environment, render};
use super::{INPUT, USAGE, burnish, text, triangle};

/// A gold triangle under a grey sky, seen from straight in front and two stops brighter.
pub fn document(folder: &Path) -> (Document, PathBuf) {
    let mut document = document::open(text(&triangle(folder))).expect("a model").document;
    let gold = preset::find("Au").expect("gold");
    document.assign_preset(0, &gold, Assigned::KeepTextures);
    document.set_value(0, "roughness", ParamValue::Number(0.25)).expect("a roughness");
    document.environment.source = Some(text(&grey_environment(folder)).into());
    document.view.camera.target = [0.3, 0.3, 0.0];
    (document.view.camera.yaw_deg, document.view.camera.pitch_deg) = (0.0, 0.0);
    (document.view.camera.distance, document.view.camera.yfov_deg) = (1.0, 20.0);
    document.view.exposure_ev = 2.0;
    document.view.tone = "none".into();
    let path = folder.join("leaf.burnish");
    document.save(&path).expect("a writable folder");
    (document, path)
}

pub fn info_describes_a_document() {
    let (_, path) = document(&scratch_folder("document-info"));
    let info = burnish(&["info", text(&path), "--json"]).json();
    assert_eq!(info["materials"][0]["preset"], "Au");
    assert_eq!(info["materials"][0]["roughness"], 0.25);
    assert_eq!(info["environment"]["width"], 32);
}

pub fn a_missing_file_is_not_rendered() {
    let folder = scratch_folder("document-missing");
    let (_, path) = document(&folder);
    fs::remove_file(folder.join("studio.hdr")).expect("it was written");
    render(&folder.join("a.png"), &[text(&path)]).failed(INPUT, &["studio.hdr", "relink"]);
    let info = burnish(&["info", text(&path)]).succeeded().out;
    assert!(info.contains("studio.hdr is missing"), "{info}");
    fs::write(&path, "{\"format\": \"burnish-document\", \"version\": 99}").expect("a writable folder");
    burnish(&["info", text(&path)]).failed(INPUT, &["leaf.burnish", "version 99"]);
}

pub fn render_shows_a_document() {
    let folder = scratch_folder("document-render");
    let (_, path) = document(&folder);
    let middle = |name: &str, more: &[&str]| {
        let file = folder.join(name);
        render(&file, &[&[text(&path)], more].concat()).succeeded();
        let (picture, _) = read_picture(&file).expect("a picture");
        picture.texels[32 * 96 + 48].truncate()
    };
    let linear = middle("a.exr", &[]);
    assert!(linear.x > 1.5 * linear.z && linear.z > 0.0, "gold is yellow: {linear}");
    let shown = middle("a.png", &["--exposure", "-2"]);
    assert!((shown - 0.25 * linear).abs().max_element() < 0.01, "{shown} for {linear} two stops down");
    let brighter = middle("b.png", &[]);
    let expected = (4.0 * linear).min(glam::Vec3::ONE);
    assert!((brighter - expected).abs().max_element() < 0.02, "{brighter} for {linear} two stops up");
}

/// No device is needed: several methods, or `--processor`, draw without one.
pub fn render_lights_objects_otherwise() {
    let folder = scratch_folder("document-otherwise");
    let (mut document, path) = document(&folder);
    let cache = folder.join("cache");
    let draw = |name: &str, more: &[&str]| {
        let file = folder.join(name);
        let fixed = ["render", text(&path), "--size", "96x64", "--cache", text(&cache), "--samples", "4"];
        let done = burnish(&[&fixed[..], &["--out", text(&file)], more].concat()).succeeded();
        (done.out, read_picture(&file).expect("a picture").0)
    };
    let (said, plain) = draw("plain.exr", &["--processor"]);
    assert!(said.contains("4 samples by classical,") && !said.contains("object"), "{said}");
    render(&folder.join("no.exr"), &[text(&path), "--processor"]).failed(USAGE, &["--spp-jitter", "--samples"]);
    let (_, paths) = draw("paths.exr", &["--method", "reference"]);

    let key = document::object_keys(&document::load_model(&document.scene).expect("a model").0)[0].clone();
    document.lighting.override_object(&key, Some("reference"));
    document.save(&path).expect("a writable folder");
    let (said, mixed) = draw("mixed.exr", &[]);
    assert!(said.contains("4 samples by classical, 1 object by another method"), "{said}");
    // The only object is traced: in the form of the live method, which keeps 1 % of the measured curve.
    let at = |picture: &burnish_core::picture::Picture| picture.texels[32 * 96 + 48].truncate();
    assert!((at(&mixed) / at(&paths) - 1.0).abs().max_element() < 0.02, "{} is not {}", at(&mixed), at(&paths));
    let (_, separable) = draw("separable.exr", &["--set", "masking=separable"]);
    assert_ne!(separable.texels, mixed.texels, "what is about the surface is that of the command line");
    let (said, again) = draw("again.exr", &["--method", "classical", "--processor"]);
    assert!(!said.contains("object"), "a method on the command line lights all: {said}");
    assert_eq!(again.texels, plain.texels);
    assert_eq!(fs::read_dir(&cache).expect("a folder").count(), 1, "all have one preparation");
}
