//! The way of a ray through a wide tree.

use glam::Vec4;

use super::Ray;
use super::wide::{LEAF, Node, WIDTH};
use crate::scene::Bounds;

/// Share of the distance to the farthest box by which boxes are grown: more than what rounding moves a corner in the
/// test of a triangle (Woop, Benthin and Wald 2013, section 3.3; half a unit in the last place is 2^-24 of a number).
pub(super) const SLACK: f32 = 1.0 / (1 << 20) as f32;

/// Ize 2013, Robust BVH Ray Traversal: with this factor on the far distance, rounding loses no box.
const FAR: f32 = 1.0 + 1.0 / (1 << 21) as f32;

/// Stands in for the inverse of a zero, so that no product is NaN.
const GREATEST_INVERSE: f32 = 1e37;

/// References that are kept without asking for memory.
const DEPTH: usize = 48;

/// A ray made ready for the boxes of one tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs {
    /// Per axis: which of the two planes of a box the ray meets first.
    near: [usize; 3],
    near_origin: [Vec4; 3],
    far_origin: [Vec4; 3],
    inverse: [Vec4; 3],
    far_inverse: [Vec4; 3],
}

impl Slabs {
    /// For a tree within `bounds`, its boxes grown by `slack` times the distance to the farthest corner.
    #[inline(always)]
    pub fn new(ray: &Ray, bounds: &Bounds, slack: f32) -> Slabs {
        let reach = (bounds.min - ray.origin).abs().max((bounds.max - ray.origin).abs());
        // Twice: an axis is sheared by no more than the depth.
        let grown = 2.0 * slack * reach.max_element();
        let inverse = ray.direction.to_array().map(|d| {
            let inverse = 1.0 / d;
            if inverse.abs() < GREATEST_INVERSE { inverse } else { GREATEST_INVERSE.copysign(d) }
        });
        let less = ray.origin.to_array().map(|o| (o - grown).min(o.next_down()));
        let more = ray.origin.to_array().map(|o| (o + grown).max(o.next_up()));
        let near = ray.direction.to_array().map(|d| usize::from(d.is_sign_negative()));
        let of = |axis: usize, toward: usize| Vec4::splat(if near[axis] == toward { more[axis] } else { less[axis] });
        Slabs {
            near,
            near_origin: [of(0, 0), of(1, 0), of(2, 0)],
            far_origin: [of(0, 1), of(1, 1), of(2, 1)],
            inverse: inverse.map(Vec4::splat),
            far_inverse: inverse.map(|i| Vec4::splat(i * FAR)),
        }
    }

    /// Where the ray enters the boxes of a node, and one bit for each box that it meets with `0 <= t <= limit`.
    #[inline(always)]
    fn meet(&self, node: &Node, limit: f32) -> (Vec4, u32) {
        let near = |axis: usize| (node.planes[axis][self.near[axis] & 1] - self.near_origin[axis]) * self.inverse[axis];
        let far = |axis: usize| {
            (node.planes[axis][(self.near[axis] & 1) ^ 1] - self.far_origin[axis]) * self.far_inverse[axis]
        };
        let enter = near(0).max(near(1)).max(near(2).max(Vec4::ZERO));
        let leave = far(0).min(far(1)).min(far(2).min(Vec4::splat(limit)));
        (enter, enter.cmple(leave).bitmask())
    }
}

/// References to visit later, with where the ray enters them.
struct Stack {
    fixed: [(f32, u32); DEPTH],
    /// What does not fit; only degenerate trees are that deep.
    spilt: Vec<(f32, u32)>,
    len: usize,
}

impl Stack {
    #[inline(always)]
    fn push(&mut self, entry: (f32, u32)) {
        match self.fixed.get_mut(self.len) {
            Some(place) => *place = entry,
            None => self.spilt.push(entry),
        }
        self.len += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<(f32, u32)> {
        self.len = self.len.checked_sub(1)?;
        match self.fixed.get(self.len) {
            Some(entry) => Some(*entry),
            None => self.spilt.pop(),
        }
    }
}

/// Calls `leaf` with the leaves on the way of a ray, nearer boxes first, until it returns true. `limit` is the end of
/// the ray, which `leaf` may draw nearer.
#[inline(always)]
pub(super) fn walk(
    nodes: &[Node],
    slabs: &Slabs,
    limit: &mut f32,
    mut leaf: impl FnMut(u32, &mut f32) -> bool,
) -> bool {
    let mut stack = Stack { fixed: [(0.0, 0); DEPTH], spilt: Vec::new(), len: 0 };
    let mut current = 0;
    loop {
        if current & LEAF != 0 {
            if leaf(current & !LEAF, limit) {
                return true;
            }
        } else if let Some(next) = nodes.get(current as usize).and_then(|node| nearest(node, slabs, *limit, &mut stack))
        {
            current = next;
            continue;
        }
        current = loop {
            match stack.pop() {
                None => return false,
                Some((enter, reference)) if enter <= *limit => break reference,
                Some(_) => {}
            }
        };
    }
}

/// The nearest child of a node that the ray meets; the others go onto the stack, the farthest first.
#[inline(always)]
fn nearest(node: &Node, slabs: &Slabs, limit: f32, stack: &mut Stack) -> Option<u32> {
    let (enter, mask) = slabs.meet(node, limit);
    let enter = enter.to_array();
    let first = |mask: u32| {
        let lane = mask.trailing_zeros() as usize % WIDTH;
        (enter[lane], node.children[lane])
    };
    let without_first = |mask: u32| mask & mask.wrapping_sub(1);
    if mask == 0 {
        return None;
    }
    let (a, mut rest) = (first(mask), without_first(mask));
    if rest == 0 {
        return Some(a.1);
    }
    let b = first(rest);
    rest = without_first(rest);
    let [mut near, mut far] = if b.0 < a.0 { [b, a] } else { [a, b] };
    if rest == 0 {
        stack.push(far);
        return Some(near.1);
    }
    // Three or four: the third and fourth find their places among the others.
    let c = first(rest);
    rest = without_first(rest);
    let mut middle = c;
    if middle.0 < near.0 {
        std::mem::swap(&mut middle, &mut near);
    }
    if far.0 < middle.0 {
        std::mem::swap(&mut middle, &mut far);
    }
    if rest == 0 {
        stack.push(far);
        stack.push(middle);
        return Some(near.1);
    }
    let mut last = first(rest);
    if last.0 < near.0 {
        std::mem::swap(&mut last, &mut near);
    }
    if last.0 < middle.0 {
        std::mem::swap(&mut last, &mut middle);
    }
    if last.0 < far.0 {
        std::mem::swap(&mut last, &mut far);
    }
    stack.push(last);
    stack.push(far);
    stack.push(middle);
    Some(near.1)
}
