//! Cube maps of half floats with all their levels, made and looked up on the processor as a device does it.

use glam::{Vec2, Vec3};
use half::f16;
use rayon::prelude::*;

use super::MethodError;
use crate::job::Handle;
use crate::math::cube;

/// Largest number that a texel holds.
const MAX: f32 = 65_000.0;

/// A cube map that is looked up. Directions are those of the cube, mirrored in z against the world, see
/// [`cube::direction`].
#[derive(Clone, Copy, Debug)]
pub struct CubeMap<'a> {
    face: u32,
    levels: u32,
    texels: &'a [f16],
}

/// A cube map that is filled level by level, the finest first: within a level by faces, rows, texels; R, G, B.
#[derive(Clone, Debug)]
pub struct CubeMapBuilder {
    face: u32,
    levels: u32,
    texels: Vec<f16>,
}

/// Where a level starts, in numbers: after the sum of a quarter less of each finer one, faces being powers of two.
fn start(face: u32, level: u32) -> usize {
    24 * ((face as usize).pow(2) - (edge(face, level) as usize).pow(2))
}

/// Numbers of a level.
fn numbers(face: u32, level: u32) -> usize {
    18 * (edge(face, level) as usize).pow(2)
}

/// Texels along the edge of a level of a cube map with `face` texels along that of its finest.
fn edge(face: u32, level: u32) -> u32 {
    (face >> level).max(1)
}

impl<'a> CubeMap<'a> {
    /// With `face` texels along an edge of the finest level, a power of two; numbers that are missing are zero.
    pub fn new(face: u32, levels: u32, texels: &'a [f16]) -> CubeMap<'a> {
        CubeMap { face: face.max(1), levels: levels.max(1), texels }
    }

    /// How many levels there are.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Texels along an edge of a level.
    pub fn edge(&self, level: u32) -> u32 {
        edge(self.face, level)
    }

    /// Linear in the direction, over the edges of faces too, and between levels.
    pub fn lookup(&self, direction: Vec3, level: f32) -> Vec3 {
        let level = level.clamp(0.0, (self.levels - 1) as f32);
        let (low, t) = (level as u32, level.fract());
        let fine = self.bilinear(direction, low);
        if t > 0.0 { fine.lerp(self.bilinear(direction, low + 1), t) } else { fine }
    }

    fn bilinear(&self, direction: Vec3, level: u32) -> Vec3 {
        let (face, p) = cube::face_point(direction);
        let at = (0.5 * p + 0.5) * self.edge(level) as f32 - 0.5;
        let low = at.floor();
        let t = at - low;
        let (x, y) = (low.x as i32, low.y as i32);
        let row = |y| self.wrapped(level, face, x, y).lerp(self.wrapped(level, face, x + 1, y), t.x);
        row(y).lerp(row(y + 1), t.y)
    }

    /// A texel, or where `x` or `y` are one beyond the face that of its neighbour.
    fn wrapped(&self, level: u32, face: u32, x: i32, y: i32) -> Vec3 {
        let n = self.edge(level) as i32;
        let inside = |v: i32| (0..n).contains(&v);
        if inside(x) && inside(y) {
            return self.texel(level, face, x as u32, y as u32);
        }
        // A hair beyond the edge, where the faces agree on the place along it. At a corner one of the two neighbours.
        let center = |v: i32| (2.0 * v as f32 + 1.0) / n as f32 - 1.0;
        let beyond = |v: i32| if v < 0 { -1.0 - 1e-5 } else { 1.0 + 1e-5 };
        let p = match (inside(x), inside(y)) {
            (false, _) => Vec2::new(beyond(x), center(y.clamp(0, n - 1))),
            _ => Vec2::new(center(x), beyond(y)),
        };
        let (face, p) = cube::face_point(cube::direction(face, p));
        let nearest = |v: f32| ((0.5 * v + 0.5) * n as f32).clamp(0.0, (n - 1) as f32) as u32;
        self.texel(level, face, nearest(p.x), nearest(p.y))
    }

    /// A texel of a face of a level.
    pub fn texel(&self, level: u32, face: u32, x: u32, y: u32) -> Vec3 {
        let n = self.edge(level);
        let place = start(self.face, level) + 3 * ((face * n + y) * n + x) as usize;
        self.texels.get(place..place + 3).map_or(Vec3::ZERO, |c| Vec3::new(c[0].to_f32(), c[1].to_f32(), c[2].to_f32()))
    }
}

impl CubeMapBuilder {
    /// Black, with `face` texels along an edge of the finest of `levels`; a power of two, and no more than it has.
    pub fn new(face: u32, levels: u32) -> CubeMapBuilder {
        CubeMapBuilder { face, levels, texels: vec![f16::ZERO; start(face, levels - 1) + numbers(face, levels - 1)] }
    }

    /// Computes a level on the current rayon pool: `f` gets level `level`'s finer one (itself for the finest), the face
    /// and the point of a texel's middle on it with its column and row. Ends early when the job is cancelled.
    pub fn fill(&mut self, level: u32, job: &Handle, f: impl Fn(&Texel<'_>) -> Vec3 + Sync) -> Result<(), MethodError> {
        let (face, levels, n) = (self.face, self.levels, edge(self.face, level));
        let (finer, rest) = self.texels.split_at_mut(start(face, level));
        let finer = CubeMap::new(face, levels, finer);
        let rows = rest[..numbers(face, level)].par_chunks_mut(3 * n as usize).enumerate();
        rows.try_for_each(|(row, texels)| {
            if job.is_cancelled() {
                return Err(MethodError::Cancelled);
            }
            let (side, y) = (row as u32 / n, row as u32 % n);
            for (x, texel) in texels.chunks_exact_mut(3).enumerate() {
                let at = Texel { finer: &finer, level, face: side, x: x as u32, y, edge: n };
                let value = f(&at).clamp(Vec3::ZERO, Vec3::splat(MAX));
                texel.copy_from_slice(&value.to_array().map(f16::from_f32));
            }
            Ok(())
        })
    }

    /// Computes the levels above the finest from it, each the mean of the one before by solid angle.
    pub fn downsample(&mut self, job: &Handle) -> Result<(), MethodError> {
        (1..self.levels).try_for_each(|level| self.fill(level, job, |texel| texel.mean_of_finer()))
    }

    /// Takes a level over from another cube.
    pub fn copy(&mut self, level: u32, from: &CubeMap<'_>, from_level: u32) {
        let to = start(self.face, level);
        let from_start = start(from.face, from_level);
        let count = numbers(self.face, level).min(from.texels.len().saturating_sub(from_start));
        self.texels[to..to + count].copy_from_slice(&from.texels[from_start..from_start + count]);
    }

    /// As far as it is made.
    pub fn map(&self) -> CubeMap<'_> {
        CubeMap::new(self.face, self.levels, &self.texels)
    }

    /// Its numbers, as [`CubeMap::new`] takes them.
    pub fn into_texels(self) -> Vec<f16> {
        self.texels
    }
}

/// A texel that is computed.
#[derive(Clone, Copy, Debug)]
pub struct Texel<'a> {
    finer: &'a CubeMap<'a>,
    level: u32,
    /// The face.
    pub face: u32,
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Texels along the edge of its level.
    pub edge: u32,
}

impl Texel<'_> {
    /// Direction of a point of the texel, `inside` in [0, 1]^2.
    pub fn direction(&self, inside: Vec2) -> Vec3 {
        cube::direction(self.face, on_face(self.x, self.y, inside, self.edge))
    }

    fn mean_of_finer(&self) -> Vec3 {
        let finer = self.level - 1;
        let n = self.finer.edge(finer);
        let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
        for i in 0..4 {
            let (x, y) = ((2 * self.x + (i & 1)).min(n - 1), (2 * self.y + (i >> 1)).min(n - 1));
            // Texels of a corner are smaller than those of a face's middle.
            let w = cube::weight(on_face(x, y, Vec2::splat(0.5), n));
            sum += w * self.finer.texel(finer, self.face, x, y);
            weight += w;
        }
        sum / weight
    }
}

/// A point of a texel on its face.
pub fn on_face(x: u32, y: u32, inside: Vec2, edge: u32) -> Vec2 {
    (Vec2::new(x as f32, y as f32) + inside) / edge as f32 * 2.0 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smooth function of the direction.
    fn light(d: Vec3) -> Vec3 {
        Vec3::new(1.0 + d.x, 1.0 + d.y * d.z, 1.0 - 0.5 * d.z)
    }

    fn cube_of_light(face: u32) -> CubeMapBuilder {
        let mut builder = CubeMapBuilder::new(face, face.ilog2() + 1);
        builder.fill(0, &Handle::default(), |texel| light(texel.direction(Vec2::splat(0.5)))).unwrap();
        builder.downsample(&Handle::default()).unwrap();
        builder
    }

    #[test]
    fn lookups_are_smooth_over_edges_and_corners_of_faces() {
        let builder = cube_of_light(64);
        for i in 0..2000 {
            let (u, phi) = (1.0 - 2.0 * (i as f32 + 0.5) / 2000.0, i as f32 * 2.399_963);
            let d = Vec3::new((1.0 - u * u).sqrt() * phi.cos(), u, (1.0 - u * u).sqrt() * phi.sin());
            // Beyond an edge a texel of the neighbour stands for one that is a little elsewhere.
            assert!(builder.map().lookup(d, 0.0).abs_diff_eq(light(d), 4e-3), "{d}");
        }
    }

    #[test]
    fn a_level_between_two_lies_between_them_and_the_coarsest_is_the_mean() {
        let builder = cube_of_light(32);
        let (map, d) = (builder.map(), Vec3::new(0.6, 0.0, 0.8));
        let mid = map.lookup(d, 1.5);
        assert!(mid.abs_diff_eq(0.5 * (map.lookup(d, 1.0) + map.lookup(d, 2.0)), 1e-5));
        let mean: Vec3 = (0..6).map(|face| map.texel(5, face, 0, 0)).sum::<Vec3>() / 6.0;
        assert!(mean.abs_diff_eq(Vec3::ONE, 2e-3), "{mean}");
        assert_eq!(map.lookup(d, 99.0), map.lookup(d, 5.0));
    }

    #[test]
    fn a_cancelled_job_ends_it() {
        let job = Handle::default();
        job.cancel();
        assert_eq!(CubeMapBuilder::new(8, 1).fill(0, &job, |_| Vec3::ONE), Err(MethodError::Cancelled));
    }
}
