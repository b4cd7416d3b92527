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

fn ggx_albedo_entry(index: u32) -> f32 {
    return tables[index];
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

fn surface_of(t: Texel, m: MaterialData) -> Surface {
    var s: Surface;
    s.base_color = t.base_color;
    s.metallic = t.metallic;
    s.alpha = t.alpha;
    s.lobe = m.flags >> MATERIAL_LOBE_SHIFT;
    s.exponent = t.exponent;
    s.dielectric_f0 = t.dielectric_f0;
    s.dielectric_f90 = t.dielectric_f90;
    s.coat = t.coat;
    s.coat_alpha = t.coat_alpha;
    s.masking = view.masking;
    s.multiple_scattering = view.multiple_scattering != 0u;
    if (m.flags & MATERIAL_PRESET) != 0u {
        s.fresnel = Fresnel(
            m.fresnel_form, m.fresnel_table, m.fresnel_f0, m.fresnel_c0, m.fresnel_c1, m.fresnel_c2, m.fresnel_c3,
        );
        s.fresnel_mean = m.fresnel_mean;
    } else {
        let none = vec3f(0.0);
        s.fresnel = Fresnel(FRESNEL_RESCALED, 0u, t.base_color, none, none, none, none);
        s.fresnel_mean = t.base_color + (1.0 - t.base_color) / 21.0;
    }
    return s;
}

// Layer of a point light's six that looks toward d: +x, -x, +y, -y, +z, -z.
fn shadow_face(d: vec3f) -> u32 {
    let a = abs(d);
    if a.x >= a.y && a.x >= a.z {
        return select(1u, 0u, d.x >= 0.0);
    }
    if a.y >= a.z {
        return select(3u, 2u, d.y >= 0.0);
    }
    return select(5u, 4u, d.z >= 0.0);
}

// Lit share of a 3x3 texel neighbourhood. The point is moved off its surface by the size of a shadow texel there.
fn shadow_visibility(light: LightData, position: vec3f, normal: vec3f, to_light: vec3f, distance: f32) -> f32 {
    if light.shadow_layer == SHADOW_NONE {
        return 1.0;
    }
    let texel = light.shadow_texel * select(distance, 1.0, light.kind == LIGHT_DIRECTIONAL);
    let slope = sqrt(max(0.0, 1.0 - pow(dot(normal, to_light), 2.0)));
    let moved = position + normal * (texel * (0.5 + 2.0 * slope));
    var layer = light.shadow_layer;
    if light.kind == LIGHT_POINT {
        layer += shadow_face(moved - light.position);
    }
    let clip = shadow_clip_from_world[layer] * vec4f(moved, 1.0);
    let ndc = clip.xyz / clip.w;
    let uv = ndc.xy * vec2f(0.5, -0.5) + 0.5;
    if clip.w <= 0.0 || any(uv < vec2f(0.0)) || any(uv > vec2f(1.0)) {
        return 1.0;
    }
    let step = 1.0 / vec2f(textureDimensions(shadow_maps));
    var lit = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let at = uv + vec2f(f32(x), f32(y)) * step;
            lit += textureSampleCompareLevel(shadow_maps, shadow_sampler, at, layer, ndc.z);
        }
    }
    return lit / 9.0;
}

// Irradiance of a lamp on a surface that faces it, before its shadow; direction in xyz of the result's pair.
struct Lamp {
    direction: vec3f,
    distance: f32,
    irradiance: vec3f,
}

fn lamp_at(light: LightData, position: vec3f) -> Lamp {
    if light.kind == LIGHT_DIRECTIONAL {
        return Lamp(-light.direction, 1.0, light.intensity);
    }
    let toward = light.position - position;
    // A millimetre: a lamp on the surface must not divide by zero.
    let distance = max(length(toward), 1e-3);
    let direction = toward / distance;
    var factor = 1.0 / (distance * distance);
    if light.range > 0.0 {
        let ratio = distance / light.range;
        factor *= clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
    }
    if light.kind == LIGHT_SPOT {
        let cone = clamp(dot(-direction, light.direction) * light.spot_scale + light.spot_offset, 0.0, 1.0);
        factor *= cone * cone;
    }
    return Lamp(direction, distance, light.intensity * factor);
}

// Largest radiance that a frame holds, where the device blends half floats only.
override frame_max: f32 = 3.0e38;

// Without it lobes are looked up once, and the code that samples them is left out.
override sampled: bool = true;

fn shade(t: Texel, position: vec3f, pixel: vec2u) -> vec3f {
    let m = materials[instances[t.id - 1u].material];
    let s = surface_of(t, m);
    let base = Frame(t.tangent, cross(t.normal, t.tangent), t.normal);
    let coat = frame_new(t.coat_normal);
    let to_viewer = normalize(view.viewer.xyz - position * view.viewer.w);
    let wo = classical_facing(frame_to_local(base, to_viewer));
    let coat_wo = classical_facing(frame_to_local(coat, to_viewer));

    var value = t.emission;
    if s.coat > 0.0 {
        // The coat lies over the emission too (KHR_materials_clearcoat, "Emission").
        value *= coat_transmission(coat_wo, s.coat_alpha, s.coat, s.masking);
    }
    for (var i = 0u; i < view.light_count; i++) {
        let lamp = lamp_at(lights[i], position);
        let wi = frame_to_local(base, lamp.direction);
        let coat_wi = frame_to_local(coat, lamp.direction);
        if (wi.z <= 0.0 && coat_wi.z <= 0.0) || all(lamp.irradiance <= vec3f(0.0)) {
            continue;
        }
        let visible = shadow_visibility(lights[i], position, t.geometric_normal, lamp.direction, lamp.distance);
        value += visible * lamp.irradiance * layered_response(s, wo, wi, coat_wo, coat_wi);
    }
    let hash = sampling_pcg(pixel.x + sampling_pcg(pixel.y + sampling_pcg(view.frame)));
    let rotation = vec2f(sampling_unit(hash), sampling_unit(sampling_pcg(hash)));
    let lobes = ClassicalLobes(
        select(0u, view.samples, sampled), view.source_count, rotation, view.environment_mips, view.prefiltered_mips,
        view.wide_alpha,
    );
    value += classical_environment(s, m.albedo_table, base, coat, to_viewer, t.occlusion, lobes);
    return min(value, vec3f(frame_max));
}
