//! Environment light: levels, prefiltering, and the light of whole surfaces, with formulas in the place of maps.

use burnish_core::lighting::classical::{self, Lobes, Maps, MeanFresnel, Source};
use burnish_core::math::frame::Frame;
use glam::{Quat, Vec2, Vec3, Vec4, Vec4Swizzles};

use crate::curves::Curves;
use crate::grid::{self, v4};
use crate::harness::Case;
use crate::surface::{self, Variant};

pub fn cases() -> Vec<Case> {
    let leaf = &classical::WGSL;
    vec![
        Case::new("classical: levels and footprints", leaf, LEVELS, levels_inputs, levels),
        Case::new("classical: prefiltering with bright sources", leaf, PREFILTER, prefilter_inputs, prefilter),
        Case::new("classical: the light of whole surfaces", leaf, ENVIRONMENT, environment_inputs, environment)
            .with(surface::WGSL),
    ]
}

/// Maps that are formulas; twin of those in externs.wgsl.
struct Formulas;

const RADIANCE_LEVELS: f32 = 9.0;
const PREFILTERED_LEVELS: f32 = 6.0;
const WIDE: f32 = 0.2;
const SOURCES: [Source; 2] = [
    Source { direction: Vec3::new(0.48, 0.6, 0.64), power: Vec3::new(0.3, 0.2, 0.1) },
    Source { direction: Vec3::new(-0.64, 0.48, 0.6), power: Vec3::new(0.05, 0.1, 0.15) },
];

fn light(d: Vec3, level: f32) -> Vec3 {
    Vec3::new(1.2 + d.x, 1.5 + d.y * d.z, 1.3 - 0.8 * d.z) / (1.0 + 0.2 * level)
}

impl Maps for Formulas {
    fn radiance(&self, direction: Vec3, level: f32) -> Vec3 {
        light(direction, level)
    }

    fn dimmed(&self, d: Vec3, level: f32) -> Vec3 {
        0.7 * light(Vec3::new(d.y, d.z, d.x), level)
    }

    fn source_count(&self) -> usize {
        SOURCES.len()
    }

    fn source(&self, index: usize) -> Source {
        SOURCES[index]
    }

    fn wide_alpha(&self) -> f32 {
        WIDE
    }

    fn prefiltered(&self, d: Vec3, level: f32) -> Vec3 {
        light(Vec3::new(d.z, d.x, d.y), 2.0 * level)
    }

    fn irradiance(&self, normal: Vec3) -> Vec3 {
        3.0 * light(normal, 1.0)
    }

    fn radiance_levels(&self) -> f32 {
        RADIANCE_LEVELS
    }

    fn prefiltered_levels(&self) -> f32 {
        PREFILTERED_LEVELS
    }
}

const LEVELS: &str = "
    let levels = x[1].x;
    let level = classical_level(x[1].y, levels);
    y[0].x = level;
    y[0].y = classical_roughness(x[1].z, levels);
    y[0].z = classical_footprint(x[0].xyz, x[1].w, u32(x[0].w), levels, 0.0);
    y[0].w = classical_footprint(x[0].xyz, x[1].w, u32(x[0].w), levels, 1.0);
";

/// Levels of a small cube and a large one, below, at and above both ends.
fn levels_inputs() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for levels in [1.0, 2.0, 6.0, 9.0, 12.0] {
        for (i, d) in grid::sphere().into_iter().enumerate() {
            let n = [1.0, 16.0, 256.0, 4096.0][i % 4];
            for (j, pdf) in [0.0, 1e-6, 0.08, 0.5, 30.0, 1e5].into_iter().enumerate() {
                let roughness = (i * 6 + j) as f32 / 400.0 - 0.1;
                // Aside of the coarsest level, where the root is steep and the two ends meet.
                let level = [-1.0, 0.0, 0.3, 0.77, 0.95, 2.0][j] * (levels - 1.0);
                inputs.push([v4(d, n), Vec4::new(levels, roughness, level, pdf)]);
            }
        }
    }
    inputs
}

fn levels(x: &[Vec4; 2]) -> [Vec4; 1] {
    let (levels, n) = (x[1].x, x[0].w as u32);
    let footprint = |blur| classical::footprint(x[0].xyz(), x[1].w, n, levels, blur);
    [Vec4::new(
        classical::level(x[1].y, levels),
        classical::roughness(x[1].z, levels),
        footprint(0.0),
        footprint(classical::OVERLAP),
    )]
}

const PREFILTER: &str = "
    y[0] = vec4f(classical_prefilter(x[0].xyz, x[0].w, u32(x[1].x), x[1].y, u32(x[1].z)), 0.0);
";

fn prefilter_inputs() -> Vec<[Vec4; 2]> {
    let normals = grid::sphere().into_iter().step_by(5).chain(SOURCES.map(|source| source.direction));
    let mut inputs = Vec::new();
    for normal in normals {
        for alpha in [1e-3, 0.01, 0.09, 0.36, 1.0] {
            for (n, sources) in [(1.0, 0.0), (64.0, 1.0), (256.0, 2.0)] {
                inputs.push([v4(normal, alpha), Vec4::new(n, RADIANCE_LEVELS, sources, 0.0)]);
            }
        }
    }
    inputs
}

fn prefilter(x: &[Vec4; 2]) -> [Vec4; 1] {
    let sources = &SOURCES[..x[1].z as usize];
    [v4(classical::prefilter((light, RADIANCE_LEVELS), x[0].xyz(), x[0].w, x[1].x as u32, sources), 0.0)]
}

const ENVIRONMENT: &str = "
    let s = parity_surface(x[0], x[1], x[2], x[3]);
    let table = parity_curve_albedo(u32(x[3].x), s.masking);
    let base = Frame(x[5].xyz, x[6].xyz, x[7].xyz);
    let coat = Frame(x[8].xyz, x[9].xyz, x[10].xyz);
    let lobes = ClassicalLobes(u32(x[11].x), u32(x[11].y), x[11].zw, x[12].x, x[12].y, x[12].z);
    y[0] = vec4f(classical_environment(s, table, base, coat, x[4].xyz, x[4].w, lobes), 0.0);
";

fn variants() -> Vec<Variant> {
    // Narrow, narrow one way, wide one way, wide: the last two lie above `WIDE` and reflect the sources one by one.
    let widths = [Vec2::splat(1e-3), Vec2::new(0.03, 0.5), Vec2::new(0.7, 0.1), Vec2::new(0.25, 0.4), Vec2::ONE];
    surface::variants(&widths)
}

/// Every surface from every side, with the split sum and with samples, open and occluded.
fn environment_inputs() -> Vec<[Vec4; 13]> {
    let base = Frame::with_tangent(Vec3::new(0.36, 0.48, 0.8), Vec3::X);
    let turn = Quat::from_axis_angle(Vec3::new(0.6, -0.8, 0.0), 0.2);
    let coat = Frame { t: turn * base.t, b: turn * base.b, n: turn * base.n };
    let frames = [base.t, base.b, base.n, coat.t, coat.b, coat.n].map(|v| v4(v, 0.0));
    let maps = Vec4::new(RADIANCE_LEVELS, PREFILTERED_LEVELS, WIDE, 0.0);
    let views: Vec<Vec3> = grid::directions().into_iter().step_by(3).map(|w| base.to_world(w)).collect();
    let mut inputs = Vec::new();
    for (i, variant) in variants().into_iter().enumerate() {
        for (j, view) in views.iter().enumerate() {
            let occlusion = [1.0, 0.4, 0.0][(i + j) % 3];
            for samples in [0.0, 16.0] {
                let head = [&surface::pack(variant)[..], &[v4(*view, occlusion)]].concat();
                let lobes = Vec4::new(samples, SOURCES.len() as f32, 0.3, 0.7);
                let all = [&head[..], &frames, &[lobes, maps]].concat();
                inputs.extend(<[Vec4; 13]>::try_from(all));
            }
        }
    }
    inputs
}

fn environment(x: &[Vec4; 13]) -> [Vec4; 1] {
    let s = surface::unpack(x);
    let curve = &Curves::get().all[x[3].x as usize];
    let mean = match &curve.albedo {
        Some(tables) => MeanFresnel::Table(&tables[s.masking as usize]),
        None => MeanFresnel::Schlick,
    };
    let frame = |i: usize| Frame { t: x[i].xyz(), b: x[i + 1].xyz(), n: x[i + 2].xyz() };
    let lobes = Lobes { samples: x[11].x as u32, rotation: x[11].zw() };
    [v4(classical::environment(&Formulas, &s, mean, &frame(5), &frame(8), x[4].xyz(), x[4].w, lobes), 0.0)]
}
