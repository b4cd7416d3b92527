//! The way of a ray through a wide tree.

use glam::Vec4;

use super::Ray;
use super::wide::{HALVES, LEAF, Node, WIDTH};
use crate::scene::Bounds;

/// Share of the distance to the farthest box by which boxes are grown: more than what rounding moves a corner in the
/// test of a triangle (Woop, Benthin and Wald 2013, section 3.3; half a unit in the last place is 2^-24 of a number).
pub(super) const SLACK: f32 = 1.0 / (1 << 20) as f32;

/// Ize 2013, Robust BVH Ray Traversal: with this factor on the far distance, rounding loses no box.
const FAR: f32 = 1.0 + 1.0 / (1 << 21) as f32;

/// Stands in for the inverse of a zero, so that no product is NaN.
const GREATEST_INVERSE: f32 = 1e37;

/// References that are kept without asking for memory.
const DEPTH: usize = 64;

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
        // At least one step of the numbers there, or a plane through the origin would divide zero by zero.
        let shift = ray.origin.abs() * f32::EPSILON + grown;
        let (less, more) = (ray.origin - shift, ray.origin + shift);
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
    fn meet(&self, node: &Node, limit: f32) -> ([f32; WIDTH], u32) {
        let near = self.near.map(|side| side & 1);
        let half = |half: usize| {
            let enter =
                |axis: usize| (node.planes[axis][near[axis]][half] - self.near_origin[axis]) * self.inverse[axis];
            let leave = |axis: usize| {
                (node.planes[axis][near[axis] ^ 1][half] - self.far_origin[axis]) * self.far_inverse[axis]
            };
            let enter = enter(0).max(enter(1)).max(enter(2).max(Vec4::ZERO));
            let leave = leave(0).min(leave(1)).min(leave(2).min(Vec4::splat(limit)));
            (enter, enter.cmple(leave).bitmask())
        };
        let [(first, low), (second, high)] = [half(0), half(1)];
        let halves: [Vec4; HALVES] = [first, second];
        (bytemuck::cast(halves), low | high << 4)
    }
}

/// References to visit later, each below the bits of the distance at which the ray enters it: as whole numbers they
/// are in the order of the distances.
struct Stack {
    fixed: [u64; DEPTH],
    /// What does not fit; only degenerate trees are that deep.
    spilt: Vec<u64>,
    len: usize,
}

impl Stack {
    #[inline(always)]
    fn push(&mut self, entry: u64) {
        match self.fixed.get_mut(self.len) {
            Some(place) => *place = entry,
            None => self.spilt.push(entry),
        }
        self.len += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<u64> {
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
    let mut stack = Stack { fixed: [0; DEPTH], spilt: Vec::new(), len: 0 };
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
                Some(entry) if (entry >> 32) as u32 <= limit.to_bits() => break entry as u32,
                Some(_) => {}
            }
        };
    }
}

/// The nearest child of a node that the ray meets; the others go onto the stack so that the next two follow in order.
/// A full order costs more branches than it saves visits.
#[inline(always)]
fn nearest(node: &Node, slabs: &Slabs, limit: f32, stack: &mut Stack) -> Option<u32> {
    let (enter, mut mask) = slabs.meet(node, limit);
    let mut take = || {
        let lane = mask.trailing_zeros() as usize % WIDTH;
        let rest = mask & mask.wrapping_sub(1);
        let found = mask != 0;
        mask = rest;
        // Without the sign, which a zero may have.
        let distance = u64::from(enter[lane].to_bits() & !(1 << 31));
        found.then_some(distance << 32 | u64::from(node.children[lane]))
    };
    let mut first = take()?;
    let Some(other) = take() else {
        return Some(first as u32);
    };
    let sorted = |a: u64, b: u64| (a.min(b), a.max(b));
    let (mut second, mut third);
    (first, second) = sorted(first, other);
    let Some(other) = take() else {
        stack.push(second);
        return Some(first as u32);
    };
    (first, third) = sorted(first, other);
    (second, third) = sorted(second, third);
    while let Some(other) = take() {
        let mut last;
        (first, last) = sorted(first, other);
        (second, last) = sorted(second, last);
        (third, last) = sorted(third, last);
        stack.push(last);
    }
    stack.push(third);
    stack.push(second);
    Some(first as u32)
}
