//! The list of all WGSL leaves. Tests loop over it, so that a newcomer cannot be forgotten.

use crate::leaf::Leaf;
use crate::scene::environment;
use crate::{color, lighting, math, measure, surface};

/// Every leaf of the project.
pub fn all() -> Vec<&'static Leaf> {
    [math::LEAVES, color::LEAVES, environment::LEAVES, measure::LEAVES, surface::LEAVES, lighting::LEAVES].concat()
}
