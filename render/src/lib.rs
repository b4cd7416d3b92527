//! The wgpu renderer of Burnish: one code path with and without a window.
//!
//! [`Gpu`] opens an adapter or takes a window's, [`Renderer`] holds a scene on it and draws [`View`]s into linear
//! pictures, [`Viewport`] keeps one on a screen up to date, [`Plate`] shows one that was computed elsewhere, [`DeviceRaster`] draws what probes see. Lighting formulas live in `burnish-core` as leaves; here are
//! the passes that join and run them.

use burnish_core::lighting::{area_cube, classical, impostor};

pub mod bench;
mod clock;
pub mod device;
pub mod error;
mod frame;
pub mod layout;
pub mod pass;
mod passes;
mod plate;
mod probes;
mod radiance_map;
mod raster;
pub mod readback;
pub mod renderer;
mod resident;
pub mod scene;
pub mod shader;
mod tables;
mod textures;
pub mod times;
pub mod trace;
pub mod viewport;

pub use device::{AdapterReport, Gpu, GpuError, adapters};
pub use error::RenderError;
pub use pass::display::Display;
pub use passes::Passes;
pub use plate::Plate;
pub use probes::Lighting;
pub use raster::DeviceRaster;
pub use renderer::{Renderer, View};
pub use viewport::{Drawn, Frame, PendingPicture, Picked, Viewport};

/// The device has a pass for this lighting method; without one a method draws on the processor, if it can.
pub fn draws(method: burnish_core::lighting::MethodId) -> bool {
    [classical::ID, impostor::ID, area_cube::ID, burnish_core::lighting::radiance_map::ID].contains(&method.0)
}
