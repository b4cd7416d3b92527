// Procedural bumps of a finish: the slopes of a solid height field, filtered to the size of a pixel.

const MICRO_NORMAL_NONE: u32 = 0u;
const MICRO_NORMAL_GRAIN: u32 = 1u;
const MICRO_NORMAL_CAST: u32 = 2u;
const MICRO_NORMAL_HAMMERED: u32 = 3u;

// Pixels over features: bumps are whole up to the first and gone from the second on.
const MICRO_NORMAL_FADE_FROM: f32 = 0.25;
const MICRO_NORMAL_FADE_TO: f32 = 0.75;
// Least pixel for a feature at distance 1 from the origin, in features: what an f32 tells apart there, eight times.
const MICRO_NORMAL_PRECISION: f32 = 9.5367431640625e-7;
// Root mean square slopes along a surface of the noise and of the dents, both in cells of size 1.
const MICRO_NORMAL_NOISE_SLOPE: f32 = 0.704;
const MICRO_NORMAL_DENT_SLOPE: f32 = 0.9025;
// Share of a cell in which its dent may lie, and the radius to which dents reach: what lies outside of the 27 cells
// about a point is at least this far away.
const MICRO_NORMAL_JITTER: f32 = 0.9;
const MICRO_NORMAL_REACH: f32 = 1.05;
// How sharp the ridges between dents are.
const MICRO_NORMAL_SHARPNESS: f32 = 20.0;
// Where no dent reaches, the plate is flat: the weight of that height.
const MICRO_NORMAL_FLAT: f32 = 1e-9;
// Octaves of a cast skin, slope of one over that of the next coarser, and slope of the coarsest.
const MICRO_NORMAL_CAST_OCTAVES: u32 = 3u;
const MICRO_NORMAL_CAST_GAIN: f32 = 0.7;
const MICRO_NORMAL_CAST_SHARE: f32 = 0.7603;

struct MicroNormal {
    // Gradient of the height, without unit; root mean square 1 along a surface where nothing was filtered out.
    gradient: vec3f,
    // Height in features.
    height: f32,
    // Share of the squared slopes that was filtered out.
    lost: f32,
}

// Three hashes of a cell. pcg3d of Jarzynski and Olano 2020.
fn micro_normal_hash(cell: vec3i, seed: u32) -> vec3u {
    var v = (bitcast<vec3u>(cell) + seed) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> vec3u(16u));
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

fn micro_normal_random(cell: vec3i, seed: u32) -> vec3f {
    let hash = micro_normal_hash(cell, seed);
    return vec3f(sampling_unit(hash.x), sampling_unit(hash.y), sampling_unit(hash.z));
}

// Gradient noise with cells of size 1: its gradient, and in w its value. Perlin 2002.
fn micro_normal_noise(p: vec3f, seed: u32) -> vec4f {
    let first = floor(p);
    let f = p - first;
    let upper = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let slope = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    var sum = vec4f(0.0);
    for (var i = 0u; i < 8u; i++) {
        let corner = vec3i(i32(i & 1u), i32((i >> 1u) & 1u), i32(i >> 2u));
        let c = vec3f(corner);
        let direction = 2.0 * micro_normal_random(vec3i(first) + corner, seed) - 1.0;
        let value = dot(direction, f - c);
        let w = c * upper + (1.0 - c) * (1.0 - upper);
        let d = (2.0 * c - 1.0) * slope;
        let weight = w.x * w.y * w.z;
        let change = vec3f(d.x * w.y * w.z, w.x * d.y * w.z, w.x * w.y * d.z);
        sum += vec4f(direction * weight + change * value, value * weight);
    }
    return sum;
}

// Round dents, one for each cell of size 1: the gradient, and in w the height. With k the sharpness and r = 1 - d^2 /
// reach^2 of the dents at distances d < reach, h = -1/k ln(flat + sum of r^2 exp(-k d^2)): close to the least d^2, with
// rounded ridges.
fn micro_normal_dents(p: vec3f) -> vec4f {
    let first = floor(p);
    let f = p - first;
    let reach2 = MICRO_NORMAL_REACH * MICRO_NORMAL_REACH;
    var total = MICRO_NORMAL_FLAT;
    var pull = vec3f(0.0);
    for (var i = 0; i < 27; i++) {
        let cell = vec3i(i % 3, (i / 3) % 3, i / 9) - 1;
        let random = micro_normal_random(vec3i(first) + cell, 0u);
        let middle = vec3f(cell) + 0.5 + MICRO_NORMAL_JITTER * (random - 0.5);
        let away = f - middle;
        let d2 = dot(away, away);
        let r = max(1.0 - d2 / reach2, 0.0);
        let weight = r * exp(-MICRO_NORMAL_SHARPNESS * d2);
        total += weight * r;
        pull += away * (weight * (r + 2.0 / (MICRO_NORMAL_SHARPNESS * reach2)));
    }
    return vec4f(2.0 / total * pull, -log(total) / MICRO_NORMAL_SHARPNESS);
}

// Amplitude that is left of features of this size under such a pixel.
fn micro_normal_resolved(feature: f32, pixel: f32) -> f32 {
    return 1.0 - smoothstep(MICRO_NORMAL_FADE_FROM, MICRO_NORMAL_FADE_TO, pixel / feature);
}

// To the axes of the cells, which lie askew so that no flat side of a body shows a row of them.
fn micro_normal_askew(p: vec3f) -> vec3f {
    return vec3f(2.0 * p.x + 2.0 * p.y + p.z, p.y - 2.0 * p.x + 2.0 * p.z, p.x - 2.0 * p.y + 2.0 * p.z) / 3.0;
}

fn micro_normal_straight(p: vec3f) -> vec3f {
    return vec3f(2.0 * p.x - 2.0 * p.y + p.z, 2.0 * p.x + p.y - 2.0 * p.z, p.x + 2.0 * p.y + 2.0 * p.z) / 3.0;
}

// Bumps of a kind at p, with features of `size`, under a pixel that is `footprint` wide; all in metres.
fn micro_normal_eval(kind: u32, p: vec3f, size: f32, footprint: f32) -> MicroNormal {
    var bumps = MicroNormal(vec3f(0.0), 0.0, 0.0);
    if kind == MICRO_NORMAL_NONE {
        return bumps;
    }
    let inverse = 1.0 / size;
    let straight = p * inverse;
    let q = micro_normal_askew(straight);
    let far = max(max(abs(straight.x), abs(straight.y)), abs(straight.z));
    let pixel = max(footprint * inverse, far * MICRO_NORMAL_PRECISION);
    var sum = vec4f(0.0);
    var kept = 0.0;
    if kind == MICRO_NORMAL_HAMMERED {
        let amplitude = micro_normal_resolved(1.0, pixel);
        if amplitude > 0.0 {
            kept = amplitude * amplitude;
            sum = amplitude / MICRO_NORMAL_DENT_SLOPE * micro_normal_dents(q);
        }
    } else {
        let octaves = select(1u, MICRO_NORMAL_CAST_OCTAVES, kind == MICRO_NORMAL_CAST);
        var share = select(1.0, MICRO_NORMAL_CAST_SHARE, kind == MICRO_NORMAL_CAST);
        var scale = 1.0;
        for (var i = 0u; i < octaves; i++) {
            let amplitude = share * micro_normal_resolved(1.0, pixel * scale);
            if amplitude > 0.0 {
                kept += amplitude * amplitude;
                let noise = micro_normal_noise(q * scale, i) * (amplitude / MICRO_NORMAL_NOISE_SLOPE);
                sum += vec4f(noise.xyz, noise.w / scale);
            }
            share *= MICRO_NORMAL_CAST_GAIN;
            scale *= 2.0;
        }
    }
    bumps.gradient = micro_normal_straight(sum.xyz);
    bumps.height = sum.w;
    bumps.lost = max(1.0 - kept, 0.0);
    return bumps;
}

// The unit normal n over bumps of the given slopes, on the side of the triangle's normal on which n is.
fn micro_normal_bent(n: vec3f, geometric: vec3f, slope: vec3f) -> vec3f {
    let bent = normalize(n - (slope - n * dot(n, slope)));
    let side = select(-geometric, geometric, dot(n, geometric) >= 0.0);
    return normalize(bent - side * min(dot(bent, side), 0.0));
}

// Widths of the microfacets together with slopes that were filtered out: `depth` is the root mean square slope.
fn micro_normal_widened(alpha: vec2f, depth: f32, lost: f32) -> vec2f {
    return min(sqrt(alpha * alpha + depth * depth * lost), vec2f(1.0));
}
