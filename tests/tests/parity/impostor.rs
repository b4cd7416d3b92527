//! Distance impostors.

use burnish_core::lighting::impostor::{self, Effort, Extent, Solver};
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

const SOLVE: &str = "
    let effort = ImpostorEffort(u32(x[0].w), u32(x[1].w), 24u, 1e9);
    let found = impostor_solve(parity_extent(), x[0].xyz, x[1].xyz, effort);
    y[0] = vec4f(found.t, found.ratio, select(0.0, 1.0, found.is_hit), f32(found.lookups));
    y[1] = vec4f(impostor_direction(found, x[0].xyz, x[1].xyz), 0.0);
";

const LEVEL: &str = "
    y[0] = vec4f(impostor_level(x[0].x, x[0].y, x[0].z, x[0].w), 0.0, 0.0, 0.0);
";

/// Points in the room, in its middle, near a wall and outside, by every solver.
fn rays() -> Vec<[Vec4; 2]> {
    let points = [
        Vec3::ZERO,
        Vec3::new(0.3, -0.2, 0.4),
        Vec3::new(-0.5, 0.45, 0.1),
        Vec3::new(0.1, 0.8, -0.6),
        Vec3::new(-0.85, 0.0, 0.2),
        Vec3::new(3.0, 0.5, 0.0),
    ];
    let mut inputs = Vec::new();
    for (number, _) in Solver::ALL.iter().enumerate() {
        for point in points {
            for i in 0..120 {
                let y = 1.0 - (i as f32 + 0.5) / 60.0;
                let (sin, cos) = (2.399_963 * i as f32).sin_cos();
                let level = (1.0 - y * y).sqrt();
                let direction = Vec3::new(level * cos, y, level * sin).normalize();
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
