// Shadows of lights with an area: percentage-closer soft shadows (Fernando 2005) from depths seen from the light's middle.
//
// A depth in the map is a point of the world. It is in the way where it lies above the plane of the surface (so nothing
// shadows itself where it bends away) and where the ray to it goes on to the light.


// Half the light's axes as a point sees them: across the line to it.
struct SoftLight {
    a: vec3f,
    b: vec3f,
    // From the light's middle to the point, or the direction of a sun.
    toward: vec3f,
    // The light is a disk in these axes.
    round: bool,
    // 0: nothing to look for.
    size: f32,
}

fn soft_light(light: LightData, position: vec3f) -> SoftLight {
    let offset = position - light.position;
    if light.kind == LIGHT_RECTANGLE {
        let up = cross(light.across, light.direction);
        let size = max(light.size.x, light.size.y);
        return SoftLight(0.5 * light.size.x * light.across, 0.5 * light.size.y * up, offset, false, size);
    }
    if light.kind == LIGHT_SUN {
        let frame = frame_new(light.direction);
        return SoftLight(light.size.x * frame.t, light.size.x * frame.b, light.direction, true, 1.0);
    }
    let distance2 = dot(offset, offset);
    let radius2 = light.size.x * light.size.x;
    if distance2 <= radius2 {
        return SoftLight(vec3f(0.0), vec3f(0.0), offset, true, 0.0);
    }
    // The rim that is seen lies nearer than the middle: as wide as this at the middle.
    let radius = light.size.x * inverseSqrt(1.0 - radius2 / distance2);
    let frame = frame_new(offset * inverseSqrt(distance2));
    return SoftLight(radius * frame.t, radius * frame.b, offset, true, radius);
}

// Point of the world that the map holds in the direction of `target`; w: 0 for none.
fn soft_blocker(light: LightData, position: vec3f) -> vec4f {
    let offset = position - light.position;
    var layer = light.shadow_layer;
    if light.kind != LIGHT_SUN {
        let up = cross(light.across, light.direction);
        let local = vec3f(dot(offset, light.across), dot(offset, up), -dot(offset, light.direction));
        let face = shadow_face(local);
        if light.kind == LIGHT_RECTANGLE && face == 4u {
            return vec4f(0.0);
        }
        layer += min(face, select(5u, 4u, light.kind == LIGHT_RECTANGLE));
    }
    let clip = shadow_clip_from_world[layer] * vec4f(position, 1.0);
    let ndc = clip.xyz / clip.w;
    let uv = ndc.xy * vec2f(0.5, -0.5) + 0.5;
    if clip.w <= 0.0 || any(uv < vec2f(0.0)) || any(uv >= vec2f(1.0)) {
        return vec4f(0.0);
    }
    let texel = vec2u(uv * vec2f(textureDimensions(shadow_maps)));
    let depth = textureLoad(shadow_maps, texel, layer, 0);
    if depth <= 0.0 {
        return vec4f(0.0);
    }
    if light.kind == LIGHT_SUN {
        return vec4f(position - light.direction * (light.shadow_depth * (depth - ndc.z)), 1.0);
    }
    return vec4f(light.position + offset * (light.shadow_depth / (depth * clip.w)), 1.0);
}

// A place on the light, in its axes.
fn soft_place(index: u32, rotation: vec2f, round: bool) -> vec2f {
    // Roberts 2018, the R2 sequence.
    let u = fract(rotation + f32(index + 1u) * vec2f(0.7548776662, 0.5698402910));
    if round {
        let phi = 2.0 * PI * u.y;
        return sqrt(u.x) * vec2f(cos(phi), sin(phi));
    }
    return 2.0 * u - 1.0;
}

// Share of the light above the surface's plane that nothing hides.
fn soft_visibility(light: LightData, position: vec3f, normal: vec3f, rotation: vec2f) -> f32 {
    if light.shadow_layer == SHADOW_NONE {
        return 1.0;
    }
    let sun = light.kind == LIGHT_SUN;
    let seen = soft_light(light, position);
    if seen.size <= 0.0 {
        return 1.0;
    }
    let texel = light.shadow_texel * select(length(seen.toward), 1.0, sun);
    let margin = 2.0 * texel;
    // What can hide a sun is nearer than half the depth of its map, from points within the scene; ground under a low sun lies
    // behind all of it, and further away.
    var nearest = 0.02;
    var farthest = 0.5;
    if sun {
        let depth = (shadow_clip_from_world[light.shadow_layer] * vec4f(position, 1.0)).z;
        nearest = max(nearest, 0.25 - depth);
        farthest = max(farthest, 0.75 - depth);
    }
    // How far a surface in the way is: for a sun in metres from the point, else as a share of the way from the light.
    var sum = 0.0;
    var found = 0.0;
    for (var i = 0u; i < view.soft_searched; i++) {
        let place = soft_place(i, rotation, seen.round);
        let step = (f32(i) + fract(rotation.x + rotation.y)) / f32(view.soft_searched);
        // From the point outward; squares look closer where most is.
        var spread = mix(nearest, farthest, step * step) * light.shadow_depth;
        if !sun {
            let share = mix(0.98, 0.15, step);
            spread = (1.0 - share) / share;
        }
        let target_point = position + (seen.a * place.x + seen.b * place.y) * spread;
        let blocker = soft_blocker(light, target_point);
        if blocker.w == 0.0 || dot(blocker.xyz - position, normal) <= margin {
            continue;
        }
        var reach = 0.0;
        var goes_on = 0.0;
        if sun {
            reach = dot(target_point - blocker.xyz, light.direction);
            goes_on = spread / max(reach, 1e-6);
        } else {
            reach = distance(blocker.xyz, light.position) / distance(target_point, light.position);
            goes_on = spread * reach / max(1.0 - reach, 1e-6);
        }
        let at = abs(place) * goes_on;
        let inside = select(max(at.x, at.y), length(at), seen.round) <= 1.0;
        if inside && reach > 0.0 && (sun || reach < 1.0) {
            sum += reach;
            found += 1.0;
        }
    }
    if found == 0.0 {
        return 1.0;
    }
    let reach = sum / found;
    let spread = select((1.0 - reach) / reach, reach, sun);
    var lit = 0.0;
    var count = 0.0;
    for (var i = 0u; i < view.soft_filtered; i++) {
        let place = soft_place(i + view.soft_searched, rotation, seen.round);
        let on_light = seen.a * place.x + seen.b * place.y;
        if dot(on_light - seen.toward, normal) <= 0.0 {
            continue;
        }
        count += 1.0;
        let blocker = soft_blocker(light, position + on_light * spread);
        if blocker.w == 0.0 || dot(blocker.xyz - position, normal) <= margin {
            lit += 1.0;
        }
    }
    return select(1.0, lit / count, count > 0.0);
}
