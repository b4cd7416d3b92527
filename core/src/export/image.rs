//! Pictures of an export: channels of 32-bit floats as OpenEXR, 8-bit texels as PNG.

use std::io::Cursor;
use std::path::Path;

use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage};
use png::{BitDepth, ColorType, Encoder};

use crate::file::FileError;

/// An OpenEXR of named channels, each of `width * height` numbers. `name` is for messages.
pub fn exr(name: &str, width: u32, height: u32, channels: Vec<(&str, Vec<f32>)>) -> Result<Vec<u8>, FileError> {
    let channel = |(name, values): (&str, Vec<f32>)| AnyChannel::new(name, FlatSamples::F32(values));
    let channels = AnyChannels::sort(channels.into_iter().map(channel).collect());
    let size = (width as usize, height as usize);
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).map_err(|e| refused(name, &e))?;
    Ok(bytes.into_inner())
}

/// A PNG of 8-bit RGB texels.
pub fn png(name: &str, width: u32, height: u32, rgb: &[u8]) -> Result<Vec<u8>, FileError> {
    encoded(name, (width, height), (ColorType::Rgb, BitDepth::Eight), rgb)
}

/// A PNG of RGBA texels of 8 bits, or of 16 with the high byte first.
pub fn png_rgba(name: &str, width: u32, height: u32, texels: &[u8], is_deep: bool) -> Result<Vec<u8>, FileError> {
    let depth = if is_deep { BitDepth::Sixteen } else { BitDepth::Eight };
    encoded(name, (width, height), (ColorType::Rgba, depth), texels)
}

fn encoded(name: &str, size: (u32, u32), of: (ColorType, BitDepth), texels: &[u8]) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, size.0, size.1);
    encoder.set_color(of.0);
    encoder.set_depth(of.1);
    let mut writer = encoder.write_header().map_err(|e| refused(name, &e))?;
    writer.write_image_data(texels).map_err(|e| refused(name, &e))?;
    writer.finish().map_err(|e| refused(name, &e))?;
    Ok(bytes)
}

fn refused(name: &str, error: &dyn std::error::Error) -> FileError {
    FileError::new(Path::new(name), format!("cannot be encoded ({error})"), "report the scene")
}
