//! Dialogs about files, and the notice of what is being done.

use std::path::PathBuf;

use eframe::egui;

use super::dialog::{Answer, Ask};
use super::save::{self, Choice, Wish};
use super::{Files, drop, image, notices};
use crate::window::lights;
use crate::window::panel::Context;
use crate::window::request::Request;

impl Files {
    /// Asks what cannot be done without an answer, and goes on with the answer.
    pub(super) fn dialogs_ui(&mut self, context: &mut Context<'_>, ctx: &egui::Context) {
        if let Some(next) = self.guard.clone()
            && let Some(choice) = save::guard_ui(ctx, &context.session.title(), &next)
        {
            self.guard = None;
            match choice {
                Choice::Save => self.save(context.session, Wish { path: None, next: Some(next) }, ctx),
                Choice::Discard => self.go_on(next, ctx),
                Choice::Cancel => {}
            }
        }
        if let Some(dialog) = &mut self.dialog {
            match dialog.ui(ctx, context.preferences) {
                Answer::None => {}
                Answer::Cancelled => self.dialog = None,
                Answer::Path(ask, path) => {
                    self.dialog = None;
                    self.answered(ask, path, context, ctx);
                }
            }
        }
        if let Some(pending) = self.dropped.first()
            && let Some(answer) = drop::slot_ui(ctx, pending, context.session)
        {
            self.outbox.extend(answer);
            self.dropped.remove(0);
        }
        // Not above another question.
        if self.guard.is_none() && self.dialog.is_none() && !self.loads.is_exclusive() {
            match self.offered.first().and_then(|found| notices::offer_ui(ctx, found)) {
                Some(notices::Offer::Recover) => {
                    let found = self.offered.remove(0);
                    self.offered.clear();
                    self.recover(found);
                }
                Some(notices::Offer::Discard) => self.offered.remove(0).discard(),
                Some(notices::Offer::Later) => self.offered.clear(),
                None => {}
            }
        }
    }

    fn answered(&mut self, ask: Ask, path: PathBuf, context: &mut Context<'_>, ctx: &egui::Context) {
        match ask {
            Ask::Scene => self.outbox.push(Request::OpenScene(path.to_string_lossy().into_owned())),
            Ask::Environment => self.outbox.push(Request::LoadEnvironment(path)),
            Ask::Texture { material, role } => self.outbox.push(Request::LoadTexture { material, role, path }),
            Ask::Preset => self.outbox.push(Request::ImportPreset(path)),
            Ask::ImportLighting => context.lightings.import(path),
            Ask::ExportLighting => {
                let stem = path.file_stem().map_or("lights".into(), |stem| stem.to_string_lossy().into_owned());
                context.lightings.export(lights::preset(context.session, &stem), path);
            }
            Ask::Relink(missing) => self.outbox.push(Request::Relink { missing, path }),
            Ask::SaveAs(next) => self.save(context.session, Wish { path: Some(path), next }, ctx),
            Ask::SaveEnvironment | Ask::SaveImage(_) if self.picture.is_some() => {
                let words = "another picture is being written; wait for it or cancel it, then save again";
                self.outbox.push(Request::Error(words.into()));
            }
            Ask::SaveEnvironment => match context.session.scene().environment.clone() {
                Some(map) => {
                    let without_sun =
                        context.session.scene().lights.iter().any(|light| light.name.starts_with("Sun of "));
                    self.picture = Some(image::write_map(map, path, without_sun, ctx));
                }
                None => self.outbox.push(Request::Error("the scene has no environment to save".into())),
            },
            Ask::SaveImage(settings) => {
                let Context { session, stage, reference, aids, .. } = context;
                let contribution = aids.contribution(session.scene());
                match image::start(
                    session,
                    (stage.passes(), reference.shown(), self.prepared_store()),
                    contribution,
                    settings,
                    path,
                    ctx,
                ) {
                    Ok(job) => self.picture = Some(job),
                    Err(reason) => self.outbox.push(Request::Error(reason)),
                }
            }
        }
        ctx.request_repaint();
    }

    /// Shows what is being done, with the means to end it.
    pub(super) fn work_ui(&mut self, ctx: &egui::Context) {
        if let Some(label) = self.loads.exclusive_label().map(str::to_string)
            && notices::loading_ui(ctx, &label)
        {
            self.loads.cancel_exclusive();
        }
        let reading = self.loads.label().filter(|_| !self.loads.is_exclusive()).map(|label| (label.to_string(), None));
        let drawing = self.picture.as_ref().map(|job| (job.label.clone(), Some(job.progress())));
        let works: Vec<_> = drawing.into_iter().chain(reading).collect();
        match notices::work_ui(ctx, &works) {
            Some(label) if self.loads.label() == Some(label.as_str()) => self.loads.cancel(),
            Some(label) => {
                self.picture = None;
                self.outbox.push(Request::Notice(format!("{label}: cancelled")));
            }
            None => {}
        }
    }
}
