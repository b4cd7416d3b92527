// Builds the cubes of an environment: tiles of one level of one cube per dispatch, a texel per invocation.

@group(0) @binding(0) var<uniform> params: EnvironmentStep;
@group(0) @binding(1) var equirectangular: texture_2d_array<f32>;
@group(0) @binding(2) var finer: texture_2d_array<f32>;
@group(0) @binding(3) var radiance_cube: texture_cube<f32>;
@group(0) @binding(4) var cube_sampler: sampler;
@group(0) @binding(5) var target_level: texture_storage_2d_array<rgba16float, write>;

@group(0) @binding(6) var<storage, read> sources: array<SourceData>;
@group(0) @binding(7) var<storage, read> tiles: array<u32>;

const TILE: u32 = 8;

// Texel and face of an invocation. Tiles are numbered along rows, then faces.
fn texel(group: vec3u, local: vec3u) -> vec3u {
    let across = (textureDimensions(target_level).x + TILE - 1u) / TILE;
    var tile = params.first_tile + group.x;
    if params.listed != 0u {
        tile = tiles[tile];
    }
    return vec3u(tile % across, tile / across % across, tile / (across * across)) * vec3u(TILE, TILE, 1u) + local;
}

fn classical_source(index: u32) -> mat2x3f {
    return mat2x3f(sources[index].direction, sources[index].power);
}

// Cube maps are left-handed: the environment's z is mirrored.
fn environment_from_cube(d: vec3f) -> vec3f {
    return vec3f(d.x, d.y, -d.z);
}

// A point of a texel on its face; `inside` in [0, 1]^2.
fn on_face(texel: vec2u, inside: vec2f, size: vec2u) -> vec2f {
    return (vec2f(texel) + inside) / vec2f(size) * 2.0 - 1.0;
}

// Rounds to the nearest half float: some devices truncate on the store, which would darken every level a little more.
fn half_rounded(x: vec3f) -> vec3f {
    let bits = bitcast<vec3u>(x);
    return bitcast<vec3f>((bits + 0xfffu + ((bits >> vec3u(13u)) & vec3u(1u))) & vec3u(0xffffe000u));
}

fn store(id: vec3u, value: vec3f) {
    textureStore(target_level, id.xy, id.z, vec4f(half_rounded(clamp(value, vec3f(0.0), vec3f(65000.0))), 1.0));
}

fn classical_radiance(direction: vec3f, level: f32) -> vec3f {
    return textureSampleLevel(radiance_cube, cube_sampler, environment_from_cube(direction), level).rgb;
}

// The map lies in layers of rows.
fn map_texel(x: i32, y: i32) -> vec3f {
    let rows = i32(textureDimensions(equirectangular).y);
    return textureLoad(equirectangular, vec2i(x, y % rows), y / rows, 0).rgb;
}

// Bilinear, wrapping around and stopping at the poles, as `Environment::radiance` on the CPU: `burnish measure` compares
// what comes of both.
fn equirectangular_radiance(d: vec3f) -> vec3f {
    let columns = textureDimensions(equirectangular).x;
    let p = cube_equirectangular(d) * vec2f(f32(columns), f32(params.rows)) - 0.5;
    let low = floor(p);
    let f = p - low;
    let w = i32(columns);
    let x0 = (i32(low.x) + w) % w;
    let x1 = (i32(low.x) + 1 + w) % w;
    let y0 = clamp(i32(low.y), 0, i32(params.rows) - 1);
    let y1 = clamp(i32(low.y) + 1, 0, i32(params.rows) - 1);
    let top = mix(map_texel(x0, y0), map_texel(x1, y0), f.x);
    let bottom = mix(map_texel(x0, y1), map_texel(x1, y1), f.x);
    return mix(top, bottom, f.y);
}

@compute @workgroup_size(TILE, TILE, 1)
fn from_equirectangular(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let id = texel(group, local);
    let size = textureDimensions(target_level);
    if any(id.xy >= size) {
        return;
    }
    // Near the poles a texel of the cube covers many columns of the map.
    let center = cube_direction(id.z, on_face(id.xy, vec2f(0.5), size));
    let n = select(2u, 6u, abs(center.y) > 0.9);
    var sum = vec3f(0.0);
    for (var i = 0u; i < n * n; i++) {
        let offset = (vec2f(f32(i % n), f32(i / n)) + 0.5) / f32(n);
        let direction = cube_direction(id.z, on_face(id.xy, offset, size));
        sum += equirectangular_radiance(environment_from_cube(direction));
    }
    store(id, sum / f32(n * n) * params.scale);
}

@compute @workgroup_size(TILE, TILE, 1)
fn downsample(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let id = texel(group, local);
    if any(id.xy >= textureDimensions(target_level)) {
        return;
    }
    let size = textureDimensions(finer);
    var sum = vec3f(0.0);
    var weight = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let at = min(2u * id.xy + vec2u(i & 1u, i >> 1u), size - 1u);
        // Texels of a corner are smaller than those of a face's middle.
        let w = cube_weight(on_face(at, vec2f(0.5), size));
        sum += w * textureLoad(finer, at, id.z, 0).rgb;
        weight += w;
    }
    store(id, sum / weight);
}

@compute @workgroup_size(TILE, TILE, 1)
fn prefilter(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let id = texel(group, local);
    let size = textureDimensions(target_level);
    if any(id.xy >= size) {
        return;
    }
    let direction = environment_from_cube(cube_direction(id.z, on_face(id.xy, vec2f(0.5), size)));
    store(id, classical_prefilter(direction, params.alpha, params.samples, params.levels, params.sources));
}

// Sum over all texels of `finer`, a level of the radiance cube.
@compute @workgroup_size(TILE, TILE, 1)
fn irradiance(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let id = texel(group, local);
    let size = textureDimensions(target_level);
    if any(id.xy >= size) {
        return;
    }
    let normal = cube_direction(id.z, on_face(id.xy, vec2f(0.5), size));
    let source = textureDimensions(finer);
    var sum = vec3f(0.0);
    var solid_angle = 0.0;
    for (var face = 0u; face < 6u; face++) {
        for (var y = 0u; y < source.y; y++) {
            for (var x = 0u; x < source.x; x++) {
                let p = on_face(vec2u(x, y), vec2f(0.5), source);
                let d = cube_direction(face, p);
                let w = cube_weight(p);
                sum += textureLoad(finer, vec2u(x, y), face, 0).rgb * (w * max(0.0, dot(d, normal)));
                solid_angle += w;
            }
        }
    }
    store(id, sum * (4.0 * PI / solid_angle));
}
