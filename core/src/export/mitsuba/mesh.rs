//! Shapes: a PLY for each mesh as it is used, placed by `to_world`.

use glam::{Vec2, Vec3};

use super::xml::Element;
use crate::export::ply::Ply;
use crate::export::{Folder, slug};
use crate::file::FileError;
use crate::scene::{Instance, Mesh, Scene};

/// Where the texture coordinates of a file come from. Mitsuba reads one set, and takes the tangent from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinates {
    /// A set of the mesh.
    Set(u8),
    /// Made so that u runs along the tangent, turned by so many radians toward the bitangent.
    Brushing(f32),
}

/// What a material asks of the meshes that wear it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// The texture coordinates.
    pub coordinates: Coordinates,
    /// Factor on the colours of the vertices, where they count.
    pub colors: Option<Vec3>,
}

/// A file that was written.
struct Written {
    mesh: usize,
    wanted: Wanted,
    mirrored: bool,
    file: String,
}

/// The meshes of an export.
#[derive(Default)]
pub struct Meshes {
    written: Vec<Written>,
}

impl Meshes {
    /// The shape of an instance, without its material.
    pub fn element(
        &mut self,
        scene: &Scene,
        instance: &Instance,
        wanted: Wanted,
        folder: &mut Folder<'_>,
    ) -> Result<Option<Element>, FileError> {
        let Some(mesh) = scene.meshes.get(instance.mesh).filter(|mesh| mesh.indices.len() >= 3) else {
            return Ok(None);
        };
        // Mitsuba takes the front from the order of the corners in the world.
        let mirrored = instance.world_from_local.matrix3.determinant() < 0.0;
        let same = |w: &&Written| w.mesh == instance.mesh && w.wanted == wanted && w.mirrored == mirrored;
        let file = match self.written.iter().find(same) {
            Some(written) => written.file.clone(),
            None => {
                let file = format!("meshes/{}.ply", slug(self.written.len(), &mesh.name));
                folder.write(&file, &ply(mesh, wanted, mirrored).encode())?;
                self.written.push(Written { mesh: instance.mesh, wanted, mirrored, file: file.clone() });
                file
            }
        };
        let shape = Element::plugin("shape", "ply").with(Element::string("filename", &file));
        Ok(Some(shape.with(Element::transform("to_world", &instance.world_from_local))))
    }
}

/// The mesh as a file holds it.
fn ply(mesh: &Mesh, wanted: Wanted, mirrored: bool) -> Ply {
    let colors = match wanted.colors {
        Some(factor) => mesh.colors.iter().map(|c| (c.truncate() * factor).clamp(Vec3::ZERO, Vec3::ONE)).collect(),
        None => Vec::new(),
    };
    let (corners, _) = mesh.indices.as_chunks::<3>();
    let turned = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    let whole = Ply {
        positions: mesh.positions.clone(),
        normals: mesh.normals.clone(),
        uvs: match wanted.coordinates {
            Coordinates::Set(set) => mesh.uvs.get(usize::from(set)).cloned().unwrap_or_default(),
            Coordinates::Brushing(_) => Vec::new(),
        },
        colors,
        triangles: corners.iter().map(turned).collect(),
    };
    match wanted.coordinates {
        Coordinates::Set(_) => whole,
        Coordinates::Brushing(angle) => brushed(mesh, &whole, angle),
    }
}

/// Every triangle with corners of its own, whose coordinates are metres along and across the tangent in its middle.
fn brushed(mesh: &Mesh, whole: &Ply, angle: f32) -> Ply {
    let mut split = Ply::default();
    for corners in &whole.triangles {
        let of = |list: &[Vec3]| corners.map(|corner| list.get(corner as usize).copied().unwrap_or(Vec3::ZERO));
        let (positions, normals) = (of(&whole.positions), of(&whole.normals));
        let tangents = corners.map(|corner| mesh.tangents.get(corner as usize).copied().unwrap_or_default());
        let normal = normals.into_iter().sum::<Vec3>().normalize_or(Vec3::Z);
        let flat = tangents.iter().map(|t| t.truncate()).sum::<Vec3>().reject_from_normalized(normal);
        let flat = flat.normalize_or_zero();
        let (sin, cos) = angle.sin_cos();
        let along = cos * flat + sin * tangents[0].w * normal.cross(flat);
        // Within the plane of the triangle, so that u grows along it there too.
        let [a, b, c] = positions;
        let face = (b - a).cross(c - a).normalize_or(normal);
        let along = along.reject_from_normalized(face).normalize_or_zero();
        let across = face.cross(along);
        let first = split.positions.len() as u32;
        for p in positions {
            split.uvs.push(Vec2::new((p - a).dot(along), (p - a).dot(across)));
        }
        split.positions.extend(positions);
        split.normals.extend(normals);
        split.colors.extend(corners.iter().filter_map(|corner| whole.colors.get(*corner as usize)));
        split.triangles.push([first, first + 1, first + 2]);
    }
    split
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::gallery::shape;

    /// Derivative of the position along u on a triangle.
    fn dp_du(ply: &Ply, corners: [u32; 3]) -> Vec3 {
        let [p, q, r] = corners.map(|i| ply.positions[i as usize]);
        let [s, t, w] = corners.map(|i| ply.uvs[i as usize]);
        let (d, e) = (t - s, w - s);
        ((q - p) * e.y - (r - p) * d.y) / (d.x * e.y - d.y * e.x)
    }

    #[test]
    fn made_coordinates_run_along_the_tangent_and_turn_counter_clockwise() {
        let mesh = shape::sphere(1.0, 24);
        for angle in [0.0, 0.6] {
            let wanted = Wanted { coordinates: Coordinates::Brushing(angle), colors: None };
            let ply = ply(&mesh, wanted, false);
            assert_eq!(ply.positions.len(), mesh.indices.len());
            for corners in &ply.triangles {
                let middle = corners.map(|i| ply.normals[i as usize]).into_iter().sum::<Vec3>().normalize();
                // Around the axis, away from the poles where it is any.
                let around = Vec3::Y.cross(middle).normalize_or_zero();
                if middle.y.abs() > 0.9 {
                    continue;
                }
                let expected = angle.cos() * around + angle.sin() * middle.cross(around);
                let found = dp_du(&ply, *corners).normalize();
                assert!(found.dot(expected) > 0.995, "{found} {expected}");
            }
        }
    }

    #[test]
    fn a_mirrored_use_turns_the_triangles_over() {
        let mesh = shape::plane(1.0, 1.0);
        let wanted = Wanted { coordinates: Coordinates::Set(0), colors: None };
        let (plain, turned) = (ply(&mesh, wanted, false), ply(&mesh, wanted, true));
        assert_eq!(plain.uvs, mesh.uvs[0]);
        for ([a, b, c], other) in plain.triangles.iter().zip(&turned.triangles) {
            assert_eq!([*a, *c, *b], *other);
        }
    }

    #[test]
    fn colours_are_written_where_they_count() {
        let mesh = shape::colored(shape::plane(1.0, 1.0), glam::Vec4::new(0.5, 1.0, 4.0, 0.5));
        let wanted = Wanted { coordinates: Coordinates::Set(0), colors: Some(Vec3::splat(0.5)) };
        assert_eq!(ply(&mesh, wanted, false).colors, vec![Vec3::new(0.25, 0.5, 1.0); 4]);
        assert!(ply(&mesh, Wanted { colors: None, ..wanted }, false).colors.is_empty());
    }
}
