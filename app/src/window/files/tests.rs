//! The window driven by labels, on a flat stage: what happens to files.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use burnish_core::document::Document;
use eframe::egui::{self, Key, ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

use crate::window::{Command, Options, Request, Session, Stage, Workbench};

/// A triangle with a red material; `NAME` is replaced.
const TRIANGLE: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"leaf"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"name":"NAME"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

/// Longest wait for a thread, far beyond what it needs.
const PATIENCE: Duration = Duration::from_secs(60);

struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Scratch {
        let folder = std::env::temp_dir().join(format!("burnish-window-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        Scratch(folder)
    }

    fn model(&self, file: &str, material: &str) -> PathBuf {
        let path = self.0.join(file);
        std::fs::write(&path, TRIANGLE.replace("NAME", material)).unwrap();
        path
    }

    fn map(&self, file: &str) -> PathBuf {
        let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n".to_vec();
        bytes.extend([128, 128, 128, 129].repeat(16 * 8));
        let path = self.0.join(file);
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

type Window = Harness<'static, Option<Workbench>>;

fn window(folder: &Scratch, scene: Option<&Path>) -> Window {
    let scene = scene.map(|path| path.to_string_lossy().into_owned());
    let options = Options { scene, data_folder: Some(folder.0.join("user")), ..Options::default() };
    let show = move |ui: &mut egui::Ui, state: &mut Option<Workbench>| {
        state.get_or_insert_with(|| Workbench::new(ui.ctx(), options.clone(), Stage::Flat)).ui(ui);
    };
    let mut window = Harness::builder().with_size([1100.0, 700.0]).build_ui_state(show, None);
    until(&mut window, |workbench| !workbench.is_busy());
    window
}

#[track_caller]
fn until(window: &mut Window, reached: impl Fn(&Workbench) -> bool) {
    let start = Instant::now();
    loop {
        window.run_steps(2);
        if window.state().as_ref().is_some_and(&reached) {
            return window.run_steps(2);
        }
        assert!(start.elapsed() < PATIENCE, "it never came to this");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[track_caller]
fn until_shown(window: &mut Window, label: &str) {
    let start = Instant::now();
    while window.query_by_label(label).is_none() {
        assert!(start.elapsed() < PATIENCE, "`{label}` was never shown");
        std::thread::sleep(Duration::from_millis(10));
        window.run_steps(1);
    }
}

fn session(window: &Window) -> &Session {
    window.state().as_ref().expect("it was drawn").session()
}

fn edit(window: &mut Window) {
    let session = window.state_mut().as_mut().expect("it was drawn").session_mut();
    session.edit("Exposure", "", |document| document.view.exposure_ev += 1.0);
    window.run_steps(2);
}

fn keys(window: &mut Window, modifiers: egui::Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(3);
}

fn click(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    window.run_steps(3);
}

/// Puts a path into the open dialog and accepts it.
fn enter_path(window: &mut Window, path: &Path) {
    window.get_by_role_and_label(egui::Role::TextInput, "Path").focus();
    window.run_steps(2);
    window.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    window.run_steps(1);
    window.get_by_role_and_label(egui::Role::TextInput, "Path").type_text(&path.to_string_lossy());
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

#[test]
fn a_model_is_opened_by_its_path_saved_and_opened_again() {
    let folder = Scratch::new("open");
    let model = folder.model("leaf.gltf", "red");
    let mut window = window(&folder, None);
    window.get_by_label("Default workbench");
    enter_path(&mut window, &model);
    until(&mut window, |workbench| workbench.session().title() == "leaf");
    assert!(!session(&window).is_dirty());

    edit(&mut window);
    assert!(session(&window).is_dirty());
    keys(&mut window, egui::Modifiers::COMMAND, Key::S);
    let saved = folder.0.join("mine");
    enter_path(&mut window, &saved);
    let saved = saved.with_extension("burnish");
    until(&mut window, |workbench| workbench.session().path.as_ref() == Some(&saved));
    assert!(!session(&window).is_dirty());
    assert_eq!(Document::read(&saved).unwrap(), **session(&window).document());

    let kept = session(&window).document().clone();
    window.state_mut().as_mut().unwrap().ask(Request::OpenScene(saved.to_string_lossy().into_owned()));
    until(&mut window, |workbench| !workbench.is_busy() && workbench.session().history().past().is_empty());
    assert_eq!(*session(&window).document(), kept);
    let recent = &crate::window::Preferences::read(&folder.0.join("user/preferences.json")).0.recent;
    assert!(recent.iter().any(|path| path.ends_with("mine.burnish")), "{recent:?}");
}

#[test]
fn a_file_that_cannot_be_read_leaves_the_document_as_it_was() {
    let folder = Scratch::new("broken");
    let broken = folder.0.join("broken.glb");
    std::fs::write(&broken, "<html>").unwrap();
    let mut window = window(&folder, Some(&folder.model("leaf.gltf", "red")));
    edit(&mut window);
    let before = session(&window).document().clone();
    window.state_mut().as_mut().unwrap().ask(Request::LoadEnvironment(broken.clone()));
    until(&mut window, |workbench| !workbench.is_busy());
    assert!(Arc::ptr_eq(&before, session(&window).document()));
    assert_eq!(session(&window).history().past().len(), 1);
}

#[test]
fn unsaved_changes_are_asked_about() {
    let folder = Scratch::new("guard");
    let other = folder.model("other.gltf", "blue");
    let mut window = window(&folder, Some(&folder.model("leaf.gltf", "red")));
    edit(&mut window);
    let open = |window: &mut Window| {
        window.state_mut().as_mut().unwrap().ask(Request::OpenScene(other.to_string_lossy().into_owned()));
        window.run_steps(3);
    };
    open(&mut window);
    click(&mut window, "Cancel");
    assert_eq!(session(&window).title(), "leaf");

    // Closing the window asks too, and saving goes on to close it.
    window.input_mut().viewports.entry(ViewportId::ROOT).or_default().events.push(ViewportEvent::Close);
    window.step();
    let said = |window: &Window, command: &ViewportCommand| {
        window.output().viewport_output.values().any(|output| output.commands.contains(command))
    };
    assert!(said(&window, &ViewportCommand::CancelClose));
    window.run_steps(3);
    click(&mut window, "Save");
    enter_path(&mut window, &folder.0.join("leaf.burnish"));
    until(&mut window, Workbench::is_ending);
    assert!(folder.0.join("leaf.burnish").is_file());
    assert_eq!(std::fs::read_dir(folder.0.join("user/recovery")).map_or(0, Iterator::count), 0);
}

/// A window with a saved document that has an edit, and the path of the document.
fn window_to_save(folder: &Scratch) -> (Window, PathBuf) {
    let model = folder.model("leaf.gltf", "red");
    let saved = folder.0.join("leaf.burnish");
    burnish_core::document::open(&model.to_string_lossy()).unwrap().document.save(&saved).unwrap();
    let mut window = window(folder, Some(&saved));
    edit(&mut window);
    (window, saved)
}

#[test]
fn a_save_lands_before_the_next_document_does() {
    let folder = Scratch::new("save-open");
    let other = folder.model("other.gltf", "blue");
    let (mut window, saved) = window_to_save(&folder);
    let edited = session(&window).document().clone();
    let workbench = window.state_mut().as_mut().unwrap();
    workbench.ask(Request::Command(Command::Save));
    workbench.ask(Request::OpenScene(other.to_string_lossy().into_owned()));
    until(&mut window, |workbench| !workbench.is_busy() && workbench.session().title() == "other");
    assert_eq!(Document::read(&saved).unwrap(), *edited);
    assert_eq!(session(&window).path, None, "the other document was never saved");
    assert!(!session(&window).is_dirty());
}

#[test]
fn quitting_waits_for_all_saves() {
    let folder = Scratch::new("save-quit");
    let (mut window, saved) = window_to_save(&folder);
    let workbench = window.state_mut().as_mut().unwrap();
    for command in [Command::Save, Command::Save, Command::Quit] {
        workbench.ask(Request::Command(command));
    }
    // The first save has begun; the second takes this edit along.
    window.step();
    edit(&mut window);
    until(&mut window, Workbench::is_ending);
    assert_eq!(Document::read(&saved).unwrap(), **session(&window).document());
}

#[test]
fn discarding_goes_on() {
    let folder = Scratch::new("discard");
    let other = folder.model("other.gltf", "blue");
    let mut window = window(&folder, Some(&folder.model("leaf.gltf", "red")));
    edit(&mut window);
    window.state_mut().as_mut().unwrap().ask(Request::OpenScene(other.to_string_lossy().into_owned()));
    window.run_steps(3);
    click(&mut window, "Discard");
    until(&mut window, |workbench| workbench.session().title() == "other");
    assert!(!session(&window).is_dirty());
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

#[test]
fn dropped_files_open_light_and_ask_for_a_slot() {
    let folder = Scratch::new("drop");
    let (model, map) = (folder.model("leaf.gltf", "red"), folder.map("sky.hdr"));
    let mut window = window(&folder, None);
    let drop = |window: &mut Window, paths: &[&Path]| {
        let files = paths.iter().map(|path| Arc::new(Dropped(path.to_path_buf())) as egui::DroppedFileHandle);
        window.input_mut().dropped_files.extend(files);
        window.step();
        window.run_steps(2);
    };
    drop(&mut window, &[&map, &model]);
    until(&mut window, |workbench| workbench.session().document().environment.source.is_some());
    assert_eq!(session(&window).title(), "leaf");
    assert_eq!(session(&window).history().past().last().unwrap().label, "Load HDRI");

    let picture = folder.0.join("steel.png");
    let flat = burnish_core::picture::Picture::filled(2, 2, glam::Vec4::ONE);
    burnish_core::file::write_picture(&flat, &picture, Default::default(), 0.0).unwrap();
    drop(&mut window, &[&picture]);
    click(&mut window, "Metallic roughness");
    until(&mut window, |workbench| !workbench.is_busy() && workbench.session().history().past().len() == 2);
    assert_eq!(session(&window).document().texture_files(), [picture.to_string_lossy()]);
}

#[test]
fn a_changed_model_is_offered_and_keeps_what_was_assigned() {
    let folder = Scratch::new("changed");
    let model = folder.model("leaf.gltf", "red");
    let mut window = window(&folder, Some(&model));
    let gold = burnish_core::material::preset::find("Au").unwrap();
    let workbench = window.state_mut().as_mut().unwrap();
    workbench.session_mut().edit("Assign", "red", |document| document.assign_preset(0, &gold, Default::default()));
    let text = TRIANGLE.replace("[{\"name\":\"NAME\"}]", "[{\"name\":\"red\"},{\"name\":\"green\"}]");
    std::fs::write(&model, text).unwrap();
    until_shown(&mut window, "Reload leaf.gltf");
    click(&mut window, "Reload leaf.gltf");
    until(&mut window, |workbench| workbench.session().document().materials.len() == 2);
    assert!(window.query_by_label("Reload leaf.gltf").is_none());
    assert_eq!(session(&window).document().materials[0].preset.as_ref().unwrap().id, "Au");
    assert_eq!(session(&window).history().past().last().unwrap().label, "Reload");
}

#[test]
fn missing_files_are_relinked_together() {
    let folder = Scratch::new("missing");
    let (model, map) = (folder.model("leaf.gltf", "red"), folder.map("sky.hdr"));
    let mut document = burnish_core::document::open(&model.to_string_lossy()).unwrap().document;
    document.environment.source = Some(map.to_string_lossy().into_owned());
    let saved = folder.0.join("leaf.burnish");
    document.save(&saved).unwrap();
    let moved = folder.0.join("moved");
    std::fs::create_dir(&moved).unwrap();
    std::fs::rename(&model, moved.join("leaf.gltf")).unwrap();
    std::fs::rename(&map, moved.join("sky.hdr")).unwrap();

    let mut window = window(&folder, Some(&saved));
    assert_eq!(session(&window).missing.len(), 2);
    window.get_by_label("Relink sky.hdr");
    click(&mut window, "Relink leaf.gltf");
    enter_path(&mut window, &moved.join("leaf.gltf"));
    until(&mut window, |workbench| workbench.session().missing.is_empty());
    let document = session(&window).document();
    assert!(document.scene.contains("moved") && document.environment.source.as_ref().unwrap().contains("moved"));
    assert_eq!(session(&window).history().past().len(), 1, "one step");
    assert!(session(&window).is_dirty());
}

#[test]
fn what_a_crash_left_is_offered_and_comes_back() {
    let folder = Scratch::new("crash");
    let model = folder.model("leaf.gltf", "red");
    let edited = {
        let mut crashed = window(&folder, Some(&model));
        edit(&mut crashed);
        let document = session(&crashed).document().clone();
        let workbench = crashed.state_mut().as_mut().unwrap();
        workbench.ask(Request::WriteRecovery);
        crashed.run_steps(2);
        assert!(crashed.state().as_ref().unwrap().recovery_kept());
        document
    };
    let mut window = window(&folder, None);
    // The thread of the window before lets go of its lock a moment later.
    let start = Instant::now();
    while window.query_by_label("Recover").is_none() {
        assert!(start.elapsed() < PATIENCE, "it was not offered");
        window = self::window(&folder, None);
    }
    click(&mut window, "Recover");
    until(&mut window, |workbench| !workbench.is_busy() && workbench.session().title() == "leaf");
    assert_eq!(*session(&window).document(), edited);
    assert!(session(&window).is_dirty());
    assert!(window.query_by_label("Default workbench").is_none(), "the start page is gone");
}

#[test]
fn the_recovery_file_follows_the_edits_and_goes_with_the_save() {
    let folder = Scratch::new("autosave");
    let mut document =
        burnish_core::document::open(&folder.model("leaf.gltf", "red").to_string_lossy()).unwrap().document;
    document.view.exposure_ev = 0.5;
    let saved = folder.0.join("leaf.burnish");
    document.save(&saved).unwrap();
    let mut window = window(&folder, Some(&saved));
    let count = || {
        let entries = std::fs::read_dir(folder.0.join("user/recovery")).into_iter().flatten().flatten();
        entries.filter(|entry| entry.path().extension().is_some_and(|e| e == "json")).count()
    };
    assert_eq!(count(), 0);
    edit(&mut window);
    until(&mut window, |_| count() == 1);
    keys(&mut window, egui::Modifiers::COMMAND, Key::S);
    until(&mut window, |workbench| !workbench.session().is_dirty() && count() == 0);
    assert_eq!(Document::read(&saved).unwrap().view.exposure_ev, 1.5);
}
