//! What belongs to the user and not to a document: recent files, favourites, theme, navigation, layout.
//!
//! One JSON file in the user's configuration folder. A file that cannot be read is set aside, not overwritten silently.

use std::fs;
use std::path::Path;

use burnish_core::file::{read_bounded, write_atomic};
use serde::{Deserialize, Serialize};

/// Largest file that is read.
const MAX_BYTES: u64 = 1 << 20;

/// Recent documents that are kept.
const MAX_RECENT: usize = 12;

/// The user's choices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Documents and models, the last opened first.
    pub recent: Vec<String>,
    /// Ids of presets.
    pub favourites: Vec<String>,
    /// Dark instead of light; as the system does when absent.
    pub dark: Option<bool>,
    /// Scale of text and widgets.
    pub ui_scale: f32,
    /// Mouse buttons of the viewport.
    pub navigation: Navigation,
    /// Where the panels are; as at first when absent or unreadable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layout: Option<serde_json::Value>,
    /// Factor on how far a drag or a turn of the wheel goes, 0.1 to 10.
    pub navigation_speed: f32,
    /// Zooms the other way.
    pub invert_zoom: bool,
}

/// Which mouse buttons turn, shift and zoom. None needs Alt alone: window managers take it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Navigation {
    /// Left turns, middle or Ctrl+right shifts, wheel or right zooms.
    #[default]
    Burnish,
    /// Middle turns, Shift+middle shifts, Ctrl+middle or wheel zooms.
    Blender,
    /// Alt+left or Ctrl+left turns, Alt+middle or middle shifts, Alt+right, right or wheel zooms.
    Maya,
}

impl Default for Preferences {
    fn default() -> Self {
        Preferences {
            recent: Vec::new(),
            favourites: Vec::new(),
            dark: None,
            ui_scale: 1.0,
            navigation: Navigation::default(),
            layout: None,
            navigation_speed: 1.0,
            invert_zoom: false,
        }
    }
}

impl Preferences {
    /// Puts a document at the top of the recent ones.
    pub fn remember(&mut self, scene: &str) {
        self.recent.retain(|known| known != scene);
        self.recent.insert(0, scene.into());
        self.recent.truncate(MAX_RECENT);
    }

    /// Reads the file, with what the user must know; defaults where there is none.
    pub fn read(path: &Path) -> (Preferences, Option<String>) {
        if !path.exists() {
            return (Preferences::default(), None);
        }
        let parse = |bytes: Vec<u8>| serde_json::from_slice(&bytes).map_err(|e| format!("{}: {e}", path.display()));
        match read_bounded(path, MAX_BYTES).map_err(|e| e.to_string()).and_then(parse) {
            Ok(preferences) => (preferences, None),
            Err(reason) => {
                let aside = path.with_extension("damaged.json");
                let kept = match fs::rename(path, &aside) {
                    Ok(()) => format!("it was set aside as {}", aside.display()),
                    Err(e) => format!("it cannot be set aside ({e})"),
                };
                (Preferences::default(), Some(format!("the preferences cannot be read: {reason}; {kept}")))
            }
        }
    }

    /// Writes the file as a whole or not at all; what went wrong is said in words.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let fault = |e: String| format!("the preferences cannot be kept: {e}");
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|e| fault(format!("{} ({e})", folder.display())))?;
        }
        let text = serde_json::to_string_pretty(self).map_err(|e| fault(e.to_string()))?;
        write_atomic(path, text.as_bytes()).map_err(|e| fault(e.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preferences_come_back_and_a_damaged_file_is_set_aside() {
        let folder = std::env::temp_dir().join(format!("burnish-preferences-{}", std::process::id()));
        let path = folder.join("deep/preferences.json");
        assert_eq!(Preferences::read(&path), (Preferences::default(), None));
        let mut preferences = Preferences::default();
        (0..20).for_each(|i| preferences.remember(&format!("{i}.glb")));
        preferences.remember("12.glb");
        preferences.write(&path).unwrap();
        assert_eq!(Preferences::read(&path), (preferences.clone(), None));
        assert_eq!((preferences.recent.len(), preferences.recent[0].as_str()), (MAX_RECENT, "12.glb"));

        fs::write(&path, "{\"recent\": 3}").unwrap();
        let (read, notice) = Preferences::read(&path);
        assert_eq!(read, Preferences::default());
        assert!(notice.unwrap().contains("preferences.damaged.json"));
        assert!(!path.exists() && path.with_extension("damaged.json").exists());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_file_of_another_version_keeps_what_is_known() {
        let read: Preferences = serde_json::from_str("{\"ui_scale\": 1.5, \"from_the_future\": 1}").unwrap();
        assert_eq!(read.ui_scale, 1.5);
    }
}
