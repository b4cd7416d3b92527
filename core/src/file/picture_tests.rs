use glam::{Vec3, Vec4};

use super::*;
use crate::color::rgb::linear_from_srgb;
use crate::file::testing::Folder;

/// Colours from black to far above white.
fn gradient(width: u32, height: u32) -> Picture {
    Picture::from_fn(width, height, |x, y| Vec4::new(x as f32 / 7.0, y as f32 / 3.0, (x * y) as f32 * 0.01, 1.0))
}

#[test]
fn exr_gives_back_every_bit() {
    let folder = Folder::new();
    let path = folder.join("a.exr");
    let mut picture = gradient(19, 33);
    picture.texels[5] = Vec4::new(1e-30, -2.0, 1e30, 1.0);
    write_exr(&picture, &path).unwrap();
    assert_eq!(read_picture(&path).unwrap(), (picture.clone(), Encoding::Linear));
    picture.texels[7] = Vec4::new(0.1, 0.2, 0.3, 0.5);
    write_exr(&picture, &path).unwrap();
    assert_eq!(read_picture(&path).unwrap(), (picture, Encoding::Linear));
}

#[test]
fn png_shows_the_tone_mapped_picture_and_says_how_it_was_made() {
    let folder = Folder::new();
    let path = folder.join("a.png");
    write_png(&Picture::filled(3, 2, Vec4::new(0.25, 0.5, 1.0, 1.0)), &path, ToneMap::None, -1.0).unwrap();
    let (picture, encoding) = read_picture(&path).unwrap();
    assert_eq!((encoding, picture.width, picture.height), (Encoding::Display, 3, 2));
    // Half the light, within half of one of 255 levels where they are widest (slope 2.27 at white).
    let error = picture.texels[0] - Vec4::new(0.125, 0.25, 0.5, 1.0);
    assert!(error.abs().max_element() < 0.5 * 2.3 / 255.0, "{error}");

    let bytes = std::fs::read(&path).unwrap();
    let reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let text = |key: &str| {
        let texts = &reader.info().uncompressed_latin1_text;
        texts.iter().find(|t| t.keyword == key).map(|t| t.text.clone()).unwrap_or_default()
    };
    assert_eq!((text(png::KEY_VIEW), text(png::KEY_EXPOSURE)), ("none".into(), "-1".into()));
}

#[test]
fn a_png_that_was_read_is_written_again_with_the_same_bytes() {
    let folder = Folder::new();
    let (first, second) = (folder.join("a.png"), folder.join("b.png"));
    let mut picture = gradient(16, 16);
    picture.texels[3] = Vec4::new(0.2, 0.1, 0.0, 0.25);
    picture.texels[4] = Vec4::ZERO;
    write_png(&picture, &first, ToneMap::Neutral, 0.0).unwrap();
    let (read, _) = read_picture(&first).unwrap();
    write_png(&read, &second, ToneMap::None, 0.0).unwrap();
    let pixels = |path: &Path| {
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(std::fs::read(path).unwrap())).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut data).unwrap();
        data
    };
    assert_eq!(pixels(&first), pixels(&second));
}

#[test]
fn the_content_of_a_file_counts_and_not_its_name() {
    let folder = Folder::new();
    write_png(&gradient(2, 2), &folder.join("a.png"), ToneMap::None, 0.0).unwrap();
    std::fs::rename(folder.join("a.png"), folder.join("a.exr")).unwrap();
    assert_eq!(read_picture(&folder.join("a.exr")).unwrap().1, Encoding::Display);
}

#[test]
fn sixteen_bit_grey_is_read_with_all_its_levels() {
    let folder = Folder::new();
    let path = folder.join("grey.png");
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(::png::ColorType::Grayscale);
    encoder.set_depth(::png::BitDepth::Sixteen);
    encoder.write_header().unwrap().write_image_data(&[0x80, 0x01, 0x80, 0x02]).unwrap();
    std::fs::write(&path, bytes).unwrap();
    let (picture, _) = read_picture(&path).unwrap();
    let expected = linear_from_srgb(Vec3::splat(32769.0 / 65535.0));
    assert!((picture.texels[0].truncate() - expected).abs().max_element() < 1e-7);
    assert!(picture.texels[1].x > picture.texels[0].x);
}

#[test]
fn a_header_that_claims_too_many_pixels_is_refused_before_memory_is_taken() {
    let folder = Folder::new();
    // A PNG header of 60 000 x 60 000, and nothing else.
    let mut bytes = Vec::new();
    let encoder = ::png::Encoder::new(&mut bytes, 60_000, 60_000);
    drop(encoder.write_header().unwrap());
    std::fs::write(folder.join("large.png"), &bytes).unwrap();
    let error = read_picture(&folder.join("large.png")).unwrap_err().to_string();
    assert!(error.contains("60000 x 60000") && error.contains("over the limit"), "{error}");

    // An OpenEXR of one pixel whose windows are made to say 100 000 x 100 000.
    write_exr(&Picture::filled(1, 1, Vec4::ONE), &folder.join("one.exr")).unwrap();
    let mut bytes = std::fs::read(folder.join("one.exr")).unwrap();
    for name in [&b"dataWindow\0box2i\0"[..], &b"displayWindow\0box2i\0"[..]] {
        let at = bytes.windows(name.len()).position(|w| w == name).unwrap() + name.len() + 4 + 8;
        bytes[at..at + 8].copy_from_slice(&[0x9f, 0x86, 1, 0, 0x9f, 0x86, 1, 0]);
    }
    std::fs::write(folder.join("large.exr"), &bytes).unwrap();
    let error = read_picture(&folder.join("large.exr")).unwrap_err().to_string();
    assert!(error.contains("100000 x 100000") && error.contains("over the limit"), "{error}");
}

#[test]
fn a_file_that_is_no_picture_is_named_by_its_content() {
    let folder = Folder::new();
    let say = |name: &str, bytes: &[u8]| {
        std::fs::write(folder.join(name), bytes).unwrap();
        let text = read_picture(&folder.join(name)).unwrap_err().to_string();
        assert!(text.contains(name) && text.contains("; use"), "{text}");
        text
    };
    assert!(say("a.png", b"").contains("empty"));
    assert!(say("b.exr", b"<html>").contains("markup"));
    assert!(say("c.png", b"version https://git-lfs.github.com/spec/v1").contains("LFS"));
    assert!(say("d.hdr", b"#?RADIANCE").contains("Radiance"));
    assert!(say("e.png", b"\x89PNG\r\n\x1a\n").contains("damaged PNG"));
}

#[test]
fn an_exr_without_colour_is_refused_with_the_channels_it_has() {
    use ::exr::prelude::*;
    let folder = Folder::new();
    let depth = SpecificChannels::build().with_channel("Z").with_pixel_fn(|_: Vec2<usize>| (1.0_f32,));
    Image::from_channels((4, 4), depth).write().to_file(folder.join("z.exr")).unwrap();
    let error = read_picture(&folder.join("z.exr")).unwrap_err().to_string();
    assert!(error.contains("R, G, B (it has Z)"), "{error}");
}

#[test]
fn damage_at_any_byte_never_panics_and_a_cut_file_is_refused() {
    let folder = Folder::new();
    let picture = gradient(9, 20);
    for name in ["a.png", "a.exr"] {
        write_picture(&picture, &folder.join(name), ToneMap::None, 0.0).unwrap();
        let whole = std::fs::read(folder.join(name)).unwrap();
        let decode = |bytes: &[u8]| if name == "a.png" { png::decode(bytes) } else { exr::decode(bytes) };
        for at in 0..whole.len() {
            for value in [0x00, 0x01, 0x7f, 0x80, 0xff, !whole[at]] {
                let mut bytes = whole.clone();
                bytes[at] = value;
                let _ = decode(&bytes);
            }
            // The last 12 bytes of a PNG mark its end and hold no pixels.
            let pixels_are_whole = name == "a.png" && at + 12 >= whole.len();
            assert!(pixels_are_whole || decode(&whole[..at]).is_err(), "{name} cut at {at} of {}", whole.len());
        }
    }
}

#[test]
fn names_and_pictures_that_cannot_be_written_are_refused() {
    let folder = Folder::new();
    let picture = Picture::filled(1, 1, Vec4::ONE);
    let write = |name: &str| write_picture(&picture, &folder.join(name), ToneMap::None, 0.0);
    assert!(write("a.bmp").unwrap_err().to_string().contains("use .png or .exr"));
    assert!(write("a").unwrap_err().to_string().contains("no ending"));
    assert!(write("A.PNG").is_ok());
    let broken = Picture { width: 2, height: 2, texels: vec![Vec4::ONE; 3] };
    assert!(write_exr(&broken, &folder.join("b.exr")).unwrap_err().to_string().contains("2 x 2 with 3 pixels"));
    assert!(write_png(&Picture::default(), &folder.join("b.png"), ToneMap::None, 0.0).is_err());
    assert_eq!(folder.names(), ["A.PNG"]);
}

#[test]
fn channels_and_attributes_stand_beside_the_colours_and_the_bytes_are_the_same_each_time() {
    use crate::file::{Attribute, Channel, Samples, write_exr_with};
    use ::exr::meta::attribute::AttributeValue;
    use ::exr::prelude::*;
    let folder = Folder::new();
    let path = folder.join("a.exr");
    let picture = gradient(9, 20);
    let ids: Vec<u32> = (0..180).map(|i| if i == 0 { u32::MAX } else { i }).collect();
    let channels = || {
        let depth = Samples::Float((0..180).map(|i| i as f32 * 0.1).collect());
        vec![
            Channel { name: "N.X", samples: depth },
            Channel { name: "id.instance", samples: Samples::Whole(ids.clone()) },
        ]
    };
    let attributes = [
        ("burnish.samples", Attribute::Whole(64)),
        ("burnish.error", Attribute::Number(0.1)),
        ("burnish.seed", Attribute::Number(4294967295.0)),
        ("burnish.masking", Attribute::Text("größer ∞".into())),
        ("a", Attribute::Whole(-1)),
    ];
    write_exr_with(&picture, channels(), &attributes, &path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    for _ in 0..8 {
        write_exr_with(&picture, channels(), &attributes, &path).unwrap();
        assert!(std::fs::read(&path).unwrap() == bytes);
    }
    let (read, encoding) = read_picture(&path).unwrap();
    assert!(read == picture && encoding == super::Encoding::Linear);

    let image = read_all_flat_layers_from_file(&path).unwrap();
    let layer = &image.layer_data[0];
    let channel = |name: &str| &layer.channel_data.list.iter().find(|c| c.name == *name).unwrap().sample_data;
    assert_eq!(*channel("id.instance"), FlatSamples::U32(ids.clone()));
    assert!(matches!(channel("N.X"), FlatSamples::F32(values) if values[7] == 7.0 * 0.1));
    let other = |name: &str| layer.attributes.other.get(name.as_bytes()).cloned();
    assert_eq!(other("burnish.samples"), Some(AttributeValue::I32(64)));
    assert_eq!(other("burnish.error"), Some(AttributeValue::F64(0.1)));
    assert_eq!(other("burnish.masking"), Some(AttributeValue::Text(Text::from("größer ?"))));

    let short = vec![Channel { name: "Z", samples: Samples::Float(vec![0.0]) }];
    let error = write_exr_with(&picture, short, &[], &path).unwrap_err().to_string();
    assert!(error.contains("channel `Z`"), "{error}");
}
