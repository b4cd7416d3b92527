//! A light as documents store it, and as scenes have it.

use glam::{EulerRot, Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{Shape, is_default};
use crate::color::blackbody::blackbody;
use crate::scene::photometry::Unit;
use crate::scene::{Light, LightKind};

/// Largest number that is stored: lights beyond it are none.
const MOST: f64 = 1e12;

/// A light. It shines along its -z; an entry of a rectangle has its width along x and its height along y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightEntry {
    /// Unique in the document.
    pub name: String,
    /// What kind, with its size.
    pub shape: Shape,
    /// Metres.
    #[serde(default)]
    pub position: [f64; 3],
    /// Degrees about +y; at 0 the light shines along -z.
    #[serde(default, skip_serializing_if = "is_default")]
    pub yaw_deg: f64,
    /// Degrees up; at -90 it shines straight down.
    #[serde(default, skip_serializing_if = "is_default")]
    pub pitch_deg: f64,
    /// Degrees about the direction in which it shines.
    #[serde(default, skip_serializing_if = "is_default")]
    pub roll_deg: f64,
    /// How strong, in `unit`.
    pub power: f64,
    /// Symbol of a [`Unit`]; that of the kind where the light has no such quantity.
    pub unit: String,
    /// Linear Rec.709 factors.
    #[serde(default = "white", skip_serializing_if = "is_white")]
    pub color: [f64; 3],
    /// Colour of a black body beside that, which leaves the power as it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kelvin: Option<f64>,
    /// Metres at which points and spots are cut off smoothly; none when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<f64>,
    /// The eye sees it as a shape.
    #[serde(default, skip_serializing_if = "is_default")]
    pub camera: bool,
    /// It adds to highlights and reflections.
    #[serde(default = "yes", skip_serializing_if = "Clone::clone")]
    pub reflections: bool,
    /// Objects throw shadows in its light.
    #[serde(default = "yes", skip_serializing_if = "Clone::clone")]
    pub shadows: bool,
    /// Switched off.
    #[serde(default, skip_serializing_if = "is_default")]
    pub muted: bool,
    /// While any light is solo, only those that are shine.
    #[serde(default, skip_serializing_if = "is_default")]
    pub solo: bool,
    /// Name of its group; none when empty.
    #[serde(default, skip_serializing_if = "is_default")]
    pub group: String,
    /// Keys of the objects that it does not light.
    #[serde(default, skip_serializing_if = "is_default")]
    pub unlit: Vec<String>,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

fn is_white(color: &[f64; 3]) -> bool {
    *color == white()
}

fn yes() -> bool {
    true
}

/// The number within bounds; the lower one where it is none.
fn bounded(value: f64, min: f64, max: f64) -> f64 {
    if value.is_finite() { value.clamp(min, max) } else { min }
}

fn finite(value: f64) -> f64 {
    if value.is_finite() { value.clamp(-MOST, MOST) } else { 0.0 }
}

impl LightEntry {
    /// A white one at the origin that shines along -z.
    pub fn new(name: &str, shape: Shape, power: f64, unit: Unit) -> LightEntry {
        LightEntry {
            name: name.into(),
            shape,
            position: [0.0; 3],
            yaw_deg: 0.0,
            pitch_deg: 0.0,
            roll_deg: 0.0,
            power,
            unit: unit.symbol().into(),
            color: white(),
            kelvin: None,
            range: None,
            camera: shape.has_area(),
            reflections: true,
            shadows: true,
            muted: false,
            solo: false,
            group: String::new(),
            unlit: Vec::new(),
            other: Map::new(),
        }
    }

    /// How it is turned from shining along -z with its width along x.
    pub fn rotation(&self) -> Quat {
        let [yaw, pitch, roll] =
            [self.yaw_deg, self.pitch_deg, self.roll_deg].map(|angle| finite(angle).to_radians() as f32);
        Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll)
    }

    /// Turns it.
    pub fn set_rotation(&mut self, rotation: Quat) {
        let (yaw, pitch, roll) = rotation.normalize().to_euler(EulerRot::YXZ);
        [self.yaw_deg, self.pitch_deg, self.roll_deg] = [yaw, pitch, roll].map(|angle| f64::from(angle.to_degrees()));
    }

    /// Unit direction in which it shines.
    pub fn direction(&self) -> Vec3 {
        self.rotation() * Vec3::NEG_Z
    }

    /// Lets it shine in a direction; its roll stays. Nothing changes for no direction.
    pub fn set_direction(&mut self, direction: Vec3) {
        let Some(d) = direction.try_normalize() else { return };
        // Straight up or down, the yaw stays.
        if d.x.hypot(d.z) > 1e-6 {
            self.yaw_deg = f64::from((-d.x).atan2(-d.z).to_degrees());
        }
        self.pitch_deg = f64::from(d.y.clamp(-1.0, 1.0).asin().to_degrees());
    }

    /// Where it stands, metres.
    pub fn place(&self) -> Vec3 {
        Vec3::from_array(self.position.map(|metres| finite(metres) as f32))
    }

    /// Puts it somewhere, metres.
    pub fn set_place(&mut self, place: Vec3) {
        self.position = place.to_array().map(f64::from);
    }

    /// The kind as scenes have it; numbers out of range are brought into it.
    pub fn kind(&self) -> LightKind {
        match self.shape {
            Shape::Point => LightKind::Point,
            Shape::Spot { inner_deg, outer_deg } => {
                let outer = bounded(outer_deg, 0.1, 90.0).to_radians() as f32;
                let inner = bounded(inner_deg, 0.0, 90.0).to_radians() as f32;
                LightKind::Spot { inner_angle: inner.min(outer - 1e-4), outer_angle: outer }
            }
            Shape::Sun { angle_deg } => {
                LightKind::Directional { angular_radius: (0.5 * bounded(angle_deg, 0.0, 180.0)).to_radians() as f32 }
            }
            Shape::Rectangle { width, height } => LightKind::Rectangle {
                across: self.rotation() * Vec3::X,
                size: Vec2::new(bounded(width, 0.0, 1e6) as f32, bounded(height, 0.0, 1e6) as f32),
            },
            Shape::Sphere { radius } => LightKind::Sphere { radius: bounded(radius, 0.0, 1e6) as f32 },
        }
    }

    /// The unit that counts.
    pub fn unit(&self) -> Unit {
        Unit::of_symbol(&self.unit).unwrap_or_else(|| Unit::base(&self.kind()))
    }

    /// Strength in the base unit of its kind, see [`Unit::base`]; 0 for one that has no such quantity, such as a flux
    /// without a surface.
    pub fn base_power(&self) -> f64 {
        let kind = self.kind();
        let base = self.unit().convert(bounded(self.power, 0.0, MOST), Unit::base(&kind), &kind);
        base.unwrap_or(0.0).min(MOST)
    }

    /// Gives its strength in another unit; nothing changes where it has no such quantity.
    pub fn set_unit(&mut self, unit: Unit) {
        if let Some(power) = self.unit().convert(self.power, unit, &self.kind()) {
            self.power = power;
            self.unit = unit.symbol().into();
        }
    }

    /// Makes it another kind, about as bright at a distance of so many metres.
    pub fn set_shape(&mut self, shape: Shape, distance: f64) {
        let lit = self.illuminance(distance);
        self.shape = shape;
        let kind = self.kind();
        let unit = match kind {
            LightKind::Directional { .. } => Unit::Lux,
            LightKind::Rectangle { .. } | LightKind::Sphere { .. } => Unit::Nit,
            _ => Unit::Lumen,
        };
        self.unit = unit.symbol().into();
        self.power = 1.0;
        self.camera = shape.has_area();
        let one = self.illuminance(distance);
        self.power = if one > 0.0 { lit / one } else { 0.0 };
    }

    /// Illuminance on a surface that faces it on its axis at so many metres, lx: what it does, whatever its unit.
    pub fn illuminance(&self, distance: f64) -> f64 {
        let kind = self.kind();
        let intensity = match kind {
            LightKind::Directional { .. } => return self.base_power(),
            _ => Unit::base(&kind).convert(self.base_power(), Unit::Candela, &kind),
        };
        intensity.unwrap_or(0.0) / distance.max(1e-3).powi(2)
    }

    /// Linear Rec.709 factors of colour and temperature together.
    pub fn tint(&self) -> Vec3 {
        let color = Vec3::from_array(self.color.map(|c| bounded(c, 0.0, MOST) as f32));
        color * self.kelvin.map_or(Vec3::ONE, blackbody)
    }

    /// The light of a scene. `unlit` are the instances that it does not light.
    pub fn light(&self, mut unlit: Vec<usize>) -> Light {
        unlit.sort_unstable();
        unlit.dedup();
        Light {
            name: self.name.clone(),
            position: self.place(),
            direction: self.direction(),
            intensity: self.base_power() as f32 * self.tint(),
            range: self.range.filter(|range| range.is_finite() && *range > 0.0).map_or(f32::INFINITY, |m| m as f32),
            kind: self.kind(),
            camera: self.camera,
            reflections: self.reflections,
            shadows: self.shadows,
            unlit,
        }
    }

    /// What a document stores of a light of a model, the inverse of [`LightEntry::light`]; `keys` are those of the
    /// instances.
    pub fn of_light(light: &Light, keys: &[String]) -> LightEntry {
        let degrees = |radians: f32| f64::from(radians).to_degrees();
        let shape = match light.kind {
            LightKind::Point => Shape::Point,
            LightKind::Spot { inner_angle, outer_angle } => {
                Shape::Spot { inner_deg: degrees(inner_angle), outer_deg: degrees(outer_angle) }
            }
            LightKind::Directional { angular_radius } => Shape::Sun { angle_deg: 2.0 * degrees(angular_radius) },
            LightKind::Rectangle { size, .. } => Shape::Rectangle { width: size.x.into(), height: size.y.into() },
            LightKind::Sphere { radius } => Shape::Sphere { radius: radius.into() },
        };
        let power = light.intensity.max_element();
        let mut entry = LightEntry::new(&light.name, shape, power.into(), Unit::base(&light.kind));
        if power > 0.0 {
            entry.color = (light.intensity / power).to_array().map(f64::from);
        }
        entry.set_place(light.position);
        match light.kind {
            LightKind::Rectangle { across, .. } => {
                let up = across.cross(light.direction);
                let turned = glam::Mat3::from_cols(across, up, -light.direction);
                entry.set_rotation(Quat::from_mat3(&turned));
            }
            _ => entry.set_direction(light.direction),
        }
        entry.range = Some(f64::from(light.range)).filter(|range| range.is_finite());
        (entry.camera, entry.reflections, entry.shadows) = (light.camera, light.reflections, light.shadows);
        entry.unlit = light.unlit.iter().filter_map(|instance| keys.get(*instance).cloned()).collect();
        entry
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries() -> Vec<LightEntry> {
        let entry = |(i, shape): (usize, Shape)| {
            let mut entry = LightEntry::new(&format!("light {i}"), shape, 3.0 + i as f64, Unit::Nit);
            entry.unit = Unit::base(&entry.kind()).symbol().into();
            entry.position = [0.25, 1.5, -0.75];
            entry.set_rotation(Quat::from_euler(EulerRot::YXZ, 0.7, -0.9, 0.4));
            entry.color = [1.0, 0.5, 0.25];
            entry
        };
        Shape::all(1.0).into_iter().enumerate().map(entry).collect()
    }

    #[test]
    fn a_light_goes_into_a_document_and_back() {
        for entry in entries() {
            let light = entry.light(vec![1]);
            let keys = ["a".to_string(), "b".to_string()];
            let stored = LightEntry::of_light(&light, &keys);
            assert_eq!(stored.unlit, ["b"]);
            let back = stored.light(vec![1]);
            assert!((back.intensity - light.intensity).length() < 1e-6 * light.intensity.length(), "{light:?}");
            assert!((back.direction - light.direction).length() < 1e-6 && back.position == light.position);
            match (back.kind, light.kind) {
                (LightKind::Rectangle { across: a, size }, LightKind::Rectangle { across: b, size: before }) => {
                    assert!((a - b).length() < 1e-5 && size == before, "{a} {b}");
                    assert!(a.dot(light.direction).abs() < 1e-6);
                }
                (LightKind::Spot { outer_angle: a, .. }, LightKind::Spot { outer_angle: b, .. }) => {
                    assert!((a - b).abs() < 1e-6);
                }
                (a, b) => assert_eq!(format!("{a:?}"), format!("{b:?}")),
            }
            let text = serde_json::to_string(&entry).unwrap();
            assert_eq!(serde_json::from_str::<LightEntry>(&text).unwrap(), entry, "{text}");
        }
    }

    #[test]
    fn another_unit_and_a_temperature_leave_the_light_as_strong() {
        for mut entry in entries() {
            let before = entry.light(Vec::new()).intensity;
            for unit in Unit::ALL {
                entry.set_unit(unit);
                let after = entry.light(Vec::new()).intensity;
                assert!((after - before).length() < 1e-5 * before.length(), "{} in {unit:?}", entry.name);
            }
            let luminance = crate::color::rgb::luminance;
            entry.color = white();
            let white = luminance(entry.light(Vec::new()).intensity);
            entry.kelvin = Some(2700.0);
            let warm = entry.light(Vec::new()).intensity;
            assert!((luminance(warm) / white - 1.0).abs() < 1e-4 && warm.x > warm.z);
        }
    }

    #[test]
    fn another_kind_lights_as_much_from_where_it_stands() {
        for shape in Shape::all(0.5) {
            let mut entry = LightEntry::new("a", Shape::Point, 1000.0, Unit::Lumen);
            let before = entry.illuminance(2.0);
            entry.set_shape(shape, 2.0);
            assert!((entry.illuminance(2.0) / before - 1.0).abs() < 1e-9, "{shape:?}");
        }
    }

    #[test]
    fn it_shines_where_it_is_told_to() {
        let mut entry = entries().remove(3);
        for d in [Vec3::NEG_Y, Vec3::X, Vec3::Y, Vec3::new(0.3, -0.5, 0.8), Vec3::new(0.0, -1.0, 1e-9)] {
            entry.set_direction(d);
            assert!((entry.direction() - d.normalize()).length() < 1e-5, "{d}");
        }
        entry.set_direction(Vec3::ZERO);
        assert!((entry.direction() - Vec3::NEG_Y).length() < 1e-5, "no direction changes nothing");
    }

    #[test]
    fn nonsense_makes_no_light_that_is_no_number() {
        for mut entry in entries() {
            entry.power = f64::NAN;
            entry.position = [f64::INFINITY, f64::NAN, 0.0];
            (entry.yaw_deg, entry.pitch_deg) = (f64::NAN, 1e300);
            (entry.kelvin, entry.range) = (Some(f64::NAN), Some(f64::NAN));
            entry.color = [f64::NAN, -1.0, f64::INFINITY];
            entry.shape = match entry.shape {
                Shape::Spot { .. } => Shape::Spot { inner_deg: f64::NAN, outer_deg: -3.0 },
                Shape::Sun { .. } => Shape::Sun { angle_deg: f64::NAN },
                Shape::Rectangle { .. } => Shape::Rectangle { width: f64::NAN, height: -1.0 },
                Shape::Sphere { .. } => Shape::Sphere { radius: f64::NEG_INFINITY },
                Shape::Point => Shape::Point,
            };
            entry.unit = "candlepower".into();
            let light = entry.light(Vec::new());
            assert!(light.intensity.is_finite() && light.position.is_finite() && light.direction.is_normalized());
            if let LightKind::Spot { inner_angle, outer_angle } = light.kind {
                assert!((0.0..outer_angle).contains(&inner_angle), "{inner_angle} {outer_angle}");
            }
        }
    }
}
