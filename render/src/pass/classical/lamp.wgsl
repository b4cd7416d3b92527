// What a lamp is to a point, before its shadow. Whoever joins this declares `unlit`.

// False where the light leaves the instance out.
fn lights_instance(light: u32, instance: u32) -> bool {
    if view.unlit_words == 0u {
        return true;
    }
    return (unlit[light * view.unlit_words + instance / 32u] >> (instance % 32u) & 1u) == 0u;
}

// Irradiance of a sharp lamp on a surface that faces it, before its shadow; direction in xyz of the result's pair.
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

// Radiance of a light with an area. The illuminance of a sun is pi sin^2 times its radiance.
fn lamp_radiance(light: LightData) -> vec3f {
    if light.kind == LIGHT_SUN {
        return light.intensity / (PI * light.size.x * light.size.x);
    }
    return light.intensity;
}
