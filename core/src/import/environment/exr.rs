//! OpenEXR through the `exr` crate: the header is judged first, since the crate takes memory for whatever it states.

use std::io::Cursor;

use ::exr::image::{AnyChannel, FlatSamples};
use ::exr::meta::MetaData;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers, read as exr_read};
use glam::{DVec2, Vec3};

use super::primaries::Primaries;
use super::{Raw, check_size};
use crate::import::guard::guarded;
use crate::import::report::Report;
use crate::import::resolve::quoted;
use crate::import::{Budget, Cause};

/// Channels in one layer; film pipelines write some hundreds.
const MOST_CHANNELS: usize = 1024;

/// Channels of one layer that make a picture, by index in the header's list.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Choice {
    Rgb([usize; 3]),
    Luminance(usize),
}

pub(super) fn read(bytes: &[u8], budget: &Budget, report: &mut Report) -> Result<Raw, Cause> {
    check_flags(bytes)?;
    let meta = guarded(|| MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(syntax))?;
    let (layer, choice) = check_headers(&meta.headers, bytes.len() as u64, budget, report)?;
    let header = &meta.headers[layer];
    let primaries = header.shared_attributes.chromaticities.map(|c| {
        let point = |v: ::exr::math::Vec2<f32>| DVec2::new(v.0.into(), v.1.into());
        Primaries { red: point(c.red), green: point(c.green), blue: point(c.blue), white: point(c.white) }
    });
    let image = guarded(|| {
        let reader = exr_read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
        // On one thread: see `guarded`.
        reader.non_parallel().from_buffered(Cursor::new(bytes)).map_err(syntax)
    })?;
    let layer = image.layer_data.get(layer).ok_or_else(|| Cause::Syntax("a layer is missing".into()))?;
    let channels = &layer.channel_data.list;
    let channel = |i: usize| channels.get(i).map(values).ok_or_else(|| Cause::Syntax("a channel is missing".into()));
    let texels: Vec<Vec3> = match choice {
        Choice::Luminance(y) => channel(y)?.into_iter().map(Vec3::splat).collect(),
        Choice::Rgb([r, g, b]) => {
            let (r, g, b) = (channel(r)?, channel(g)?, channel(b)?);
            r.into_iter().zip(g).zip(b).map(|((r, g), b)| Vec3::new(r, g, b)).collect()
        }
    };
    let (width, height) = (layer.size.0, layer.size.1);
    if texels.len() != width * height {
        return Err(Cause::Syntax("a channel has not one sample for each pixel".into()));
    }
    Ok(Raw { width, height, texels, primaries })
}

/// Deep files are told by their version field, so that they are refused by name whatever else is in them.
fn check_flags(bytes: &[u8]) -> Result<(), Cause> {
    const DEEP: u32 = 0x800;
    let version = bytes.get(4..).and_then(|b| b.first_chunk()).map(|b| u32::from_le_bytes(*b));
    match version {
        None => Err(Cause::Syntax("cut short in the version field".into())),
        Some(version) if version & DEEP != 0 => {
            Err(Cause::Unsupported("has deep data (many samples a pixel); flatten the picture first".into()))
        }
        Some(_) => Ok(()),
    }
}

/// Checks every layer against the budget (all are decoded) and picks the one to show.
fn check_headers(
    headers: &[Header],
    file_bytes: u64,
    budget: &Budget,
    report: &mut Report,
) -> Result<(usize, Choice), Cause> {
    let mut samples = 0_u64;
    for header in headers {
        if header.deep {
            return Err(Cause::Unsupported("has deep data (many samples a pixel); flatten the picture first".into()));
        }
        let (width, height) = (header.layer_size.0 as u64, header.layer_size.1 as u64);
        check_size(width, height, budget)?;
        if let Some(c) = header.channels.list.iter().find(|c| c.sampling.0 != 1 || c.sampling.1 != 1) {
            let name = quoted(&c.name.to_string());
            return Err(Cause::Unsupported(format!("channel {name} is subsampled; save all channels in full size")));
        }
        // The table of chunk offsets alone must fit into the file.
        if (header.chunk_count as u64).saturating_mul(8) > file_bytes {
            return Err(Cause::Syntax(format!(
                "states {} chunks, for which the file is too short",
                header.chunk_count
            )));
        }
        let channels = header.channels.list.len() as u64;
        if channels > MOST_CHANNELS as u64 {
            return Err(Cause::Limit { what: "channels", asked: channels, limit: MOST_CHANNELS as u64 });
        }
        samples = samples.saturating_add((width * height).saturating_mul(channels));
    }
    // Four channels of the largest picture.
    let limit = budget.pixels.saturating_mul(4);
    if samples > limit {
        return Err(Cause::Limit { what: "samples in all channels", asked: samples, limit });
    }
    let Some((layer, choice, used)) = headers.iter().enumerate().find_map(|(i, h)| {
        let (choice, prefix) = choose(&names(h))?;
        Some((i, choice, prefix))
    }) else {
        let all: Vec<String> = headers.iter().flat_map(names).take(16).collect();
        let list = quoted(&all.join(", "));
        return Err(match all.iter().any(|n| n == "RY" || n == "BY") {
            true => Cause::Unsupported(format!("has luminance and chroma channels ({list}); save it as RGB")),
            false => Cause::Unsupported(format!("has no R, G, B or Y channels, only {list}")),
        });
    };
    tell(headers, layer, &used, report);
    Ok((layer, choice))
}

/// Names of the channels of a layer, in the order of decoding.
fn names(header: &Header) -> Vec<String> {
    header.channels.list.iter().map(|c| c.name.to_string()).collect()
}

/// The channels R, G, B without a prefix, else those of the first layer prefix that has them (`beauty.R`), else Y
/// alone; with the prefix. Luminance beside chroma is no picture by itself.
fn choose(names: &[String]) -> Option<(Choice, String)> {
    let find = |prefix: &str, suffix: &str| names.iter().position(|n| n.strip_prefix(prefix) == Some(suffix));
    let mut prefixes = vec![""];
    prefixes.extend(names.iter().filter_map(|n| n.rfind('.').map(|dot| &n[..=dot])));
    // A file may have a thousand channels; each prefix is judged once.
    prefixes.dedup();
    let rgb =
        prefixes.iter().find_map(|p| Some((Choice::Rgb([find(p, "R")?, find(p, "G")?, find(p, "B")?]), p.to_string())));
    rgb.or_else(|| {
        prefixes.iter().find_map(|p| {
            let chroma = find(p, "RY").is_some() || find(p, "BY").is_some();
            find(p, "Y").filter(|_| !chroma).map(|y| (Choice::Luminance(y), p.to_string()))
        })
    })
}

/// Notices on what was chosen and on windows.
fn tell(headers: &[Header], layer: usize, prefix: &str, report: &mut Report) {
    let header = &headers[layer];
    let name = header.own_attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
    let shown = match (name.as_str(), prefix.trim_end_matches('.')) {
        ("", "") => "the unnamed layer".to_string(),
        ("", prefix) => format!("layer {}", quoted(prefix)),
        (name, _) => format!("layer {}", quoted(name)),
    };
    if headers.len() > 1 || !prefix.is_empty() {
        report.notice("layers", format!("{shown} is shown; others are left out"));
    }
    let (data, display) = (header.own_attributes.layer_position, header.shared_attributes.display_window);
    if data != display.position || header.layer_size != display.size {
        report.notice("windows", "the data window is not the display window; the data window is taken for the sphere");
    }
}

fn values(channel: &AnyChannel<FlatSamples>) -> Vec<f32> {
    match &channel.sample_data {
        FlatSamples::F16(list) => list.iter().map(|v| v.to_f32()).collect(),
        FlatSamples::F32(list) => list.clone(),
        FlatSamples::U32(list) => list.iter().map(|v| *v as f32).collect(),
    }
}

fn syntax(error: ::exr::error::Error) -> Cause {
    match error {
        ::exr::error::Error::NotSupported(text) => Cause::Unsupported(format!("OpenEXR: {text}")),
        error => Cause::Syntax(format!("OpenEXR: {error}")),
    }
}
