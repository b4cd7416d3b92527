//! Files of the window: open, save, dialogs, recovery, what changed on disk.
//!
//! All work on files is done by other threads; [`Files::frame`] takes over what they finished.

mod dialog;
mod drop;
mod finished;
mod folders;
mod image;
mod load;
mod notices;
mod questions;
mod recovery;
mod save;
mod store;
#[cfg(test)]
mod tests;
mod watch;

use std::path::Path;

use burnish_core::job::Job;
use burnish_core::lighting;
use eframe::egui;

use super::commands::Command;
use super::panel::Context;
use super::preferences::Preferences;
use super::reference::{Look, Reference};
use super::request::{Purpose, Request, Requests};
use super::session::Session;
use super::stage::Stage;
use super::workbench::Options;
use dialog::{Ask, Dialog};
use drop::Pending;
use image::ImageSettings;
use load::{Loads, Notices};
use recovery::{Found, Recovery, Scan, Snapshot};
use save::{Next, Saving, Wish};
use store::Store;
use watch::Watch;

pub use dialog::{is_table, typed_path};
pub use folders::Folders;

/// Jobs and dialogs about files.
#[derive(Default)]
pub struct Files {
    folders: Option<Folders>,
    store: Option<Store>,
    loads: Loads,
    /// One at a time: two would write the same file.
    saving: Option<Saving>,
    /// The save after the running one.
    wish: Option<Wish>,
    /// What waits for the end of the saves.
    held: Option<Next>,
    dialog: Option<Dialog>,
    guard: Option<Next>,
    picture: Option<Job<Result<String, String>>>,
    dropped: Vec<Pending>,
    notices: Notices,
    shows_notices: bool,
    recovery: Recovery,
    scanning: Option<Job<Scan>>,
    /// Takes up what is found without a question.
    recovers: bool,
    offered: Vec<Found>,
    watch: Watch,
    /// Missing files that the user has seen and put away.
    put_away: Vec<String>,
    /// Revision of the session that was handed to the recovery file.
    kept_revision: Option<u64>,
    /// The last wish for a recovery file was fulfilled.
    recovery_kept: bool,
    title: String,
    /// Another document was opened since somebody asked.
    opened: bool,
    quitting: bool,
    /// Wishes of other threads for the next frame.
    outbox: Requests,
}

impl Files {
    /// Files of a window as it starts, with the user's choices. A flat stage without a folder of its own keeps nothing.
    pub fn new(options: &Options, stage: &Stage, ctx: &egui::Context) -> (Files, Preferences) {
        let folders = match &options.data_folder {
            Some(folder) => Some(Folders::within(folder)),
            None if matches!(stage, Stage::Flat) => None,
            None => Folders::of_user(),
        };
        let mut files = Files { folders, recovers: options.recover, ..Files::default() };
        let mut preferences = Preferences::default();
        if let Some(folders) = &files.folders {
            let (read, notice) = Preferences::read(&folders.preferences());
            files.outbox.extend(notice.map(Request::Error));
            files.store = Some(Store::new(folders.preferences(), &read));
            preferences = read;
            let (folder, waker, patient) = (folders.recovery(), ctx.clone(), options.recover);
            files.recovery = Recovery::new(folder.clone());
            let work = move |_: &_| recovery::scan(&folder, patient);
            files.scanning = Some(Job::spawn("Looking for unsaved work", move || waker.request_repaint(), work));
        }
        if let Some(scene) = &options.scene {
            files.loads.push(load::scene(scene.clone()));
        }
        if let Some(map) = &options.environment {
            files.loads.push(load::environment(map));
        }
        (files, preferences)
    }

    /// Folders of the user; `None` where nothing is kept.
    pub fn folders(&self) -> Option<&Folders> {
        self.folders.as_ref()
    }

    /// A dialog has the keyboard, or a document is being read: commands wait.
    pub fn is_modal(&self) -> bool {
        let asks =
            self.dialog.is_some() || self.guard.is_some() || !self.dropped.is_empty() || !self.offered.is_empty();
        asks || self.loads.is_exclusive()
    }

    /// A file is being read or written.
    pub fn is_busy(&self) -> bool {
        self.loads.is_busy() || self.saving.is_some() || self.picture.is_some() || self.scanning.is_some()
    }

    /// The last [`Request::WriteRecovery`] put the document on the disk.
    pub fn recovery_kept(&self) -> bool {
        self.recovery_kept
    }

    /// Another document was opened since the last call.
    pub fn take_opened(&mut self) -> bool {
        std::mem::take(&mut self.opened)
    }

    /// The window was told to close, with nothing left to ask.
    pub fn is_ending(&self) -> bool {
        self.quitting
    }

    /// Writes the document, saved or not, into the recovery file and waits for it: for when the program is about to end badly.
    pub fn keep_now(&mut self, session: &Session) -> Result<(), String> {
        self.kept_revision = Some(session.revision);
        self.recovery.write_now(&snapshot(session))
    }

    /// Looks at running jobs and shows open dialogs; once a frame.
    pub fn frame(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let ctx = &ui.ctx().clone();
        self.close_requested(context.session, ctx);
        self.advance(context, ctx);
        self.keep(context, ctx);
        let Files { outbox, dropped, .. } = self;
        dropped.extend(drop::take(ctx, context.session, outbox));
        self.dialogs_ui(context, ctx);
        drop::hover_ui(ctx, context.session);
        self.work_ui(ctx);
        notices::window_ui(ctx, &mut self.shows_notices, &self.notices);
        if !self.outbox.is_empty() {
            context.requests.append(&mut self.outbox);
            ctx.request_repaint();
        }
    }

    /// What must be seen above the panels: changed and missing files.
    pub fn banner_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let changed = self.watch.changed();
        let missing: Vec<_> =
            context.session.missing.iter().filter(|missing| !self.put_away.contains(&missing.path)).cloned().collect();
        for action in notices::banner_ui(ui, &changed, &missing) {
            match action {
                notices::Action::Reload(path) => match load::kind_of(context.session.document(), &path) {
                    Some(kind) => self.loads.push(load::changed(kind, path)),
                    None => self.watch.ignore(&path),
                },
                notices::Action::Ignore(path) => self.watch.ignore(&path),
                notices::Action::Relink(missing) => self.open_dialog(Ask::Relink(missing), context.session),
                notices::Action::PutAway(path) => self.put_away.push(path),
            }
        }
    }

    /// Fulfils a request about a file.
    pub fn fulfil(&mut self, request: Request, session: &mut Session, ctx: &egui::Context) {
        match request {
            Request::OpenScene(scene) => self.leave(Next::Open(scene), session, ctx),
            Request::LoadEnvironment(path) => self.loads.push(load::environment(&path)),
            Request::LoadTexture { material, role, path } => {
                if let Some(entry) = session.document().materials.get(material) {
                    self.loads.push(load::texture(entry.name.clone(), role, &path));
                }
            }
            Request::Relink { missing, path } => {
                self.loads.push(load::relinked(missing, &path, session.missing.clone()));
            }
            Request::PickFile(purpose) => {
                let ask = match purpose {
                    Purpose::Scene => Some(Ask::Scene),
                    Purpose::Environment => Some(Ask::Environment),
                    Purpose::Texture { material, role } => Some(Ask::Texture { material, role }),
                    Purpose::Preset => Some(Ask::Preset),
                    Purpose::ImportLighting => Some(Ask::ImportLighting),
                    Purpose::ExportLighting => Some(Ask::ExportLighting),
                    Purpose::Missing { index, .. } => session.missing.get(index).cloned().map(Ask::Relink),
                };
                if let Some(ask) = ask {
                    self.open_dialog(ask, session);
                }
            }
            Request::WriteRecovery => {
                let fault = self.keep_now(session).err();
                self.recovery_kept = fault.is_none();
                self.outbox.extend(fault.map(Request::Error));
            }
            // Not about files of the document.
            Request::Command(_)
            | Request::Notice(_)
            | Request::Error(_)
            | Request::AssignPreset { .. }
            | Request::ImportPreset(_)
            | Request::ImportText(_) => {}
        }
        ctx.request_repaint();
    }

    /// Does a command about files.
    pub fn command(
        &mut self,
        command: Command,
        session: &mut Session,
        (stage, reference): (&Stage, &Reference),
        ctx: &egui::Context,
    ) {
        match command {
            Command::Open => self.open_dialog(Ask::Scene, session),
            Command::LoadEnvironment => self.open_dialog(Ask::Environment, session),
            Command::Save => self.save(session, Wish::default(), ctx),
            Command::SaveAs => self.open_dialog(Ask::SaveAs(None), session),
            Command::SaveImage => {
                let size = stage.status().map(|status| status.size);
                let traced = reference.shown().and_then(Look::whole_size);
                self.open_dialog(Ask::SaveImage(ImageSettings::new(size, traced, reference.is_on())), session);
            }
            Command::SaveEnvironment => self.open_dialog(Ask::SaveEnvironment, session),
            Command::Notices => self.shows_notices = true,
            Command::Quit => self.leave(Next::Quit, session, ctx),
            _ => {}
        }
        ctx.request_repaint();
    }

    fn open_dialog(&mut self, ask: Ask, session: &Session) {
        let path = match &ask {
            Ask::SaveAs(_) => beside(session, "burnish"),
            Ask::SaveImage(_) => beside(session, "png"),
            Ask::SaveEnvironment => beside(session, "hdr"),
            Ask::Relink(missing) => missing.path.clone(),
            Ask::ExportLighting => beside(session, "json"),
            Ask::Scene | Ask::Environment | Ask::Texture { .. } | Ask::Preset | Ask::ImportLighting => String::new(),
        };
        self.dialog = Some(Dialog::new(ask, path));
    }

    /// Leaves the document for something else, after a question where it has unsaved changes.
    fn leave(&mut self, next: Next, session: &Session, ctx: &egui::Context) {
        if session.is_dirty() && self.saving.is_none() {
            self.guard = Some(next);
        } else {
            self.go_on(next, ctx);
        }
    }

    fn go_on(&mut self, next: Next, ctx: &egui::Context) {
        if self.saving.is_some() {
            // Whether something is unsaved is known when it is over.
            self.held = Some(next);
            return;
        }
        match next {
            Next::Open(scene) => self.loads.push(load::scene(scene)),
            Next::Quit => {
                self.quitting = true;
                self.recovery.finish();
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }
        ctx.request_repaint();
    }

    /// Saves under the path of the wish or the known one, or asks for one; after the running save.
    fn save(&mut self, session: &Session, wish: Wish, ctx: &egui::Context) {
        if self.saving.is_some() {
            self.wish = Some(wish.or(self.wish.take().unwrap_or_default()));
            return;
        }
        let Wish { path, next } = wish;
        match path.as_ref().or(session.path.as_ref()) {
            Some(path) => self.saving = Some(Saving::start(session, path, next, ctx)),
            None => self.open_dialog(Ask::SaveAs(next), session),
        }
    }

    /// The window is about to close.
    fn close_requested(&mut self, session: &Session, ctx: &egui::Context) {
        if self.quitting || !ctx.input(|input| input.viewport().close_requested()) {
            return;
        }
        if session.is_dirty() || self.saving.is_some() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        }
        self.leave(Next::Quit, session, ctx);
    }

    /// Keeps on disk what must last: the user's choices and unsaved edits.
    fn keep(&mut self, context: &mut Context<'_>, ctx: &egui::Context) {
        let session = &*context.session;
        if let Some(store) = &mut self.store {
            self.outbox.extend(store.keep(context.preferences, self.quitting).map(Request::Error));
        }
        self.outbox.extend(self.recovery.take_error().map(Request::Error));
        if self.kept_revision != Some(session.revision) && !self.quitting {
            self.kept_revision = Some(session.revision);
            if session.is_dirty() {
                self.recovery.keep(snapshot(session));
            } else {
                self.recovery.forget();
            }
            let title = format!("{}{} - Burnish", session.title(), if session.is_dirty() { "*" } else { "" });
            if self.title != title {
                ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
                self.title = title;
            }
        }
    }

    /// Where preparations are kept.
    pub fn prepared_store(&self) -> lighting::Store {
        self.folders().map_or_else(lighting::Store::none, |folders| lighting::Store::within(&folders.prepared()))
    }
}

fn snapshot(session: &Session) -> Snapshot {
    Snapshot { document: session.document().clone(), path: session.path.clone() }
}

/// A path with another ending beside the document, else beside its model, else in the current folder.
fn beside(session: &Session, ending: &str) -> String {
    let scene = &session.document().scene;
    let model = Some(Path::new(scene)).filter(|_| !scene.starts_with("gallery:"));
    let folder = session.path.as_deref().or(model).and_then(Path::parent).map(Path::to_path_buf);
    let folder = folder.or_else(|| std::env::current_dir().ok()).unwrap_or_default();
    folder.join(format!("{}.{ending}", session.title())).to_string_lossy().into_owned()
}
