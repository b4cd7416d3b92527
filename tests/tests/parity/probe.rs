//! Probes: how much each counts, and how far away they see the surroundings.

use burnish_core::lighting::impostor::{self, Found, Show};
use burnish_core::lighting::probe::{self, DistanceCube, Place};
use glam::{Vec3, Vec4, Vec4Swizzles};

use crate::grid::v4;
use crate::harness::{Case, Tolerance};

/// Texels along the edge of a face.
const FACE: u32 = 16;

pub fn cases() -> Vec<Case> {
    vec![
        Case::new("probe: weights of several", &probe::WGSL, WEIGHTS, points, |x| {
            let serving = x[0].w as u32;
            let all = (0..4u32).filter(|i| serving & (1 << i) != 0);
            let places: Vec<Place> = all.clone().map(place).collect();
            let weights = probe::weights(&places, x[0].xyz());
            let mut found = [0.0; 4];
            all.zip(&weights).for_each(|(i, weight)| found[i as usize] = *weight);
            [Vec4::from_array(found), Vec4::new(weights.iter().sum(), 0.0, 0.0, 0.0)]
        })
        .with(HELPERS)
        .within(Tolerance { relative: 1e-4, absolute: 1e-4 }),
        Case::new(
            "probe: distances between texels, at jumps and before the sky",
            &probe::WGSL,
            DISTANCE,
            directions,
            |x| [Vec4::new(DistanceCube::new(FACE, &inverse(), &[]).distance(x[0].xyz()), 0.0, 0.0, 0.0)],
        )
        .with(HELPERS),
        Case::new("impostor: colours of a search", &impostor::WGSL, SHOWN, searches, |x| {
            let found = Found { t: 0.0, ratio: x[0].x, lookups: x[0].y as u32, is_hit: x[0].z > 0.5 };
            let show = Show::ALL[x[0].w as usize];
            [v4(impostor::shown(&found, show), 0.0), v4(impostor::error_shown(x[0].x), 0.0)]
        })
        .within(Tolerance { relative: 1e-4, absolute: 1e-4 }),
    ]
}

/// Twin of `probe_place` below.
fn place(index: u32) -> Place {
    let i = index as f32;
    Place { middle: Vec3::new(0.8 * i - 1.0, 0.2 * i, 0.1), half: Vec3::new(1.0 + i, 1e9, 2.0) }
}

/// Twin of `probe_inverse_depth`.
fn inverse() -> Vec<f32> {
    let texel = |i: u32| {
        let (side, y, x) = (i / (FACE * FACE), i / FACE % FACE, i % FACE);
        match (x, y) {
            (12.., 8..) => 0.0,
            (8.., 8..) => 0.9,
            _ => 0.4 + 0.01 * (side + x) as f32 + 0.005 * y as f32,
        }
    };
    (0..6 * FACE * FACE).map(texel).collect()
}

const HELPERS: &str = "
fn probe_place(index: u32) -> ProbePlace {
    let i = f32(index);
    return ProbePlace(vec3f(0.8 * i - 1.0, 0.2 * i, 0.1), vec3f(1.0 + i, 1e9, 2.0));
}

// Half of the texels are a wall, a quarter something nearer, a quarter the sky.
fn probe_inverse_depth(side: u32, x: u32, y: u32) -> f32 {
    if x >= 8u && y >= 8u {
        return select(0.9, 0.0, x >= 12u);
    }
    return 0.4 + 0.01 * f32(side + x) + 0.005 * f32(y);
}
";

const WEIGHTS: &str = "
    let serving = u32(x[0].w);
    for (var i = 0u; i < 4u; i++) {
        y[0][i] = select(0.0, probe_weight(i, serving, x[0].xyz), (serving & (1u << i)) != 0u);
    }
    y[1] = vec4f(probe_weight(PROBE_ALL, serving, x[0].xyz), 0.0, 0.0, 0.0);
";

const DISTANCE: &str = "
    y[0] = vec4f(probe_distance(16u, x[0].xyz), 0.0, 0.0, 0.0);
";

const SHOWN: &str = "
    let found = ImpostorFound(0.0, x[0].x, u32(x[0].y), x[0].z > 0.5);
    y[0] = vec4f(impostor_shown(found, u32(x[0].w)), 0.0);
    y[1] = vec4f(impostor_error_shown(x[0].x), 0.0);
";

/// Points near all of the boxes and outside, for every choice of probes that serve.
fn points() -> Vec<[Vec4; 1]> {
    let grid = (0..9 * 5 * 5).map(|i| Vec3::new((i % 9) as f32, (i / 9 % 5) as f32, (i / 45) as f32));
    let at = |p: Vec3| Vec3::new(0.7 * p.x - 2.6, 0.5 * p.y - 1.1, 1.1 * p.z - 2.2);
    grid.flat_map(|p| (0..16).map(move |serving| [at(p).extend(serving as f32)])).collect()
}

/// All around, off the middles between texels, where a rounding decides which is nearest.
fn directions() -> Vec<[Vec4; 1]> {
    let direction = |i: usize| {
        let y = 1.0 - (i as f32 + 0.5) / 1000.0;
        let (sin, cos) = (2.399_963 * i as f32).sin_cos();
        let level = (1.0 - y * y).sqrt();
        Vec3::new(level * cos, y, level * sin).normalize()
    };
    let halves = |d: &Vec3| {
        let a = d.abs();
        let p = *d / a.max_element();
        let off = |v: f32| ((0.5 * v + 0.5) * FACE as f32).fract();
        [p.x, p.y, p.z].into_iter().all(|v| v.abs() > 0.999_9 || (0.001..0.999).contains(&off(v)))
    };
    (0..2000).map(direction).filter(halves).map(|d| [d.extend(0.0)]).collect()
}

fn searches() -> Vec<[Vec4; 1]> {
    let ratios = [0.0, 0.5, 0.93, 0.999, 1.0, 1.04, 1.7, 30.0, 1e4];
    let all = ratios.into_iter().flat_map(|ratio| (0..40).map(move |i| (ratio, i)));
    all.map(|(ratio, i)| [Vec4::new(ratio, i as f32, (i % 2) as f32, (i % 4) as f32)]).collect()
}
