//! Two pictures: sides stored, wiped, listed and copied; the error heat map over the viewport.

use burnish::window::{Command, Compare, CompareView, Pane, Request};
use burnish_core::document::Side;
use burnish_tests::trial;
use eframe::egui::{Key, Modifiers, Role, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

pub fn trials() -> Vec<Trial> {
    vec![
        trial("two_sides_are_stored_wiped_copied_and_undone", &[], wiped),
        trial("every_view_of_two_pictures_is_reached_by_key_label_and_menu", &[], views),
        trial("snapshots_are_taken_renamed_restored_and_deleted", &[], snapshots),
        trial("a_click_picks_in_either_half", &[], picked),
        trial("the_error_of_the_live_picture_is_mapped_and_dropped_when_it_changes", &[], mapped),
        trial("a_button_over_the_picture_hears_a_click_of_several_frames", &[], slow_click),
        trial("both_sides_can_be_traced", &[], traced),
        trial("a_side_that_the_processor_draws_is_shown_and_compared", &[], by_processor),
    ]
}

fn bench(name: &str) -> Bench {
    let name = format!("compare-{name}");
    Bench::new(Setup { name: &name, scene: Some("gallery:workbench"), size: [1280.0, 800.0], drawn: false })
}

/// Small: a debug build traces it.
fn small(name: &str) -> Bench {
    let name = format!("compare-{name}");
    Bench::new(Setup { name: &name, scene: Some("gallery:workbench"), size: [560.0, 320.0], drawn: false })
}

fn compare(bench: &Bench) -> &Compare {
    bench.window.state().as_ref().expect("it was drawn").compare()
}

fn labels(bench: &Bench) -> Vec<String> {
    bench.session().history().past().iter().map(|step| step.label.clone()).collect()
}

fn roughness(bench: &Bench) -> f32 {
    bench.session().scene().materials[0].roughness
}

fn wiped() {
    let mut bench = bench("wiped");
    let first = roughness(&bench);
    bench.keys(Modifiers::COMMAND, Key::Num1);
    bench.slide("Roughness", 0.8);
    bench.keys(Modifiers::COMMAND, Key::Num2);
    assert_eq!(labels(&bench), ["Store as A", "Roughness", "Store as B"]);
    let sides = Side::ALL.map(|side| bench.session().document().of_side(side));
    assert!(sides[0].materials[0].value("roughness").is_none() && sides[1].materials[0].value("roughness").is_some());

    bench.keys(Modifiers::NONE, Key::W);
    assert_eq!(compare(&bench).view(), Some(CompareView::Wipe));
    let line = bench.window.get_by_label("Wipe line");
    assert_eq!(line.accesskit_node().role(), Role::Slider);
    let middle = line.rect().center();
    let camera = bench.session().document().view.camera.clone();
    bench.drag(middle, middle - vec2(120.0, 0.0));
    assert!(compare(&bench).wipe < 0.45, "{}", compare(&bench).wipe);
    let moved = bench.window.get_by_label("Wipe line").rect().center();
    assert!((moved.x - middle.x + 120.0).abs() < 2.0, "{moved:?}");
    assert_eq!(bench.session().document().view.camera, camera, "the line moved, not the camera");
    bench.window.get_by_label("A: live");
    bench.window.get_by_label("B: live");

    bench.workbench().show_panel(Pane::Compare);
    bench.window.run_steps(3);
    bench.click("Copy Roughness to A");
    assert!(bench.window.query_by_label("Copy Roughness to A").is_none(), "they are equal now");
    bench.window.get_by_label("No differences");
    assert_eq!(labels(&bench).last().map(String::as_str), Some("Copy Roughness to A"));
    bench.keys(Modifiers::COMMAND, Key::Z);
    bench.click("Copy Roughness to B");
    let b = bench.session().document().of_side(Side::B);
    assert!(b.materials[0].value("roughness").is_none());
    assert_eq!(roughness(&bench), 0.8, "the document is no side");
    for _ in 0..4 {
        bench.keys(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(roughness(&bench), first);
    assert!(bench.session().document().snapshots.is_empty() && !bench.session().is_dirty());
    assert_eq!(compare(&bench).view(), Some(CompareView::Wipe), "how it is looked at is no edit");
}

fn views() {
    let mut bench = bench("views");
    let keys = [Key::W, Key::S, Key::D, Key::E];
    for (view, key) in CompareView::ALL.into_iter().zip(keys) {
        bench.keys(Modifiers::NONE, key);
        assert_eq!(compare(&bench).view(), Some(view));
        bench.keys(Modifiers::NONE, key);
        assert_eq!(compare(&bench).view(), None, "again: one picture");
    }
    bench.click_role(Role::RadioButton, "A | B");
    assert_eq!(compare(&bench).view(), Some(CompareView::Difference), "the last of two sides");
    for (label, view) in [("Side by side", CompareView::SideBySide), ("Wipe", CompareView::Wipe)] {
        bench.click_role(Role::RadioButton, label);
        assert_eq!(compare(&bench).view(), Some(view));
    }
    bench.click_role(Role::RadioButton, "Live");
    assert_eq!(compare(&bench).view(), None);
    bench.menu("Compare", "Error heat map");
    assert_eq!(compare(&bench).view(), Some(CompareView::Error));
    bench.click_role(Role::RadioButton, "Reference");
    let reference = |bench: &Bench| bench.window.state().as_ref().is_some_and(|w| w.reference().is_on());
    assert!(compare(&bench).view().is_none() && reference(&bench));
    bench.keys(Modifiers::NONE, Key::W);
    assert!(!reference(&bench), "one of them is shown");
    bench.keys(Modifiers::NONE, Key::W);
    bench.until("nothing is traced for nobody", |w| !w.reference().is_tracing());
    assert!(bench.session().history().past().is_empty());
}

/// Press and release come in frames of their own, as they do where a frame takes long.
fn slow_click() {
    let mut bench = bench("slow-click");
    for (label, traced) in [("Reference", true), ("Live", false)] {
        let at = bench.window.get_by_role_and_label(Role::RadioButton, label).rect().center();
        bench.drag(at, at);
        assert_eq!(bench.window.state().as_ref().is_some_and(|w| w.reference().is_on()), traced, "{label}");
    }
}

fn snapshots() {
    let mut bench = bench("snapshots");
    bench.workbench().show_panel(Pane::Compare);
    bench.window.run_steps(3);
    bench.click("Take snapshot");
    let first = roughness(&bench);
    bench.workbench().show_panel(Pane::Material);
    bench.window.run_steps(3);
    bench.slide("Roughness", 0.6);
    bench.workbench().show_panel(Pane::Compare);
    bench.window.run_steps(3);
    bench.click("Change snapshot Snapshot");
    bench.click("Rename");
    bench.window.get_by_label("Name of the snapshot");
    bench.keys(Modifiers::COMMAND, Key::A);
    bench.window.event(eframe::egui::Event::Text("before".into()));
    bench.window.run_steps(2);
    bench.keys(Modifiers::NONE, Key::Enter);
    bench.click("Restore before");
    assert_eq!(roughness(&bench), first);
    bench.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(roughness(&bench), 0.6);
    bench.click("Change snapshot before");
    bench.click("Show as A");
    bench.click_role(Role::ComboBox, "Method of B");
    bench.click_role(Role::Button, "live");
    bench.window.get_by_label("Copy Roughness to B");
    bench.click("Change snapshot before");
    bench.click("Delete");
    assert!(bench.session().document().snapshots.is_empty());
    let expected =
        ["Take snapshot", "Roughness", "Rename snapshot", "Choose side", "Method of side", "Delete snapshot"];
    assert_eq!(labels(&bench), expected);
}

fn picked() {
    let mut bench = bench("picked");
    bench.keys(Modifiers::NONE, Key::S);
    let viewport = bench.window.get_by(|node| node.label().is_some_and(|label| label.starts_with("Viewport:"))).rect();
    for share in [0.25, 0.75] {
        bench.workbench().session_mut().selection.objects.clear();
        let at = pos2(viewport.left() + share * viewport.width(), viewport.center().y + 40.0);
        bench.drag(at, at);
        assert_eq!(bench.session().selection.objects.len(), 1, "the ball is in the middle of each half");
        assert_ne!(bench.session().selection.objects, ["floor"]);
    }
}

fn mapped() {
    let mut bench = small("mapped");
    bench.keys(Modifiers::NONE, Key::E);
    let said = |bench: &Bench, words: &str| bench.window.query_all_by_label_contains(words).next().is_some();
    bench.until("there is a map", |w| w.compare().maps.shown().is_some());
    assert!(said(&bench, "FLIP: mean 0.") && said(&bench, "Against reference, "));
    let viewport = bench.window.get_by(|node| node.label().is_some_and(|label| label.starts_with("Viewport:"))).rect();
    bench.window.hover_at(viewport.center());
    bench.window.run_steps(3);
    assert!(said(&bench, "FLIP 0."), "the value under the pointer");
    bench.click_role(Role::RadioButton, "Relative");
    bench.until("it is measured again", |w| w.compare().maps.shown().is_some());
    assert!(said(&bench, "Relative: mean "));

    bench.slide("Roughness", 0.7);
    let shown = compare(&bench).maps.shown().is_some();
    assert!(!shown || said(&bench, "Against reference, "), "no old map over a new picture");
    bench.until("there is a map of the new picture", |w| w.compare().maps.shown().is_some());
    bench.keys(Modifiers::NONE, Key::E);
    assert!(compare(&bench).maps.shown().is_none());
    bench.until("the thread rests", |w| !w.reference().is_tracing());
}

fn traced() {
    let mut bench = small("traced");
    bench.keys(Modifiers::COMMAND, Key::Num1);
    bench.slide("Roughness", 0.8);
    bench.workbench().session_mut().edit("Both", "", |document| {
        for side in Side::ALL {
            document.compare.side_mut(side).method = "reference".into();
        }
    });
    bench.workbench().ask(Request::Command(Command::Compare(CompareView::Difference)));
    bench.until("both are traced and compared", |w| w.compare().maps.shown().is_some());
    let map = compare(&bench).maps.shown().map(|(map, _)| map.mean);
    assert!(map.is_some_and(|mean| mean > 0.0), "{map:?}");
    bench.keys(Modifiers::NONE, Key::D);
    bench.until("the thread rests", |w| !w.reference().is_tracing());
}

fn by_processor() {
    let mut bench = Bench::new(Setup {
        name: "compare-processor",
        scene: Some("gallery:ball"),
        size: [560.0, 320.0],
        drawn: false,
    });
    bench.keys(Modifiers::COMMAND, Key::Num1);
    let keys = bench.session().resolved().object_keys.clone();
    bench.workbench().session_mut().edit("Light all otherwise", "", |document| {
        keys.iter().for_each(|key| document.lighting.override_object(key, Some("reference")));
    });
    bench.workbench().ask(Request::Command(Command::Compare(CompareView::Difference)));
    // A is the flat grey of a window without a device.
    bench.until("B is drawn and compared with A", |w| w.compare().maps.shown().is_some());
    let mean = |bench: &Bench| compare(bench).maps.shown().map(|(map, _)| map.mean);
    assert!(mean(&bench).is_some_and(|mean| mean > 0.1), "{:?}", mean(&bench));
    let shown = |bench: &mut Bench| bench.workbench().reference().shown().is_some();
    assert!(!shown(&mut bench), "the picture of a side is not offered to be saved as the live one");
    bench.keys(Modifiers::NONE, Key::D);
    // Both follow paths, each with points of its own: what is left is noise and the form of the metals.
    bench.keys(Modifiers::NONE, Key::E);
    bench.until("the picture is compared with the reference", |w| w.compare().maps.shown().is_some());
    bench.until("it refines", |w| w.compare().maps.shown().is_some_and(|(map, _)| map.mean < 0.1));
    assert!(!shown(&mut bench), "nor is the reference");
    bench.keys(Modifiers::NONE, Key::E);
    bench.until("the threads rest", |w| !w.reference().is_tracing());
}
