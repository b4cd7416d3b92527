//! Lighting methods, one folder each.

pub mod area;
pub mod area_cube;
pub mod bakes;
pub mod classical;
pub mod cube_map;
pub mod drawing;
pub mod impostor;
pub mod layers;
pub mod method;
pub mod prepared;
pub mod probe;
pub mod radiance_map;

use std::sync::{PoisonError, RwLock};

use crate::leaf::Leaf;
use crate::reference;

pub use drawing::Drawing;
pub use layers::{Layer, Layers};
pub use method::{Cover, Coverage, Method, MethodError, MethodId, MethodInfo, Methods, ShadePoint};
pub use prepared::{Prepared, Reads, Store};

/// The methods that come with the program, in the order in which they are listed.
pub static METHODS: Methods<'static> = &[
    &classical::Classical,
    &impostor::Impostor,
    &area_cube::AreaCube,
    &radiance_map::RadianceMap,
    &reference::Reference,
];

/// Methods that were added by [`register`].
static ADDED: RwLock<Vec<&'static dyn Method>> = RwLock::new(Vec::new());

/// All methods: those of the program, then those that were added. Window, command line, chart and pages list these.
pub fn methods() -> Vec<&'static dyn Method> {
    let added = ADDED.read().unwrap_or_else(PoisonError::into_inner);
    METHODS.iter().chain(&*added).copied().collect()
}

/// Adds a method for the rest of the process, as a program does that embeds this one; false when there is one of its id.
pub fn register(method: &'static dyn Method) -> bool {
    let mut added = ADDED.write().unwrap_or_else(PoisonError::into_inner);
    let is_new = METHODS.iter().chain(&*added).all(|known| known.info().id != method.info().id);
    if is_new {
        added.push(method);
    }
    is_new
}

/// The method of that id, if there is one.
pub fn find(id: &str) -> Option<&'static dyn Method> {
    methods().into_iter().find(|method| method.info().id.0 == id)
}

/// The WGSL twins of this folder.
pub static LEAVES: &[&Leaf] = &[&area::WGSL, &area_cube::WGSL, &classical::WGSL, &impostor::WGSL, &probe::WGSL];
