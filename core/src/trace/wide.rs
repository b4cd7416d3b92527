//! A tree whose nodes have eight children, made from a binary one.
//!
//! Ylitie, Karras and Laine 2017, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, section 3.1:
//! the cheapest way to write a binary subtree as one wide subtree or as up to seven follows from those of its
//! children, measured by the surface area heuristic.

use glam::{Vec3, Vec4};
use rayon::prelude::*;

use super::triangle::{BLOCK, NONE};

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// Vectors that hold a number for each child.
pub(super) const HALVES: usize = 2;

/// Set in the reference of a child that is a leaf.
pub(super) const LEAF: u32 = 1 << 31;

/// Time to test a leaf of up to four primitives, in tests of a node.
const LEAF_COST: f32 = 1.0;

/// Lists of fewer binary nodes than this are not shared out between threads.
const PARALLEL: usize = 1 << 14;

/// How deep lists are shared out.
const SPLITS: u32 = 12;

/// Subtrees that threads write.
const TASKS: usize = 64;

/// A node of a binary tree that is written from the root down, each subtree in one piece: the first child follows its
/// parent.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Binary {
    pub min: Vec3,
    pub max: Vec3,
    /// Distance in the list to the second child, or the primitive of a leaf.
    pub link: u32,
    pub is_leaf: bool,
}

impl Binary {
    fn area(&self) -> f32 {
        let size = self.max - self.min;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// Eight boxes and what is in them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Axis, least and greatest, half, child. Empty children have boxes that no ray meets.
    pub planes: [[[Vec4; HALVES]; 2]; 3],
    /// Place of a node, or of a leaf when [`LEAF`] is set; [`NONE`] where there is no child.
    pub children: [u32; WIDTH],
}

impl Node {
    const EMPTY: Node =
        Node { planes: [[[Vec4::INFINITY; HALVES], [Vec4::NEG_INFINITY; HALVES]]; 3], children: [NONE; WIDTH] };

    fn set(&mut self, lane: usize, binary: &Binary, child: u32) {
        self.children[lane] = child;
        for axis in 0..3 {
            self.planes[axis][0][lane / 4][lane % 4] = binary.min[axis];
            self.planes[axis][1][lane / 4][lane % 4] = binary.max[axis];
        }
    }
}

/// The tree and the primitives of its leaves, [`NONE`] in places that are left over.
#[derive(Debug, Default)]
pub(super) struct Wide {
    pub nodes: Vec<Node>,
    pub leaves: Vec<[u32; BLOCK]>,
}

/// What is known of a binary subtree.
#[derive(Clone, Copy, Debug, Default)]
struct Cost {
    /// The cost of writing it as at most 1, 2 .. 7 wide subtrees.
    of: [f32; WIDTH - 1],
    /// How many of at most 1, 2 .. 8 wide subtrees its first child gets; 0 where fewer are no worse.
    first_gets: [u8; WIDTH],
    /// Primitives; counts up to one more than fit into a leaf.
    primitives: u8,
    /// As a single wide subtree it is a leaf.
    is_leaf: bool,
}

/// A binary subtree that is to be written, by its place in the list, and the place of its node.
type Open = (usize, usize);

impl Wide {
    /// `leaf_size` primitives at most go into a leaf.
    pub fn new(binary: &[Binary], leaf_size: usize) -> Wide {
        let Some(root) = binary.first() else {
            return Wide::default();
        };
        let mut costs = vec![Cost::default(); binary.len()];
        find_costs(binary, &mut costs, leaf_size.clamp(1, BLOCK) as u8, SPLITS);
        let mut wide = Wide { nodes: vec![Node::EMPTY], leaves: Vec::new() };
        if costs[0].is_leaf {
            let leaf = wide.leaf(binary);
            wide.nodes[0].set(0, root, leaf);
            return wide;
        }
        // From the root until there is enough to share out.
        let mut open: Vec<Open> = vec![(0, 0)];
        let mut done = 0;
        while done < open.len() && open.len() - done < TASKS {
            wide.write(binary, &costs, open[done], &mut open);
            done += 1;
        }
        let open = &open[done..];
        let parts: Vec<Wide> = open.par_iter().map(|(subtree, _)| Wide::subtree(binary, &costs, *subtree)).collect();
        for ((_, place), part) in open.iter().zip(parts) {
            wide.append(part, *place);
        }
        wide
    }

    fn subtree(binary: &[Binary], costs: &[Cost], subtree: usize) -> Wide {
        let mut wide = Wide { nodes: vec![Node::EMPTY], leaves: Vec::new() };
        let mut open = vec![(subtree, 0)];
        while let Some(next) = open.pop() {
            wide.write(binary, costs, next, &mut open);
        }
        wide
    }

    /// Writes the node of a subtree and makes places for its children.
    fn write(&mut self, binary: &[Binary], costs: &[Cost], (subtree, place): Open, open: &mut Vec<Open>) {
        let mut node = Node::EMPTY;
        let (children, count) = children(binary, costs, subtree);
        for (lane, child) in children.into_iter().take(count).enumerate() {
            let reference = if costs[child].is_leaf {
                self.leaf(&binary[child..])
            } else {
                self.nodes.push(Node::EMPTY);
                open.push((child, self.nodes.len() - 1));
                self.nodes.len() as u32 - 1
            };
            node.set(lane, &binary[child], reference);
        }
        self.nodes[place] = node;
    }

    /// Writes the primitives of the subtree at the start of a list as a leaf and returns the reference to it.
    fn leaf(&mut self, binary: &[Binary]) -> u32 {
        let mut leaf = [NONE; BLOCK];
        let mut places = leaf.iter_mut();
        let mut open = 1;
        for node in binary {
            if !node.is_leaf {
                open += 1;
                continue;
            }
            if let Some(place) = places.next() {
                *place = node.link;
            }
            open -= 1;
            if open == 0 {
                break;
            }
        }
        self.leaves.push(leaf);
        LEAF | (self.leaves.len() as u32 - 1)
    }

    /// Adds a tree of its own; its root goes to a place that was made for it.
    fn append(&mut self, part: Wide, place: usize) {
        let (nodes, leaves) = (self.nodes.len() as u32, self.leaves.len() as u32);
        let moved = part.nodes.into_iter().map(|mut node| {
            for child in node.children.iter_mut().filter(|child| **child != NONE) {
                // The root is not among the others: the second node becomes the first of them.
                *child = if *child & LEAF != 0 { *child + leaves } else { *child + nodes - 1 };
            }
            node
        });
        let mut moved = moved.fuse();
        if let Some(root) = moved.next() {
            self.nodes[place] = root;
        }
        self.nodes.extend(moved);
        self.leaves.extend(part.leaves);
    }
}

/// Costs of all subtrees of a list that is one subtree; it is shared out between threads so many times.
fn find_costs(binary: &[Binary], costs: &mut [Cost], leaf_size: u8, splits: u32) {
    let link = binary[0].link as usize;
    if splits == 0 || binary[0].is_leaf || binary.len() < PARALLEL {
        for i in (0..binary.len()).rev() {
            costs[i] = match &binary[i] {
                leaf if leaf.is_leaf => Cost::single(leaf),
                inner => Cost::joined(inner, &costs[i + 1], &costs[i + inner.link as usize], leaf_size),
            };
        }
        return;
    }
    let (firsts, seconds) = costs.split_at_mut(link);
    rayon::join(
        || find_costs(&binary[1..link], &mut firsts[1..], leaf_size, splits - 1),
        || find_costs(&binary[link..], seconds, leaf_size, splits - 1),
    );
    costs[0] = Cost::joined(&binary[0], &costs[1], &costs[link], leaf_size);
}

impl Cost {
    fn single(leaf: &Binary) -> Cost {
        Cost { of: [leaf.area() * LEAF_COST; WIDTH - 1], primitives: 1, is_leaf: true, ..Cost::default() }
    }

    fn joined(node: &Binary, first: &Cost, second: &Cost, leaf_size: u8) -> Cost {
        let primitives = (first.primitives + second.primitives).min(leaf_size + 1);
        let mut cost = Cost { primitives, ..Cost::default() };
        // The cheapest way to share out two subtrees or more between the children.
        let mut shared = [f32::INFINITY; WIDTH + 1];
        for (total, shared) in shared.iter_mut().enumerate().skip(2) {
            for gets in 1..total {
                let sum = first.of[gets - 1] + second.of[total - gets - 1];
                if sum < *shared {
                    *shared = sum;
                    cost.first_gets[total - 1] = gets as u8;
                }
            }
        }
        let area = node.area();
        let as_leaf = if primitives <= leaf_size { area * LEAF_COST } else { f32::INFINITY };
        let as_node = area + shared[WIDTH];
        cost.is_leaf = as_leaf <= as_node;
        cost.of[0] = as_leaf.min(as_node);
        for more in 1..WIDTH - 1 {
            cost.of[more] = shared[more + 1];
            if cost.of[more - 1] <= cost.of[more] {
                cost.of[more] = cost.of[more - 1];
                cost.first_gets[more] = 0;
            }
        }
        cost
    }
}

/// The binary subtrees that become the children of a wide node, and how many they are.
fn children(binary: &[Binary], costs: &[Cost], subtree: usize) -> ([usize; WIDTH], usize) {
    let mut found = [0; WIDTH];
    let mut count = 0;
    // Subtrees with the number of children that they become.
    let mut open = [(0, 0); WIDTH];
    open[0] = (subtree, WIDTH);
    let mut left = 1;
    while left > 0 {
        left -= 1;
        let (index, mut share) = open[left];
        let gets = &costs[index].first_gets;
        while share > 1 && gets[share - 1] == 0 {
            share -= 1;
        }
        if share == 1 {
            found[count] = index;
            count += 1;
        } else {
            let first = usize::from(gets[share - 1]);
            open[left] = (index + binary[index].link as usize, share - first);
            open[left + 1] = (index + 1, first);
            left += 2;
        }
    }
    (found, count)
}
