//! Normals and tangents for meshes that lack them, and repair of those that are broken.

mod normals;
mod tangents;
#[cfg(test)]
mod tests;

use glam::{Vec3, Vec4};

use super::report::Report;
use crate::scene::Mesh;

/// How to make normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Normals {
    /// One per triangle.
    Flat,
    /// Shared across edges that are less sharp.
    Smooth {
        /// Radians.
        crease_angle: f32,
    },
}

/// What had to be repaired.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Repairs {
    /// Normals far from unit length, rescaled.
    pub rescaled_normals: usize,
    /// Normals of length zero, replaced by those of the triangles around.
    pub zero_normals: usize,
    /// Tangents of length zero or along the normal, replaced by any perpendicular.
    pub lost_tangents: usize,
    /// Triangles without area.
    pub degenerate: usize,
    /// Tangents were not taken from texture coordinates, since too many triangles meet at one point.
    pub crowded: bool,
}

impl Repairs {
    /// Turns the counts into notices.
    pub fn tell(self, at: &str, report: &mut Report) {
        report.notice_many(at, "normals that were not of unit length were rescaled", self.rescaled_normals);
        report.notice_many(at, "normals of length 0 were replaced by those of their triangles", self.zero_normals);
        report.notice_many(at, "tangents of length 0 or along the normal were replaced", self.lost_tangents);
        report.notice_many(at, "triangles have no area", self.degenerate);
        let crowded = "thousands of triangles meet at one point; tangents do not follow the texture coordinates";
        report.notice_many(at, crowded, usize::from(self.crowded));
    }
}

/// Lengths within this of 1 are rounding (a normal of three signed bytes is off by up to 0.007).
const UNIT_TOLERANCE: f32 = 0.01;

/// Gives a mesh unit normals and tangents. `positions`, `uvs` and `indices` are finite and in range.
///
/// Flat normals, and smooth ones at creases, take shared vertices apart. With normals of the file its tangents are
/// kept; those are meaningless under new normals and are made anew, along texture coordinate set `tangent_uv` by
/// MikkTSpace, or around the y axis where there are no coordinates.
pub(super) fn complete(mesh: &mut Mesh, policy: Normals, tangent_uv: usize) -> Repairs {
    let mut repairs = Repairs { degenerate: normals::degenerate(mesh), ..Repairs::default() };
    if mesh.normals.is_empty() {
        mesh.tangents.clear();
        match policy {
            Normals::Flat => normals::flat(mesh),
            Normals::Smooth { crease_angle } => normals::smooth(mesh, crease_angle),
        }
    } else {
        normals::repair(mesh, &mut repairs);
    }
    let crowded = mesh.tangents.is_empty() && !mesh.uvs[tangent_uv].is_empty() && tangents::crowded(mesh);
    if !mesh.tangents.is_empty() {
        repairs.lost_tangents = tangents::repair(mesh);
    } else if mesh.uvs[tangent_uv].is_empty() || crowded {
        repairs.crowded = crowded;
        mesh.tangents = mesh.normals.iter().map(|n| tangents::around_y(*n)).collect();
    } else {
        tangents::mikktspace(mesh, tangent_uv);
    }
    repairs
}

/// Replaces the vertices of a mesh: vertex `i` of the new one is vertex `sources[i]` of the old. Indices are the
/// caller's.
fn gather(mesh: &mut Mesh, sources: &[u32]) {
    fn pick<T: Copy>(list: &mut Vec<T>, sources: &[u32]) {
        if !list.is_empty() {
            *list = sources.iter().map(|i| list[*i as usize]).collect();
        }
    }
    let Mesh { name: _, positions, normals, tangents, uvs, colors, indices: _ } = mesh;
    pick::<Vec3>(positions, sources);
    pick::<Vec3>(normals, sources);
    pick::<Vec4>(tangents, sources);
    uvs.iter_mut().for_each(|uv| pick(uv, sources));
    pick::<Vec4>(colors, sources);
}
