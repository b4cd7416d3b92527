//! Rays against the triangles of a scene.

mod accel;
mod brute;
mod flat;
mod mesh_tree;
mod offset;
mod placed;
#[cfg(test)]
mod tests;
mod triangle;
mod walk;
mod wide;

use glam::{Vec2, Vec3};

pub use accel::Accel;
pub use brute::brute_force;
pub use flat::{Flat, FlatInstance, FlatNode, FlatTriangle};
pub use offset::{offset, rounding};

/// A part of a line in the world: points `origin + t direction` with `0 <= t < t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Metres.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// Metres; infinite for a ray without an end.
    pub t_max: f32,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Metres along the ray.
    pub t: f32,
    /// Index into `Scene::instances`.
    pub instance: u32,
    /// Place of the triangle in its mesh: its corners are the indices `3 triangle` and the two after it.
    pub triangle: u32,
    /// Weights of the second and third corner.
    pub barycentric: Vec2,
}
