//! The chart: records that are clicked and become sides, fields that are refused, a measurement that is ended.

use std::time::{Duration, Instant};

use burnish::window::{CompareView, Pane, Workbench};
use burnish_core::document::Side;
use burnish_core::measure::Errors;
use burnish_core::measure::bench::Record;
use burnish_core::param::ParamValue;
use burnish_tests::{Need, trial};
use eframe::egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::UVec2;
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a_chart_point_becomes_a_side_is_wiped_copied_and_undone", &[], from_point_to_wipe),
        trial("the_plan_of_a_chart_tells_what_is_wrong_where_it_is_typed", &[], plan),
        trial("a_small_chart_is_measured_and_kept", &[Need::Gpu], measured),
        trial("marks_of_a_chart_are_shown_as_they_come", &[Need::Gpu], arriving),
        trial("a_measurement_is_ended_and_the_window_does_not_wait", &[Need::Gpu], cancelled),
    ]
}

fn errors(relmse: f64) -> Errors {
    let flip = relmse.sqrt() / 4.0;
    Errors { relmse, flip, flip_p99: 3.0 * flip, bias: -0.1 * flip, difference: 1.5 * flip, worst: 20.0 * relmse }
}

/// A record as it is read from the cache; the silhouettes are the worst of it.
fn record(method: &str, samples: u32, ms: f64, relmse: f64) -> Record {
    let floor = errors(4e-5);
    Record {
        scene: "gallery:workbench".into(),
        method: method.into(),
        settings: vec![("samples".into(), samples.to_string()), ("masking".into(), "correlated".into())],
        width: 320,
        height: 180,
        prepare_secs: 0.72,
        bytes: (method == "classical").then_some(41_500_000),
        frame_secs: 1e-3 * ms,
        calibration_secs: 8.7e-3,
        frames: 60,
        compared_frames: 16,
        errors: [relmse * 0.7, relmse, relmse * 0.4].map(|relmse| Some(errors(relmse))),
        floors: [Some(floor); 3],
        truth_samples: 256,
        truth_settings: Vec::new(),
    }
}

/// What a chart of the default plan is like.
pub fn records() -> Vec<Record> {
    vec![
        record("classical", 0, 3.1, 0.0121),
        record("classical", 4, 9.4, 0.0087),
        record("classical", 16, 30.5, 0.0021),
        record("classical", 64, 118.0, 7.4e-4),
        record("classical", 256, 463.0, 6.9e-4),
        record("reference", 1, 74.0, 0.31),
        record("reference", 4, 290.0, 0.08),
        record("reference", 64, 4600.0, 3.1e-5),
    ]
}

fn bench(name: &str) -> Bench {
    let name = format!("chart-{name}");
    let mut bench =
        Bench::new(Setup { name: &name, scene: Some("gallery:workbench"), size: [1280.0, 800.0], drawn: false });
    bench.workbench().show_panel(Pane::Chart);
    bench.window.run_steps(3);
    bench
}

fn view(bench: &Bench) -> Option<CompareView> {
    bench.window.state().as_ref().and_then(|workbench| workbench.compare().view())
}

fn labels(bench: &Bench) -> Vec<String> {
    bench.session().history().past().iter().map(|step| step.label.clone()).collect()
}

fn samples(bench: &Bench, side: Side) -> Option<ParamValue> {
    bench.session().document().of_side(side).lighting.settings().get("samples")
}

fn from_point_to_wipe() {
    let mut bench = bench("wipe");
    bench.workbench().chart_mut().set_records(records());
    bench.window.run_steps(3);
    bench.click("classical samples=0: 3.1 ms, relMSE 0.0121");
    bench.click("As A");
    assert_eq!(view(&bench), None, "there is no other side yet");
    bench.click("classical samples=64: 118 ms, relMSE 7.4e-4");
    bench.click("As B");
    assert_eq!(labels(&bench), ["Chart point as A", "Chart point as B"]);
    assert_eq!(view(&bench), Some(CompareView::Wipe));
    bench.window.get_by_label("Wipe line");
    bench.window.get_by_label("A: live");
    let stored = Side::ALL.map(|side| samples(&bench, side));
    assert_eq!(stored, [Some(ParamValue::Integer(0)), Some(ParamValue::Integer(64))]);

    bench.workbench().show_panel(Pane::Compare);
    bench.window.run_steps(3);
    bench.click("Copy Samples to B");
    assert_eq!(samples(&bench, Side::B), Some(ParamValue::Integer(0)));
    bench.window.get_by_label("No differences");
    bench.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(samples(&bench, Side::B), Some(ParamValue::Integer(64)), "undo restores");

    // A path-traced point with Shift is side A; the view of two sides stays.
    bench.workbench().show_panel(Pane::Chart);
    bench.window.run_steps(3);
    bench.window.get_by_label("reference samples=4: 290 ms, relMSE 0.08").click_modifiers(Modifiers::SHIFT);
    bench.window.run_steps(3);
    assert!(bench.session().document().compare.a.is_reference());
    assert_eq!(view(&bench), Some(CompareView::Wipe));
    for _ in 0..3 {
        bench.keys(Modifiers::COMMAND, Key::Z);
    }
    assert!(bench.session().document().snapshots.is_empty() && !bench.session().is_dirty());
}

fn plan() {
    let mut bench = bench("plan");
    let measure =
        |bench: &Bench| !bench.window.get_by_role_and_label(Role::Button, "Measure").accesskit_node().is_disabled();
    bench.window.get_by_label("15 measurements");
    bench.click_role(Role::CheckBox, "impostor");
    bench.window.get_by_label("10 measurements");
    bench.click_role(Role::CheckBox, "area-cube");
    bench.window.get_by_label("9 measurements");
    bench.click_role(Role::CheckBox, "radiance-map");
    bench.window.get_by_label("8 measurements");
    bench.window.get_by_role_and_label(Role::TextInput, "Values of classical 1").focus();
    bench.window.run_steps(2);
    bench.keys(Modifiers::COMMAND, Key::A);
    bench.window.get_by_role_and_label(Role::TextInput, "Values of classical 1").type_text("samples=0,2000");
    bench.window.run_steps(3);
    assert!(bench.window.query_by_label_contains("0 to 1024").is_some() && !measure(&bench));
    bench.click_role(Role::CheckBox, "classical");
    bench.window.get_by_label("3 measurements");
    assert!(measure(&bench));
    bench.click("Vary another setting of reference");
    bench.window.get_by_role_and_label(Role::TextInput, "Values of reference 2").focus();
    bench.window.run_steps(2);
    bench.window.get_by_role_and_label(Role::TextInput, "Values of reference 2").type_text("bounces=1,2");
    bench.window.run_steps(3);
    bench.window.get_by_label("6 measurements");
    bench.click_role(Role::CheckBox, "reference");
    bench.window.get_by_label("nothing to measure");
    assert!(!measure(&bench));
}

/// Few pixels, few paths, few candidates: a debug build measures them.
fn small(workbench: &mut Workbench) {
    let plan = &mut workbench.chart_mut().plan;
    (plan.size, plan.samples) = (UVec2::new(32, 18), 4);
    for chosen in &mut plan.methods {
        let (on, sweep) = match chosen.info().id.0 {
            "classical" => (true, "samples=2"),
            "reference" => (true, "samples=1"),
            _ => (false, ""),
        };
        (chosen.on, chosen.sweeps) = (on, vec![sweep.into()]);
    }
}

fn measured() {
    let mut bench = bench("measured");
    small(bench.workbench());
    bench.window.run_steps(2);
    bench.click_role(Role::Button, "Measure");
    bench.window.get_by_label("Cancel");
    bench.until("it is measured", |workbench| !workbench.chart().is_busy());
    let first = bench.workbench().chart().records();
    assert_eq!(bench.workbench().chart().fault(), None);
    assert_eq!(first.len(), 2);
    assert!(bench.window.query_by_label_contains("classical: ").is_some());
    bench.click_role(Role::Button, "Measure");
    bench.until("it is read", |workbench| !workbench.chart().is_busy());
    assert_eq!(bench.workbench().chart().records(), first, "times and all: it was kept");
    assert!(bench.session().history().past().is_empty(), "measuring is no edit");
}

fn arriving() {
    let mut bench = bench("arriving");
    small(bench.workbench());
    let of_reference = |workbench: &mut Workbench, on: bool, sweep: &str| {
        let mut methods = workbench.chart_mut().plan.methods.iter_mut();
        let chosen = methods.find(|chosen| chosen.info().id.0 == "reference").expect("it is in the plan");
        (chosen.on, chosen.sweeps) = (on, vec![sweep.into()]);
    };
    of_reference(bench.workbench(), false, "");
    bench.window.run_steps(2);
    bench.click_role(Role::Button, "Measure");
    bench.until("it is measured", |workbench| !workbench.chart().is_busy());
    bench.workbench().chart_mut().set_records(Vec::new());

    // The first is kept, the second takes longer than anyone waits.
    of_reference(bench.workbench(), true, "samples=1048576");
    bench.window.run_steps(2);
    bench.click_role(Role::Button, "Measure");
    bench.until("a record arrives", |workbench| !workbench.chart().records().is_empty());
    bench.window.run_steps(2);
    assert!(bench.workbench().chart().is_busy(), "the other is measured still");
    assert_eq!(bench.workbench().chart().records().len(), 1);
    bench.window.get_by_label_contains("classical: ");
    assert!(bench.window.query_by_label_contains("reference: ").is_none());
    bench.window.get_by_label("Cancel");
    bench.click_role(Role::Button, "Cancel");
    bench.until("it has ended", |workbench| !workbench.chart().is_busy());
    assert_eq!(bench.workbench().chart().records().len(), 1, "what was measured stays");
}

fn cancelled() {
    let mut bench = bench("cancelled");
    bench.workbench().chart_mut().plan.samples = 1 << 20;
    bench.click_role(Role::Button, "Measure");
    bench.until("it traces", |w| w.chart().progress().is_some_and(|words| words.contains("tracing")));
    let start = Instant::now();
    bench.click_role(Role::Button, "Cancel");
    assert!(bench.workbench().chart().is_ending() || !bench.workbench().chart().is_busy());
    bench.until("it has ended", |workbench| !workbench.chart().is_busy());
    let secs = start.elapsed();
    assert!(secs < Duration::from_secs(5), "{secs:?}");
    assert!(bench.workbench().chart().records().is_empty() && bench.workbench().chart().fault().is_none());
}
