// What leaves ask of a pass, from a buffer or by formula. Rust twins: curves.rs and the maps of classical.rs.

@group(0) @binding(0) var<storage, read> parity_inputs: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> parity_outputs: array<vec4f>;
// The albedo tables, the cosines of area lights, the tables of area cubes, the curves' fields, the curves' tables.
@group(0) @binding(2) var<storage, read> parity_table: array<f32>;

fn parity_vec3(at: u32) -> vec3f {
    return vec3f(parity_table[at], parity_table[at + 1u], parity_table[at + 2u]);
}

fn ggx_albedo_entry(index: u32) -> f32 {
    return parity_table[index];
}

fn area_entry(index: u32) -> f32 {
    return parity_table[PARITY_AREA + index];
}

fn area_cube_entry(index: u32) -> f32 {
    return parity_table[PARITY_AREA_CUBE + index];
}

fn fresnel_table(table: u32, entry: u32) -> vec3f {
    return parity_vec3(table + 3u * entry);
}

// Light that depends on the direction and falls with the level.
fn parity_light(d: vec3f, level: f32) -> vec3f {
    return vec3f(1.2 + d.x, 1.5 + d.y * d.z, 1.3 - 0.8 * d.z) / (1.0 + 0.2 * level);
}

fn classical_radiance(direction: vec3f, level: f32) -> vec3f {
    return parity_light(direction, level);
}

fn classical_dimmed(direction: vec3f, level: f32) -> vec3f {
    return 0.7 * parity_light(direction.yzx, level);
}

fn classical_prefiltered(direction: vec3f, level: f32) -> vec3f {
    return parity_light(direction.zxy, 2.0 * level);
}

fn classical_irradiance(direction: vec3f) -> vec3f {
    return 3.0 * parity_light(direction, 1.0);
}

fn classical_source(index: u32) -> mat2x3f {
    if index == 0u {
        return mat2x3f(vec3f(0.48, 0.6, 0.64), vec3f(0.3, 0.2, 0.1));
    }
    return mat2x3f(vec3f(-0.64, 0.48, 0.6), vec3f(0.05, 0.1, 0.15));
}

fn impostor_distance(direction: vec3f) -> f32 {
    let a = abs(direction);
    return (1.0 + 0.1 * direction.x * direction.y) / max(a.x, max(a.y, a.z));
}

fn area_cube_texel(index: u32) -> mat3x4f {
    let i = f32(index);
    let place = vec3f(sin(1.3 * i), cos(2.1 * i), sin(0.7 * i + 1.0)) + vec3f(0.05);
    let radiance = vec4f(1.2 + sin(0.9 * i), 0.8, 1.5 + cos(0.4 * i), 0.0);
    if index % 7u == 0u {
        return mat3x4f(vec4f(normalize(place), 0.0), vec4f(vec3f(0.0), 0.97), radiance);
    }
    let spread = 0.05 + 0.04 * sin(0.3 * i);
    return mat3x4f(vec4f(place, spread), vec4f(-1.2 * normalize(place), 0.95), radiance);
}

// Faces with 12 texels: a wall, a quarter something nearer, a corner of the sky.
fn pyramid_face() -> u32 {
    return 12u;
}

fn parity_kept(side: u32, x: u32, y: u32) -> f32 {
    if x >= 6u && y >= 6u {
        return select(0.9, 0.0, x >= 9u);
    }
    return 0.5 + 0.01 * f32(side + x) + 0.005 * f32(y);
}

fn pyramid_corners(side: u32, x: u32, y: u32) -> vec4f {
    return vec4f(
        parity_kept(side, x, y), parity_kept(side, x + 1u, y),
        parity_kept(side, x, y + 1u), parity_kept(side, x + 1u, y + 1u),
    );
}

// Wider than what is stored, which costs lookups and changes no place.
fn pyramid_bounds(level: u32, side: u32, x: u32, y: u32) -> vec2f {
    let low = vec2u(x, y) << vec2u(level);
    let high = min(low + vec2u(1u << level), vec2u(11u));
    var bounds = vec2f(1e30, 0.0);
    for (var v = low.y; v <= high.y; v++) {
        for (var u = low.x; u <= high.x; u++) {
            let kept = parity_kept(side, u, v);
            bounds = vec2f(min(bounds.x, 0.98 * kept), max(bounds.y, 1.02 * kept));
        }
    }
    return bounds;
}
