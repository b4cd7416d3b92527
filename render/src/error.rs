//! Why there is no picture.

use crate::device::GpuError;

/// Why a picture could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// The device failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Something does not fit the device.
    #[error("{what}: {bytes} is more than the {allowed} that this graphics adapter allows; use a smaller model or map")]
    TooLarge {
        /// Buffer or texture.
        what: String,
        /// Bytes or pixels asked for.
        bytes: u64,
        /// The adapter's limit.
        allowed: u64,
    },
    /// A view without pixels or larger than a texture may be.
    #[error("a picture of {width}x{height} pixels cannot be made; each side must be 1 to {allowed}")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Largest side.
        allowed: u32,
    },
    /// What a method prepared cannot be put on the device.
    #[error("{0}")]
    Preparation(String),
    /// There is no light from infinity to show.
    #[error("the scene has no environment; give one")]
    NoEnvironment,
}
