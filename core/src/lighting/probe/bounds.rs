//! Least and greatest of what a cube of distances keeps, over cells of 2, 4, 8 ... quads.

use super::{DistanceCube, JUMP};

/// Share by which bounds are wider than what they bound: more than what is computed from them is rounded by.
const SLACK: f32 = 1e-4;
/// A cell of which nothing is known.
const ANY: [f32; 2] = [0.0, f32::INFINITY];

/// The quads between the middles of neighbouring texels: along an edge of a face with `face` texels there is one fewer, those at
/// the rim reach to the edge. A cell of level `l` has `2^l` of them along each edge.
#[derive(Clone, Copy, Debug)]
pub struct Cells {
    /// Quads along an edge.
    pub quads: u32,
    /// The level with one cell for the face; 0 where there is one quad.
    pub top: u32,
}

impl Cells {
    /// Of faces with so many texels along an edge.
    pub fn new(face: u32) -> Cells {
        let quads = face.max(2) - 1;
        Cells { quads, top: quads.next_power_of_two().trailing_zeros() }
    }

    /// Cells along an edge as they are stored, from level 1 on.
    pub fn width(&self, level: u32) -> u32 {
        (1 << self.top) >> level
    }

    /// Where the bounds of a cell are stored: levels from 1 on, faces, rows.
    pub fn index(&self, level: u32, side: u32, x: u32, y: u32) -> usize {
        let square = |width: u32| width as usize * width as usize;
        let (whole, width) = (square(1 << self.top), self.width(level));
        // The levels before have 6 (1/4 + 1/16 + ...) of the whole.
        let before = 2 * whole - 8 * square(width);
        before + ((side * width + y) * width + x) as usize
    }

    /// How many are stored.
    pub fn count(&self) -> usize {
        (1..=self.top).map(|level| 6 * (self.width(level) as usize).pow(2)).sum()
    }
}

/// Bounds of all cells, two numbers each, from what a cube keeps.
pub fn bounds(face: u32, inverse: &[f32]) -> Vec<f32> {
    let cells = Cells::new(face);
    let mut all = vec![ANY; cells.count()];
    for level in 1..=cells.top {
        let below = cells.quads.div_ceil(1 << (level - 1));
        for side in 0..6 {
            for (y, x) in (0..below.div_ceil(2)).flat_map(|y| (0..below.div_ceil(2)).map(move |x| (y, x))) {
                let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| (2 * x + dx, 2 * y + dy));
                let of = |(x, y): (u32, u32)| match level {
                    1 => quad(face, inverse, side, x, y),
                    _ => all[cells.index(level - 1, side, x, y)],
                };
                let there = four.into_iter().filter(|(x, y)| *x < below && *y < below).map(of);
                let both = there.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
                all[cells.index(level, side, x, y)] = both.unwrap_or(ANY);
            }
        }
    }
    all.into_iter().flatten().collect()
}

/// Bounds over a quad: of the texels around it at a jump, else of the line through them at its corners.
fn quad(face: u32, inverse: &[f32], side: u32, x: u32, y: u32) -> [f32; 2] {
    let last = face.max(1) - 1;
    let corners = DistanceCube::new(face, inverse, &[]).corners(side, x, y);
    if corners.iter().any(|corner| !corner.is_finite()) {
        return ANY;
    }
    let range = |all: [f32; 4]| [all.into_iter().fold(f32::MAX, f32::min), all.into_iter().fold(f32::MIN, f32::max)];
    let [least, most] = range(corners);
    let smooth = least > 0.0 && most <= JUMP * least;
    let ends = |at: u32| {
        let (low, high) = (if at == 0 { -0.5 } else { 0.0 }, if at + 2 > last { 1.5 } else { 1.0 });
        if smooth { [low, high] } else { [0.0, 1.0] }
    };
    let [a, b, c, d] = corners;
    let at = |tx: f32, ty: f32| {
        let (top, bottom) = (a + (b - a) * tx, c + (d - c) * tx);
        top + (bottom - top) * ty
    };
    let ([left, right], [up, down]) = (ends(x), ends(y));
    let [least, most] = range([at(left, up), at(right, up), at(left, down), at(right, down)]);
    [least * (1.0 - SLACK), most * (1.0 + SLACK)]
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::math::cube::{face_point, mirrored};
    use crate::math::sampling::Random;

    #[test]
    fn every_distance_lies_within_the_bounds_of_its_cells() {
        for face in [1, 2, 3, 8, 21] {
            let mut random = Random::new(face.into());
            let mut level = 0.5;
            let next = |_| {
                level = if random.unit() < 0.1 { 2.0 * random.unit() } else { level * (1.0 + 0.05 * random.unit()) };
                if random.unit() < 0.1 { 0.0 } else { level.min(5.0) }
            };
            let inverse: Vec<f32> = (0..6 * face * face).map(next).collect();
            let bounds = bounds(face, &inverse);
            let cube = DistanceCube::new(face, &inverse, &bounds);
            let cells = Cells::new(face);
            for _ in 0..20_000 {
                let (a, b) = (random.point2(), random.unit());
                let Some(d) = (Vec3::new(a.x, a.y, b) * 2.0 - 1.0).try_normalize() else { continue };
                let (side, p) = face_point(mirrored(d));
                let distance = cube.distance(d);
                let kept = if distance > 0.0 { (1.0 + p.length_squared()).sqrt() / distance } else { 0.0 };
                let at = ((0.5 * p + 0.5) * face as f32 - 0.5).floor().max(glam::Vec2::ZERO).as_uvec2();
                let at = at.min(glam::UVec2::splat(cells.quads - 1));
                for level in 1..=cells.top {
                    let [least, most] = cube.bounds(level, side, at.x >> level, at.y >> level);
                    assert!(kept >= least && kept <= most, "{face} {level} {d}: {kept} {least} {most}");
                }
            }
        }
    }
}
