//! SCENE arguments: a model file, or `gallery:NAME[?key=value&...]`.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::sync::Arc;

use burnish_core::import::{self, ImportOptions};
use burnish_core::scene::{Environment, Scene, gallery};

use crate::failure::Failure;

/// What is opened when no scene is named.
pub const DEFAULT_SCENE: &str = "gallery:workbench";

/// The scene that a command works on.
#[derive(clap::Args)]
pub struct SceneArg {
    /// Model file (.gltf, .glb, .obj) or gallery:NAME[?key=value&...]
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
}

impl SceneArg {
    pub fn open(&self) -> Result<Opened, Failure> {
        if let Some(name) = gallery_name(&self.scene) {
            let scene = gallery::open(name).map_err(|e| Failure::input(Path::new(&self.scene), e))?;
            return Ok(Opened { scene, notices: Vec::new(), from_gallery: true });
        }
        let path = Path::new(&self.scene);
        let imported = import::load_scene(path, &ImportOptions::default()).map_err(|e| Failure::input(path, e))?;
        let notices = imported.notices.iter().map(ToString::to_string).collect();
        Ok(Opened { scene: imported.scene, notices, from_gallery: false })
    }
}

/// The part after `gallery:`.
pub fn gallery_name(scene: &OsStr) -> Option<&str> {
    scene.to_str()?.strip_prefix("gallery:")
}

/// Reads the file of `--env`, with notices.
pub fn environment(path: &Path) -> Result<(Arc<Environment>, Vec<String>), Failure> {
    let (environment, notices) = import::load_environment(path).map_err(|e| Failure::input(path, e))?;
    Ok((Arc::new(environment), notices.iter().map(ToString::to_string).collect()))
}
