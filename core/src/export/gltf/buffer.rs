//! The binary part: accessors over the one buffer, and the container of both parts.

use std::path::Path;

use glam::Vec3;
use serde_json::{Map, Value, json};

use crate::file::FileError;
use crate::scene::Mesh;

/// glTF's number for 32-bit floats.
const FLOAT: u32 = 5126;
/// For 32-bit unsigned integers.
const UINT: u32 = 5125;
/// Use of a buffer view: vertices, indices.
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// Bytes with what lies where in them.
#[derive(Default)]
pub(super) struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// A view of bytes, from a multiple of four on.
    pub fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.extend(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], of: (u32, &str, usize), target: u32) -> usize {
        let (component, shape, count) = of;
        let view = self.view(bytes, Some(target));
        let accessor = json!({ "bufferView": view, "componentType": component, "type": shape, "count": count });
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, shape: &str, values: impl ExactSizeIterator<Item = [f32; N]>) -> usize {
        let count = values.len();
        let bytes: Vec<u8> = values.flatten().flat_map(f32::to_le_bytes).collect();
        self.accessor(&bytes, (FLOAT, shape, count), VERTICES)
    }

    /// The attributes of a mesh and the accessor of its indices.
    pub fn mesh(&mut self, mesh: &Mesh) -> (Value, usize) {
        let mut attributes = Map::new();
        let position = self.floats("VEC3", mesh.positions.iter().map(|p| p.to_array()));
        let least = mesh.positions.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let greatest = mesh.positions.iter().copied().reduce(Vec3::max).unwrap_or_default();
        self.accessors[position]["min"] = json!(least.to_array());
        self.accessors[position]["max"] = json!(greatest.to_array());
        attributes.insert("POSITION".into(), position.into());
        if !mesh.normals.is_empty() {
            let normals = self.floats("VEC3", mesh.normals.iter().map(|n| n.to_array()));
            attributes.insert("NORMAL".into(), normals.into());
        }
        if !mesh.tangents.is_empty() {
            let tangents = self.floats("VEC4", mesh.tangents.iter().map(|t| t.to_array()));
            attributes.insert("TANGENT".into(), tangents.into());
        }
        // Sets are numbered without gaps: one that is missing before another is filled with the other.
        let [first, second] = &mesh.uvs;
        let sets = match (first.is_empty(), second.is_empty()) {
            (true, true) => vec![],
            (false, true) => vec![first],
            (true, false) => vec![second, second],
            (false, false) => vec![first, second],
        };
        for (i, set) in sets.into_iter().enumerate() {
            let uvs = self.floats("VEC2", set.iter().map(|uv| uv.to_array()));
            attributes.insert(format!("TEXCOORD_{i}"), uvs.into());
        }
        if !mesh.colors.is_empty() {
            let colors = self.floats("VEC4", mesh.colors.iter().map(|c| c.to_array()));
            attributes.insert("COLOR_0".into(), colors.into());
        }
        let bytes: Vec<u8> = mesh.indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let indices = self.accessor(&bytes, (UINT, "SCALAR", mesh.indices.len()), INDICES);
        (attributes.into(), indices)
    }

    /// Accessors, views, bytes.
    pub fn into_parts(self) -> (Vec<Value>, Vec<Value>, Vec<u8>) {
        (self.accessors, self.views, self.bytes)
    }
}

/// Both parts in one file (glTF 2.0, section 4.4).
pub(super) fn glb(root: &Value, mut bytes: Vec<u8>) -> Result<Vec<u8>, FileError> {
    let failure = |reason: String| FileError::new(Path::new("scene.glb"), reason, "export less in one file");
    let mut json = serde_json::to_vec(root).map_err(|e| failure(format!("cannot be described ({e})")))?;
    json.resize(json.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let chunks: Vec<(&[u8; 4], Vec<u8>)> =
        if bytes.is_empty() { vec![(b"JSON", json)] } else { vec![(b"JSON", json), (b"BIN\0", bytes)] };
    let length = 12 + chunks.iter().map(|(_, data)| 8 + data.len()).sum::<usize>();
    let length = u32::try_from(length).map_err(|_| failure(format!("would have {length} bytes, over 4 GiB")))?;
    let mut file = Vec::with_capacity(length as usize);
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend(length.to_le_bytes());
    for (kind, data) in chunks {
        // Shorter than the file.
        file.extend((data.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(data);
    }
    Ok(file)
}
