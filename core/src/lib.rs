//! The mathematics of Burnish, its scene and its files.
//!
//! Nothing here knows a GPU or a window. Formulas exist twice: as Rust, which is the plain reference, and as a WGSL
//! twin beside it (a [`leaf::Leaf`]), which passes of `burnish-render` join into their shaders. Tests hold the two
//! together.

pub mod color;
pub mod document;
pub mod error_map;
pub mod export;
pub mod file;
pub mod import;
pub mod job;
pub mod leaf;
pub mod leaves;
pub mod lighting;
pub mod material;
pub mod math;
pub mod measure;
pub mod param;
pub mod picture;
pub mod reference;
pub mod scene;
pub mod surface;
pub mod trace;
