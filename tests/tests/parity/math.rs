//! Frames, unit vectors on a square and point sets.

use burnish_core::math::frame::Frame;
use burnish_core::math::{self, cube, oct, sampling};
use glam::{Vec2, Vec3, Vec4};

use crate::grid::{self, v4};
use crate::harness::{Case, Tolerance};

pub fn cases() -> Vec<Case> {
    let leaf = &math::WGSL;
    vec![
        Case::new("math: a frame about a direction, to it and from it", leaf, FRAME, frame_inputs, frame),
        Case::new("math: a frame with a tangent", leaf, TANGENT, tangent_inputs, tangent),
        Case::new(
            "math: unit vectors to the square",
            leaf,
            "y[0] = vec4f(oct_encode(x[0].xyz), 0.0, 0.0);",
            vectors,
            |x| [oct::encode(x[0].truncate()).extend(0.0).extend(0.0)],
        ),
        Case::new("math: the square to unit vectors", leaf, "y[0] = vec4f(oct_decode(x[0].xy), 0.0);", points, |x| {
            [v4(oct::decode(x[0].truncate().truncate()), 0.0)]
        }),
        Case::new("math: faces of a cube map", leaf, CUBE, face_points, cube_map),
        Case::new("math: equirectangular coordinates", leaf, EQUIRECTANGULAR, off_axis, equirectangular),
        Case::new("math: the square to the disk and the hemisphere", leaf, DISK, unit_points, disk),
        Case::new("math: hashes and digits are equal to the last bit", leaf, HASH, integers, hash)
            .within(Tolerance::EXACT),
        Case::new("math: point sets", leaf, POINTS, sets, point_sets),
    ]
}

const CUBE: &str = "
    let face = u32(x[0].z);
    y[0] = vec4f(cube_direction(face, x[0].xy), cube_weight(x[0].xy));
    // Off the edges, which belong to two faces.
    y[1] = vec4f(cube_face_point(2.5 * cube_direction(face, 0.98 * x[0].xy)), 0.0);
";

fn face_points() -> Vec<[Vec4; 1]> {
    let steps = [-1.0, -0.999, -0.4, 0.0, 0.3, 1.0];
    let points = steps.into_iter().flat_map(|x| steps.map(|y| Vec2::new(x, y)));
    points.flat_map(|p| (0..6).map(move |face| [Vec4::new(p.x, p.y, face as f32, 0.0)])).collect()
}

fn cube_map(x: &[Vec4; 1]) -> [Vec4; 2] {
    let p = x[0].truncate().truncate();
    let face = x[0].z as u32;
    let (found, at) = cube::face_point(2.5 * cube::direction(face, 0.98 * p));
    [v4(cube::direction(face, p), cube::weight(p)), Vec4::new(found as f32, at.x, at.y, 0.0)]
}

/// Around as a direction: the left edge of the map is its right edge.
const EQUIRECTANGULAR: &str = "
    let uv = cube_equirectangular(x[0].xyz);
    y[0] = vec4f(cos(2.0 * PI * uv.x), sin(2.0 * PI * uv.x), uv.y, 0.0);
";

/// Directions that are not at a pole, where any u is right.
fn off_axis() -> Vec<[Vec4; 1]> {
    let usable = |d: &Vec3| d.x.abs() + d.z.abs() > 1e-4;
    grid::sphere().into_iter().filter(usable).map(|d| [v4(d, 0.0)]).collect()
}

fn equirectangular(x: &[Vec4; 1]) -> [Vec4; 1] {
    let uv = cube::equirectangular(x[0].truncate());
    let (sin, cos) = (std::f32::consts::TAU * uv.x).sin_cos();
    [Vec4::new(cos, sin, uv.y, 0.0)]
}

const FRAME: &str = "
    let frame = frame_new(x[0].xyz);
    let local = frame_to_local(frame, x[1].xyz);
    y[0] = vec4f(frame.t, local.x);
    y[1] = vec4f(frame.b, local.y);
    y[2] = vec4f(frame.n, local.z);
    y[3] = vec4f(frame_to_world(frame, x[1].xyz), 0.0);
";

fn frame_inputs() -> Vec<[Vec4; 2]> {
    let turned = |n: Vec3| Vec3::new(0.3 - n.y, n.z, 0.5 * n.x);
    grid::sphere().into_iter().map(|n| [v4(n, 0.0), v4(turned(n), 0.0)]).collect()
}

fn frame(x: &[Vec4; 2]) -> [Vec4; 4] {
    let (frame, v) = (Frame::new(x[0].truncate()), x[1].truncate());
    let local = frame.to_local(v);
    [v4(frame.t, local.x), v4(frame.b, local.y), v4(frame.n, local.z), v4(frame.to_world(v), 0.0)]
}

const TANGENT: &str = "
    let frame = frame_with_tangent(x[0].xyz, x[1].xyz);
    y[0] = vec4f(frame.t, 0.0);
    y[1] = vec4f(frame.b, 0.0);
    y[2] = vec4f(frame.n, 0.0);
";

/// Tangents across and aslant, long and short, parallel and zero.
fn tangent_inputs() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for n in grid::sphere() {
        let Frame { t, b, .. } = Frame::new(n);
        let tangents =
            [t, -b, 3.0 * t + 2.0 * b + 4.0 * n, 1e-6 * (t - n), 1e6 * (b + 0.1 * t), n, -2.0 * n, Vec3::ZERO];
        inputs.extend(tangents.map(|tangent| [v4(n, 0.0), v4(tangent, 0.0)]));
    }
    inputs
}

fn tangent(x: &[Vec4; 2]) -> [Vec4; 3] {
    let frame = Frame::with_tangent(x[0].truncate(), x[1].truncate());
    [frame.t, frame.b, frame.n].map(|v| v4(v, 0.0))
}

fn vectors() -> Vec<[Vec4; 1]> {
    grid::sphere().into_iter().flat_map(|d| [[v4(d, 0.0)], [v4(1e-3 * d, 0.0)]]).collect()
}

fn points() -> Vec<[Vec4; 1]> {
    grid::square().into_iter().map(|u| [v4((2.0 * u - 1.0).extend(0.0), 0.0)]).collect()
}

fn unit_points() -> Vec<[Vec4; 1]> {
    grid::square().into_iter().map(|u| [v4(u.extend(0.0), 0.0)]).collect()
}

const DISK: &str =
    "y[0] = vec4f(sampling_disk(x[0].xy), 0.0, 0.0); y[1] = vec4f(sampling_cosine_hemisphere(x[0].xy), 0.0);";

fn disk(x: &[Vec4; 1]) -> [Vec4; 2] {
    let u = x[0].truncate().truncate();
    [sampling::disk(u).extend(0.0).extend(0.0), v4(sampling::cosine_hemisphere(u), 0.0)]
}

const HASH: &str = "
    let i = u32(x[0].x) * 65536u + u32(x[0].y);
    let hash = sampling_pcg(i);
    y[0] = vec4f(f32(hash >> 16u), f32(hash & 65535u), sampling_unit(hash), sampling_radical_inverse(i));
";

/// Both halves of the integers, each of which an f32 holds.
fn integers() -> Vec<[Vec4; 1]> {
    let all = (0..32).map(|bit| 1 << bit).chain(0..500).chain((0..500).map(|i: u32| i.wrapping_mul(0x9e37_79b9)));
    all.chain([u32::MAX]).map(|i| [Vec4::new((i >> 16) as f32, (i & 65535) as f32, 0.0, 0.0)]).collect()
}

fn hash(x: &[Vec4; 1]) -> [Vec4; 1] {
    let i = x[0].x as u32 * 65536 + x[0].y as u32;
    let hash = sampling::pcg(i);
    let halves = Vec2::new((hash >> 16) as f32, (hash & 65535) as f32);
    [halves.extend(sampling::unit(hash)).extend(sampling::radical_inverse(i))]
}

const POINTS: &str = "
    let i = u32(x[0].x);
    let n = u32(x[0].y);
    y[0] = vec4f(sampling_hammersley(i, n), sampling_spiral(i, n, x[0].zw));
";

fn sets() -> Vec<[Vec4; 1]> {
    let mut inputs = Vec::new();
    for n in [1, 2, 16, 1000, 65536] {
        for i in [0, 1, 2, 7, n / 3, n / 2, n - 1].into_iter().filter(|&i| i < n) {
            inputs.extend(grid::square().into_iter().map(|u| [Vec2::new(i as f32, n as f32).extend(u.x).extend(u.y)]));
        }
    }
    inputs
}

fn point_sets(x: &[Vec4; 1]) -> [Vec4; 1] {
    let (i, n) = (x[0].x as u32, x[0].y as u32);
    let (hammersley, spiral) = (sampling::hammersley(i, n), sampling::spiral(i, n, Vec2::new(x[0].z, x[0].w)));
    [hammersley.extend(spiral.x).extend(spiral.y)]
}
