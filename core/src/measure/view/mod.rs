//! Aids for judging exposure: how a picture's light is spread over stops, columns and the range of a screen.
//!
//! The table of bands, the test of clipping and the modes of the display have a WGSL twin, `view.wgsl`.

mod histogram;
mod waveform;

use glam::Vec3;

pub use histogram::{Counts, Histogram, STOPS, histogram};
pub use waveform::{Waveform, waveform};

use crate::color::rgb::luminance;
use crate::color::tone::{self, ToneMap, exposure_factor, tone_map};
use crate::leaf::Leaf;
use crate::picture::Picture;

/// The WGSL twin.
pub static LEAF: Leaf = Leaf { name: "view", source: include_str!("view.wgsl"), needs: &[&tone::LEAF], externs: "" };

/// Exposed luminance from which stops are counted: middle grey.
pub const MIDDLE_GREY: f32 = 0.18;

/// WGSL number of [`DisplayMode::Picture`].
pub const DISPLAY_PICTURE: u32 = 0;
/// WGSL number of [`DisplayMode::FalseColor`].
pub const DISPLAY_FALSE_COLOR: u32 = 1;
/// WGSL number of [`DisplayMode::Clipping`].
pub const DISPLAY_CLIPPING: u32 = 2;

/// What is shown of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum DisplayMode {
    /// The picture itself.
    #[default]
    Picture = DISPLAY_PICTURE,
    /// Bands of luminance in stops about middle grey, before the tone map, see [`BANDS`].
    FalseColor = DISPLAY_FALSE_COLOR,
    /// The picture with marks where channels reach an end of the screen's range, see [`Clipping`].
    Clipping = DISPLAY_CLIPPING,
}

/// No mode of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no display mode `{0}`; there are picture, false-color, clipping")]
pub struct UnknownDisplayMode(pub String);

impl DisplayMode {
    /// Every mode, in the order of their numbers.
    pub const ALL: [DisplayMode; 3] = [DisplayMode::Picture, DisplayMode::FalseColor, DisplayMode::Clipping];

    /// Name in files and on the command line.
    pub fn id(self) -> &'static str {
        match self {
            DisplayMode::Picture => "picture",
            DisplayMode::FalseColor => "false-color",
            DisplayMode::Clipping => "clipping",
        }
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            DisplayMode::Picture => "Picture",
            DisplayMode::FalseColor => "False colour",
            DisplayMode::Clipping => "Clipping",
        }
    }

    /// Number in shaders: one of the `DISPLAY_` constants.
    pub fn number(self) -> u32 {
        self as u32
    }
}

impl std::str::FromStr for DisplayMode {
    type Err = UnknownDisplayMode;

    fn from_str(text: &str) -> Result<DisplayMode, UnknownDisplayMode> {
        let wanted = text.trim().to_ascii_lowercase();
        DisplayMode::ALL.into_iter().find(|mode| mode.id() == wanted).ok_or_else(|| UnknownDisplayMode(text.into()))
    }
}

/// A range of luminance in one colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Stops about middle grey from which on it holds; the first from darkness on.
    pub from_stops: f32,
    /// sRGB encoded, 0 to 1.
    pub color: Vec3,
    /// For people.
    pub label: &'static str,
}

const fn band(from_stops: f32, color: [f32; 3], label: &'static str) -> Band {
    Band { from_stops, color: Vec3::from_array(color), label }
}

/// The legend, from dark to bright. Each band is lighter than the one before, so that it reads without colours as well, and
/// hue runs from blue to yellow, which people tell apart who confuse red and green. Middle grey is grey.
pub const BANDS: [Band; 13] = [
    band(f32::NEG_INFINITY, [0.0, 0.0, 0.0], "below -6"),
    band(-6.0, [0.13, 0.02, 0.30], "-6 to -5"),
    band(-5.0, [0.10, 0.08, 0.55], "-5 to -4"),
    band(-4.0, [0.05, 0.20, 0.75], "-4 to -3"),
    band(-3.0, [0.05, 0.33, 0.85], "-3 to -2"),
    band(-2.0, [0.10, 0.46, 0.88], "-2 to -1"),
    band(-1.0, [0.25, 0.57, 0.85], "-1 to -1/2"),
    band(-0.5, [0.63, 0.63, 0.63], "middle grey"),
    band(0.5, [0.80, 0.68, 0.35], "1/2 to 1"),
    band(1.0, [0.93, 0.74, 0.10], "1 to 2"),
    band(2.0, [0.98, 0.83, 0.20], "2 to 3"),
    band(3.0, [1.0, 0.92, 0.45], "3 to 4"),
    band(4.0, [1.0, 1.0, 1.0], "above 4"),
];

/// The band of an exposed luminance; negative values and none count as darkness.
pub fn false_color(exposed_luminance: f32) -> Vec3 {
    let mut color = BANDS[0].color;
    for band in &BANDS[1..] {
        if exposed_luminance >= MIDDLE_GREY * band.from_stops.exp2() {
            color = band.color;
        }
    }
    color
}

/// Which channels of a shown colour are at an end of the screen's range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clipping {
    /// Red, green, blue at the largest of 256 levels.
    pub over: [bool; 3],
    /// At 0.
    pub under: [bool; 3],
}

impl Clipping {
    /// Of display-encoded values, 0 to 1, as 8 bits show them.
    pub fn of(encoded: Vec3) -> Clipping {
        let each = |test: fn(f32) -> bool| encoded.to_array().map(test);
        Clipping { over: each(|v| v >= CLIP_OVER), under: each(|v| v < CLIP_UNDER) }
    }

    /// The mark, sRGB encoded; `None` where nothing is clipped. Too bright counts before too dark.
    pub fn mark(self) -> Option<Vec3> {
        let count = |of: [bool; 3]| of.into_iter().filter(|v| *v).count();
        match (count(self.over), count(self.under)) {
            (3, _) => Some(OVER_ALL),
            (1.., _) => Some(OVER_SOME),
            (0, 3) => Some(UNDER_ALL),
            (0, 1..) => Some(UNDER_SOME),
            _ => None,
        }
    }
}

/// Encoded values from here on are level 255.
pub const CLIP_OVER: f32 = 254.5 / 255.0;
/// Below they are level 0.
pub const CLIP_UNDER: f32 = 0.5 / 255.0;
/// Mark where all channels are too bright: no drawing is left. The marks are of the palette of Okabe and Ito 2008, Color
/// Universal Design.
pub const OVER_ALL: Vec3 = Vec3::new(0.835, 0.369, 0.0);
/// Where one or two are: the hue is wrong.
pub const OVER_SOME: Vec3 = Vec3::new(0.941, 0.894, 0.259);
/// Where all are too dark.
pub const UNDER_ALL: Vec3 = Vec3::new(0.0, 0.447, 0.698);
/// Where one or two are.
pub const UNDER_SOME: Vec3 = Vec3::new(0.337, 0.706, 0.914);

/// What a screen shows of an exposed linear colour in a mode, sRGB encoded.
pub fn view_display(mode: DisplayMode, tone: ToneMap, linear: Vec3) -> Vec3 {
    match mode {
        DisplayMode::Picture => tone_map(tone, linear),
        DisplayMode::FalseColor => false_color(luminance(linear)),
        DisplayMode::Clipping => {
            let shown = tone_map(tone, linear);
            Clipping::of(shown).mark().unwrap_or(shown)
        }
    }
}

/// Shares of a picture that a screen cannot show.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClippedShares {
    /// Of pixels with a channel at the upper end, 0 to 1.
    pub over_some: f64,
    /// With all three there.
    pub over_all: f64,
    /// With a channel at 0.
    pub under_some: f64,
    /// With all three at 0.
    pub under_all: f64,
}

/// How much of a picture is clipped by a tone map at an exposure.
pub fn clipped_shares(picture: &Picture, tone: ToneMap, exposure_ev: f32) -> ClippedShares {
    let factor = exposure_factor(exposure_ev);
    let mut counts = [0usize; 4];
    for texel in &picture.texels {
        let Clipping { over, under } = Clipping::of(tone_map(tone, factor * texel.truncate()));
        let found = [over.contains(&true), !over.contains(&false), under.contains(&true), !under.contains(&false)];
        counts.iter_mut().zip(found).for_each(|(count, found)| *count += usize::from(found));
    }
    let share = |count: usize| count as f64 / picture.texels.len().max(1) as f64;
    let [over_some, over_all, under_some, under_all] = counts.map(share);
    ClippedShares { over_some, over_all, under_some, under_all }
}

/// A picture as a mode shows it: linear light of what the screen gives off, so that it is written and compared like
/// others (tone map none, 0 EV). Opaque.
pub fn displayed(picture: &Picture, mode: DisplayMode, tone: ToneMap, exposure_ev: f32) -> Picture {
    let factor = exposure_factor(exposure_ev);
    let texels = picture.texels.iter().map(|texel| {
        let shown = view_display(mode, tone, factor * texel.truncate());
        crate::color::rgb::linear_from_srgb(shown).extend(1.0)
    });
    Picture { width: picture.width, height: picture.height, texels: texels.collect() }
}

#[cfg(test)]
mod tests;
