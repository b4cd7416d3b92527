//! The wgpu renderer of Burnish: one code path with and without a window.
//!
//! [`Gpu`] opens an adapter, [`Renderer`] holds a scene on it and draws [`View`]s into linear pictures. Lighting
//! formulas live in `burnish-core` as leaves; here are the passes that join and run them.

pub mod device;
pub mod error;
pub mod layout;
pub mod pass;
pub mod readback;
pub mod renderer;
pub mod scene;
pub mod shader;
mod tables;
mod textures;

pub use device::{AdapterReport, Gpu, GpuError, adapters};
pub use error::RenderError;
pub use renderer::{Renderer, View};
