//! Fresnel reflectance: how much a surface reflects at each angle.
//!
//! One file per form. [`exact::exact`] is the truth in f64; the others are what a renderer evaluates. Angles enter as
//! `cos_theta`, the cosine between the light and the (microfacet) normal.

mod batch;
mod compensated;
mod dielectric;
mod exact;
pub mod fit;
mod form;
mod gulbrandsen;
mod schlick;
mod spectral;

#[cfg(test)]
mod tests;

use glam::Vec3;

pub use compensated::{compensated, exponents, f82, series2, series3, series4};
pub use dielectric::dielectric;
pub use exact::{INDEX_MAX, INDEX_MIN, conductor, exact, f0, grazing_slope};
pub use form::{Form, UnknownForm};
pub use gulbrandsen::{REFLECTANCE_MAX, gulbrandsen};
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
/// [`Fresnel::Compensated`] in shaders.
pub const COMPENSATED: u32 = 4;
/// [`Fresnel::F82`] in shaders.
pub const F82: u32 = 5;
/// [`Fresnel::Series2`] in shaders.
pub const SERIES2: u32 = 6;
/// [`Fresnel::Series3`] in shaders.
pub const SERIES3: u32 = 7;
/// [`Fresnel::Series4`] in shaders.
pub const SERIES4: u32 = 8;

/// A reflectance curve over the cosine of the angle, per channel, with its numbers: what a renderer evaluates.
///
/// Several [`Form`]s share one of these: they differ in where the numbers come from. F0 of the forms with a dip may
/// exceed 1, as the red of gold does under D65; the value is clamped after the dip, which then is where it belongs.
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
    /// [`compensated`].
    Compensated {
        /// Reflectance at normal incidence.
        f0: Vec3,
        /// Strength of the dip.
        a: Vec3,
        /// Its exponent, above 0.
        alpha: Vec3,
    },
    /// [`f82`].
    F82 {
        /// Reflectance at normal incidence.
        f0: Vec3,
        /// Strength of the dip.
        b: Vec3,
    },
    /// [`series2`].
    Series2 {
        /// Reflectance at normal incidence.
        f0: Vec3,
        /// Coefficients of y^3 and y^8.
        c: [Vec3; 2],
    },
    /// [`series3`].
    Series3 {
        /// Reflectance at normal incidence.
        f0: Vec3,
        /// Coefficients of y^2, y^6 and y^12.
        c: [Vec3; 3],
    },
    /// [`series4`].
    Series4 {
        /// Reflectance at normal incidence.
        f0: Vec3,
        /// Coefficients of y^2, y^4, y^8 and y^16.
        c: [Vec3; 4],
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
            Fresnel::Compensated { .. } => COMPENSATED,
            Fresnel::F82 { .. } => F82,
            Fresnel::Series2 { .. } => SERIES2,
            Fresnel::Series3 { .. } => SERIES3,
            Fresnel::Series4 { .. } => SERIES4,
        }
    }

    /// The numbers of the form in the order of the fields of `Fresnel` in shaders: F0 and four coefficients; a table is
    /// not among them. The F0 of forms without one is that of the curve.
    pub fn coefficients(&self) -> [Vec3; 5] {
        let mut numbers = [self.f0(), Vec3::ZERO, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO];
        let (f0, c): (Option<Vec3>, &[Vec3]) = match self {
            Fresnel::Rescaled { f0 } | Fresnel::Schlick { f0 } => (Some(*f0), &[]),
            Fresnel::Conductor { n, k } => (None, &[*n, *k]),
            Fresnel::Spectral { .. } => (None, &[]),
            Fresnel::Compensated { f0, a, alpha } => (Some(*f0), &[*a, *alpha]),
            Fresnel::F82 { f0, b } => (Some(*f0), &[*b]),
            Fresnel::Series2 { f0, c } => (Some(*f0), c),
            Fresnel::Series3 { f0, c } => (Some(*f0), c),
            Fresnel::Series4 { f0, c } => (Some(*f0), c),
        };
        numbers[0] = f0.unwrap_or(numbers[0]);
        for (number, c) in numbers[1..].iter_mut().zip(c) {
            *number = *c;
        }
        numbers
    }

    /// Reflectance in [0, 1] at `cos_theta`, which is clamped to [0, 1].
    pub fn eval(&self, cos_theta: f32) -> Vec3 {
        let value = match self {
            Fresnel::Rescaled { f0 } | Fresnel::Schlick { f0 } => schlick(*f0, 1.0, cos_theta),
            Fresnel::Conductor { n, k } => per_channel(*n, *k, |n, k| conductor(n, k, cos_theta)),
            Fresnel::Spectral { table } => spectral(table, cos_theta),
            Fresnel::Compensated { f0, a, alpha } => compensated(*f0, *a, *alpha, cos_theta),
            Fresnel::F82 { f0, b } => f82(*f0, *b, cos_theta),
            Fresnel::Series2 { f0, c } => series2(*f0, c, cos_theta),
            Fresnel::Series3 { f0, c } => series3(*f0, c, cos_theta),
            Fresnel::Series4 { f0, c } => series4(*f0, c, cos_theta),
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
            Fresnel::Spectral { table } => spectral::mean(table),
            _ => exact::mean(self),
        };
        value.clamp(Vec3::ZERO, Vec3::ONE)
    }
}

/// A function of one channel's `n` and `k`, on all three.
fn per_channel(n: Vec3, k: Vec3, f: impl Fn(f32, f32) -> f32) -> Vec3 {
    Vec3::new(f(n.x, k.x), f(n.y, k.y), f(n.z, k.z))
}
