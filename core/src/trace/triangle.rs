//! Rays against triangles, four at a time, without gaps between triangles that share an edge.
//!
//! Woop, Benthin and Wald 2013, Watertight Ray/Triangle Intersection. The corners are moved so that the ray starts at
//! the origin and sheared so that it points along one axis. What remains is a point in a triangle of the plane. Two
//! triangles with a common edge round the same numbers in the same way there, so the point is on one side of the edge
//! for both; exact zeros are decided in double precision, edge by edge.

use glam::{BVec4A, Vec2, Vec3, Vec4};

use super::Ray;

/// Triangles of a block.
pub(super) const BLOCK: usize = 4;

/// Marks a place in a block that holds no triangle.
pub(super) const NONE: u32 = u32::MAX;

/// Four triangles side by side.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Block {
    /// Corner, axis, triangle. NaN where there is no triangle: no comparison holds there.
    pub corners: [[Vec4; 3]; 3],
    /// Place in the mesh, or [`NONE`].
    pub triangles: [u32; BLOCK],
}

/// A ray made ready for the triangles of one mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheared {
    /// Which axis becomes x, y and z: z is where the direction is longest.
    axes: [usize; 3],
    origin: [Vec4; 3],
    /// Direction along x and y for one step of z, and the parameter of the ray for such a step.
    shear: [Vec4; 3],
}

/// Where a ray meets the triangles of a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    t: Vec4,
    /// Weights of the second and third corner.
    weights: [Vec4; 2],
    /// One bit per triangle.
    pub mask: u32,
}

impl Block {
    pub const EMPTY: Block = Block { corners: [[Vec4::NAN; 3]; 3], triangles: [NONE; BLOCK] };

    /// At most four triangles with their places in the mesh.
    pub fn new(triangles: impl IntoIterator<Item = (u32, [Vec3; 3])>) -> Block {
        let mut block = Block::EMPTY;
        for (lane, (triangle, corners)) in triangles.into_iter().take(BLOCK).enumerate() {
            block.triangles[lane] = triangle;
            for (axes, corner) in block.corners.iter_mut().zip(corners) {
                for (values, value) in axes.iter_mut().zip(corner.to_array()) {
                    values[lane] = value;
                }
            }
        }
        block
    }
}

impl Sheared {
    pub fn new(ray: &Ray) -> Sheared {
        let z = ray.direction.abs().max_position();
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let [x, y, z] = axes.map(|axis| ray.direction[axis]);
        Sheared {
            axes,
            origin: ray.origin.to_array().map(Vec4::splat),
            shear: [x / z, y / z, 1.0 / z].map(Vec4::splat),
        }
    }

    /// The triangles that the ray meets with `0 <= t <= limit`.
    #[inline(always)]
    pub fn meet(&self, block: &Block, limit: f32) -> Option<Met> {
        let [x, y, z] = self.axes;
        let shifted = |corner: usize, axis: usize| block.corners[corner][axis] - self.origin[axis];
        let depth = [0, 1, 2].map(|corner| shifted(corner, z));
        let across = [0, 1, 2].map(|corner| shifted(corner, x) - self.shear[0] * depth[corner]);
        let along = [0, 1, 2].map(|corner| shifted(corner, y) - self.shear[1] * depth[corner]);

        // Twice the area between the origin and the edge opposite to each corner.
        let area = |b: usize, c: usize| across[c] * along[b] - along[c] * across[b];
        let mut weights = [area(1, 2), area(2, 0), area(0, 1)];
        let zero = weights.map(|w| w.cmpeq(Vec4::ZERO));
        if (zero[0] | zero[1] | zero[2]).any() {
            weights = exact(weights, zero, across, along);
        }
        let [u, v, w] = weights;
        let least = u.min(v).min(w);
        let most = u.max(v).max(w);
        let inside = least.cmpge(Vec4::ZERO) | most.cmple(Vec4::ZERO);
        if !inside.any() {
            return None;
        }
        // A sum of zero, the triangle seen from its edge, makes t infinite or NaN. Divided first: areas times depths
        // would leave the range of numbers long before both do.
        let per_sum = Vec4::ONE / (u + v + w);
        let weights = weights.map(|weight| weight * per_sum);
        let [u, v, w] = weights;
        let t = (u * depth[0] + v * depth[1] + w * depth[2]) * self.shear[2];
        let met = inside & t.cmpge(Vec4::ZERO) & t.cmple(Vec4::splat(limit)) & t.cmplt(Vec4::INFINITY);
        let mask = met.bitmask();
        (mask != 0).then_some(Met { t, weights: [v, w], mask })
    }
}

/// Areas again where they were zero in single precision: products of two such numbers are exact in double precision,
/// so the sign of their difference is right. Others stay, as a neighbour that shares their edge keeps them too.
#[cold]
fn exact(mut weights: [Vec4; 3], zero: [BVec4A; 3], across: [Vec4; 3], along: [Vec4; 3]) -> [Vec4; 3] {
    for (corner, (weight, zero)) in weights.iter_mut().zip(zero).enumerate() {
        let (b, c) = ((corner + 1) % 3, (corner + 2) % 3);
        for lane in (0..BLOCK).filter(|lane| zero.test(*lane)) {
            let product =
                |x: [Vec4; 3], i: usize, y: [Vec4; 3], j: usize| f64::from(x[i][lane]) * f64::from(y[j][lane]);
            weight[lane] = (product(across, c, along, b) - product(along, c, across, b)) as f32;
        }
    }
    weights
}

impl Met {
    /// Parameter of the ray and weights of the second and third corner, for the triangle in a place of the block.
    #[inline(always)]
    pub fn at(&self, lane: usize) -> (f32, Vec2) {
        let [v, w] = self.weights;
        (self.t[lane], Vec2::new(v[lane], w[lane]))
    }
}
