//! OpenEXR to and from [`Picture`].

use std::io::Cursor;

use exr::meta::attribute::Chromaticities;
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, MetaData, ReadChannels, ReadLayers,
    ReadSpecificChannel, Vec2, WritableImage, read,
};
use glam::Vec4;

use super::picture::check_size;
use crate::color::rgb::PRIMARIES;
use crate::picture::Picture;

/// Chromaticity of the white that files are marked with, D65 as Rec.709 rounds it.
const WHITE: (f64, f64) = (0.3127, 0.3290);

/// Most layers and most channels of a layer that are read.
const MAX_PARTS: usize = 1024;

/// The bytes of a 32-bit float file, ZIP in blocks of 16 rows; alpha only when a pixel is not opaque.
pub(super) fn encode(picture: &Picture) -> Result<Vec<u8>, exr::error::Error> {
    let names: &[&str] = if picture.is_opaque() { &["R", "G", "B"] } else { &["R", "G", "B", "A"] };
    let channel = |(index, name): (usize, &&str)| {
        AnyChannel::new(*name, FlatSamples::F32(picture.texels.iter().map(|t| t[index]).collect()))
    };
    let channels = AnyChannels::sort(names.iter().enumerate().map(channel).collect());
    let attributes = LayerAttributes {
        software_name: Some(concat!("Burnish ", env!("CARGO_PKG_VERSION")).into()),
        comments: Some("scene-linear Rec.709, no display transform, exposure 0 EV".into()),
        ..LayerAttributes::default()
    };
    let size = (picture.width as usize, picture.height as usize);
    let mut image = Image::from_layer(Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels));
    let point = |(x, y): (f64, f64)| Vec2(x as f32, y as f32);
    let [red, green, blue] = PRIMARIES.map(point);
    image.attributes.chromaticities = Some(Chromaticities { red, green, blue, white: point(WHITE) });
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
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
