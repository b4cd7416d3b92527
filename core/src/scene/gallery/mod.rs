//! Built-in scenes made by code: one file or folder per scene, all listed in [`list`].
//!
//! A scene is named on the command line as `gallery:NAME[?key=value&...]` and opened by [`open`]. The keys are
//! declared settings, so that help and messages show the same list. [`studio`] is the environment that lights a
//! scene that brings none.

mod ball;
mod bowls;
mod box_sphere;
mod cabin;
mod corner;
mod crate_box;
mod parts;
mod pattern;
mod ring;
mod room;
pub mod shape;
mod statue;
mod studio;
mod teapot;
#[cfg(test)]
mod tests;
mod wall;
mod workbench;

use super::Scene;
use crate::param::{ParamError, ParamSpec, ParamValue, Settings};

pub use studio::studio;

/// A scene made by code.
#[derive(Clone, Copy, Debug)]
pub struct GalleryScene {
    /// Name after `gallery:`.
    pub name: &'static str,
    /// One line for people.
    pub title: &'static str,
    /// What may follow the `?`.
    pub params: &'static [ParamSpec],
    /// Makes the scene from the values of [`GalleryScene::params`].
    pub build: fn(&Settings) -> Scene,
}

/// Why a gallery scene could not be opened. The text says what there is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GalleryError {
    /// No scene of that name.
    #[error("no gallery scene `{name}`; there are: {known}")]
    UnknownScene {
        /// What was asked for.
        name: String,
        /// All names.
        known: String,
    },
    /// A part after the `?` is not `key=value`.
    #[error("gallery:{scene}: `{text}` is not `key=value`")]
    Malformed {
        /// The scene.
        scene: &'static str,
        /// The part.
        text: String,
    },
    /// A key was given twice.
    #[error("gallery:{scene}: `{key}` is set twice")]
    Twice {
        /// The scene.
        scene: &'static str,
        /// The key.
        key: String,
    },
    /// A key or value that the scene does not take.
    #[error("gallery:{scene}: {source}")]
    Param {
        /// The scene.
        scene: &'static str,
        /// What is wrong with it.
        source: ParamError,
    },
}

/// All scenes, the default first.
pub fn list() -> &'static [GalleryScene] {
    const LIST: &[GalleryScene] = &[
        workbench::SCENE,
        ball::SCENE,
        ring::SCENE,
        room::SCENE,
        crate_box::SCENE,
        box_sphere::SCENE,
        statue::STATUE,
        statue::FIREBALLS,
        corner::SCENE,
        teapot::SCENE,
        bowls::SCENE,
        cabin::SCENE,
        wall::SCENE,
    ];
    LIST
}

/// Makes the scene that `spec` names: `NAME[?key=value&...]`, with or without `gallery:` before it.
pub fn open(spec: &str) -> Result<Scene, GalleryError> {
    let spec = spec.strip_prefix("gallery:").unwrap_or(spec);
    let (name, query) = spec.split_once('?').unwrap_or((spec, ""));
    let scene = list().iter().find(|scene| scene.name == name).ok_or_else(|| GalleryError::UnknownScene {
        name: name.into(),
        known: list().iter().map(|scene| scene.name).collect::<Vec<_>>().join(", "),
    })?;
    Ok((scene.build)(&settings(scene, query)?))
}

/// Reads `key=value&key=value` for a scene.
fn settings(scene: &GalleryScene, query: &str) -> Result<Settings, GalleryError> {
    let mut settings = Settings::new(scene.params);
    let mut seen = Vec::new();
    for part in query.split('&').filter(|part| !part.is_empty()) {
        let (key, text) =
            part.split_once('=').ok_or_else(|| GalleryError::Malformed { scene: scene.name, text: part.into() })?;
        settings.set(key, text).map_err(|source| GalleryError::Param { scene: scene.name, source })?;
        if seen.contains(&key) {
            return Err(GalleryError::Twice { scene: scene.name, key: key.into() });
        }
        seen.push(key);
    }
    Ok(settings)
}

/// Value of a declared number.
fn number(settings: &Settings, key: &str) -> f32 {
    match settings.get(key) {
        Some(ParamValue::Number(value)) => value as f32,
        other => {
            debug_assert!(false, "`{key}` is declared as a number, not {other:?}");
            0.0
        }
    }
}
