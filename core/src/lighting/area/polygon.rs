//! Polygons as a point sees them, and the light that comes from one.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

/// Corners that a polygon may have: twelve sides of a sphere and one more from each of two clips, rounded up.
pub const CORNERS_MAX: usize = 16;

/// A convex polygon around the origin, seen from it: corners in any units, counter-clockwise from the origin when its
/// light is positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polygon {
    pub(super) corners: [Vec3; CORNERS_MAX],
    pub(super) count: usize,
}

impl Polygon {
    /// Nothing.
    pub const EMPTY: Polygon = Polygon { corners: [Vec3::ZERO; CORNERS_MAX], count: 0 };

    /// The first [`CORNERS_MAX`] of `corners`.
    pub fn new(corners: impl IntoIterator<Item = Vec3>) -> Polygon {
        let mut polygon = Polygon::EMPTY;
        corners.into_iter().for_each(|corner| polygon.push(corner));
        polygon
    }

    fn push(&mut self, corner: Vec3) {
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    /// Its corners.
    pub fn corners(&self) -> &[Vec3] {
        &self.corners[..self.count]
    }

    /// True when nothing is left of it.
    pub fn is_empty(&self) -> bool {
        self.count < 3
    }

    /// With other corners.
    pub fn map(&self, f: impl Fn(Vec3) -> Vec3) -> Polygon {
        let mut mapped = *self;
        mapped.corners[..self.count].iter_mut().for_each(|corner| *corner = f(*corner));
        mapped
    }

    /// What is above the plane z = 0. Sutherland and Hodgman 1974, for one plane.
    pub fn clipped(&self) -> Polygon {
        let mut left = Polygon::EMPTY;
        let corners = self.corners();
        let Some(mut from) = corners.last().copied() else { return left };
        for &to in corners {
            if (from.z > 0.0) != (to.z > 0.0) {
                let crossing = from + (to - from) * (from.z / (from.z - to.z));
                left.push(crossing.truncate().extend(0.0));
            }
            if to.z > 0.0 {
                left.push(to);
            }
            from = to;
        }
        left
    }

    /// Integral of the direction over the solid angle, which is the irradiance vector for radiance 1:
    /// `1/2 sum theta_j n_j` over the edges, theta the angle under which one is seen and n its plane's normal. Lambert
    /// 1760; Arvo 1995, eq. 3.
    pub fn flux(&self) -> Vec3 {
        let corners = self.corners();
        let Some(mut from) = corners.last().copied() else { return Vec3::ZERO };
        let mut sum = Vec3::ZERO;
        for &to in corners {
            // The cross product with the difference keeps the digits of short edges.
            let normal = from.cross(to - from);
            let sin = normal.length();
            sum += normal * (angle(sin, from.dot(to)) / sin.max(1e-30));
            from = to;
        }
        0.5 * sum
    }
}

/// Angle in [0, pi] whose sine and cosine are in this ratio; `sin >= 0`. Error 1e-7: Abramowitz and Stegun 1964, 4.4.49.
pub(super) fn angle(sin: f32, cos: f32) -> f32 {
    let (low, high) = (sin.min(cos.abs()), sin.max(cos.abs()));
    let x = low / high.max(1e-30);
    let x2 = x * x;
    let tail =
        0.106_562_64 + x2 * (-0.075_289_64 + x2 * (0.042_909_613 + x2 * (-0.016_165_737 + x2 * 0.002_866_225_7)));
    let acute = x * (1.0 + x2 * (-0.333_331_45 + x2 * (0.199_935_51 + x2 * (-0.142_089 + x2 * tail))));
    let first = if sin > cos.abs() { FRAC_PI_2 - acute } else { acute };
    if cos < 0.0 { PI - first } else { first }
}
