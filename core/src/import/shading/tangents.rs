//! Tangents: from texture coordinates (MikkTSpace) or, without them, from the normal alone.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec3, Vec4};

use super::gather;
use super::normals::weld;
use crate::scene::Mesh;

/// A unit tangent that runs around the y axis, as the grooves of a turned part do: smooth everywhere but at the poles,
/// where x takes over.
pub(super) fn around_y(normal: Vec3) -> Vec4 {
    let around = Vec3::Y.cross(normal);
    let tangent = if around.length_squared() > 1e-6 {
        around.normalize()
    } else {
        Vec3::X.reject_from_normalized(normal).normalize()
    };
    tangent.extend(1.0)
}

/// Makes the tangents of a file unit, perpendicular to the normals and signed; counts those that had to be replaced.
pub(super) fn repair(mesh: &mut Mesh) -> usize {
    let mut lost = 0;
    for (tangent, normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
        let sign = if tangent.w < 0.0 { -1.0 } else { 1.0 };
        match perpendicular(tangent.truncate(), *normal) {
            Some(direction) => *tangent = direction.extend(sign),
            None => {
                lost += 1;
                *tangent = around_y(*normal);
            }
        }
    }
    lost
}

/// The part of `v` perpendicular to the unit `normal`, as a unit vector; none when nothing is left of it.
fn perpendicular(v: Vec3, normal: Vec3) -> Option<Vec3> {
    v.try_normalize()?.reject_from_normalized(normal).try_normalize().filter(|_| {
        // Less than half a degree off the normal the direction is mostly rounding.
        v.normalize().dot(normal).abs() < 0.99996
    })
}

/// MikkTSpace compares all triangles at a point with each other; beyond this many it would take too long.
const LARGEST_FAN: u32 = 2048;

/// True when more triangles meet at one point than MikkTSpace takes in good time.
pub(super) fn crowded(mesh: &Mesh) -> bool {
    let points = weld(&mesh.positions);
    let mut counts = vec![0_u32; points.len()];
    mesh.indices.iter().for_each(|i| counts[points[*i as usize] as usize] += 1);
    counts.into_iter().any(|count| count > LARGEST_FAN)
}

/// Tangents by MikkTSpace. Vertices at which triangles disagree (mirrored coordinates) are taken apart.
pub(super) fn mikktspace(mesh: &mut Mesh, uv_set: usize) {
    let mut corners = Corners { mesh, uv_set, tangents: vec![None; mesh.indices.len()] };
    // The error type has no values: nothing can fail.
    let _ = generate_tangents(&mut corners);
    let tangents = corners.tangents;

    let mut vertices: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    let (mut sources, mut kept) = (Vec::new(), Vec::new());
    for (index, tangent) in mesh.indices.iter_mut().zip(tangents) {
        let normal = mesh.normals[*index as usize];
        let tangent = tangent
            .and_then(|t: Vec4| Some(perpendicular(t.truncate(), normal)?.extend(t.w)))
            .unwrap_or_else(|| around_y(normal));
        let key = (*index, tangent.to_array().map(f32::to_bits));
        *index = *vertices.entry(key).or_insert_with(|| {
            sources.push(*index);
            kept.push(tangent);
            sources.len() as u32 - 1
        });
    }
    gather(mesh, &sources);
    mesh.tangents = kept;
}

/// A mesh as MikkTSpace sees it.
struct Corners<'a> {
    mesh: &'a Mesh,
    uv_set: usize,
    tangents: Vec<Option<Vec4>>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.indices[3 * face + corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.indices.len() / 3
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    /// MikkTSpace takes v as pointing up, and so do normal maps (green is up); our v points down.
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let uv = self.mesh.uvs[self.uv_set][self.vertex(face, corner)];
        [uv.x, -uv.y]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        self.tangents[3 * face + corner] = space.map(|s| Vec4::from(s.tangent_encoded()));
    }
}
