//! Studios by numbers: a backdrop of three colours with softboxes painted into it.

use glam::{Vec2, Vec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::direction;
use crate::scene::Environment;

/// Widest softbox, radians (170 degrees): it is a flat sheet before the viewer.
pub const WIDEST: f32 = 2.967_06;
/// Samples along each side of a texel that the edge of a softbox crosses.
const EDGE_SAMPLES: u32 = 4;

/// A studio: what is around, and the lamps in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Studio {
    /// Radiance at the zenith, nit.
    pub top: Vec3,
    /// At the horizon.
    pub horizon: Vec3,
    /// At the nadir.
    pub bottom: Vec3,
    /// Lamps. Their light adds up where they overlap.
    pub boxes: Vec<SoftBox>,
}

/// The outline of a softbox.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// With corners.
    #[default]
    Rectangle,
    /// An ellipse.
    Disc,
}

/// A flat sheet of light that faces the middle of the studio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftBox {
    /// Of its middle from the front (+z) toward +x, radians.
    pub azimuth: f32,
    /// Of its middle above the horizon, radians.
    pub elevation: f32,
    /// Full angles across and up as seen from the middle, radians, above 0, at most [`WIDEST`].
    pub size: Vec2,
    /// Counter-clockwise as seen from the middle, radians.
    pub roll: f32,
    /// Radiance in the middle, nit.
    pub radiance: Vec3,
    /// Width of the soft edge as a share of the way from the edge to the middle, 0 sharp to 1.
    pub softness: f32,
    /// Change of radiance from the middle to the right and to the upper edge as a share of it, -1 to 1.
    pub gradient: Vec2,
    /// Outline.
    pub shape: Shape,
}

impl SoftBox {
    /// Unit directions toward so many points of its edge, in order around it; none where it has no size.
    pub fn outline(&self, points: usize) -> Vec<Vec3> {
        let Some(sheet) = Sheet::new(self) else { return Vec::new() };
        let edge = |i: usize| {
            let (sin, cos) = (std::f32::consts::TAU * (i as f32 + 0.5) / points as f32).sin_cos();
            let round = Vec2::new(cos, sin);
            let place = match self.shape {
                Shape::Disc => round,
                Shape::Rectangle => round / round.abs().max_element(),
            };
            let across = sheet.half.x * place.x * sheet.across;
            (sheet.toward + across + sheet.half.y * place.y * sheet.up).normalize()
        };
        (0..points).map(edge).collect()
    }
}

impl Studio {
    /// Paints an equirectangular map in nit. Edges of softboxes are smoothed over a texel.
    pub fn paint(&self, width: u32, height: u32) -> Environment {
        let (width, height) = (width.max(1), height.max(1));
        let grid = Environment::new("studio", width, height, Vec::new());
        let sheets: Vec<Sheet> = self.boxes.iter().filter_map(Sheet::new).collect();
        let reach = std::f32::consts::PI / height as f32;
        let mut texels = vec![Vec3::ZERO; (width * height) as usize];
        texels.par_chunks_exact_mut(width as usize).enumerate().for_each(|(y, row)| {
            for (x, texel) in row.iter_mut().enumerate() {
                let at = |inside: Vec2| grid.texel_direction(x as u32, y as u32, inside);
                let middle = at(Vec2::splat(0.5));
                let lamps: Vec3 = sheets.iter().map(|sheet| sheet.mean(middle, reach, at)).sum();
                *texel = self.backdrop(middle.y) + lamps;
            }
        });
        Environment::new("studio", width, height, texels)
    }

    /// By the sine of the elevation.
    fn backdrop(&self, up: f32) -> Vec3 {
        let height = up.clamp(-1.0, 1.0).asin() / std::f32::consts::FRAC_PI_2;
        let end = if height > 0.0 { self.top } else { self.bottom };
        self.horizon.lerp(end, height.abs()).max(Vec3::ZERO)
    }
}

/// A softbox at distance 1 with its frame.
struct Sheet {
    shape: SoftBox,
    toward: Vec3,
    across: Vec3,
    up: Vec3,
    /// Tangents of half the angles.
    half: Vec2,
    /// Cosine of the angle beyond which nothing is left.
    least_depth: f32,
}

impl Sheet {
    /// `None` for one without a size.
    fn new(shape: &SoftBox) -> Option<Sheet> {
        let half = (0.5 * shape.size.clamp(Vec2::ZERO, Vec2::splat(WIDEST))).map(f32::tan);
        // Also false for numbers that are none.
        if !(half.min_element() > 0.0 && shape.radiance.is_finite()) {
            return None;
        }
        let toward = direction(shape.azimuth, shape.elevation);
        // Seen from the middle of the studio the right is where the azimuth falls.
        let right = Vec3::new(-shape.azimuth.cos(), 0.0, shape.azimuth.sin());
        let upward = right.cross(toward);
        let (sin, cos) = shape.roll.sin_cos();
        let least_depth = (1.0 + half.length_squared()).sqrt().recip();
        let (across, up) = (cos * right + sin * upward, cos * upward - sin * right);
        Some(Sheet { shape: *shape, toward, across, up, half, least_depth })
    }

    /// Place on the sheet, from -1 to 1 at its edges; `None` behind the viewer.
    fn place(&self, d: Vec3) -> Option<Vec2> {
        let depth = d.dot(self.toward);
        (depth > 1e-4).then(|| Vec2::new(d.dot(self.across), d.dot(self.up)) / (depth * self.half))
    }

    /// Share of the way from the edge to the middle; negative outside.
    fn inside(&self, place: Vec2) -> f32 {
        match self.shape.shape {
            Shape::Rectangle => 1.0 - place.abs().max_element(),
            Shape::Disc => 1.0 - place.length(),
        }
    }

    fn radiance(&self, d: Vec3) -> Vec3 {
        let Some(place) = self.place(d) else { return Vec3::ZERO };
        let inside = self.inside(place);
        if inside <= 0.0 {
            return Vec3::ZERO;
        }
        let t = (inside / self.shape.softness.clamp(1e-6, 1.0)).min(1.0);
        let soft = t * t * (3.0 - 2.0 * t);
        let tilt = (1.0 + self.shape.gradient.dot(place)).max(0.0);
        soft * tilt * self.shape.radiance.max(Vec3::ZERO)
    }

    /// Mean over a texel that reaches so many radians from `middle`; `at` tells directions of its points.
    fn mean(&self, middle: Vec3, reach: f32, at: impl Fn(Vec2) -> Vec3) -> Vec3 {
        let cut = (self.least_depth.clamp(-1.0, 1.0).acos() + reach).min(std::f32::consts::PI).cos();
        if middle.dot(self.toward) < cut {
            return Vec3::ZERO;
        }
        // How far the texel reaches in the measure of the sheet: distances grow with the square of the depth's inverse.
        let depth = middle.dot(self.toward).max(1e-2);
        let blurred = reach / (depth * depth * self.half.min_element());
        let inside = self.place(middle).map_or(-1.0, |place| self.inside(place));
        if inside.abs() > 2.0 * blurred {
            return self.radiance(middle);
        }
        let (mut sum, n) = (Vec3::ZERO, EDGE_SAMPLES);
        for i in 0..n * n {
            let point = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
            sum += self.radiance(at(point));
        }
        sum / (n * n) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> SoftBox {
        SoftBox {
            azimuth: 0.0,
            elevation: 0.0,
            size: Vec2::splat(0.6),
            roll: 0.0,
            radiance: Vec3::splat(100.0),
            softness: 0.0,
            gradient: Vec2::ZERO,
            shape: Shape::Rectangle,
        }
    }

    fn painted(shape: SoftBox) -> Environment {
        Studio { boxes: vec![shape], ..Studio::default() }.paint(1024, 512)
    }

    /// Radiance integrated over the sphere.
    fn power(map: &Environment) -> f64 {
        let w = map.width as usize;
        let texel = |i: usize| f64::from(map.texels[i].x) * map.texel_solid_angle((i / w) as u32);
        (0..map.texels.len()).map(texel).sum()
    }

    #[test]
    fn a_box_has_the_solid_angle_of_its_sheet_wherever_it_hangs() {
        // Of a rectangle at distance 1 with half sides a, b: 4 atan(a b / sqrt(1 + a^2 + b^2)).
        let a = 0.3f64.tan();
        let wanted = 100.0 * 4.0 * (a * a / (1.0 + 2.0 * a * a).sqrt()).atan();
        for (azimuth, elevation, roll) in [(0.0, 0.0, 0.0), (1.0, 0.7, 0.3), (-2.0, 1.57, 0.9), (3.1, -1.2, 0.0)] {
            let found = power(&painted(SoftBox { azimuth, elevation, roll, ..square() }));
            assert!((found / wanted - 1.0).abs() < 5e-3, "{azimuth} {elevation}: {found} {wanted}");
        }
    }

    #[test]
    fn a_disc_has_the_solid_angle_of_its_cone() {
        let wanted = 100.0 * std::f64::consts::TAU * (1.0 - 0.3f64.cos());
        let found = power(&painted(SoftBox { shape: Shape::Disc, elevation: 0.4, ..square() }));
        assert!((found / wanted - 1.0).abs() < 5e-3, "{found} {wanted}");
    }

    #[test]
    fn right_and_up_are_those_of_someone_in_the_middle() {
        let gradient = Vec2::new(0.5, 0.25);
        let map = painted(SoftBox { gradient, ..square() });
        // Looking along +z with +y up the right is -x.
        let at = |x: f32, y: f32| map.radiance(Vec3::new(x, y, 1.0).normalize()).x;
        let half = 0.3f32.tan();
        assert!((at(-0.5 * half, 0.0) - 125.0).abs() < 1.0, "{}", at(-0.5 * half, 0.0));
        assert!((at(0.0, 0.5 * half) - 112.5).abs() < 1.0, "{}", at(0.0, 0.5 * half));
        let rolled = painted(SoftBox { gradient: Vec2::X, roll: std::f32::consts::FRAC_PI_2, ..square() });
        // A quarter turn counter-clockwise brings the right up.
        assert!(rolled.radiance(Vec3::new(0.0, 0.15, 1.0).normalize()).x > 120.0);
    }

    #[test]
    fn soft_edges_fall_to_nothing_and_the_backdrop_is_behind() {
        let soft = painted(SoftBox { softness: 1.0, ..square() });
        assert!((soft.radiance(Vec3::Z).x - 100.0).abs() < 1.0);
        let half_way = soft.radiance(Vec3::new(0.5 * 0.3f32.tan(), 0.0, 1.0).normalize()).x;
        assert!((half_way - 50.0).abs() < 1.5, "{half_way}");
        let room = Studio { top: Vec3::X, horizon: Vec3::Y, bottom: Vec3::Z, boxes: Vec::new() }.paint(64, 512);
        assert!((room.radiance(Vec3::Y) - Vec3::X).length() < 0.01);
        assert!((room.radiance(Vec3::NEG_X) - Vec3::Y).length() < 0.01);
        assert!((room.radiance(Vec3::NEG_Y) - Vec3::Z).length() < 0.01);
    }

    #[test]
    fn the_outline_is_where_the_light_ends() {
        for shape in [Shape::Rectangle, Shape::Disc] {
            let shape =
                SoftBox { shape, azimuth: 0.7, elevation: -0.4, roll: 0.5, size: Vec2::new(0.6, 0.3), ..square() };
            let sheet = Sheet::new(&shape).unwrap();
            let outline = shape.outline(32);
            assert_eq!(outline.len(), 32);
            for direction in outline {
                let inside = sheet.inside(sheet.place(direction).unwrap());
                assert!(inside.abs() < 1e-5, "{inside} at {direction}");
            }
        }
        assert!(SoftBox { size: Vec2::ZERO, ..square() }.outline(8).is_empty());
    }

    #[test]
    fn numbers_that_make_no_box_paint_nothing() {
        for size in [Vec2::ZERO, Vec2::new(-1.0, 1.0), Vec2::NAN] {
            assert_eq!(power(&painted(SoftBox { size, ..square() })), 0.0);
        }
        let wide = painted(SoftBox { size: Vec2::splat(9.0), ..square() });
        assert!(wide.texels.iter().all(|t| t.is_finite()));
    }
}
