//! Triangle meshes as binary PLY.

use glam::{Vec2, Vec3};

/// What a file holds; lists are as long as `positions`, or empty where absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ply {
    /// Metres.
    pub positions: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Texture coordinates.
    pub uvs: Vec<Vec2>,
    /// Linear colours.
    pub colors: Vec<Vec3>,
    /// Corners of each triangle, counter-clockwise from the front.
    pub triangles: Vec<[u32; 3]>,
}

impl Ply {
    /// The bytes of the file, little endian, 32-bit floats.
    pub fn encode(&self) -> Vec<u8> {
        let Ply { positions, normals, uvs, colors, triangles } = self;
        let count = positions.len();
        let lists: [(bool, &str); 4] = [
            (true, "x y z"),
            (normals.len() == count, "nx ny nz"),
            (uvs.len() == count, "u v"),
            (colors.len() == count, "r g b"),
        ];
        let present = lists.map(|list| list.0 && count > 0);
        let mut header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n");
        for (_, names) in lists.iter().zip(present).filter(|(_, there)| *there).map(|(list, _)| list) {
            for name in names.split(' ') {
                header += &format!("property float {name}\n");
            }
        }
        let faces = triangles.len();
        header += &format!("element face {faces}\nproperty list uchar int vertex_indices\nend_header\n");
        let mut bytes = header.into_bytes();
        bytes.reserve(count * 44 + faces * 13);
        for (vertex, position) in positions.iter().enumerate() {
            put(&mut bytes, &position.to_array());
            if let Some(normal) = normals.get(vertex).filter(|_| present[1]) {
                put(&mut bytes, &normal.to_array());
            }
            if let Some(uv) = uvs.get(vertex).filter(|_| present[2]) {
                put(&mut bytes, &uv.to_array());
            }
            if let Some(color) = colors.get(vertex).filter(|_| present[3]) {
                put(&mut bytes, &color.to_array());
            }
        }
        for corners in triangles {
            bytes.push(3);
            bytes.extend(corners.iter().flat_map(|corner| corner.to_le_bytes()));
        }
        bytes
    }
}

fn put(bytes: &mut Vec<u8>, numbers: &[f32]) {
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_the_bytes_that_its_header_promises() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let ply = Ply {
            normals: vec![Vec3::Z; 3],
            uvs: vec![Vec2::new(0.25, 0.5); 3],
            triangles: vec![[0, 1, 2]],
            positions,
            ..Ply::default()
        };
        let bytes = ply.encode();
        let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        let header = std::str::from_utf8(&bytes[..end]).unwrap();
        assert_eq!(header.matches("property float").count(), 8);
        assert!(header.contains("element vertex 3\n") && header.contains("element face 1\n"), "{header}");
        assert_eq!(bytes.len() - end, 3 * 8 * 4 + 13);
        // The second vertex begins with x = 1.
        assert_eq!(bytes[end + 32..end + 36], 1.0_f32.to_le_bytes());
        assert_eq!(bytes[bytes.len() - 13..], [3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    }

    #[test]
    fn lists_of_another_length_are_left_out() {
        let ply = Ply { positions: vec![Vec3::ZERO; 2], normals: vec![Vec3::Z], ..Ply::default() };
        assert!(!String::from_utf8_lossy(&ply.encode()).contains("nx"));
    }
}
