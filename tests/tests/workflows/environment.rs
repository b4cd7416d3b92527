//! Environments made by numbers.

use std::fs;

use burnish_core::import::load_environment;
use burnish_tests::scratch_folder;
use glam::Vec3;

use super::{INPUT, USAGE, burnish, text};

pub fn made_and_split() {
    let folder = scratch_folder("environment");
    let (sky, rest) = (folder.join("sky.hdr"), folder.join("rest.exr"));
    let args =
        ["environment", "sky", "--elevation", "30", "--azimuth", "0", "--rows", "64", "--out", text(&sky), "--json"];
    let made = burnish(&args).json();
    let map = load_environment(&sky).expect("it was written").0;
    assert_eq!((map.width, map.height), (128, 64));
    let up = made["irradiance_up"][1].as_f64().expect("a number");
    assert!((f64::from(map.irradiance_up().y) / up - 1.0).abs() < 0.01, "{up}");
    assert!((made["sun"]["direction"][1].as_f64().expect("a number") - 0.5).abs() < 1e-4);
    // A sky has no sun in its map.
    burnish(&["environment", "split", text(&sky), "--out", text(&rest)]).failed(INPUT, &["sky.hdr", "sun"]);

    let mut texels = vec![Vec3::ONE; 128 * 64];
    texels[20 * 128 + 64] = Vec3::splat(6e4);
    let bright = folder.join("bright.hdr");
    let noon = burnish_core::scene::Environment::new("noon", 128, 64, texels);
    burnish_core::file::write_environment(&noon, &bright).expect("a writable folder");
    let split = burnish(&["environment", "split", text(&bright), "--out", text(&rest), "--json"]).json();
    assert!(split["peak"].as_f64().expect("a number") < 1.1, "{split}");
    assert!(split["sun"]["irradiance"][0].as_f64().expect("a number") > 50.0, "{split}");

    let (description, studio) = (folder.join("studio.json"), folder.join("studio.exr"));
    fs::write(&description, r#"{ "boxes": [{ "radiance": 700, "softness": 0 }] }"#).expect("a writable folder");
    let args = ["environment", "studio", text(&description), "--rows", "128", "--out", text(&studio), "--json"];
    let peak = burnish(&args).json()["peak"].as_f64().expect("a number");
    assert!((700.0..701.0).contains(&peak), "{peak}");
    let words = burnish(&["environment", "studio", "--rows", "32", "--out", text(&studio)]).succeeded().out;
    assert!(words.contains("64x32") && words.contains("lx"), "{words}");
}

pub fn refused() {
    let folder = scratch_folder("environment-refused");
    let out = folder.join("a.hdr");
    for bad in [["--turbidity", "1"], ["--elevation", "91"], ["--rows", "8"], ["--turbidity", "nan"]] {
        burnish(&["environment", "sky", bad[0], bad[1], "--out", text(&out)]).failed(USAGE, &[bad[0]]);
    }
    let description = folder.join("studio.json");
    for (json, word) in [("{", "EOF"), (r#"{ "boxes": [{ "softness": 3 }] }"#, "softness")] {
        fs::write(&description, json).expect("a writable folder");
        burnish(&["environment", "studio", text(&description), "--out", text(&out)])
            .failed(INPUT, &["studio.json", word]);
    }
    assert!(!out.exists());
}
