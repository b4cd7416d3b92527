//! What other threads finished about files, taken over.

use burnish_core::job::Outcome;
use eframe::egui;

use super::Files;
use super::load::{self, Landing};
use super::recovery::{Found, Scan};
use super::save::Wish;
use crate::window::panel::Context;
use crate::window::request::Request;

impl Files {
    /// Takes over what other threads finished.
    pub(super) fn advance(&mut self, context: &mut Context<'_>, ctx: &egui::Context) {
        // Before another document may take the place of the one that is saved.
        self.advance_save(context, ctx);
        if self.saving.is_none() || !self.loads.is_exclusive() {
            self.advance_loads(context, ctx);
        }
        self.advance_picture();
        if let Some(job) = &mut self.scanning
            && let Outcome::Done(scan) = job.poll()
        {
            self.scanning = None;
            self.scanned(scan);
        }
        self.watch.wake(ctx);
    }

    fn advance_loads(&mut self, context: &mut Context<'_>, ctx: &egui::Context) {
        let Files { loads, watch, outbox, notices, recovery, opened, .. } = self;
        let (session, preferences) = (&mut *context.session, &mut *context.preferences);
        loads.advance(&mut Landing { session, preferences, watch, outbox, recovery, opened, notices }, ctx);
    }

    fn advance_save(&mut self, context: &mut Context<'_>, ctx: &egui::Context) {
        let Some(result) = self.saving.as_mut().and_then(|saving| saving.advance(context.session)) else { return };
        self.saving = None;
        let after = match result {
            Ok((path, next)) => {
                self.outbox.push(Request::Notice(format!("Saved {}", path.display())));
                context.preferences.remember(&load::known_path(&path));
                self.kept_revision = None;
                next
            }
            Err(reason) => {
                self.outbox.push(Request::Error(reason));
                None
            }
        };
        let held = self.held.take();
        if let Some(Wish { path, next }) = self.wish.take() {
            let next = held.or(next).or(after);
            self.save(context.session, Wish { path, next }, ctx);
        } else if let Some(next) = held.or(after) {
            self.leave(next, context.session, ctx);
        }
    }

    fn advance_picture(&mut self) {
        let Some(job) = &mut self.picture else { return };
        let failed = format!("{} ended unexpectedly; try a smaller picture", job.label);
        let request = match job.poll() {
            Outcome::Running => return,
            Outcome::Done(Ok(words)) => Request::Notice(words),
            Outcome::Done(Err(reason)) => Request::Error(reason),
            Outcome::Failed => Request::Error(failed),
        };
        self.picture = None;
        self.outbox.push(request);
    }

    fn scanned(&mut self, scan: Scan) {
        for aside in scan.damaged {
            let aside = aside.display();
            self.outbox.push(Request::Error(format!("a damaged recovery file was set aside as {aside}")));
        }
        for fault in scan.unreadable {
            self.outbox.push(Request::Error(format!("a recovery file was left as it is: {fault}")));
        }
        self.offered = scan.found;
        if std::mem::take(&mut self.recovers) && !self.offered.is_empty() {
            let newest = self.offered.remove(0);
            self.offered.clear();
            self.recover(newest);
        }
    }

    pub(super) fn recover(&mut self, found: Found) {
        self.loads.push(load::recovered(found));
    }
}
