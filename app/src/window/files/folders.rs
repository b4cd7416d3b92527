//! Where the program keeps what belongs to its user.

use std::path::{Path, PathBuf};

use directories::ProjectDirs;

/// Folders of the user, or of a test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folders {
    config: PathBuf,
    data: PathBuf,
    cache: PathBuf,
}

impl Folders {
    /// Those that the system gives programs; `None` for a user without a home.
    pub fn of_user() -> Option<Folders> {
        let of_system = ProjectDirs::from("", "", "burnish")?;
        Some(Folders {
            config: of_system.config_dir().into(),
            data: of_system.data_dir().into(),
            cache: of_system.cache_dir().into(),
        })
    }

    /// All in one folder.
    pub fn within(folder: &Path) -> Folders {
        Folders { config: folder.into(), data: folder.into(), cache: folder.into() }
    }

    /// The user's choices.
    pub fn preferences(&self) -> PathBuf {
        self.config.join("preferences.json")
    }

    /// Documents that were not saved yet.
    pub fn recovery(&self) -> PathBuf {
        self.data.join("recovery")
    }

    /// Pictures of presets, which can be made again.
    pub fn thumbnails(&self) -> PathBuf {
        self.cache.join("thumbnails")
    }

    /// References and measurements of the bench, which can be made again.
    pub fn bench(&self) -> PathBuf {
        self.cache.join("bench")
    }

    /// What lighting methods prepared, which can be made again.
    pub fn prepared(&self) -> PathBuf {
        self.cache.join("prepared")
    }

    /// Metals and saved materials of the user.
    pub fn presets(&self) -> PathBuf {
        self.data.join("presets")
    }

    /// Lighting presets of the user.
    pub fn lightings(&self) -> PathBuf {
        self.presets().join("lighting")
    }
}
