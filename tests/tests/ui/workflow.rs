//! A day at the workbench, by what a person reads on the screen.

use std::path::Path;
use std::time::{Duration, SystemTime};

use burnish::window::{Command, Pane, Request};
use burnish_core::document::Document;
use burnish_core::material::Reflectance;
use burnish_core::material::finish::{self, Kind};
use burnish_core::param::ParamValue;
use burnish_core::surface::micro_normal;
use burnish_tests::trial;
use eframe::egui::{Key, Modifiers, Role, vec2};
use egui_kittest::kittest::Queryable;
use libtest_mimic::Trial;

use super::bench::{Bench, Setup};

/// Two triangles with a material each; `FIRST` and `SECOND` are the names of the materials.
const MODEL: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0,"name":"leaf"},{"mesh":1,"name":"stem","translation":[1,0,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]},{"primitives":[{"attributes":{"POSITION":0},"material":1}]}],
"materials":[{"name":"FIRST"},{"name":"SECOND"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a_model_becomes_gold_and_is_saved_undone_and_opened_again", &[], gold),
        trial("a_model_that_changed_is_reloaded_and_one_that_moved_is_relinked", &[], changed_and_moved),
        trial("commands_about_materials_and_objects_do_what_they_say", &[], commands),
        trial("a_finish_and_a_coat_are_chosen_by_name_and_taken_back", &[], finishes),
        trial("the_scene_panel_selects_renames_hides_and_assigns", &[], scene_panel),
        trial("the_history_panel_goes_to_any_step", &[], history_panel),
        trial("the_palette_finds_and_does_a_command", &[], palette),
        trial("keys_do_commands_and_typing_does_none", &[], keys),
        trial("the_layout_is_kept_for_the_next_start", &[], layout),
        trial("an_error_is_said_once_in_words", &[], errors),
    ]
}

fn bench(name: &str, scene: Option<&str>) -> Bench {
    Bench::new(Setup { name, scene, size: [1280.0, 900.0], drawn: false })
}

fn model(path: &Path, first: &str, second: &str) {
    std::fs::write(path, MODEL.replace("FIRST", first).replace("SECOND", second)).expect("the folder can be written");
}

fn labels(bench: &Bench) -> Vec<String> {
    bench.session().history().past().iter().map(|step| step.label.clone()).collect()
}

/// True where the material of an object is a metal.
fn is_metal(bench: &Bench, object: usize, id: &str) -> bool {
    let scene = bench.session().scene();
    let material = &scene.materials[scene.instances[object].material];
    matches!(&material.reflectance, Reflectance::Preset { id: of, .. } if of == id)
}

fn ask(bench: &mut Bench, command: Command) {
    bench.workbench().ask(Request::Command(command));
    bench.window.run_steps(3);
}

/// Searches first: more metals come with the program than the panel shows at once.
fn pick_gold(bench: &mut Bench) {
    bench.until_shown("Search presets");
    bench.window.get_by_label("Search presets").set_text_value_accesskit("gold");
    bench.window.run_steps(3);
    bench.click("Gold");
}

fn gold() {
    let mut bench = bench("gold", None);
    let path = bench.folder.join("leaf.gltf");
    model(&path, "red", "green");
    // The start page has a path field.
    bench.enter_path(&path);
    bench.until("the model is open", |workbench| workbench.session().title() == "leaf");
    pick_gold(&mut bench);
    assert!(is_metal(&bench, 0, "Au") && !is_metal(&bench, 1, "Au"));
    let rail = bench.window.get_by_role_and_label(Role::Slider, "Roughness").rect();
    bench.drag(rail.lerp_inside(vec2(0.9, 0.5)), rail.lerp_inside(vec2(0.4, 0.5)));
    let dragged = bench.session().scene().materials[0].roughness;
    assert!((0.25..0.5).contains(&dragged), "{dragged}");
    assert_eq!(labels(&bench).iter().filter(|label| *label == "Roughness").count(), 1, "a drag is one step");
    bench.slide("Roughness", 0.35);
    bench.slide("Anisotropy", 0.5);
    let scene = bench.session().scene().clone();
    assert_eq!((scene.materials[0].roughness, scene.materials[0].anisotropy), (0.35, 0.5));

    let before = bench.session().document().view.camera.clone();
    let viewport = bench.window.get_by(|node| node.label().is_some_and(|label| label.starts_with("Viewport:")));
    let middle = viewport.rect().center();
    bench.drag(middle, middle + vec2(120.0, 30.0));
    assert_ne!(bench.session().document().view.camera.yaw_deg, before.yaw_deg, "it turned");

    bench.menu("Material", "Apply to all objects");
    assert!(is_metal(&bench, 1, "Au"));
    let done = bench.text();
    let steps = labels(&bench).len();
    for _ in 0..3 {
        bench.keys(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(labels(&bench).len(), steps - 3);
    assert!(!is_metal(&bench, 1, "Au"));
    for _ in 0..3 {
        bench.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    }
    assert_eq!(bench.text(), done, "redo leads back");

    bench.keys(Modifiers::COMMAND, Key::S);
    let saved = bench.folder.join("leaf.burnish");
    bench.enter_path(&saved);
    bench.until("it is saved", |workbench| !workbench.session().is_dirty());
    let kept = bench.session().document().clone();
    assert_eq!(Document::read(&saved).expect("it was saved"), *kept);
    bench.workbench().ask(Request::OpenScene(saved.to_string_lossy().into_owned()));
    bench.until("it is open again", |w| !w.is_busy() && w.session().history().past().is_empty());
    assert_eq!(*bench.session().document(), kept);
}

fn changed_and_moved() {
    let mut bench = bench("changed", None);
    let path = bench.folder.join("leaf.gltf");
    model(&path, "red", "green");
    bench.workbench().ask(Request::OpenScene(path.to_string_lossy().into_owned()));
    bench.until("the model is open", |workbench| workbench.session().title() == "leaf");
    pick_gold(&mut bench);

    // A change on disk is seen by its time: make sure that it differs.
    model(&path, "blue", "red");
    let later = SystemTime::now() + Duration::from_secs(10);
    let file = std::fs::File::options().append(true).open(&path).expect("it is there");
    file.set_modified(later).expect("its time can be set");
    bench.until_shown("Reload leaf.gltf");
    bench.click("Reload leaf.gltf");
    bench.until("it is reloaded", |workbench| workbench.session().document().materials.len() == 3);
    assert!(is_metal(&bench, 1, "Au") && !is_metal(&bench, 0, "Au"), "gold stays on `red`");

    let saved = bench.folder.join("mine.burnish");
    bench.session().document().save(&saved).expect("the folder can be written");
    let moved = bench.folder.join("moved.gltf");
    std::fs::rename(&path, &moved).expect("it is there");
    ask(&mut bench, Command::Undo);
    bench.workbench().ask(Request::OpenScene(saved.to_string_lossy().into_owned()));
    bench.window.run_steps(3);
    if bench.window.query_by_label("Discard").is_some() {
        bench.click("Discard");
    }
    bench.until_shown("Relink leaf.gltf");
    bench.click("Relink leaf.gltf");
    bench.enter_path(&moved);
    bench.until("it is found", |workbench| workbench.session().resolved().missing.is_empty());
    assert!(is_metal(&bench, 1, "Au"));
}

fn commands() {
    let mut bench = bench("commands", Some("gallery:workbench"));
    let start = bench.text();
    let keys = bench.session().resolved().object_keys.clone();
    let count = bench.session().document().materials.len();
    bench.workbench().session_mut().selection.objects = vec![keys[0].clone()];
    ask(&mut bench, Command::NewMaterial);
    assert_eq!(bench.session().selection.material, count);
    assert_eq!(bench.session().scene().instances[0].material, count, "the selected object has it");
    ask(&mut bench, Command::CopyMaterial);
    assert!(bench.window.state().as_ref().is_some_and(|w| w.messages().any(|text| text.starts_with("Copied"))));
    bench.workbench().session_mut().selection.objects = vec![keys[1].clone(), keys[2].clone()];
    ask(&mut bench, Command::PasteMaterial);
    let materials = bench.session().scene().materials.clone();
    for object in [1, 2] {
        let pasted = &materials[bench.session().scene().instances[object].material];
        let (expected, got) = (materials[count].base_color, pasted.base_color);
        assert_eq!((got, pasted.roughness), (expected, materials[count].roughness), "it looks like the copied one");
    }
    ask(&mut bench, Command::DuplicateMaterial);
    ask(&mut bench, Command::ApplyToSelected);
    let instances = bench.session().scene().instances.clone();
    assert_eq!(instances[1].material, instances[2].material);
    ask(&mut bench, Command::Isolate);
    let visible = |bench: &Bench| bench.session().scene().instances.iter().filter(|i| i.visible).count();
    assert_eq!(visible(&bench), 2);
    ask(&mut bench, Command::ShowAll);
    assert_eq!(visible(&bench), keys.len());
    ask(&mut bench, Command::Hide);
    assert_eq!(visible(&bench), keys.len() - 2);
    let expected = ["New material", "Paste material", "Duplicate material", "Isolate", "Show all", "Hide"];
    assert_eq!(labels(&bench), expected, "what changes nothing leaves no step");
    bench.workbench().session_mut().go_to(0);
    assert_eq!(bench.text(), start);
}

fn finishes() {
    let mut bench = bench("finish", Some("gallery:workbench"));
    let pick = |bench: &mut Bench, list: &str, entry: &str| {
        bench.click_role(Role::ComboBox, list);
        bench.click_role(Role::Button, entry);
    };
    let of = |bench: &Bench| {
        let material = &bench.session().scene().materials[0];
        Kind::ALL.map(|kind| finish::of(material, kind).map(|finish| finish.id.as_str()))
    };
    let start = bench.text();
    assert_eq!(of(&bench), [None, Some("none")]);
    pick(&mut bench, "Finish", "Hammered");
    assert_eq!(bench.session().scene().materials[0].micro_normal, micro_normal::Kind::Hammered);
    pick(&mut bench, "Coat", "Satin lacquer");
    assert_eq!(of(&bench), [Some("hammered"), Some("satin-lacquer")]);
    let document = bench.session().document().clone();
    assert_eq!(document.materials[0].value("micro-normal"), Some(ParamValue::Choice(3)));
    assert_eq!(document.materials[0].value("coat"), Some(ParamValue::Number(1.0)));
    pick(&mut bench, "Finish", "Mirror");
    assert_eq!(bench.session().scene().materials[0].micro_normal, micro_normal::Kind::None, "the dents are gone");
    assert_eq!(of(&bench), [Some("mirror"), Some("satin-lacquer")]);
    assert_eq!(labels(&bench), ["Finish", "Coat", "Finish"]);

    bench.slide("Roughness", 0.5);
    assert_eq!(of(&bench), [None, Some("satin-lacquer")]);
    let shown = bench.window.get_by_role_and_label(Role::ComboBox, "Finish");
    assert_eq!(egui_kittest::kittest::NodeT::accesskit_node(&shown).value().as_deref(), Some("custom"));
    for _ in 0..4 {
        bench.keys(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(bench.text(), start);
}

fn scene_panel() {
    let mut bench = bench("scene", Some("gallery:workbench"));
    let keys = bench.session().resolved().object_keys.clone();
    let names: Vec<String> = bench.session().scene().instances.iter().map(|i| i.name.clone()).collect();
    bench.click_role(Role::Button, "foot");
    assert_eq!(bench.session().selection.objects, ["foot"]);
    bench.window.get_by_role_and_label(Role::Button, "ring").click_modifiers(Modifiers::COMMAND);
    bench.window.run_steps(3);
    assert_eq!(bench.session().selection.objects, ["foot", "ring"]);
    bench.click_role(Role::Button, "foot");
    bench.window.get_by_role_and_label(Role::Button, "plinth").click_modifiers(Modifiers::SHIFT);
    bench.window.run_steps(3);
    assert_eq!(bench.session().selection.objects, keys[1..=4], "all between: {names:?}");

    bench.click("Hide foot");
    assert!(!bench.session().scene().instances[1].visible);
    bench.click("Show foot");
    assert!(bench.session().scene().instances[1].visible);

    bench.click_role(Role::Button, "foot");
    bench.keys(Modifiers::NONE, Key::F2);
    bench.window.get_by_label("Name of the object");
    bench.keys(Modifiers::COMMAND, Key::A);
    bench.window.event(eframe::egui::Event::Text("base".into()));
    bench.window.run_steps(2);
    bench.keys(Modifiers::NONE, Key::Enter);
    assert_eq!(bench.session().scene().instances[1].name, "base");
    assert_eq!(labels(&bench).last().map(String::as_str), Some("Rename"));

    let row = bench.window.get_by_role_and_label(Role::Button, "core").rect();
    bench.click("Material of base");
    let core = bench.session().document().materials.iter().position(|entry| entry.name == "core").expect("it is there");
    // Beside the row of the object of that name there is now the entry of the list that dropped down.
    let entry = bench.window.get_all_by_role_and_label(Role::Button, "core").find(|node| node.rect() != row);
    entry.expect("the list shows it").click();
    bench.window.run_steps(3);
    assert_eq!(bench.session().scene().instances[1].material, core);

    bench.window.get_by_label("Search the scene").focus();
    bench.window.run_steps(2);
    bench.window.event(eframe::egui::Event::Text("wall".into()));
    bench.window.run_steps(3);
    assert!(
        bench.window.query_by_label("Hide ring").is_none() && bench.window.query_by_label("Hide wall-left").is_some()
    );
}

fn history_panel() {
    let mut bench = bench("history", Some("gallery:workbench"));
    for exposure in [1.0, 2.0, 3.0] {
        let session = bench.workbench().session_mut();
        session.edit("Exposure", "", |document| document.view.exposure_ev = exposure);
        session.seal();
    }
    bench.workbench().show_panel(Pane::History);
    bench.window.run_steps(3);
    for (step, exposure) in [("Step 1, Exposure", 1.0), ("Step 3, Exposure", 3.0), ("Step 0, As opened", 0.0)] {
        bench.click(step);
        assert_eq!(bench.session().document().view.exposure_ev, exposure);
    }
    assert_eq!(bench.session().history().future().count(), 3);
}

fn palette() {
    let mut bench = bench("palette", Some("gallery:workbench"));
    bench.keys(Modifiers::COMMAND, Key::K);
    bench.window.event(eframe::egui::Event::Text("new mat".into()));
    bench.window.run_steps(2);
    bench.keys(Modifiers::NONE, Key::Enter);
    assert_eq!(labels(&bench), ["New material"]);
    assert!(bench.window.query_by_label("Find a command").is_none(), "it is closed");
    // A letter that is a shortcut is a letter here, and Escape does nothing.
    bench.workbench().session_mut().selection.objects = vec!["ring".into()];
    bench.keys(Modifiers::COMMAND, Key::K);
    bench.keys(Modifiers::NONE, Key::H);
    bench.keys(Modifiers::NONE, Key::Escape);
    assert_eq!(labels(&bench), ["New material"]);
    assert!(bench.window.query_by_label("Find a command").is_none());
}

fn keys() {
    let mut bench = bench("keys", Some("gallery:workbench"));
    bench.workbench().session_mut().selection.objects = vec!["ring".into()];
    bench.keys(Modifiers::COMMAND, Key::Plus);
    bench.keys(Modifiers::COMMAND, Key::Equals);
    assert_eq!(bench.workbench().preferences().ui_scale, 1.2);
    bench.keys(Modifiers::COMMAND, Key::Num0);
    assert_eq!(bench.workbench().preferences().ui_scale, 1.0);
    bench.keys(Modifiers::NONE, Key::H);
    assert_eq!(labels(&bench), ["Hide"]);
    bench.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::H);
    assert_eq!(labels(&bench), ["Hide", "Show all"]);
    // Shift+Ctrl+Z is redo and never undo.
    bench.keys(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(labels(&bench), ["Hide", "Show all"]);
    bench.window.get_by_label("Search the scene").focus();
    bench.window.run_steps(2);
    bench.keys(Modifiers::NONE, Key::H);
    assert_eq!(labels(&bench), ["Hide", "Show all"], "a letter in a field is a letter");
    bench.keys(Modifiers::NONE, Key::F1);
    bench.window.get_by_label("Mouse in the viewport");
}

fn layout() {
    let mut bench = bench("layout", Some("gallery:workbench"));
    assert!(bench.window.query_by_label("Reflectance").is_some());
    bench.menu("View", "Reflectance panel");
    bench.keys(Modifiers::NONE, Key::Escape);
    let stored = bench.workbench().preferences().layout.clone();
    assert!(stored.is_some());
    bench.until("it is written", |workbench| !workbench.is_busy());
    *bench.window.state_mut() = None;
    bench.window.run_steps(1);
    bench.until("it is open again", |workbench| !workbench.is_busy());
    assert_eq!(bench.workbench().preferences().layout, stored);
    assert!(bench.window.query_by_label("Reflectance").is_none(), "the panel is still hidden");
    ask(&mut bench, Command::ResetLayout);
    assert_eq!(bench.workbench().preferences().layout, None);
}

fn errors() {
    let mut bench = bench("errors", Some("gallery:workbench"));
    for _ in 0..5 {
        bench.workbench().ask(Request::Error("paint.png: is no picture; use a PNG".into()));
        bench.window.run_steps(2);
    }
    let said: Vec<_> = bench.window.get_all_by_label("paint.png: is no picture; use a PNG").collect();
    assert_eq!(said.len(), 1);
    bench.click("Close message");
    assert_eq!(bench.workbench().messages().count(), 0);
}
