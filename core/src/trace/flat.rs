//! The trees as plain arrays, for a traversal on the graphics device.

use std::collections::HashMap;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3, Mat3, Vec4};

use super::accel::Accel;
use super::mesh_tree::MeshTree;
use super::placed::{Inverse, Placed};
use super::triangle::{BLOCK, Block, NONE};
use super::walk::SLACK;
use super::wide::{HALVES, LEAF, Node};
use crate::scene::Bounds;

/// Bits of a reference to a leaf below its count.
const COUNT_SHIFT: u32 = 29;

/// All trees of an [`Accel`] in three lists that refer to each other by place. Words of 32 bits, vectors padded to four,
/// no pointers: what a storage buffer holds.
///
/// Node 0 is the root of the tree over instances; [`FlatInstance::root`] is that of a mesh. Nothing is hit without
/// instances. A child of a node is
/// - none: [`FlatNode::NONE`];
/// - a node: its place, below [`FlatNode::LEAF`];
/// - a leaf: [`FlatNode::LEAF`] is set, the next two bits hold one less than the number of its primitives, the others the
///   place of the first, an instance in the tree over instances or a triangle in that of a mesh.
///
/// A leaf of the upper tree is traversed with the ray brought to the instance: its origin less
/// [`FlatInstance::translation`], then origin and direction times [`FlatInstance::local_from_world`] and what is left of it.
/// The direction is not made a unit vector, so distances stay those of the world. [`Accel`] computes this in double
/// precision; who uses less may find another triangle where two are near.
///
/// Boxes hold their triangles exactly. A traversal that rounds must grow them: by [`Flat::slack`] in the upper tree and
/// [`FlatInstance::slack`] in that of a mesh, times the distance of the ray's origin from the farthest corner of
/// [`Flat::bounds`] or [`FlatInstance::bounds`].
#[derive(Clone, Debug, PartialEq)]
pub struct Flat {
    /// Of both kinds of tree.
    pub nodes: Vec<FlatNode>,
    /// Visible instances.
    pub instances: Vec<FlatInstance>,
    /// Those of each mesh once.
    pub triangles: Vec<FlatTriangle>,
    /// Box around all instances, in the world.
    pub bounds: Bounds,
    /// Share of a distance by which the boxes of instances are to be grown.
    pub slack: f32,
}

/// Eight boxes and what is in them: 224 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FlatNode {
    /// Least x of the eight children, then greatest x, least y and so on. Least is above greatest where there is none.
    pub planes: [[[f32; 8]; 2]; 3],
    /// References, see [`Flat`].
    pub children: [u32; 8],
}

impl FlatNode {
    /// In place of a child.
    pub const NONE: u32 = NONE;
    /// Set in the reference to a leaf.
    pub const LEAF: u32 = LEAF;

    /// Primitives of a leaf, by place.
    pub fn primitives(leaf: u32) -> std::ops::Range<usize> {
        let first = leaf & !(u32::MAX << COUNT_SHIFT);
        let count = (leaf & !LEAF) >> COUNT_SHIFT;
        first as usize..(first + count) as usize + 1
    }
}

/// A mesh in the world: 144 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FlatInstance {
    /// Columns of the matrix that turns a world position less [`Self::translation`] into a local one; w is 0.
    pub local_from_world: [[f32; 4]; 3],
    /// World position of the local origin.
    pub translation: [f32; 3],
    /// Place of the node that is the root of the mesh.
    pub root: u32,
    /// Box around the mesh, local: its least corner.
    pub min: [f32; 3],
    /// Index into `Scene::instances`.
    pub instance: u32,
    /// Greatest corner of the box.
    pub max: [f32; 3],
    /// Share of a distance by which the boxes of the mesh are to be grown.
    pub slack: f32,
    /// What single precision leaves of [`Self::local_from_world`].
    pub local_from_world_left: [[f32; 4]; 3],
}

impl FlatInstance {
    /// Box around the mesh, local.
    pub fn bounds(&self) -> Bounds {
        Bounds { min: self.min.into(), max: self.max.into() }
    }
}

/// Corners in local space: 48 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FlatTriangle {
    /// First corner.
    pub a: [f32; 3],
    /// Place of the triangle in its mesh, as in [`super::Hit::triangle`].
    pub triangle: u32,
    /// Second corner, and 0.
    pub b: [f32; 4],
    /// Third corner, and 0.
    pub c: [f32; 4],
}

impl Accel {
    /// The trees as plain arrays.
    pub fn flatten(&self) -> Flat {
        let (bounds, slack) = (self.shared.bounds, self.shared.slack);
        let mut flat = Flat { nodes: Vec::new(), instances: Vec::new(), triangles: Vec::new(), bounds, slack };
        flat.add_nodes(&self.shared.nodes, |leaf| LEAF | leaf);
        let mut roots = HashMap::new();
        for placed in &self.shared.placed {
            let root = *roots.entry(Arc::as_ptr(&placed.tree).addr()).or_insert_with(|| flat.add_tree(&placed.tree));
            flat.instances.push(FlatInstance::new(placed, root));
        }
        flat
    }
}

impl Flat {
    /// Returns the place of the root.
    fn add_tree(&mut self, tree: &MeshTree) -> u32 {
        let reference = |block: &Block| {
            let first = self.triangles.len() as u32;
            self.triangles.extend((0..BLOCK).filter_map(|lane| FlatTriangle::new(block, lane)));
            let more = self.triangles.len() as u32 - first - 1;
            LEAF | more << COUNT_SHIFT | first
        };
        let leaves: Vec<u32> = tree.blocks.iter().map(reference).collect();
        let root = self.nodes.len() as u32;
        self.add_nodes(&tree.nodes, |leaf| leaves[leaf as usize]);
        root
    }

    fn add_nodes(&mut self, nodes: &[Node], leaf: impl Fn(u32) -> u32) {
        let first = self.nodes.len() as u32;
        let moved = |child: u32| match child {
            NONE => NONE,
            child if child & LEAF != 0 => leaf(child & !LEAF),
            child => child + first,
        };
        self.nodes.extend(nodes.iter().map(|node| FlatNode {
            planes: bytemuck::cast::<[[[Vec4; HALVES]; 2]; 3], _>(node.planes),
            children: node.children.map(moved),
        }));
    }
}

impl FlatInstance {
    fn new(placed: &Placed, root: u32) -> FlatInstance {
        let (linear, translation) = match placed.inverse {
            Inverse::Identity => (DMat3::IDENTITY, DVec3::ZERO),
            Inverse::Affine { translation, linear } => (linear, translation),
        };
        let bounds = &placed.tree.bounds;
        let columns = |matrix: Mat3| matrix.to_cols_array_2d().map(|[x, y, z]| [x, y, z, 0.0]);
        let single = linear.as_mat3();
        FlatInstance {
            local_from_world: columns(single),
            translation: translation.as_vec3().into(),
            root,
            min: bounds.min.into(),
            instance: placed.index,
            max: bounds.max.into(),
            slack: SLACK,
            local_from_world_left: columns((linear - single.as_dmat3()).as_mat3()),
        }
    }
}

impl FlatTriangle {
    fn new(block: &Block, lane: usize) -> Option<FlatTriangle> {
        let triangle = Some(block.triangles[lane]).filter(|triangle| *triangle != NONE)?;
        let [a, b, c] = block.corners.map(|axes| axes.map(|values| values[lane]));
        let padded = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        Some(FlatTriangle { a, triangle, b: padded(b), c: padded(c) })
    }
}
