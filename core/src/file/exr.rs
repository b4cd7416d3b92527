//! OpenEXR to and from [`Picture`], with channels and attributes beside the colours.

use std::io::Cursor;
use std::path::Path;

use exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, MetaData, ReadChannels, ReadLayers,
    ReadSpecificChannel, Vec2, WritableImage, read,
};
use glam::Vec4;

use super::picture::{check_size, check_whole};
use super::{FileError, atomic};
use crate::color::rgb::PRIMARIES;
use crate::picture::Picture;

/// Chromaticity of the white that files are marked with, D65 as Rec.709 rounds it.
const WHITE: (f64, f64) = (0.3127, 0.3290);

/// Most layers and most channels of a layer that are read.
const MAX_PARTS: usize = 1024;

/// A channel beside the colours, one number for each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name in the file, `LAYER.PART` for one of several that belong together.
    pub name: &'static str,
    /// Row by row from the top.
    pub samples: Samples,
}

/// Numbers of a [`Channel`].
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 32-bit floats.
    Float(Vec<f32>),
    /// Whole numbers, such as ids.
    Whole(Vec<u32>),
}

/// A fact about the whole picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    /// A whole number.
    Whole(i32),
    /// A number.
    Number(f64),
    /// Words; characters beyond Latin-1 are replaced.
    Text(String),
}

/// Writes 32-bit float scene-linear Rec.709 as [`super::write_exr`] does, with more channels and attributes. The bytes
/// depend on the arguments alone.
pub fn write_exr_with(
    picture: &Picture,
    channels: Vec<Channel>,
    attributes: &[(&str, Attribute)],
    path: &Path,
) -> Result<(), FileError> {
    check_whole(picture, path)?;
    let unfit = |channel: &&Channel| match &channel.samples {
        Samples::Float(values) => values.len() != picture.texels.len(),
        Samples::Whole(values) => values.len() != picture.texels.len(),
    };
    if let Some(Channel { name, .. }) = channels.iter().find(unfit) {
        let reason = format!("channel `{name}` has not as many numbers as the picture has pixels");
        return Err(FileError::new(path, reason, "give it one for each"));
    }
    let bytes = encode_with(picture, channels, attributes)
        .map_err(|e| FileError::new(path, format!("cannot be encoded ({e})"), "write a smaller picture"))?;
    atomic::write_atomic(path, &bytes)
}

/// The bytes of a 32-bit float file, ZIP in blocks of 16 rows; alpha only when a pixel is not opaque.
pub(super) fn encode(picture: &Picture) -> Result<Vec<u8>, exr::error::Error> {
    encode_with(picture, Vec::new(), &[])
}

fn encode_with(
    picture: &Picture,
    more: Vec<Channel>,
    attributes: &[(&str, Attribute)],
) -> Result<Vec<u8>, exr::error::Error> {
    let names: &[&str] = if picture.is_opaque() { &["R", "G", "B"] } else { &["R", "G", "B", "A"] };
    let color = |(index, name): (usize, &&str)| {
        AnyChannel::new(*name, FlatSamples::F32(picture.texels.iter().map(|t| t[index]).collect()))
    };
    let beside = |Channel { name, samples }| match samples {
        Samples::Float(values) => AnyChannel::new(name, FlatSamples::F32(values)),
        // No filter may mix two ids.
        Samples::Whole(values) => {
            AnyChannel { quantize_linearly: true, ..AnyChannel::new(name, FlatSamples::U32(values)) }
        }
    };
    let channels = AnyChannels::sort(names.iter().enumerate().map(color).chain(more.into_iter().map(beside)).collect());
    let facts = LayerAttributes {
        software_name: Some(concat!("Burnish ", env!("CARGO_PKG_VERSION")).into()),
        comments: Some("scene-linear Rec.709, no display transform, exposure 0 EV".into()),
        other: attributes.iter().map(|(name, value)| (latin(name), attribute(value))).collect(),
        ..LayerAttributes::default()
    };
    let size = (picture.width as usize, picture.height as usize);
    let mut image = Image::from_layer(Layer::new(size, facts, Encoding::SMALL_LOSSLESS, channels));
    let point = |(x, y): (f64, f64)| Vec2(x as f32, y as f32);
    let [red, green, blue] = PRIMARIES.map(point);
    image.attributes.chromaticities = Some(Chromaticities { red, green, blue, white: point(WHITE) });
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes)?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    Ok(bytes)
}

fn latin(text: &str) -> Text {
    Text::new_or_panic(text.chars().map(|c| if u8::try_from(c).is_ok() { c } else { '?' }).collect::<String>())
}

fn attribute(value: &Attribute) -> AttributeValue {
    match value {
        Attribute::Whole(value) => AttributeValue::I32(*value),
        Attribute::Number(value) => AttributeValue::F64(*value),
        Attribute::Text(text) => AttributeValue::Text(latin(text)),
    }
}

/// Puts the attributes of the only header in the order of their names. The library keeps some in a hash map, whose order
/// changes from run to run; the place of what follows does not change, so that the table of blocks stays right.
fn sort_attributes(bytes: &mut [u8]) {
    // Behind the magic number and the version.
    const START: usize = 8;
    let mut entries: Vec<Vec<u8>> = Vec::new();
    let mut at = START;
    while let Some(length) = attribute_length(&bytes[at..]) {
        entries.push(bytes[at..at + length].to_vec());
        at += length;
    }
    entries.sort();
    bytes[START..at].copy_from_slice(&entries.concat());
}

/// Bytes of the attribute that begins here: name, type, both ended by 0, size, value. `None` at the end of the list.
fn attribute_length(bytes: &[u8]) -> Option<usize> {
    let text = |from: usize| bytes.get(from..)?.iter().position(|b| *b == 0).filter(|length| *length > 0);
    let name = text(0)?;
    let size_at = name + 1 + text(name + 1)? + 1;
    let size = bytes.get(size_at..size_at + 4)?.first_chunk().map(|size| u32::from_le_bytes(*size))?;
    let length = size_at + 4 + size as usize;
    (length <= bytes.len()).then_some(length)
}

/// The first flat layer with channels R, G, B (A optional), its largest resolution.
pub(super) fn decode(bytes: &[u8]) -> Result<Picture, String> {
    let fault = |e: exr::error::Error| format!("is a damaged or unknown OpenEXR ({e})");
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(fault)?;
    let (width, height) = check_headers(&meta.headers)?;
    let create = move |_: Vec2<usize>, _: &_| vec![Vec4::ZERO; width as usize * height as usize];
    let set = move |texels: &mut Vec<Vec4>, at: Vec2<usize>, (r, g, b, a): (f32, f32, f32, f32)| {
        if let Some(texel) = texels.get_mut(at.y() * width as usize + at.x()) {
            *texel = Vec4::new(r, g, b, a);
        }
    };
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("R")
        .required("G")
        .required("B")
        .optional("A", 1.0_f32)
        .collect_pixels(create, set)
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(fault)?;
    // Both choose the first layer that fits; were it not the same one, pixels would lie in the wrong rows.
    if image.layer_data.size != Vec2(width as usize, height as usize) {
        return Err("has layers of different sizes that cannot be told apart".into());
    }
    Ok(Picture { width, height, texels: image.layer_data.channel_data.pixels })
}

/// Size of the layer that will be read, after every header was found to be within the budget.
fn check_headers(headers: &[Header]) -> Result<(u32, u32), String> {
    if headers.len() > MAX_PARTS || headers.iter().any(|h| h.channels.list.len() > MAX_PARTS) {
        return Err(format!("has more than {MAX_PARTS} layers or channels"));
    }
    for header in headers {
        let size = check_size(header.layer_size.width() as u64, header.layer_size.height() as u64)?;
        // Blocks hold at least a pixel each, and all levels together less than three times the pixels (rip maps: four).
        if header.chunk_count as u64 > 4 * u64::from(size.0) * u64::from(size.1) {
            return Err(format!("claims {} blocks for {} x {} pixels", header.chunk_count, size.0, size.1));
        }
    }
    let has = |header: &Header, name: &str| header.channels.list.iter().any(|c| c.name == *name);
    let has_rgb = |header: &&Header| !header.deep && ["R", "G", "B"].iter().all(|name| has(header, name));
    let Some(header) = headers.iter().find(has_rgb) else {
        let list = |h: &Header| h.channels.list.iter().map(|c| c.name.to_string()).collect::<Vec<_>>().join(", ");
        let found: Vec<String> = headers.iter().take(4).map(list).collect();
        let deep = if headers.iter().any(|h| h.deep) { "; deep pixels are not read" } else { "" };
        return Err(format!("has no layer with channels R, G, B (it has {}){deep}", found.join(" | ")));
    };
    if header.channels.list.iter().any(|c| c.sampling != Vec2(1, 1)) {
        return Err("has channels of lower resolution, which are not read".into());
    }
    check_size(header.layer_size.width() as u64, header.layer_size.height() as u64)
}
