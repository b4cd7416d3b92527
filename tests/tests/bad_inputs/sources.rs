//! Small sound files to break, and what reads them.

use std::fmt::Write;

use burnish_core::import::{ImportOptions, Imported, ResolveError, Resolver, environment_from_bytes, scene_from_bytes};
use serde_json::{Value, json};

/// A folder without files.
pub struct Nothing;

impl Resolver for Nothing {
    fn read(&self, uri: &str, _budget: u64) -> Result<Vec<u8>, ResolveError> {
        Err(ResolveError::Missing { uri: uri.into() })
    }
}

/// A PNG of one black pixel.
pub const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\
    \x00\x00\x00\x0dIHDR\x00\x00\x00\x01\x00\x00\x00\x01\x08\x00\x00\x00\x00\x3a\x7e\x9b\x55\
    \x00\x00\x00\x0aIDAT\x78\x9c\x63\x60\x00\x00\x00\x02\x00\x01\x48\xaf\xa4\x71\
    \x00\x00\x00\x00IEND\xae\x42\x60\x82";

/// A model of one triangle whose buffer is inline.
pub fn triangle() -> Value {
    let numbers = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "name": "body", "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "byteLength": 36, "uri": percent(&bytes) }],
    })
}

/// Bytes as a percent-encoded data URI, which needs no library.
pub fn percent(bytes: &[u8]) -> String {
    let mut uri = String::from("data:application/octet-stream,");
    for byte in bytes {
        write!(uri, "%{byte:02x}").expect("writing to a string");
    }
    uri
}

/// A GLB from JSON and chunks of other kinds.
pub fn glb(json: &[u8], chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let mut body = Vec::new();
    for (kind, data) in [(b"JSON", json)].iter().chain(chunks) {
        body.extend((data.len() as u32).to_le_bytes());
        body.extend(*kind);
        body.extend(*data);
    }
    let mut file = b"glTF\x02\x00\x00\x00".to_vec();
    file.extend((12 + body.len() as u32).to_le_bytes());
    file.extend(body);
    file
}

/// The triangle as a GLB with a binary chunk.
pub fn triangle_glb() -> Vec<u8> {
    let mut model = triangle();
    model["buffers"] = json!([{ "byteLength": 36 }]);
    let numbers = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    glb(model.to_string().as_bytes(), &[(b"BIN\0", &bytes)])
}

/// Reads a model with default options and no files beside it.
pub fn read(bytes: &[u8], name: &str) -> Result<Imported, String> {
    scene_from_bytes(bytes, name, &Nothing, &ImportOptions::default()).map_err(|error| error.to_string())
}

/// Asserts that the model is refused with a line that holds all of `words`.
#[track_caller]
pub fn refused(model: &Value, words: &[&str]) {
    refused_bytes(model.to_string().as_bytes(), "m.gltf", words);
}

/// As [`refused`], for any file.
#[track_caller]
pub fn refused_bytes(bytes: &[u8], name: &str, words: &[&str]) {
    let environment = name.ends_with(".hdr") || name.ends_with(".exr");
    let text = match environment {
        true => environment_from_bytes(bytes, name, &Default::default()).map(|_| ()).map_err(|e| e.to_string()),
        false => read(bytes, name).map(|_| ()),
    };
    let text = text.expect_err("the file was accepted");
    let line = text.lines().find(|line| words.iter().all(|word| line.contains(word)));
    assert!(line.is_some_and(|line| line.starts_with(&format!("{name}: "))), "{text}\nhas no line with {words:?}");
}

/// The texts of all notices of a model that is shown.
#[track_caller]
pub fn notices(bytes: &[u8], name: &str) -> Vec<String> {
    let imported = read(bytes, name).expect("the model is shown");
    imported.scene.validate().expect("a sound scene");
    imported.notices.iter().map(ToString::to_string).collect()
}
