//! What can be shown of a search instead of the light that it finds.

use glam::Vec3;

use super::Found;

/// Number of [`Show::Light`] in shaders.
pub const SHOW_LIGHT: u32 = 0;
/// Number of [`Show::Lookups`].
pub const SHOW_LOOKUPS: u32 = 1;
/// Number of [`Show::Ratio`].
pub const SHOW_RATIO: u32 = 2;
/// Number of [`Show::Error`].
pub const SHOW_ERROR: u32 = 3;

/// Lookups that are shown as the most.
pub const MOST_LOOKUPS: f32 = 32.0;
/// Ratio off 1 that is shown as the most.
pub const MOST_RATIO: f32 = 0.1;

/// What a picture shows of the mirror direction of each point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum Show {
    /// The light itself.
    #[default]
    Light = SHOW_LIGHT,
    /// How many distances were looked up, from blue to red at [`MOST_LOOKUPS`].
    Lookups = SHOW_LOOKUPS,
    /// Where the search ended: blue before the surface, red behind it, up to [`MOST_RATIO`]; green where it missed.
    Ratio = SHOW_RATIO,
    /// Degrees between where it looked and what the ray meets, from blue at 0.01 to red at 100.
    Error = SHOW_ERROR,
}

impl Show {
    /// All of them, in the order of their numbers.
    pub const ALL: [Show; 4] = [Show::Light, Show::Lookups, Show::Ratio, Show::Error];
    /// Their names in files and on the command line.
    pub const IDS: [&'static str; 4] = ["light", "lookups", "ratio", "error"];
}

/// A scale from blue over green to red, `x` from 0 to 1.
pub fn heat(x: f32) -> Vec3 {
    let ramp = |middle: f32| (1.5 - (4.0 * x.clamp(0.0, 1.0) - middle).abs()).clamp(0.0, 1.0);
    Vec3::new(ramp(3.0), ramp(2.0), ramp(1.0))
}

/// The colour of a search by its lookups or where it ended; black for light and errors.
pub fn shown(found: &Found, show: Show) -> Vec3 {
    match show {
        Show::Light | Show::Error => Vec3::ZERO,
        Show::Lookups => heat(found.lookups as f32 / MOST_LOOKUPS),
        Show::Ratio => {
            let off = ((found.ratio - 1.0) / MOST_RATIO).clamp(-1.0, 1.0);
            Vec3::new(off.max(0.0), if found.is_hit { 0.0 } else { 1.0 }, (-off).max(0.0))
        }
    }
}

/// The colour of an error in direction, degrees.
pub fn error_shown(degrees: f32) -> Vec3 {
    heat((degrees.max(1e-9).log10() + 2.0) / 4.0)
}
