//! The triangles of one mesh in a tree.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::triangle::{BLOCK, Block, Sheared};
use super::walk::{SLACK, Slabs, walk};
use super::wide::{Binary, Node, Wide};
use super::{Hit, Ray};
use crate::scene::{Bounds, Mesh};

/// A mesh as rays see it, in its local space.
#[derive(Debug)]
pub(super) struct MeshTree {
    pub bounds: Bounds,
    pub nodes: Vec<Node>,
    /// The leaves.
    pub blocks: Vec<Block>,
}

impl MeshTree {
    /// `binary` makes a binary tree over boxes.
    pub fn new(mesh: &Mesh, binary: impl FnOnce(&[Bounds]) -> Vec<Binary>) -> MeshTree {
        let triangles: Vec<u32> = triangles(mesh).collect();
        let boxes: Vec<Bounds> = triangles.par_iter().map(|triangle| around(corners(mesh, *triangle))).collect();
        let bounds = boxes.iter().fold(Bounds::EMPTY, |all, b| all.including(b.min).including(b.max));
        let Wide { nodes, leaves } = Wide::new(&binary(&boxes), BLOCK);
        let filled = |leaf: &[u32; BLOCK]| {
            let places = leaf.iter().filter_map(|i| triangles.get(*i as usize));
            Block::new(places.map(|triangle| (*triangle, corners(mesh, *triangle))))
        };
        let blocks = leaves.par_iter().map(filled).collect();
        MeshTree { bounds, nodes, blocks }
    }

    /// Calls `meet` for every triangle that the ray, given in local space, meets before `limit`; it may draw the limit
    /// nearer, and ends the search by returning true.
    #[inline(always)]
    pub fn walk(&self, ray: &Ray, instance: u32, limit: &mut f32, mut meet: impl FnMut(Hit, &mut f32) -> bool) -> bool {
        let slabs = Slabs::new(ray, &self.bounds, SLACK);
        let sheared = Sheared::new(ray);
        walk(&self.nodes, &slabs, limit, |leaf, limit| {
            let Some(block) = self.blocks.get(leaf as usize) else {
                return false;
            };
            sheared.hits(block, instance, limit, &mut meet)
        })
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice())
    }
}

impl Sheared {
    /// Calls `meet` for the triangles of a block that the ray meets before `limit`, until it returns true.
    #[inline(always)]
    pub(super) fn hits(
        &self,
        block: &Block,
        instance: u32,
        limit: &mut f32,
        mut meet: impl FnMut(Hit, &mut f32) -> bool,
    ) -> bool {
        let Some(met) = self.meet(block, *limit) else {
            return false;
        };
        for lane in (0..BLOCK).filter(|lane| met.mask & (1 << lane) != 0) {
            let (t, barycentric) = met.at(lane);
            let hit = Hit { t, instance, triangle: block.triangles[lane], barycentric };
            if meet(hit, limit) {
                return true;
            }
        }
        false
    }
}

/// Places of the triangles that have an area.
pub(super) fn triangles(mesh: &Mesh) -> impl Iterator<Item = u32> {
    (0..mesh.indices.len() as u32 / 3).filter(|triangle| {
        let [a, b, c] = corners(mesh, *triangle).map(Vec3::as_dvec3);
        let normal: DVec3 = (b - a).cross(c - a);
        normal.is_finite() && normal != DVec3::ZERO
    })
}

/// Corners of a triangle; NaN where an index is outside the mesh.
pub(super) fn corners(mesh: &Mesh, triangle: u32) -> [Vec3; 3] {
    [0, 1, 2].map(|corner| {
        let index = mesh.indices.get(3 * triangle as usize + corner);
        index.and_then(|i| mesh.positions.get(*i as usize)).copied().unwrap_or(Vec3::NAN)
    })
}

fn around(corners: [Vec3; 3]) -> Bounds {
    corners.into_iter().fold(Bounds::EMPTY, Bounds::including)
}
