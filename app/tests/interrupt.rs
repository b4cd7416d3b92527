//! What only the running program shows: signals, and a kill in the middle of its work.

#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use burnish_core::file::Container;
use burnish_core::reference::checkpoint::KIND;

/// A folder for one test.
fn folder(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("burnish-interrupt-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

fn render(folder: &Path, samples: &str, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_burnish"));
    let scene = ["render", "gallery:workbench?room=none", "--method", "reference", "--size", "19x17", "--bounces", "2"];
    command.current_dir(folder).args(scene).args(["--samples", samples]).args(more);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Starts a picture that has no end worth waiting for, and waits until its checkpoint is there.
fn started(folder: &Path) -> Child {
    let mut child = render(folder, "16777216", &["--checkpoint", "x.checkpoint", "--out", "x.exr"]).spawn().unwrap();
    while !folder.join("x.checkpoint").exists() {
        let ended = child.try_wait().unwrap();
        assert_eq!(ended, None, "it ended before its checkpoint was there");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

/// Samples in the checkpoint.
fn held(folder: &Path) -> u64 {
    Container::read(&folder.join("x.checkpoint"), KIND, 1 << 20).unwrap().header["samples"].as_u64().unwrap()
}

fn succeeded(mut command: Command) -> Output {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output
}

/// Goes on from the checkpoint, traces the same without an interruption, and compares the files.
fn goes_on_as_if_nothing_had_happened(folder: &Path) {
    let samples = (held(folder) + 3).to_string();
    succeeded(render(folder, &samples, &["--checkpoint", "x.checkpoint", "--out", "x.exr"]));
    succeeded(render(folder, &samples, &["--out", "whole.exr"]));
    assert!(fs::read(folder.join("x.exr")).unwrap() == fs::read(folder.join("whole.exr")).unwrap());
}

#[test]
fn a_killed_picture_goes_on_from_its_checkpoint_with_the_same_bytes() {
    let folder = folder("kill");
    let mut child = started(&folder);
    child.kill().unwrap();
    assert_eq!(child.wait().unwrap().code(), None, "killed");
    assert!(!folder.join("x.exr").exists());
    goes_on_as_if_nothing_had_happened(&folder);
    fs::remove_dir_all(folder).unwrap();
}

fn bake(folder: &Path, out: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_burnish"));
    let settings = ["--set", "points=12000", "--set", "directions=32", "--set", "paths=4"];
    command.current_dir(folder).args(["bake", "gallery:room", "--out", out]).args(settings);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[test]
fn a_killed_bake_goes_on_with_the_same_bytes() {
    let folder = folder("bake");
    let mut child = bake(&folder, "x.bake").spawn().unwrap();
    while !folder.join("x.bake.part").exists() {
        assert_eq!(child.try_wait().unwrap(), None, "it ended before its part was there");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    assert_eq!(child.wait().unwrap().code(), None, "killed");
    assert!(!folder.join("x.bake").exists());
    let told = succeeded(bake(&folder, "x.bake"));
    assert!(String::from_utf8_lossy(&told.stderr).contains("x.bake.part: going on"));
    assert!(!folder.join("x.bake.part").exists());
    succeeded(bake(&folder, "whole.bake"));
    assert!(fs::read(folder.join("x.bake")).unwrap() == fs::read(folder.join("whole.bake")).unwrap());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_signal_ends_a_picture_in_order_with_exit_code_5() {
    let folder = folder("signal");
    for signal in ["-INT", "-TERM"] {
        for file in ["x.checkpoint", "x.exr"] {
            let _ = fs::remove_file(folder.join(file));
        }
        let child = started(&folder);
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(5), "{text}");
        assert!(text.contains(&format!("cancelled at {} samples; x.checkpoint holds them", held(&folder))), "{text}");
        assert!(output.stdout.is_empty() && !folder.join("x.exr").exists());
        goes_on_as_if_nothing_had_happened(&folder);
    }
    fs::remove_dir_all(folder).unwrap();
}
