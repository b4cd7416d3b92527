//! The arrays of [`Flat`] as one list of vectors of four words.

use burnish_core::trace::{Flat, FlatInstance, FlatNode, FlatTriangle};

/// What a storage buffer holds: `vec4u`.
type Word4 = [u32; 4];

/// Vectors before the nodes; `TRACE_HEADER` of `trace.wgsl`.
const HEADER: usize = 3;

/// Bytes of [`of`], without making it.
pub(super) fn bytes(flat: &Flat) -> u64 {
    let Flat { nodes, instances, triangles, .. } = flat;
    let lists = [size_of_val(&nodes[..]), size_of_val(&instances[..]), size_of_val(&triangles[..])];
    (size_of::<[Word4; HEADER]>() + lists.iter().sum::<usize>()) as u64
}

/// Header, nodes, instances, triangles. The header holds the number of instances, where the first instance and the first
/// triangle are, a zero; least corner of the box around all and slack; greatest corner.
pub(super) fn of(flat: &Flat) -> Vec<Word4> {
    let Flat { nodes, instances, triangles, bounds, slack } = flat;
    let nodes: Vec<FlatNode> = nodes.iter().map(without_empty_boxes).collect();
    let first_instance = HEADER + vectors::<FlatNode>(&nodes).len();
    let first_triangle = first_instance + vectors::<FlatInstance>(instances).len();
    let bits = |[x, y, z]: [f32; 3], w: f32| [x, y, z, w].map(f32::to_bits);
    // An empty box has infinite corners, which nobody reads: there is nothing in it.
    let mut words = vec![
        [instances.len() as u32, first_instance as u32, first_triangle as u32, 0],
        bits(bounds.min.into(), *slack),
        bits(bounds.max.into(), 0.0),
    ];
    words.extend_from_slice(vectors::<FlatNode>(&nodes));
    words.extend_from_slice(vectors::<FlatInstance>(instances));
    words.extend_from_slice(vectors::<FlatTriangle>(triangles));
    words
}

fn vectors<T: bytemuck::NoUninit>(list: &[T]) -> &[Word4] {
    bytemuck::cast_slice(list)
}

/// Shaders may take it that there is no infinity: they tell a missing child by its reference.
fn without_empty_boxes(node: &FlatNode) -> FlatNode {
    let mut node = *node;
    for (lane, _) in node.children.iter().enumerate().filter(|(_, child)| **child == FlatNode::NONE) {
        node.planes.as_flattened_mut().iter_mut().for_each(|planes| planes[lane] = 0.0);
    }
    node
}
