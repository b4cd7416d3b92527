//! Procedural bumps.

use burnish_core::surface::micro_normal::{self, Kind, WGSL};
use glam::{IVec3, Vec3, Vec4};

use crate::grid::{self, ALPHAS, v4};
use crate::harness::{Case, Tolerance};

pub fn cases() -> Vec<Case> {
    vec![
        Case::new("micro_normal: hashes of cells are equal to the last bit", &WGSL, HASH, cells, hash)
            .within(Tolerance::EXACT),
        Case::new("micro_normal: noise and dents", &WGSL, FIELDS, near, fields).within(COORDINATES),
        Case::new("micro_normal: bumps of every kind under pixels of every size", &WGSL, EVAL, bumps, eval)
            .within(COORDINATES),
        Case::new("micro_normal: normals over bumps and what is filtered out", &WGSL, BENT, slopes, bent),
    ]
}

/// A slope changes by up to 10 in a cell, and a coordinate of 500 cells is rounded to 3e-5 of one.
const COORDINATES: Tolerance = Tolerance { relative: 1e-4, absolute: 4e-4 };

const HASH: &str = "
    let cell = vec3i(x[0].xyz);
    let hash = micro_normal_hash(cell, u32(x[0].w));
    y[0] = vec4f(vec3f(hash >> vec3u(16u)), 0.0);
    y[1] = vec4f(vec3f(hash & vec3u(65535u)), 0.0);
    y[2] = vec4f(micro_normal_random(cell, u32(x[0].w)), 0.0);
";

fn cells() -> Vec<[Vec4; 1]> {
    let steps = [-16_777_216.0, -70_000.0, -2.0, -1.0, 0.0, 1.0, 3.0, 255.0, 786_432.0, 16_777_215.0];
    let mut inputs = Vec::new();
    for x in steps {
        for y in steps {
            inputs.extend(steps.map(|z| [Vec4::new(x, y, z, f32::abs(x + z) % 3.0)]));
        }
    }
    inputs
}

fn hash(x: &[Vec4; 1]) -> [Vec4; 3] {
    let (cell, seed): (IVec3, u32) = (x[0].truncate().as_ivec3(), x[0].w as u32);
    let hash = micro_normal::hash(cell, seed);
    [(hash >> 16u32).as_vec3(), (hash & 65535).as_vec3(), micro_normal::random(cell, seed)].map(|v| v4(v, 0.0))
}

const FIELDS: &str = "
    y[0] = micro_normal_noise(x[0].xyz, u32(x[0].w));
    y[1] = micro_normal_dents(x[0].xyz);
    y[2] = vec4f(micro_normal_askew(x[0].xyz), micro_normal_resolved(1.0, abs(x[0].x)));
    y[3] = vec4f(micro_normal_straight(x[0].xyz), micro_normal_resolved(abs(x[0].y) + 0.1, abs(x[0].x)));
";

/// On borders of cells and between, on both sides of the origin, up to 500 cells away.
fn near() -> Vec<[Vec4; 1]> {
    places(1.0).into_iter().enumerate().map(|(i, p)| [v4(p, (i % 4) as f32)]).collect()
}

fn places(scale: f32) -> Vec<Vec3> {
    let steps = [-499.6, -33.25, -1.0, -0.999, -0.3, 0.0, 1e-6, 0.25, 0.7, 1.0, 2.5, 12.1, 480.4];
    let mut all = Vec::new();
    for x in steps {
        for y in steps {
            all.extend(steps.map(|z| scale * Vec3::new(x, y, z)));
        }
    }
    all
}

fn fields(x: &[Vec4; 1]) -> [Vec4; 4] {
    let p = x[0].truncate();
    [
        micro_normal::noise(p, x[0].w as u32),
        micro_normal::dents(p),
        v4(micro_normal::askew(p), micro_normal::resolved(1.0, p.x.abs())),
        v4(micro_normal::straight(p), micro_normal::resolved(p.y.abs() + 0.1, p.x.abs())),
    ]
}

const EVAL: &str = "
    let bumps = micro_normal_eval(u32(x[0].w), x[0].xyz, x[1].x, x[1].y);
    y[0] = vec4f(bumps.gradient, bumps.height);
    y[1] = vec4f(bumps.lost, 0.0, 0.0, 0.0);
";

/// All kinds. Sizes and pixels in metres; the last places are too far away for bumps.
fn bumps() -> Vec<[Vec4; 2]> {
    // A power of two: each place is at the same spot of a cell as it is for size 1.
    let size = 2f32.powi(-8);
    let mut inputs = Vec::new();
    for (i, p) in places(0.4 * size).into_iter().enumerate() {
        let footprint = [0.0, 0.1, 0.3, 0.5, 0.7, 1.0][i % 6] * size;
        inputs.push([v4(p, (i % 4) as f32), Vec4::new(size, footprint, 0.0, 0.0)]);
    }
    for place in [1e5, -1e6, 1e30] {
        for kind in Kind::ALL {
            inputs.extend([1e-5, 5e-3].map(|size| {
                [v4(Vec3::new(place, 0.5 * place, -place), kind as u32 as f32), Vec4::new(size, 1e-4, 0.0, 0.0)]
            }));
        }
    }
    inputs
}

fn eval(x: &[Vec4; 2]) -> [Vec4; 2] {
    let bumps = micro_normal::eval(Kind::ALL[x[0].w as usize], x[0].truncate(), x[1].x, x[1].y);
    [v4(bumps.gradient, bumps.height), Vec4::new(bumps.lost, 0.0, 0.0, 0.0)]
}

const BENT: &str = "
    y[0] = vec4f(micro_normal_bent(x[0].xyz, x[1].xyz, x[2].xyz), 0.0);
    y[1] = vec4f(micro_normal_widened(vec2f(x[0].w, x[1].w), abs(x[2].x), abs(x[2].y)), 0.0, 0.0);
";

fn slopes() -> Vec<[Vec4; 3]> {
    let directions = grid::sphere();
    let mut inputs = Vec::new();
    for (i, n) in directions.iter().enumerate() {
        for turn in [0, 1, 7, 31] {
            let geometric = directions[(i + turn) % directions.len()];
            let slope = [0.0, 0.2, 1.0][i % 3] * directions[(i + 3 * turn + 5) % directions.len()];
            let alpha = ALPHAS[i % ALPHAS.len()];
            // A normal in the plane of the triangle is on either side of it.
            if n.dot(geometric).abs() > 1e-6 {
                inputs.push([v4(*n, alpha.x), v4(geometric, alpha.y), v4(slope, 0.0)]);
            }
        }
    }
    inputs
}

fn bent(x: &[Vec4; 3]) -> [Vec4; 2] {
    let [n, geometric, slope] = [x[0], x[1], x[2]].map(Vec4::truncate);
    let alpha = micro_normal::widened(glam::Vec2::new(x[0].w, x[1].w), slope.x.abs(), slope.y.abs());
    [v4(micro_normal::bent(n, geometric, slope), 0.0), alpha.extend(0.0).extend(0.0)]
}
