//! A photographer's studio as an environment: large soft boxes in a dark room, painted by code.
//!
//! Made for metals, which show nothing but what they reflect: boxes with straight, soft edges for clean highlights,
//! and darkness between them for contrast. Radiance is in the units of the scene, about 1 on average.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::scene::Environment;

/// Pixels from the zenith to the nadir; twice as many around.
const HEIGHT: u32 = 512;

/// A rectangle of light at distance 1 that faces the middle of the studio.
struct SoftBox {
    /// Where it hangs: radians from the front (+z, behind the usual camera) to the right, then up.
    azimuth: f32,
    elevation: f32,
    /// Half width and half height at distance 1: tangents of the half angles.
    half: Vec2,
    /// Width of the soft edge, in the same measure.
    softness: f32,
    /// Radiance in the middle.
    radiance: Vec3,
    /// Share of the radiance that is lost towards the edge, as where a bulb is behind the cloth.
    falloff: f32,
}

/// The lamps: key left, fill right, two strips beside the object for its edges, one from above, and a white card below
/// the camera that shapes what looks down.
const BOXES: [SoftBox; 6] = [
    SoftBox {
        azimuth: -0.85,
        elevation: 0.6,
        half: Vec2::new(0.36, 0.5),
        softness: 0.05,
        radiance: Vec3::new(9.6, 9.1, 8.4),
        falloff: 0.4,
    },
    SoftBox {
        azimuth: 1.0,
        elevation: 0.35,
        half: Vec2::new(0.3, 0.55),
        softness: 0.16,
        radiance: Vec3::new(1.7, 1.95, 2.25),
        falloff: 0.3,
    },
    SoftBox {
        azimuth: -2.0,
        elevation: 0.25,
        half: Vec2::new(0.055, 0.8),
        softness: 0.03,
        radiance: Vec3::new(16.0, 16.4, 16.8),
        falloff: 0.2,
    },
    SoftBox {
        azimuth: 2.05,
        elevation: 0.2,
        half: Vec2::new(0.045, 0.75),
        softness: 0.025,
        radiance: Vec3::new(14.0, 13.2, 12.0),
        falloff: 0.2,
    },
    SoftBox {
        azimuth: 0.15,
        elevation: 1.4,
        half: Vec2::new(0.6, 0.2),
        softness: 0.08,
        radiance: Vec3::new(3.6, 3.6, 3.6),
        falloff: 0.4,
    },
    SoftBox {
        azimuth: 0.35,
        elevation: -0.5,
        half: Vec2::new(0.6, 0.16),
        softness: 0.1,
        radiance: Vec3::new(1.9, 1.8, 1.65),
        falloff: 0.5,
    },
];

/// The studio that lights a scene without an environment of its own.
pub fn studio() -> Environment {
    let (width, height) = (2 * HEIGHT, HEIGHT);
    let lamps: Vec<Lamp> = BOXES.iter().map(Lamp::new).collect();
    // Column centres: azimuth 0 of the image is -z, seen at its middle.
    let columns: Vec<(f32, f32)> =
        (0..width).map(|x| (((x as f32 + 0.5) / width as f32 - 0.5) * TAU).sin_cos()).collect();
    let mut texels = vec![Vec3::ZERO; (width * height) as usize];
    texels.par_chunks_exact_mut(width as usize).enumerate().for_each(|(y, row)| {
        let (sin_theta, cos_theta) = ((y as f32 + 0.5) / height as f32 * PI).sin_cos();
        let room = Room::at(cos_theta);
        for (texel, (sin, cos)) in row.iter_mut().zip(&columns) {
            let direction = Vec3::new(sin_theta * sin, cos_theta, -sin_theta * cos);
            *texel = lamps.iter().fold(room.radiance(direction), |sum, lamp| sum + lamp.radiance(direction));
        }
    });
    Environment::new("studio", width, height, texels)
}

/// The unlit studio at one height: a dark backdrop, brightest just above the horizon, and a warm floor that fades out
/// below.
struct Room {
    /// Radiance behind the camera (+z), and what the backdrop (-z) has more.
    front: Vec3,
    backdrop: Vec3,
}

impl Room {
    /// `up` is the sine of the elevation.
    fn at(up: f32) -> Room {
        // The floor meets the backdrop in a round cove, not in an edge.
        let floor = smooth_step(0.05, -0.08, up);
        let ground = Vec3::new(0.40, 0.33, 0.26) * (1.0 - 0.65 * smooth_step(-0.05, -0.9, up));
        let glow = (-(up - 0.1) * (up - 0.1) / 0.06).exp() * Vec3::new(0.26, 0.275, 0.30);
        let wall = Vec3::new(0.035, 0.038, 0.044) + 0.2 * glow;
        Room { front: wall.lerp(ground, floor), backdrop: 0.55 * glow * (1.0 - floor) }
    }

    fn radiance(&self, direction: Vec3) -> Vec3 {
        self.front + self.backdrop * (0.5 - 0.5 * direction.z)
    }
}

/// A soft box with its frame of reference.
struct Lamp<'a> {
    shape: &'a SoftBox,
    toward: Vec3,
    right: Vec3,
    up: Vec3,
    /// Cosine of the angle to the corners, beyond which nothing is left.
    least_depth: f32,
}

impl<'a> Lamp<'a> {
    fn new(shape: &'a SoftBox) -> Lamp<'a> {
        let (sin, cos) = shape.azimuth.sin_cos();
        let (rise, level) = shape.elevation.sin_cos();
        let toward = Vec3::new(level * sin, rise, level * cos);
        let right = Vec3::new(cos, 0.0, -sin);
        let least_depth = (1.0 + shape.half.length_squared()).sqrt().recip();
        Lamp { shape, toward, right, up: toward.cross(right), least_depth }
    }

    /// What the box sends from a direction.
    fn radiance(&self, direction: Vec3) -> Vec3 {
        let SoftBox { half, softness, radiance, falloff, .. } = *self.shape;
        let depth = direction.dot(self.toward);
        if depth <= self.least_depth {
            return Vec3::ZERO;
        }
        let at = Vec2::new(direction.dot(self.right), direction.dot(self.up)) / depth;
        // Distance inside the rectangle, whose corners are rounded by the soft edge.
        let out = (at.abs() - half + softness).max(Vec2::ZERO);
        let cover = smooth_step(1.0, 0.0, out.length() / softness);
        let center = 1.0 - falloff * (at / half).length_squared().min(2.0) * 0.5;
        radiance * (cover * center)
    }
}

/// 0 at `from`, 1 at `to`, level at both; `from` may be the greater one.
fn smooth_step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
