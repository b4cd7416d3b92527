//! Import: model and environment files become a flat, validated [`Scene`] or [`Environment`].
//!
//! [`scene_from_bytes`] is a pure function: bytes and a [`Resolver`] in, a scene or every fault of the file out. It
//! never opens a path itself. Whatever a foreign file claims about its size is checked against a [`Budget`] before
//! memory is taken, all arithmetic on such claims is checked, and node graphs are walked with a list, not by recursion.
//! Nothing here writes files or knows a renderer.

mod budget;
mod data_uri;
mod environment;
mod folder;
mod gltf;
mod guard;
mod numbers;
mod obj;
pub mod optical;
mod picture;
mod report;
mod resolve;
mod shading;
mod sniff;

use std::path::Path;
use std::sync::Arc;

pub use budget::Budget;
pub use environment::environment_from_bytes;
pub use folder::FolderResolver;
pub use report::{Cause, Fault, ImportError, Notice};
pub use resolve::{ResolveError, Resolver};

use crate::scene::{Environment, Image, Scene};
use budget::Meter;
use report::Report;

/// What an import may be told.
#[derive(Clone, Debug, Default)]
pub struct ImportOptions {
    /// What to do with meshes that have no normals.
    pub normals: NormalsWhenAbsent,
    /// Limits on what a file may ask for.
    pub budget: Budget,
}

/// What to do with meshes that have no normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NormalsWhenAbsent {
    /// Flat for glTF, as its specification asks; smooth with a crease of 60 degrees for OBJ, which says nothing.
    #[default]
    FormatDefault,
    /// One normal per triangle; vertices are no longer shared.
    Flat,
    /// Area- and angle-weighted means over the triangles around a point.
    Smooth {
        /// Radians, 0 to pi; triangles whose normals differ by more do not share a normal.
        crease_angle: f32,
    },
}

/// Crease of an OBJ without normals: 60 degrees in radians.
pub const OBJ_CREASE_ANGLE: f32 = std::f32::consts::FRAC_PI_3;

/// A model that was read.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Passed [`Scene::validate`].
    pub scene: Scene,
    /// What was left out, repaired or guessed; empty for a file that was understood entirely.
    pub notices: Vec<Notice>,
}

/// Reads a model file (`.gltf`, `.glb`, `.obj`; the content decides) with the files beside it.
pub fn load_scene(path: &Path, options: &ImportOptions) -> Result<Imported, ImportError> {
    let (bytes, name) = read_named(path, &options.budget)?;
    let folder = FolderResolver::beside(path).map_err(|cause| ImportError::one(&name, "file", cause.into()))?;
    scene_from_bytes(&bytes, &name, &folder, options)
}

/// Reads a model from the bytes of its main file; `file_name` serves messages and the scene's name, and `resolver`
/// supplies the files that the model refers to.
pub fn scene_from_bytes(
    bytes: &[u8],
    file_name: &str,
    resolver: &dyn Resolver,
    options: &ImportOptions,
) -> Result<Imported, ImportError> {
    let mut report = Report::new(file_name);
    let mut meter = Meter::new(options.budget.clone());
    let scene = match sniff::model(bytes, file_name) {
        Ok(sniff::Model::Gltf) => gltf::scene(bytes, resolver, options.normals, &mut meter, &mut report),
        Ok(sniff::Model::Obj) => obj::scene(bytes, resolver, options.normals, &mut meter, &mut report),
        Err(cause) => {
            report.fault("file", cause);
            None
        }
    };
    if let Some(scene) = &scene {
        check_extent(scene, &mut report);
    }
    let (mut scene, notices) = report.finish(scene)?;
    scene.name = Path::new(file_name).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    // The readers check as they go and name the place in the file; this is the net below them.
    scene.validate().map_err(|faults| ImportError::from_scene(file_name, faults))?;
    Ok(Imported { scene, notices })
}

/// Squares and cubes of lengths up to this many metres are far from the end of f32.
const LARGEST: f32 = 1e12;

/// Models below this many metres or above a thousandth of [`LARGEST`] are hardly meant in metres.
const SMALLEST: f32 = 1e-6;

/// Positions have 24 bits: this far from the origin, in its own sizes, a model has about 1000 steps across left.
const FAR: f32 = 1e4;

/// Refuses scenes that are empty or too large to compute with; notices those that are oddly large, small or far off.
fn check_extent(scene: &Scene, report: &mut Report) {
    if scene.triangle_count() == 0 {
        let summary = report.summary();
        let because = if summary.is_empty() { String::new() } else { format!(" ({summary})") };
        report.fault("scene", Cause::Invalid(format!("there are no triangles to show{because}")));
        return;
    }
    let bounds = scene.bounds();
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
    let (radius, distance) = (bounds.radius(), bounds.center().length());
    if reach.is_nan() || reach > LARGEST {
        report.fault("scene", Cause::Invalid(format!("reaches {reach} m from the origin; {LARGEST} m is the limit")));
    } else if !(SMALLEST..=1e-3 * LARGEST).contains(&radius) {
        report.notice("scene", format!("has a radius of {radius} m; is its unit the metre?"));
    } else if distance > FAR * radius {
        let step = distance * f32::EPSILON;
        report.notice("scene", format!("lies {distance} m from the origin, where positions are rounded to {step} m"));
    }
}

/// Reads an equirectangular environment (`.hdr`, `.exr`; the content decides) with the default budget.
pub fn load_environment(path: &Path) -> Result<(Environment, Vec<Notice>), ImportError> {
    let budget = Budget::default();
    let (bytes, name) = read_named(path, &budget)?;
    environment_from_bytes(&bytes, &name, &budget)
}

/// Reads a picture for a texture (`.png`, `.jpg`; the content decides) with the default budget.
pub fn load_image(path: &Path) -> Result<Image, ImportError> {
    let budget = Budget::default();
    let (bytes, name) = read_named(path, &budget)?;
    let at = |cause| ImportError::one(&name, "picture", cause);
    let encoded = picture::Encoded::open(bytes, name.clone(), &mut Meter::new(budget)).map_err(at)?;
    encoded.decode().map_err(at)
}

/// Bytes of a file with the name by which messages call it.
fn read_named(path: &Path, budget: &Budget) -> Result<(Vec<u8>, String), ImportError> {
    let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
    match folder::read_regular(path, budget.file_bytes) {
        Ok(bytes) => Ok((bytes, name)),
        Err(cause) => Err(ImportError::one(&name, "file", cause.into())),
    }
}

/// What a reader makes of a file; faults, if any, are in its report.
type ReadScene = Option<Scene>;

/// Decoded pictures are shared between materials.
type SharedImage = Arc<crate::scene::Image>;

#[cfg(test)]
mod tests;
