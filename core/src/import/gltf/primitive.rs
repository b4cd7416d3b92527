//! One primitive becomes one mesh.

use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use glam::{Vec3, Vec4};

use super::accessor::Data;
use super::material::Uses;
use crate::import::budget::Meter;
use crate::import::numbers::finite;
use crate::import::report::Report;
use crate::import::shading::{self, Normals};
use crate::import::{Cause, NormalsWhenAbsent};
use crate::scene::Mesh;

/// Reads a primitive; `None` when it is not of triangles (a notice) or faulty (reported).
pub(super) fn read(
    data: &Data<'_>,
    json: &Primitive,
    at: &str,
    uses: Uses,
    normals: NormalsWhenAbsent,
    meter: &mut Meter,
    report: &mut Report,
) -> Option<Mesh> {
    let mode = mode(json, at, report)?;
    let reader = Reader { data, json, at };
    let Some(positions) = reader.accessor(&Semantic::Positions) else {
        report.notice(at, "a primitive without positions is not shown");
        return None;
    };
    let count = reader.keep(positions, "POSITION", data.shape(positions), report)?.count;
    reader.keep(positions, "POSITION", meter.take_vertices(count as u64), report)?;
    let mut mesh = Mesh { positions: to(reader.attribute(&Semantic::Positions, count, report)?), ..Mesh::default() };
    // All attributes are read before giving up, so that all faults are listed.
    let optional = [
        reader.optional(&Semantic::Normals, count, &mut mesh.normals, report),
        reader.optional(&Semantic::Tangents, count, &mut mesh.tangents, report),
        reader.optional(&Semantic::TexCoords(0), count, &mut mesh.uvs[0], report),
        reader.optional(&Semantic::TexCoords(1), count, &mut mesh.uvs[1], report),
        reader.colors(count, &mut mesh.colors, report),
        reader.triangles(mode, count, &mut mesh.indices, meter, report),
    ];
    if optional.contains(&None) {
        return None;
    }
    for set in (0..2).filter(|s| uses.uv_sets[*s] && mesh.uvs[*s].is_empty()) {
        report.notice(at, format!("a texture asks for TEXCOORD_{set}, which the primitive lacks"));
    }
    let policy = match normals {
        NormalsWhenAbsent::FormatDefault | NormalsWhenAbsent::Flat => Normals::Flat,
        NormalsWhenAbsent::Smooth { crease_angle } => Normals::Smooth { crease_angle },
    };
    shading::complete(&mut mesh, policy, uses.tangent_uv).tell(at, report);
    Some(mesh)
}

fn mode(json: &Primitive, at: &str, report: &mut Report) -> Option<Mode> {
    match json.mode {
        Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => Some(mode),
        Checked::Valid(_) => {
            report.notice(at, "points and lines are not shown");
            None
        }
        Checked::Invalid => {
            report.fault(at, Cause::Invalid("the mode is unknown".into()));
            None
        }
    }
}

/// Vectors of glam from arrays.
fn to<T: From<[f32; N]>, const N: usize>(list: Vec<[f32; N]>) -> Vec<T> {
    list.into_iter().map(T::from).collect()
}

struct Reader<'a> {
    data: &'a Data<'a>,
    json: &'a Primitive,
    at: &'a str,
}

impl Reader<'_> {
    fn accessor(&self, semantic: &Semantic) -> Option<usize> {
        self.json.attributes.get(&Checked::Valid(semantic.clone())).map(|index| index.value())
    }

    fn keep<T>(&self, accessor: usize, name: &str, result: Result<T, Cause>, report: &mut Report) -> Option<T> {
        result.map_err(|cause| report.fault(format!("{}, accessor {accessor} ({name})", self.at), cause)).ok()
    }

    /// One finite vector per vertex; `None` when absent or reported.
    fn attribute<const N: usize>(
        &self,
        semantic: &Semantic,
        count: usize,
        report: &mut Report,
    ) -> Option<Vec<[f32; N]>> {
        let index = self.accessor(semantic)?;
        let read = self.data.shape(index).and_then(|shape| {
            if shape.count != count {
                let have = shape.count;
                return Err(Cause::Invalid(format!("has {have} elements for {count} vertices")));
            }
            let list = self.data.vectors::<N>(index)?;
            finite("element", &list)?;
            Ok(list)
        });
        self.keep(index, &semantic.to_string(), read, report)
    }

    /// Fills `list` when the attribute is there; `None` when it is faulty.
    fn optional<T: From<[f32; N]>, const N: usize>(
        &self,
        semantic: &Semantic,
        count: usize,
        list: &mut Vec<T>,
        report: &mut Report,
    ) -> Option<()> {
        if self.accessor(semantic).is_some() {
            *list = to(self.attribute::<N>(semantic, count, report)?);
        }
        Some(())
    }

    /// COLOR_0 with or without alpha.
    fn colors(&self, count: usize, list: &mut Vec<Vec4>, report: &mut Report) -> Option<()> {
        let semantic = Semantic::Colors(0);
        let Some(index) = self.accessor(&semantic) else { return Some(()) };
        let width = self.data.shape(index).map_or(4, |shape| shape.width);
        if width == 3 {
            let rgb = self.attribute::<3>(&semantic, count, report)?;
            *list = rgb.into_iter().map(|c| Vec3::from(c).extend(1.0)).collect();
            return Some(());
        }
        self.optional(&semantic, count, list, report)
    }

    /// Triangles of three indices each, all in range; `None` when reported.
    fn triangles(
        &self,
        mode: Mode,
        count: usize,
        list: &mut Vec<u32>,
        meter: &mut Meter,
        report: &mut Report,
    ) -> Option<()> {
        let accessor = self.json.indices.as_ref().map(|i| i.value());
        let corners = match accessor {
            Some(index) => self.keep(index, "indices", self.data.shape(index), report)?.count,
            None => count,
        };
        let triangles = if mode == Mode::Triangles { corners / 3 } else { corners.saturating_sub(2) };
        let taken = meter.take_triangles(triangles as u64);
        report.keep(self.at, taken)?;
        let corners = match accessor {
            Some(index) => {
                let read = self.data.indices(index).and_then(|list| in_range(list, count));
                self.keep(index, "indices", read, report)?
            }
            None => (0..u32::try_from(count).unwrap_or(u32::MAX)).collect(),
        };
        let left_over = if mode == Mode::Triangles { corners.len() % 3 } else { 0 };
        report.notice_many(self.at, "indices that do not fill a triangle were left out", left_over);
        *list = into_triangles(mode, corners);
        if list.is_empty() {
            report.notice(self.at, "a primitive without triangles is not shown");
            return None;
        }
        Some(())
    }
}

fn in_range(list: Vec<u32>, count: usize) -> Result<Vec<u32>, Cause> {
    match list.iter().find(|i| **i as usize >= count) {
        Some(index) => Err(Cause::Index { what: "vertex", index: u64::from(*index), count: count as u64 }),
        None => Ok(list),
    }
}

/// Corners three by three; strips and fans as glTF 2.0, 3.7.2.1 orders them, so that all triangles face one way.
pub(super) fn into_triangles(mode: Mode, mut corners: Vec<u32>) -> Vec<u32> {
    match mode {
        Mode::TriangleStrip => {
            let windows = corners.windows(3).enumerate();
            windows.flat_map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] }).collect()
        }
        Mode::TriangleFan => match corners.split_first() {
            Some((hub, rim)) => rim.windows(2).flat_map(|w| [w[0], w[1], *hub]).collect(),
            None => Vec::new(),
        },
        _ => {
            corners.truncate(corners.len() / 3 * 3);
            corners
        }
    }
}
