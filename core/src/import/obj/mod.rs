//! Wavefront OBJ with MTL, through `tobj`.
//!
//! `tobj` reads well-formed text; it passes NaN, opens any path and panics on a short colour. So the text is checked
//! line by line first ([`lines`]), which also gives faults their line numbers, and files come from the resolver.
//! Polygons are cut as fans, which is right for convex ones. OBJ knows no sides: materials are double-sided.

mod lines;
mod material;
#[cfg(test)]
mod tests;

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::path::Path;

use glam::{Affine3A, Vec2, Vec3, Vec4};

use super::budget::Meter;
use super::report::Report;
use super::resolve::quoted;
use super::shading::{self, Normals};
use super::{Cause, NormalsWhenAbsent, OBJ_CREASE_ANGLE, ReadScene, Resolver};
use crate::color::rgb::linear_from_srgb;
use crate::scene::{Instance, Mesh, Scene};

/// Reads a model; faults and notices go to the report.
pub(super) fn scene(
    bytes: &[u8],
    resolver: &dyn Resolver,
    normals: NormalsWhenAbsent,
    meter: &mut Meter,
    report: &mut Report,
) -> ReadScene {
    let taken = meter.take_bytes(bytes.len() as u64);
    report.keep("file", taken)?;
    let checked = lines::check(&String::from_utf8_lossy(bytes), meter, report)?;
    let (models, tobj_materials) = load(&checked.text, resolver, meter, report)?;

    let mut scene = Scene::default();
    let read = material::read_all(&tobj_materials, resolver, meter, report);
    scene.materials = read.materials;
    scene.images = read.images;
    let policy = match normals {
        NormalsWhenAbsent::FormatDefault => Normals::Smooth { crease_angle: OBJ_CREASE_ANGLE },
        NormalsWhenAbsent::Flat => Normals::Flat,
        NormalsWhenAbsent::Smooth { crease_angle } => Normals::Smooth { crease_angle },
    };
    for model in models.into_iter().filter(|m| m.mesh.indices.len() >= 3) {
        let at = format!("object {}", quoted(&model.name));
        let material = model.mesh.material_id.filter(|m| *m < scene.materials.len()).unwrap_or_else(|| {
            let default = |m: &crate::material::Material| m.name == material::DEFAULT_NAME;
            scene.materials.iter().position(default).unwrap_or_else(|| {
                scene.materials.push(material::default());
                scene.materials.len() - 1
            })
        });
        let mesh = mesh(&model, checked.normals_complete);
        let Some(mut mesh) = report.keep(&at, mesh) else { continue };
        shading::complete(&mut mesh, policy, 0).tell(&at, report);
        let taken = meter.take_instance(mesh.indices.len() as u64 / 3);
        report.keep(&at, taken)?;
        let world_from_local = Affine3A::IDENTITY;
        scene.instances.push(Instance {
            name: model.name,
            mesh: scene.meshes.len(),
            material,
            world_from_local,
            visible: true,
        });
        scene.meshes.push(mesh.into());
    }
    if scene.meshes.is_empty() {
        report.fault("file", Cause::Invalid("has no faces".into()));
        return None;
    }
    Some(scene)
}

/// Runs `tobj` over checked text.
fn load(
    text: &str,
    resolver: &dyn Resolver,
    meter: &mut Meter,
    report: &mut Report,
) -> Option<(Vec<tobj::Model>, Vec<tobj::Material>)> {
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    // `tobj` takes a shared function, so what it changes is behind a cell; it is called on this thread only.
    let state = RefCell::new((HashSet::new(), meter, &mut *report));
    let library = |path: &Path| {
        let mut state = state.borrow_mut();
        let (seen, meter, report) = &mut *state;
        let name = path.to_string_lossy().into_owned();
        // A library named twice was read the first time.
        Ok(match seen.insert(name.clone()) {
            true => material::library(&name, resolver, meter, report),
            false => Default::default(),
        })
    };
    let loaded = tobj::load_obj_buf(&mut text.as_bytes(), &options, library);
    drop(state);
    match loaded {
        Ok((models, materials)) => Some((models, materials.unwrap_or_default())),
        Err(error) => {
            report.fault("file", Cause::Syntax(format!("cannot be read: {error}")));
            None
        }
    }
}

/// Vertices from the separate index lists of positions, coordinates and normals: one per combination that occurs.
fn mesh(model: &tobj::Model, use_normals: bool) -> Result<Mesh, Cause> {
    let source = &model.mesh;
    let broken = || Cause::Invalid("an index is outside its list".into());
    let triple = |list: &[f32], i: u32| {
        let start = 3 * i as usize;
        list.get(start..start + 3).map(Vec3::from_slice).ok_or_else(broken)
    };
    let with_uvs = !source.texcoord_indices.is_empty();
    let with_normals = use_normals && !source.normal_indices.is_empty();
    let mut mesh = Mesh { name: model.name.clone(), ..Mesh::default() };
    let mut vertices: HashMap<(u32, u32, u32), u32> = HashMap::new();
    for (corner, &p) in source.indices.iter().enumerate() {
        let part = |used: bool, list: &[u32]| if used { list.get(corner).copied().ok_or_else(broken) } else { Ok(0) };
        let t = part(with_uvs, &source.texcoord_indices)?;
        let n = part(with_normals, &source.normal_indices)?;
        if let Some(&vertex) = vertices.get(&(p, t, n)) {
            mesh.indices.push(vertex);
            continue;
        }
        let vertex = vertices.len() as u32;
        vertices.insert((p, t, n), vertex);
        mesh.indices.push(vertex);
        mesh.positions.push(triple(&source.positions, p)?);
        if with_normals {
            mesh.normals.push(triple(&source.normals, n)?);
        }
        if with_uvs {
            let start = 2 * t as usize;
            let uv = source.texcoords.get(start..start + 2).map(Vec2::from_slice).ok_or_else(broken)?;
            // The origin of OBJ is at the bottom left of the image.
            mesh.uvs[0].push(Vec2::new(uv.x, 1.0 - uv.y));
        }
        if !source.vertex_color.is_empty() {
            mesh.colors.push(linear(triple(&source.vertex_color, p)?));
        }
    }
    Ok(mesh)
}

/// Vertex colours of OBJ are an unwritten extension; the tools that write them write display (sRGB) values.
fn linear(srgb: Vec3) -> Vec4 {
    linear_from_srgb(srgb).extend(1.0)
}
