//! Kinds of lights with their sizes, as documents store them.

use serde::{Deserialize, Serialize};

/// The kind of a light with its size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// Shines in all directions.
    Point,
    /// A cone; half angles in degrees, full strength within the inner one, dark beyond the outer one, up to 90.
    Spot {
        /// Full strength inside.
        inner_deg: f64,
        /// Dark outside.
        outer_deg: f64,
    },
    /// Infinitely far away.
    Sun {
        /// Angle of its whole disc in degrees; 0.53 for the sun of the earth.
        angle_deg: f64,
    },
    /// Shines to one side.
    Rectangle {
        /// Metres.
        width: f64,
        /// Metres.
        height: f64,
    },
    /// Shines to all sides.
    Sphere {
        /// Metres.
        radius: f64,
    },
}

impl Shape {
    /// One of each, of a size that suits a subject of this radius in metres.
    pub fn all(radius: f64) -> [Shape; 5] {
        [
            Shape::Point,
            Shape::Spot { inner_deg: 20.0, outer_deg: 30.0 },
            Shape::Sun { angle_deg: 0.53 },
            Shape::Rectangle { width: 1.2 * radius, height: 1.2 * radius },
            Shape::Sphere { radius: 0.25 * radius },
        ]
    }

    /// One word for people.
    pub fn title(&self) -> &'static str {
        match self {
            Shape::Point => "Point",
            Shape::Spot { .. } => "Spot",
            Shape::Sun { .. } => "Sun",
            Shape::Rectangle { .. } => "Rectangle",
            Shape::Sphere { .. } => "Sphere",
        }
    }

    /// Has a surface that can be seen.
    pub fn has_area(&self) -> bool {
        matches!(self, Shape::Rectangle { .. } | Shape::Sphere { .. })
    }

    /// Its strength depends on where it stands.
    pub fn has_place(&self) -> bool {
        !matches!(self, Shape::Sun { .. })
    }

    /// Shines one way.
    pub fn has_aim(&self) -> bool {
        !matches!(self, Shape::Point | Shape::Sphere { .. })
    }

    /// The same, times a factor: what a larger subject needs.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Shape {
        match self {
            Shape::Rectangle { width, height } => Shape::Rectangle { width: width * factor, height: height * factor },
            Shape::Sphere { radius } => Shape::Sphere { radius: radius * factor },
            other => other,
        }
    }
}
