//! Reading files on another thread, one after the other, and what they change once they are read.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::document::{self, Document, MadeEntry, Missing, MissingKind, Sources, TextureChoice};
use burnish_core::job::{Job, Outcome};
use burnish_core::material::TextureRole;
use burnish_core::scene::{Environment, Image, Scene};
use eframe::egui;

use super::recovery::{Found, Recovery, Snapshot};
use super::watch::{Watch, stamps};
use crate::window::panel::expose;
use crate::window::preferences::Preferences;
use crate::window::request::{Request, Requests};
use crate::window::session::Session;
use crate::window::user_presets::fit;

/// What a read file may change, on the thread of the window.
pub struct Landing<'a> {
    pub session: &'a mut Session,
    pub preferences: &'a mut Preferences,
    pub watch: &'a mut Watch,
    pub outbox: &'a mut Requests,
    pub recovery: &'a Recovery,
    /// Set when another document is open.
    pub opened: &'a mut bool,
    /// Title and lines of the last notices of an importer.
    pub notices: &'a mut Notices,
}

/// What importers left out, repaired or guessed.
#[derive(Clone, Debug, Default)]
pub struct Notices {
    /// Name of the file.
    pub title: String,
    /// One each.
    pub lines: Vec<String>,
}

/// The change that a read file makes.
type Apply = Box<dyn FnOnce(&mut Landing<'_>) + Send>;

/// A file to be read.
pub struct Load {
    label: String,
    /// Nothing may be edited meanwhile, for it would be lost.
    exclusive: bool,
    work: Box<dyn FnOnce() -> Result<Apply, String> + Send>,
}

impl Load {
    fn new(label: String, exclusive: bool, work: impl FnOnce() -> Result<Apply, String> + Send + 'static) -> Load {
        Load { label, exclusive, work: Box::new(work) }
    }
}

/// Files that are being read.
#[derive(Default)]
pub struct Loads {
    queue: VecDeque<Load>,
    running: Option<(Job<Result<Apply, String>>, bool)>,
}

impl Loads {
    /// Reads a file after those that wait.
    pub fn push(&mut self, load: Load) {
        self.queue.push_back(load);
    }

    /// Something is being read or waits.
    pub fn is_busy(&self) -> bool {
        self.running.is_some() || !self.queue.is_empty()
    }

    /// A document is being read or waits for it: nothing may be edited.
    pub fn is_exclusive(&self) -> bool {
        self.exclusive_label().is_some()
    }

    /// The document that is being read, or the first that waits.
    pub fn exclusive_label(&self) -> Option<&str> {
        let running = self.running.as_ref().filter(|(_, exclusive)| *exclusive).map(|(job, _)| job.label.as_str());
        running.or_else(|| self.queue.iter().find(|load| load.exclusive).map(|load| load.label.as_str()))
    }

    /// What is being read.
    pub fn label(&self) -> Option<&str> {
        self.running.as_ref().map(|(job, _)| job.label.as_str())
    }

    /// Forgets the running file; what was read so far changes nothing.
    pub fn cancel(&mut self) {
        self.running = None;
    }

    /// Forgets the document of [`Loads::exclusive_label`] and those that wait; what is open stays.
    pub fn cancel_exclusive(&mut self) {
        if self.running.as_ref().is_some_and(|(_, exclusive)| *exclusive) {
            self.running = None;
        }
        self.queue.retain(|load| !load.exclusive);
    }

    /// Takes over what was read and starts what waits.
    pub fn advance(&mut self, landing: &mut Landing<'_>, ctx: &egui::Context) {
        if let Some((job, _)) = &mut self.running {
            let failed = format!("{} ended unexpectedly; the document is as it was", job.label);
            match job.poll() {
                Outcome::Running => return,
                Outcome::Done(Ok(apply)) => apply(landing),
                Outcome::Done(Err(reason)) => landing.outbox.push(Request::Error(reason)),
                Outcome::Failed => landing.outbox.push(Request::Error(failed)),
            }
            self.running = None;
            ctx.request_repaint();
        }
        if let Some(Load { label, exclusive, work }) = self.queue.pop_front() {
            let waker = ctx.clone();
            self.running = Some((Job::spawn(label, move || waker.request_repaint(), move |_| work()), exclusive));
        }
    }
}

/// Name of a file or gallery scene for people.
pub fn name_of(path: &str) -> String {
    let file = Path::new(path).file_name().filter(|_| !path.starts_with("gallery:"));
    file.map_or_else(|| path.into(), |name| name.to_string_lossy().into_owned())
}

/// The path under which documents know a file.
pub fn known_path(path: &Path) -> String {
    std::path::absolute(path).map_or_else(
        |_| path.to_string_lossy().into_owned(),
        |absolute| document::absolute(&absolute.to_string_lossy(), Path::new("")),
    )
}

/// A model, gallery scene or document in place of what is open.
pub fn scene(scene: String) -> Load {
    Load::new(format!("Loading {}", name_of(&scene)), true, move || {
        let in_gallery = scene.starts_with("gallery:");
        let known = if in_gallery { scene } else { known_path(Path::new(&scene)) };
        let file = PathBuf::from(&known);
        let (opened, path, seen) = if !in_gallery && document::is_document(&file) {
            let document = fitted(Document::read(&file).map_err(|e| e.to_string())?);
            let seen = stamps(files_of(&document));
            (document::reload(document, &Sources::default()), Some(file), seen)
        } else {
            let seen = stamps([known.clone()]);
            (document::open(&known).map_err(|e| e.to_string())?, None, seen)
        };
        Ok(Box::new(move |landing| {
            landing.note(&known, &opened.notices);
            landing.session.replace(opened, path);
            *landing.opened = true;
            landing.watch.start(seen);
            landing.preferences.remember(&known);
        }))
    })
}

/// With the fits of the metals that are stored in it, which older documents do not have: panels show them, and the
/// thread of the window must not wait for them.
fn fitted(mut document: Document) -> Document {
    document.presets.iter_mut().for_each(|metal| fit(Arc::make_mut(metal)));
    document
}

/// What was not saved when the program ended.
pub fn recovered(found: Found) -> Load {
    Load::new(format!("Recovering {}", found.title), true, move || {
        let Snapshot { document, path } = found.snapshot().clone();
        let seen = stamps(files_of(&document));
        let opened = document::reload(fitted(Document::clone(&document)), &Sources::default());
        Ok(Box::new(move |landing| {
            landing.session.replace(opened, path);
            landing.session.set_unsaved();
            *landing.opened = true;
            landing.watch.start(seen);
            landing.recovery.adopt(found);
            landing.outbox.push(Request::Notice("Recovered the unsaved edits; save them to keep them".into()));
        }))
    })
}

/// An HDRI.
pub fn environment(path: &Path) -> Load {
    let known = known_path(path);
    Load::new(format!("Loading {}", name_of(&known)), false, move || {
        let seen = stamps([known.clone()]);
        let (map, notices) = document::load_map(&known)?;
        Ok(Box::new(move |landing| {
            landing.note(&known, &notices);
            landing.watch.add(seen);
            landing.session.edit_sources(|sources| _ = sources.environments.insert(known.clone(), map));
            landing.session.seal();
            let (name, label) = (name_of(&known), "Load HDRI");
            let made = landing.session.document().environment.made.clone();
            landing.session.edit(label, &name, |document| {
                (document.environment.source, document.environment.made) = (Some(known), None);
            });
            // Skies are some 10 000 times as bright as what stands in other maps.
            if matches!(made, Some(MadeEntry::Sky(_))) {
                expose(landing.session, label, &name);
            }
        }))
    })
}

/// A picture for a texture slot of the material of that name.
pub fn texture(material: String, role: TextureRole, path: &Path) -> Load {
    let known = known_path(path);
    Load::new(format!("Loading {}", name_of(&known)), false, move || {
        let seen = stamps([known.clone()]);
        let image = document::load_image(&known)?;
        Ok(Box::new(move |landing| {
            let Some(index) = landing.session.document().materials.iter().position(|entry| entry.name == material)
            else {
                let gone = format!("{}: there is no material `{material}` any more; load it again", name_of(&known));
                return landing.outbox.push(Request::Error(gone));
            };
            landing.watch.add(seen);
            landing.session.edit_sources(|sources| _ = sources.images.insert(known.clone(), image));
            landing.session.seal();
            landing.session.edit(&format!("Load {} texture", role.name()), &material, |document| {
                document.set_texture(index, role, Some(TextureChoice::File(known)));
            });
        }))
    })
}

/// A file that changed on disk.
pub fn changed(kind: MissingKind, path: String) -> Load {
    Load::new(format!("Reloading {}", name_of(&path)), false, move || {
        let seen = stamps([path.clone()]);
        let read = Read::file(kind, &path)?;
        Ok(Box::new(move |landing| {
            landing.note(&path, &read.notices);
            landing.watch.add(seen);
            landing.session.edit_sources(|sources| read.insert(&path, sources));
            if let Content::Model(model) = &read.content {
                landing.session.seal();
                landing.session.edit("Reload", &name_of(&path), |document| document.sync(model));
            }
            landing.outbox.push(Request::Notice(format!("Reloaded {}", name_of(&path))));
        }))
    })
}

/// A missing file in its new place; others that are missing are looked for beside it.
pub fn relinked(missing: Missing, path: &Path, others: Vec<Missing>) -> Load {
    let known = known_path(path);
    Load::new(format!("Loading {}", name_of(&known)), false, move || {
        let mut seen = stamps([known.clone()]);
        let mut found = vec![(missing.path.clone(), known.clone(), Read::file(missing.kind, &known)?)];
        let folder = Path::new(&known).parent().unwrap_or(Path::new(""));
        for other in others.iter().filter(|other| **other != missing) {
            let beside = Path::new(&other.path).file_name().map(|name| folder.join(name));
            let beside = beside.filter(|file| file.is_file()).map(|file| file.to_string_lossy().into_owned());
            let Some(beside) = beside else { continue };
            let stamp = stamps([beside.clone()]);
            if let Ok(read) = Read::file(other.kind, &beside) {
                seen.extend(stamp);
                found.push((other.path.clone(), beside, read));
            }
        }
        Ok(Box::new(move |landing| {
            landing.watch.add(seen);
            land_relinked(landing, found);
        }))
    })
}

/// `found` holds old path, new path and content.
fn land_relinked(landing: &mut Landing<'_>, found: Vec<(String, String, Read)>) {
    landing.session.edit_sources(|sources| found.iter().for_each(|(_, new, read)| read.insert(new, sources)));
    landing.session.seal();
    let target = found.first().map(|(_, new, _)| name_of(new)).unwrap_or_default();
    landing.session.edit("Relink", &target, |document| {
        for (old, new, read) in &found {
            match &read.content {
                Content::Model(model) => {
                    document.scene = new.clone();
                    document.sync(model);
                }
                Content::Map(_) => document.replace_map(old, new),
                Content::Image(_) => document.replace_texture_file(old, new),
            }
        }
    });
    if found.len() > 1 {
        landing.outbox.push(Request::Notice(format!("Found {} more missing files beside it", found.len() - 1)));
    }
    let notices: Vec<String> = found.into_iter().flat_map(|(_, _, read)| read.notices).collect();
    landing.note(&target, &notices);
}

enum Content {
    Model(Arc<Scene>),
    Map(Arc<Environment>),
    Image(Arc<Image>),
}

/// A file of a document.
struct Read {
    content: Content,
    notices: Vec<String>,
}

impl Read {
    fn file(kind: MissingKind, path: &str) -> Result<Read, String> {
        let (content, notices) = match kind {
            MissingKind::Model => {
                let (model, notices) = document::load_model(path)?;
                (Content::Model(model), notices)
            }
            MissingKind::Environment => {
                let (map, notices) = document::load_map(path)?;
                (Content::Map(map), notices)
            }
            MissingKind::Texture => (Content::Image(document::load_image(path)?), Vec::new()),
        };
        Ok(Read { content, notices })
    }

    fn insert(&self, path: &str, sources: &mut Sources) {
        match &self.content {
            Content::Model(model) => _ = sources.models.insert(path.into(), model.clone()),
            Content::Map(map) => _ = sources.environments.insert(path.into(), map.clone()),
            Content::Image(image) => _ = sources.images.insert(path.into(), image.clone()),
        }
    }
}

/// Every file that a document refers to.
pub fn files_of(document: &Document) -> Vec<String> {
    let model = Some(document.scene.clone()).filter(|scene| !scene.starts_with("gallery:"));
    model.into_iter().chain(document.maps()).chain(document.texture_files()).collect()
}

/// What a file of a document is; `None` when the document does not refer to it.
pub fn kind_of(document: &Document, path: &str) -> Option<MissingKind> {
    if document.scene == path {
        Some(MissingKind::Model)
    } else if document.maps().iter().any(|map| map == path) {
        Some(MissingKind::Environment)
    } else {
        document.texture_files().iter().any(|file| file == path).then_some(MissingKind::Texture)
    }
}

impl Landing<'_> {
    fn note(&mut self, path: &str, lines: &[String]) {
        if lines.is_empty() {
            return;
        }
        let title = name_of(path);
        let count = if lines.len() == 1 { "1 notice".into() } else { format!("{} notices", lines.len()) };
        self.outbox.push(Request::Notice(format!("{count} about {title}; see Help, Notices")));
        *self.notices = Notices { title, lines: lines.to_vec() };
    }
}
