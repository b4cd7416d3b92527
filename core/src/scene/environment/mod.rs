//! Environments: reading equirectangular maps, what the eye sees of them, and maps made by code.

mod background;
mod blur;
pub mod ground;
mod sky;
mod split;
mod studio;

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::Environment;
use crate::leaf::Leaf;
use crate::math::cube;

pub use background::{Backdrop, Background};
pub use blur::{BLUR_MAX_DEG, blurred, resized};
pub use ground::Ground;
pub use sky::{SkyModel, TURBIDITY};
pub use split::{NoSun, Split, Sun, split_sun};
pub use studio::{Shape, SoftBox, Studio, WIDEST};

/// The WGSL twins of what is here.
pub const LEAVES: &[&Leaf] = &[&ground::LEAF];

/// The rotation of an environment about +y.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    sin: f32,
    cos: f32,
}

impl Turn {
    /// By radians, counter-clockwise.
    pub fn by(rotation: f32) -> Turn {
        let (sin, cos) = rotation.sin_cos();
        Turn { sin, cos }
    }

    /// A direction of the world in the map's own frame.
    pub fn to_own(self, world: Vec3) -> Vec3 {
        let Turn { sin, cos } = self;
        Vec3::new(cos * world.x - sin * world.z, world.y, sin * world.x + cos * world.z)
    }

    /// And back.
    pub fn to_world(self, own: Vec3) -> Vec3 {
        let Turn { sin, cos } = self;
        Vec3::new(cos * own.x + sin * own.z, own.y, -sin * own.x + cos * own.z)
    }
}

/// Unit direction of an azimuth from the front (+z) toward +x and an elevation above the horizon, radians.
pub fn direction(azimuth: f32, elevation: f32) -> Vec3 {
    let ((sin, cos), (rise, level)) = (azimuth.sin_cos(), elevation.sin_cos());
    Vec3::new(level * sin, rise, level * cos)
}

impl Environment {
    /// A map from its parts, unrotated, at strength 1. Rows from the top; `texels` should hold `width * height` colours,
    /// what is missing is black.
    pub fn new(name: &str, width: u32, height: u32, texels: Vec<Vec3>) -> Environment {
        Environment {
            name: name.into(),
            width,
            height,
            texels: texels.into(),
            rotation: 0.0,
            strength: 1.0,
            tint: Vec3::ONE,
        }
    }

    /// Factor from a texel to radiance: strength times tint.
    pub fn scale(&self) -> Vec3 {
        self.strength * self.tint
    }

    /// Where a world direction is seen, in [0, 1]^2 from the top left.
    pub fn uv_from_direction(&self, world: Vec3) -> Vec2 {
        cube::equirectangular(Turn::by(self.rotation).to_own(world))
    }

    /// The world direction that is seen at a point of the map.
    pub fn direction_from_uv(&self, uv: Vec2) -> Vec3 {
        let (sin_phi, cos_phi) = ((uv.x - 0.5) * TAU).sin_cos();
        let (sin_theta, cos_theta) = (uv.y * PI).sin_cos();
        let d = Vec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi);
        Turn::by(self.rotation).to_world(d)
    }

    /// Radiance from a world direction, strength and tint included: bilinear, wrapping around, stopping at the poles.
    pub fn radiance(&self, world: Vec3) -> Vec3 {
        self.radiance_at(self.uv_from_direction(world))
    }

    /// [`Environment::radiance`] of a point of the map, [0, 1]^2 from the top left.
    pub fn radiance_at(&self, uv: Vec2) -> Vec3 {
        let p = uv * Vec2::new(self.width as f32, self.height as f32) - 0.5;
        let low = p.floor();
        let f = p - low;
        let (x0, x1) = (self.column(low.x as i64), self.column(low.x as i64 + 1));
        let (y0, y1) = (self.row(low.y as i64), self.row(low.y as i64 + 1));
        let top = self.texel(x0, y0).lerp(self.texel(x1, y0), f.x);
        let bottom = self.texel(x0, y1).lerp(self.texel(x1, y1), f.x);
        self.scale() * top.lerp(bottom, f.y)
    }

    fn column(&self, x: i64) -> usize {
        x.rem_euclid(i64::from(self.width.max(1))) as usize
    }

    fn row(&self, y: i64) -> usize {
        y.clamp(0, i64::from(self.height.max(1)) - 1) as usize
    }

    fn texel(&self, x: usize, y: usize) -> Vec3 {
        self.texels.get(y * self.width as usize + x).copied().unwrap_or(Vec3::ZERO)
    }

    /// World direction of a point of a texel; `inside` in [0, 1]^2 from the texel's top left.
    pub fn texel_direction(&self, x: u32, y: u32, inside: Vec2) -> Vec3 {
        let size = Vec2::new(self.width as f32, self.height as f32);
        self.direction_from_uv((Vec2::new(x as f32, y as f32) + inside) / size)
    }

    /// Light on a white plane that faces up and sees all of the sky above: irradiance in lx per
    /// channel. Turning the map does not change it.
    pub fn irradiance_up(&self) -> Vec3 {
        let mut sum = glam::DVec3::ZERO;
        let width = self.width.max(1) as usize;
        for (y, row) in self.texels.chunks(width).enumerate().take(self.height as usize) {
            let edge = |row: usize| (std::f64::consts::PI * row as f64 / f64::from(self.height)).cos().max(0.0);
            let total: glam::DVec3 = row.iter().map(|texel| texel.as_dvec3()).sum();
            // The integral of cos theta over a texel.
            sum += total * (edge(y).powi(2) - edge(y + 1).powi(2)) * std::f64::consts::PI / f64::from(self.width);
        }
        self.scale() * sum.as_vec3()
    }

    /// Solid angle of a texel of a row, in sr; those of the whole map sum to 4 pi.
    pub fn texel_solid_angle(&self, y: u32) -> f64 {
        let edge = |row: u32| (std::f64::consts::PI * f64::from(row) / f64::from(self.height)).cos();
        (edge(y) - edge(y + 1)) * std::f64::consts::TAU / f64::from(self.width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(rotation: f32) -> Environment {
        let texels = (0..32 * 16).map(|i| Vec3::new(i as f32, (i % 32) as f32, 1.0)).collect();
        Environment { rotation, ..Environment::new("test", 32, 16, texels) }
    }

    #[test]
    fn the_centre_of_the_map_is_minus_z_and_u_grows_to_the_right() {
        let map = map(0.0);
        assert!((map.direction_from_uv(Vec2::splat(0.5)) - Vec3::NEG_Z).length() < 1e-6);
        assert!((map.direction_from_uv(Vec2::new(0.75, 0.5)) - Vec3::X).length() < 1e-6);
        assert!((map.direction_from_uv(Vec2::new(0.3, 0.0)) - Vec3::Y).length() < 1e-6);
    }

    #[test]
    fn a_quarter_turn_brings_what_was_ahead_to_the_left() {
        let turned = map(std::f32::consts::FRAC_PI_2);
        assert!((turned.direction_from_uv(Vec2::splat(0.5)) - Vec3::NEG_X).length() < 1e-6);
    }

    #[test]
    fn directions_and_coordinates_are_inverse_to_each_other() {
        for rotation in [0.0, 0.7, -2.0] {
            let map = map(rotation);
            for i in 0..200 {
                let uv = Vec2::new((i as f32 * 0.618).fract(), 0.02 + 0.96 * (i as f32 * 0.414).fract());
                let back = map.uv_from_direction(map.direction_from_uv(uv));
                // The left edge is the right edge.
                let apart = Vec2::new((back.x - uv.x + 0.5).rem_euclid(1.0) - 0.5, back.y - uv.y);
                assert!(apart.length() < 1e-5, "{uv} came back as {back}");
            }
        }
    }

    #[test]
    fn texel_centres_return_the_texel() {
        let map = map(0.4);
        for (x, y) in [(0, 0), (31, 15), (7, 9)] {
            let uv = Vec2::new((x as f32 + 0.5) / 32.0, (y as f32 + 0.5) / 16.0);
            let got = map.radiance(map.direction_from_uv(uv));
            assert!((got - map.texels[y * 32 + x]).length() < 2e-3, "{got} at {x},{y}");
        }
    }

    #[test]
    fn solid_angles_sum_to_the_sphere() {
        let map = map(0.0);
        let sum: f64 = (0..map.height).map(|y| map.texel_solid_angle(y) * f64::from(map.width)).sum();
        assert!((sum - 4.0 * std::f64::consts::PI).abs() < 1e-9, "{sum}");
    }
}
