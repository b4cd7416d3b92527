//! Lighting methods, one folder each.

pub mod classical;
pub mod method;

use crate::leaf::Leaf;
use crate::reference;

pub use method::{Cover, Coverage, Method, MethodId, MethodInfo, Methods};

/// The methods of the program, in the order in which they are listed.
pub static METHODS: Methods<'static> = &[&classical::Classical, &reference::Reference];

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] = &[&classical::WGSL];
