//! The truth: unidirectional path tracing.
//!
//! A [`World`] is a scene made ready; [`World::sample`] follows one path through one pixel and is a pure function of
//! seed, pixel and number of the sample, so that any number of threads gives the same picture.

mod backdrop;
mod bsdf;
pub mod checkpoint;
mod emitters;
mod eye;
mod film;
mod lamps;
mod layers;
mod lights;
mod pacing;
mod passes;
mod path;
mod point;
mod sampler;
mod settings;
mod shapes;
mod sky;
mod texture;
mod waves;
mod world;

#[cfg(test)]
mod tests;

use glam::{UVec2, Vec3};

use crate::lighting::{Cover, Coverage, Method, MethodId, MethodInfo, Reads};
use crate::scene::Camera;

pub use eye::{Drawn, Eye, Reflecting, SurfacePoint};
pub use film::{Film, NOTHING, Pixel, Rejected};
pub use pacing::{End, Goal, MAX_SAMPLES, Pacing, Step};
pub use passes::{Control, Pass, preview, preview_with, trace, trace_with};
pub use path::Apart;
pub use settings::{COMPARED_PARAMS, Contribution, Options, PARAMS, is_spectral};
pub use texture::mean_texel;
pub use world::{Sighted, World};

/// Id of the method, as documents name it.
pub const ID: &str = "reference";

/// The method as others see it: in a comparison its cost is that of `samples` paths a pixel.
#[derive(Debug)]
pub struct Reference;

static INFO: MethodInfo = MethodInfo {
    id: MethodId(ID),
    title: "Reference",
    summary: "Unidirectional path tracing with multiple importance sampling: right but for noise.",
    params: COMPARED_PARAMS,
    coverage: Coverage {
        lamps: Cover::Exact,
        environment: Cover::Exact,
        indirect_diffuse: Cover::Exact,
        indirect_glossy: Cover::Exact,
        emission: Cover::Exact,
    },
    reads: Reads::NOTHING,
    revision: 1,
};

impl Method for Reference {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }
}

/// What is looked at, and from where.
#[derive(Clone, Debug)]
pub struct View {
    /// The eye.
    pub camera: Camera,
    /// Pixels of the picture.
    pub size: UVec2,
    /// Pictures of different seeds are independent of each other.
    pub seed: u32,
}

/// What one path brought back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSample {
    /// Scene-linear Rec.709; may be not finite where something is wrong, the film counts and drops such samples.
    pub radiance: Vec3,
    /// Radiance that the clamp took away; zero without one.
    pub clamped: Vec3,
    /// The first surface.
    pub first: Option<FirstHit>,
    /// Rays that were cast, of both kinds.
    pub rays: u32,
}

/// The surface that a path meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// Shading normal in the world, unit.
    pub normal: Vec3,
    /// Share of even light that the surface sends back toward the eye, about.
    pub albedo: Vec3,
    /// Index into `Scene::instances`.
    pub instance: u32,
    /// Index into `Scene::materials`.
    pub material: u32,
}
