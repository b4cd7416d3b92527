//! The cube of distances: how it is kept and looked up.

use glam::{Vec2, Vec3};

use super::Cells;
use crate::lighting::cube_map::on_face;
use crate::math::cube::{self, mirrored};

/// Neighbouring depths whose ratio is above this belong to different surfaces.
pub const JUMP: f32 = 1.15;

/// Distances around a place, `6 * face * face` of them by faces, rows, texels, as inverse depths along the axis of the face: on
/// a plane these are linear over the face, so that what lies between texels is exact. 0 is the sky.
#[derive(Clone, Copy, Debug)]
pub struct DistanceCube<'a> {
    face: u32,
    inverse: &'a [f32],
    bounds: &'a [f32],
}

impl<'a> DistanceCube<'a> {
    /// With `face` texels along an edge, and their [`bounds`](super::bounds); missing texels are sky, missing bounds bound nothing.
    pub fn new(face: u32, inverse: &'a [f32], bounds: &'a [f32]) -> DistanceCube<'a> {
        DistanceCube { face: face.max(1), inverse, bounds }
    }

    /// Texels along an edge.
    pub fn face(&self) -> u32 {
        self.face
    }

    /// Unit direction of the middle of a texel, in the world.
    pub fn direction(face: u32, side: u32, x: u32, y: u32) -> Vec3 {
        mirrored(cube::direction(side, on_face(x, y, Vec2::splat(0.5), face)))
    }

    /// What is kept of a distance in the direction of a texel; of none for the sky.
    pub fn kept(face: u32, x: u32, y: u32, distance: Option<f32>) -> f32 {
        let p = on_face(x, y, Vec2::splat(0.5), face);
        distance.filter(|d| *d > 0.0).map_or(0.0, |distance| stretch(p) / distance)
    }

    /// Metres to the surface in a world direction; 0 for the sky. Between texels of one surface by their depths, at a jump that
    /// of the nearest texel: means of both sides would make surfaces that are not there.
    pub fn distance(&self, direction: Vec3) -> f32 {
        let (side, p) = cube::face_point(mirrored(direction));
        let n = self.face;
        let at = (0.5 * p + 0.5) * n as f32 - 0.5;
        // Beyond the outer texels the line of the last two goes on.
        let last = n.saturating_sub(2) as f32;
        let low = at.floor().clamp(Vec2::ZERO, Vec2::splat(last));
        let t = at - low;
        let corners = self.corners(side, low.x as u32, low.y as u32);
        let [least, most] = [corners.into_iter().fold(f32::MAX, f32::min), corners.into_iter().fold(0.0, f32::max)];
        let inverse = if least > 0.0 && most <= JUMP * least {
            let [a, b, c, d] = corners;
            let (top, bottom) = (a + (b - a) * t.x, c + (d - c) * t.x);
            top + (bottom - top) * t.y
        } else {
            corners[usize::from(t.x >= 0.5) + 2 * usize::from(t.y >= 0.5)]
        };
        if inverse > 0.0 { stretch(p) / inverse } else { 0.0 }
    }

    /// What is kept at the corners of a quad, which lies between the middles of four texels: by rows from its first texel on.
    pub fn corners(&self, side: u32, x: u32, y: u32) -> [f32; 4] {
        let n = self.face;
        let texel = |x: u32, y: u32| {
            let index = (side * n + y.min(n - 1)) * n + x.min(n - 1);
            self.inverse.get(index as usize).copied().unwrap_or(0.0)
        };
        [texel(x, y), texel(x + 1, y), texel(x, y + 1), texel(x + 1, y + 1)]
    }

    /// Least and greatest of what is kept in a cell of a level from 1 on, and a little beyond.
    pub fn bounds(&self, level: u32, side: u32, x: u32, y: u32) -> [f32; 2] {
        let first = 2 * Cells::new(self.face).index(level, side, x, y);
        self.bounds.get(first..first + 2).map_or([0.0, f32::INFINITY], |pair| [pair[0], pair[1]])
    }
}

/// Length of the vector to a point of a face at depth 1.
fn stretch(p: Vec2) -> f32 {
    (1.0 + p.length_squared()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling::Random;

    fn cube_of(face: u32, distance: impl Fn(Vec3) -> Option<f32>) -> Vec<f32> {
        let places = (0..6).flat_map(|side| (0..face * face).map(move |i| (side, i % face, i / face)));
        let kept = |(side, x, y)| DistanceCube::kept(face, x, y, distance(DistanceCube::direction(face, side, x, y)));
        places.map(kept).collect()
    }

    #[test]
    fn walls_are_exact_between_texels_but_for_their_corners() {
        let room = |d: Vec3| Vec3::new(1.0, 2.0, 1.5).map(|half| half) / d.abs();
        let wall = |d: Vec3| room(d).min_element();
        let inverse = cube_of(32, |d| Some(wall(d)));
        let cube = DistanceCube::new(32, &inverse, &[]);
        let mut random = Random::new(1);
        let (mut exact, all) = (0, 4000);
        for _ in 0..all {
            let u = random.point2();
            let (sin, cos) = (std::f32::consts::TAU * u.x).sin_cos();
            let z = 1.0 - 2.0 * u.y;
            let level = (1.0 - z * z).sqrt();
            let d = Vec3::new(level * cos, z, level * sin).normalize();
            let error = (cube.distance(d) / wall(d) - 1.0).abs();
            assert!(error < 0.08, "{d}: {} {}", cube.distance(d), wall(d));
            exact += u32::from(error < 1e-4);
        }
        assert!(exact * 100 > all * 85, "{exact} of {all}");
    }

    #[test]
    fn the_sky_has_no_distance_and_no_edge_of_its_own() {
        let inverse = cube_of(16, |d| (d.y < 0.0).then_some(2.0));
        let cube = DistanceCube::new(16, &inverse, &[]);
        for i in 0..500 {
            let y = 1.0 - (i as f32 + 0.5) / 250.0;
            let (sin, cos) = (2.4 * i as f32).sin_cos();
            let d = Vec3::new((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin);
            let found = cube.distance(d);
            // At the horizon the depth of the nearest texel stands for half a texel around it: 3 % at 16 texels.
            assert!(found == 0.0 || (found - 2.0).abs() < 0.08, "{d}: {found}");
        }
        assert_eq!((cube.distance(Vec3::Y), DistanceCube::new(0, &[], &[]).distance(Vec3::X)), (0.0, 0.0));
    }
}
