//! GLB, JSON, extensions and files that are not what their name says.

use serde_json::json;

use crate::sources::{glb, notices, refused, refused_bytes, triangle, triangle_glb};

#[test]
fn a_glb_with_a_false_length_or_cut_anywhere_is_refused() {
    let whole = triangle_glb();
    let mut long = whole.clone();
    long[8..12].copy_from_slice(&0xFFFF_FFF0_u32.to_le_bytes());
    refused_bytes(&long, "m.glb", &["file", "GLB header", "states 4294967280 bytes"]);
    for end in 0..whole.len() {
        let words: &[&str] = match end {
            0 => &["file", "the content is empty"],
            1..4 => &["file", "not a glTF, GLB or OBJ model"],
            4..12 => &["file", "GLB header: cut short"],
            _ => &["file", "GLB header: states"],
        };
        refused_bytes(&whole[..end], "m.glb", words);
    }
}

#[test]
fn chunks_that_are_too_long_twice_there_or_not_json_are_refused() {
    let json = triangle().to_string();
    let mut long = triangle_glb();
    long[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    refused_bytes(&long, "m.glb", &["GLB chunk 0", "states 4294967295 bytes"]);
    let twice = glb(json.as_bytes(), &[(b"BIN\0", &[0; 4]), (b"BIN\0", &[0; 4])]);
    refused_bytes(&twice, "m.glb", &["GLB chunk 2", "second binary chunk"]);
    refused_bytes(&glb(b"", &[]), "m.glb", &["JSON", "EOF"]);
    let mut other = triangle_glb();
    other[16..20].copy_from_slice(b"XXXX");
    refused_bytes(&other, "m.glb", &["GLB chunk 0", "is not JSON"]);
    let mut old = triangle_glb();
    old[4] = 1;
    refused_bytes(&old, "m.glb", &["GLB version 1", "version 2 is read"]);
}

#[test]
fn chunks_of_other_kinds_zeros_after_the_json_and_bytes_after_the_end_are_no_harm() {
    let json = [triangle().to_string().as_bytes(), &[0; 3]].concat();
    let mut file = glb(&json, &[(b"XTRA", &[1, 2, 3])]);
    file.extend([9; 5]);
    assert_eq!(notices(&file, "m.glb"), [""; 0]);
}

#[test]
fn json_that_is_deep_doubled_or_not_json_is_refused_with_its_place() {
    let deep = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}]}}", "[".repeat(200_000));
    refused_bytes(deep.as_bytes(), "m.gltf", &["JSON", "line 1 column"]);
    let deep = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"extensions\":{{\"x\":{}}}}}", "[".repeat(200_000));
    refused_bytes(deep.as_bytes(), "m.gltf", &["JSON", "recursion limit"]);
    refused_bytes(
        b"{\"asset\":{\"version\":\"2.0\"},\"nodes\":[],\"nodes\":[]}",
        "m.gltf",
        &["JSON", "duplicate field"],
    );
    let mark = [b"\xef\xbb\xbf".as_slice(), triangle().to_string().as_bytes()].concat();
    refused_bytes(&mark, "m.gltf", &["file", "JSON with a byte order mark"]);
    refused_bytes(
        b"{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"name\":\"\\ud800\"}]}",
        "m.gltf",
        &["JSON", "hex escape"],
    );
    let huge = b"{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"scale\":[1e999,1,1]}]}";
    refused_bytes(huge, "m.gltf", &["JSON", "number out of range"]);
    refused_bytes(b"{}", "m.gltf", &["JSON", "missing field `asset`"]);
    refused_bytes(b"{\"asset\":{\"version\":\"1.0\"}}", "m.gltf", &["asset", "glTF version '1.0'"]);
}

#[test]
fn json_of_countless_small_objects_is_refused_before_it_is_parsed() {
    let nodes = "{},".repeat(4_000_000);
    let json = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{nodes}{{}}]}}");
    refused_bytes(json.as_bytes(), "m.gltf", &["JSON", "asks for 4000003 JSON objects; the limit is 3000000"]);
    // Braces in a string are none.
    let mut model = triangle();
    model["nodes"][0]["name"] = format!("\\\"{}", "{".repeat(4_000_000)).into();
    assert_eq!(notices(model.to_string().as_bytes(), "m.gltf"), [""; 0]);
}

#[test]
fn required_extensions_are_refused_by_name_with_a_remedy_and_used_ones_noticed() {
    let mut model = triangle();
    model["extensionsRequired"] =
        json!(["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu"]);
    for (name, remedy) in [
        ("KHR_draco_mesh_compression", "without Draco compression"),
        ("EXT_meshopt_compression", "without meshopt compression"),
        ("KHR_texture_basisu", "PNG or JPEG instead of KTX2"),
    ] {
        refused(&model, &["extensionsRequired", name, remedy]);
    }
    let mut model = triangle();
    model["extensionsUsed"] = json!(["KHR_texture_basisu"]);
    let notices = notices(model.to_string().as_bytes(), "m.gltf");
    assert!(notices[0].contains("m.gltf: extensionsUsed: the extension 'KHR_texture_basisu'"), "{notices:?}");
}

#[test]
fn a_file_that_is_something_else_is_called_what_it_is() {
    for (bytes, found) in [
        (b"\x89PNG\r\n\x1a\nrest".as_slice(), "a PNG picture"),
        (b"<!DOCTYPE html><html>404</html>", "an HTML page"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "a Git LFS pointer"),
        (b"PK\x03\x04", "a ZIP archive"),
        (b"\x76\x2f\x31\x01", "an OpenEXR picture"),
    ] {
        for name in ["m.glb", "m.gltf", "m.obj"] {
            refused_bytes(bytes, name, &["file", found]);
        }
        if found != "an OpenEXR picture" {
            refused_bytes(bytes, "sky.hdr", &["file", found]);
        }
    }
    refused_bytes(b"\x00\x01\x02\x03", "m.obj", &["unknown binary data"]);
}

#[test]
fn inline_data_is_checked_before_it_is_decoded() {
    let mut model = triangle();
    for (uri, words) in [
        ("data:application/octet-stream;base64", "no comma"),
        ("data:application/octet-stream;base64,!!!!", "bad base64"),
        ("data:text/html;base64,AAAA", "media type 'text/html', expected application/octet-stream"),
        ("data:;base64,AAAA", "states 36 bytes but has 3"),
    ] {
        model["buffers"][0]["uri"] = uri.into();
        refused(&model, &["buffer 0", words]);
    }
    let budget = burnish_core::import::Budget { file_bytes: 5000, ..Default::default() };
    let options = burnish_core::import::ImportOptions { budget, ..Default::default() };
    model["buffers"][0]["uri"] = format!("data:;base64,{}", "A".repeat(4000)).into();
    let bytes = model.to_string();
    let error = burnish_core::import::scene_from_bytes(bytes.as_bytes(), "m.gltf", &crate::sources::Nothing, &options);
    let text = error.unwrap_err().to_string();
    // 5000 less the model itself is less than the 3000 that the text would decode to.
    assert!(text.contains("m.gltf: buffer 0: data URI has 3000 bytes;"), "{text}");
}
