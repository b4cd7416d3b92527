//! The node hierarchy, flattened: every placed primitive, light and camera in world space.

use std::collections::HashMap;

use ::gltf::json::scene::Node;
use glam::{Affine3A, DAffine3, DMat3, DMat4, DQuat, DVec3, Vec4Swizzles};

use super::accessor::Data;
use super::material::Materials;
use super::{element, primitive, punctual};
use crate::import::budget::Meter;
use crate::import::numbers::pick;
use crate::import::report::Report;
use crate::import::{Cause, NormalsWhenAbsent};
use crate::scene::{Instance, Scene};

/// Columns whose box has less than this part of the volume that their lengths would allow are taken for flat: such a
/// transform cannot be inverted in f32.
const FLAT: f64 = 1e-6;

/// A node that waits to be visited.
struct Waiting {
    node: usize,
    world_from_parent: DAffine3,
    depth: u64,
}

/// Everything but materials and images.
pub(super) fn flatten(
    data: &Data<'_>,
    materials: &Materials,
    normals: NormalsWhenAbsent,
    meter: &mut Meter,
    report: &mut Report,
) -> Option<Scene> {
    let roots = roots(data);
    let roots = report.keep("scene", roots)?;
    let mut scene = Scene::default();
    let mut meshes = Meshes { read: HashMap::new(), normals, materials };
    let mut visited = vec![false; data.root.nodes.len()];
    let mut waiting: Vec<Waiting> = Vec::new();
    // Reversed, so that nodes come out in the order of the file.
    for node in roots.into_iter().rev() {
        waiting.push(Waiting { node, world_from_parent: DAffine3::IDENTITY, depth: 1 });
    }
    while let Some(Waiting { node: index, world_from_parent, depth }) = waiting.pop() {
        let (node, at) = match arrive(data, index, depth, &mut visited, meter) {
            Ok(arrived) => arrived,
            Err((at, cause)) => {
                report.fault(at, cause);
                return None;
            }
        };
        let local = local_transform(node);
        let Some(parent_from_local) = report.keep(&at, local) else { continue };
        let world_from_local = world_from_parent * parent_from_local;
        place(data, node, &at, world_from_local, &mut meshes, &mut scene, meter, report)?;
        for child in node.children.iter().flatten().rev() {
            waiting.push(Waiting { node: child.value(), world_from_parent: world_from_local, depth: depth + 1 });
        }
    }
    Some(scene)
}

/// The nodes to start from: of the scene that the file chooses, else its first, else every node without a parent.
fn roots(data: &Data<'_>) -> Result<Vec<usize>, Cause> {
    let root = data.root;
    let scene = match root.scene {
        Some(index) => Some(pick(&root.scenes, index.value(), "scene")?),
        None => root.scenes.first(),
    };
    if let Some(scene) = scene {
        return Ok(scene.nodes.iter().map(|n| n.value()).collect());
    }
    let mut child = vec![false; root.nodes.len()];
    for index in root.nodes.iter().flat_map(|n| n.children.iter().flatten()) {
        if let Some(flag) = child.get_mut(index.value()) {
            *flag = true;
        }
    }
    Ok((0..root.nodes.len()).filter(|i| !child[*i]).collect())
}

/// The node with its name for messages, if it exists, was not there before and is not too deep.
fn arrive<'a>(
    data: &Data<'a>,
    index: usize,
    depth: u64,
    visited: &mut [bool],
    meter: &Meter,
) -> Result<(&'a Node, String), (String, Cause)> {
    let node = pick(&data.root.nodes, index, "node").map_err(|cause| ("nodes".to_string(), cause))?;
    let at = element("node", index, node.name.as_deref());
    if std::mem::replace(&mut visited[index], true) {
        return Err((at, Cause::Invalid("is reached twice: it has two parents or is its own ancestor".into())));
    }
    let limit = meter.budget.depth;
    if depth > limit {
        return Err((at, Cause::Limit { what: "levels of nodes", asked: depth, limit }));
    }
    Ok((node, at))
}

/// Parent from local, in f64 so that long chains keep their millimetres.
fn local_transform(node: &Node) -> Result<DAffine3, Cause> {
    let local = match &node.matrix {
        Some(matrix) => {
            let m = DMat4::from_cols_array(&matrix.map(f64::from));
            let last_row = m.row(3);
            // Exporters multiply matrices in f32, which leaves a rounding here.
            let affine = last_row.xyz().abs().max_element() <= 1e-5 && (last_row.w - 1.0).abs() <= 1e-5;
            if m.is_finite() && !affine {
                return Err(Cause::Invalid("the matrix is not affine (its last row is not 0 0 0 1)".into()));
            }
            DAffine3::from_mat4(m)
        }
        None => {
            let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
            let scale = node.scale.map_or(DVec3::ONE, |s| DVec3::from_array(s.map(f64::from)));
            let translation = node.translation.map_or(DVec3::ZERO, |t| DVec3::from_array(t.map(f64::from)));
            // Exporters round quaternions; a zero one has no direction to restore.
            let Some(length) = Some(rotation.length()).filter(|l| *l > 1e-6) else {
                return Err(Cause::Invalid("the rotation is zero or not finite".into()));
            };
            DAffine3::from_scale_rotation_translation(scale, rotation / length, translation)
        }
    };
    if local.is_finite() { Ok(local) } else { Err(Cause::Invalid("the transform is not finite".into())) }
}

/// Adds what a node carries. `None` when a budget is used up and going on is pointless.
#[expect(clippy::too_many_arguments, reason = "the walk's whole state meets here, once")]
fn place(
    data: &Data<'_>,
    node: &Node,
    at: &str,
    world_from_local: DAffine3,
    meshes: &mut Meshes<'_>,
    scene: &mut Scene,
    meter: &mut Meter,
    report: &mut Report,
) -> Option<()> {
    let name = || node.name.clone().unwrap_or_else(|| at.to_string());
    if let Some(camera) = node.camera {
        let camera = punctual::camera(data.root, camera.value(), name(), world_from_local);
        scene.cameras.extend(report.keep(at, camera));
    }
    if let Some(light) = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()) {
        let light = punctual::light(data.root, light.light.value(), name(), world_from_local, at, report);
        scene.lights.extend(report.keep(at, light));
    }
    let Some(mesh) = node.mesh else { return Some(()) };
    let transform = affine(world_from_local);
    if !transform.is_finite() {
        report.fault(at, Cause::Invalid("the transform to world space passes the range of 32-bit numbers".into()));
        return Some(());
    }
    if flat(world_from_local) || !transform.inverse().is_finite() {
        report.notice(at, "meshes whose transform cannot be inverted (a scale of 0) are not shown");
        return Some(());
    }
    for &(mesh, material) in meshes.primitives(data, mesh.value(), at, scene, meter, report) {
        let triangles = scene.meshes[mesh].indices.len() / 3;
        let taken = meter.take_instance(triangles as u64);
        report.keep(at, taken)?;
        scene.instances.push(Instance { name: name(), mesh, material, world_from_local: transform, visible: true });
    }
    Some(())
}

/// Nearest in f32.
pub(super) fn affine(a: DAffine3) -> Affine3A {
    Affine3A::from_mat3_translation(a.matrix3.as_mat3(), a.translation.as_vec3())
}

fn flat(a: DAffine3) -> bool {
    let m: DMat3 = a.matrix3;
    let box_volume = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    let volume = m.determinant().abs();
    volume.is_nan() || volume <= FLAT * box_volume
}

/// Primitives that were read: each mesh once, however many nodes show it.
struct Meshes<'a> {
    /// Mesh index of the file to (mesh, material) indices of the scene.
    read: HashMap<usize, Vec<(usize, usize)>>,
    normals: NormalsWhenAbsent,
    materials: &'a Materials,
}

impl Meshes<'_> {
    fn primitives(
        &mut self,
        data: &Data<'_>,
        index: usize,
        at: &str,
        scene: &mut Scene,
        meter: &mut Meter,
        report: &mut Report,
    ) -> &[(usize, usize)] {
        if !self.read.contains_key(&index) {
            let list = self.read_mesh(data, index, at, scene, meter, report);
            self.read.insert(index, list);
        }
        &self.read[&index]
    }

    fn read_mesh(
        &self,
        data: &Data<'_>,
        index: usize,
        at: &str,
        scene: &mut Scene,
        meter: &mut Meter,
        report: &mut Report,
    ) -> Vec<(usize, usize)> {
        let mesh = pick(&data.root.meshes, index, "mesh");
        let Some(mesh) = report.keep(at, mesh) else { return Vec::new() };
        let mesh_at = element("mesh", index, mesh.name.as_deref());
        let mut list = Vec::new();
        for (i, json) in mesh.primitives.iter().enumerate() {
            let at = format!("{mesh_at}, primitive {i}");
            let material = json.material.as_ref().map_or(Ok(self.materials.default), |m| {
                pick(&data.root.materials, m.value(), "material").map(|_| m.value())
            });
            let Some(material) = report.keep(&at, material) else { continue };
            let uses = self.materials.uses(material);
            let read = primitive::read(data, json, &at, uses, self.normals, meter, report);
            if let Some(mut read) = read {
                let name = mesh.name.as_deref().map_or_else(|| format!("mesh {index}"), str::to_string);
                read.name = if mesh.primitives.len() > 1 { format!("{name}.{i}") } else { name };
                scene.meshes.push(read.into());
                list.push((scene.meshes.len() - 1, material));
            }
        }
        if mesh.weights.is_some() || mesh.primitives.iter().any(|p| p.targets.is_some()) {
            report.notice(mesh_at, "morph targets are not applied; the model is shown at rest".to_string());
        }
        list
    }
}
