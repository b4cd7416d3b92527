//! Fresnel reflectance of metals.

use glam::Vec3;

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
