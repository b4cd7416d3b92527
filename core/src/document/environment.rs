//! The environment of a document: its entry. What a scene gets from it is made in `maps.rs`.

use std::ops::RangeInclusive;

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{is_default, one};
use crate::color::blackbody::blackbody;
use crate::scene::Environment;
use crate::scene::environment::{Shape, SkyModel, SoftBox, Studio};

/// The environment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnvironmentEntry {
    /// Path of the HDRI; what is [`made`](Self::made), else that of the scene, else the built-in studio, when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// A map by numbers. Counts where there is no HDRI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made: Option<MadeEntry>,
    /// Degrees counter-clockwise about +y.
    #[serde(default)]
    pub rotation_deg: f64,
    /// Factor on the radiance, 0 to 1e6.
    #[serde(default = "one")]
    pub strength: f64,
    /// Linear Rec.709 factor on the radiance, each 0 to 1e6; white changes nothing.
    #[serde(default = "white", skip_serializing_if = "is_white")]
    pub tint: [f64; 3],
    /// What the eye sees behind everything.
    #[serde(default, skip_serializing_if = "is_default")]
    pub background: BackgroundEntry,
    /// Degrees from the middle of the lobe that blurs the background to its half height, 0 (sharp) to 90. Light and
    /// reflections stay as they are.
    #[serde(default, skip_serializing_if = "is_default")]
    pub background_blur_deg: f64,
    /// The ground that the background is laid on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground: Option<GroundEntry>,
    /// The sun of the map becomes a light.
    #[serde(default, skip_serializing_if = "is_default")]
    pub sun_split: bool,
    /// Factor on the light of that sun, or of the sky's, 0 to 1e6: files cut the brightest off.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub sun_strength: f64,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// What is behind everything.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BackgroundEntry {
    /// The environment.
    #[default]
    Environment,
    /// One colour, linear Rec.709 radiance in nit; `[0, 0, 0]` hides the environment.
    Color([f64; 3]),
    /// What this version does not know; the environment is shown.
    #[serde(untagged)]
    Unknown(Value),
}

/// A dome on a ground, see [`Ground`](crate::scene::Ground).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GroundEntry {
    /// Of the camera that took the map, above the ground, metres, above 0.
    pub height: f64,
    /// Of the dome, metres, more than the height.
    pub radius: f64,
    /// y of the ground, metres; the lowest point of the scene when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<f64>,
    /// x and z of the middle, metres; that of the scene when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub middle: Option<[f64; 2]>,
    /// Shadows of the scene fall on it.
    pub shadows: bool,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// A map by numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MadeEntry {
    /// A sky by day.
    Sky(SkyEntry),
    /// Softboxes before a backdrop.
    Studio(StudioEntry),
    /// What this version does not know.
    #[serde(untagged)]
    Unknown(Value),
}

/// A sky by day, see [`SkyModel`]. Radiance is in nit: noon asks for an exposure of about -14 EV.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SkyEntry {
    /// Haze, 1.7 to 10.
    pub turbidity: f64,
    /// Of the sun, degrees above the horizon, 0 to 90.
    pub elevation_deg: f64,
    /// Of the sun, degrees from the front (+z) toward +x.
    pub azimuth_deg: f64,
    /// Adds the sun as a light.
    pub sun: bool,
    /// Reflectance of the ground, linear Rec.709, each 0 to 1.
    pub ground: [f64; 3],
    /// Rows of the map, 16 to 2048; twice as many columns.
    pub rows: u32,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// A studio, see [`Studio`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct StudioEntry {
    /// Radiance above, linear Rec.709 in nit.
    pub top: [f64; 3],
    /// At the horizon.
    pub horizon: [f64; 3],
    /// Below.
    pub bottom: [f64; 3],
    /// Lamps.
    pub boxes: Vec<SoftBoxEntry>,
    /// Rows of the map, 16 to 2048; twice as many columns.
    pub rows: u32,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// A softbox, see [`SoftBox`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SoftBoxEntry {
    /// For people.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Degrees from the front (+z) toward +x.
    pub azimuth_deg: f64,
    /// Degrees above the horizon.
    pub elevation_deg: f64,
    /// Full angle across, degrees, above 0, at most 170.
    pub width_deg: f64,
    /// Full angle up.
    pub height_deg: f64,
    /// Degrees counter-clockwise as seen from the middle.
    pub roll_deg: f64,
    /// Luminance in the middle, nit, where the colour has luminance 1.
    pub radiance: f64,
    /// Colour of a black body, 1000 to 40 000 K, in the place of the colour.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kelvin: Option<f64>,
    /// Linear Rec.709.
    pub color: [f64; 3],
    /// Width of the soft edge as a share of the way to the middle, 0 to 1.
    pub softness: f64,
    /// Change of radiance to the right and to the upper edge, each -1 to 1.
    pub gradient: [f64; 2],
    /// Outline: `rectangle` or `disc`.
    pub shape: Shape,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

fn is_one(factor: &f64) -> bool {
    *factor == 1.0
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

fn is_white(tint: &[f64; 3]) -> bool {
    *tint == white()
}

impl Default for EnvironmentEntry {
    fn default() -> Self {
        EnvironmentEntry {
            source: None,
            made: None,
            rotation_deg: 0.0,
            strength: 1.0,
            tint: white(),
            background: BackgroundEntry::Environment,
            background_blur_deg: 0.0,
            ground: None,
            sun_split: false,
            sun_strength: 1.0,
            other: Map::new(),
        }
    }
}

impl Default for GroundEntry {
    fn default() -> Self {
        GroundEntry { height: 1.6, radius: 20.0, level: None, middle: None, shadows: true, other: Map::new() }
    }
}

impl Default for SkyEntry {
    fn default() -> Self {
        SkyEntry {
            turbidity: 3.0,
            elevation_deg: 40.0,
            azimuth_deg: 45.0,
            sun: true,
            ground: [0.2; 3],
            rows: 512,
            other: Map::new(),
        }
    }
}

impl Default for StudioEntry {
    /// A grey room with two lamps.
    fn default() -> Self {
        let key = SoftBoxEntry { name: "key".into(), ..SoftBoxEntry::default() };
        let fill = SoftBoxEntry {
            name: "fill".into(),
            azimuth_deg: 60.0,
            elevation_deg: 20.0,
            radiance: 2.0,
            softness: 0.5,
            ..SoftBoxEntry::default()
        };
        StudioEntry {
            top: [0.05; 3],
            horizon: [0.15; 3],
            bottom: [0.1; 3],
            boxes: vec![key, fill],
            rows: 512,
            other: Map::new(),
        }
    }
}

impl Default for SoftBoxEntry {
    fn default() -> Self {
        SoftBoxEntry {
            name: String::new(),
            azimuth_deg: -45.0,
            elevation_deg: 35.0,
            width_deg: 40.0,
            height_deg: 55.0,
            roll_deg: 0.0,
            radiance: 10.0,
            kelvin: None,
            color: [1.0; 3],
            softness: 0.1,
            gradient: [0.0; 2],
            shape: Shape::Rectangle,
            other: Map::new(),
        }
    }
}

pub(super) fn vec3(v: [f64; 3]) -> Vec3 {
    Vec3::from_array(v.map(|v| v as f32))
}

fn rows(rows: u32) -> u32 {
    rows.clamp(16, 2048)
}

impl SkyEntry {
    /// What the sky is made from.
    pub fn model(&self) -> SkyModel {
        SkyModel {
            turbidity: self.turbidity,
            elevation: self.elevation_deg.to_radians() as f32,
            azimuth: self.azimuth_deg.to_radians() as f32,
            ground: vec3(self.ground),
        }
    }
}

impl SoftBoxEntry {
    /// The box as it is painted.
    pub fn shape(&self) -> SoftBox {
        let radians = |degrees: f64| degrees.to_radians() as f32;
        let color = self.kelvin.map_or(vec3(self.color), blackbody);
        SoftBox {
            azimuth: radians(self.azimuth_deg),
            elevation: radians(self.elevation_deg),
            size: Vec2::new(radians(self.width_deg), radians(self.height_deg)),
            roll: radians(self.roll_deg),
            radiance: self.radiance as f32 * color,
            softness: self.softness as f32,
            gradient: Vec2::new(self.gradient[0] as f32, self.gradient[1] as f32),
            shape: self.shape,
        }
    }
}

impl MadeEntry {
    /// The map; `None` for what this version does not know.
    pub fn map(&self) -> Option<Environment> {
        match self {
            MadeEntry::Sky(sky) => Some(sky.model().map(2 * rows(sky.rows), rows(sky.rows))),
            MadeEntry::Studio(entry) => {
                let boxes = entry.boxes.iter().map(SoftBoxEntry::shape).collect();
                let (top, horizon, bottom) = (vec3(entry.top), vec3(entry.horizon), vec3(entry.bottom));
                Some(Studio { top, horizon, bottom, boxes }.paint(2 * rows(entry.rows), rows(entry.rows)))
            }
            MadeEntry::Unknown(_) => None,
        }
    }
}

impl EnvironmentEntry {
    /// The first number out of its range, in words; `place` is what its field follows.
    pub(super) fn check(&self, place: &str) -> Result<(), String> {
        let mut numbers: Vec<Number> = vec![
            ("rotation_deg", self.rotation_deg, -1e6..=1e6),
            ("strength", self.strength, 0.0..=1e6),
            ("background_blur_deg", self.background_blur_deg, 0.0..=90.0),
            ("sun_strength", self.sun_strength, 0.0..=1e6),
        ];
        numbers.extend(self.tint.map(|v| ("tint", v, 0.0..=1e6)));
        if let BackgroundEntry::Color(color) = &self.background {
            numbers.extend(color.map(|v| ("background.color", v, 0.0..=1e6)));
        }
        if let Some(ground) = &self.ground {
            numbers.push(("ground.height", ground.height, 1e-3..=1e6));
            numbers.push(("ground.radius", ground.radius, ground.height.max(1e-3) * 1.001..=1e7));
            numbers.extend(ground.level.map(|v| ("ground.level", v, -1e6..=1e6)));
            numbers.extend(ground.middle.iter().flatten().map(|v| ("ground.middle", *v, -1e6..=1e6)));
        }
        numbers.extend(self.made.iter().flat_map(MadeEntry::numbers));
        first_outside(numbers).map_or(Ok(()), |fault| Err(fault.words(&format!("{place}environment."))))
    }
}

/// A number with its field and what it may be.
type Number = (&'static str, f64, RangeInclusive<f64>);

/// A number out of its range.
struct Outside(Number);

impl Outside {
    fn words(&self, place: &str) -> String {
        let Outside((field, value, range)) = self;
        format!("field `{place}{field}` is {value}; it takes {} to {}", range.start(), range.end())
    }
}

fn first_outside(numbers: Vec<Number>) -> Option<Outside> {
    numbers.into_iter().find(|(_, value, range)| !range.contains(value)).map(Outside)
}

impl MadeEntry {
    /// The first number out of its range, in words.
    pub fn check(&self) -> Result<(), String> {
        first_outside(self.numbers()).map_or(Ok(()), |fault| Err(fault.words("")))
    }

    fn numbers(&self) -> Vec<Number> {
        let mut numbers: Vec<Number> = Vec::new();
        match self {
            MadeEntry::Sky(sky) => {
                numbers.push(("made.sky.turbidity", sky.turbidity, 1.7..=10.0));
                numbers.push(("made.sky.elevation_deg", sky.elevation_deg, 0.0..=90.0));
                numbers.push(("made.sky.azimuth_deg", sky.azimuth_deg, -1e6..=1e6));
                numbers.extend(sky.ground.map(|v| ("made.sky.ground", v, 0.0..=1.0)));
                numbers.push(("made.sky.rows", sky.rows.into(), 16.0..=2048.0));
            }
            MadeEntry::Studio(studio) => {
                let colors = [studio.top, studio.horizon, studio.bottom].concat();
                numbers.extend(colors.into_iter().map(|v| ("made.studio", v, 0.0..=1e6)));
                numbers.push(("made.studio.rows", studio.rows.into(), 16.0..=2048.0));
                for lamp in &studio.boxes {
                    numbers.push(("made.studio.boxes.azimuth_deg", lamp.azimuth_deg, -1e6..=1e6));
                    numbers.push(("made.studio.boxes.elevation_deg", lamp.elevation_deg, -1e6..=1e6));
                    numbers.push(("made.studio.boxes.width_deg", lamp.width_deg, 0.0..=170.0));
                    numbers.push(("made.studio.boxes.height_deg", lamp.height_deg, 0.0..=170.0));
                    numbers.push(("made.studio.boxes.roll_deg", lamp.roll_deg, -1e6..=1e6));
                    numbers.push(("made.studio.boxes.radiance", lamp.radiance, 0.0..=1e9));
                    numbers.push(("made.studio.boxes.softness", lamp.softness, 0.0..=1.0));
                    numbers.extend(lamp.kelvin.map(|v| ("made.studio.boxes.kelvin", v, 1000.0..=40_000.0)));
                    numbers.extend(lamp.color.map(|v| ("made.studio.boxes.color", v, 0.0..=1e6)));
                    numbers.extend(lamp.gradient.map(|v| ("made.studio.boxes.gradient", v, -1.0..=1.0)));
                }
            }
            MadeEntry::Unknown(_) => {}
        }
        numbers
    }
}

#[cfg(test)]
#[path = "environment_tests.rs"]
mod tests;
