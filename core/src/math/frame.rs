//! Orthonormal frames about a direction.

use glam::Vec3;

/// A right-handed orthonormal basis. BRDFs work in its coordinates, with z along `n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Tangent, local x.
    pub t: Vec3,
    /// Bitangent, local y.
    pub b: Vec3,
    /// Normal, local z.
    pub n: Vec3,
}

impl Frame {
    /// Some frame about the unit vector `n`, without a branch.
    ///
    /// Duff et al. 2017, Building an Orthonormal Basis, Revisited. The frame jumps at `n.z = 0` only.
    pub fn new(n: Vec3) -> Frame {
        let s = if n.z >= 0.0 { 1.0 } else { -1.0 };
        let a = -1.0 / (s + n.z);
        let c = n.x * n.y * a;
        Frame { t: Vec3::new(1.0 + s * n.x * n.x * a, s * c, -s * n.x), b: Vec3::new(c, s + n.y * n.y * a, -n.y), n }
    }

    /// The frame about the unit vector `n` whose tangent is as near to `tangent` as it can be, with bitangent
    /// `n x t`; [`Frame::new`] where `tangent` is parallel to `n`, zero or not finite.
    pub fn with_tangent(n: Vec3, tangent: Vec3) -> Frame {
        let across = tangent - n * n.dot(tangent);
        // Below this share of its length the remainder is rounding and points anywhere.
        if across.length_squared() > 1e-8 * tangent.length_squared()
            && let Some(t) = across.try_normalize()
        {
            // Once more, since the first subtraction cancels digits where the two are close.
            let t = (t - n * n.dot(t)).normalize();
            return Frame { t, b: n.cross(t), n };
        }
        Frame::new(n)
    }

    /// Coordinates of `v` in the frame.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.t), v.dot(self.b), v.dot(self.n))
    }

    /// The vector with coordinates `v` in the frame.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.t * v.x + self.b * v.y + self.n * v.z
    }
}
