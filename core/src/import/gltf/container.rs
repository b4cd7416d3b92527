//! The two containers of glTF: plain JSON, and GLB with a JSON and a binary chunk.

use crate::import::Cause;

const MAGIC: &[u8] = b"glTF";
const JSON_CHUNK: &[u8; 4] = b"JSON";
const BINARY_CHUNK: &[u8; 4] = b"BIN\0";

/// JSON text and the binary chunk, if there is one.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Cause> {
    if bytes.starts_with(MAGIC) { split_glb(bytes) } else { Ok((bytes, None)) }
}

fn split_glb(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Cause> {
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(syntax(format!("GLB header: cut short after {} bytes", bytes.len())));
    };
    if version != 2 {
        return Err(Cause::Unsupported(format!("GLB version {version}; version 2 is read")));
    }
    let Some(mut rest) = bytes.get(12..length as usize) else {
        return Err(syntax(format!("GLB header: states {length} bytes, the file has {}", bytes.len())));
    };
    let mut json = None;
    let mut binary = None;
    let mut index = 0;
    while !rest.is_empty() {
        let (Some(size), Some(kind)) = (word(rest, 0), rest.get(4..8)) else {
            return Err(syntax(format!("GLB chunk {index}: cut short")));
        };
        let Some((data, after)) = rest.get(8..).and_then(|r| r.split_at_checked(size as usize)) else {
            return Err(syntax(format!("GLB chunk {index}: states {size} bytes, {} are left", rest.len() - 8)));
        };
        match index {
            // Padding is of spaces; some writers leave zeros, which are no JSON.
            0 if kind == JSON_CHUNK => json = Some(&data[..data.iter().rposition(|b| *b != 0).map_or(0, |i| i + 1)]),
            0 => return Err(syntax("GLB chunk 0: is not JSON".into())),
            _ if kind == JSON_CHUNK => return Err(syntax(format!("GLB chunk {index}: a second JSON chunk"))),
            _ if kind == BINARY_CHUNK && binary.is_some() => {
                return Err(syntax(format!("GLB chunk {index}: a second binary chunk")));
            }
            _ if kind == BINARY_CHUNK => binary = Some(data),
            // Chunks of other kinds are to be ignored.
            _ => {}
        }
        // Chunks are padded to four bytes by their own length; some writers forget the last one's padding.
        rest = after;
        index += 1;
    }
    json.map(|json| (json, binary)).ok_or_else(|| syntax("GLB: has no JSON chunk".into()))
}

/// Little-endian word at a byte offset.
fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|b| u32::from_le_bytes(*b))
}

fn syntax(text: String) -> Cause {
    Cause::Syntax(text)
}
