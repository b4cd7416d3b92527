//! Probes: added, edited, placed by themselves, shown in the picture, warned of; what searches do, shown instead of light.

use std::time::Duration;

use burnish::window::Pane;
use burnish_core::document::ProbeEntry;
use burnish_core::param::ParamValue;
use burnish_core::scene::ProbeSource;
use burnish_tests::trial;
use eframe::egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable;
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a_probe_is_added_edited_renamed_and_undone", &[], edited),
        trial("probes_are_placed_by_themselves", &[], placed),
        trial("a_probe_inside_of_a_wall_is_warned_of", &[], warned),
        trial("what_a_search_does_is_chosen_and_prepares_nothing_anew", &[], shown),
        trial("an_object_that_is_dragged_gets_a_draft_and_then_the_whole", &[], dragged),
    ]
}

/// A room under `impostor`, prepared as coarsely as it goes.
fn bench(name: &str) -> Bench {
    let mut bench = Bench::new(Setup { name, scene: Some("gallery:room"), size: [1280.0, 2600.0], drawn: false });
    bench.workbench().session_mut().edit("Lighting method", "", |document| {
        document.lighting.choose("impostor");
        for (key, value) in [("resolution", 16), ("probe-paths", 1)] {
            document.set_lighting(key, ParamValue::Integer(value)).expect("a setting");
        }
    });
    bench.workbench().show_panel(Pane::Environment);
    bench.until("it is prepared", |workbench| !workbench.is_busy());
    bench
}

fn probes(bench: &Bench) -> &[ProbeEntry] {
    &bench.session().document().probes
}

fn last_step(bench: &Bench) -> Option<&str> {
    bench.session().history().past().last().map(|step| step.label.as_str())
}

fn edited() {
    let mut bench = bench("probes");
    bench.window.get_by_label("One probe, in the middle of the subject");
    bench.click("Add probe");
    assert_eq!(probes(&bench).len(), 1);
    bench.click_role(Role::CheckBox, "Own position");
    let middle = bench.session().subject_bounds().center();
    assert_eq!(probes(&bench)[0].place(), Some(middle), "it stays where it was");
    assert_eq!(last_step(&bench), Some("Own position of probe"));
    bench.click_role(Role::CheckBox, "In a box");
    bench.click_role(Role::CheckBox, "Own quality");
    bench.slide("Probe resolution", 32.0);
    assert_eq!((probes(&bench)[0].resolution, probes(&bench)[0].extent), (Some(32), Some([1.0; 3])));
    bench.click("Duplicate probe");
    assert_eq!(probes(&bench).len(), 2);
    assert_eq!(bench.session().scene().probes.len(), 2, "the scene has them");
    bench.click("Delete probe");
    bench.click_role(Role::ListItem, "Probe probe");
    bench.workbench().session_mut().selection.objects = vec!["ball".into()];
    bench.window.run_steps(2);
    bench.click("Serve selected");
    assert_eq!(probes(&bench)[0].serves, ["ball"]);
    bench.click("Serve the subject");
    assert!(probes(&bench)[0].serves.is_empty());
    for _ in 0..20 {
        bench.keys(Modifiers::COMMAND, Key::Z);
    }
    assert!(probes(&bench).is_empty());
}

fn placed() {
    let mut bench = bench("probes-placed");
    bench.click("Place automatically");
    bench.until("they are placed", |workbench| !workbench.session().document().probes.is_empty());
    bench.window.get_by_label_contains("95 % of the rays are right to");
    let middle = bench.session().subject_bounds().center();
    let [one] = probes(&bench) else { panic!("{:?}", probes(&bench)) };
    assert!(one.place().is_some_and(|place| (place - middle).length() < 0.05), "a ball needs one: {one:?}");
    assert_eq!(last_step(&bench), Some("Place probes"));
}

fn warned() {
    let mut bench = bench("probes-warned");
    assert!(bench.window.query_all_by_label_contains("inside of an object").next().is_none());
    bench.workbench().session_mut().edit("Add probe", "", |document| {
        let name = document.add_probe(Vec::new());
        let probe = document.probe_mut(&name).expect("it was added");
        // The walls are slabs of 0.12 m.
        probe.position = Some([1.06, 0.0, 0.0]);
        probe.set_source(ProbeSource::Raster);
    });
    bench.until("it is prepared", |workbench| !workbench.is_busy());
    bench.window.get_by_label_contains("inside of an object");
    bench.window.get_by_label_contains("notice");
}

fn shown() {
    let mut bench = bench("probes-shown");
    let before = bench.session().revision;
    for show in ["lookups", "ratio", "error", "light"] {
        bench.click_role(Role::ComboBox, "Show");
        bench.click_role(Role::Button, show);
        let text = bench.session().document().lighting.settings().text("show");
        assert_eq!(text.as_deref(), Some(show));
        bench.until("it is compared", |workbench| !workbench.is_busy());
        assert!(bench.window.query_all_by_label("draft").next().is_none());
        bench.window.get_by_label("prepared");
    }
    assert!(bench.session().revision > before);
    bench.click_role(Role::CheckBox, "Show probes");
    bench.click_role(Role::CheckBox, "Show distances");
    let marks = bench.workbench().aids_mut().probes.clone();
    assert!(marks.places && marks.distances);
}

fn dragged() {
    let mut bench = bench("probes-dragged");
    let prepared = |bench: &Bench| bench.window.query_all_by_label("prepared").next().is_some();
    assert!(prepared(&bench));
    bench.workbench().session_mut().edit("Move", "", |document| {
        document.edit_object("ball", |entry| {
            entry.transform =
                Some(burnish_core::document::TransformEntry { by: [0.1, 0.0, 0.0], ..Default::default() });
        });
    });
    bench.until_shown("draft");
    std::thread::sleep(Duration::from_millis(1));
    bench.until("the whole is prepared", |workbench| !workbench.is_busy());
    assert!(prepared(&bench));
    // Its own material is not seen by the probe.
    bench.workbench().session_mut().edit("Roughness", "", |document| {
        document.set_value(0, "roughness", ParamValue::Number(0.5)).expect("a factor");
    });
    bench.window.run_steps(2);
    bench.until("it is compared", |workbench| !workbench.is_busy());
    assert!(prepared(&bench) && bench.window.query_all_by_label("draft").next().is_none());
}
