//! Everything that is shown, put together: menus, docked panels, what panels ask for.

use std::path::PathBuf;

use burnish_core::document;
use eframe::egui;
use egui_tiles::{Container, Linear, LinearDir, Tiles, Tree};

use super::commands::{Command, Menu, TABLE};
use super::files::Files;
use super::panel::{Context, Docked, Pane, Panels, StartPage, StatusLine, assign};
use super::preferences::Preferences;
use super::request::{Request, Requests};
use super::session::Session;
use super::stage::Stage;
use super::thumbnails::{self, Thumbnails};
use super::user_presets::{self, UserPresets};

/// How the window starts.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Model, `gallery:NAME` or document; the start page when absent.
    pub scene: Option<String>,
    /// HDRI instead of the scene's.
    pub environment: Option<PathBuf>,
    /// Take up the newest recovery file at once.
    pub recover: bool,
    /// Folder for preferences, recovery files, presets and thumbnails instead of the user's.
    pub data_folder: Option<PathBuf>,
}

/// The workbench.
pub struct Workbench {
    session: Session,
    preferences: Preferences,
    stage: Stage,
    panels: Panels,
    tree: Tree<Pane>,
    start: Option<StartPage>,
    status: StatusLine,
    requests: Requests,
    files: Files,
    own: UserPresets,
    thumbnails: Thumbnails,
}

impl Workbench {
    /// The workbench as it is at first.
    pub fn new(_ctx: &egui::Context, options: Options, stage: Stage) -> Workbench {
        let scene = options.scene.clone().unwrap_or_else(|| document::DEFAULT_SCENE.into());
        let opened =
            document::open(&scene).unwrap_or_else(|_| document::reload(Default::default(), &Default::default()));
        Workbench {
            session: Session::new(opened, None),
            preferences: Preferences::default(),
            stage,
            panels: Panels::default(),
            tree: default_layout(),
            start: options.scene.is_none().then(StartPage::default),
            status: StatusLine::default(),
            requests: Requests::new(),
            files: Files::default(),
            own: UserPresets::new(user_presets::folder(options.data_folder.as_deref())),
            thumbnails: Thumbnails::new(thumbnails::folder(options.data_folder.as_deref())),
        }
    }

    /// What is open.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// What is open, for tests that edit beside the panels.
    pub fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    /// The source of the picture.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// The source of the picture, for trials of its faults.
    pub fn stage_mut(&mut self) -> &mut Stage {
        &mut self.stage
    }

    /// Draws everything and then does what was asked for.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.session.now_secs = ui.input(|input| input.time);
        self.shortcuts(ui);
        egui::Panel::top("menu").show(ui, |ui| self.menu_ui(ui));
        let Workbench { session, preferences, stage, panels, tree, start, status, requests, files, own, thumbnails } =
            self;
        if let Some(fault) = thumbnails.frame(ui.ctx(), stage.passes()) {
            requests.push(Request::Error(fault));
        }
        for preset in own.frame(ui.ctx(), requests) {
            requests.push(Request::AssignPreset { preset, materials: session.selected_materials() });
        }
        let mut context = Context { session, preferences, stage, requests, own, thumbnails };
        egui::Panel::bottom("status").show(ui, |ui| status.ui(ui, &mut context));
        egui::CentralPanel::no_frame().show(ui, |ui| match start {
            Some(page) => page.ui(ui, &mut context),
            None => tree.ui(&mut Docked { panels, context: &mut context }, ui),
        });
        files.frame(ui, session, preferences, requests);
        for request in std::mem::take(&mut self.requests) {
            self.fulfil(request, ui.ctx());
        }
    }

    /// Fulfils a wish of a panel.
    fn fulfil(&mut self, request: Request, ctx: &egui::Context) {
        match request {
            Request::Command(command) => self.command(command, ctx),
            Request::ImportPreset(path) => self.own.import(path),
            Request::AssignPreset { preset, materials } => {
                if let Err(fault) = assign(&mut self.session, &self.own, &preset, &materials) {
                    self.requests.push(Request::Error(fault));
                }
            }
            Request::Notice(_) | Request::Error(_) => {}
            about_files => self.files.fulfil(about_files, &mut self.session, &mut self.preferences, ctx),
        }
    }

    fn command(&mut self, command: Command, ctx: &egui::Context) {
        if !command.is_enabled(&self.session) {
            return;
        }
        match command {
            Command::Undo => _ = self.session.undo(),
            Command::Redo => _ = self.session.redo(),
            Command::ResetLayout => self.tree = default_layout(),
            Command::Start => self.start = Some(StartPage::default()),
            Command::Open
            | Command::LoadEnvironment
            | Command::Save
            | Command::SaveAs
            | Command::SaveImage
            | Command::Quit => self.files.command(command, &mut self.session, &mut self.preferences, ctx),
            Command::Frame
            | Command::FrameAll
            | Command::ViewFront
            | Command::ViewRight
            | Command::ViewTop
            | Command::Orthographic
            | Command::SaveCamera => self.panels.viewport.command(command, &mut self.session),
            Command::CopyMaterial
            | Command::PasteMaterial
            | Command::NewMaterial
            | Command::DuplicateMaterial
            | Command::ApplyToAll
            | Command::ApplyToSelected
            | Command::Hide
            | Command::Isolate
            | Command::ShowAll => super::edits::command(command, &mut self.session),
            Command::Palette
            | Command::Shortcuts
            | Command::ScaleUp
            | Command::ScaleDown
            | Command::ScaleReset
            | Command::Theme => {}
        }
    }

    /// Commands whose keys were pressed; those without a modifier only while no text is edited.
    fn shortcuts(&mut self, ui: &egui::Ui) {
        let typing = ui.ctx().egui_wants_keyboard_input();
        for entry in TABLE {
            let Some(shortcut) = entry.shortcut else { continue };
            let plain = shortcut.modifiers.is_none() && shortcut.logical_key != egui::Key::F1;
            if !(plain && typing) && ui.input_mut(|input| input.consume_shortcut(&shortcut)) {
                self.requests.push(Request::Command(entry.command));
            }
        }
    }

    fn menu_ui(&mut self, ui: &mut egui::Ui) {
        egui::MenuBar::new().ui(ui, |ui| {
            for menu in Menu::ALL {
                ui.menu_button(menu.title(), |ui| {
                    for entry in TABLE.iter().filter(|entry| entry.menu == menu) {
                        let mut button = egui::Button::new(entry.title);
                        if let Some(shortcut) = &entry.shortcut {
                            button = button.shortcut_text(ui.ctx().format_shortcut(shortcut));
                        }
                        let enabled = entry.command.is_enabled(&self.session);
                        if ui.add_enabled(enabled, button).on_hover_text(entry.help).clicked() {
                            self.requests.push(Request::Command(entry.command));
                        }
                    }
                });
            }
        });
    }
}

/// The viewport in the middle, objects and metals left, the material right.
fn default_layout() -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let mut tabs = |panes: &[Pane]| {
        let children = panes.iter().map(|pane| tiles.insert_pane(*pane)).collect();
        tiles.insert_tab_tile(children)
    };
    let (objects, metals) = (tabs(&[Pane::Scene, Pane::History]), tabs(&[Pane::Presets]));
    let picture = tabs(&[Pane::Viewport]);
    let (material, plot) = (tabs(&[Pane::Material, Pane::Environment]), tabs(&[Pane::Reflectance]));
    let mut column = |upper, lower, share: f32| {
        let mut linear = Linear::new(LinearDir::Vertical, vec![upper, lower]);
        linear.shares.set_share(upper, share);
        tiles.insert_container(Container::Linear(linear))
    };
    let (left, right) = (column(objects, metals, 0.6), column(material, plot, 2.2));
    let mut row = Linear::new(LinearDir::Horizontal, vec![left, picture, right]);
    row.shares.set_share(left, 0.42);
    row.shares.set_share(picture, 1.5);
    row.shares.set_share(right, 0.55);
    let root = tiles.insert_container(Container::Linear(row));
    Tree::new(egui::Id::unique("layout"), root, tiles)
}
