use ::exr::prelude as e;
use glam::Vec3;

use super::environment_from_bytes;
use crate::import::Budget;
use crate::import::tests::survive;

fn hdr(header: &str, resolution: &str, pixels: &[u8]) -> Vec<u8> {
    let end = if header.is_empty() { "" } else { "\n" };
    [format!("#?RADIANCE\n{header}{end}\n{resolution}\n").as_bytes(), pixels].concat()
}

/// Red, green / blue, white: four texels whose places can be told apart.
const PIXELS: [[u8; 4]; 4] = [[128, 0, 0, 129], [0, 128, 0, 129], [0, 0, 128, 129], [128, 128, 128, 129]];
const RED: Vec3 = Vec3::X;
const GREEN: Vec3 = Vec3::Y;
const BLUE: Vec3 = Vec3::Z;
const WHITE: Vec3 = Vec3::ONE;

fn read(bytes: &[u8]) -> (crate::scene::Environment, Vec<String>) {
    let (environment, notices) = environment_from_bytes(bytes, "sky.hdr", &Budget::default()).unwrap();
    (environment, notices.iter().map(ToString::to_string).collect())
}

fn refusal(bytes: &[u8]) -> String {
    environment_from_bytes(bytes, "sky.hdr", &Budget::default()).unwrap_err().to_string()
}

#[test]
fn every_orientation_of_an_hdr_comes_out_upright() {
    let pixels = PIXELS.as_flattened();
    for (resolution, expected) in [
        ("-Y 2 +X 2", [RED, GREEN, BLUE, WHITE]),
        ("+Y 2 +X 2", [BLUE, WHITE, RED, GREEN]),
        ("-Y 2 -X 2", [GREEN, RED, WHITE, BLUE]),
        ("+Y 2 -X 2", [WHITE, BLUE, GREEN, RED]),
        ("+X 2 -Y 2", [RED, BLUE, GREEN, WHITE]),
        ("-X 2 -Y 2", [BLUE, RED, WHITE, GREEN]),
        ("+X 2 +Y 2", [GREEN, WHITE, RED, BLUE]),
        ("-X 2 +Y 2", [WHITE, GREEN, BLUE, RED]),
    ] {
        let (environment, _) = read(&hdr("FORMAT=32-bit_rle_rgbe", resolution, pixels));
        assert_eq!(*environment.texels, expected, "{resolution}");
    }
}

#[test]
fn sides_that_differ_are_kept_apart_for_rows_and_columns() {
    let pixels = [PIXELS[0], PIXELS[1], PIXELS[2], PIXELS[3], PIXELS[3], PIXELS[3]];
    let (environment, notices) = read(&hdr("", "-Y 2 +X 3", pixels.as_flattened()));
    assert_eq!((environment.width, environment.height), (3, 2));
    assert!(notices.iter().any(|n| n.contains("3x2 is not 2:1")), "{notices:?}");
    let (environment, _) = read(&hdr("", "+X 2 -Y 3", pixels.as_flattened()));
    assert_eq!((environment.width, environment.height), (2, 3));
    assert_eq!(*environment.texels, [RED, WHITE, GREEN, WHITE, BLUE, WHITE]);
}

#[test]
fn both_run_length_forms_of_hdr_decode() {
    // Newer: per channel, a run of 8 or a literal of 8.
    let mut pixels = vec![2, 2, 0, 8, 136, 128, 8, 1, 2, 3, 4, 5, 6, 7, 128, 136, 0, 136, 129];
    let (environment, _) = read(&hdr("", "-Y 1 +X 8", &pixels));
    assert_eq!(environment.texels[7], Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(environment.texels[0], Vec3::new(1.0, 1.0 / 128.0, 0.0));
    // Older: a texel, then "repeat 2 + 256 times".
    pixels = [[128, 128, 128, 129], [1, 1, 1, 2], [1, 1, 1, 1]].concat();
    let (environment, _) = read(&hdr("", "-Y 1 +X 259", &pixels));
    assert!(environment.texels.iter().all(|t| *t == WHITE));
}

#[test]
fn exposure_lines_multiply_and_are_divided_out() {
    let (environment, _) = read(&hdr("EXPOSURE=2\nEXPOSURE=4", "-Y 2 +X 2", PIXELS.as_flattened()));
    assert_eq!(environment.texels[3], WHITE / 8.0);
}

#[test]
fn faulty_hdr_files_are_refused_in_words() {
    let long = format!("#?RADIANCE\n# {}\n\n-Y 1 +X 1\n", "x".repeat(1 << 20));
    for (bytes, words) in [
        (hdr("", "-Y 60000 +X 60000", &[]), "3600000000 pixels; the limit is"),
        (hdr("", "-Y 0 +X 0", &[]), "the size is 0x0"),
        (hdr("", "-Y 2 +X 2", &[1, 2, 3]), "scanline 0 of 2: cut short"),
        (hdr("", "-Y 1 +X 8", &[2, 2, 0, 8, 255, 1]), "a run is empty or passes the end"),
        (hdr("", "-Y 1 +X 8", &[2, 2, 0, 9]), "states another length"),
        (hdr("", "-Y 1 +X 8", &[2, 2, 0, 8, 0, 0, 0]), "a run is empty or passes the end"),
        (hdr("", "-Y 1 +X 2", &[1, 1, 1, 2]), "a run before any texel"),
        (
            hdr("", "-Y 1 +X 9", &[9, 9, 9, 9, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 1]),
            "passes the end",
        ),
        (hdr("FORMAT=32-bit_rle_xyze", "-Y 2 +X 2", &[]), "XYZE"),
        (hdr("EXPOSURE=0", "-Y 2 +X 2", &[]), "EXPOSURE"),
        (hdr("", "-Y 99999999999 +X 2", &[]), "is not a resolution"),
        (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n-Y 1 +X 1\n".to_vec(), "no blank line"),
        (b"#?RADIANCE\n".to_vec(), "header: cut short"),
        (long.into_bytes(), "longer than 64 KiB"),
        (b"<!DOCTYPE html><html>".to_vec(), "an HTML page, not a Radiance HDR or OpenEXR picture"),
        (b"version https://git-lfs.github.com/spec/v1\n".to_vec(), "Git LFS pointer"),
        (b"\x89PNG\r\n\x1a\n".to_vec(), "a PNG picture"),
        (Vec::new(), "the content is empty"),
    ] {
        let text = refusal(&bytes);
        assert!(text.contains(words) && text.starts_with("sky.hdr: file: "), "{text:?} lacks {words:?}");
    }
}

/// An EXR of 4x2 pixels with the given channels.
fn exr(channels: Vec<(&str, e::FlatSamples)>, encoding: e::Encoding) -> Vec<u8> {
    layers(vec![("", channels)], encoding)
}

fn layers(layers: Vec<(&str, Vec<(&str, e::FlatSamples)>)>, encoding: e::Encoding) -> Vec<u8> {
    let layers: Vec<_> = layers
        .into_iter()
        .map(|(name, channels)| {
            let channels = channels.into_iter().map(|(name, data)| e::AnyChannel::new(name, data)).collect();
            let attributes = if name.is_empty() { Default::default() } else { e::LayerAttributes::named(name) };
            e::Layer::new((4, 2), attributes, encoding, e::AnyChannels::sort(channels))
        })
        .collect();
    let attributes = e::ImageAttributes::with_size((4, 2));
    let mut file = std::io::Cursor::new(Vec::new());
    e::WritableImage::write(&e::Image::from_layers(attributes, layers)).to_buffered(&mut file).unwrap();
    file.into_inner()
}

fn float(value: f32) -> e::FlatSamples {
    e::FlatSamples::F32(vec![value; 8])
}

fn half(value: f32) -> e::FlatSamples {
    e::FlatSamples::F16(vec![e::f16::from_f32(value); 8])
}

fn plain() -> e::Encoding {
    e::Encoding::UNCOMPRESSED
}

#[test]
fn every_compression_of_exr_decodes() {
    use e::Compression as C;
    let list =
        [C::Uncompressed, C::RLE, C::ZIP1, C::ZIP16, C::PIZ, C::PXR24, C::B44, C::B44A, C::DWAA(None), C::DWAB(None)];
    for compression in list {
        for tiled in [false, true] {
            let blocks = if tiled { e::Blocks::Tiles(e::Vec2(2, 2)) } else { e::Blocks::ScanLines };
            let encoding = e::Encoding { compression, blocks, line_order: e::LineOrder::Increasing };
            let bytes = exr(vec![("R", half(0.5)), ("G", half(1.0)), ("B", half(2.0))], encoding);
            let (environment, _) = read(&bytes);
            for t in environment.texels.iter() {
                // The lossy ones keep about two digits.
                assert!(t.abs_diff_eq(Vec3::new(0.5, 1.0, 2.0), 0.02), "{compression:?}, tiled {tiled}: {t}");
            }
        }
    }
}

#[test]
fn half_float_and_integer_channels_mix_and_luminance_is_grey() {
    let integers = e::FlatSamples::U32(vec![7; 8]);
    let bytes = exr(vec![("R", half(0.5)), ("G", float(1e6)), ("B", integers), ("A", half(0.0))], plain());
    assert_eq!(read(&bytes).0.texels[3], Vec3::new(0.5, 1e6, 7.0));
    assert_eq!(read(&exr(vec![("Y", float(3.0))], plain())).0.texels[0], Vec3::splat(3.0));
}

#[test]
fn the_picture_is_found_among_layers_and_named() {
    let prefixed = vec![("Z", float(9.0)), ("fill.light.R", float(1.0)), ("fill.light.G", float(2.0))];
    let bytes = exr([prefixed, vec![("fill.light.B", float(3.0))]].concat(), plain());
    let (environment, notices) = read(&bytes);
    assert_eq!(environment.texels[0], Vec3::new(1.0, 2.0, 3.0));
    assert!(notices.iter().any(|n| n.contains("layer 'fill.light' is shown")), "{notices:?}");

    let rgb = vec![("R", float(1.0)), ("G", float(2.0)), ("B", float(3.0))];
    let (environment, notices) = read(&layers(vec![("depth", vec![("Z", float(9.0))]), ("beauty", rgb)], plain()));
    assert_eq!(environment.texels[0], Vec3::new(1.0, 2.0, 3.0));
    assert!(notices.iter().any(|n| n.contains("layer 'beauty' is shown")), "{notices:?}");
}

#[test]
fn exr_files_that_cannot_be_shown_are_refused_in_words() {
    let rgb = || vec![("R", half(1.0)), ("G", half(1.0)), ("B", half(1.0))];
    let text = refusal(&exr(vec![("Z", float(1.0))], plain()));
    assert!(text.contains("has no R, G, B or Y channels, only 'Z'"), "{text}");
    let text = refusal(&exr(vec![("Y", half(1.0)), ("RY", half(1.0)), ("BY", half(1.0))], plain()));
    assert!(text.contains("luminance and chroma"), "{text}");

    let mut deep = exr(rgb(), plain());
    deep[5] |= 0x08;
    assert!(refusal(&deep).contains("deep data"));

    // The same file with a data window of 100 000 x 100 000: patched where the attribute's value lies.
    let mut huge = exr(rgb(), plain());
    let at = huge.windows(11).position(|w| w == b"dataWindow\0").unwrap() + 11 + 6 + 4;
    for (i, corner) in [0_i32, 0, 99_999, 99_999].into_iter().enumerate() {
        huge[at + 4 * i..at + 4 * i + 4].copy_from_slice(&corner.to_le_bytes());
    }
    let text = refusal(&huge);
    assert!(text.contains("asks for 10000000000 pixels; the limit is 268435456"), "{text}");
    for window in [[5, 5, 1, 1], [i32::MIN, i32::MIN, i32::MAX, i32::MAX], [0, 0, i32::MAX, 0]] {
        for (i, corner) in window.into_iter().enumerate() {
            huge[at + 4 * i..at + 4 * i + 4].copy_from_slice(&corner.to_le_bytes());
        }
        let text = refusal(&huge);
        assert!(text.starts_with("sky.hdr: file: "), "{window:?}: {text}");
    }
}

#[test]
fn bad_values_are_repaired_and_counted() {
    let values = vec![f32::NAN, f32::INFINITY, -1.0, 1e30, f32::NEG_INFINITY, 0.0, 1.0, 2.0];
    let bytes = exr(vec![("Y", e::FlatSamples::F32(values))], plain());
    let (environment, notices) = read(&bytes);
    let repaired: Vec<f32> = environment.texels.iter().map(|t| t.x).collect();
    assert_eq!(repaired, [0.0, 1e30, 0.0, 1e30, 0.0, 0.0, 1.0, 2.0]);
    for words in ["not numbers were set to 0 (3 times)", "negative values were set to 0 (6 times)", "infinite"] {
        assert!(notices.iter().any(|n| n.contains(words)), "{notices:?} lack {words}");
    }
    let (_, notices) = read(&exr(vec![("Y", float(0.0))], plain()));
    assert!(notices.iter().any(|n| n.contains("black everywhere")), "{notices:?}");
}

/// The panic is an overflow, which release builds do not check.
#[cfg(debug_assertions)]
#[test]
fn a_panic_of_the_decoder_is_a_fault_of_the_file() {
    let blocks = e::Blocks::Tiles(e::Vec2(2, 2));
    let encoding = e::Encoding { compression: e::Compression::B44, blocks, line_order: e::LineOrder::Increasing };
    let mut bytes = exr(vec![("R", half(0.5)), ("G", float(1.0)), ("B", half(2.0))], encoding);
    // Tiles of 99 pixels across in a picture of 4, and no stated number of chunks that would contradict.
    let place = |word: &[u8]| bytes.windows(word.len()).position(|w| w == word).unwrap();
    let (width, count) = (place(b"tiledesc\0") + 9 + 4, place(b"chunkCount"));
    bytes[width] = 99;
    bytes[count] = b'x';
    let text = refusal(&bytes);
    assert!(text.starts_with("sky.hdr: file: the decoder failed on the content"), "{text}");
}

#[test]
fn mutated_exr_files_never_panic() {
    use e::Compression as C;
    let budget = Budget { pixels: 1 << 16, ..Budget::default() };
    for compression in [C::Uncompressed, C::RLE, C::ZIP16, C::PIZ, C::PXR24, C::B44, C::DWAA(None)] {
        for blocks in [e::Blocks::ScanLines, e::Blocks::Tiles(e::Vec2(2, 2))] {
            let encoding = e::Encoding { compression, blocks, line_order: e::LineOrder::Increasing };
            let source = exr(vec![("R", half(0.5)), ("G", float(1.0)), ("B", half(2.0))], encoding);
            survive(&source, 6, 500, |bytes| drop(environment_from_bytes(bytes, "sky.exr", &budget)));
        }
    }
}
