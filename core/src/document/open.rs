//! A document with the files that it refers to.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use glam::{Affine3A, Vec3};
use serde_json::Map;

use super::{CameraEntry, DEFAULT_SCENE, Document, DocumentError, TextureChoice, absolute};
use crate::import::{self, ImportOptions};
use crate::material::Material;
use crate::scene::{Camera, Environment, Image, Instance, Scene, gallery};

/// Files that were read, by the path under which documents know them. What an undone edit refers to stays here.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    /// Models and gallery scenes.
    pub models: BTreeMap<String, Arc<Scene>>,
    /// HDRIs.
    pub environments: BTreeMap<String, Arc<Environment>>,
    /// Textures that were loaded into slots.
    pub images: BTreeMap<String, Arc<Image>>,
}

/// What a document refers to and cannot be read; something stands in for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// What it is.
    pub kind: MissingKind,
    /// Where it was looked for.
    pub path: String,
    /// Why it cannot be read, in words.
    pub reason: String,
}

/// The kinds of files that documents refer to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MissingKind {
    /// A row of balls with the document's materials stands in.
    Model,
    /// The built-in studio stands in.
    Environment,
    /// The slot is empty.
    Texture,
}

/// A document that was opened.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The document, in step with its model.
    pub document: Document,
    /// What could be read of its files.
    pub sources: Sources,
    /// What could not.
    pub missing: Vec<Missing>,
    /// What importers left out, repaired or guessed.
    pub notices: Vec<String>,
}

/// True for a path that names a document.
pub fn is_document(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("burnish"))
}

/// Opens a `.burnish` document, or makes a new one about a model file or `gallery:NAME[?key=value&...]`.
///
/// A document whose files are missing opens all the same; a model or gallery scene that cannot be read is an error.
pub fn open(scene: &str) -> Result<Opened, DocumentError> {
    if !scene.starts_with("gallery:") && is_document(Path::new(scene)) {
        return Ok(reload(Document::read(Path::new(scene))?, &Sources::default()));
    }
    let path = if scene.starts_with("gallery:") { scene.into() } else { absolute_now(scene) };
    let (model, notices) = load_model(&path).map_err(DocumentError::Source)?;
    let mut document = Document::new(path.clone());
    document.sync(&model);
    document.view.camera = first_view(&model, path.starts_with("gallery:"));
    let sources = Sources { models: BTreeMap::from([(path, model)]), ..Sources::default() };
    Ok(Opened { document, sources, missing: Vec::new(), notices })
}

/// Reads the files of a document anew; those of `known` that still stand under the same path are taken from there.
pub fn reload(mut document: Document, known: &Sources) -> Opened {
    let mut sources = Sources::default();
    let (mut missing, mut notices) = (Vec::new(), Vec::new());
    let path = document.scene.clone();
    let model = known.models.get(&path).map(|model| Ok((model.clone(), Vec::new())));
    match model.unwrap_or_else(|| load_model(&path)) {
        Ok((model, more)) => {
            document.sync(&model);
            notices.extend(more);
            sources.models.insert(path, model);
        }
        Err(reason) => missing.push(Missing { kind: MissingKind::Model, path, reason }),
    }
    for path in document.maps() {
        match known.environments.get(&path).map(|map| Ok((map.clone(), Vec::new()))).unwrap_or_else(|| load_map(&path))
        {
            Ok((map, more)) => {
                notices.extend(more);
                sources.environments.insert(path, map);
            }
            Err(reason) => missing.push(Missing { kind: MissingKind::Environment, path, reason }),
        }
    }
    for path in document.texture_files() {
        match known.images.get(&path).map(|image| Ok(image.clone())).unwrap_or_else(|| load_image(&path)) {
            Ok(image) => _ = sources.images.insert(path, image),
            Err(reason) => missing.push(Missing { kind: MissingKind::Texture, path, reason }),
        }
    }
    Opened { document, sources, missing, notices }
}

/// Reads a texture; the error is in words.
pub fn load_image(path: &str) -> Result<Arc<Image>, String> {
    import::load_image(Path::new(path)).map(Arc::new).map_err(|e| e.to_string())
}

/// Reads a model or makes a scene of the gallery, with notices; the error is in words.
pub fn load_model(path: &str) -> Result<(Arc<Scene>, Vec<String>), String> {
    if path.starts_with("gallery:") {
        return Ok((Arc::new(gallery::open(path).map_err(|e| e.to_string())?), Vec::new()));
    }
    let imported = import::load_scene(Path::new(path), &ImportOptions::default()).map_err(|e| e.to_string())?;
    Ok((Arc::new(imported.scene), imported.notices.iter().map(ToString::to_string).collect()))
}

/// Reads an HDRI, with notices; the error is in words.
pub fn load_map(path: &str) -> Result<(Arc<Environment>, Vec<String>), String> {
    let (map, notices) = import::load_environment(Path::new(path)).map_err(|e| e.to_string())?;
    Ok((Arc::new(map), notices.iter().map(ToString::to_string).collect()))
}

fn absolute_now(path: &str) -> String {
    absolute(path, &std::env::current_dir().unwrap_or_default())
}

/// The first camera of a gallery scene, which shows what it is about; all of a model, which may have any camera.
fn first_view(model: &Scene, from_gallery: bool) -> CameraEntry {
    let bounds = model.bounds();
    let first = model.cameras.first().filter(|_| from_gallery).cloned();
    let camera = first.unwrap_or_else(|| Camera::frame(bounds, 1.5));
    CameraEntry { name: String::new(), ..CameraEntry::from_camera(&camera, bounds) }
}

impl Document {
    /// A document about a scene, with nothing changed. [`Document::sync`] gives it the materials.
    pub fn new(scene: String) -> Document {
        Document {
            scene,
            subject: Vec::new(),
            materials: Vec::new(),
            assignments: Vec::new(),
            objects: Vec::new(),
            presets: Vec::new(),
            environment: Default::default(),
            lights: None,
            probes: Vec::new(),
            cameras: Vec::new(),
            lighting: Default::default(),
            view: Default::default(),
            snapshots: Vec::new(),
            compare: Default::default(),
            other: Map::new(),
        }
    }

    /// Paths of its environment and those of its snapshots, each once.
    pub fn maps(&self) -> Vec<String> {
        let of_snapshots = self.snapshots.iter().map(|snapshot| &snapshot.environment);
        let mut paths: Vec<String> =
            std::iter::once(&self.environment).chain(of_snapshots).filter_map(|e| e.source.clone()).collect();
        paths.sort();
        paths.dedup();
        paths
    }

    /// Paths of the textures that were loaded into slots, also those of snapshots, each once.
    pub fn texture_files(&self) -> Vec<String> {
        let of_snapshots = self.snapshots.iter().flat_map(|snapshot| &snapshot.materials);
        let choices = self.materials.iter().chain(of_snapshots).flat_map(|entry| entry.textures.values());
        let mut paths: Vec<String> = choices
            .filter_map(|choice| match choice {
                TextureChoice::File(path) => Some(path.clone()),
                TextureChoice::None | TextureChoice::Image(_) => None,
            })
            .collect();
        paths.sort();
        paths.dedup();
        paths
    }
}

impl Default for Document {
    fn default() -> Self {
        Document::new(DEFAULT_SCENE.into())
    }
}

/// What is shown instead of a missing model: a ball for each material of the document.
pub fn placeholder(document: &Document) -> Scene {
    let mut scene = Scene { name: "missing model".into(), ..Scene::default() };
    scene.meshes.push(Arc::new(gallery::shape::sphere(0.5, 64)));
    let sources = document.materials.iter().filter_map(|entry| entry.source.clone());
    let mut names: Vec<String> = sources.collect();
    names.dedup();
    if names.is_empty() {
        names.push("default".into());
    }
    for (index, name) in names.into_iter().enumerate() {
        scene.materials.push(Material { name: name.clone(), ..Material::default() });
        let place = Vec3::new(1.2 * (index % 8) as f32, -1.2 * (index / 8) as f32, 0.0);
        scene.instances.push(Instance {
            name,
            mesh: 0,
            material: index,
            world_from_local: Affine3A::from_translation(place),
            visible: true,
        });
    }
    scene
}
