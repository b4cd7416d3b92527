//! Collects vertices and triangles.

use glam::{Vec2, Vec3};

use crate::scene::Mesh;

/// A vertex of a patch whose v grows downwards where u grows to the right; so its bitangent sign is +1.
#[derive(Clone, Copy)]
pub struct Vertex {
    /// Metres.
    pub position: Vec3,
    /// Unit.
    pub normal: Vec3,
    /// Unit derivative of the position along u.
    pub tangent: Vec3,
    /// `[0, 1]` over the shape.
    pub uv: Vec2,
    /// Metres along the surface.
    pub uv_metres: Vec2,
}

/// A mesh in the making.
#[derive(Default)]
pub struct Builder {
    mesh: Mesh,
}

impl Builder {
    /// Adds a vertex and gives its index.
    pub fn vertex(&mut self, vertex: Vertex) -> u32 {
        let index = self.mesh.positions.len() as u32;
        self.mesh.positions.push(vertex.position);
        self.mesh.normals.push(vertex.normal);
        self.mesh.tangents.push(vertex.tangent.extend(1.0));
        self.mesh.uvs[0].push(vertex.uv);
        self.mesh.uvs[1].push(vertex.uv_metres);
        index
    }

    /// Adds a triangle unless two of its corners coincide, as they do at a pole.
    pub fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|i| self.mesh.positions[i as usize]);
        if a != b && b != c && c != a {
            self.mesh.indices.extend(corners);
        }
    }

    /// Adds `columns` x `rows` quads between the vertices that `vertex(i, j)` gives for `i <= columns`, `j <= rows`;
    /// i goes to the right and j down, seen from the front.
    pub fn grid(&mut self, columns: usize, rows: usize, mut vertex: impl FnMut(usize, usize) -> Vertex) {
        let first = self.mesh.positions.len() as u32;
        for j in 0..=rows {
            for i in 0..=columns {
                self.vertex(vertex(i, j));
            }
        }
        let at = |i: usize, j: usize| first + (j * (columns + 1) + i) as u32;
        for j in 0..rows {
            for i in 0..columns {
                let (top_left, bottom_right) = (at(i, j), at(i + 1, j + 1));
                self.triangle([top_left, at(i, j + 1), bottom_right]);
                self.triangle([top_left, bottom_right, at(i + 1, j)]);
            }
        }
    }

    /// The mesh.
    pub fn finish(self, name: &str) -> Mesh {
        Mesh { name: name.into(), ..self.mesh }
    }
}
