//! Files: safe writing, bounded reading, pictures, arrays of numbers.
//!
//! A write leaves the whole old or the whole new file, whatever happens in between. A read knows its limit before it
//! takes memory. Every message names the file, the reason and what to do.

mod atomic;
mod container;
mod exr;
mod hdr;
mod picture;
mod png;
#[cfg(test)]
pub(crate) mod testing;

pub use atomic::{read_bounded, write_atomic};
pub use container::{Array, Container, Element, Kind};
pub use exr::{Attribute, Channel, Samples, write_exr_with};
pub use hdr::write_environment;
pub use picture::{Encoding, MAX_PIXELS, PictureFormat, read_picture, write_exr, write_picture, write_png};

use std::path::{Path, PathBuf};

/// Why a file could not be read or written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}; {remedy}", path.display())]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub reason: String,
    /// What to do about it.
    pub remedy: String,
}

impl FileError {
    /// An error about `path`.
    pub fn new(path: &Path, reason: impl Into<String>, remedy: impl Into<String>) -> FileError {
        FileError { path: path.into(), reason: reason.into(), remedy: remedy.into() }
    }
}
