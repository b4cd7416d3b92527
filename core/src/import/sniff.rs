//! What a file is, told by its content: names lie.

use std::path::Path;

use super::Cause;

/// Model formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Model {
    /// JSON or binary container.
    Gltf,
    /// Wavefront text.
    Obj,
}

const SIGNATURES: &[(&[u8], &str)] = &[
    (b"glTF", "a GLB model"),
    (b"\x89PNG\r\n\x1a\n", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"\x76\x2f\x31\x01", "an OpenEXR picture"),
    (b"#?", "a Radiance HDR picture"),
    (b"\xabKTX 20\xbb", "a KTX2 texture"),
    (b"RIFF", "a RIFF (WebP) file"),
    (b"GIF8", "a GIF picture"),
    (b"DDS ", "a DDS texture"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"BLENDER", "a Blender file"),
    (b"Kaydara FBX", "an FBX model"),
    (b"ply\n", "a PLY model"),
    (b"version https://git-lfs", "a Git LFS pointer (the real file was not downloaded)"),
    (b"\xef\xbb\xbf{", "JSON with a byte order mark"),
];

/// Words for what the bytes look like.
pub(super) fn describe(bytes: &[u8]) -> &'static str {
    if bytes.is_empty() {
        return "empty";
    }
    if let Some((_, name)) = SIGNATURES.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return name;
    }
    let head = bytes.trim_ascii_start();
    let head = &head[..head.len().min(256)];
    let lower = head.to_ascii_lowercase();
    if lower.starts_with(b"<!doctype html") || lower.starts_with(b"<html") {
        return "an HTML page";
    }
    match head.first() {
        Some(b'<') => "XML",
        Some(b'{') => "JSON",
        Some(_) if !head.iter().any(|b| *b < 9 || *b == 127) => "text",
        _ => "unknown binary data",
    }
}

/// The format of a model file.
pub(super) fn model(bytes: &[u8], file_name: &str) -> Result<Model, Cause> {
    let found = describe(bytes);
    let named_obj = Path::new(file_name).extension().is_some_and(|e| e.eq_ignore_ascii_case("obj"));
    match found {
        "a GLB model" | "JSON" => Ok(Model::Gltf),
        "text" if named_obj || has_vertices(bytes) => Ok(Model::Obj),
        _ => Err(Cause::Content { found: found.into(), expected: "a glTF, GLB or OBJ model" }),
    }
}

/// True when one of the first lines is a vertex of OBJ.
fn has_vertices(bytes: &[u8]) -> bool {
    let mut lines = bytes.split(|b| *b == b'\n').take(64);
    lines.any(|line| line.trim_ascii_start().starts_with(b"v "))
}
