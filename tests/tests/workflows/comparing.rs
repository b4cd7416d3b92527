//! Pictures that are compared.

use burnish_core::color::tone::ToneMap;
use burnish_core::file::{read_picture, write_exr, write_png};
use burnish_core::picture::Picture;
use burnish_tests::scratch_folder;
use glam::Vec4;

use super::{DIFFERENCE, INPUT, burnish, text};

/// A grey ramp with a little blue, 64 by 48.
pub fn ramp() -> Picture {
    Picture::from_fn(64, 48, |x, y| Vec4::new(x as f32 / 63.0, 0.5, y as f32 / 47.0, 1.0))
}

pub fn a_picture_equals_itself() {
    let folder = scratch_folder("equal");
    let (png, exr) = (folder.join("a.png"), folder.join("a.exr"));
    write_png(&ramp(), &png, ToneMap::None, 0.0).expect("a writable folder");
    write_exr(&ramp(), &exr).expect("a writable folder");
    for file in [&png, &exr] {
        let result = burnish(&["compare", text(file), text(file), "--threshold", "0", "--json"]).json();
        assert_eq!((result["flip"].as_f64(), result["relmse"].as_f64()), (Some(0.0), Some(0.0)));
    }
}

pub fn a_difference_over_the_threshold() {
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

pub fn incomparable_pictures() {
    let folder = scratch_folder("incomparable");
    let (exr, png, small) = (folder.join("a.exr"), folder.join("a.png"), folder.join("small.exr"));
    write_exr(&ramp(), &exr).expect("a writable folder");
    write_png(&ramp(), &png, ToneMap::None, 0.0).expect("a writable folder");
    write_exr(&Picture::filled(3, 2, Vec4::ONE), &small).expect("a writable folder");
    burnish(&["compare", text(&small), text(&exr)]).failed(INPUT, &["small.exr", "3 x 2", "64 x 48"]);
    burnish(&["compare", text(&png), text(&exr)]).failed(INPUT, &["a.png", "a.exr"]);
}
