//! What is done when panels and commands ask for it.

use eframe::egui;

use super::Workbench;
use crate::window::commands::Command;
use crate::window::files::is_table;
use crate::window::palette::Palette;
use crate::window::panel::{Pane, StartPage, assign};
use crate::window::request::Request;
use crate::window::table_import::Origin;
use crate::window::{edits, layout, snapshots, theme};

impl Workbench {
    /// Fulfils a wish of a panel.
    pub(super) fn fulfil(&mut self, request: Request, ctx: &egui::Context) {
        match request {
            Request::Command(command) => self.command(command, ctx),
            Request::ImportPreset(path) => {
                self.start = None;
                match is_table(&path) {
                    true => self.tables.open(Origin::File(path)),
                    false => self.own.import(path),
                }
                ctx.request_repaint();
            }
            Request::ImportText(text) => {
                self.start = None;
                self.tables.open(Origin::Text(text));
                ctx.request_repaint();
            }
            Request::AssignPreset { preset, materials } => {
                if let Err(fault) = assign(&mut self.session, &self.own, &preset, &materials) {
                    self.requests.push(Request::Error(fault));
                }
            }
            Request::Notice(text) => self.toasts.notice(text, self.session.now_secs),
            Request::Error(text) => self.toasts.error(text, self.session.now_secs),
            about_files => {
                if !matches!(about_files, Request::PickFile(_) | Request::WriteRecovery) {
                    self.start = None;
                }
                self.files.fulfil(about_files, &mut self.session, ctx);
            }
        }
        // An answer is shown in the next frame.
        if !self.requests.is_empty() {
            ctx.request_repaint();
        }
    }

    /// Why a command can do nothing now, in words.
    pub(super) fn obstacle(&self, command: Command) -> Option<&'static str> {
        if self.start.is_some() && !command.suits_start_page() {
            return Some("Open a scene first.");
        }
        command.obstacle(&self.session)
    }

    /// For commands that switch something: whether it is on.
    pub(super) fn is_on(&self, command: Command) -> Option<bool> {
        match command {
            Command::Panel(pane) => Some(layout::is_shown(&self.tree, pane)),
            Command::Orthographic => Some(self.session.document().view.camera.orthographic),
            Command::Reference => Some(self.reference.is_on() && self.compare.view().is_none()),
            Command::Display(mode) => Some(self.aids.mode == mode),
            Command::Compare(view) => Some(self.compare.view() == Some(view)),
            Command::Tool(tool) => Some(self.panels.viewport.tools.tool == tool),
            Command::ThemeSystem => Some(self.preferences.dark.is_none()),
            Command::ThemeLight => Some(self.preferences.dark == Some(false)),
            Command::ThemeDark => Some(self.preferences.dark == Some(true)),
            _ => None,
        }
    }

    fn command(&mut self, command: Command, ctx: &egui::Context) {
        if self.obstacle(command).is_some() {
            return;
        }
        match command {
            Command::Undo => _ = self.session.undo(),
            Command::Redo => _ = self.session.redo(),
            Command::Start => self.start = Some(StartPage::default()),
            Command::Open
            | Command::LoadEnvironment
            | Command::Save
            | Command::SaveAs
            | Command::SaveImage
            | Command::SaveEnvironment
            | Command::Notices
            | Command::Quit => {
                self.files.command(command, &mut self.session, (&self.stage, &self.reference), ctx);
            }
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
            | Command::RemoveMaterial
            | Command::ApplyToAll
            | Command::ApplyToSelected
            | Command::Hide
            | Command::Isolate
            | Command::ShowAll => edits::command(command, &mut self.session, &mut self.requests),
            Command::Rename => {
                self.show_panel(Pane::Scene);
                self.panels.scene.rename(&self.session);
            }
            Command::Tool(tool) => self.panels.viewport.tools.tool = tool,
            Command::Reference => {
                self.reference.switch(!self.reference.is_on());
                self.compare.show(None);
            }
            Command::Display(mode) => self.aids.toggle(mode),
            Command::Compare(view) => {
                self.reference.switch(false);
                self.compare.show(Some(view).filter(|view| self.compare.view() != Some(*view)));
            }
            Command::StoreSide(_) | Command::SwapSides | Command::TakeSnapshot => {
                snapshots::command(command, &mut self.session, &mut self.requests);
            }
            Command::Panel(pane) => {
                layout::toggle(&mut self.tree, pane);
                self.rearranged = true;
            }
            Command::ResetLayout => {
                self.tree = layout::initial();
                self.preferences.layout = None;
            }
            Command::Palette => self.palette = if self.palette.is_some() { None } else { Some(Palette::default()) },
            Command::Shortcuts => self.shortcut_page = !self.shortcut_page,
            Command::ScaleUp => self.preferences.ui_scale = theme::scaled(self.preferences.ui_scale, 1.0),
            Command::ScaleDown => self.preferences.ui_scale = theme::scaled(self.preferences.ui_scale, -1.0),
            Command::ScaleReset => self.preferences.ui_scale = 1.0,
            Command::ThemeSystem => self.preferences.dark = None,
            Command::ThemeLight => self.preferences.dark = Some(false),
            Command::ThemeDark => self.preferences.dark = Some(true),
        }
        ctx.request_repaint();
    }
}
