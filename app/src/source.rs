//! SCENE arguments: a model file, a document, or `gallery:NAME[?key=value&...]`.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::sync::Arc;

use burnish_core::document::{self, Curves, Document, Missing, Sources, resolve};
use burnish_core::import::{self, ImportOptions};
use burnish_core::scene::{Camera, Environment, Scene, gallery};
use glam::UVec2;

use crate::failure::{Exit, Failure};

/// What is opened when no scene is named.
pub const DEFAULT_SCENE: &str = "gallery:workbench";

/// The scene that a command works on.
#[derive(clap::Args)]
pub struct SceneArg {
    /// Model file (.gltf, .glb, .obj), document (.burnish) or gallery:NAME[?key=value&...]
    #[arg(default_value = DEFAULT_SCENE)]
    scene: OsString,
}

/// An opened scene.
pub struct Opened {
    pub scene: Scene,
    /// What the importer left out, repaired or guessed, one line each.
    pub notices: Vec<String>,
    /// Made by code, with a first camera that shows what the scene is about.
    pub from_gallery: bool,
    /// The document that describes the scene, if it was one: its view and lighting count where no option says else.
    pub document: Option<Document>,
    /// Keys of its objects, in the order of the scene's instances.
    pub object_keys: Vec<String>,
    /// Files of the document that something stands in for.
    pub missing: Vec<Missing>,
}

impl SceneArg {
    /// A SCENE that no command line names.
    pub fn named(scene: &str) -> SceneArg {
        SceneArg { scene: scene.into() }
    }

    pub fn open(&self) -> Result<Opened, Failure> {
        open(&self.scene)
    }

    /// The file that is named, if it is one.
    pub fn file(&self) -> Option<&Path> {
        gallery_name(&self.scene).is_none().then(|| Path::new(&self.scene))
    }
}

/// Opens a SCENE.
pub fn open(scene: &OsStr) -> Result<Opened, Failure> {
    if let Some(name) = gallery_name(scene) {
        let scene = gallery::open(name).map_err(|e| Failure::input(Path::new(scene), e))?;
        return Ok(Opened {
            scene,
            notices: Vec::new(),
            from_gallery: true,
            document: None,
            object_keys: Vec::new(),
            missing: Vec::new(),
        });
    }
    let path = Path::new(scene);
    if document::is_document(path) {
        return open_document(path);
    }
    let imported = import::load_scene(path, &ImportOptions::default()).map_err(|e| Failure::input(path, e))?;
    let notices = imported.notices.iter().map(ToString::to_string).collect();
    let scene = imported.scene;
    Ok(Opened { scene, notices, from_gallery: false, document: None, object_keys: Vec::new(), missing: Vec::new() })
}

fn open_document(path: &Path) -> Result<Opened, Failure> {
    let document = Document::read(path).map_err(|e| Failure::input(path, e))?;
    let document::Opened { document, sources, missing, mut notices } = document::reload(document, &Sources::default());
    let resolved = resolve(&document, &sources, &mut Curves::default());
    notices.extend(resolved.notices);
    let object_keys = resolved.object_keys;
    // Nothing else holds the scene.
    let scene = Arc::unwrap_or_clone(resolved.scene);
    Ok(Opened { scene, notices, from_gallery: false, document: Some(document), object_keys, missing })
}

impl Opened {
    /// Refuses a document whose files are missing: what stands in for them is for people who look.
    pub fn complete(self) -> Result<Opened, Failure> {
        if self.missing.is_empty() {
            return Ok(self);
        }
        let line = |missing: &Missing| format!("{}: {}; relink it in the window", missing.path, missing.reason);
        Err(Failure { exit: Exit::Input, messages: self.missing.iter().map(line).collect() })
    }

    /// From where it is looked at when nothing else is said: the document's view, the first camera of a gallery scene,
    /// all of a model in a picture of that shape.
    pub fn camera(&self, size: UVec2) -> Camera {
        match (&self.document, self.scene.cameras.first()) {
            (Some(document), _) => document.view.camera.camera(),
            (None, Some(camera)) if self.from_gallery => camera.clone(),
            _ => Camera::frame(self.scene.bounds(), size.x as f32 / size.y as f32),
        }
    }

    /// Puts the environment of an option in, else a studio where the scene has none.
    pub fn light(&mut self, environment: Option<&EnvironmentFile>) {
        if let Some(EnvironmentFile { environment, notices }) = environment {
            self.scene.environment = Some(environment.clone());
            self.notices.extend(notices.iter().cloned());
        } else if self.scene.environment.is_none() {
            self.scene.environment = Some(Arc::new(gallery::studio()));
        }
    }
}

/// The part after `gallery:`.
pub fn gallery_name(scene: &OsStr) -> Option<&str> {
    scene.to_str()?.strip_prefix("gallery:")
}

/// The file of `--env`.
pub struct EnvironmentFile {
    pub environment: Arc<Environment>,
    notices: Vec<String>,
}

/// Reads it.
pub fn environment(path: &Path) -> Result<EnvironmentFile, Failure> {
    let (environment, notices) = import::load_environment(path).map_err(|e| Failure::input(path, e))?;
    Ok(EnvironmentFile {
        environment: Arc::new(environment),
        notices: notices.iter().map(ToString::to_string).collect(),
    })
}
