//! What is open: the document with its history and files, the scene made of them, the selection.
//!
//! Panels read it and edit it through [`Session::edit`]; nothing here draws or starts work.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::document::{Curves, Document, History, MaterialEntry, Missing, Opened, Resolved, Sources, resolve};
use burnish_core::lighting::probe::Site;
use burnish_core::lighting::{Layers, impostor};
use burnish_core::scene::{Bounds, Scene};

/// What the next command is about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Keys of objects.
    pub objects: Vec<String>,
    /// Index of the material that the inspector shows.
    pub material: usize,
    /// Names of lights.
    pub lights: Vec<String>,
}

/// An open document.
pub struct Session {
    history: History,
    sources: Sources,
    curves: Curves,
    resolved: Resolved,
    layers: Layers,
    /// Boxes of what the picture is about and of all, measured when someone asks.
    subject_bounds: OnceCell<Bounds>,
    probe_sites: OnceCell<Vec<Site>>,
    bounds: OnceCell<Bounds>,
    /// Where the document is saved; `None` before the first time.
    pub path: Option<PathBuf>,
    saved: Arc<Document>,
    /// What is selected.
    pub selection: Selection,
    /// The copied material.
    pub clipboard: Option<Arc<MaterialEntry>>,
    /// Files that the document refers to and that could not be read, with the reason.
    pub missing: Vec<Missing>,
    /// All that could not be read since the document was opened.
    unread: Vec<Missing>,
    /// Seconds of the window's clock, set once a frame.
    pub now_secs: f64,
    /// Counts every change of the document, for whoever wants to notice one.
    pub revision: u64,
    /// Counts every change of the files.
    pub files_revision: u64,
}

impl Session {
    /// A session about what was opened; `path` is the document's file if it has one.
    pub fn new(opened: Opened, path: Option<PathBuf>) -> Session {
        let Opened { document, sources, missing, notices: _ } = opened;
        let mut curves = Curves::default();
        let resolved = resolve(&document, &sources, &mut curves);
        let layers = document.lighting.layers(&resolved.object_keys);
        let history = History::new(document);
        let saved = history.current().clone();
        Session {
            history,
            sources,
            curves,
            resolved,
            layers,
            subject_bounds: OnceCell::new(),
            probe_sites: OnceCell::new(),
            bounds: OnceCell::new(),
            path,
            saved,
            selection: Selection::default(),
            clipboard: None,
            unread: missing.clone(),
            missing,
            now_secs: 0.0,
            revision: 0,
            files_revision: 0,
        }
    }

    /// The document as it is now.
    pub fn document(&self) -> &Arc<Document> {
        self.history.current()
    }

    /// The scene as it is drawn.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.resolved.scene
    }

    /// The scene with what stands in for something else.
    pub fn resolved(&self) -> &Resolved {
        &self.resolved
    }

    /// What lights the scene.
    pub fn layers(&self) -> &Layers {
        &self.layers
    }

    /// Box of what the picture is about. Measured once for a scene: that visits every vertex.
    pub fn subject_bounds(&self) -> Bounds {
        *self.subject_bounds.get_or_init(|| self.scene().subject_bounds())
    }

    /// Where the probes of the method stand, found likewise.
    pub fn probe_sites(&self) -> &[Site] {
        let find = || impostor::sites(self.scene(), &self.document().lighting.settings()).list;
        self.probe_sites.get_or_init(find)
    }

    /// Box of the whole scene, measured likewise.
    pub fn bounds(&self) -> Bounds {
        *self.bounds.get_or_init(|| self.scene().bounds())
    }

    /// The files of the document.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Past and future.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Changes the document as one labelled step, see [`History::edit`]; `target` is what is edited.
    pub fn edit(&mut self, label: &str, target: &str, change: impl FnOnce(&mut Document)) {
        let before = self.history.current().clone();
        if self.history.edit(label, target, self.now_secs, change) {
            self.follow(&before);
        }
    }

    /// Ends the running step, such as when a drag ends.
    pub fn seal(&mut self) {
        self.history.seal();
    }

    /// Takes back the last step and returns its label.
    pub fn undo(&mut self) -> Option<String> {
        let before = self.history.current().clone();
        let label = self.history.undo()?.label.clone();
        self.follow(&before);
        Some(label)
    }

    /// Does the last undone step again and returns its label.
    pub fn redo(&mut self) -> Option<String> {
        let before = self.history.current().clone();
        let label = self.history.redo()?.label.clone();
        self.follow(&before);
        Some(label)
    }

    /// Goes to the state after `count` steps from the start.
    pub fn go_to(&mut self, count: usize) {
        self.history.go_to(count);
        self.refresh();
    }

    /// Takes over files that were read.
    pub fn edit_sources(&mut self, change: impl FnOnce(&mut Sources)) {
        change(&mut self.sources);
        self.files_revision += 1;
        self.refresh();
    }

    /// The document differs from its file. Looking at something that has no file yet from another side is no change.
    pub fn is_dirty(&self) -> bool {
        if Arc::ptr_eq(self.document(), &self.saved) || **self.document() == *self.saved {
            return false;
        }
        self.path.is_some() || self.document().scene != self.saved.scene || {
            let mut seen_alike = Document::clone(&self.saved);
            seen_alike.view.camera = self.document().view.camera.clone();
            seen_alike != **self.document()
        }
    }

    /// This document, which was the current one when it was handed out, was written to `path`.
    pub fn set_saved(&mut self, path: &Path, document: Arc<Document>) {
        self.saved = document;
        self.path = Some(path.into());
    }

    /// Goes over to another document. The clipboard stays.
    pub fn replace(&mut self, opened: Opened, path: Option<PathBuf>) {
        let former = std::mem::replace(self, Session::new(opened, path));
        self.clipboard = former.clipboard;
        self.now_secs = former.now_secs;
        self.revision = former.revision + 1;
        self.files_revision = former.files_revision + 1;
    }

    /// The document has changes that no file holds, such as after a recovery.
    pub fn set_unsaved(&mut self) {
        let mut other = Document::clone(self.document());
        other.scene.clear();
        self.saved = Arc::new(other);
    }

    /// Name of the document for people.
    pub fn title(&self) -> String {
        let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let of_scene = || match self.document().scene.strip_prefix("gallery:") {
            Some(name) => Some(name.into()),
            None => stem(Path::new(&self.document().scene)),
        };
        self.path.as_deref().and_then(stem).or_else(of_scene).unwrap_or_else(|| "untitled".into())
    }

    /// The material that the inspector shows.
    pub fn material(&self) -> Option<&Arc<MaterialEntry>> {
        self.document().materials.get(self.selection.material)
    }

    /// Indices of the materials of the selected objects; the inspector's where none is selected. Each once.
    pub fn selected_materials(&self) -> Vec<usize> {
        let scene = self.scene();
        let keys = self.resolved.object_keys.iter().zip(&scene.instances);
        let mut of_objects: Vec<usize> =
            keys.filter(|(key, _)| self.selection.objects.contains(key)).map(|(_, i)| i.material).collect();
        of_objects.sort_unstable();
        of_objects.dedup();
        of_objects.retain(|index| *index < self.document().materials.len());
        if of_objects.is_empty() && self.selection.material < self.document().materials.len() {
            of_objects.push(self.selection.material);
        }
        of_objects
    }

    /// Follows a change of the document. The scene stays the same `Arc` where only the view moved.
    fn follow(&mut self, before: &Document) {
        let now = self.document();
        let same = before.materials == now.materials
            && before.scene == now.scene
            && before.environment == now.environment
            && before.assignments == now.assignments
            && before.objects == now.objects
            && before.lights == now.lights
            && before.probes == now.probes
            && before.presets == now.presets
            && before.lighting.method == now.lighting.method
            && before.lighting.settings == now.lighting.settings
            // A notice tells of an unknown one.
            && before.view.tone.parse::<ToneMap>().is_err() == now.view.tone.parse::<ToneMap>().is_err();
        if same {
            let lit_otherwise = before.lighting != now.lighting;
            self.revision += 1;
            if lit_otherwise {
                self.layers = self.history.current().lighting.layers(&self.resolved.object_keys);
            }
        } else {
            self.refresh();
        }
    }

    fn refresh(&mut self) {
        self.revision += 1;
        self.resolved = resolve(self.history.current(), &self.sources, &mut self.curves);
        self.layers = self.history.current().lighting.layers(&self.resolved.object_keys);
        self.subject_bounds.take();
        self.probe_sites.take();
        self.bounds.take();
        let known = |missing: &Missing| self.unread.iter().find(|m| m.path == missing.path && m.kind == missing.kind);
        self.missing = self.resolved.missing.iter().map(|missing| known(missing).unwrap_or(missing).clone()).collect();
        let materials = self.document().materials.len();
        self.selection.material = self.selection.material.min(materials.saturating_sub(1));
        self.selection.objects.retain(|key| self.resolved.object_keys.contains(key));
        if !self.selection.lights.is_empty() {
            let lights = super::lights::entries(self);
            self.selection.lights.retain(|name| lights.iter().any(|light| light.name == *name));
        }
    }
}
