//! Everything that is shown, put together: menus, docked panels, what panels ask for.

mod acts;
mod menu;

use std::path::PathBuf;

use burnish_core::document;
use eframe::egui::{self, Event};
use egui_tiles::Tree;

use super::aids::Aids;
use super::chart::Chart;
use super::compare::Compare;
use super::files::{Files, Folders};
use super::palette::{Chosen, Palette};
use super::panel::{Context, Docked, Pane, Panels, StartPage, StatusLine};
use super::preferences::Preferences;
use super::preparations::Preparations;
use super::reference::Reference;
use super::request::{Request, Requests};
use super::scope::Scope;
use super::session::Session;
use super::stage::Stage;
use super::table_import::TableImport;
use super::thumbnails::Thumbnails;
use super::toasts::Toasts;
use super::user_lightings::UserLightings;
use super::user_presets::{Arrival, UserPresets};
use super::{layout, lights, shortcuts, theme};

/// Frames of the viewport's picture after which other pictures may be drawn.
const RESTING_FRAMES: u32 = 4;

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
    reference: Reference,
    preparations: Preparations,
    compare: Compare,
    chart: Chart,
    aids: Aids,
    scope: Scope,
    panels: Panels,
    tree: Tree<Pane>,
    /// The layout differs from that of the preferences.
    rearranged: bool,
    start: Option<StartPage>,
    status: StatusLine,
    requests: Requests,
    files: Files,
    own: UserPresets,
    lightings: UserLightings,
    tables: TableImport,
    thumbnails: Thumbnails,
    toasts: Toasts,
    palette: Option<Palette>,
    shortcut_page: bool,
}

impl Workbench {
    /// The workbench as it is at first.
    pub fn new(ctx: &egui::Context, options: Options, stage: Stage) -> Workbench {
        let start = options.scene.is_none() && !options.recover;
        // Scenes made by code are there at once; files are read by another thread while the default one is shown.
        let scene = options.scene.as_deref().filter(|scene| scene.starts_with("gallery:"));
        let made = scene.and_then(|scene| document::open(scene).ok());
        let options = Options { scene: options.scene.filter(|_| made.is_none()), ..options };
        let opened = made.or_else(|| document::open(document::DEFAULT_SCENE).ok());
        let opened = opened.unwrap_or_else(|| document::reload(Default::default(), &Default::default()));
        let (files, preferences) = Files::new(&options, &stage, ctx);
        let store = files.prepared_store();
        theme::install(ctx);
        theme::apply(ctx, &preferences);
        Workbench {
            session: Session::new(opened, None),
            tree: preferences.layout.as_ref().and_then(layout::restore).unwrap_or_else(layout::initial),
            rearranged: false,
            preferences,
            stage,
            reference: Reference::default(),
            preparations: Preparations::new(store.clone()),
            compare: Compare::new(store),
            chart: Chart::new(files.folders().map(Folders::bench)),
            aids: Aids::default(),
            scope: Scope::default(),
            panels: Panels::default(),
            start: start.then(StartPage::default),
            status: StatusLine::default(),
            requests: Requests::new(),
            own: UserPresets::new(files.folders().map(Folders::presets)),
            lightings: UserLightings::new(files.folders().map(Folders::lightings)),
            thumbnails: Thumbnails::new(files.folders().map(Folders::thumbnails)),
            files,
            tables: TableImport::default(),
            toasts: Toasts::default(),
            palette: None,
            shortcut_page: false,
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

    /// Asks for something as a panel would; it is fulfilled in the next frame.
    pub fn ask(&mut self, request: Request) {
        self.requests.push(request);
    }

    /// The window was told to close, with nothing left to ask.
    pub fn is_ending(&self) -> bool {
        self.files.is_ending()
    }

    /// The last [`Request::WriteRecovery`] put the document on the disk; false before the first.
    pub fn recovery_kept(&self) -> bool {
        self.files.recovery_kept()
    }

    /// Another thread reads or writes a file or draws small pictures.
    pub fn is_busy(&self) -> bool {
        self.files.is_busy()
            || self.tables.is_busy()
            || self.thumbnails.is_drawing()
            || self.compare.is_busy()
            || self.preparations.is_busy()
            || self.chart.is_busy()
            || self.scope.is_busy()
            || self.lightings.is_busy()
    }

    /// Goes over to another session, away from the start page.
    pub fn set_session(&mut self, session: Session) {
        self.session = session;
        self.start = None;
        self.forget_light();
    }

    /// What was prepared for another document lights none after it.
    fn forget_light(&mut self) {
        self.preparations.forget();
        self.compare.forget();
        self.panels.forget();
    }

    /// The user's choices.
    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// The user's choices, for those who make them beside the window.
    pub fn preferences_mut(&mut self) -> &mut Preferences {
        &mut self.preferences
    }

    /// Shows a panel, before the other tabs of its place.
    pub fn show_panel(&mut self, pane: Pane) {
        layout::show(&mut self.tree, pane);
        self.rearranged = true;
    }

    /// Puts a panel away.
    pub fn hide_panel(&mut self, pane: Pane) {
        if layout::is_shown(&self.tree, pane) {
            layout::toggle(&mut self.tree, pane);
            self.rearranged = true;
        }
    }

    /// Messages that are shown.
    pub fn messages(&self) -> impl Iterator<Item = &str> {
        self.toasts.texts()
    }

    /// The source of the picture.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// The path-traced reference.
    pub fn reference(&self) -> &Reference {
        &self.reference
    }

    /// Two pictures.
    pub fn compare(&self) -> &Compare {
        &self.compare
    }

    /// Time against error.
    pub fn chart(&self) -> &Chart {
        &self.chart
    }

    /// How the picture is looked at, for those who choose it beside the window.
    pub fn aids_mut(&mut self) -> &mut Aids {
        &mut self.aids
    }

    /// How the picture is looked at.
    pub fn aids(&self) -> &Aids {
        &self.aids
    }

    /// Time against error, for tests that bring records of their own.
    pub fn chart_mut(&mut self) -> &mut Chart {
        &mut self.chart
    }

    /// The source of the picture, for trials of its faults.
    pub fn stage_mut(&mut self) -> &mut Stage {
        &mut self.stage
    }

    /// Draws everything and then does what was asked for.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        theme::apply(ui.ctx(), &self.preferences);
        self.session.now_secs = ui.input(|input| input.time);
        let revision = self.session.revision;
        self.chart.frame();
        if ui.input(is_used) {
            self.note_input();
        }
        self.shortcuts(ui);
        egui::Panel::top("menu").show(ui, |ui| self.menu_ui(ui));
        let Workbench {
            session,
            preferences,
            stage,
            reference,
            preparations,
            compare,
            chart,
            aids,
            scope,
            panels,
            tree,
            start,
            status,
            requests,
            files,
            own,
            lightings,
            tables,
            thumbnails,
            ..
        } = self;
        preparations.draw_probes_by(stage.raster());
        preparations.follow(session.layers(), session.scene(), ui.ctx());
        let rests = reference.shown().is_some()
            || stage.status().is_none_or(|status| status.drawn.settled || status.drawn.frames >= RESTING_FRAMES);
        if let Some(fault) = thumbnails.frame(ui.ctx(), stage.passes(), rests) {
            requests.push(Request::Error(fault));
        }
        for Arrival { key, assign } in own.frame(ui.ctx(), requests) {
            panels.presets.reveal(&key);
            if assign {
                requests.push(Request::AssignPreset { preset: key, materials: session.selected_materials() });
            }
        }
        if let Some(preset) = lightings.frame(ui.ctx(), requests) {
            lights::apply(session, &preset);
        }
        aids.follow(session.scene());
        let mut context = Context {
            session,
            preferences,
            stage,
            reference,
            preparations,
            compare,
            chart,
            aids,
            scope,
            requests,
            own,
            lightings,
            thumbnails,
        };
        egui::Panel::bottom("status").show(ui, |ui| status.ui(ui, &mut context));
        if start.is_none() {
            files.banner_ui(ui, &mut context);
        }
        let middle = ui.available_rect_before_wrap();
        let plain = egui::Frame::NONE;
        egui::CentralPanel::default().frame(plain).show(ui, |ui| match start {
            Some(page) => {
                if page.ui(ui, &mut context, files.is_modal()) {
                    *start = None;
                }
            }
            None => {
                let mut docked = Docked { panels, context: &mut context, rearranged: false };
                tree.ui(&mut docked, ui);
                self.rearranged |= docked.rearranged;
            }
        });
        files.frame(ui, &mut context);
        tables.ui(ui.ctx(), &mut context);
        if files.take_opened() {
            self.start = None;
            self.forget_light();
            ui.ctx().request_repaint();
        }
        self.above_ui(ui.ctx());
        for request in std::mem::take(&mut self.requests) {
            self.fulfil(request, ui.ctx());
        }
        self.toasts.ui(ui.ctx(), middle);
        self.keep_layout(ui.ctx());
        self.reference.end_frame();
        self.compare.end_frame(&mut self.stage);
        self.scope.end_frame();
        // The picture was drawn before the panel that changed it.
        if self.session.revision != revision {
            self.note_input();
            ui.ctx().request_repaint();
        }
    }

    /// Whoever traces leaves the processor to the user for a while.
    fn note_input(&self) {
        self.reference.note_input();
        self.compare.note_input();
    }

    /// What lies over the panels: palette and shortcut page.
    fn above_ui(&mut self, ctx: &egui::Context) {
        if let Some(mut palette) = self.palette.take() {
            match palette.ui(ctx, |command| self.obstacle(command)) {
                Chosen::Nothing => self.palette = Some(palette),
                Chosen::Closed => {}
                Chosen::Command(command) => self.requests.push(Request::Command(command)),
            }
        }
        if self.shortcut_page {
            shortcuts::ui(ctx, &mut self.shortcut_page, self.preferences.navigation);
        }
    }

    /// Puts a changed layout into the preferences once no button is down: a drag changes it every frame.
    fn keep_layout(&mut self, ctx: &egui::Context) {
        if self.rearranged && !ctx.input(|input| input.pointer.any_down()) {
            self.preferences.layout = layout::store(&self.tree);
            self.rearranged = false;
        }
    }
}

/// Someone uses mouse or keyboard; moving the pointer alone does not count.
fn is_used(input: &egui::InputState) -> bool {
    let counts = |event: &Event| match event {
        Event::PointerMoved(_) | Event::MouseMoved(_) => input.pointer.any_down(),
        Event::PointerGone | Event::WindowFocused(_) => false,
        _ => true,
    };
    input.events.iter().any(counts)
}

#[cfg(test)]
mod tests {
    use burnish_core::reference;

    use super::*;

    #[test]
    fn what_was_prepared_for_a_document_is_forgotten_with_it() {
        let ctx = egui::Context::default();
        let mut opened = document::open("gallery:ball").unwrap();
        let key = document::object_keys(&opened.sources.models[&opened.document.scene])[0].clone();
        opened.document.lighting.override_object(&key, Some(reference::ID));
        let options = Options { data_folder: None, ..Options::default() };
        let mut workbench = Workbench::new(&ctx, options, Stage::Flat);
        workbench.set_session(Session::new(opened, None));
        let Workbench { preparations, session, .. } = &mut workbench;
        preparations.follow(session.layers(), session.scene(), &ctx);
        assert!(preparations.iter_mut().count() > 0);
        workbench.set_session(Session::new(document::open("gallery:ball").unwrap(), None));
        assert_eq!(workbench.preparations.iter_mut().count(), 0);
    }
}
