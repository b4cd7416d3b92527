//! PNG to and from [`Picture`].

use std::io::Cursor;

use glam::{Vec3, Vec4};
use png::{BitDepth, ColorType, Decoder, Encoder, EncodingError, Limits, SrgbRenderingIntent, Transformations};

use super::picture::{MAX_PIXELS, check_size};
use crate::color::rgb::linear_from_srgb;
use crate::color::tone::{ToneMap, exposure_factor, tone_map};
use crate::picture::Picture;

/// Key of the text that names the display transform.
pub(super) const KEY_VIEW: &str = "View transform";
/// Key of the text that names the exposure.
pub(super) const KEY_EXPOSURE: &str = "Exposure EV";

/// The bytes of an 8-bit sRGB file.
pub(super) fn encode(picture: &Picture, tone: ToneMap, exposure_ev: f32) -> Result<Vec<u8>, EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, picture.width, picture.height);
    let opaque = picture.is_opaque();
    encoder.set_color(if opaque { ColorType::Rgb } else { ColorType::Rgba });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    encoder.add_text_chunk("Software".into(), concat!("Burnish ", env!("CARGO_PKG_VERSION")).into())?;
    encoder.add_text_chunk(KEY_VIEW.into(), tone.id().into())?;
    encoder.add_text_chunk(KEY_EXPOSURE.into(), format!("{exposure_ev}"))?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&display_bytes(picture, tone, exposure_ev, opaque))?;
    writer.finish()?;
    Ok(bytes)
}

/// RGB or straight RGBA, 8 bits.
fn display_bytes(picture: &Picture, tone: ToneMap, exposure_ev: f32, opaque: bool) -> Vec<u8> {
    let factor = exposure_factor(exposure_ev);
    let mut bytes = Vec::with_capacity(picture.texels.len() * if opaque { 3 } else { 4 });
    for texel in &picture.texels {
        // The transform is for the light of a covered point: coverage goes out before it and is stored beside it.
        let coverage = if opaque { 1.0 } else { texel.w };
        let straight = if coverage > 0.0 { texel.truncate() / coverage } else { Vec3::ZERO };
        bytes.extend(tone_map(tone, factor * straight).to_array().map(unorm8));
        if !opaque {
            bytes.push(unorm8(coverage));
        }
    }
    bytes
}

/// Nearest of 256 levels; the cast saturates and takes NaN to 0.
fn unorm8(x: f32) -> u8 {
    (255.0 * x + 0.5) as u8
}

/// Any PNG: grey, colour or palette, 1 to 16 bits, of an animation the first frame.
pub(super) fn decode(bytes: &[u8]) -> Result<Picture, String> {
    let fault = |e: png::DecodingError| format!("is a damaged PNG ({e})");
    // 16-bit RGBA of the largest picture, and as much again for tables and text.
    let limits = Limits { bytes: 16 * MAX_PIXELS as usize };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(fault)?;
    let (width, height) = check_size(header.width.into(), header.height.into())?;
    let mut reader = decoder.read_info().map_err(fault)?;
    let size = reader.output_buffer_size().ok_or("is a PNG too large for this machine")?;
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data).map_err(fault)?;
    let samples: Vec<f32> = match frame.bit_depth {
        BitDepth::Sixteen => {
            data.chunks_exact(2).map(|b| f32::from(u16::from_be_bytes([b[0], b[1]])) / 65535.0).collect()
        }
        _ => data.iter().map(|&b| f32::from(b) / 255.0).collect(),
    };
    let linear = |encoded: Vec3, alpha: f32| (linear_from_srgb(encoded) * alpha).extend(alpha);
    let texels: Vec<Vec4> = match frame.color_type {
        ColorType::Grayscale => samples.iter().map(|&v| linear(Vec3::splat(v), 1.0)).collect(),
        ColorType::GrayscaleAlpha => samples.chunks_exact(2).map(|s| linear(Vec3::splat(s[0]), s[1])).collect(),
        ColorType::Rgb => samples.chunks_exact(3).map(|s| linear(Vec3::new(s[0], s[1], s[2]), 1.0)).collect(),
        ColorType::Rgba => samples.chunks_exact(4).map(|s| linear(Vec3::new(s[0], s[1], s[2]), s[3])).collect(),
        ColorType::Indexed => return Err("is a PNG whose palette cannot be read".into()),
    };
    let picture = Picture { width, height, texels };
    if picture.is_whole() { Ok(picture) } else { Err("is a PNG with missing rows".into()) }
}
