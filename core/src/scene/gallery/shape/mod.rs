//! Meshes made by code, with exact normals and tangents.
//!
//! Every shape follows one convention. Seen from its front, u grows to the right and v grows downwards, as in an
//! image; the tangent is the unit derivative of the position along u, and the sign of the bitangent is that of the
//! upward direction, as glTF and MikkTSpace have it. Texture set 0 covers `[0, 1]` over the shape (per face on a
//! block); set 1 is in metres along the surface. Triangles are counter-clockwise from the front.
//!
//! Shapes around the +y axis start their u at +z and go counter-clockwise seen from above.

mod block;
mod builder;
mod deform;
mod pierced;
mod profile;
mod revolve;
mod star;
mod sweep;
#[cfg(test)]
mod tests;
mod vessel;

use glam::{Affine3A, Vec2, Vec3, Vec4};

use crate::scene::Mesh;

pub use block::block;
pub use deform::{Curve, bent, deformed, twisted};
pub use pierced::pierced;
pub use profile::{Corner, Profile};
pub use revolve::revolve;
pub use star::{Bump, blob, bunny_like, star};
pub use sweep::sweep;
pub use vessel::{bowl, figure, goblet, rod, teapot};

use builder::{Builder, Vertex};

/// A ball around the origin, `segments` around and half as many from pole to pole.
pub fn sphere(radius: f32, segments: usize) -> Mesh {
    use std::f32::consts::FRAC_PI_2;
    let profile = Profile::new().arc(Vec2::ZERO, radius, FRAC_PI_2, -FRAC_PI_2, segments.max(4) / 2);
    revolve("sphere", &profile, segments)
}

/// A ring around +y: `major` from the axis to the middle of the tube, `minor` the tube's radius.
pub fn torus(major: f32, minor: f32, segments: usize, tube_segments: usize) -> Mesh {
    let profile = Profile::new().arc(Vec2::new(major, 0.0), minor, 0.0, -std::f32::consts::TAU, tube_segments.max(3));
    revolve("torus", &profile, segments)
}

/// A flat disc in the plane y = 0, facing up, with tangents around its middle as on a part that was turned.
pub fn disc(radius: f32, segments: usize, rings: usize) -> Mesh {
    let profile = Profile::new().to(Vec2::ZERO).line(Vec2::new(radius, 0.0), rings.max(1));
    revolve("disc", &profile, segments)
}

/// An upright cylinder around the origin with rounded edges.
pub fn cylinder(radius: f32, height: f32, edge: f32, segments: usize) -> Mesh {
    let h = 0.5 * height;
    let outline = [
        Corner::sharp(0.0, h),
        Corner::round(radius, h, edge),
        Corner::round(radius, -h, edge),
        Corner::sharp(0.0, -h),
    ];
    revolve("cylinder", &Profile::rounded(&outline, EDGE_SEGMENTS), segments)
}

/// Segments of a quarter turn on edges whose number nobody asks for.
const EDGE_SEGMENTS: usize = 5;

/// A rectangle in the plane z = 0 around the origin, facing +z.
pub fn plane(width: f32, height: f32) -> Mesh {
    let size = Vec2::new(width, height);
    let mut builder = Builder::default();
    builder.grid(1, 1, |i, j| {
        let uv = Vec2::new(i as f32, j as f32);
        let at = (uv - 0.5) * size * Vec2::new(1.0, -1.0);
        Vertex { position: at.extend(0.0), normal: Vec3::Z, tangent: Vec3::X, uv, uv_metres: uv * size }
    });
    builder.finish("plane")
}

/// The mesh moved by any invertible transform. A mirroring one turns the triangles and the bitangents over, so that
/// fronts stay fronts and textures are seen mirrored.
pub fn transformed(mut mesh: Mesh, by: &Affine3A) -> Mesh {
    let mirrored = by.matrix3.determinant() < 0.0;
    let normal_matrix = by.matrix3.inverse().transpose();
    mesh.positions.iter_mut().for_each(|p| *p = by.transform_point3(*p));
    mesh.normals.iter_mut().for_each(|n| *n = (normal_matrix * *n).normalize_or(*n));
    for t in &mut mesh.tangents {
        let along = by.transform_vector3(t.truncate()).normalize_or(t.truncate());
        *t = along.extend(if mirrored { -t.w } else { t.w });
    }
    if mirrored {
        mesh.indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
    }
    mesh
}

/// One mesh from several. Vertex colours are white where a part has none and another has.
pub fn combined(name: &str, parts: impl IntoIterator<Item = Mesh>) -> Mesh {
    let mut whole = Mesh { name: name.into(), ..Mesh::default() };
    for part in parts {
        let first = whole.positions.len();
        if !part.colors.is_empty() {
            whole.colors.resize(first, Vec4::ONE);
        }
        whole.colors.extend(&part.colors);
        whole.positions.extend(&part.positions);
        whole.normals.extend(&part.normals);
        whole.tangents.extend(&part.tangents);
        for (all, more) in whole.uvs.iter_mut().zip(&part.uvs) {
            all.extend(more);
        }
        whole.indices.extend(part.indices.iter().map(|i| i + first as u32));
    }
    if !whole.colors.is_empty() {
        whole.colors.resize(whole.positions.len(), Vec4::ONE);
    }
    whole
}

/// The same mesh with one linear colour on every vertex.
pub fn colored(mut mesh: Mesh, color: Vec4) -> Mesh {
    mesh.colors = vec![color; mesh.positions.len()];
    mesh
}
