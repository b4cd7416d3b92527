//! Pictures as files: PNG for looking, OpenEXR for measuring.

use std::path::Path;

use super::{FileError, atomic, exr, png};
use crate::color::tone::ToneMap;
use crate::picture::Picture;

/// Largest number of pixels that is read: 64 Mi, one GiB in memory.
pub const MAX_PIXELS: u64 = 64 << 20;

/// Largest picture file that is read.
const MAX_BYTES: u64 = 2 << 30;

/// What the linear values of a read picture mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Light of the screen in [0, 1]: a display transform and an exposure are already in it (PNG).
    Display,
    /// Radiance of the scene, unbounded (OpenEXR).
    Linear,
}

/// The formats that are written, by the ending of the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// 8 bits, sRGB, through a display transform.
    Png,
    /// 32-bit float, scene-linear, no display transform.
    Exr,
}

impl PictureFormat {
    /// The format that `path` asks for; lets a caller refuse a name before a long computation.
    pub fn of(path: &Path) -> Result<PictureFormat, FileError> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("png") => Ok(PictureFormat::Png),
            Some("exr") => Ok(PictureFormat::Exr),
            Some(other) => {
                Err(FileError::new(path, format!("`.{other}` is no picture format here"), "use .png or .exr"))
            }
            None => Err(FileError::new(path, "the name has no ending", "use .png or .exr")),
        }
    }
}

/// Writes in the format that the name asks for; OpenEXR ignores `tone` and `exposure_ev`.
pub fn write_picture(picture: &Picture, path: &Path, tone: ToneMap, exposure_ev: f32) -> Result<(), FileError> {
    match PictureFormat::of(path)? {
        PictureFormat::Png => write_png(picture, path, tone, exposure_ev),
        PictureFormat::Exr => write_exr(picture, path),
    }
}

/// Writes 8-bit sRGB through a display transform; the file says which, and with what exposure. Alpha is stored,
/// straight as PNG wants it, when a pixel is not opaque.
pub fn write_png(picture: &Picture, path: &Path, tone: ToneMap, exposure_ev: f32) -> Result<(), FileError> {
    check_whole(picture, path)?;
    let bytes = png::encode(picture, tone, exposure_ev)
        .map_err(|e| FileError::new(path, format!("cannot be encoded ({e})"), "write a smaller picture"))?;
    atomic::write_atomic(path, &bytes)
}

/// Writes 32-bit float scene-linear Rec.709 without loss (ZIP), no display transform and no exposure.
pub fn write_exr(picture: &Picture, path: &Path) -> Result<(), FileError> {
    check_whole(picture, path)?;
    let bytes = exr::encode(picture)
        .map_err(|e| FileError::new(path, format!("cannot be encoded ({e})"), "write a smaller picture"))?;
    atomic::write_atomic(path, &bytes)
}

/// Reads a PNG or OpenEXR picture, told apart by content. Texels come out linear and premultiplied in both cases.
///
/// The header is checked against [`MAX_PIXELS`] before memory is taken. Colour profiles in PNG files are not read: sRGB
/// is assumed. Of an OpenEXR file the first layer with channels R, G, B is read, its data window as the picture.
pub fn read_picture(path: &Path) -> Result<(Picture, Encoding), FileError> {
    let bytes = atomic::read_bounded(path, MAX_BYTES)?;
    let damaged =
        |reason: String| FileError::new(path, reason, "use a PNG or OpenEXR picture that other programs open");
    if bytes.starts_with(&[0x89, b'P', b'N', b'G']) {
        png::decode(&bytes).map(|picture| (picture, Encoding::Display)).map_err(damaged)
    } else if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        exr::decode(&bytes).map(|picture| (picture, Encoding::Linear)).map_err(damaged)
    } else {
        Err(damaged(format!("is neither PNG nor OpenEXR ({})", content(&bytes))))
    }
}

/// Refuses a header whose picture is empty or over the budget.
pub(super) fn check_size(width: u64, height: u64) -> Result<(u32, u32), String> {
    let pixels = width.saturating_mul(height);
    if pixels == 0 {
        return Err(format!("is {width} x {height} pixels: empty"));
    }
    match (u32::try_from(width), u32::try_from(height)) {
        (Ok(w), Ok(h)) if pixels <= MAX_PIXELS => Ok((w, h)),
        _ => Err(format!("is {width} x {height} pixels, over the limit of {MAX_PIXELS}")),
    }
}

/// What a file that is no picture seems to be.
fn content(bytes: &[u8]) -> &'static str {
    let starts = |magic: &[u8]| bytes.starts_with(magic);
    if bytes.is_empty() {
        "it is empty"
    } else if starts(b"#?") {
        "it is a Radiance .hdr"
    } else if starts(&[0xff, 0xd8]) {
        "it is a JPEG"
    } else if starts(b"version https://git-lfs") {
        "it is a Git LFS pointer: fetch the file itself"
    } else if starts(b"<") {
        "it is a web page or other markup"
    } else {
        "its content is unknown"
    }
}

/// Refuses a picture that no file can hold.
pub(super) fn check_whole(picture: &Picture, path: &Path) -> Result<(), FileError> {
    if picture.texels.is_empty() || !picture.is_whole() {
        let Picture { width, height, texels } = picture;
        let reason = format!("the picture is {width} x {height} with {} pixels", texels.len());
        return Err(FileError::new(path, reason, "give it at least one pixel and as many as its size says"));
    }
    Ok(())
}

#[cfg(test)]
#[path = "picture_tests.rs"]
mod tests;
