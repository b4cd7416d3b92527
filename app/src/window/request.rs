//! What panels ask the window to do: everything that is not an edit of the document.

use std::path::PathBuf;

use burnish_core::document::{Missing, MissingKind};
use burnish_core::material::TextureRole;

use super::commands::Command;

/// One wish of a panel. The window fulfils it after the frame.
#[derive(Clone, Debug)]
pub enum Request {
    /// A command of the table.
    Command(Command),
    /// Open a model, `gallery:NAME` or document in place of the current one.
    OpenScene(String),
    /// Light the scene with an HDRI.
    LoadEnvironment(PathBuf),
    /// Load a picture into a texture slot of a material, by index.
    LoadTexture {
        /// Index of the material.
        material: usize,
        /// The slot.
        role: TextureRole,
        /// PNG or JPEG.
        path: PathBuf,
    },
    /// Put a preset of the browser on materials, by index.
    AssignPreset {
        /// Its key: the id of a metal, or `material:NAME`.
        preset: String,
        /// The materials.
        materials: Vec<usize>,
    },
    /// Read a preset file, keep it with the user's, and put it on the selected materials; show a table of optical
    /// constants first.
    ImportPreset(PathBuf),
    /// Show a pasted table of optical constants, to be kept with the user's presets.
    ImportText(String),
    /// Look for a missing file in another place.
    Relink {
        /// What is missing.
        missing: Missing,
        /// Where it is now.
        path: PathBuf,
    },
    /// Ask for a file with a dialog.
    PickFile(Purpose),
    /// Write the recovery file now: what draws the window has failed.
    WriteRecovery,
    /// Say something that passes.
    Notice(String),
    /// Say what went wrong, in words.
    Error(String),
}

/// What a picked file is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Purpose {
    /// A model or document.
    Scene,
    /// An HDRI.
    Environment,
    /// A texture of a material, by index.
    Texture {
        /// Index of the material.
        material: usize,
        /// The slot.
        role: TextureRole,
    },
    /// A metal preset.
    Preset,
    /// A lighting preset to light the subject by.
    ImportLighting,
    /// The lights as a preset.
    ExportLighting,
    /// What is missing under this kind, by its place in the session's list.
    Missing {
        /// What it is.
        kind: MissingKind,
        /// Place in the list.
        index: usize,
    },
}

/// Requests of one frame, in order.
pub type Requests = Vec<Request>;
