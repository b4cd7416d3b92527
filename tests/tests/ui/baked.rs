//! Light that was baked: what an edit leaves of it, and what needs no other bake.

use std::time::{Duration, Instant};

use burnish::window::Pane;
use burnish_core::param::ParamValue;
use burnish_tests::trial;
use egui_kittest::kittest::Queryable;
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a_bake_outlives_an_edit_and_the_size_of_stale_light_is_told", &[], outlived),
        trial("lights_of_a_bake_are_scaled_without_another", &[], scaled),
    ]
}

/// A room under `radiance-map`, baked as coarsely as makes sense.
fn bench(name: &str) -> Bench {
    let mut bench = Bench::new(Setup { name, scene: Some("gallery:room"), size: [1280.0, 2600.0], drawn: false });
    bench.workbench().session_mut().edit("Lighting method", "", |document| {
        document.lighting.choose("radiance-map");
        for (key, value) in [("points", 800), ("directions", 16), ("paths", 1)] {
            document.set_lighting(key, ParamValue::Integer(value)).expect("a setting");
        }
    });
    bench.workbench().show_panel(Pane::Environment);
    bench.until("it is baked", |workbench| !workbench.is_busy());
    bench.window.get_by_label("prepared");
    bench
}

fn is_shown(bench: &Bench, text: &str) -> bool {
    bench.window.query_all_by_label_contains(text).next().is_some()
}

fn outlived() {
    let mut bench = bench("baked-outlived");
    bench.workbench().session_mut().edit("Roughness", "", |document| {
        document.set_value(0, "roughness", ParamValue::Number(0.7)).expect("a factor");
    });
    let start = Instant::now();
    while !is_shown(&bench, "stale, light off by") {
        assert!(start.elapsed() < Duration::from_secs(60) && !is_shown(&bench, "draft"));
        std::thread::sleep(Duration::from_millis(5));
        bench.window.run_steps(1);
    }
    bench.until("another is baked", |workbench| !workbench.is_busy());
    bench.window.get_by_label("prepared");
    // What moves is drafted.
    bench.workbench().session_mut().edit("Move", "", |document| {
        document.edit_object("ball", |entry| {
            entry.transform =
                Some(burnish_core::document::TransformEntry { by: [0.1, 0.0, 0.0], ..Default::default() });
        });
    });
    bench.until_shown("draft");
}

fn scaled() {
    let mut bench = bench("baked-scaled");
    bench.slide("Glow", 2.5);
    assert_eq!(bench.session().document().lighting.settings().text("glow-strength").as_deref(), Some("2.5"));
    for _ in 0..20 {
        assert!(!is_shown(&bench, "stale") && !is_shown(&bench, "draft"));
        std::thread::sleep(Duration::from_millis(5));
        bench.window.run_steps(1);
    }
    bench.until("it is compared", |workbench| !workbench.is_busy());
    bench.window.get_by_label("prepared");
}
