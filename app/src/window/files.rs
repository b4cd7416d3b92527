//! Files of the window: open, save, dialogs, recovery, what changed on disk.

use eframe::egui;

use super::commands::Command;
use super::preferences::Preferences;
use super::request::{Request, Requests};
use super::session::Session;

/// Jobs and dialogs about files.
#[derive(Default)]
pub struct Files {}

impl Files {
    /// Looks at running jobs and shows open dialogs; once a frame.
    pub fn frame(
        &mut self,
        ui: &mut egui::Ui,
        session: &mut Session,
        preferences: &mut Preferences,
        requests: &mut Requests,
    ) {
        let _ = (ui, session, preferences, requests);
    }

    /// Fulfils a request about a file.
    pub fn fulfil(
        &mut self,
        request: Request,
        session: &mut Session,
        preferences: &mut Preferences,
        ctx: &egui::Context,
    ) {
        let _ = (request, session, preferences, ctx);
    }

    /// Does a command about files.
    pub fn command(
        &mut self,
        command: Command,
        session: &mut Session,
        preferences: &mut Preferences,
        ctx: &egui::Context,
    ) {
        let _ = (command, session, preferences, ctx);
    }
}
