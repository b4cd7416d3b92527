// Lights with a place: those of one direction a point, and those with an area.

// Radiance toward the viewer that a lamp adds, with its shadow.
fn lamp_light(
    light: LightData, s: Surface, base: Frame, coat: Frame, to_viewer: vec3f, position: vec3f, normal: vec3f,
    rotation: vec2f,
) -> vec3f {
    let reflections = (light.flags & LIGHT_REFLECTIONS) != 0u;
    let wo = classical_facing(frame_to_local(base, to_viewer));
    let coat_wo = classical_facing(frame_to_local(coat, to_viewer));
    if areas && light.kind >= LIGHT_RECTANGLE {
        let shape = lamp_shape(light, position);
        if shape.kind == AREA_NOTHING {
            return vec3f(0.0);
        }
        let value = lamp_radiance(light)
            * area_response(s, wo, area_local(shape, base), coat_wo, area_local(shape, coat), reflections);
        if all(value <= vec3f(0.0)) {
            return vec3f(0.0);
        }
        return value * soft_visibility(light, position, normal, rotation);
    }
    let lamp = lamp_at(light, position);
    let wi = frame_to_local(base, lamp.direction);
    let coat_wi = frame_to_local(coat, lamp.direction);
    if (wi.z <= 0.0 && coat_wi.z <= 0.0) || all(lamp.irradiance <= vec3f(0.0)) {
        return vec3f(0.0);
    }
    let visible = shadow_visibility(light, position, normal, lamp.direction, lamp.distance);
    if reflections {
        return visible * lamp.irradiance * layered_response(s, wo, wi, coat_wo, coat_wi);
    }
    var value = (1.0 - s.metallic) * layered_matte(s, wo, wi) * max(wi.z, 0.0);
    if s.coat > 0.0 {
        value *= coat_transmission(coat_wo, s.coat_alpha, s.coat, s.masking)
            * coat_transmission(coat_wi, s.coat_alpha, s.coat, s.masking);
    }
    return visible * lamp.irradiance * value;
}

// What shines of a light with an area, relative to a point of the world.
fn lamp_shape(light: LightData, position: vec3f) -> AreaShape {
    if light.kind == LIGHT_RECTANGLE {
        return area_rectangle(light.position - position, light.direction, light.across, light.size);
    }
    if light.kind == LIGHT_SPHERE {
        return area_sphere(light.position - position, light.size.x);
    }
    return area_cap(-light.direction, light.size.x);
}

// Radiance of the lights that the eye sees as shapes along a ray (unit direction) before `limit` metres.
fn lamps_seen(origin: vec3f, direction: vec3f, limit: f32) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < view.light_count; i++) {
        let light = lights[i];
        if (light.flags & LIGHT_CAMERA) != 0u && light.kind >= LIGHT_RECTANGLE && shows(CONTRIBUTION_LIGHT + i)
            && lamp_is_met(light, origin, direction, limit) {
            sum += lamp_radiance(light);
        }
    }
    return sum;
}

fn lamp_is_met(light: LightData, origin: vec3f, direction: vec3f, limit: f32) -> bool {
    let toward = light.position - origin;
    if light.kind == LIGHT_SUN {
        let away = cross(direction, light.direction);
        return limit >= FAR && dot(direction, light.direction) < 0.0 && dot(away, away) <= light.size.x * light.size.x;
    }
    if light.kind == LIGHT_SPHERE {
        let along = dot(toward, direction);
        let away = toward - along * direction;
        let half2 = light.size.x * light.size.x - dot(away, away);
        if half2 < 0.0 || light.size.x <= 0.0 {
            return false;
        }
        let inside = dot(toward, toward) < light.size.x * light.size.x;
        let t = along + select(-sqrt(half2), sqrt(half2), inside);
        return t > 0.0 && t < limit;
    }
    let facing = -dot(light.direction, direction);
    let t = -dot(toward, light.direction) / facing;
    let at = direction * t - toward;
    let along = vec2f(dot(at, light.across), dot(at, cross(light.across, light.direction)));
    return facing > 0.0 && t > 0.0 && t < limit && all(abs(along) <= 0.5 * light.size)
        && min(light.size.x, light.size.y) > 0.0;
}

// Where nothing limits a ray.
const FAR: f32 = 1e30;

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
    // The ground under a low sun lies behind the far plane of its map.
    let depth = max(ndc.z, 0.0);
    let step = 1.0 / vec2f(textureDimensions(shadow_maps));
    var lit = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let at = uv + vec2f(f32(x), f32(y)) * step;
            lit += textureSampleCompareLevel(shadow_maps, shadow_sampler, at, layer, depth);
        }
    }
    return lit / 9.0;
}
