//! Saving, and what asks before something unsaved is lost.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::document::Document;
use burnish_core::job::{Job, Outcome};
use eframe::egui;

use crate::window::session::Session;

/// What is done once nothing unsaved is in its way.
#[derive(Clone, Debug, PartialEq)]
pub enum Next {
    /// Opens a model, gallery scene or document.
    Open(String),
    /// Ends the program.
    Quit,
}

/// A save that is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wish {
    /// Where to; the path of the document when absent.
    pub path: Option<PathBuf>,
    /// What comes after it.
    pub next: Option<Next>,
}

impl Wish {
    /// The newest wish, with what it leaves open from the one before.
    pub fn or(self, before: Wish) -> Wish {
        Wish { path: self.path.or(before.path), next: self.next.or(before.next) }
    }
}

/// A document on its way to the disk.
pub struct Saving {
    job: Job<Result<(), String>>,
    document: Arc<Document>,
    path: PathBuf,
    next: Option<Next>,
}

impl Saving {
    /// Saves the document as it is now.
    pub fn start(session: &Session, path: &Path, next: Option<Next>, ctx: &egui::Context) -> Saving {
        let (document, path) = (session.document().clone(), path.to_path_buf());
        let (written, file, waker) = (document.clone(), path.clone(), ctx.clone());
        let label = format!("Saving {}", super::load::name_of(&path.to_string_lossy()));
        let work = move |_: &_| written.save(&file).map_err(|e| e.to_string());
        Saving { job: Job::spawn(label, move || waker.request_repaint(), work), document, path, next }
    }

    /// `None` while it runs; then the file and what comes next, or what went wrong.
    pub fn advance(&mut self, session: &mut Session) -> Option<Result<(PathBuf, Option<Next>), String>> {
        match self.job.poll() {
            Outcome::Running => None,
            Outcome::Done(Ok(())) => {
                session.set_saved(&self.path, self.document.clone());
                Some(Ok((self.path.clone(), self.next.take())))
            }
            Outcome::Done(Err(reason)) => Some(Err(reason)),
            Outcome::Failed => Some(Err(format!("{}: it was not saved; try again", self.path.display()))),
        }
    }
}

/// What the user wants with unsaved changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    Save,
    Discard,
    Cancel,
}

/// Asks about unsaved changes; `None` while there is no answer.
pub fn guard_ui(ctx: &egui::Context, title: &str, next: &Next) -> Option<Choice> {
    let mut choice = None;
    let shown = egui::Modal::new(egui::Id::unique("unsaved changes")).show(ctx, |ui| {
        ui.set_width(360.0);
        ui.heading("Unsaved changes");
        ui.add_space(4.0);
        let doing = match next {
            Next::Open(scene) => format!("opening {}", super::load::name_of(scene)),
            Next::Quit => "quitting".into(),
        };
        ui.label(format!("Save the changes to `{title}` before {doing}?"));
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            let save = ui.button("Save").on_hover_text("Save, then go on");
            if ui.memory(|memory| memory.focused().is_none()) {
                save.request_focus();
            }
            if save.clicked() {
                choice = Some(Choice::Save);
            }
            if ui.button("Discard").on_hover_text("Go on; the changes are lost").clicked() {
                choice = Some(Choice::Discard);
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Cancel").on_hover_text("Keep working").clicked() {
                    choice = Some(Choice::Cancel);
                }
            });
        });
    });
    if shown.should_close() {
        choice = choice.or(Some(Choice::Cancel));
    }
    choice
}
