//! Lights: added, aimed, switched, dragged by their highlight, kept as presets.

use burnish::window::{Command, Pane, Request, Tool};
use burnish_core::document::{LightEntry, LightingPreset};
use burnish_tests::trial;
use eframe::egui::{Key, Modifiers, Role, vec2};
use egui_kittest::kittest::Queryable;
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a_rectangle_light_is_added_aimed_switched_and_undone", &[], edited),
        trial("a_light_is_placed_by_its_highlight_its_shadow_and_around_the_subject", &[], placed),
        trial("lighting_presets_light_the_subject_and_are_kept_exported_and_imported", &[], presets),
    ]
}

fn bench(name: &str) -> Bench {
    let mut bench = Bench::new(Setup { name, scene: Some("gallery:workbench"), size: [1280.0, 2000.0], drawn: false });
    bench.workbench().show_panel(Pane::Lights);
    bench.until_shown("Add light");
    bench
}

fn lights(bench: &Bench) -> Vec<LightEntry> {
    let session = bench.session();
    session.document().light_entries(&session.sources().models[&session.document().scene])
}

fn edited() {
    let mut bench = bench("lights-edited");
    let before = lights(&bench);
    bench.click("Add light");
    bench.click("Add rectangle");
    let added =
        lights(&bench).into_iter().find(|light| !before.iter().any(|b| b.name == light.name)).expect("a new one");
    assert_eq!((added.name.as_str(), lights(&bench).len()), ("Rectangle", before.len() + 1));

    let yaw = |bench: &Bench| lights(bench).iter().find(|light| light.name == "Rectangle").map(|light| light.yaw_deg);
    bench.slide("Yaw", 90.0);
    assert_eq!(yaw(&bench), Some(90.0));
    bench.click("Aim at subject");
    let aimed = yaw(&bench).expect("it is there");
    assert!((aimed - added.yaw_deg).abs() < 0.1, "{aimed} {}", added.yaw_deg);
    bench.keys(Modifiers::COMMAND, Key::Z);
    assert_eq!(yaw(&bench), Some(90.0), "undo takes the aim back");

    let shining = |bench: &Bench| bench.session().scene().lights.len();
    bench.click("Solo Rectangle");
    assert_eq!(shining(&bench), 1);
    bench.click("Solo Rectangle");
    bench.click("Mute Rectangle");
    assert_eq!(shining(&bench), before.len());
    bench.click("Mute Rectangle");

    // The unit changes, the light does not.
    let strength =
        |bench: &Bench| bench.session().scene().lights.iter().find(|l| l.name == "Rectangle").map(|l| l.intensity);
    let lumen = strength(&bench).expect("it shines");
    bench.click_role(Role::ComboBox, "Unit");
    bench.click_role(Role::Button, "nit");
    let nit = strength(&bench).expect("it shines");
    assert!((nit - lumen).length() < 1e-4 * lumen.length(), "{lumen} {nit}");

    for button in ["Duplicate light", "Delete light"] {
        bench.click(button);
    }
    assert_eq!(lights(&bench).len(), before.len() + 1);
    while bench.session().history().past().iter().any(|step| step.label == "Add light") {
        bench.keys(Modifiers::COMMAND, Key::Z);
    }
    assert!(bench.session().document().lights.is_none(), "those of the model again");
}

fn placed() {
    let mut bench = bench("lights-placed");
    bench.click("Add light");
    bench.click("Add sphere");
    let place = |bench: &Bench| lights(bench).last().map(LightEntry::place).expect("it was added");
    let added = place(&bench);
    let picture = bench.window.get_by_label_contains("Viewport: ").rect();
    let middle = picture.center();
    for (tool, label) in
        [(Tool::Highlight, "Place highlight"), (Tool::Shadow, "Place shadow"), (Tool::Orbit, "Orbit light")]
    {
        bench.workbench().ask(Request::Command(Command::Tool(tool)));
        bench.window.run_steps(2);
        let before = place(&bench);
        let camera = bench.session().document().view.clone();
        bench.drag(middle, middle + vec2(24.0, 12.0));
        assert!((place(&bench) - before).length() > 1e-3, "{label} moves it");
        assert_eq!(bench.session().document().view, camera, "and no camera");
        assert_eq!(bench.session().history().past().last().map(|step| step.label.as_str()), Some(label));
        bench.keys(Modifiers::COMMAND, Key::Z);
        assert!((place(&bench) - before).length() < 1e-6, "one step");
    }
    assert_eq!(place(&bench), added);

    // By a handle, too, where it is seen.
    let center = bench.session().scene().subject_bounds().center();
    let model = bench.session().sources().models[&bench.session().document().scene].clone();
    bench.workbench().session_mut().edit("Nearer", "", |document| {
        document.edit_light(&model, "Sphere", |light| light.set_place(center));
    });
    bench.workbench().ask(Request::Command(Command::Tool(Tool::Move)));
    bench.window.run_steps(2);
    let handle = bench.window.get_by_label("Move Sphere along y").rect().center();
    bench.drag(handle, handle + vec2(0.0, -20.0));
    assert!(place(&bench).y > center.y && (place(&bench).x - center.x).abs() < 1e-3);
    let mark = bench.window.get_by_label("Mark of Sphere").rect().center();
    bench.workbench().session_mut().selection.lights.clear();
    bench.workbench().ask(Request::Command(Command::Tool(Tool::Select)));
    bench.window.run_steps(2);
    bench.drag(mark, mark);
    assert_eq!(bench.session().selection.lights, ["Sphere"], "a click on its mark selects it");
}

fn presets() {
    let mut bench = bench("lights-presets");
    for preset in LightingPreset::library() {
        bench.click(&format!("Light by {}", preset.name));
        assert_eq!(bench.session().scene().lights.len(), preset.lights.len(), "{}", preset.id);
    }
    bench.click("Light by Three-point");
    let three = lights(&bench);
    bench.window.get_by_role_and_label(Role::TextInput, "Lighting preset name").focus();
    bench.window.run_steps(1);
    bench.window.get_by_role_and_label(Role::TextInput, "Lighting preset name").type_text("Mine");
    bench.window.run_steps(2);
    bench.click("Keep lighting preset");
    bench.until_shown("Light by Mine");
    bench.click("Light by Rim");
    bench.click("Light by Mine");
    let back = lights(&bench);
    assert_eq!(back.len(), three.len());
    for (a, b) in back.iter().zip(&three) {
        assert!((a.place() - b.place()).length() < 1e-4 && a.name == b.name, "{} {}", a.name, b.name);
        assert!((a.power / b.power - 1.0).abs() < 1e-4 && (a.direction() - b.direction()).length() < 1e-4);
    }

    let file = bench.folder.join("shared.json");
    bench.click("Export...");
    bench.enter_path(&file);
    bench.until("it is written", |workbench| !workbench.is_busy());
    assert!(file.exists());
    bench.click("Light by Rim");
    let import = |bench: &mut Bench| {
        bench.click("Import lighting preset...");
        bench.enter_path(&file);
        bench.until("it is read", |workbench| !workbench.is_busy());
    };
    import(&mut bench);
    assert_eq!(lights(&bench).len(), three.len());
    bench.until_shown("Light by shared");
    std::fs::write(&file, "{ \"format\": \"burnish-lighting\" }").expect("a writable folder");
    import(&mut bench);
    let told: Vec<String> = bench.workbench().messages().map(str::to_string).collect();
    assert!(told.iter().any(|text| text.contains("shared.json")), "{told:?}");
    assert_eq!(lights(&bench).len(), three.len(), "nothing is lost");

    bench.window.get_by_label("Light by Mine").click_secondary();
    bench.window.run_steps(3);
    bench.click("Delete lighting preset");
    bench.until("it is deleted", |workbench| !workbench.is_busy());
    assert!(bench.window.query_by_label("Light by Mine").is_none());
    bench.until_shown("Light by shared");
}
