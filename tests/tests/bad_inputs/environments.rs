//! Environments: false sizes, other encodings, odd channels and values that are no radiance.

use burnish_core::import::{Budget, environment_from_bytes};
use burnish_core::scene::Environment;

use crate::sources::refused_bytes;

fn hdr(header: &str, resolution: &str, pixels: &[u8]) -> Vec<u8> {
    [format!("#?RADIANCE\n{header}\n{resolution}\n").as_bytes(), pixels].concat()
}

fn shown(bytes: &[u8], name: &str) -> (Environment, Vec<String>) {
    let (environment, notices) = environment_from_bytes(bytes, name, &Budget::default()).expect("shown");
    (environment, notices.iter().map(ToString::to_string).collect())
}

/// An uncompressed scanline EXR written by hand: float channels of 2x1 pixels with the given names, in sorted order.
struct Exr {
    version: u32,
    channels: Vec<String>,
    /// Steps in x and y between samples.
    sampling: i32,
    window: [i32; 4],
    /// Offset of the one scanline; that of the data when `None`.
    offset: Option<u64>,
    /// Bytes that the scanline states; the true number when `None`.
    size: Option<u32>,
    values: Vec<f32>,
}

impl Exr {
    fn new(channels: &[&str], values: &[f32]) -> Exr {
        Exr {
            version: 2,
            channels: channels.iter().map(|c| c.to_string()).collect(),
            sampling: 1,
            window: [0, 0, 1, 0],
            offset: None,
            size: None,
            values: values.to_vec(),
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut file = 0x0131_2f76_u32.to_le_bytes().to_vec();
        file.extend(self.version.to_le_bytes());
        let mut attribute = |name: &str, kind: &str, value: &[u8]| {
            file.extend(name.bytes().chain([0]).chain(kind.bytes()).chain([0]));
            file.extend((value.len() as u32).to_le_bytes());
            file.extend(value);
        };
        let mut list = Vec::new();
        for name in &self.channels {
            list.extend(name.bytes().chain([0]));
            for word in [2, 0, self.sampling, self.sampling] {
                list.extend(i32::to_le_bytes(word));
            }
        }
        list.push(0);
        attribute("channels", "chlist", &list);
        attribute("compression", "compression", &[0]);
        attribute("dataWindow", "box2i", &self.window.map(i32::to_le_bytes).concat());
        attribute("displayWindow", "box2i", &[0, 0, 1, 0].map(i32::to_le_bytes).concat());
        attribute("lineOrder", "lineOrder", &[0]);
        attribute("pixelAspectRatio", "float", &1_f32.to_le_bytes());
        attribute("screenWindowCenter", "v2f", &[0; 8]);
        attribute("screenWindowWidth", "float", &1_f32.to_le_bytes());
        file.push(0);
        let start = file.len() as u64 + 8;
        file.extend(self.offset.unwrap_or(start).to_le_bytes());
        file.extend(0_i32.to_le_bytes());
        file.extend(self.size.unwrap_or(4 * self.values.len() as u32).to_le_bytes());
        file.extend(self.values.iter().flat_map(|v| v.to_le_bytes()));
        file
    }
}

/// Two grey pixels.
fn grey(values: [f32; 2]) -> Exr {
    Exr::new(&["Y"], &values)
}

#[test]
fn hdr_files_with_false_headers_or_pixels_are_refused() {
    let comment = format!("#?RADIANCE\n# {}\n\n-Y 1 +X 1\n", "x".repeat(1 << 20));
    for (bytes, words) in [
        (hdr("", "-Y 60000 +X 60000", &[]), "asks for 3600000000 pixels; the limit is 268435456"),
        (hdr("", "-Y 0 +X 0", &[]), "the size is 0x0"),
        (hdr("", "-Y 1 +X 8", &[2, 2, 0, 8, 255, 1]), "scanline 0 of 1: a run is empty or passes the end"),
        (hdr("", "-Y 1 +X 8", &[2, 2, 0, 8, 0, 0, 0]), "a run is empty"),
        (hdr("", "-Y 1 +X 2", &[9, 9, 9, 9, 1, 1, 1, 255]), "a run passes the end"),
        (hdr("", "-Y 9 +X 9", &[9; 40]), "scanline 1 of 9: cut short"),
        (hdr("FORMAT=32-bit_rle_xyze\n", "-Y 1 +X 1", &[0; 4]), "the pixels are XYZE"),
        (b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n-Y 1 +X 1\n0000".to_vec(), "no blank line before the resolution"),
        (comment.into_bytes(), "header: longer than 64 KiB"),
    ] {
        refused_bytes(&bytes, "sky.hdr", &["file", words]);
    }
    let flipped = hdr("", "+Y 2 -X 1", &[128, 0, 0, 129, 0, 128, 0, 129]);
    assert_eq!(shown(&flipped, "sky.hdr").0.texels.iter().map(|t| t.x).collect::<Vec<_>>(), [0.0, 1.0]);
}

#[test]
fn exr_windows_chunks_and_offsets_that_are_false_are_refused_before_memory_is_taken() {
    assert_eq!(shown(&grey([1.0, 2.0]).bytes(), "sky.exr").0.texels[1].x, 2.0);
    let huge = Exr { window: [0, 0, 99_999, 99_999], ..grey([0.0; 2]) }.bytes();
    assert!(huge.len() < 400, "{}", huge.len());
    refused_bytes(&huge, "sky.exr", &["file", "asks for 10000000000 pixels; the limit is 268435456"]);
    for window in [[i32::MIN, i32::MIN, i32::MAX, i32::MAX], [5, 5, 1, 1], [0, 0, i32::MAX, 0], [i32::MAX; 4]] {
        refused_bytes(&Exr { window, ..grey([0.0; 2]) }.bytes(), "sky.exr", &["file"]);
    }
    refused_bytes(
        &Exr { window: [0, 0, 3, 16_383], ..grey([0.0; 2]) }.bytes(),
        "sky.exr",
        &["file", "states 16384 chunks"],
    );
    refused_bytes(&Exr { size: Some(1 << 31), ..grey([0.0; 2]) }.bytes(), "sky.exr", &["file", "OpenEXR"]);
    let whole = grey([1.0, 2.0]).bytes();
    for end in 4..whole.len() {
        refused_bytes(&whole[..end], "sky.exr", &["file"]);
    }
    // Blocks are read in the order of the file; a false table of offsets is no harm.
    let _ = environment_from_bytes(
        &Exr { offset: Some(u64::MAX), ..grey([0.0; 2]) }.bytes(),
        "sky.exr",
        &Budget::default(),
    );
}

#[test]
fn exr_kinds_that_are_no_picture_are_refused_by_name() {
    refused_bytes(&Exr { version: 0x802, ..grey([0.0; 2]) }.bytes(), "sky.exr", &["file", "deep data"]);
    refused_bytes(&Exr::new(&["Z"], &[0.0; 2]).bytes(), "sky.exr", &["file", "no R, G, B or Y channels, only 'Z'"]);
    let chroma = Exr::new(&["BY", "RY", "Y"], &[0.0; 6]).bytes();
    refused_bytes(&chroma, "sky.exr", &["file", "luminance and chroma"]);
    refused_bytes(&Exr { sampling: 2, ..grey([0.0; 2]) }.bytes(), "sky.exr", &["file", "subsampl"]);
    let names: Vec<String> = (0..1025).map(|i| format!("c{i:04}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    refused_bytes(&Exr::new(&names, &[0.0; 2050]).bytes(), "sky.exr", &["file", "asks for 1025 channels"]);

    let dotted = Exr::new(&["a.b.B", "a.b.G", "a.b.R"], &[3.0, 3.0, 2.0, 2.0, 1.0, 1.0]).bytes();
    let (environment, notices) = shown(&dotted, "sky.exr");
    assert_eq!(environment.texels[0].to_array(), [1.0, 2.0, 3.0]);
    assert!(notices.iter().any(|n| n.contains("layer 'a.b' is shown")), "{notices:?}");
}

#[test]
fn values_that_are_no_radiance_are_repaired_and_counted() {
    for (values, repaired, words) in [
        ([f32::NAN, 1.0], [0.0, 1.0], "sky.exr: pixels: values that were not numbers were set to 0"),
        ([-1.0, 1e30], [0.0, 1e30], "negative values were set to 0"),
        ([f32::INFINITY, 2.0], [2.0, 2.0], "infinite values were set to the largest finite one, 2"),
        ([f32::NEG_INFINITY, 0.0], [0.0, 0.0], "the picture is black everywhere"),
    ] {
        let (environment, notices) = shown(&grey(values).bytes(), "sky.exr");
        assert_eq!(environment.texels.iter().map(|t| t.x).collect::<Vec<_>>(), repaired);
        assert!(notices.iter().any(|n| n.contains(words)), "{notices:?} lack {words}");
    }
}

#[test]
fn odd_sizes_are_read_and_all_but_2_to_1_are_noticed() {
    for (width, height) in [(1_usize, 1_usize), (2, 1), (3, 5), (65_536, 1)] {
        let pixels = [128, 128, 128, 129].repeat(width * height);
        let (environment, notices) = shown(&hdr("", &format!("-Y {height} +X {width}"), &pixels), "sky.hdr");
        assert_eq!(environment.texels.len(), width * height);
        let noticed = notices.iter().any(|n| n.contains(&format!("sky.hdr: size: {width}x{height} is not 2:1")));
        assert_eq!(noticed, width != 2 * height, "{notices:?}");
    }
}
