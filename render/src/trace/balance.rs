//! Trees so deep that more nodes would have to wait than shaders have room for: what lies one within the other, or in one
//! place, becomes a list. Such trees are made anew, level by level, with all leaves as deep.

use burnish_core::scene::Bounds;
use burnish_core::trace::{Flat, FlatNode};
use glam::Vec3;

use super::STACK;

/// Children of a node.
const WIDTH: usize = 8;

/// Without children.
const EMPTY: FlatNode =
    FlatNode { planes: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3], children: [FlatNode::NONE; WIDTH] };

/// A child: its box and the reference to it.
type Child = (Bounds, u32);

/// Makes trees anew where more than [`STACK`] children could wait. Half of that suffices for all leaves that can be named.
pub(super) fn fit(flat: &mut Flat) {
    let roots = roots_of_meshes(flat);
    let of_meshes = roots.iter().map(|root| waiting(flat, *root)).max().unwrap_or(0);
    if waiting(flat, 0) + of_meshes <= STACK {
        return;
    }
    for root in std::iter::once(0).chain(roots) {
        if waiting(flat, root) > STACK / 2 {
            let mut leaves = leaves(flat, root);
            // The former nodes stay, unused, below a root in its old place: what refers to it stays right.
            write(&mut flat.nodes, root as usize, &mut leaves);
        }
    }
}

/// Each once.
fn roots_of_meshes(flat: &Flat) -> Vec<u32> {
    let mut roots: Vec<u32> = flat.instances.iter().map(|instance| instance.root).collect();
    roots.sort_unstable();
    roots.dedup();
    roots
}

fn children(node: &FlatNode) -> impl Iterator<Item = Child> {
    let present = |lane: &usize| node.children[*lane] != FlatNode::NONE;
    (0..WIDTH).filter(present).map(|lane| {
        let corner = |side: usize| Vec3::from_array([0, 1, 2].map(|axis| node.planes[axis][side][lane]));
        (Bounds { min: corner(0), max: corner(1) }, node.children[lane])
    })
}

/// The most children that ever wait on the way of a ray through a tree, were it to meet every box: all but one of each node
/// on the way down.
fn waiting(flat: &Flat, root: u32) -> usize {
    let mut most = 0;
    // Nodes, with how many wait when they are reached.
    let mut open = vec![(root, 0)];
    while let Some((place, before)) = open.pop() {
        let Some(node) = flat.nodes.get(place as usize) else {
            continue;
        };
        let waiting = before + children(node).count().saturating_sub(1);
        most = most.max(waiting);
        let nodes = children(node).filter(|(_, child)| child & FlatNode::LEAF == 0);
        open.extend(nodes.map(|(_, child)| (child, waiting)));
    }
    most
}

fn leaves(flat: &Flat, root: u32) -> Vec<Child> {
    let mut leaves = Vec::new();
    let mut open = vec![root];
    while let Some(node) = open.pop().and_then(|place| flat.nodes.get(place as usize)) {
        for child in children(node) {
            if child.1 & FlatNode::LEAF == 0 {
                open.push(child.1);
            } else {
                leaves.push(child);
            }
        }
    }
    leaves
}

/// Writes a tree over `leaves` whose root has a place already.
fn write(nodes: &mut Vec<FlatNode>, place: usize, leaves: &mut [Child]) {
    let mut full = 1;
    while full * WIDTH < leaves.len() {
        full *= WIDTH;
    }
    let mut parts = Vec::with_capacity(WIDTH);
    split(leaves, full, &mut parts);
    let mut node = EMPTY;
    for (lane, part) in parts.into_iter().enumerate() {
        let (bounds, mut reference) = part.iter().copied().reduce(joined).unwrap_or((Bounds::EMPTY, FlatNode::NONE));
        if part.len() > 1 {
            reference = nodes.len() as u32;
            nodes.push(EMPTY);
            write(nodes, reference as usize, part);
        }
        node.children[lane] = reference;
        for axis in 0..3 {
            node.planes[axis][0][lane] = bounds.min[axis];
            node.planes[axis][1][lane] = bounds.max[axis];
        }
    }
    nodes[place] = node;
}

fn joined((a, reference): Child, (b, _): Child) -> Child {
    (a.joined(b), reference)
}

/// Splits a list into parts of so many, the last one excepted, across the axis along which it is longest.
fn split<'a>(leaves: &'a mut [Child], full: usize, parts: &mut Vec<&'a mut [Child]>) {
    let count = leaves.len().div_ceil(full);
    if count <= 1 {
        parts.push(leaves);
        return;
    }
    let middle = |(bounds, _): &Child| 0.5 * bounds.min + 0.5 * bounds.max;
    let middles = leaves.iter().map(middle).fold(Bounds::EMPTY, Bounds::including);
    let axis = (middles.max - middles.min).max_position();
    let at = count / 2 * full;
    leaves.select_nth_unstable_by(at, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]));
    let (first, second) = leaves.split_at_mut(at);
    split(first, full, parts);
    split(second, full, parts);
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use burnish_core::scene::gallery::shape;
    use burnish_core::scene::{Instance, Mesh, Scene};
    use burnish_core::trace::Accel;
    use glam::Affine3A;

    use super::*;

    fn flat(mesh: Mesh, sizes: impl IntoIterator<Item = f32>) -> Flat {
        let instance = |size: f32| Instance {
            name: String::new(),
            mesh: 0,
            material: 0,
            world_from_local: Affine3A::from_scale(Vec3::splat(size)),
            visible: true,
        };
        let instances = sizes.into_iter().map(instance).collect();
        Accel::new(&Scene { meshes: vec![Arc::new(mesh)], instances, ..Scene::default() }).flatten()
    }

    /// Boxes one within the other, boxes in one place, triangles in one place; and a tree that fits.
    fn trees() -> [Flat; 4] {
        let block = || shape::block(Vec3::ONE, 0.0, 1);
        let mut stacked = block();
        stacked.indices = stacked.indices.repeat(500);
        [
            flat(block(), (0..1_500).map(|i| 1.005_f32.powi(i))),
            flat(block(), [1.0; 1_500]),
            flat(stacked, [1.0, 2.0]),
            flat(shape::sphere(1.0, 40), [1.0]),
        ]
    }

    fn most(flat: &Flat) -> usize {
        waiting(flat, 0) + roots_of_meshes(flat).iter().map(|root| waiting(flat, *root)).max().unwrap_or(0)
    }

    #[test]
    fn trees_that_are_lists_come_to_fit() {
        for (mut flat, fits) in trees().into_iter().zip([false, false, false, true]) {
            let before = flat.clone();
            assert_eq!(most(&flat) <= STACK, fits, "{} wait", most(&flat));
            fit(&mut flat);
            assert!(most(&flat) <= STACK, "{} wait", most(&flat));
            assert_eq!(flat == before, fits);
            for root in std::iter::once(0).chain(roots_of_meshes(&flat)) {
                let sorted = |flat: &Flat| {
                    let mut leaves: Vec<u32> = leaves(flat, root).into_iter().map(|(_, leaf)| leaf).collect();
                    leaves.sort_unstable();
                    leaves
                };
                assert!(sorted(&flat) == sorted(&before), "the same leaves are in it");
            }
        }
    }

    #[test]
    fn boxes_hold_what_is_below_them() {
        for mut flat in trees() {
            fit(&mut flat);
            for (place, node) in flat.nodes.iter().enumerate() {
                for (bounds, child) in children(node).filter(|(_, child)| child & FlatNode::LEAF == 0) {
                    let below = children(&flat.nodes[child as usize]).fold(Bounds::EMPTY, |all, (b, _)| all.joined(b));
                    assert!(bounds == below, "node {place}: {bounds:?} holds {below:?}");
                }
            }
        }
    }
}
