//! Radiance RGBE pictures, and environments as files.

use std::path::Path;

use glam::Vec3;

use super::{FileError, atomic, write_exr};
use crate::picture::Picture;
use crate::scene::Environment;

/// Widths that lines with runs can have.
const RUN_WIDTHS: std::ops::RangeInclusive<u32> = 8..=0x7fff;
/// Shortest run worth its count.
const RUN_MIN: usize = 4;

/// Writes a map of radiance in nit as `.hdr` (8 bits of mantissa: each channel within 0.4 % of the texel's largest) or
/// `.exr` (32-bit floats): as it lights a scene with its strength and tint, but not turned.
pub fn write_environment(map: &Environment, path: &Path) -> Result<(), FileError> {
    let whole = u64::from(map.width) * u64::from(map.height);
    if whole == 0 || map.texels.len() as u64 != whole {
        let reason = format!("the map is {} x {} with {} texels", map.width, map.height, map.texels.len());
        return Err(FileError::new(path, reason, "give it at least one texel and as many as its size says"));
    }
    let scale = map.scale();
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match ending.as_deref() {
        Some("hdr") => {
            atomic::write_atomic(path, &encode(map.width, map.height, map.texels.iter().map(|t| scale * *t)))
        }
        Some("exr") => {
            let texels = map.texels.iter().map(|t| (scale * *t).extend(1.0)).collect();
            write_exr(&Picture { width: map.width, height: map.height, texels }, path)
        }
        _ => Err(FileError::new(path, "the name has no ending of an environment", "use .hdr or .exr")),
    }
}

/// The bytes of a file with rows from the top. Ward 1991, Real Pixels, Graphics Gems II.
fn encode(width: u32, height: u32, texels: impl Iterator<Item = Vec3>) -> Vec<u8> {
    let software = concat!("Burnish ", env!("CARGO_PKG_VERSION"));
    let mut bytes = format!(
        "#?RADIANCE\nSOFTWARE={software}\nPRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n\
         FORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    )
    .into_bytes();
    let words: Vec<[u8; 4]> = texels.map(rgbe).collect();
    for line in words.chunks(width.max(1) as usize) {
        if !RUN_WIDTHS.contains(&width) {
            bytes.extend(line.iter().flatten());
            continue;
        }
        bytes.extend([2, 2, (width >> 8) as u8, width as u8]);
        for channel in 0..4 {
            let values: Vec<u8> = line.iter().map(|word| word[channel]).collect();
            runs(&values, &mut bytes);
        }
    }
    bytes
}

/// Three mantissas with the exponent of the largest, rounded to the nearest; negative values and none are 0.
fn rgbe(color: Vec3) -> [u8; 4] {
    let color = Vec3::from_array(color.to_array().map(|v| if v > 0.0 { v.min(1e38) } else { 0.0 }));
    let largest = f64::from(color.max_element());
    if largest < 1e-38 {
        return [0; 4];
    }
    // largest = m 2^e, m in [1/2, 1).
    let mut exponent = largest.log2().floor() as i32 + 1;
    if (largest * 256.0 * f64::from(-exponent).exp2()).round() >= 256.0 {
        exponent += 1;
    }
    let scale = 256.0 * f64::from(-exponent).exp2();
    let [r, g, b] = color.to_array().map(|v| (f64::from(v) * scale).round() as u8);
    let stored = (exponent + 128).clamp(0, 255) as u8;
    [r, g, b, stored]
}

/// Runs of equal bytes as a count over 128 and the byte, others as a count and the bytes.
fn runs(values: &[u8], bytes: &mut Vec<u8>) {
    let run_at = |at: usize| values[at..].iter().take(127).take_while(|v| **v == values[at]).count();
    let mut at = 0;
    while at < values.len() {
        let run = run_at(at);
        if run >= RUN_MIN {
            bytes.extend([128 + run as u8, values[at]]);
            at += run;
            continue;
        }
        let start = at;
        while at < values.len() && at - start < 128 && run_at(at) < RUN_MIN {
            at += 1;
        }
        bytes.push((at - start) as u8);
        bytes.extend(&values[start..at]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::testing::Folder;
    use crate::import::load_environment;
    use crate::math::sampling::Random;

    fn noise(width: u32, height: u32) -> Environment {
        let mut random = Random::new(7);
        let mut texel = |i: u32| {
            let flat = (i / 40).is_multiple_of(2);
            let size = (20.0 * random.unit() - 6.0).exp2();
            if flat { Vec3::new(0.5, 0.25, 0.0) } else { size * random.point3() }
        };
        Environment::new("noise", width, height, (0..width * height).map(&mut texel).collect())
    }

    #[test]
    fn maps_are_read_as_they_were_written() {
        let folder = Folder::new();
        for (width, height) in [(256, 128), (4, 2), (9, 3)] {
            let tint = Vec3::new(1.0, 0.5, 2.0);
            let map = Environment { strength: 3.0, tint, rotation: 1.0, ..noise(width, height) };
            for (name, error) in [("a.hdr", 0.004), ("a.exr", 1e-6)] {
                let file = folder.join(name);
                write_environment(&map, &file).unwrap();
                let read = load_environment(&file).unwrap().0;
                assert_eq!((read.width, read.height), (width, height));
                let mut worst = 0.0f32;
                for (a, b) in map.texels.iter().zip(&*read.texels) {
                    let wanted = map.scale() * *a;
                    worst = worst.max((wanted - *b).abs().max_element() / wanted.max_element().max(1e-6));
                }
                println!("{name} {width}x{height}: {worst:.2e}");
                assert!(worst <= error, "{name} {width}x{height}: {worst}");
            }
        }
    }

    #[test]
    fn extremes_are_stored_as_the_nearest_that_there_is() {
        assert_eq!(rgbe(Vec3::ONE), [128, 128, 128, 129]);
        assert_eq!(rgbe(Vec3::ZERO), [0; 4]);
        assert_eq!(rgbe(Vec3::new(-1.0, f32::NAN, 0.0)), [0; 4]);
        // Rounds up to the next exponent.
        assert_eq!(rgbe(Vec3::new(0.999, 0.0, 0.0)), [128, 0, 0, 129]);
        assert!(rgbe(Vec3::splat(f32::INFINITY))[3] == 255);
    }

    #[test]
    fn names_and_maps_that_are_none_are_refused() {
        let folder = Folder::new();
        assert!(write_environment(&noise(8, 4), &folder.join("a.png")).is_err());
        let empty = Environment::new("", 3, 2, Vec::new());
        assert!(write_environment(&empty, &folder.join("a.hdr")).is_err());
    }
}
