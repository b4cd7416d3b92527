//! Distance impostors.

use burnish_core::lighting::impostor::{self, Effort, Extent, Solver};
use burnish_core::lighting::probe::{DistanceCube, bounds};
use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::grid::v4;
use crate::harness::{Case, Tolerance};

const EXTENT: Extent =
    Extent { near: 0.9, far: 2.0, radius: 1.3, low: Vec3::new(-1.1, -0.9, -1.0), high: Vec3::new(1.0, 1.2, 1.1) };

pub fn cases() -> Vec<Case> {
    vec![
        Case::new("impostor: where rays meet the surroundings", &impostor::WGSL, SOLVE, rays, |x| {
            let effort = Effort {
                solver: Solver::ALL[x[0].w as usize],
                refinements: x[1].w as u32,
                steps: 24,
                // What is on a surface and what is not differ by a rounding.
                tolerance: 1e9,
            };
            let (p, r) = (x[0].xyz(), x[1].xyz());
            let found = impostor::solve(&distance, &EXTENT, p, r, &effort);
            let hit = if found.is_hit { 1.0 } else { 0.0 };
            [v4(Vec3::new(found.t, found.ratio, hit), found.lookups as f32), v4(found.direction(p, r), 0.0)]
        })
        .with(HELPERS)
        // A secant divides by the difference of two ratios: what they are rounded by grows a hundredfold.
        .within(Tolerance { relative: 2e-3, absolute: 2e-4 }),
        Case::new(
            "impostor: where rays meet what a cube keeps, by its bounds",
            &impostor::WGSL,
            BY_BOUNDS,
            ways,
            |x| {
                let inverse = kept();
                let bounds = bounds(FACE, &inverse);
                let cube = DistanceCube::new(FACE, &inverse, &bounds);
                let effort = Effort { solver: Solver::Pyramid, refinements: 0, steps: 200, tolerance: 0.01 };
                let (p, r) = (x[0].xyz(), x[1].xyz());
                let found = impostor::solve(&cube, &WIDE, p, r, &effort);
                let hit = if found.is_hit { 1.0 } else { 0.0 };
                [Vec4::new(found.t, found.ratio, hit, 0.0)]
            },
        )
        .with(HELPERS)
        .within(Tolerance { relative: 1e-4, absolute: 1e-4 }),
        Case::new("impostor: levels for surfaces nearer than the middle", &impostor::WGSL, LEVEL, levels, |x| {
            [Vec4::new(impostor::level(x[0].x, x[0].y, x[0].z, x[0].w), 0.0, 0.0, 0.0)]
        })
        .within(Tolerance { relative: 1e-4, absolute: 1e-5 }),
    ]
}

/// The room of `impostor_distance` in externs.wgsl.
fn distance(d: Vec3) -> f32 {
    (1.0 + 0.1 * d.x * d.y) / d.abs().max_element()
}

const HELPERS: &str = "
fn parity_extent() -> ImpostorExtent {
    return ImpostorExtent(0.9, 2.0, 1.3, vec3f(-1.1, -0.9, -1.0), vec3f(1.0, 1.2, 1.1));
}
";

/// Texels along an edge in externs.wgsl.
const FACE: u32 = 12;
/// What the distances there say as a whole.
const WIDE: Extent = Extent { near: 1.0, far: 3.5, radius: 1.5, low: Vec3::splat(-2.0), high: Vec3::splat(2.0) };

/// Twin of `parity_kept`.
fn kept() -> Vec<f32> {
    let texel = |i: u32| {
        let (side, y, x) = (i / (FACE * FACE), i / FACE % FACE, i % FACE);
        match (x, y) {
            (9.., 6..) => 0.0,
            (6.., 6..) => 0.9,
            _ => 0.5 + 0.01 * (side + x) as f32 + 0.005 * y as f32,
        }
    };
    (0..6 * FACE * FACE).map(texel).collect()
}

const BY_BOUNDS: &str = "
    let extent = ImpostorExtent(1.0, 3.5, 1.5, vec3f(-2.0), vec3f(2.0));
    let found = impostor_solve(extent, x[0].xyz, x[1].xyz, ImpostorEffort(IMPOSTOR_PYRAMID, 0u, 200u, 0.01));
    y[0] = vec4f(found.t, found.ratio, select(0.0, 1.0, found.is_hit), 0.0);
";

const SOLVE: &str = "
    let effort = ImpostorEffort(u32(x[0].w), u32(x[1].w), 24u, 1e9);
    let found = impostor_solve(parity_extent(), x[0].xyz, x[1].xyz, effort);
    y[0] = vec4f(found.t, found.ratio, select(0.0, 1.0, found.is_hit), f32(found.lookups));
    y[1] = vec4f(impostor_direction(found, x[0].xyz, x[1].xyz), 0.0);
";

const LEVEL: &str = "
    y[0] = vec4f(impostor_level(x[0].x, x[0].y, x[0].z, x[0].w), 0.0, 0.0, 0.0);
";

/// In the room, in its middle, near a wall and outside.
const POINTS: [Vec3; 6] = [
    Vec3::ZERO,
    Vec3::new(0.3, -0.2, 0.4),
    Vec3::new(-0.5, 0.45, 0.1),
    Vec3::new(0.1, 0.8, -0.6),
    Vec3::new(-0.85, 0.0, 0.2),
    Vec3::new(3.0, 0.5, 0.0),
];

/// All around.
fn direction(i: u32) -> Vec3 {
    let y = 1.0 - (i as f32 + 0.5) / 60.0;
    let (sin, cos) = (2.399_963 * i as f32).sin_cos();
    let level = (1.0 - y * y).sqrt();
    Vec3::new(level * cos, y, level * sin).normalize()
}

/// From the points, all but the middle, whose rays stay in one direction.
fn ways() -> Vec<[Vec4; 2]> {
    let all = POINTS.into_iter().skip(1).flat_map(|point| (0..120).map(move |i| (point, direction(i))));
    all.map(|(point, direction)| [point.extend(0.0), direction.extend(0.0)]).collect()
}

/// From the points by every solver that needs distances alone.
fn rays() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for (number, _) in Solver::ALL.iter().enumerate().filter(|(_, solver)| **solver != Solver::Pyramid) {
        for point in POINTS {
            for i in 0..120 {
                let direction = direction(i);
                // Later secant steps go between places that are one already.
                inputs.push([point.extend(number as f32), direction.extend((i % 3) as f32)]);
            }
        }
    }
    inputs
}

fn levels() -> Vec<[Vec4; 1]> {
    let lengths = [0.0, 1e-3, 0.25, 1.0, 3.0, 1e9];
    let pairs = lengths.iter().flat_map(|t| lengths.map(|distance| (*t, distance)));
    pairs.flat_map(|(t, distance)| [0.0, 2.5, 7.0].map(|level| [Vec4::new(level, t, distance, 7.0)])).collect()
}
