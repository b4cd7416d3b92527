//! The plain reference of the trees.

use rayon::prelude::*;

use super::mesh_tree::{corners, triangles};
use super::placed::Placed;
use super::triangle::{BLOCK, Block, Sheared};
use super::{Hit, Ray};
use crate::scene::Scene;

/// The nearest hit of each ray, from a test of every triangle of every visible instance: no tree, the triangles in
/// the order of their mesh. What [`super::Accel::closest`] finds is held to this.
pub fn brute_force(scene: &Scene, rays: &[Ray]) -> Vec<Option<Hit>> {
    let mut nearest: Vec<Option<Hit>> = vec![None; rays.len()];
    for (index, instance) in scene.instances.iter().enumerate().filter(|(_, i)| i.visible) {
        let Some(mesh) = scene.meshes.get(instance.mesh) else {
            continue;
        };
        let solid: Vec<u32> = triangles(mesh).collect();
        let block = |places: &[u32]| Block::new(places.iter().map(|t| (*t, corners(mesh, *t))));
        let blocks: Vec<Block> = solid.chunks(BLOCK).map(block).collect();
        let Some(inverse) = Placed::inverse(&instance.world_from_local) else {
            continue;
        };
        rays.par_iter().zip(&mut nearest).for_each(|(ray, nearest)| {
            let sheared = Sheared::new(&inverse.local(ray));
            for block in &blocks {
                let mut limit = nearest.as_ref().map_or(ray.t_max, |hit| hit.t);
                sheared.hits(block, index as u32, &mut limit, |hit, limit| {
                    // The first of several at the same distance stays.
                    if hit.t < *limit {
                        *limit = hit.t;
                        *nearest = Some(hit);
                    }
                    false
                });
            }
        });
    }
    nearest
}
