//! Scenes for other renderers.

use std::fs;

use burnish_core::import::{self, ImportOptions};
use burnish_core::material::preset;
use burnish_core::surface::fresnel::Form;
use burnish_tests::scratch_folder;

use super::documents::document;
use super::{INPUT, OK, RESOURCES, USAGE, burnish, text};

pub fn a_scene_is_exported_with_a_report() {
    let folder = scratch_folder("export").join("made");
    let export = |more: &[&str]| {
        let fixed = ["export", "--target", "mitsuba", "--size", "32x16", "--metal", "Cr:ball", "--out", text(&folder)];
        burnish(&[&fixed, more].concat())
    };
    let told = export(&["--coat", "clear-lacquer:ball"]).succeeded();
    assert!(told.out.contains("material 0 'ball': dropped: the clear coat"), "{}", told.out);
    assert!(told.out.contains("scene.xml"), "{}", told.out);
    let scene = fs::read_to_string(folder.join("scene.xml")).expect("the scene");
    assert!(scene.contains("name=\"width\" value=\"32\"") && scene.contains("roughconductor"), "{scene}");

    // Again, with other choices: the earlier export is replaced.
    let outcome = export(&["--json", "--spectral", "--bounces", "3", "--samples", "7"]).succeeded();
    let json: serde_json::Value = serde_json::from_str(&outcome.out).expect("JSON");
    assert!(json["files"].as_array().is_some_and(|files| files.iter().any(|f| f == "scene.xml")), "{json}");
    assert!(json["notes"][0]["loss"].is_string(), "{json}");
    let scene = fs::read_to_string(folder.join("scene.xml")).expect("the scene");
    for part in ["<spectrum name=\"eta\"", "name=\"max_depth\" value=\"4\"", "name=\"sample_count\" value=\"7\""] {
        assert!(scene.contains(part), "{part}: {scene}");
    }

    // What someone else wrote stays.
    fs::write(folder.join("scene.xml"), "<scene/>").expect("a writable folder");
    let refused = export(&[]);
    assert_ne!(refused.exit, OK);
    assert!(refused.err.contains("choose another folder"), "{}", refused.err);
    assert_eq!(fs::read_to_string(folder.join("scene.xml")).expect("the scene"), "<scene/>");
    assert_eq!(burnish(&["export", "--target", "povray", "--out", text(&folder)]).exit, USAGE);
}

pub fn scenes_of_the_gallery_are_written_as_glb() {
    let folder = scratch_folder("gallery-export");
    let told = burnish(&["gallery", "export", "ball?material=Cu", "gallery:wall", "--out", text(&folder)]).succeeded();
    assert!(told.out.contains("approximated: the curve of Cu") && told.out.contains("wrote"), "{}", told.out);
    for name in ["ball-material-Cu", "wall"] {
        let glb = folder.join(format!("{name}.glb"));
        let info = burnish(&["info", text(&glb)]).succeeded();
        assert!(info.out.contains("triangles"), "{}", info.out);
    }
    assert!(folder.join("wall.exr").is_file());
    burnish(&["gallery", "export", "wal", "--out", text(&folder)]).failed(INPUT, &["wal"]);
    burnish(&["gallery", "export", "wall", "wall", "--out", text(&folder)]).failed(USAGE, &["leave one out"]);
    let file = folder.join("wall.glb");
    burnish(&["gallery", "export", "wall", "--out", text(&file)]).failed(RESOURCES, &["cannot be made a folder"]);
}

pub fn a_document_is_written_as_glb_and_read_again() {
    let folder = scratch_folder("export-gltf");
    let (document, path) = document(&folder);
    let glb = folder.join("out.glb");
    let export = |more: &[&str]| burnish(&[&["export", text(&path), "--target", "gltf", "--out"], more].concat());
    let told = export(&[text(&glb)]).succeeded().out;
    for part in ["approximated: the curve of Au", "environment: dropped", "out.glb", "out.exr"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    let back = import::load_scene(&glb, &ImportOptions::default()).expect("a model").scene;
    let (gold, material) = (preset::find("Au").expect("gold"), &back.materials[0]);
    let color = gold.fresnel(Form::Spectral).f0();
    assert!(material.base_color.abs_diff_eq(color, 1e-4), "{} for {color}", material.base_color);
    assert!((material.roughness - 0.25).abs() < 1e-4 && material.metallic == 1.0, "{material:?}");
    let (view, camera) = (document.view.camera.camera(), &back.cameras[0]);
    assert!(camera.world_from_view.abs_diff_eq(view.world_from_view, 1e-4), "{camera:?}");
    let (map, _) = import::load_environment(&folder.join("out.exr")).expect("a map");
    assert_eq!((map.width, map.height), (32, 16));

    let json = export(&[text(&glb), "--json"]).json();
    assert_eq!(json["files"], serde_json::json!(["out.glb", "out.exr"]));
    assert_eq!(json["notes"][0]["loss"], "approximated");
}

pub fn what_a_glb_cannot_be_is_refused_by_name() {
    let folder = scratch_folder("export-gltf-refused");
    let (_, path) = document(&folder);
    let before = fs::read(folder.join("studio.hdr")).expect("it was written");
    let export = |out: &str, more: &[&str]| {
        let out = folder.join(out);
        burnish(&[&["export", text(&path), "--target", "gltf", "--out", text(&out)], more].concat())
    };
    export("out", &[]).failed(USAGE, &["--out", "out", ".glb"]);
    export("out.gltf", &[]).failed(USAGE, &["out.gltf", ".glb"]);
    for option in [&["--samples", "4"][..], &["--bounces", "2"], &["--spectral"], &["--size", "32x16"]] {
        export("out.glb", option).failed(USAGE, &[option[0], "mitsuba"]);
    }
    export("absent/out.glb", &[]).failed(RESOURCES, &["absent"]);
    assert!(!folder.join("out.glb").exists());

    // Neither the model nor the map that is read is written over.
    let model = folder.join("made.glb");
    export("made.glb", &[]).succeeded();
    let again = |model: &str, out: &str, more: &[&str]| {
        burnish(&[&["export", model, "--target", "gltf", "--out", out], more].concat())
    };
    again(text(&model), text(&model), &[]).failed(USAGE, &["made.glb", "write over"]);
    let map = folder.join("made.exr");
    again("gallery:workbench", text(&model), &["--env", text(&map)]).failed(USAGE, &["made.exr", "write over"]);
    assert_eq!(fs::read(folder.join("studio.hdr")).expect("it is there"), before);
}
