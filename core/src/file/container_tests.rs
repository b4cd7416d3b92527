use serde_json::json;

use super::*;
use crate::file::testing::Folder;

const KIND: Kind = Kind { id: "test", version: 3 };

fn sample() -> Container {
    Container::new(KIND, json!({ "answer": 42, "name": "ü" }))
        .with("a", vec![1.5_f64, -0.0, f64::MIN_POSITIVE])
        .with("b", vec![f32::MAX, 0.1])
        .with("c", vec![7_u32, u32::MAX, 0])
        .with("d", vec![1_u8, 2, 3, 4, 5])
        .with::<f64>("none", vec![])
}

/// A file with any JSON and data, its lengths and its hash right.
fn forged(json: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend(LAYOUT.to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend((data.len() as u64).to_le_bytes());
    bytes.extend(json.as_bytes());
    bytes.extend(data);
    bytes.extend(blake3::hash(&bytes).as_bytes());
    bytes
}

#[test]
fn what_is_written_is_read_bit_for_bit() {
    let folder = Folder::new();
    let path = folder.join("a.bin");
    sample().write(&path).unwrap();
    let mut read = Container::read(&path, KIND, 10_000).unwrap();
    assert_eq!(read, sample());
    let a: Vec<f64> = read.take("a", 3).unwrap();
    assert_eq!(a.iter().map(|v| v.to_bits()).collect::<Vec<_>>(), [1.5, -0.0, f64::MIN_POSITIVE].map(f64::to_bits));
    assert_eq!(read.take::<f32>("b", 2).unwrap(), [f32::MAX, 0.1]);
    assert_eq!(read.take::<u32>("c", 3).unwrap(), [7, u32::MAX, 0]);
    assert_eq!(read.take::<u8>("d", 5).unwrap(), [1, 2, 3, 4, 5]);
    assert_eq!(read.take::<f64>("none", 0).unwrap(), [0.0; 0]);
    assert_eq!(sample().encode(), sample().encode());
    assert!(Container::read(&path, KIND, 100).unwrap_err().to_string().contains("limit of 100"));
}

#[test]
fn numbers_of_another_name_type_or_count_are_told() {
    let mut file = sample();
    assert_eq!(file.take::<f64>("z", 3).unwrap_err(), "lacks the numbers `z`");
    assert_eq!(file.take::<f32>("a", 3).unwrap_err(), "has 3 of f64 as `a`, not 3 of f32");
    assert_eq!(file.take::<u32>("c", 4).unwrap_err(), "has 3 of u32 as `c`, not 4 of u32");
}

#[test]
fn a_file_cut_anywhere_or_with_any_bit_changed_is_refused() {
    let whole = sample().encode().unwrap();
    assert!(Container::decode(&whole, KIND).is_ok());
    for at in 0..whole.len() {
        assert!(Container::decode(&whole[..at], KIND).is_err(), "cut at {at} of {}", whole.len());
        for bit in 0..8 {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << bit;
            assert!(Container::decode(&bytes, KIND).is_err(), "bit {bit} of byte {at}");
        }
    }
    let longer = [&whole[..], &[0]].concat();
    assert!(Container::decode(&longer, KIND).is_err());
}

#[test]
fn another_kind_and_a_newer_version_are_refused_by_name() {
    let folder = Folder::new();
    let path = folder.join("a.bin");
    sample().write(&path).unwrap();
    let refused = |kind| Container::read(&path, kind, 10_000).unwrap_err().to_string();
    let other = refused(Kind { id: "bake", version: 3 });
    assert!(other.contains("a.bin: is a file of the kind `test`, not `bake`; name a file"), "{other}");
    let newer = refused(Kind { version: 2, ..KIND });
    assert!(newer.contains("version 3 of `test`, and this program knows 2; update"), "{newer}");
    assert_eq!(Container::read(&path, Kind { version: 4, ..KIND }, 10_000).unwrap().version, 3);
    let mut layout = sample().encode().unwrap();
    layout[8] = 2;
    assert!(Container::decode(&layout, KIND).unwrap_err().0.contains("has the layout 2"));
    std::fs::write(&path, "<html>").unwrap();
    assert!(refused(KIND).contains("no file of numbers"));
}

#[test]
fn sizes_that_lie_are_refused_before_memory_is_taken() {
    let decode = |arrays: &str, data: &[u8]| {
        let json = format!(r#"{{"kind":"test","version":1,"header":null,"arrays":[{arrays}]}}"#);
        Container::decode(&forged(&json, data), KIND).map_err(|(reason, _)| reason)
    };
    assert!(decode(r#"{"name":"a","type":"f64","count":2}"#, &[0; 16]).is_ok());
    for count in ["3", "2000000000000", "2305843009213693952", "18446744073709551615"] {
        let reason = decode(&format!(r#"{{"name":"a","type":"f64","count":{count}}}"#), &[0; 16]).unwrap_err();
        assert!(reason.contains(count) && reason.contains("holds fewer"), "{reason}");
    }
    let reason = |arrays: &str, data: &[u8]| decode(arrays, data).unwrap_err();
    assert!(reason(r#"{"name":"a","type":"f64","count":1}"#, &[0; 16]).contains("8 bytes that it does not announce"));
    assert!(reason(r#"{"name":"a","type":"f24","count":1}"#, &[0; 8]).contains("unknown type `f24`"));
    let twice = r#"{"name":"a","type":"u8","count":0},{"name":"a","type":"u8","count":0}"#;
    assert!(reason(twice, &[]).contains("two arrays `a`"));
    assert!(reason(r#"{"name":"a","type":"f64","count":-1}"#, &[]).contains("makes no sense"));
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(Container::decode(&forged(&deep, &[]), KIND).is_err());

    // Lengths of the prefix that overflow, with the hash right.
    for at in [12, 16, 20] {
        let mut bytes = forged("{}", &[]);
        bytes[at..at + 4].fill(0xff);
        let end = bytes.len() - HASH;
        let hash = blake3::hash(&bytes[..end]);
        bytes[end..].copy_from_slice(hash.as_bytes());
        assert!(Container::decode(&bytes, KIND).unwrap_err().0.contains("not those that it announces"));
    }
}
