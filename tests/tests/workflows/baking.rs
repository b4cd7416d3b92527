//! `bake`, `merge` and pictures of what they write.

use std::fs;
use std::path::Path;

use burnish_tests::scratch_folder;
use serde_json::Value;

use super::{INPUT, USAGE, burnish, text};

const SCENE: &str = "gallery:room?roughness=0.5";
const FEW: [&str; 6] = ["--set", "points=600", "--set", "directions=16", "--set", "paths=2"];

fn bake(out: &Path, more: &[&str]) {
    burnish(&[&["bake", SCENE, "--out", text(out)], &FEW[..], more].concat()).succeeded();
}

pub fn shards_are_merged_to_the_bytes_of_a_whole() {
    let folder = scratch_folder("baking");
    let [whole, a, b, c, merged] =
        ["whole.bake", "a.shard", "b.shard", "c.shard", "merged.bake"].map(|name| folder.join(name));
    bake(&whole, &["--threads", "1"]);
    for (file, which) in [(&a, "1/3"), (&b, "2/3"), (&c, "3/3")] {
        bake(file, &["--shard", which]);
    }
    let files = [text(&c), text(&a), text(&b)];
    let told = burnish(&[&["merge", "--json", "--out", text(&merged)], &files[..]].concat()).succeeded().out;
    let report: Value = serde_json::from_str(&told).expect("JSON");
    assert!(report["bytes"].as_u64() > Some(1000) && report["noise"].as_f64() > Some(0.0), "{told}");
    assert!(fs::read(&whole).expect("a bake") == fs::read(&merged).expect("a bake"));

    // What is missing, damaged, twice there or of another bake is named.
    let refused = |files: &[&str], words: &[&str]| {
        burnish(&[&["merge", "--out", text(&merged)], files].concat()).failed(INPUT, words);
    };
    refused(&[text(&a), text(&c)], &["a.shard", "2/3"]);
    refused(&[text(&a), text(&b), text(&c), text(&b)], &["b.shard: has block"]);
    let mut bytes = fs::read(&b).expect("a shard");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 16;
    fs::write(&b, bytes).expect("it can be written");
    refused(&[text(&a), text(&b), text(&c)], &["b.shard", "damaged"]);
    bake(&b, &["--shard", "2/3", "--seed", "5"]);
    refused(&[text(&a), text(&b), text(&c)], &["b.shard", "seed"]);
    refused(&[text(&whole)], &["whole.bake", "bake-shard"]);
    burnish(&["bake", SCENE, "--shard", "4/3", "--out", text(&a)]).failed(USAGE, &["4/3"]);
    burnish(&["bake", SCENE, "--method", "reference", "--out", text(&a)]).failed(USAGE, &["prepares nothing"]);
}

pub fn a_picture_is_lit_by_what_was_baked() {
    let folder = scratch_folder("baked");
    let [one, two, mean] = ["one.bake", "two.bake", "mean.bake"].map(|name| folder.join(name));
    bake(&one, &[]);
    bake(&two, &["--seed", "1"]);
    burnish(&["merge", "--average", text(&one), text(&two), "--out", text(&mean)]).succeeded();
    burnish(&["merge", "--average", text(&one), text(&one), "--out", text(&mean)]).failed(INPUT, &["seed 0"]);
    let render = |scene: &str, bake: &Path, out: &str, more: &[&str]| {
        let out = folder.join(out);
        let args = ["render", scene, "--method", "radiance-map", "--prepared", text(bake), "--out", text(&out)];
        let told = burnish(&[&args[..], &["--size", "24x18", "--samples", "2", "--processor"], more].concat());
        (told, out)
    };
    let picture = |bake: &Path, out: &str| {
        let (told, out) = render(SCENE, bake, out, &[]);
        assert_eq!(told.succeeded().err, "");
        fs::read(out).expect("a picture")
    };
    let (first, second, third) = (picture(&one, "a.exr"), picture(&two, "b.exr"), picture(&mean, "c.exr"));
    assert!(first != second && first != third && second != third);
    assert!(picture(&one, "d.exr") == first);
    // Other materials are what it is for; another room is not.
    let (told, _) = render(SCENE, &one, "e.exr", &["--metal", "Cu"]);
    let told = told.succeeded().err;
    assert!(told.contains("one.bake") && told.contains("materials"), "{told}");
    let (told, _) = render("gallery:ring", &one, "f.exr", &[]);
    told.failed(INPUT, &["one.bake", "geometry"]);
    let told = burnish(&["render", SCENE, "--method", "impostor", "--prepared", text(&one), "--out", "x.exr"]);
    told.failed(INPUT, &["radiance-map, not impostor"]);
}

pub fn what_the_parts_of_a_frame_cost_is_told() {
    let bake_file = scratch_folder("map-times").join("room.bake");
    bake(&bake_file, &[]);
    let times = |scene: &str| {
        let args =
            ["map-times", scene, "--prepared", text(&bake_file), "--size", "32x24", "--processor", "--rounds", "1"];
        burnish(&[&args[..], &["--json"]].concat())
    };
    let told = times(SCENE).succeeded();
    assert_eq!(told.err, "");
    let rows: Value = serde_json::from_str(&told.out).expect("JSON");
    let [row] = rows.as_array().expect("rows").as_slice() else { panic!("{rows}") };
    let number = |key: &str| row[key].as_f64().expect("a number");
    assert!(number("frame_ms") > 0.0 && row["device"].as_str().is_some_and(|device| device.contains("processor")));
    let parts = ["query", "filter", "shading", "rest"].map(number);
    assert!((parts.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{rows}");
    // Of other geometry.
    times("gallery:ring").failed(INPUT, &["room.bake", "geometry"]);
}
