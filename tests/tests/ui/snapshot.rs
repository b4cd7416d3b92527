//! `burnish snapshot`: the same bytes each time, and exit codes that tell a difference.

use std::ffi::OsString;
use std::path::Path;

use burnish_core::document::{DEFAULT_SCENE, open};
use burnish_core::param::ParamValue;
use burnish_tests::{Need, scratch_folder, trial};
use libtest_mimic::Trial;

pub fn trials() -> Vec<Trial> {
    let gpu: &[Need] = &[Need::Gpu];
    vec![
        trial("a_snapshot_compares_equal_with_itself_and_tells_another_material", gpu, a_changed_material_is_told),
        trial("two_snapshots_of_the_window_have_the_same_bytes", gpu, two_runs_are_equal),
        trial("snapshots_of_nothing_are_refused_in_words", &[], refused),
    ]
}

fn burnish(args: &[&str]) -> (u8, String, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let args = std::iter::once("snapshot").chain(args.iter().copied()).map(OsString::from);
    let code = burnish::run(args, &mut out, &mut err);
    (code, String::from_utf8_lossy(&out).into(), String::from_utf8_lossy(&err).into())
}

/// A document that is quick to draw: a tiny sky, few samples.
fn document(path: &Path, roughness: f64) {
    let sky = path.with_extension("hdr");
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n".to_vec();
    bytes.extend([128, 128, 160, 129].repeat(16 * 8));
    std::fs::write(&sky, bytes).expect("the folder can be written");
    let mut document = open(DEFAULT_SCENE).expect("it is built in").document;
    document.environment.source = Some(sky.to_string_lossy().into_owned());
    document.set_lighting("samples", ParamValue::Integer(8)).expect("it is a setting");
    document.set_value(0, "roughness", ParamValue::Number(roughness)).expect("it is a factor");
    document.save(path).expect("the folder can be written");
}

fn a_changed_material_is_told() {
    let folder = scratch_folder("snapshot-compare");
    let at = |name: &str| folder.join(name).to_string_lossy().into_owned();
    document(&folder.join("a.burnish"), 0.2);
    document(&folder.join("b.burnish"), 0.9);
    let size = ["--size", "96x64"];
    let (code, _, err) = burnish(&[&[&at("a.burnish"), "--out", &at("ref.png")], &size[..]].concat());
    assert_eq!(code, 0, "{err}");
    let compare = |document: &str| {
        burnish(&[&[&at(document), "--out", &at("shot.png"), "--compare", &at("ref.png")], &size[..]].concat())
    };
    let (code, out, err) = compare("a.burnish");
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("flip 0.000000"), "{out}");
    assert_eq!(std::fs::read(at("shot.png")).unwrap(), std::fs::read(at("ref.png")).unwrap());
    let (code, out, err) = compare("b.burnish");
    assert_eq!(code, 1, "{out}{err}");
    assert!(err.contains("shot.diff.png") && folder.join("shot.diff.png").exists(), "{err}");
}

fn two_runs_are_equal() {
    let folder = scratch_folder("snapshot-ui");
    let at = |name: &str| folder.join(name).to_string_lossy().into_owned();
    document(&folder.join("a.burnish"), 0.2);
    for name in ["one.png", "two.png"] {
        let (code, _, err) = burnish(&[&at("a.burnish"), "--ui", "--out", &at(name), "--size", "640x400"]);
        assert_eq!(code, 0, "{err}");
    }
    assert_eq!(std::fs::read(at("one.png")).unwrap(), std::fs::read(at("two.png")).unwrap());
}

fn refused() {
    let folder = scratch_folder("snapshot-refused");
    let at = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let out = at("shot.png");
    let (code, _, err) = burnish(&[&at("none.burnish"), "--out", &out]);
    assert!(code == 3 && err.contains("none.burnish"), "{code}: {err}");
    let mut gone = open(DEFAULT_SCENE).expect("it is built in").document;
    gone.scene = at("gone.glb");
    gone.save(&folder.join("gone.burnish")).expect("the folder can be written");
    let (code, _, err) = burnish(&[&at("gone.burnish"), "--out", &out]);
    assert!(code == 3 && err.contains("gone.glb") && err.contains("relink"), "{code}: {err}");
    // The reference under another name of its folder, and where the difference would go.
    let kept = at("shot.diff.png");
    std::fs::write(&kept, "kept").expect("the folder can be written");
    let detour = folder.join("inner");
    std::fs::create_dir_all(&detour).expect("the folder can be written");
    let around = detour.join("../shot.diff.png").to_string_lossy().into_owned();
    for usage in [
        &["gallery:workbench", "--out", &out, "--compare", &out][..],
        &["gallery:workbench", "--out", &out, "--compare", &kept],
        &["gallery:workbench", "--out", &out, "--compare", &around],
        &["gallery:workbench", "--out", &kept, "--compare", &around],
        &["gallery:workbench", "--ui", "--out", &at("shot.exr")],
        &["gallery:workbench", "--out", &out, "--panel", "scene"],
        &["gallery:workbench", "--ui", "--out", &out, "--panel", "nothing"],
        &["--out", &out],
    ] {
        let (code, _, err) = burnish(usage);
        assert_eq!(code, 2, "{usage:?}: {err}");
        assert_eq!(err.lines().count(), 1, "{err}");
    }
    assert_eq!(std::fs::read(&kept).unwrap(), b"kept");
}
