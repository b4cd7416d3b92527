//! The path-traced reference behind the viewport: switched, refined, started anew, left alone.

use burnish::window::{Command, Pane, Reference, Request, Workbench};
use burnish_core::param::ParamValue;
use burnish_tests::trial;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Role, vec2};
use egui_kittest::kittest::Queryable;
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

pub fn trials() -> Vec<Trial> {
    vec![
        trial("the_reference_is_switched_by_label_key_and_menu", &[], switched),
        trial("the_reference_refines_while_still_and_starts_anew_after_an_edit", &[], refined),
        trial("the_reference_rests_after_input_and_goes_on_by_itself", &[], rested),
        trial("nothing_is_traced_behind_the_live_picture_or_another_tab", &[], left_alone),
        trial("settings_of_the_reference_are_shown_edited_and_undone", &[], settings),
        trial("a_reference_that_fails_says_so_and_leaves_the_live_picture", &[], failed),
        trial("the_reference_is_saved_as_it_is_shown", &[], saved),
        trial("an_object_is_lit_by_another_method_than_the_scene", &[], lit_otherwise),
    ]
}

/// Small: a debug build traces it.
fn bench(name: &str) -> Bench {
    let name = format!("reference-{name}");
    Bench::new(Setup { name: &name, scene: Some("gallery:workbench"), size: [560.0, 320.0], drawn: false })
}

fn reference(bench: &Bench) -> &Reference {
    bench.window.state().as_ref().expect("it was drawn").reference()
}

fn samples(workbench: &Workbench) -> u32 {
    workbench.reference().shown().map_or(0, |look| look.samples)
}

fn switched() {
    let mut bench = bench("switched");
    assert!(!reference(&bench).is_on());
    bench.click_role(Role::RadioButton, "Reference");
    assert!(reference(&bench).is_on());
    bench.click_role(Role::RadioButton, "Reference");
    assert!(reference(&bench).is_on(), "it is on already");
    bench.click_role(Role::RadioButton, "Live");
    assert!(!reference(&bench).is_on());
    bench.keys(Modifiers::NONE, Key::R);
    assert!(reference(&bench).is_on());
    bench.menu("View", "Path-traced reference");
    assert!(!reference(&bench).is_on());
    assert!(bench.session().history().past().is_empty(), "it is no edit");
    assert!(!bench.session().is_dirty());
}

fn refined() {
    let mut bench = bench("refined");
    bench.keys(Modifiers::NONE, Key::R);
    bench.until("there is a whole picture", |w| samples(w) > 0);
    let before = reference(&bench).shown().expect("it was there").samples;
    bench.until("it refines", |w| samples(w) > before + 2);
    assert!(reference(&bench).text(true).contains("noise"), "{}", reference(&bench).text(true));
    bench.until_shown("reference; all light: path traced");

    let session = bench.workbench().session_mut();
    session.edit("Exposure", "", |document| document.view.exposure_ev = 1.5);
    bench.window.run_steps(1);
    assert!(reference(&bench).shown().is_some(), "exposure is a matter of the display");

    bench.slide("Roughness", 0.7);
    assert!(reference(&bench).shown().is_none(), "an old picture is not shown as the new one");
    assert!(reference(&bench).text(true).starts_with("Live picture"), "{}", reference(&bench).text(true));
    bench.until("it is traced anew", |w| samples(w) > 0);

    let viewport = bench.window.get_by(|node| node.label().is_some_and(|label| label.starts_with("Viewport:")));
    let middle = viewport.rect().center();
    bench.drag(middle, middle + vec2(40.0, 10.0));
    assert!(reference(&bench).shown().is_none());
    bench.until("it is traced anew", |w| samples(w) > 0);
    bench.keys(Modifiers::COMMAND, Key::Z);
    assert!(reference(&bench).shown().is_none());
    bench.until("it is traced anew", |w| samples(w) > 0);
}

fn rested() {
    let mut bench = bench("rested");
    bench.keys(Modifiers::NONE, Key::R);
    bench.until("there is a whole picture", |w| samples(w) > 0);
    bench.until("it goes on", |w| w.reference().rests_for().is_none());
    let at = bench.window.get_by_label("Search presets").rect().center();
    bench.window.hover_at(at);
    bench.window.run_steps(1);
    assert_eq!(reference(&bench).rests_for(), None, "a pointer that only passes disturbs nobody");
    let modifiers = Modifiers::NONE;
    for pressed in [true, false] {
        let button = PointerButton::Primary;
        bench.window.event(Event::PointerButton { pos: at, button, pressed, modifiers });
        bench.window.run_steps(1);
        assert!(reference(&bench).rests_for().is_some());
    }
    bench.until("the rest is over", |w| w.reference().rests_for().is_none());
    let before = reference(&bench).shown().expect("nothing was edited").samples;
    bench.until("it refines", |w| samples(w) > before);
    bench.window.event(Event::Text("g".into()));
    bench.window.run_steps(1);
    assert!(reference(&bench).rests_for().is_some() && reference(&bench).text(true).ends_with(", paused"));
}

fn left_alone() {
    let mut bench = bench("left-alone");
    bench.keys(Modifiers::NONE, Key::R);
    bench.until("there is a whole picture", |w| samples(w) > 1);
    let before = reference(&bench).shown().expect("it was there").samples;
    bench.keys(Modifiers::NONE, Key::R);
    bench.until("the thread rests", |w| !w.reference().is_tracing());
    assert!(reference(&bench).shown().is_none());
    bench.keys(Modifiers::NONE, Key::R);
    assert!(reference(&bench).shown().expect("it was kept").samples >= before);
    bench.until("it goes on from there", |w| samples(w) > before);

    bench.workbench().hide_panel(Pane::Viewport);
    bench.window.run_steps(2);
    bench.until("the thread rests", |w| !w.reference().is_tracing());
    bench.workbench().show_panel(Pane::Viewport);
    bench.until("it goes on from there", |w| samples(w) > before && w.reference().is_tracing());
    bench.workbench().ask(Request::Command(Command::Start));
    bench.window.run_steps(2);
    bench.until("the thread rests", |w| !w.reference().is_tracing());
}

fn settings() {
    let mut bench = bench("settings");
    bench.workbench().show_panel(Pane::Environment);
    bench.window.run_steps(2);
    assert!(bench.window.query_by_label("Bounces").is_none());
    bench.keys(Modifiers::NONE, Key::R);
    bench.slide("Bounces", 3.0);
    let bounces = |bench: &Bench| bench.session().document().lighting.reference_settings().get("bounces");
    assert_eq!(bounces(&bench), Some(ParamValue::Integer(3)));
    let labels: Vec<_> = bench.session().history().past().iter().map(|step| step.label.clone()).collect();
    assert_eq!(labels, ["Reference bounces"]);
    bench.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(bounces(&bench), Some(ParamValue::Integer(64)));
}

fn failed() {
    let mut bench = bench("failed");
    bench.workbench().reference().inject_failure();
    bench.keys(Modifiers::NONE, Key::R);
    bench.until("it is said", |w| w.messages().any(|text| text.starts_with("The reference cannot be traced:")));
    assert!(reference(&bench).shown().is_none() && !reference(&bench).is_tracing());
    bench.slide("Roughness", 0.7);
    bench.until("the next edit tries again", |w| samples(w) > 0);
    assert_eq!(reference(&bench).fault(), None);

    let keys = bench.session().resolved().object_keys.clone();
    bench.workbench().session_mut().selection.objects = keys;
    bench.workbench().ask(Request::Command(Command::Hide));
    bench.window.run_steps(2);
    assert!(bench.session().scene().instances.iter().all(|instance| !instance.visible));
    bench.until("a scene without objects is traced too", |w| samples(w) > 0);
}

fn saved() {
    let mut bench = bench("saved");
    bench.keys(Modifiers::NONE, Key::R);
    bench.until("there is a whole picture", |w| samples(w) > 0);
    bench.keys(Modifiers::COMMAND, Key::E);
    bench.window.get_by_label("Reference, as shown");
    let path = bench.folder.join("shown.exr");
    bench.enter_path(&path);
    bench.until("it is written", |w| w.messages().any(|text| text.starts_with("Wrote ")));
    let look = reference(&bench).shown().expect("it is still there");
    let written = burnish_core::file::read_picture(&path).expect("it was written").0;
    assert_eq!((written.width, written.height), (look.picture.width, look.picture.height));
}

fn lit_otherwise() {
    let mut bench = Bench::new(Setup {
        name: "reference-otherwise",
        scene: Some("gallery:ball"),
        size: [1280.0, 2000.0],
        drawn: false,
    });
    let key = bench.session().resolved().object_keys[0].clone();
    let name = bench.session().scene().instances[0].name.clone();
    let method = |bench: &Bench| bench.session().document().lighting.overrides.get(&key).map(|o| o.method.clone());
    bench.workbench().show_panel(Pane::Environment);
    bench.until_shown("Objects lit otherwise");
    bench.click("Objects lit otherwise");
    bench.workbench().session_mut().selection.objects = vec![key.clone()];
    bench.click("Light the selection otherwise");
    assert_eq!(method(&bench).as_deref(), Some("reference"));
    // The cubes of the scene's own method are made, then both draw.
    bench.until("it is drawn on the processor", |w| w.reference().shown().is_some_and(|look| look.samples >= 2));
    bench.until_shown(
        "classical; no lamps; environment: approximate; indirect diffuse: nothing; indirect glossy: nothing; \
         1 object lit otherwise, drawn on the processor",
    );
    bench.workbench().ask(Request::Command(Command::SaveImage));
    bench.until_shown("As shown");
    bench.until_shown("Rendered anew");
    bench.keys(Modifiers::NONE, Key::Escape);
    bench.click_role(Role::ComboBox, &format!("Method of {name}"));
    bench.click_role(Role::Button, "Classical");
    assert_eq!(method(&bench).as_deref(), Some("classical"));
    bench.until("it is drawn anew", |w| w.reference().shown().is_some_and(|look| look.samples >= 2));
    assert!(bench.text().contains("\"overrides\""), "it is saved: {}", bench.text());
    bench.click(&format!("Light {name} as the scene"));
    assert_eq!(method(&bench), None);
    bench.until("the device draws again", |w| w.reference().shown().is_none());
    bench.keys(Modifiers::COMMAND, Key::Z);
    bench.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(method(&bench).as_deref(), Some("reference"));
}
