//! Fresnel reflectance: how much a surface reflects at each angle.
//!
//! One file per form. [`exact::exact`] is the truth in f64; the others are what a renderer evaluates. Angles enter as
//! `cos_theta`, the cosine between the light and the (microfacet) normal.

mod dielectric;
mod exact;
mod schlick;
mod spectral;

#[cfg(test)]
mod tests;

use glam::Vec3;

pub use dielectric::dielectric;
pub use exact::{INDEX_MAX, INDEX_MIN, conductor, exact, f0};
pub use schlick::{schlick, schlick_mean};
pub use spectral::spectral;

use crate::leaf::Leaf;

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "fresnel",
    source: include_str!("fresnel.wgsl"),
    needs: &[],
    externs: "fn fresnel_table(table: u32, entry: u32) -> vec3f { return vec3f(f32(entry) / 255.0); }",
};

/// Entries of a spectral table.
pub const TABLE_SIZE: usize = 256;

/// [`Fresnel::Rescaled`] in shaders.
pub const RESCALED: u32 = 0;
/// [`Fresnel::Schlick`] in shaders.
pub const SCHLICK: u32 = 1;
/// [`Fresnel::Conductor`] in shaders.
pub const CONDUCTOR: u32 = 2;
/// [`Fresnel::Spectral`] in shaders.
pub const SPECTRAL: u32 = 3;

/// A reflectance curve over the cosine of the angle, per channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Fresnel {
    /// `F0 + (1 - F0)(1 - x)^5`, F0 measured.
    Rescaled {
        /// Reflectance at normal incidence.
        f0: Vec3,
    },
    /// The same with F0 = ((n - 1) / (n + 1))^2, which ignores the extinction: a baseline that fails on metals.
    Schlick {
        /// `((n - 1) / (n + 1))^2`.
        f0: Vec3,
    },
    /// Exact for one complex index per channel, from vacuum.
    Conductor {
        /// Real part.
        n: Vec3,
        /// Extinction.
        k: Vec3,
    },
    /// Integrated R, G, B curves: entry i is the reflectance at cos theta = i / 255, linear between entries.
    Spectral {
        /// One colour per entry.
        table: Box<[Vec3; TABLE_SIZE]>,
    },
}

impl Fresnel {
    /// The rescaled form of a conductor with the index `n + ik` per channel: F0 is exact.
    pub fn rescaled(n: Vec3, k: Vec3) -> Fresnel {
        Fresnel::Rescaled { f0: per_channel(n, k, f0) }
    }

    /// The Schlick form of a conductor: F0 ignores the extinction.
    pub fn schlick(n: Vec3) -> Fresnel {
        Fresnel::Schlick { f0: per_channel(n, Vec3::ZERO, f0) }
    }

    /// The form's number in shaders.
    pub fn form(&self) -> u32 {
        match self {
            Fresnel::Rescaled { .. } => RESCALED,
            Fresnel::Schlick { .. } => SCHLICK,
            Fresnel::Conductor { .. } => CONDUCTOR,
            Fresnel::Spectral { .. } => SPECTRAL,
        }
    }

    /// Reflectance in [0, 1] at `cos_theta`, which is clamped to [0, 1].
    pub fn eval(&self, cos_theta: f32) -> Vec3 {
        let value = match self {
            Fresnel::Rescaled { f0 } | Fresnel::Schlick { f0 } => schlick(*f0, 1.0, cos_theta),
            Fresnel::Conductor { n, k } => per_channel(*n, *k, |n, k| conductor(n, k, cos_theta)),
            Fresnel::Spectral { table } => spectral(table, cos_theta),
        };
        value.clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// Reflectance at normal incidence, in [0, 1].
    pub fn f0(&self) -> Vec3 {
        self.eval(1.0)
    }

    /// Cosine-weighted mean over the hemisphere, `2 int_0^1 F(x) x dx`, in [0, 1].
    pub fn mean(&self) -> Vec3 {
        let value = match self {
            Fresnel::Rescaled { f0 } | Fresnel::Schlick { f0 } => schlick_mean(f0.clamp(Vec3::ZERO, Vec3::ONE), 1.0),
            Fresnel::Conductor { .. } => exact::mean(self),
            Fresnel::Spectral { table } => spectral::mean(table),
        };
        value.clamp(Vec3::ZERO, Vec3::ONE)
    }
}

/// A function of one channel's `n` and `k`, on all three.
fn per_channel(n: Vec3, k: Vec3, f: impl Fn(f32, f32) -> f32) -> Vec3 {
    Vec3::new(f(n.x, k.x), f(n.y, k.y), f(n.z, k.z))
}
