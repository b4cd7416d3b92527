//! Scenes for other renderers.

use std::fs;

use burnish_tests::scratch_folder;

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
