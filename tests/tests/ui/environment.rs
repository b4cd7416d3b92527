//! The environment: kinds, softboxes on the map, background and ground, saving; and aids for judging light.

use burnish::window::{Command, Pane, Request, Source};
use burnish_core::document::{BackgroundEntry, MadeEntry, SoftBoxEntry};
use burnish_core::measure::view::DisplayMode;
use burnish_core::reference::Contribution;
use burnish_tests::trial;
use eframe::egui::{Key, Modifiers, Role, vec2};
use egui_kittest::kittest::Queryable;
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a_studio_is_built_of_softboxes_moved_on_its_map_and_saved", &[], studio),
        trial("a_sky_sets_the_exposure_for_itself_and_back", &[], sky),
        trial("the_background_is_a_colour_a_blur_or_lies_on_a_ground", &[], background),
        trial("false_colour_clipping_and_the_light_of_one_source_are_shown_and_left", &[], aids),
        trial("levels_of_the_picture_are_counted", &[], scope),
    ]
}

fn bench(name: &str, pane: Pane) -> Bench {
    let mut bench = Bench::new(Setup { name, scene: Some("gallery:workbench"), size: [1280.0, 2400.0], drawn: false });
    bench.workbench().show_panel(pane);
    bench.window.run_steps(3);
    bench
}

fn boxes(bench: &Bench) -> Vec<SoftBoxEntry> {
    match &bench.session().document().environment.made {
        Some(MadeEntry::Studio(studio)) => studio.boxes.clone(),
        other => panic!("no studio but {other:?}"),
    }
}

fn last_step(bench: &Bench) -> Option<&str> {
    bench.session().history().past().last().map(|step| step.label.as_str())
}

fn studio() {
    let mut bench = bench("environment-studio", Pane::Environment);
    bench.click_role(Role::RadioButton, "Studio");
    let before = boxes(&bench);
    let lit = bench.session().scene().environment.clone().expect("a map");
    bench.click("Add softbox");
    assert_eq!(boxes(&bench).len(), before.len() + 1);
    bench.slide("Box azimuth", 30.0);
    bench.slide("Box radiance", 50.0);
    let added = boxes(&bench).last().expect("it was added").clone();
    assert_eq!((added.azimuth_deg, added.radiance), (30.0, 50.0), "the new one is edited");
    assert_ne!(bench.session().scene().environment.as_ref().expect("a map").texels, lit.texels);

    // The map shows the front in its middle, and +x to the left of it.
    let map = bench.window.get_by_label("Map of the environment").rect();
    let handle = bench.window.get_by_label("Handle of softbox key").rect().center();
    let wanted = map.center() + vec2(-0.125 * map.width(), 0.0);
    bench.drag(handle, wanted);
    let key = boxes(&bench)[0].clone();
    assert!((key.azimuth_deg - 45.0).abs() < 1.5 && key.elevation_deg.abs() < 1.5, "{key:?}");
    assert_eq!(last_step(&bench), Some("Move softbox"));
    bench.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(boxes(&bench)[0], before[0], "a drag is one step");
    bench.click("Delete softbox");
    assert_eq!(boxes(&bench).len(), before.len());

    bench.click("Save environment...");
    bench.enter_path(&bench.folder.join("studio.png"));
    assert!(bench.window.query_by_label_contains("needs the ending .hdr or .exr").is_some());
    let file = bench.folder.join("studio.hdr");
    bench.enter_path(&file);
    bench.until("it is written", |workbench| !workbench.is_busy());
    let bytes = std::fs::read(&file).expect("it was written");
    assert!(bytes.starts_with(b"#?RADIANCE"));

    // The studio comes back as it was left.
    bench.click_role(Role::RadioButton, "HDRI");
    assert!(bench.session().document().environment.made.is_none());
    bench.click_role(Role::RadioButton, "Studio");
    assert_eq!(boxes(&bench).len(), before.len());
}

fn sky() {
    let mut bench = bench("environment-sky", Pane::Environment);
    let exposure = |bench: &Bench| bench.session().document().view.exposure_ev;
    let suns = |bench: &Bench| bench.session().scene().lights.iter().filter(|l| l.name == "Sun of the sky").count();
    assert_eq!((exposure(&bench), suns(&bench)), (0.0, 0));
    bench.click_role(Role::RadioButton, "Sky");
    assert!((-16.0..-10.0).contains(&exposure(&bench)), "{}", exposure(&bench));
    assert_eq!(suns(&bench), 1);
    let bright = exposure(&bench);
    bench.slide("Sun elevation", 5.0);
    bench.click("Expose for sky and sun");
    assert!(exposure(&bench) > bright + 1.0, "a low sun is darker: {} {bright}", exposure(&bench));
    bench.click_role(Role::CheckBox, "Sun");
    assert_eq!(suns(&bench), 0);
    bench.click_role(Role::RadioButton, "HDRI");
    assert!(exposure(&bench).abs() < 4.0, "{}", exposure(&bench));
    while !bench.session().history().past().is_empty() {
        bench.keys(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!((exposure(&bench), suns(&bench)), (0.0, 0));
}

fn background() {
    let mut bench = bench("environment-background", Pane::Environment);
    let background = |bench: &Bench| bench.session().scene().background.clone();
    bench.slide("Background blur", 20.0);
    assert!(background(&bench).map.is_some_and(|map| map.height <= 256), "a map of its own");
    bench.click_role(Role::ComboBox, "Background");
    bench.click_role(Role::Button, "Colour");
    assert!(matches!(bench.session().document().environment.background, BackgroundEntry::Color(_)));
    bench.click_role(Role::CheckBox, "Ground");
    let ground = background(&bench).ground.expect("a ground");
    let lowest = bench.session().scene().bounds().min.y;
    assert!((ground.middle.y - lowest).abs() < 1e-4 && ground.shadows);
    bench.slide("Height of map", 50.0);
    let ground = background(&bench).ground.expect("wider than high, else it would be refused");
    assert!(ground.radius > ground.height && ground.height == 50.0);
    bench.slide("Level", -2.0);
    assert_eq!(background(&bench).ground.map(|ground| ground.middle.y), Some(-2.0));
    bench.click("Reset Level");
    assert!(background(&bench).ground.is_some_and(|ground| (ground.middle.y - lowest).abs() < 1e-4));
    bench.click_role(Role::CheckBox, "Catch shadows");
    assert!(background(&bench).ground.is_some_and(|ground| !ground.shadows));
}

fn aids() {
    let mut bench = bench("environment-aids", Pane::Lights);
    let mode = |bench: &mut Bench| bench.workbench().aids().mode;
    bench.keys(Modifiers::NONE, Key::U);
    assert_eq!(mode(&mut bench), DisplayMode::FalseColor);
    bench.until_shown("Legend: False colour");
    bench.workbench().ask(Request::Command(Command::Display(DisplayMode::Clipping)));
    bench.until_shown("Legend: Clipping");
    bench.keys(Modifiers::NONE, Key::J);
    assert_eq!(mode(&mut bench), DisplayMode::Picture);
    assert!(bench.window.query_by_label_contains("Legend: ").is_none());

    let name = bench.session().scene().lights[0].name.clone();
    let document = bench.text();
    bench.click_role(Role::ComboBox, "Show light of");
    bench.click_role(Role::Button, &name);
    let scene = bench.session().scene().clone();
    assert_eq!(bench.workbench().aids().contribution(&scene), Contribution::Light(0));
    bench.until_shown(&format!("Shown light: {name}"));
    assert_eq!(bench.text(), document, "nothing of the document changes");
    bench.click(&format!("Mute {name}"));
    assert_eq!(*bench.workbench().aids().source(), Source::All, "a light that does not shine is not shown alone");
}

fn scope() {
    let mut bench = bench("environment-scope", Pane::Scope);
    bench.until("it is counted", |workbench| !workbench.is_busy());
    // A flat stage is evenly grey.
    bench.until_shown("0 % too bright, 0 % black");
    assert!(bench.window.query_by_label_contains("Histogram: 0 %").is_some());
    bench.workbench().session_mut().edit("Exposure", "", |document| document.view.exposure_ev = 10.0);
    bench.until_shown("100.0 % too bright, 0 % black");
    bench.click("Waveform");
    bench.until_shown("Waveform of the picture");
    bench.click_role(Role::RadioButton, "False colour");
    bench.until_shown("Legend: False colour");
}
