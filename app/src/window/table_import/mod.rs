//! Import of optical constants: a table of n and k is read and fitted on another thread, looked at, and kept.
//!
//! Nothing is imported before someone has seen what was read. Presets and saved materials in our own format (`.json`)
//! need no look; they go straight to [`UserPresets`](super::user_presets::UserPresets).

mod plot;
#[cfg(test)]
mod tests;
mod view;

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::import::optical::{self, Imported, OpticalError, OpticalFault, Options};
use burnish_core::job::{Job, Outcome};
use burnish_core::material::preset::Preset;
use eframe::egui;

use super::panel::Context;
use super::user_presets::fit;
use view::Answer;

/// Name of a text that came from the clipboard, in messages and as a first name of the metal.
const PASTED: &str = "pasted";

/// Lines of a text that are looked at for a table.
const LINES_LOOKED_AT: usize = 500;

/// Rows of numbers that make a text a table.
const ROWS_OF_A_TABLE: usize = 3;

/// Where a table comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A file.
    File(PathBuf),
    /// The clipboard, perhaps corrected since.
    Text(String),
}

impl Origin {
    /// Name for people.
    fn name(&self) -> String {
        match self {
            Origin::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
            Origin::Text(_) => PASTED.into(),
        }
    }

    /// Reads it and fits its forms. Not for the thread of the window.
    fn read(&self, options: &Options) -> Result<Imported, OpticalError> {
        let mut imported = match self {
            Origin::File(path) => optical::read(path, options)?,
            Origin::Text(text) => optical::parse(text, PASTED, options)?,
        };
        fit(&mut imported.preset);
        Ok(imported)
    }
}

/// Tables that wait to be looked at, and the one that is.
#[derive(Default)]
pub struct TableImport {
    waiting: VecDeque<Origin>,
    preview: Option<Preview>,
}

impl TableImport {
    /// Shows a table after those that wait.
    pub fn open(&mut self, origin: Origin) {
        let shown = self.preview.as_ref().map(|preview| &preview.origin);
        if shown != Some(&origin) && !self.waiting.contains(&origin) {
            self.waiting.push_back(origin);
        }
    }

    /// A table is being read.
    pub fn is_busy(&self) -> bool {
        !self.waiting.is_empty() && self.preview.is_none()
            || self.preview.as_ref().is_some_and(|preview| preview.job.is_some())
    }

    /// Takes over what was read and shows the preview; once a frame.
    pub fn ui(&mut self, ctx: &egui::Context, context: &mut Context<'_>) {
        if self.preview.is_none() {
            self.preview = self.waiting.pop_front().map(|origin| Preview::new(origin, ctx));
        }
        let Some(preview) = &mut self.preview else { return };
        preview.advance();
        if let Some(Ok(found)) = &preview.found
            && let Some(half) = other_half(&preview.origin, found)
        {
            self.waiting.retain(|waiting| *waiting != half);
        }
        let assign = match preview.ui(ctx, self.waiting.len(), context) {
            Answer::None => return,
            Answer::Cancel => None,
            Answer::Import => Some(false),
            Answer::ImportAndAssign => Some(true),
        };
        if let (Some(assign), Some(preview)) = (assign, self.preview.take())
            && let Ok(metal) = preview.metal()
        {
            context.own.add(metal, assign);
        }
        self.preview = None;
        ctx.request_repaint();
    }
}

/// A table that is looked at.
struct Preview {
    origin: Origin,
    /// Unit and sign that were asked for.
    options: Options,
    /// As in the field; that of the table until someone types.
    name: String,
    id: String,
    /// Someone typed a name or an id: they outlast another reading.
    named: bool,
    /// The text differs from what was read.
    edited: bool,
    job: Option<Job<Result<Imported, OpticalError>>>,
    /// Shared, so that it can be shown while the fields change.
    found: Option<Result<Arc<Imported>, OpticalError>>,
}

impl Preview {
    fn new(origin: Origin, ctx: &egui::Context) -> Preview {
        let mut preview = Preview {
            origin,
            options: Options::default(),
            name: String::new(),
            id: String::new(),
            named: false,
            edited: false,
            job: None,
            found: None,
        };
        preview.read(ctx);
        preview
    }

    /// Starts to read, in place of a reading that goes on.
    fn read(&mut self, ctx: &egui::Context) {
        let (origin, options, waker) = (self.origin.clone(), self.options.clone(), ctx.clone());
        let label = format!("Reading {}", origin.name());
        self.edited = false;
        self.job = Some(Job::spawn(label, move || waker.request_repaint(), move |_| origin.read(&options)));
    }

    /// Takes over what was read.
    fn advance(&mut self) {
        let found = match self.job.as_mut().map(Job::poll) {
            None | Some(Outcome::Running) => return,
            Some(Outcome::Done(found)) => found,
            Some(Outcome::Failed) => Err(unread(&self.origin)),
        };
        self.job = None;
        if let (Ok(imported), false) = (&found, self.named) {
            self.name.clone_from(&imported.preset.name);
            self.id.clone_from(&imported.preset.id);
        }
        self.found = Some(found.map(Arc::new));
    }

    /// The metal under the name and the id of the fields, or what is wrong with it.
    fn metal(&self) -> Result<Preset, String> {
        let Some(Ok(found)) = &self.found else { return Err("Nothing was read".into()) };
        let metal = Preset { name: self.name.trim().into(), id: self.id.trim().into(), ..found.preset.clone() };
        metal.check(&self.origin.name()).map_err(|e| e.to_string())?;
        Ok(metal)
    }
}

/// What is said when the reader gave no answer.
fn unread(origin: &Origin) -> OpticalError {
    let (reason, remedy) = ("could not be read: the reader ended unexpectedly", "try a table of plain columns");
    let fault = OpticalFault { file: origin.name(), line: None, reason: reason.into(), remedy: remedy.into() };
    OpticalError { faults: vec![fault], omitted: 0 }
}

/// The file that was read with that of `origin`: it need not be looked at again.
fn other_half(origin: &Origin, found: &Imported) -> Option<Origin> {
    let Origin::File(path) = origin else { return None };
    found.report.other.as_ref().map(|other| Origin::File(path.with_file_name(other)))
}

/// True for a text that is worth a preview: rows of numbers, a database file of refractiveindex.info, a preset of ours.
pub fn looks_like_table(text: &str) -> bool {
    if text.trim_start().starts_with('{') {
        return text.contains("burnish-metal");
    }
    let is_row = |line: &&str| {
        let mut cells = line.split([' ', '\t', ',', ';']).filter(|cell| !cell.is_empty());
        let mut number = || cells.next().is_some_and(|cell| cell.parse::<f64>().is_ok());
        number() && number()
    };
    let mut lines = text.lines().take(LINES_LOOKED_AT);
    lines.clone().any(|line| line.starts_with("DATA:"))
        || lines.by_ref().filter(is_row).take(ROWS_OF_A_TABLE).count() == ROWS_OF_A_TABLE
}
