// Everything that lights a resolved surface: emission, lamps with their shadows, environment.

@group(2) @binding(0) var radiance_cube: texture_cube<f32>;
@group(2) @binding(1) var prefiltered_cube: texture_cube<f32>;
@group(2) @binding(2) var irradiance_cube: texture_cube<f32>;
@group(2) @binding(3) var cube_sampler: sampler;
@group(2) @binding(4) var shadow_maps: texture_depth_2d_array;
@group(2) @binding(5) var shadow_sampler: sampler_comparison;
@group(2) @binding(6) var<storage, read> lights: array<LightData>;
@group(2) @binding(7) var<storage, read> shadow_clip_from_world: array<mat4x4f>;
@group(2) @binding(8) var<storage, read> tables: array<f32>;
@group(2) @binding(9) var dimmed_cube: texture_cube<f32>;
@group(2) @binding(10) var<storage, read> sources: array<SourceData>;
@group(2) @binding(11) var<storage, read> unlit: array<u32>;
@group(2) @binding(12) var<uniform> probe_places: array<vec4f, 64>;

fn ggx_albedo_entry(index: u32) -> f32 {
    return tables[index];
}

// The cosines of area lights follow the albedo tables.
fn area_entry(index: u32) -> f32 {
    return tables[2u * GGX_ALBEDO_STRIDE + index];
}

fn fresnel_table(table: u32, entry: u32) -> vec3f {
    let first = table + 3u * entry;
    return vec3f(tables[first], tables[first + 1u], tables[first + 2u]);
}

// World direction to the environment's own frame. Cube maps are left-handed: z is mirrored when they are read, as it
// was when they were written.
fn environment_direction(d: vec3f) -> vec3f {
    let c = view.environment_cos;
    let s = view.environment_sin;
    return vec3f(c * d.x - s * d.z, d.y, -(s * d.x + c * d.z));
}

fn classical_radiance(direction: vec3f, level: f32) -> vec3f {
    return view.environment_scale
        * textureSampleLevel(radiance_cube, cube_sampler, environment_direction(direction), level).rgb;
}

fn classical_dimmed(direction: vec3f, level: f32) -> vec3f {
    return view.environment_scale
        * textureSampleLevel(dimmed_cube, cube_sampler, environment_direction(direction), level).rgb;
}

// Direction in the world and radiance times solid angle.
fn classical_source(index: u32) -> mat2x3f {
    let d = sources[index].direction;
    let c = view.environment_cos;
    let s = view.environment_sin;
    return mat2x3f(vec3f(c * d.x + s * d.z, d.y, -s * d.x + c * d.z), view.environment_scale * sources[index].power);
}

fn classical_prefiltered(direction: vec3f, level: f32) -> vec3f {
    return view.environment_scale
        * textureSampleLevel(prefiltered_cube, cube_sampler, environment_direction(direction), level).rgb;
}

fn classical_irradiance(direction: vec3f) -> vec3f {
    return view.environment_scale
        * textureSampleLevel(irradiance_cube, cube_sampler, environment_direction(direction), 0.0).rgb;
}

// Without it lights with an area are none, and the code that sums them is left out: software drivers compile it for long.
override areas: bool = true;

// Without it lobes are looked up once, and the code that samples them is left out.
override sampled: bool = true;

// With it the environment is left to another pass.
override mapped: bool = false;

// Without it no probes take the place of the environment.
override probed: bool = false;

fn probe_place(index: u32) -> ProbePlace {
    return ProbePlace(probe_places[2u * index].xyz, probe_places[2u * index + 1u].xyz);
}

fn probe_inverse_depth(side: u32, x: u32, y: u32) -> f32 {
    return 0.0;
}

fn shade(t: Texel, position: vec3f, pixel: vec2u) -> vec3f {
    let m = materials[instances[t.id - 1u].material];
    let s = surface_of(t, m);
    let base = Frame(t.tangent, cross(t.normal, t.tangent), t.normal);
    let coat = frame_new(t.coat_normal);
    let to_viewer = normalize(view.viewer.xyz - position * view.viewer.w);
    let wo = classical_facing(frame_to_local(base, to_viewer));
    let coat_wo = classical_facing(frame_to_local(coat, to_viewer));

    let rotation = sample_rotation(pixel);
    var value = vec3f(0.0);
    if shows(CONTRIBUTION_EMISSION) {
        value = t.emission;
        if s.coat > 0.0 {
            // The coat lies over the emission too (KHR_materials_clearcoat, "Emission").
            value *= coat_transmission(coat_wo, s.coat_alpha, s.coat, s.masking);
        }
    }
    for (var i = 0u; i < view.light_count; i++) {
        if shows(CONTRIBUTION_LIGHT + i) && lights_instance(i, t.id - 1u) {
            value += lamp_light(lights[i], s, base, coat, to_viewer, position, t.geometric_normal, rotation);
        }
    }
    if mapped || !shows(CONTRIBUTION_ENVIRONMENT) {
        return min(value, vec3f(frame_max));
    }
    var left = 1.0;
    if probed {
        // The rest is added by the passes of the probes.
        left -= probe_weight(PROBE_ALL, instances[t.id - 1u].probes, position);
        if left <= 0.0 {
            return min(value, vec3f(frame_max));
        }
    }
    let lobes = ClassicalLobes(
        select(0u, view.samples, sampled), view.source_count, rotation, view.environment_mips, view.prefiltered_mips,
        view.wide_alpha,
    );
    value += left * classical_environment(s, m.albedo_table, base, coat, to_viewer, t.occlusion, lobes);
    return min(value, vec3f(frame_max));
}
