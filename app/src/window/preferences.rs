//! What belongs to the user and not to a document: recent files, favourites, theme, navigation, layout.
//!
//! One JSON file in the user's configuration folder. A file that cannot be read is set aside, not overwritten silently.

use serde::{Deserialize, Serialize};

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
}
