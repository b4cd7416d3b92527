//! Radiance HDR: a text header, then runs of RGB with a shared exponent (Ward 1991, "Real Pixels", Graphics Gems II).

use glam::{DVec2, Vec3};

use super::primaries::Primaries;
use super::{Raw, check_size};
use crate::import::resolve::quoted;
use crate::import::{Budget, Cause};

/// Headers are a few hundred bytes; more is no header.
const LONGEST_HEADER: usize = 1 << 16;

/// What the header says.
struct Header {
    /// Product of all EXPOSURE lines; pixel values were multiplied by it.
    exposure: f32,
    primaries: Option<Primaries>,
    axes: Axes,
}

/// The resolution line: two signed axes, the slower first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axes {
    /// Scanlines run down or up (x is the faster axis), or else across.
    rows: bool,
    /// Number of scanlines, texels in one.
    lines: usize,
    length: usize,
    /// x grows to the right.
    x_forward: bool,
    /// y grows downwards, which is written `-Y`.
    y_down: bool,
}

pub(super) fn read(bytes: &[u8], budget: &Budget) -> Result<Raw, Cause> {
    let (header, mut rest) = header(bytes)?;
    let axes = header.axes;
    check_size(axes.length as u64, axes.lines as u64, budget)?;
    // Grown line by line: a header alone takes no memory.
    let mut stored: Vec<[u8; 4]> = Vec::new();
    for line in 0..axes.lines {
        rest = scanline(rest, axes.length, &mut stored)
            .map_err(|what| Cause::Syntax(format!("scanline {line} of {}: {what}", axes.lines)))?;
    }
    let (width, height) = if axes.rows { (axes.length, axes.lines) } else { (axes.lines, axes.length) };
    let mut texels = Vec::with_capacity(stored.len());
    for y in 0..height {
        let y = if axes.y_down { y } else { height - 1 - y };
        for x in 0..width {
            let x = if axes.x_forward { x } else { width - 1 - x };
            let (line, place) = if axes.rows { (y, x) } else { (x, y) };
            texels.push(decode(stored[line * axes.length + place]) / header.exposure);
        }
    }
    Ok(Raw { width, height, texels, primaries: header.primaries })
}

/// Parses the header; returns the pixel data after it.
fn header(bytes: &[u8]) -> Result<(Header, &[u8]), Cause> {
    let mut rest = bytes;
    let mut exposure = 1.0_f32;
    let mut primaries = None;
    loop {
        let line = line(bytes, &mut rest)?;
        if line.is_empty() {
            break;
        }
        if axes(line).is_some() {
            return Err(Cause::Syntax("header: no blank line before the resolution".into()));
        }
        let Some((key, value)) = line.split_once('=') else { continue };
        match key.trim() {
            "FORMAT" if value.trim() == "32-bit_rle_rgbe" => {}
            "FORMAT" if value.trim() == "32-bit_rle_xyze" => {
                return Err(Cause::Unsupported("the pixels are XYZE; convert the picture to RGBE (ra_xyze -r)".into()));
            }
            "FORMAT" => return Err(Cause::Unsupported(format!("the pixel format is {}", quoted(value.trim())))),
            "EXPOSURE" => exposure *= value.trim().parse::<f32>().unwrap_or(f32::NAN),
            "PRIMARIES" => primaries = primaries.or(parse_primaries(value)),
            _ => {}
        }
    }
    if !(exposure.is_finite() && exposure > 0.0) {
        return Err(Cause::Invalid("header: EXPOSURE is not a positive number".into()));
    }
    let line = line(bytes, &mut rest)?;
    let axes = axes(line).ok_or_else(|| Cause::Syntax(format!("header: {} is not a resolution", quoted(line))))?;
    Ok((Header { exposure, primaries, axes }, rest))
}

/// The next line of the header.
fn line<'a>(bytes: &'a [u8], rest: &mut &'a [u8]) -> Result<&'a str, Cause> {
    let read = bytes.len() - rest.len();
    let window = &rest[..rest.len().min(LONGEST_HEADER.saturating_sub(read))];
    let Some(end) = window.iter().position(|b| *b == b'\n') else {
        let cut = window.len() == rest.len();
        let text = if cut { "header: cut short" } else { "header: longer than 64 KiB" };
        return Err(Cause::Syntax(text.into()));
    };
    let line = window[..end].strip_suffix(b"\r").unwrap_or(&window[..end]);
    *rest = &rest[end + 1..];
    // A comment in another encoding is no reason to refuse.
    Ok(std::str::from_utf8(line).unwrap_or("#"))
}

fn axes(line: &str) -> Option<Axes> {
    let mut words = line.split_whitespace();
    let (first, lines, second, length) = (words.next()?, words.next()?, words.next()?, words.next()?);
    // u32, so that products of two fit in u64.
    let size = |word: &str| word.parse::<u32>().ok().map(|n| n as usize);
    let (lines, length) = (size(lines)?, size(length)?);
    let rows = match (first, second) {
        ("-Y" | "+Y", "+X" | "-X") => true,
        ("+X" | "-X", "-Y" | "+Y") => false,
        _ => return None,
    };
    let (x, y) = if rows { (second, first) } else { (first, second) };
    words.next().is_none().then_some(Axes { rows, lines, length, x_forward: x == "+X", y_down: y == "-Y" })
}

fn parse_primaries(value: &str) -> Option<Primaries> {
    let numbers: Vec<f64> = value.split_whitespace().map_while(|w| w.parse().ok()).collect();
    let pair = |i: usize| Some(DVec2::new(*numbers.get(i)?, *numbers.get(i + 1)?));
    // Some writers state eight zeros for "not known".
    let stated = numbers.iter().any(|n| *n != 0.0);
    Some(Primaries { red: pair(0)?, green: pair(2)?, blue: pair(4)?, white: pair(6)? }).filter(|_| stated)
}

/// Reads one scanline to the end of `out`; returns what follows it.
fn scanline<'a>(bytes: &'a [u8], length: usize, out: &mut Vec<[u8; 4]>) -> Result<&'a [u8], &'static str> {
    match bytes {
        // The newer form: a mark, then each of the four channels in runs of its own.
        [2, 2, high, low, rest @ ..] if (8..0x8000).contains(&length) && *high < 128 => {
            if usize::from(*high) << 8 | usize::from(*low) != length {
                return Err("states another length");
            }
            channels(rest, length, out)
        }
        _ => texels(bytes, length, out),
    }
}

/// Four channels, each as runs (a count over 128, then one byte) and literals (a count, then so many bytes).
fn channels<'a>(mut bytes: &'a [u8], length: usize, out: &mut Vec<[u8; 4]>) -> Result<&'a [u8], &'static str> {
    let start = out.len();
    out.resize(start + length, [0; 4]);
    let line = &mut out[start..];
    for channel in 0..4 {
        let mut x = 0;
        while x < length {
            let Some((&count, rest)) = bytes.split_first() else { return Err(CUT) };
            let run = count > 128;
            let count = usize::from(if run { count - 128 } else { count });
            if count == 0 || x + count > length {
                return Err("a run is empty or passes the end");
            }
            let Some((values, after)) = rest.split_at_checked(if run { 1 } else { count }) else { return Err(CUT) };
            for (i, texel) in line[x..x + count].iter_mut().enumerate() {
                texel[channel] = values[if run { 0 } else { i }];
            }
            x += count;
            bytes = after;
        }
    }
    Ok(bytes)
}

/// Whole texels; `1 1 1 n` repeats the last one n times, and more such give the higher digits of n in base 256.
fn texels<'a>(mut bytes: &'a [u8], length: usize, out: &mut Vec<[u8; 4]>) -> Result<&'a [u8], &'static str> {
    let end = out.len() + length;
    let start = out.len();
    let mut shift = 0;
    while out.len() < end {
        let Some((texel, rest)) = bytes.split_first_chunk::<4>() else { return Err(CUT) };
        bytes = rest;
        if texel[..3] != [1, 1, 1] {
            out.push(*texel);
            shift = 0;
            continue;
        }
        let count = usize::from(texel[3]).checked_shl(shift).filter(|_| shift < 32).unwrap_or(usize::MAX);
        let Some(last) = out.last().copied().filter(|_| out.len() > start) else {
            return Err("a run before any texel");
        };
        if count > end - out.len() {
            return Err("a run passes the end");
        }
        out.resize(out.len() + count, last);
        shift += 8;
    }
    Ok(bytes)
}

const CUT: &str = "cut short";

/// `mantissa * 2^(exponent - 128 - 8)`; 0 for exponent 0. The half step that Ward adds to a mantissa is left out, as
/// in all common readers, so that black stays black.
fn decode([r, g, b, exponent]: [u8; 4]) -> Vec3 {
    if exponent == 0 {
        return Vec3::ZERO;
    }
    // Through f64: the scale alone would be subnormal in f32.
    let scale = f64::from(i32::from(exponent) - 136).exp2();
    Vec3::from([r, g, b].map(|m| (f64::from(m) * scale) as f32))
}
