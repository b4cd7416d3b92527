//! The triangles of a scene, ready for rays: a tree per mesh and one over the instances.
//!
//! The only place that knows obvhs, which makes the binary trees (parallel locally-ordered clustering, Meister and
//! Bittner 2018, improved by reinsertion, Meister and Bittner 2018).

use std::collections::HashMap;
use std::sync::Arc;

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use super::mesh_tree::MeshTree;
use super::placed::Placed;
use super::walk::{Slabs, walk};
use super::wide::{Binary, Node, Wide};
use super::{Hit, Ray};
use crate::scene::{Bounds, Mesh, Scene};

/// The visible instances of a scene. Copies share everything.
#[derive(Clone, Debug)]
pub struct Accel {
    pub(super) shared: Arc<Shared>,
}

impl Default for Accel {
    /// Nothing to hit.
    fn default() -> Accel {
        let (trees, placed, nodes) = Default::default();
        Accel { shared: Arc::new(Shared { trees, placed, bounds: Bounds::EMPTY, nodes, slack: 0.0 }) }
    }
}

#[derive(Debug)]
pub(super) struct Shared {
    /// Trees of the meshes of the scene that were visible once. The meshes are kept, so that a pointer stays theirs.
    pub trees: Vec<(Arc<Mesh>, Arc<MeshTree>)>,
    pub placed: Vec<Placed>,
    pub bounds: Bounds,
    /// Over the instances; a leaf is a place in `placed`.
    pub nodes: Vec<Node>,
    /// Share of a distance by which its boxes are grown.
    pub slack: f32,
}

impl Accel {
    /// All visible instances.
    pub fn new(scene: &Scene) -> Accel {
        Accel::default().updated(scene)
    }

    /// The same for another scene. Trees of meshes that both share are used again: moved instances and other materials
    /// take no longer than a tree over the instances.
    pub fn updated(&self, scene: &Scene) -> Accel {
        let known: HashMap<usize, &Arc<MeshTree>> =
            self.shared.trees.iter().map(|(mesh, tree)| (Arc::as_ptr(mesh).addr(), tree)).collect();
        let mut visible = vec![false; scene.meshes.len()];
        for instance in scene.instances.iter().filter(|i| i.visible) {
            if let Some(visible) = visible.get_mut(instance.mesh) {
                *visible = true;
            }
        }
        let of_mesh: Vec<Option<Arc<MeshTree>>> = (scene.meshes.par_iter().zip(visible))
            .map(|(mesh, visible)| match known.get(&Arc::as_ptr(mesh).addr()) {
                Some(tree) => Some(Arc::clone(tree)),
                None => visible.then(|| Arc::new(MeshTree::new(mesh, binary))),
            })
            .collect();
        let placed = Placed::all(scene, &of_mesh);
        let pairs = scene.meshes.iter().zip(of_mesh);
        let trees = pairs.filter_map(|(mesh, tree)| Some((Arc::clone(mesh), tree?))).collect();

        let boxes: Vec<Bounds> = placed.iter().map(|p| p.bounds).collect();
        let bounds = boxes.iter().fold(Bounds::EMPTY, |all, b| all.including(b.min).including(b.max));
        let slack = placed.iter().map(|p| p.slack).fold(0.0, f32::max);
        let Wide { nodes, leaves } = Wide::new(&binary(&boxes), 1);
        // In the order of the leaves, so that a leaf is its instance.
        let placed = leaves.iter().filter_map(|[first, ..]| placed.get(*first as usize).cloned()).collect();
        Accel { shared: Arc::new(Shared { trees, placed, bounds, nodes, slack }) }
    }

    /// The nearest hit that `accept` takes; of several at the same distance that of the first instance and triangle.
    /// `accept` is asked in no particular order, and twice about none.
    pub fn closest(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        self.walk(ray, |hit, limit| {
            let nearer = match &best {
                None => hit.t < ray.t_max,
                Some(best) => {
                    let rank = |hit: &Hit| (hit.instance, hit.triangle);
                    hit.t < best.t || (hit.t == best.t && rank(&hit) < rank(best))
                }
            };
            if nearer && accept(&hit) {
                *limit = hit.t;
                best = Some(hit);
            }
            false
        });
        best
    }

    /// True when some hit is accepted.
    pub fn occluded(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> bool {
        self.walk(ray, |hit, _| hit.t < ray.t_max && accept(&hit))
    }

    /// The nearest hit of each ray, on the caller's threads.
    pub fn closest_of_each(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        rays.par_iter().map(|ray| self.closest(ray, |_| true)).collect()
    }

    /// For each ray whether there is a hit, on the caller's threads.
    pub fn occluded_of_each(&self, rays: &[Ray]) -> Vec<bool> {
        rays.par_iter().map(|ray| self.occluded(ray, |_| true)).collect()
    }

    /// Memory of the trees.
    pub fn bytes(&self) -> usize {
        let Shared { trees, placed, nodes, .. } = &*self.shared;
        let meshes: usize = trees.iter().map(|(_, tree)| tree.bytes()).sum();
        meshes + size_of_val(placed.as_slice()) + size_of_val(nodes.as_slice())
    }

    /// Calls `meet` for the triangles on the way of a ray until it returns true.
    #[inline(always)]
    fn walk(&self, ray: &Ray, mut meet: impl FnMut(Hit, &mut f32) -> bool) -> bool {
        let Shared { placed, bounds, nodes, slack, .. } = &*self.shared;
        let mut limit = ray.t_max;
        if let [only] = placed.as_slice() {
            return only.walk(ray, &mut limit, meet);
        }
        if placed.is_empty() {
            return false;
        }
        let slabs = Slabs::new(ray, bounds, *slack);
        walk(nodes, &slabs, &mut limit, |leaf, limit| match placed.get(leaf as usize) {
            Some(placed) => placed.walk(ray, limit, &mut meet),
            None => false,
        })
    }
}

/// A binary tree over boxes.
fn binary(boxes: &[Bounds]) -> Vec<Binary> {
    // A power of two: what is scaled back is exact, and areas neither overflow nor vanish.
    let greatest = boxes.iter().map(|b| b.min.abs().max(b.max.abs()).max_element()).fold(0.0, f32::max);
    let scale = f32::from_bits(254_u32.saturating_sub(greatest.to_bits() >> 23).clamp(2, 252) << 23);
    let scaled = |Bounds { min, max }: &Bounds| Aabb::new((*min * scale).into(), (*max * scale).into());
    let boxes: Vec<Aabb> = boxes.par_iter().map(scaled).collect();
    let indices = (0..boxes.len() as u32).collect();
    let mut tree = PlocBuilder::new().build(PlocSearchDistance::Low, &boxes, indices, SortPrecision::U64, 2);
    ReinsertionOptimizer::default().run(&mut tree, 0.02, None);
    from_the_root(&tree, 1.0 / scale)
}

/// The nodes of a tree, each subtree in one piece.
fn from_the_root(tree: &Bvh2, scale: f32) -> Vec<Binary> {
    let mut list: Vec<Binary> = Vec::with_capacity(tree.nodes.len());
    // Nodes of the tree, with the place of the parent whose second child they are.
    let mut open: Vec<(u32, Option<usize>)> = tree.nodes.first().map(|_| (0, None)).into_iter().collect();
    while let Some((index, parent)) = open.pop() {
        let node = &tree.nodes[index as usize];
        let place = list.len();
        if let Some(parent) = parent {
            list[parent].link = (place - parent) as u32;
        }
        let link = if node.is_leaf() { tree.primitive_indices[node.first_index as usize] } else { 0 };
        let Aabb { min, max } = node.aabb;
        list.push(Binary { min: (min * scale).into(), max: (max * scale).into(), link, is_leaf: node.is_leaf() });
        if !node.is_leaf() {
            open.push((node.first_index + 1, Some(place)));
            open.push((node.first_index, None));
        }
    }
    list
}
