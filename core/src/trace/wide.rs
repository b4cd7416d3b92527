//! A tree whose nodes have four children, made from a binary one.
//!
//! Ylitie, Karras and Laine 2017, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, section 3.1:
//! the cheapest way to write each binary subtree as at most one, two or three wide ones follows from those of its
//! children, measured by the surface area heuristic.

use glam::{Vec3A, Vec4};

use super::triangle::NONE;

/// Children of a node, and primitives of a leaf at most.
pub(super) const WIDTH: usize = 4;

/// Set in the reference of a child that is a leaf.
pub(super) const LEAF: u32 = 1 << 31;

/// Time to test a leaf of up to four primitives, in tests of a node.
const LEAF_COST: f32 = 1.2;

/// A node of a binary tree. The root is the first; children lie side by side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Binary {
    pub min: Vec3A,
    pub max: Vec3A,
    /// The first child, or the primitive of a leaf.
    pub first: u32,
    pub is_leaf: bool,
}

/// Four boxes and what is in them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Axis, least and greatest, child. Empty children have boxes that no ray meets.
    pub planes: [[Vec4; 2]; 3],
    /// Place of a node, or of a leaf when [`LEAF`] is set.
    pub children: [u32; WIDTH],
}

impl Node {
    const EMPTY: Node = Node { planes: [[Vec4::INFINITY, Vec4::NEG_INFINITY]; 3], children: [NONE; WIDTH] };

    fn set(&mut self, lane: usize, binary: &Binary, child: u32) {
        self.children[lane] = child;
        for axis in 0..3 {
            self.planes[axis][0][lane] = binary.min[axis];
            self.planes[axis][1][lane] = binary.max[axis];
        }
    }
}

/// The tree and the primitives of its leaves, [`NONE`] in places that are left over.
#[derive(Debug, Default)]
pub(super) struct Wide {
    pub nodes: Vec<Node>,
    pub leaves: Vec<[u32; WIDTH]>,
}

/// What is known of a binary subtree: the cost of writing it as at most one, two or three wide subtrees.
#[derive(Clone, Copy, Debug, Default)]
struct Cost {
    of: [f32; WIDTH - 1],
    /// How many of 1, 2, 3 and 4 wide subtrees the first child gets; 0 at 2 and 3 means that fewer do.
    first_gets: [u8; WIDTH],
    /// Primitives; counts up to one more than fit into a leaf.
    primitives: u8,
    /// As a single wide subtree it is a leaf.
    is_leaf: bool,
}

impl Wide {
    /// `leaf_size` primitives at most go into a leaf.
    pub fn new(binary: &[Binary], leaf_size: usize) -> Wide {
        let mut wide = Wide::default();
        let Some(root) = binary.first() else {
            return wide;
        };
        let costs = costs(binary, leaf_size.clamp(1, WIDTH) as u8);
        wide.nodes.push(Node::EMPTY);
        if costs[0].is_leaf {
            let leaf = wide.leaf(binary, 0);
            wide.nodes[0].set(0, root, leaf);
            return wide;
        }
        let mut open = vec![(0_u32, 0_usize)];
        while let Some((subtree, place)) = open.pop() {
            let mut node = Node::EMPTY;
            let (children, count) = children(binary, &costs, subtree);
            for (lane, child) in children.iter().take(count).enumerate() {
                let reference = if costs[*child as usize].is_leaf {
                    wide.leaf(binary, *child)
                } else {
                    wide.nodes.push(Node::EMPTY);
                    open.push((*child, wide.nodes.len() - 1));
                    wide.nodes.len() as u32 - 1
                };
                node.set(lane, &binary[*child as usize], reference);
            }
            wide.nodes[place] = node;
        }
        wide
    }

    /// Writes the primitives of a subtree as a leaf and returns the reference to it.
    fn leaf(&mut self, binary: &[Binary], subtree: u32) -> u32 {
        let mut leaf = [NONE; WIDTH];
        let mut places = leaf.iter_mut();
        let mut open = [subtree; WIDTH + 1];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let node = &binary[open[count] as usize];
            if !node.is_leaf {
                open[count] = node.first + 1;
                open[count + 1] = node.first;
                count += 2;
            } else if let Some(place) = places.next() {
                *place = node.first;
            }
        }
        self.leaves.push(leaf);
        LEAF | (self.leaves.len() as u32 - 1)
    }
}

/// Costs of all subtrees, from the leaves to the root.
fn costs(binary: &[Binary], leaf_size: u8) -> Vec<Cost> {
    let mut order = Vec::with_capacity(binary.len());
    order.push(0_u32);
    let mut done = 0;
    while let Some(node) = order.get(done).map(|i| &binary[*i as usize]) {
        if !node.is_leaf {
            order.extend([node.first, node.first + 1]);
        }
        done += 1;
    }
    let mut costs = vec![Cost::default(); binary.len()];
    for index in order.into_iter().rev() {
        let node = &binary[index as usize];
        let size = node.max - node.min;
        let area = size.x * size.y + size.y * size.z + size.z * size.x;
        costs[index as usize] = if node.is_leaf {
            Cost { of: [area * LEAF_COST; 3], primitives: 1, is_leaf: true, ..Cost::default() }
        } else {
            joined(area, &costs[node.first as usize], &costs[node.first as usize + 1], leaf_size)
        };
    }
    costs
}

fn joined(area: f32, first: &Cost, second: &Cost, leaf_size: u8) -> Cost {
    // Two, three and four subtrees, shared out between the children.
    let [two, three, four] = [2, 3, 4].map(|total: usize| {
        let shared = (1..total).map(|gets| (first.of[gets - 1] + second.of[total - gets - 1], gets as u8));
        shared.fold((f32::INFINITY, 1), |best, this| if this.0 < best.0 { this } else { best })
    });
    let primitives = (first.primitives + second.primitives).min(leaf_size + 1);
    let as_leaf = if primitives <= leaf_size { area * LEAF_COST } else { f32::INFINITY };
    let as_node = area + four.0;
    let mut cost = Cost {
        of: [as_leaf.min(as_node), two.0, three.0],
        first_gets: [0, two.1, three.1, four.1],
        primitives,
        is_leaf: as_leaf <= as_node,
    };
    for more in 1..WIDTH - 1 {
        if cost.of[more - 1] <= cost.of[more] {
            cost.of[more] = cost.of[more - 1];
            cost.first_gets[more] = 0;
        }
    }
    cost
}

/// The binary subtrees that become the children of a wide node, and how many they are.
fn children(binary: &[Binary], costs: &[Cost], subtree: u32) -> ([u32; WIDTH], usize) {
    let mut found = [NONE; WIDTH];
    let mut count = 0;
    let root = &binary[subtree as usize];
    let gets = costs[subtree as usize].first_gets[WIDTH - 1] as usize;
    let mut open = [(root.first + 1, WIDTH - gets), (root.first, gets), (0, 0), (0, 0), (0, 0)];
    let mut left = 2;
    while left > 0 {
        left -= 1;
        let (index, mut share) = open[left];
        let (node, cost) = (&binary[index as usize], &costs[index as usize]);
        while share > 1 && cost.first_gets[share - 1] == 0 {
            share -= 1;
        }
        if share == 1 || node.is_leaf {
            found[count] = index;
            count += 1;
        } else {
            let gets = cost.first_gets[share - 1] as usize;
            open[left] = (node.first + 1, share - gets);
            open[left + 1] = (node.first, gets);
            left += 2;
        }
    }
    (found, count)
}
