//! A workbench on a flat stage with a folder of its own, and hands for it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use burnish::window::{Options, Session, Stage, Workbench};
use burnish_tests::scratch_folder;
use eframe::egui::{self, Key, Modifiers, PointerButton, Pos2, Role};
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, HarnessBuilder};

/// Longest wait for a thread, far beyond what it needs.
const PATIENCE: Duration = Duration::from_secs(120);

pub struct Bench {
    pub window: Harness<'static, Option<Workbench>>,
    pub folder: PathBuf,
}

impl Drop for Bench {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// How the window is made.
pub struct Setup<'a> {
    /// Unique among the tests.
    pub name: &'a str,
    /// The start page when absent.
    pub scene: Option<&'a str>,
    pub size: [f32; 2],
    /// Pixels are wanted too.
    pub drawn: bool,
}

impl Bench {
    pub fn new(setup: Setup) -> Bench {
        let folder = scratch_folder(&format!("ui-{}", setup.name));
        let scene = setup.scene.map(str::to_string);
        let options = Options { scene, data_folder: Some(folder.join("user")), ..Options::default() };
        let show = move |ui: &mut egui::Ui, state: &mut Option<Workbench>| {
            state.get_or_insert_with(|| Workbench::new(ui.ctx(), options.clone(), Stage::Flat)).ui(ui);
        };
        let builder: HarnessBuilder<Option<Workbench>> = Harness::builder().with_size(setup.size);
        let builder = if setup.drawn { builder.wgpu() } else { builder };
        let mut bench = Bench { window: builder.build_ui_state(show, None), folder };
        bench.until("it has opened", |workbench| !workbench.is_busy());
        bench
    }

    pub fn workbench(&mut self) -> &mut Workbench {
        self.window.state_mut().as_mut().expect("it was drawn")
    }

    pub fn session(&self) -> &Session {
        self.window.state().as_ref().expect("it was drawn").session()
    }

    /// The document as it would be saved, paths and all.
    pub fn text(&self) -> String {
        self.session().document().to_text(Path::new("/"))
    }

    /// Draws frames until something is so.
    #[track_caller]
    pub fn until(&mut self, what: &str, reached: impl Fn(&Workbench) -> bool) {
        let start = Instant::now();
        loop {
            self.window.run_steps(2);
            if self.window.state().as_ref().is_some_and(&reached) {
                return self.window.run_steps(2);
            }
            let said: Vec<&str> = self.window.state().iter().flat_map(Workbench::messages).collect();
            assert!(start.elapsed() < PATIENCE, "never: {what}; messages: {said:?}");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    #[track_caller]
    pub fn until_shown(&mut self, label: &str) {
        let start = Instant::now();
        while self.window.query_all_by_label(label).next().is_none() {
            assert!(start.elapsed() < PATIENCE, "`{label}` was never shown");
            std::thread::sleep(Duration::from_millis(5));
            self.window.run_steps(1);
        }
    }

    #[track_caller]
    pub fn click(&mut self, label: &str) {
        self.window.get_by_label(label).click();
        self.window.run_steps(3);
    }

    #[track_caller]
    pub fn click_role(&mut self, role: Role, label: &str) {
        self.window.get_by_role_and_label(role, label).click();
        self.window.run_steps(3);
    }

    /// Opens a menu of the bar, which comes before tabs of the same name.
    #[track_caller]
    pub fn open_menu(&mut self, menu: &str) {
        self.window.get_all_by_role_and_label(Role::Button, menu).next().expect("it is in the bar").click();
        self.window.run_steps(3);
    }

    /// Picks an entry of a menu.
    #[track_caller]
    pub fn menu(&mut self, menu: &str, entry: &str) {
        self.open_menu(menu);
        self.window
            .get_by(|node| node.label().is_some_and(|label| label == entry || label.starts_with(&format!("{entry} "))))
            .click();
        self.window.run_steps(3);
    }

    pub fn keys(&mut self, modifiers: Modifiers, key: Key) {
        self.window.key_press_modifiers(modifiers, key);
        self.window.run_steps(3);
    }

    /// Sets a slider.
    #[track_caller]
    pub fn slide(&mut self, label: &str, value: f64) {
        self.window.get_by_role_and_label(Role::Slider, label).set_value_accesskit(value);
        self.window.run_steps(3);
    }

    /// Drags with the left button, in two moves.
    pub fn drag(&mut self, from: Pos2, to: Pos2) {
        let press = |pressed, pos| {
            let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
            egui::Event::PointerButton { pos, button, pressed, modifiers }
        };
        self.window.hover_at(from);
        self.window.event(press(true, from));
        self.window.run_steps(1);
        for share in [0.5, 1.0] {
            self.window.hover_at(from.lerp(to, share));
            self.window.run_steps(1);
        }
        self.window.event(press(false, to));
        self.window.run_steps(3);
    }

    /// Puts a path into the open dialog and accepts it.
    #[track_caller]
    pub fn enter_path(&mut self, path: &Path) {
        self.window.get_by_role_and_label(Role::TextInput, "Path").focus();
        self.window.run_steps(2);
        self.window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.window.run_steps(1);
        self.window.get_by_role_and_label(Role::TextInput, "Path").type_text(&path.to_string_lossy());
        self.window.run_steps(2);
        self.window.key_press(Key::Enter);
        self.window.run_steps(3);
    }

    pub fn drop_file(&mut self, path: &Path) {
        let file: egui::DroppedFileHandle = Arc::new(Dropped(path.into()));
        self.window.input_mut().dropped_files.push(file);
        self.window.run_steps(3);
    }
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
