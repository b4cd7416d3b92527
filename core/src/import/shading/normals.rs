//! Normals from triangles.

use std::collections::HashMap;

use glam::Vec3;

use super::{Repairs, UNIT_TOLERANCE, gather};
use crate::scene::Mesh;

/// Unit normal of a triangle; zero when it has no area. In f64, so that triangles of 1e-20 m^2 and of 1e20 m^2 have
/// theirs.
fn face_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    let (ab, ac) = (b - a, c - a);
    let cross = ab.cross(ac);
    let scale = ab.length() * ac.length();
    // Below this sine the direction is the rounding of the positions.
    if cross.length() > 1e-9 * scale { cross.normalize_or_zero().as_vec3().normalize_or_zero() } else { Vec3::ZERO }
}

/// The corners' positions of every triangle.
fn triangles(mesh: &Mesh) -> impl Iterator<Item = [Vec3; 3]> {
    mesh.indices.chunks_exact(3).map(|t| [0, 1, 2].map(|k| mesh.positions[t[k] as usize]))
}

/// Triangles without area.
pub(super) fn degenerate(mesh: &Mesh) -> usize {
    triangles(mesh).filter(|t| face_normal(*t) == Vec3::ZERO).count()
}

/// One normal per triangle; every corner becomes a vertex of its own. A triangle without area gets +y: nobody sees it.
pub(super) fn flat(mesh: &mut Mesh) {
    let normals = triangles(mesh).map(|t| unit_or_y(face_normal(t))).flat_map(|n| [n; 3]).collect();
    let corners = std::mem::take(&mut mesh.indices);
    gather(mesh, &corners);
    mesh.indices = (0..corners.len() as u32).collect();
    mesh.normals = normals;
}

/// Angle-weighted normals that are shared across every edge where the triangles meet at no more than `crease_angle`
/// radians. Vertices at sharper edges are taken apart; texture seams are smoothed over.
///
/// Weights by angle do not depend on how a flat part is cut into triangles (Thurmer and Wuthrich 1998). Sharing spreads
/// from edge to edge, so the work is linear in the triangles, however many meet at one point.
pub(super) fn smooth(mesh: &mut Mesh, crease_angle: f32) {
    let faces: Vec<Vec3> = triangles(mesh).map(face_normal).collect();
    let points = weld(&mesh.positions);
    let point = |corner: usize| points[mesh.indices[corner] as usize];
    let mut groups = Groups::new(mesh.indices.len());

    // Step 1: every edge, with the corner at which it starts, sorted so that its triangles are neighbours. Triangles
    // without area have no direction and would only stand between those that have one.
    let mut edges: Vec<(u32, u32, u32)> = (0..mesh.indices.len())
        .filter(|corner| faces[corner / 3] != Vec3::ZERO)
        .map(|corner| {
            let (p, q) = (point(corner), point(next(corner)));
            (p.min(q), p.max(q), corner as u32)
        })
        .collect();
    edges.sort_unstable();
    let least_cos = crease_angle.clamp(0.0, std::f32::consts::PI).cos() - 1e-6;
    for pair in edges.windows(2) {
        let ((p, q, a), (p2, q2, b)) = (pair[0], pair[1]);
        let (a, b) = (a as usize, b as usize);
        if (p, q) != (p2, q2) || p == q || faces[a / 3].dot(faces[b / 3]) < least_cos {
            continue;
        }
        // Triangles that agree on their winding run along a shared edge in opposite directions.
        if point(a) == point(next(b)) {
            groups.join(a, next(b));
            groups.join(next(a), b);
        }
    }

    // Step 2: sums over the corners of a group.
    let mut sums = vec![Vec3::ZERO; mesh.indices.len()];
    for (face, corners) in triangles(mesh).enumerate() {
        for k in 0..3 {
            let (here, to, from) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
            let angle = (to - here).angle_between(from - here);
            if angle.is_finite() {
                sums[groups.root(3 * face + k)] += angle * faces[face];
            }
        }
    }

    // Step 3: one vertex per old vertex and group.
    let mut vertices: HashMap<(u32, usize), u32> = HashMap::new();
    let (mut sources, mut normals) = (Vec::new(), Vec::new());
    for corner in 0..mesh.indices.len() {
        let (old, root) = (mesh.indices[corner], groups.root(corner));
        mesh.indices[corner] = *vertices.entry((old, root)).or_insert_with(|| {
            sources.push(old);
            let sum = sums[root].normalize_or_zero();
            normals.push(unit_or_y(if sum == Vec3::ZERO { faces[corner / 3] } else { sum }));
            sources.len() as u32 - 1
        });
    }
    gather(mesh, &sources);
    mesh.normals = normals;
}

/// Rescales the normals of a file and replaces those of length zero by the mean of the triangles around.
pub(super) fn repair(mesh: &mut Mesh, repairs: &mut Repairs) {
    let mut lost = Vec::new();
    for (i, normal) in mesh.normals.iter_mut().enumerate() {
        let length = normal.as_dvec3().length();
        if length < 1e-12 {
            lost.push(i);
            continue;
        }
        if (length - 1.0).abs() > f64::from(UNIT_TOLERANCE) {
            repairs.rescaled_normals += 1;
        }
        *normal = (normal.as_dvec3() / length).as_vec3();
    }
    repairs.zero_normals = lost.len();
    if lost.is_empty() {
        return;
    }
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for (corners, indices) in triangles(mesh).zip(mesh.indices.chunks_exact(3)) {
        let normal = face_normal(corners);
        indices.iter().for_each(|i| sums[*i as usize] += normal);
    }
    for i in lost {
        mesh.normals[i] = unit_or_y(sums[i].normalize_or_zero());
    }
}

/// Number of the first vertex at the same place, for each vertex.
pub(super) fn weld(positions: &[Vec3]) -> Vec<u32> {
    let mut seen = HashMap::new();
    let numbers = positions.iter().enumerate().map(|(i, p)| {
        // Adding 0 makes -0 the same as 0.
        *seen.entry((*p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(i as u32)
    });
    numbers.collect()
}

/// The next corner of the same triangle.
fn next(corner: usize) -> usize {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

fn unit_or_y(v: Vec3) -> Vec3 {
    if v == Vec3::ZERO { Vec3::Y } else { v }
}

/// Disjoint sets of corners.
struct Groups(Vec<u32>);

impl Groups {
    fn new(count: usize) -> Groups {
        Groups((0..count as u32).collect())
    }

    /// The set's representative; halves the path on the way.
    fn root(&mut self, mut corner: usize) -> usize {
        while self.0[corner] as usize != corner {
            let above = self.0[self.0[corner] as usize];
            self.0[corner] = above;
            corner = above as usize;
        }
        corner
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        // The smaller number leads, so that the result does not depend on the order of joining.
        self.0[a.max(b)] = a.min(b) as u32;
    }
}
