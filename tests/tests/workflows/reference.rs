//! `render --method reference`: pictures, checkpoints and how they end.

use std::fs;
use std::path::{Path, PathBuf};

use burnish_core::document::Document;
use burnish_core::file::{Container, read_picture};
use burnish_core::param::ParamValue;
use burnish_core::reference::checkpoint::KIND;
use burnish_tests::scratch_folder;

use super::documents::document;
use super::rendering::grey_environment;
use super::{INPUT, Outcome, RESOURCES, USAGE, burnish, text};

/// Traces the workbench at a size of no whole tiles; `more` arguments come last.
fn trace(out: &Path, more: &[&str]) -> Outcome {
    let mut args = vec!["render", "--method", "reference", "--out", text(out)];
    for (option, value) in [("--size", "37x21"), ("--bounces", "3")] {
        if !more.contains(&option) {
            args.extend([option, value]);
        }
    }
    args.extend(more);
    burnish(&args)
}

/// An environment that is quick to prepare.
fn sky(folder: &Path) -> String {
    text(&grey_environment(folder)).into()
}

fn bytes(file: &Path) -> Vec<u8> {
    fs::read(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()))
}

pub fn threads_do_not_change_a_file() {
    let folder = scratch_folder("threads");
    let sky = sky(&folder);
    let render = |name: &str, more: &[&str]| {
        let file = folder.join(name);
        trace(&file, &[&["--samples", "6", "--env", &sky], more].concat()).succeeded();
        bytes(&file)
    };
    let one = render("1.exr", &["--threads", "1"]);
    assert!(render("2.exr", &["--threads", "2"]) == one);
    assert!(render("7.exr", &["--threads", "7"]) == one);
    assert!(render("all.exr", &[]) == one);
    assert!(render("seed.exr", &["--seed", "1"]) != one);
    assert!(render("bounces.exr", &["--bounces", "1", "--set", "bounces=2"]) != one, "--bounces counts");
}

/// An early end and a continuation, at every count; killing the process itself is a test of the program.
pub fn a_picture_that_goes_on_is_the_uninterrupted_one() {
    let folder = scratch_folder("resume");
    let sky = sky(&folder);
    let (whole, file, checkpoint) = (folder.join("whole.exr"), folder.join("x.exr"), folder.join("x.checkpoint"));
    trace(&whole, &["--samples", "6", "--env", &sky]).succeeded();
    for cut in ["1", "2", "3", "5", "6"] {
        let _ = fs::remove_file(&checkpoint);
        let keep = ["--env", &sky, "--checkpoint", text(&checkpoint), "--samples"];
        trace(&file, &[&keep[..], &[cut]].concat()).succeeded();
        let more = trace(&file, &[&keep[..], &["6", "--threads", "3"]].concat()).succeeded();
        assert!(more.err.contains(&format!("going on from {} at {cut} samples", checkpoint.display())), "{}", more.err);
        assert!(bytes(&file) == bytes(&whole), "cut at {cut}");
    }
    let asked = trace(&file, &["--env", &sky, "--checkpoint", text(&checkpoint), "--samples", "4"]);
    asked.failed(USAGE, &["x.checkpoint", "holds 6 samples, more than --samples 4", "ask for 6 or more"]);
}

pub fn a_checkpoint_that_does_not_fit_is_refused() {
    let folder = scratch_folder("checkpoint");
    let sky = sky(&folder);
    let (file, checkpoint) = (folder.join("x.exr"), folder.join("x.checkpoint"));
    let keep = |more: &[&str]| {
        let kept = ["--env", &sky, "--checkpoint", text(&checkpoint), "--samples", "2"];
        trace(&file, &[&kept[..], more].concat())
    };
    keep(&[]).succeeded();
    let made = bytes(&checkpoint);
    for (more, words) in [
        (&["--seed", "3"][..], ["the seed (0 there, 3 here)", "remove it"]),
        (&["--size", "21x37"], ["the size (37x21 there, 21x37 here)", "remove it"]),
        (&["--camera", "close"], ["the camera;", "remove it"]),
        (&["--metal", "Au"], ["the materials;", "remove it"]),
        (&["--bounces", "2"], ["the bounces (3 there, 2 here);", "remove it"]),
        (&["--set", "masking=separable"], ["the masking (correlated there, separable here)", "remove it"]),
        (&["--set", "spectral=on"], ["the wavelengths (off there, on here);", "remove it"]),
        (&["gallery:workbench?room=none"], ["the geometry", "remove it"]),
    ] {
        keep(more).failed(INPUT, &[&["x.checkpoint", "another picture"][..], &words].concat());
    }
    for (damage, word) in [
        (made[..made.len() - 1].to_vec(), "not those that it announces"),
        ([&made[..made.len() - 1], &[!made[made.len() - 1]]].concat(), "is damaged"),
        (b"notes".to_vec(), "no file of numbers"),
        (Vec::new(), "no file of numbers"),
    ] {
        fs::write(&checkpoint, damage).expect("a writable folder");
        keep(&[]).failed(INPUT, &["x.checkpoint", word]);
    }
    let absent = folder.join("absent/x.checkpoint");
    trace(&file, &["--checkpoint", text(&absent)]).failed(RESOURCES, &["absent", "another --checkpoint"]);
    trace(&file, &["--checkpoint", text(&file)]).failed(USAGE, &["the same file"]);
    trace(&file, &["--checkpoint", text(&folder)]).failed(INPUT, &["not a regular file"]);
}

pub fn a_checkpoint_that_cannot_be_written_costs_no_picture() {
    let folder = scratch_folder("unwritable-checkpoint");
    let (sky, file) = (sky(&folder), folder.join("x.exr"));
    // Longer than file systems take names.
    let checkpoint = folder.join("x".repeat(300));
    let outcome = trace(&file, &["--env", &sky, "--samples", "2", "--checkpoint", text(&checkpoint)]);
    assert_eq!(outcome.exit, RESOURCES, "{}", outcome.err);
    let lines: Vec<&str> = outcome.err.lines().collect();
    // After the first pass, and at the end.
    let [first, .., last] = lines[..] else { panic!("{}", outcome.err) };
    assert!(first.contains("cannot be written") && first.ends_with("the picture goes on without"), "{first}");
    assert!(last.contains("cannot be written") && outcome.out.contains("wrote"), "{last} {}", outcome.out);
    assert!(read_picture(&file).is_ok());
}

pub fn every_end_ends_a_picture() {
    let folder = scratch_folder("ends");
    let sky = sky(&folder);
    let (file, checkpoint) = (folder.join("x.exr"), folder.join("x.checkpoint"));
    let held = |more: &[&str]| -> (u64, String) {
        let _ = fs::remove_file(&checkpoint);
        let kept = ["--env", &sky, "--checkpoint", text(&checkpoint)];
        let out = trace(&file, &[&kept[..], more].concat()).succeeded().out;
        let container = Container::read(&checkpoint, KIND, 1 << 20).expect("a checkpoint");
        let samples = container.header["samples"].as_u64().expect("a count");
        assert!(out.contains(&format!("37x21, {samples} samples, error ")) && out.contains(" Mrays/s"), "{out}");
        (samples, out)
    };
    // Reached at the first count that is judged, and out of reach.
    assert_eq!(held(&["--error", "100"]).0, 16);
    assert_eq!(held(&["--error", "0.00001", "--samples", "18"]).0, 18);
    let (least, _) = held(&["--time", "0"]);
    assert_eq!(least, 1, "one sample at least");
    let (count, out) = held(&["--error", "0.2", "--samples", "4096"]);
    let error: f64 = out
        .split("error ")
        .nth(1)
        .and_then(|rest| rest.split(',').next())
        .expect("an error")
        .parse()
        .expect("a number");
    assert!(count < 4096 && error <= 0.2 && (count == 16 || error > 0.1), "{out}");
    assert_eq!(held(&["--error", "0.2", "--threads", "1"]).0, count, "the same picture whatever the threads");
}

pub fn the_reference_writes_png_and_layers_and_reads_settings() {
    let folder = scratch_folder("reference-files");
    let sky = sky(&folder);
    let (exr, png) = (folder.join("x.exr"), folder.join("x.png"));
    let clamped = trace(&exr, &["--samples", "2", "--env", &sky, "--set", "clamp=0.01"]).succeeded();
    assert!(clamped.out.contains("% of the light clamped"), "{}", clamped.out);
    let plain = trace(&exr, &["--samples", "2", "--env", &sky]).succeeded();
    assert!(!plain.out.contains("clamped") && plain.err.is_empty(), "{} {}", plain.out, plain.err);
    trace(&png, &["--samples", "2", "--env", &sky, "--tone", "none", "--exposure", "-1"]).succeeded();
    let (radiance, shown) = (read_picture(&exr).expect("an exr").0, read_picture(&png).expect("a png").0);
    for (radiance, shown) in radiance.texels.iter().zip(&shown.texels) {
        let expected = (0.5 * radiance).truncate().min(glam::Vec3::ONE);
        assert!((expected - shown.truncate()).abs().max_element() < 0.01, "{expected} shown as {shown}");
    }
    let file = bytes(&exr);
    for name in ["variance.R", "N.Z", "albedo.G", "id.instance", "id.material", "burnish.samples", "burnish.error"] {
        let found = file.windows(name.len() + 1).any(|w| w == [name.as_bytes(), &[0]].concat());
        assert!(found, "{name}");
    }
}

pub fn a_document_is_traced_with_its_settings_and_spectral_metals() {
    let folder = scratch_folder("reference-document");
    let (mut document, path) = document(&folder);
    let render = |name: &str, path: &Path, more: &[&str]| {
        let file = folder.join(name);
        trace(&file, &[&[text(path), "--samples", "4"], more].concat()).succeeded();
        bytes(&file)
    };
    let spectral = render("a.exr", &path, &[]);
    assert!(render("b.exr", &path, &["--set", "fresnel=spectral"]) == spectral);
    assert!(render("c.exr", &path, &["--set", "fresnel=schlick"]) != spectral);
    assert!(render("s.exr", &path, &["--set", "spectral=on"]) != spectral);
    let separable = render("d.exr", &path, &["--set", "masking=separable"]);
    assert!(separable != spectral);

    let save = |document: &Document, name: &str| -> PathBuf {
        let path = folder.join(name);
        document.save(&path).expect("a writable folder");
        path
    };
    document.set_lighting("masking", ParamValue::Choice(1)).expect("a choice");
    let masked = save(&document, "masked.burnish");
    assert!(render("e.exr", &masked, &[]) == separable, "masking of the document counts");
    assert!(render("f.exr", &masked, &["--set", "masking=correlated"]) == spectral);
    document.set_fresnel(0, Some("schlick"));
    let live_form = save(&document, "schlick.burnish");
    assert!(render("g.exr", &live_form, &[]) == separable, "forms of the live view do not");
}

pub fn options_of_the_other_method_are_refused() {
    let reference = ["render", "--method", "reference", "--out", "x.exr"];
    let classical = ["render", "--out", "x.exr"];
    let refused = |base: &[&str], more: &[&str], words: &[&str]| burnish(&[base, more].concat()).failed(USAGE, words);
    refused(&reference, &["--spp-jitter", "4"], &["--spp-jitter belongs to --method classical"]);
    for option in ["--samples", "--time", "--error", "--seed", "--bounces", "--checkpoint", "--threads"] {
        let words = format!("{option} belongs to --method reference");
        refused(&classical, &[option, "2"], &[&words]);
    }
    refused(&reference, &["--set", "samples=3"], &["no setting `samples`", "bounces, clamp"]);
    refused(&classical, &["--set", "bounces=3"], &["no setting `bounces`", "masking"]);
    refused(&reference, &["--bounces", "2000"], &["--bounces 2000", "0 to 1024"]);
    refused(&reference, &["--samples", "0"], &["--samples", "1..=16777216"]);
    refused(&reference, &["--error", "0"], &["--error", "0.000001"]);
    refused(&reference, &["--time", "NaN"], &["--time", "0 to"]);
    refused(&reference, &["--threads", "0"], &["--threads"]);
    refused(&reference, &["--seed", "4294967296"], &["--seed"]);
    refused(
        &["render", "--method", "magic", "--out", "x.exr"],
        &[],
        &["magic", "classical, impostor, area-cube, radiance-map, reference"],
    );
    let help = burnish(&["render", "--help"]).succeeded().out;
    for words in ["--checkpoint", "--error", "With --method reference", "bounces: a whole number", "default: 64"] {
        assert!(help.contains(words), "{words} is missing in: {help}");
    }
}
