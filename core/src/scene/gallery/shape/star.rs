//! Smooth bodies around the origin: a ball with bumps and dents.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::{
    Builder, Vertex,
    revolve::{around, at_angle},
};
use crate::scene::Mesh;

/// A bump of a body: `height exp(sharpness (d . towards - 1))` metres are added to its radius in the direction d.
#[derive(Clone, Copy, Debug)]
pub struct Bump {
    /// Unit.
    pub towards: Vec3,
    /// Metres, negative for a dent.
    pub height: f32,
    /// 2 is broad, 60 is a finger.
    pub sharpness: f32,
}

impl Bump {
    /// A bump towards any direction.
    pub fn new(towards: Vec3, height: f32, sharpness: f32) -> Bump {
        Bump { towards: towards.normalize_or(Vec3::Y), height, sharpness }
    }

    /// What it adds to the radius in the direction `d`, and the gradient of that.
    fn at(&self, d: Vec3) -> (f32, Vec3) {
        let height = self.height * (self.sharpness * (d.dot(self.towards) - 1.0)).exp();
        (height, self.sharpness * height * self.towards)
    }
}

/// A ball with bumps, `segments` around and half as many from pole to pole. Texture set 1 is in metres of the ball.
pub fn star(name: &str, radius: f32, bumps: &[Bump], segments: usize) -> Mesh {
    let mut builder = Builder::default();
    let columns = segments.max(4);
    let rows = columns / 2;
    builder.grid(columns, rows, |i, j| {
        // A pole has no direction around: each of its triangles gets the one of its middle, as on a turned body.
        let shift = match j {
            0 => 0.5,
            j if j == rows => -0.5,
            _ => 0.0,
        };
        let uv = Vec2::new((i as f32 + shift) / columns as f32, j as f32 / rows as f32);
        // The last column is the first one.
        let angle = if i == columns && shift == 0.0 { 0.0 } else { TAU * uv.x };
        let d = match j {
            0 => Vec3::Y,
            j if j == rows => Vec3::NEG_Y,
            _ => at_angle(Vec2::new((PI * uv.y).sin(), (PI * uv.y).cos()), angle),
        };
        let (r, gradient) = bumps
            .iter()
            .map(|bump| bump.at(d))
            .fold((radius, Vec3::ZERO), |sum, (height, gradient)| (sum.0 + height, sum.1 + gradient));
        let across = around(angle);
        Vertex {
            position: r * d,
            normal: (r * d - (gradient - d * d.dot(gradient))).normalize(),
            tangent: (r * across + d * gradient.dot(across)).normalize(),
            uv,
            uv_metres: uv * Vec2::new(TAU, PI) * radius,
        }
    });
    builder.finish(name)
}

/// A lump with soft hills and hollows of about `radius` metres.
pub fn blob(radius: f32, segments: usize) -> Mesh {
    let bump = |x, y, z, height: f32, sharpness| Bump::new(Vec3::new(x, y, z), height * radius, sharpness);
    let bumps = [
        bump(1.0, 0.5, 0.4, 0.34, 5.0),
        bump(-0.7, 0.9, 0.2, 0.3, 6.0),
        bump(-0.6, -0.5, 0.8, 0.32, 5.0),
        bump(0.2, -0.6, -1.0, 0.3, 4.0),
        bump(0.5, -1.0, 0.5, 0.26, 6.0),
        bump(0.15, 0.25, 1.0, -0.3, 5.0),
        bump(-1.0, 0.0, -0.3, -0.26, 6.0),
        bump(0.6, 0.4, -0.8, -0.22, 6.0),
        bump(0.1, 1.0, -0.4, -0.2, 5.0),
    ];
    star("blob", 0.86 * radius, &bumps, segments)
}

/// A sitting animal with long ears that looks towards +z, about `radius` metres from its middle to the end of its feet.
pub fn bunny_like(radius: f32, segments: usize) -> Mesh {
    let bump = |x, y, z, height: f32, sharpness| Bump::new(Vec3::new(x, y, z), height * radius, sharpness);
    let both = |x: f32, y, z, height, sharpness| [bump(x, y, z, height, sharpness), bump(-x, y, z, height, sharpness)];
    let single = [
        // Head and muzzle, chest, back, tail.
        bump(0.0, 0.62, 0.78, 0.4, 9.0),
        bump(0.0, 0.4, 0.92, 0.14, 40.0),
        bump(0.0, -0.3, 0.95, 0.12, 8.0),
        bump(0.0, -0.25, -1.0, 0.2, 5.0),
        bump(0.0, -0.45, -0.9, 0.13, 60.0),
    ];
    let pairs = [
        // Ears, thighs, hind feet, paws.
        both(0.26, 1.0, 0.3, 0.62, 70.0),
        both(0.85, -0.45, -0.15, 0.16, 9.0),
        both(0.5, -0.75, 0.62, 0.22, 30.0),
        both(0.2, -0.62, 0.85, 0.14, 45.0),
    ];
    let bumps: Vec<Bump> = single.into_iter().chain(pairs.into_iter().flatten()).collect();
    star("bunny-like", 0.66 * radius, &bumps, segments)
}
