//! The cubes of an environment: how large they are, and how the processor makes them. The twin of `environment.wgsl` of the
//! renderer.

use glam::{Vec2, Vec3};

use super::{Maps, PREFILTER_SOURCES, SHADING_SOURCES, Source, Split, block_angle, prefilter, prefilter_samples};
use super::{roughness, shading_block, split, wide_alpha};
use crate::job::Handle;
use crate::lighting::cube_map::{CubeMap, CubeMapBuilder, on_face};
use crate::lighting::{MethodError, Prepared};
use crate::math::cube::{self, mirrored};
use crate::scene::Environment;
use crate::scene::environment::Turn;

/// Largest value stored in a cube.
const STORED_MAX: f32 = 60_000.0;
/// Largest edge of a face; beyond it the cubes cost more memory than the eye gains.
const FACE_MAX: u32 = 1024;
/// Smallest edge of a face: below it there would be too few levels to tell one roughness from another.
const FACE_MIN: u32 = 64;
/// Edge of the coarsest prefiltered level: its lobe is a hemisphere wide.
const COARSEST: u32 = 8;
/// Edge of a face of the irradiance cube.
pub const IRRADIANCE_FACE: u32 = 16;
/// Edge of the level of radiance from which irradiance is summed.
const IRRADIANCE_SOURCE: u32 = 32;

/// Sizes of the cubes of an environment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CubeSizes {
    /// Edge of level 0 of the cubes of radiance.
    pub radiance: u32,
    /// Edge of level 0 of the prefiltered cube.
    pub prefiltered: u32,
    /// Edge of the level of radiance from which irradiance is summed.
    pub irradiance_source: u32,
}

impl CubeSizes {
    /// For the best cubes that a map of `width` columns is worth.
    pub fn full(width: u32) -> CubeSizes {
        let face = (width / 2).next_power_of_two().clamp(FACE_MIN, FACE_MAX);
        CubeSizes { radiance: face, prefiltered: face, irradiance_source: IRRADIANCE_SOURCE }
    }

    /// For cubes that are made in a moment from a small map.
    pub fn coarse(width: u32) -> CubeSizes {
        let face = (width / 2).next_power_of_two().clamp(FACE_MIN, 2 * FACE_MIN);
        CubeSizes { radiance: face, prefiltered: FACE_MIN, irradiance_source: IRRADIANCE_SOURCE / 2 }
    }

    /// Levels of the cubes of radiance.
    pub fn levels(&self) -> u32 {
        self.radiance.ilog2() + 1
    }

    /// Levels of the prefiltered cube.
    pub fn prefiltered_levels(&self) -> u32 {
        self.prefiltered.ilog2() + 1 - COARSEST.ilog2()
    }
}

/// Factor from a texel of a cube to radiance: cubes hold half floats, and a sun is beyond their range.
pub fn cube_scale(environment: &Environment) -> f32 {
    let largest = environment.texels.iter().map(|c| c.max_element()).fold(0.0, f32::max);
    (largest / STORED_MAX).max(1.0)
}

/// Makes the cubes of a map; its rotation and strength are left to lookups.
pub fn prepare(map: &Environment, job: &Handle) -> Result<Prepared, MethodError> {
    // In its own frame.
    let map = &Environment { rotation: 0.0, strength: 1.0, tint: Vec3::ONE, ..map.clone() };
    let (sizes, scale) = (CubeSizes::full(map.width), cube_scale(map));
    let block = shading_block(map.width);
    let Split { dimmed, sources } = split(map, block, SHADING_SOURCES);
    let radiance = radiance_cube(map, sizes, scale, job)?;
    job.set_progress(0.2);
    let irradiance = irradiance_cube(&radiance.map(), sizes, job)?;
    let dimmed = radiance_cube(&dimmed, sizes, scale, job)?;
    job.set_progress(0.4);
    let without_texels = split(map, 1, PREFILTER_SOURCES);
    let dark = radiance_cube(&without_texels.dimmed, sizes, scale, job)?;
    let over_scale = |s: &Source| Source { power: s.power / scale, ..*s };
    let bright: Vec<Source> = without_texels.sources.iter().map(over_scale).collect();
    let prefiltered = prefiltered_cube(map.width, (&radiance.map(), &dark.map(), &bright), sizes, job)?;
    let sources =
        sources.iter().map(over_scale).flat_map(|s| [s.direction, s.power]).flat_map(|v| v.to_array()).collect();
    Ok(Prepared::nothing()
        .with("radiance", radiance.into_texels())
        .with("dimmed", dimmed.into_texels())
        .with("prefiltered", prefiltered.into_texels())
        .with("irradiance", irradiance.into_texels())
        .with("sources", sources)
        .with("scale", vec![scale])
        .with("width", vec![map.width]))
}

/// Radiance over scale, box-filtered.
fn radiance_cube(map: &Environment, sizes: CubeSizes, scale: f32, job: &Handle) -> Result<CubeMapBuilder, MethodError> {
    let mut builder = CubeMapBuilder::new(sizes.radiance, sizes.levels());
    builder.fill(0, job, |texel| {
        // Near the poles a texel of the cube covers many columns of the map.
        let n = if texel.direction(Vec2::splat(0.5)).y.abs() > 0.9 { 6 } else { 2 };
        let points = (0..n * n).map(|i| (Vec2::new((i % n) as f32, (i / n) as f32) + 0.5) / n as f32);
        let sum: Vec3 = points.map(|inside| map.radiance(mirrored(texel.direction(inside)))).sum();
        sum / (n * n) as f32 / scale
    })?;
    builder.downsample(job)?;
    Ok(builder)
}

/// Integral of radiance times cosine about each direction, over scale.
fn irradiance_cube(radiance: &CubeMap<'_>, sizes: CubeSizes, job: &Handle) -> Result<CubeMapBuilder, MethodError> {
    let level = sizes.radiance.ilog2() - sizes.irradiance_source.ilog2();
    let n = radiance.edge(level);
    let places = (0..6).flat_map(|face| (0..n).flat_map(move |y| (0..n).map(move |x| (face, x, y))));
    let lights: Vec<(Vec3, Vec3, f32)> = places
        .map(|(face, x, y)| {
            let p = on_face(x, y, Vec2::splat(0.5), n);
            let weight = cube::weight(p);
            (cube::direction(face, p), weight * radiance.texel(level, face, x, y), weight)
        })
        .collect();
    let whole: f32 = lights.iter().map(|(.., weight)| weight).sum();
    let mut builder = CubeMapBuilder::new(IRRADIANCE_FACE, 1);
    builder.fill(0, job, |texel| {
        let normal = texel.direction(Vec2::splat(0.5));
        let sum: Vec3 = lights.iter().map(|(d, light, _)| d.dot(normal).max(0.0) * light).sum();
        sum * (4.0 * std::f32::consts::PI / whole)
    })?;
    Ok(builder)
}

/// Radiance over scale, filtered with the lobes of the levels.
fn prefiltered_cube(
    width: u32,
    (radiance, dark, bright): (&CubeMap<'_>, &CubeMap<'_>, &[Source]),
    sizes: CubeSizes,
    job: &Handle,
) -> Result<CubeMapBuilder, MethodError> {
    let levels = sizes.prefiltered_levels();
    let mut builder = CubeMapBuilder::new(sizes.prefiltered, levels);
    // Level 0 is the mirror.
    builder.copy(0, radiance, (sizes.radiance / sizes.prefiltered).ilog2());
    for level in 1..levels {
        let alpha = roughness(level as f32, levels as f32).powi(2);
        // To a lobe narrower than a texel none is a point; its samples are dense enough to find every texel.
        let wide = alpha >= block_angle(width, 1);
        let (from, sources) = if wide { (dark, bright) } else { (radiance, &[][..]) };
        builder.fill(level, job, |texel| {
            let normal = mirrored(texel.direction(Vec2::splat(0.5)));
            let lookup = |d: Vec3, level: f32| from.lookup(mirrored(d), level);
            prefilter((lookup, from.levels() as f32), normal, alpha, prefilter_samples(level), sources)
        })?;
        job.set_progress(0.6 + 0.4 * level as f32 / levels as f32);
    }
    Ok(builder)
}

/// What [`prepare`] made, looked up in the world's directions.
pub struct PreparedMaps<'a> {
    radiance: CubeMap<'a>,
    dimmed: CubeMap<'a>,
    prefiltered: CubeMap<'a>,
    irradiance: CubeMap<'a>,
    sources: &'a [f32],
    wide_alpha: f32,
    /// From a texel to radiance.
    scale: Vec3,
    turn: Turn,
}

impl<'a> PreparedMaps<'a> {
    /// The cubes of an environment; `None` where they were not made.
    pub fn new(prepared: &'a Prepared, environment: &Environment) -> Option<PreparedMaps<'a>> {
        let maps = PreparedMaps::unturned(prepared)?;
        Some(PreparedMaps { scale: maps.scale * environment.scale(), turn: Turn::by(environment.rotation), ..maps })
    }

    /// The cubes as they were made, neither turned nor scaled.
    pub fn unturned(prepared: &'a Prepared) -> Option<PreparedMaps<'a>> {
        let (scale, width) = (*prepared.floats("scale").first()?, *prepared.whole("width").first()?);
        let sizes = CubeSizes::full(width);
        let radiance = |name| CubeMap::new(sizes.radiance, sizes.levels(), prepared.halves(name));
        Some(PreparedMaps {
            radiance: radiance("radiance"),
            dimmed: radiance("dimmed"),
            prefiltered: CubeMap::new(sizes.prefiltered, sizes.prefiltered_levels(), prepared.halves("prefiltered")),
            irradiance: CubeMap::new(IRRADIANCE_FACE, 1, prepared.halves("irradiance")),
            sources: prepared.floats("sources"),
            wide_alpha: wide_alpha(width, shading_block(width)),
            scale: Vec3::splat(scale),
            turn: Turn::by(0.0),
        })
    }

    /// Its cubes: radiance, dimmed, prefiltered, irradiance, all over the scale.
    pub fn cubes(&self) -> [&CubeMap<'a>; 4] {
        [&self.radiance, &self.dimmed, &self.prefiltered, &self.irradiance]
    }

    /// Factor from a texel of unturned cubes to radiance.
    pub fn scale(&self) -> f32 {
        self.scale.x
    }

    /// The sources in the map's own frame, over the scale.
    pub fn stored_sources(&self) -> impl Iterator<Item = Source> + use<'a> {
        let (six, _) = self.sources.as_chunks::<6>();
        six.iter().map(|[x, y, z, r, g, b]| Source { direction: Vec3::new(*x, *y, *z), power: Vec3::new(*r, *g, *b) })
    }

    fn lookup(&self, map: &CubeMap<'_>, direction: Vec3, level: f32) -> Vec3 {
        self.scale * map.lookup(mirrored(self.turn.to_own(direction)), level)
    }
}

impl Maps for PreparedMaps<'_> {
    fn radiance(&self, direction: Vec3, level: f32) -> Vec3 {
        self.lookup(&self.radiance, direction, level)
    }

    fn dimmed(&self, direction: Vec3, level: f32) -> Vec3 {
        self.lookup(&self.dimmed, direction, level)
    }

    fn source_count(&self) -> usize {
        self.sources.len() / 6
    }

    fn source(&self, index: usize) -> Source {
        let [d, power] = [6 * index, 6 * index + 3].map(|at| Vec3::from_slice(&self.sources[at..at + 3]));
        Source { direction: self.turn.to_world(d), power: self.scale * power }
    }

    fn wide_alpha(&self) -> f32 {
        self.wide_alpha
    }

    fn prefiltered(&self, direction: Vec3, level: f32) -> Vec3 {
        self.lookup(&self.prefiltered, direction, level)
    }

    fn irradiance(&self, normal: Vec3) -> Vec3 {
        self.lookup(&self.irradiance, normal, 0.0)
    }

    fn radiance_levels(&self) -> f32 {
        self.radiance.levels() as f32
    }

    fn prefiltered_levels(&self) -> f32 {
        self.prefiltered.levels() as f32
    }
}
