//! Asking for a path: a field to type it into, the dialog of the system, recent files.
//!
//! The dialog of the system runs on a thread of its own, and where there is none it answers like one that was
//! cancelled. So everything can be done by the field alone.

use std::path::{Path, PathBuf};

use burnish_core::document::{Missing, MissingKind};
use burnish_core::file::PictureFormat;
use burnish_core::job::{Job, Outcome};
use burnish_core::material::TextureRole;
use eframe::egui::{self, Key};

use super::image::ImageSettings;
use super::load::name_of;
use super::save::Next;
use crate::window::preferences::Preferences;

/// Models and documents.
const SCENES: &[&str] = &["burnish", "gltf", "glb", "obj"];
/// Models.
const MODELS: &[&str] = &["gltf", "glb", "obj"];
/// Environments.
const MAPS: &[&str] = &["hdr", "exr"];
/// Textures.
const IMAGES: &[&str] = &["png", "jpg", "jpeg"];
/// Metals and saved materials of ours, then tables of optical constants.
const PRESETS: &[&str] = &["json", "csv", "tsv", "txt", "dat", "yml", "yaml", "spd"];
/// Recent documents that the dialog lists.
const MAX_RECENT: usize = 6;

/// What the path is for.
#[derive(Clone, Debug, PartialEq)]
pub enum Ask {
    /// A model, gallery scene or document to open.
    Scene,
    /// An HDRI.
    Environment,
    /// A texture for the slot of the material of that index.
    Texture { material: usize, role: TextureRole },
    /// A metal.
    Preset,
    /// A lighting preset.
    ImportLighting,
    /// Where to write the lights as a preset.
    ExportLighting,
    /// Where a missing file is now.
    Relink(Missing),
    /// Where to save the document, and what comes then.
    SaveAs(Option<Next>),
    /// Where to write the picture, and how.
    SaveImage(ImageSettings),
    /// Where to write the environment.
    SaveEnvironment,
}

impl Ask {
    fn title(&self) -> String {
        match self {
            Ask::Scene => "Open".into(),
            Ask::Environment => "Load HDRI".into(),
            Ask::Texture { role, .. } => format!("Load {} texture", role.name()),
            Ask::Preset => "Import preset".into(),
            Ask::ImportLighting => "Import lighting preset".into(),
            Ask::ExportLighting => "Export lighting preset".into(),
            Ask::Relink(missing) => format!("Relink {}", name_of(&missing.path)),
            Ask::SaveAs(_) => "Save as".into(),
            Ask::SaveImage(_) => "Save image".into(),
            Ask::SaveEnvironment => "Save environment".into(),
        }
    }

    /// The button that accepts.
    fn verb(&self) -> &'static str {
        match self {
            Ask::Scene => "Open",
            Ask::Environment | Ask::Texture { .. } => "Load",
            Ask::Preset | Ask::ImportLighting => "Import",
            Ask::Relink(_) => "Relink",
            Ask::SaveAs(_) | Ask::SaveImage(_) | Ask::SaveEnvironment | Ask::ExportLighting => "Save",
        }
    }

    fn is_for_writing(&self) -> bool {
        matches!(self, Ask::SaveAs(_) | Ask::SaveImage(_) | Ask::SaveEnvironment | Ask::ExportLighting)
    }

    fn endings(&self) -> (&'static str, &'static [&'static str]) {
        match self {
            Ask::Scene => ("Models and documents", SCENES),
            Ask::Environment | Ask::SaveEnvironment | Ask::Relink(Missing { kind: MissingKind::Environment, .. }) => {
                ("HDR pictures", MAPS)
            }
            Ask::Texture { .. } | Ask::Relink(Missing { kind: MissingKind::Texture, .. }) => ("Pictures", IMAGES),
            Ask::Relink(Missing { kind: MissingKind::Model, .. }) => ("Models", MODELS),
            Ask::Preset => ("Presets and tables of n and k", PRESETS),
            Ask::ImportLighting | Ask::ExportLighting => ("Lighting presets", &["json"]),
            Ask::SaveAs(_) => ("Documents", &["burnish"]),
            Ask::SaveImage(_) => ("Pictures", &["png", "exr"]),
        }
    }

    fn hint(&self) -> String {
        self.endings().1.iter().map(|ending| format!(".{ending}")).collect::<Vec<_>>().join("  ")
    }
}

/// An open dialog.
pub struct Dialog {
    ask: Ask,
    path: String,
    fault: Option<String>,
    /// The file that may be replaced: the user was asked.
    replaced: Option<PathBuf>,
    browsing: Option<Job<Option<PathBuf>>>,
    shown: bool,
}

/// What became of a dialog.
pub enum Answer {
    /// Still open.
    None,
    /// Closed.
    Cancelled,
    /// A path that was checked.
    Path(Ask, PathBuf),
}

impl Dialog {
    /// A dialog that starts from a path.
    pub fn new(ask: Ask, path: String) -> Dialog {
        Dialog { ask, path, fault: None, replaced: None, browsing: None, shown: false }
    }

    /// Shows it.
    pub fn ui(&mut self, ctx: &egui::Context, preferences: &Preferences) -> Answer {
        let mut accepted = self.browsed();
        let mut cancelled = false;
        let modal = egui::Modal::new(egui::Id::unique("path dialog")).show(ctx, |ui| {
            ui.set_width(520.0);
            ui.heading(self.ask.title());
            ui.add_space(6.0);
            accepted |= self.path_ui(ui);
            if let Ask::SaveImage(settings) = &mut self.ask {
                ui.add_space(6.0);
                settings.ui(ui);
            }
            if let Some(fault) = &self.fault {
                ui.add_space(4.0);
                ui.colored_label(ui.visuals().error_fg_color, fault);
            }
            if self.ask == Ask::Scene {
                accepted |= self.recent_ui(ui, preferences);
            }
            ui.add_space(10.0);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let verb = if self.replaced.is_some() { "Replace" } else { self.ask.verb() };
                accepted |= ui.add_enabled(!self.path.trim().is_empty(), egui::Button::new(verb)).clicked();
                cancelled |= ui.button("Cancel").clicked();
            });
        });
        self.shown = true;
        // A click beside the dialog keeps it: what was typed would be lost.
        if cancelled || ctx.input(|input| input.key_pressed(Key::Escape)) && modal.is_top_modal {
            return Answer::Cancelled;
        }
        if !accepted {
            return Answer::None;
        }
        match self.checked() {
            Ok(path) => Answer::Path(self.ask.clone(), path),
            Err(fault) => {
                self.fault = Some(fault);
                Answer::None
            }
        }
    }

    /// The field and the button of the system's dialog; true when the path is to be taken.
    fn path_ui(&mut self, ui: &mut egui::Ui) -> bool {
        let mut entered = false;
        ui.horizontal(|ui| {
            let label = ui.label("Path");
            let field = egui::TextEdit::singleline(&mut self.path).hint_text(self.ask.hint()).desired_width(380.0);
            let field = ui.add(field).labelled_by(label.id);
            if !self.shown {
                field.request_focus();
            }
            if field.changed() {
                (self.fault, self.replaced) = (None, None);
            }
            entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let browse = ui.add_enabled(self.browsing.is_none(), egui::Button::new("Browse..."));
            if browse.on_hover_text("Choose with the dialog of the system").clicked() {
                self.browse(ui.ctx());
            }
        });
        entered
    }

    fn recent_ui(&mut self, ui: &mut egui::Ui, preferences: &Preferences) -> bool {
        if preferences.recent.is_empty() {
            return false;
        }
        let mut chosen = None;
        ui.add_space(8.0);
        ui.weak("Recent");
        for path in preferences.recent.iter().take(MAX_RECENT) {
            let button = egui::Button::new(name_of(path)).frame(false).min_size(egui::vec2(520.0, 0.0)).truncate();
            if ui.add(button).on_hover_text(path).clicked() {
                chosen = Some(path.clone());
            }
        }
        let is_chosen = chosen.is_some();
        self.path = chosen.unwrap_or_else(|| std::mem::take(&mut self.path));
        is_chosen
    }

    /// Opens the dialog of the system.
    fn browse(&mut self, ctx: &egui::Context) {
        let (name, endings) = self.ask.endings();
        let mut dialog = rfd::FileDialog::new().set_title(self.ask.title()).add_filter(name, endings);
        let typed = typed_path(&self.path);
        if let Some(folder) = typed.parent().filter(|folder| folder.is_dir()) {
            dialog = dialog.set_directory(folder);
        }
        let is_for_writing = self.ask.is_for_writing();
        if let Some(name) = typed.file_name().filter(|_| is_for_writing) {
            dialog = dialog.set_file_name(name.to_string_lossy());
        }
        let waker = ctx.clone();
        let work = move |_: &_| if is_for_writing { dialog.save_file() } else { dialog.pick_file() };
        self.browsing = Some(Job::spawn("Choosing a file", move || waker.request_repaint(), work));
    }

    /// Takes over what was chosen; true when there is something.
    fn browsed(&mut self) -> bool {
        let Some(job) = &mut self.browsing else { return false };
        let path = match job.poll() {
            Outcome::Running => return false,
            Outcome::Done(path) => path,
            Outcome::Failed => None,
        };
        self.browsing = None;
        let Some(path) = path else { return false };
        self.path = path.to_string_lossy().into_owned();
        // The dialog of the system has asked already.
        self.replaced = self.ask.is_for_writing().then_some(path);
        // More than the path is asked for here: the picture's size can still be changed.
        !matches!(self.ask, Ask::SaveImage(_))
    }

    /// The path, or what is wrong with it.
    fn checked(&mut self) -> Result<PathBuf, String> {
        if self.path.trim().starts_with("gallery:") && self.ask == Ask::Scene {
            return Ok(self.path.trim().into());
        }
        let mut path = typed_path(&self.path);
        if !self.ask.is_for_writing() {
            return match path.is_file() {
                true => Ok(path),
                false if path.is_dir() => Err(format!("{} is a folder; name a file in it", path.display())),
                false => Err(format!("There is no file {}; check the name and the folder", path.display())),
            };
        }
        match &self.ask {
            Ask::SaveImage(_) => _ = PictureFormat::of(&path).map_err(|e| format!("{}; {}", e.reason, e.remedy))?,
            Ask::SaveEnvironment if !is_map(&path) => {
                return Err(format!("{}: the name needs the ending .hdr or .exr", path.display()));
            }
            Ask::SaveEnvironment => {}
            Ask::ExportLighting if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json")) => {}
            Ask::ExportLighting => path.as_mut_os_string().push(".json"),
            _ if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("burnish")) => {
                path.as_mut_os_string().push(".burnish");
            }
            _ => {}
        }
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
            return Err(format!("There is no folder {}; create it first", folder.display()));
        }
        if path.exists() && self.replaced.as_ref() != Some(&path) {
            let fault = format!("{} exists already; press Replace to write over it", path.display());
            self.replaced = Some(path);
            return Err(fault);
        }
        Ok(path)
    }
}

/// A path as people type or paste it: with quotes, `file://` or `~`.
pub fn typed_path(text: &str) -> PathBuf {
    let text = text.trim();
    let quoted = ['"', '\''].into_iter().find_map(|quote| text.strip_prefix(quote)?.strip_suffix(quote));
    let text = quoted.unwrap_or(text);
    let text = text.strip_prefix("file://").unwrap_or(text);
    let home = text.strip_prefix("~/").and_then(|rest| Some((directories::BaseDirs::new()?, rest)));
    home.map_or_else(|| PathBuf::from(text), |(folders, rest)| folders.home_dir().join(rest))
}

/// What a file is good for, by the ending of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    Scene,
    Environment,
    Texture,
    Preset,
    /// Of optical constants.
    Table,
}

impl FileKind {
    /// `None` for a file that Burnish cannot use.
    pub fn of(path: &Path) -> Option<FileKind> {
        let ending = path.extension()?.to_string_lossy().to_ascii_lowercase();
        let is = |list: &[&str]| list.contains(&ending.as_str());
        if is(SCENES) {
            Some(FileKind::Scene)
        } else if is(MAPS) {
            Some(FileKind::Environment)
        } else if is(IMAGES) {
            Some(FileKind::Texture)
        } else {
            let kind = if is(&["json"]) { FileKind::Preset } else { FileKind::Table };
            is(PRESETS).then_some(kind)
        }
    }
}

/// True for the name of an environment.
fn is_map(path: &Path) -> bool {
    FileKind::of(path) == Some(FileKind::Environment)
}

/// True for a file that is looked at before it is imported.
pub fn is_table(path: &Path) -> bool {
    FileKind::of(path) == Some(FileKind::Table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typed_path_may_be_quoted_or_a_uri() {
        for text in ["/a b/c.glb", " \"/a b/c.glb\" ", "'/a b/c.glb'", "file:///a b/c.glb"] {
            assert_eq!(typed_path(text), Path::new("/a b/c.glb"), "{text}");
        }
        assert!(!typed_path("~/c.glb").starts_with("~"));
    }

    #[test]
    fn files_are_told_apart_by_their_endings() {
        assert_eq!(FileKind::of(Path::new("a.GLB")), Some(FileKind::Scene));
        assert_eq!(FileKind::of(Path::new("a.burnish")), Some(FileKind::Scene));
        assert_eq!(FileKind::of(Path::new("a.exr")), Some(FileKind::Environment));
        assert_eq!(FileKind::of(Path::new("a.jpeg")), Some(FileKind::Texture));
        assert_eq!(FileKind::of(Path::new("a.json")), Some(FileKind::Preset));
        assert_eq!(FileKind::of(Path::new("a.YML")), Some(FileKind::Table));
        assert_eq!(FileKind::of(Path::new("a.pdf")), None);
        assert_eq!(FileKind::of(Path::new("glb")), None);
    }

    #[test]
    fn a_path_to_write_gets_its_ending_and_an_old_file_is_asked_about() {
        let folder = std::env::temp_dir().join(format!("burnish-dialog-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let mut dialog = Dialog::new(Ask::SaveAs(None), folder.join("a").to_string_lossy().into_owned());
        assert_eq!(dialog.checked(), Ok(folder.join("a.burnish")));
        std::fs::write(folder.join("a.burnish"), "old").unwrap();
        assert!(dialog.checked().unwrap_err().contains("Replace"));
        assert_eq!(dialog.checked(), Ok(folder.join("a.burnish")));
        let mut absent = Dialog::new(Ask::Scene, folder.join("b.glb").to_string_lossy().into_owned());
        assert!(absent.checked().unwrap_err().contains("no file"));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
