//! Lights: kinds, sizes and switches.

use glam::{Vec2, Vec3};

/// Angular radius below which a sun is parallel light, a fiftieth of the real one's.
const SHARPEST: f32 = 1e-4;

/// A light other than the environment and glowing materials.
///
/// Lights block no rays: a ray that meets one takes up its radiance and goes on, so that what single lights contribute
/// adds up to the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name for people.
    pub name: String,
    /// World position in metres, the centre of a light with a size; unused by directional lights.
    pub position: Vec3,
    /// Unit direction in which the light shines; unused by points and spheres.
    pub direction: Vec3,
    /// Linear Rec.709 colour times cd (point, spot), lx on a facing surface (directional) or nit (rectangle, sphere). One
    /// nit is one unit of radiance.
    pub intensity: Vec3,
    /// Distance in metres at which points and spots are cut off smoothly; infinite when absent. Other kinds have none.
    pub range: f32,
    /// What kind of light.
    pub kind: LightKind,
    /// The eye sees it as a shape, if it has a size.
    pub camera: bool,
    /// Adds to specular lobes and is seen in mirrors; otherwise it lights only the diffuse base.
    pub reflections: bool,
    /// Surfaces stand in its way.
    pub shadows: bool,
    /// Indices of the instances that it does not light, ascending.
    pub unlit: Vec<usize>,
}

/// The kinds of [`Light`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Shines in all directions.
    Point,
    /// A cone; half angles in radians, `0 <= inner < outer <= pi/2`.
    Spot {
        /// Full strength inside.
        inner_angle: f32,
        /// Dark outside.
        outer_angle: f32,
    },
    /// A sun, infinitely far away.
    Directional {
        /// Half the angle of its disc in radians, 0 to pi/2; parallel light below 1e-4.
        angular_radius: f32,
    },
    /// Shines evenly to the side of `direction` only. Dark without an area.
    Rectangle {
        /// Unit, at right angles to the direction; the other side runs along `across x direction`.
        across: Vec3,
        /// Full width (along `across`) and height in metres.
        size: Vec2,
    },
    /// Shines evenly from its surface, outwards and inwards. Dark without a radius.
    Sphere {
        /// Metres.
        radius: f32,
    },
}

impl Default for Light {
    /// A point of one candela at the origin.
    fn default() -> Light {
        Light {
            name: String::new(),
            position: Vec3::ZERO,
            direction: Vec3::NEG_Z,
            intensity: Vec3::ONE,
            range: f32::INFINITY,
            kind: LightKind::Point,
            camera: false,
            reflections: true,
            shadows: true,
            unlit: Vec::new(),
        }
    }
}

impl Light {
    /// Instance number `instance` is lit by it.
    pub fn lights(&self, instance: usize) -> bool {
        self.unlit.binary_search(&instance).is_err()
    }
}

impl Light {
    /// Radiance along every ray that meets it, nit; zero for lights without a size. The illuminance of a sun is
    /// `pi sin^2` times its radiance.
    pub fn radiance(&self) -> Vec3 {
        match self.kind {
            LightKind::Rectangle { .. } | LightKind::Sphere { .. } => self.intensity,
            LightKind::Directional { angular_radius } if !self.kind.is_sharp() => {
                self.intensity / (std::f32::consts::PI * angular_radius.sin().powi(2))
            }
            _ => Vec3::ZERO,
        }
    }
}

impl LightKind {
    /// Parallel light from infinitely far away.
    pub const PARALLEL: LightKind = LightKind::Directional { angular_radius: 0.0 };

    /// A kind of KHR_lights_punctual: point, spot, or directional of any angle.
    pub fn is_punctual(&self) -> bool {
        match self {
            LightKind::Point | LightKind::Spot { .. } | LightKind::Directional { .. } => true,
            LightKind::Rectangle { .. } | LightKind::Sphere { .. } => false,
        }
    }

    /// Comes from one direction at each point: point, spot, or directional of an angle below 1e-4.
    pub fn is_sharp(&self) -> bool {
        match *self {
            LightKind::Point | LightKind::Spot { .. } => true,
            LightKind::Directional { angular_radius } => angular_radius < SHARPEST,
            LightKind::Rectangle { .. } | LightKind::Sphere { .. } => false,
        }
    }

    /// Name for people, one word.
    pub fn label(&self) -> &'static str {
        match self {
            LightKind::Point => "point",
            LightKind::Spot { .. } => "spot",
            LightKind::Directional { .. } => "directional",
            LightKind::Rectangle { .. } => "rectangle",
            LightKind::Sphere { .. } => "sphere",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_leaves_out_the_instances_of_its_list() {
        let light = Light { unlit: vec![1, 4], ..Light::default() };
        assert_eq!([0, 1, 2, 4].map(|i| light.lights(i)), [true, false, true, false]);
    }

    #[test]
    fn only_kinds_without_a_size_are_sharp() {
        let sun = LightKind::Directional { angular_radius: 0.005 };
        let rectangle = LightKind::Rectangle { across: Vec3::X, size: Vec2::ONE };
        let kinds = [LightKind::Point, LightKind::PARALLEL, sun, rectangle, LightKind::Sphere { radius: 0.1 }];
        assert_eq!(kinds.map(|k| k.is_sharp()), [true, true, false, false, false]);
        assert_eq!(kinds.map(|k| k.is_punctual()), [true, true, true, false, false]);
    }
}
