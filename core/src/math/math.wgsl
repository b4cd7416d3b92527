// Constants, frames, octahedral unit vectors and point sets.

const PI: f32 = 3.14159265358979;
const INV_PI: f32 = 0.318309886183791;

// An orthonormal right-handed basis: tangent, bitangent, normal.
struct Frame {
    t: vec3f,
    b: vec3f,
    n: vec3f,
}

// Some frame about the unit vector n, without a branch. Duff et al. 2017.
fn frame_new(n: vec3f) -> Frame {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let c = n.x * n.y * a;
    return Frame(vec3f(1.0 + s * n.x * n.x * a, s * c, -s * n.x), vec3f(c, s + n.y * n.y * a, -n.y), n);
}

// The frame about the unit vector n with the tangent nearest to `tangent`; frame_new where that has no direction.
fn frame_with_tangent(n: vec3f, tangent: vec3f) -> Frame {
    let across = tangent - n * dot(n, tangent);
    // Below this share of its length the remainder is rounding and points anywhere.
    if !(dot(across, across) > 1e-8 * dot(tangent, tangent)) {
        return frame_new(n);
    }
    let first = normalize(across);
    // Once more, since the first subtraction cancels digits where the two are close.
    let t = normalize(first - n * dot(n, first));
    return Frame(t, cross(n, t), n);
}

fn frame_to_local(frame: Frame, v: vec3f) -> vec3f {
    return vec3f(dot(v, frame.t), dot(v, frame.b), dot(v, frame.n));
}

fn frame_to_world(frame: Frame, v: vec3f) -> vec3f {
    return frame.t * v.x + frame.b * v.y + frame.n * v.z;
}

// Unit vector to the square [-1, 1]^2; +z is the centre. Cigolle et al. 2014.
fn oct_encode(v: vec3f) -> vec2f {
    let p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    let folded = (1.0 - abs(p.yx)) * select(vec2f(-1.0), vec2f(1.0), p >= vec2f(0.0));
    return select(folded, p, v.z >= 0.0);
}

fn oct_decode(p: vec2f) -> vec3f {
    let z = 1.0 - abs(p.x) - abs(p.y);
    let folded = (1.0 - abs(p.yx)) * select(vec2f(-1.0), vec2f(1.0), p >= vec2f(0.0));
    return normalize(vec3f(select(folded, p, z >= 0.0), z));
}

// Unit direction of a point of a face of a cube map, (-1, -1) at its top left; faces +x, -x, +y, -y, +z, -z. Cube maps are
// left-handed: what a face shows is mirrored in z against the world.
fn cube_direction(face: u32, p: vec2f) -> vec3f {
    var d: vec3f;
    switch face {
        case 0u: { d = vec3f(1.0, -p.y, -p.x); }
        case 1u: { d = vec3f(-1.0, -p.y, p.x); }
        case 2u: { d = vec3f(p.x, 1.0, p.y); }
        case 3u: { d = vec3f(p.x, -1.0, -p.y); }
        case 4u: { d = vec3f(p.x, -p.y, 1.0); }
        default: { d = vec3f(-p.x, -p.y, -1.0); }
    }
    return normalize(d);
}

// Solid angle of a small texel there over that of one in the face's middle.
// The face that shows a direction of any length but 0 in x, the point of it in yz: the inverse of cube_direction.
fn cube_face_point(d: vec3f) -> vec3f {
    let a = abs(d);
    if a.x >= a.y && a.x >= a.z {
        if d.x >= 0.0 {
            return vec3f(0.0, vec2f(-d.z, -d.y) / a.x);
        }
        return vec3f(1.0, vec2f(d.z, -d.y) / a.x);
    }
    if a.y >= a.z {
        if d.y >= 0.0 {
            return vec3f(2.0, vec2f(d.x, d.z) / a.y);
        }
        return vec3f(3.0, vec2f(d.x, -d.z) / a.y);
    }
    if d.z >= 0.0 {
        return vec3f(4.0, vec2f(d.x, -d.y) / a.z);
    }
    return vec3f(5.0, vec2f(-d.x, -d.y) / a.z);
}

fn cube_weight(p: vec2f) -> f32 {
    return pow(1.0 + dot(p, p), -1.5);
}

// Where an equirectangular map shows a unit direction, from the top left: -z in the middle, +y on top.
fn cube_equirectangular(d: vec3f) -> vec2f {
    // Two arctangents: an arccosine would lose half of the digits near the poles.
    return vec2f(0.5 + atan2(d.x, -d.z) * (0.5 * INV_PI), atan2(length(d.xz), d.y) * INV_PI);
}

// The square [0, 1)^2 to the unit disk, keeping areas and neighbours. Shirley and Chiu 1997.
fn sampling_disk(u: vec2f) -> vec2f {
    let p = 2.0 * u - 1.0;
    if p.x == 0.0 && p.y == 0.0 {
        return vec2f(0.0);
    }
    if abs(p.x) > abs(p.y) {
        let phi = 0.25 * PI * (p.y / p.x);
        return p.x * vec2f(cos(phi), sin(phi));
    }
    let phi = 0.5 * PI - 0.25 * PI * (p.x / p.y);
    return p.y * vec2f(cos(phi), sin(phi));
}

// Direction with density cos(theta) / pi about z.
fn sampling_cosine_hemisphere(u: vec2f) -> vec3f {
    // Radius on the disk, from which the cosine keeps its digits at the rim.
    let p = abs(2.0 * u - 1.0);
    let r = max(p.x, p.y);
    return vec3f(sampling_disk(u), sqrt((1.0 - r) * (1.0 + r)));
}

// Bits of i mirrored at the binary point, in [0, 1).
fn sampling_radical_inverse(i: u32) -> f32 {
    // Only 24 bits fit an f32 below one.
    return f32(reverseBits(i) >> 8u) * (1.0 / 16777216.0);
}

// Point i of n in [0, 1)^2.
fn sampling_hammersley(i: u32, n: u32) -> vec2f {
    return vec2f(f32(i) / f32(n), sampling_radical_inverse(i));
}

// Point i of n for maps that take x around and y outward: a spiral whose cells are as wide as they are long. `offset` in
// [0, 1)^2 turns it and moves it outward within a step.
fn sampling_spiral(i: u32, n: u32, offset: vec2f) -> vec2f {
    // Steps of the golden angle, in integers so that no digit is lost: 2^32 over the golden ratio, wrapping.
    let turn = f32((i * 2654435769u) >> 8u) * (1.0 / 16777216.0);
    return vec2f(fract(turn + offset.x), (f32(i) + offset.y) / f32(n));
}

// Hash of 32 bits. Jarzynski and Olano 2020.
fn sampling_pcg(v: u32) -> u32 {
    let state = v * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Hash as a number in [0, 1).
fn sampling_unit(hash: u32) -> f32 {
    return f32(hash >> 8u) * (1.0 / 16777216.0);
}
