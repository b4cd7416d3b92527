// The surroundings of a probe as a point beside its middle sees them: each lookup turned to what its ray meets.

@group(2) @binding(0) var radiance_cube: texture_cube<f32>;
@group(2) @binding(1) var prefiltered_cube: texture_cube<f32>;
@group(2) @binding(2) var irradiance_cube: texture_cube<f32>;
@group(2) @binding(3) var cube_sampler: sampler;
@group(2) @binding(4) var dimmed_cube: texture_cube<f32>;
@group(2) @binding(5) var<storage, read> sources: array<SourceData>;
@group(2) @binding(6) var<storage, read> tables: array<f32>;
@group(2) @binding(7) var inverse_depths: texture_2d_array<f32>;
@group(2) @binding(8) var<uniform> probe: ProbeData;
@group(2) @binding(9) var<uniform> probe_places: array<vec4f, 64>;
// Least and greatest of the inverse depths over cells of 2, 4, 8 ... quads.
@group(2) @binding(12) var inverse_bounds: texture_2d_array<f32>;
// The second layer of surfaces; the faces of its distances come after those of the first.
@group(2) @binding(13) var radiance_behind: texture_cube<f32>;
@group(2) @binding(14) var prefiltered_behind: texture_cube<f32>;
@group(2) @binding(15) var dimmed_behind: texture_cube<f32>;
@group(2) @binding(16) var<uniform> probe_behind: ProbeData;
@group(3) @binding(0) var<uniform> given: EffortData;

fn ggx_albedo_entry(index: u32) -> f32 {
    return tables[index];
}

fn fresnel_table(table: u32, entry: u32) -> vec3f {
    let first = table + 3u * entry;
    return vec3f(tables[first], tables[first + 1u], tables[first + 2u]);
}

fn probe_place(index: u32) -> ProbePlace {
    return ProbePlace(probe_places[2u * index].xyz, probe_places[2u * index + 1u].xyz);
}

// The layer of surfaces whose distances are looked up.
var<private> layer: u32;

fn probe_inverse_depth(side: u32, x: u32, y: u32) -> f32 {
    return textureLoad(inverse_depths, vec2u(x, y), 6u * layer + side, 0).x;
}

fn impostor_distance(direction: vec3f) -> f32 {
    return probe_distance(probe.face, direction);
}

fn pyramid_face() -> u32 {
    return probe.face;
}

fn pyramid_corners(side: u32, x: u32, y: u32) -> vec4f {
    return vec4f(
        probe_inverse_depth(side, x, y), probe_inverse_depth(side, x + 1u, y),
        probe_inverse_depth(side, x, y + 1u), probe_inverse_depth(side, x + 1u, y + 1u),
    );
}

fn pyramid_bounds(level: u32, side: u32, x: u32, y: u32) -> vec2f {
    return textureLoad(inverse_bounds, vec2u(x, y), 6u * layer + side, level - 1u).xy;
}

fn extent() -> ImpostorExtent {
    if layer == 1u {
        return ImpostorExtent(
            probe_behind.near, probe_behind.far, probe_behind.radius, probe_behind.low, probe_behind.high,
        );
    }
    return ImpostorExtent(probe.near, probe.far, probe.radius, probe.low, probe.high);
}

fn effort() -> ImpostorEffort {
    return ImpostorEffort(given.solver, given.refinements, given.steps, given.tolerance);
}

// The point that is lit, from the middle of the probe.
var<private> from_middle: vec3f;

struct Followed {
    found: ImpostorFound,
    // Whose light is to be looked up.
    layer: u32,
}

// Through what the probe sees; where that finds nothing, through what lies behind.
fn follow(direction: vec3f) -> Followed {
    var first: ImpostorFound;
    var lookups = 0u;
    for (layer = 0u; layer < probe.layers; layer++) {
        var found = impostor_solve(extent(), from_middle, direction, effort());
        lookups += found.lookups;
        if found.is_hit {
            found.lookups = lookups;
            let hit = layer;
            layer = 0u;
            return Followed(found, hit);
        }
        if layer == 0u {
            first = found;
        }
    }
    layer = 0u;
    first.lookups = lookups;
    return Followed(first, 0u);
}

// Where to look, mirrored as cubes are, how much nearer than to the middle the place is, and in which layer.
struct Look {
    at: vec3f,
    nearer: f32,
    layer: u32,
}

fn look(direction: vec3f) -> Look {
    let followed = follow(direction);
    let found = followed.found;
    let seen = impostor_direction(found, from_middle, direction);
    let distance = length(from_middle + found.t * direction);
    var nearer = 1.0;
    if found.is_hit && distance > 0.0 {
        nearer = found.t / distance;
    }
    return Look(vec3f(seen.xy, -seen.z), nearer, followed.layer);
}

fn classical_radiance(direction: vec3f, level: f32) -> vec3f {
    let look = look(direction);
    let shifted = impostor_level(level, look.nearer, 1.0, probe.radiance_mips - 1.0);
    if look.layer == 1u {
        return probe_behind.scale * textureSampleLevel(radiance_behind, cube_sampler, look.at, shifted).rgb;
    }
    return probe.scale * textureSampleLevel(radiance_cube, cube_sampler, look.at, shifted).rgb;
}

fn classical_dimmed(direction: vec3f, level: f32) -> vec3f {
    let look = look(direction);
    let shifted = impostor_level(level, look.nearer, 1.0, probe.radiance_mips - 1.0);
    if look.layer == 1u {
        return probe_behind.scale * textureSampleLevel(dimmed_behind, cube_sampler, look.at, shifted).rgb;
    }
    return probe.scale * textureSampleLevel(dimmed_cube, cube_sampler, look.at, shifted).rgb;
}

// As bright from every side, and larger from nearer.
fn classical_source(index: u32) -> mat2x3f {
    let direction = sources[index].direction;
    let power = probe.scale * sources[index].power;
    let distance = impostor_distance(direction);
    if distance <= 0.0 || given.solver == IMPOSTOR_CLASSICAL {
        return mat2x3f(direction, power);
    }
    let toward = distance * direction - from_middle;
    let range = length(toward);
    let ratio = distance / max(range, 0.05 * distance);
    return mat2x3f(select(direction, toward / range, range > 0.0), ratio * ratio * power);
}

// The lobe covers so much less of a near surface: a narrower one would from the middle.
fn classical_prefiltered(direction: vec3f, level: f32) -> vec3f {
    let look = look(direction);
    let roughness = classical_roughness(level, probe.prefiltered_mips);
    let seen = classical_level(roughness * sqrt(look.nearer), probe.prefiltered_mips);
    if look.layer == 1u {
        return probe_behind.scale * textureSampleLevel(prefiltered_behind, cube_sampler, look.at, seen).rgb;
    }
    return probe.scale * textureSampleLevel(prefiltered_cube, cube_sampler, look.at, seen).rgb;
}

fn classical_irradiance(direction: vec3f) -> vec3f {
    let own = vec3f(direction.xy, -direction.z);
    return probe.scale * textureSampleLevel(irradiance_cube, cube_sampler, own, 0.0).rgb;
}

// A pixel that shows a surface which the probe serves; its weight is 0 for others.
struct Served {
    texel: Texel,
    point: vec3f,
    weight: f32,
}

fn served(position: vec4f) -> Served {
    let pixel = vec2u(position.xy);
    var found: Served;
    let first = textureLoad(words0, pixel, 0);
    if first.x == 0u {
        return found;
    }
    let serving = instances[first.x - 1u].probes;
    if (serving & (1u << probe.index)) == 0u {
        return found;
    }
    let packed = Packed(
        first, textureLoad(words1, pixel, 0), textureLoad(words2, pixel, 0), textureLoad(words3, pixel, 0),
    );
    found.texel = texel_unpack(packed);
    let world = unproject(position.xy, textureLoad(depth, pixel, 0));
    found.point = world.xyz / world.w;
    found.weight = probe_weight(probe.index, serving, found.point);
    from_middle = found.point - probe.middle;
    return found;
}

fn to_viewer(point: vec3f) -> vec3f {
    return normalize(view.viewer.xyz - point * view.viewer.w);
}
