//! Scenes for Mitsuba 3: `scene.xml` with meshes as PLY and pictures as OpenEXR and PNG beside it.
//!
//! Mitsuba's surface models are single-scattering and one per shape; [`Report`] tells where a material is more than that.
//! Conventions (transforms, texture coordinates, where textures are read) were checked against Mitsuba 3.9.1; the test
//! `external` renders the same scenes with it and compares.

mod light;
mod material;
mod mesh;
mod metal;
mod sensor;
mod surface;
mod texture;
mod xml;

#[cfg(test)]
mod tests;

use std::path::Path;

use glam::UVec2;

use super::{Folder, Loss, Report, slug};
use crate::file::FileError;
use crate::material::preset::Preset;
use crate::scene::{Camera, LightKind, Scene};
use material::Written;
use xml::Element;

/// Name of the file that Mitsuba opens.
pub const MAIN: &str = "scene.xml";

/// How it begins; one that begins otherwise is not ours to replace.
const MARK: &str = "<!-- Burnish";

/// What is looked at, and how.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The eye.
    pub camera: &'a Camera,
    /// Pixels of the picture.
    pub size: UVec2,
    /// Paths through a pixel.
    pub samples: u32,
    /// Most surfaces on the way, as the path tracer counts them.
    pub bounces: u32,
}

/// What can be chosen.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// Metals with their measured n and k, for the `*_spectral` variants. Without it each has one index per channel.
    pub spectral: bool,
    /// A metal by its id.
    pub metal: &'a dyn Fn(&str) -> Option<Preset>,
}

/// Writes a scene into a folder, which is made where it is missing. Files of an earlier export are replaced, others
/// stay; `scene.xml` comes last.
pub fn export(scene: &Scene, view: &View<'_>, options: &Options<'_>, folder: &Path) -> Result<Report, FileError> {
    let mut folder = Folder::create(folder, MAIN, MARK)?;
    let mut root = Element::new("scene").attribute("version", "3.0.0");
    let mut textures = texture::Textures::new(scene);
    let mut materials = Vec::new();
    for index in 0..scene.materials.len() {
        let used = scene.instances.iter().any(|i| i.visible && i.material == index);
        let written = match used {
            true => material::write(scene, index, options, &mut textures, &mut folder)?,
            false => None,
        };
        materials.push(written);
    }
    tell_of_backs(scene, &mut folder.report);
    if !scene.background.is_plain() {
        let what = "the environment itself is seen, infinitely far away";
        folder.report.note("background", Loss::Dropped, what);
    }

    let transparent = materials.iter().flatten().any(|m| m.transparent);
    root = root.with(sensor::integrator(view, transparent)).with(sensor::sensor(view, scene.bounds()));
    if let Some(map) = &scene.environment {
        root = root.with(light::environment(map, &mut folder)?);
    }
    // A shape without an area is none there.
    let is_flat = |kind: LightKind| match kind {
        LightKind::Rectangle { size, .. } => size.min_element() <= 0.0,
        LightKind::Sphere { radius } => radius <= 0.0,
        _ => false,
    };
    for (index, lamp) in scene.lights.iter().enumerate().filter(|(_, lamp)| !is_flat(lamp.kind)) {
        root = root.with(light::lamp(index, lamp, &mut folder)?);
    }
    root = root.with_all(materials.iter().enumerate().filter_map(|(index, written)| {
        Some(written.as_ref()?.bsdf.clone().attribute("id", material_id(scene, index)))
    }));
    let mut meshes = mesh::Meshes::default();
    for instance in scene.instances.iter().filter(|i| i.visible) {
        let Some(Some(Written { emitter, wanted, hidden: false, .. })) = materials.get(instance.material) else {
            continue;
        };
        let Some(shape) = meshes.element(scene, instance, *wanted, &mut folder)? else { continue };
        let bsdf = Element::reference(&material_id(scene, instance.material));
        root = root.with(shape.with(bsdf).with_all(emitter.clone()));
    }
    let text = format!("{MARK} {}: linear Rec.709, metres, +y up -->\n{root}", env!("CARGO_PKG_VERSION"));
    folder.write(MAIN, text.as_bytes())?;
    Ok(folder.report)
}

/// The identifier of a material's element.
fn material_id(scene: &Scene, index: usize) -> String {
    format!("material-{}", slug(index, scene.materials.get(index).map_or("", |m| &m.name)))
}

/// Place of an element for notes.
fn element_name(kind: &str, index: usize, name: &str) -> String {
    format!("{kind} {index} '{name}'")
}

fn tell_of_backs(scene: &Scene, report: &mut Report) {
    let one_sided = |i: usize| scene.materials.get(i).is_some_and(|m| !m.double_sided);
    if scene.instances.iter().any(|i| i.visible && one_sided(i.material)) {
        let what = "black to the camera too, which here looks through them";
        report.note("backs of one-sided surfaces", Loss::Approximated, what);
    }
}
