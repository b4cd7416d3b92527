// What the eye sees behind everything: the environment or a map of its own, infinitely far away or on a ground.

@group(3) @binding(0) var background_map: texture_2d<f32>;
@group(3) @binding(1) var<uniform> background: BackgroundData;

fn background_texel(x: i32, y: i32) -> vec3f {
    let size = vec2i(textureDimensions(background_map));
    let column = ((x % size.x) + size.x) % size.x;
    return textureLoad(background_map, vec2i(column, clamp(y, 0, size.y - 1)), 0).rgb;
}

// Bilinear, wrapping around and stopping at the poles, as `Environment::radiance` on the processor.
fn background_radiance(d: vec3f) -> vec3f {
    let own = vec3f(background.cos * d.x - background.sin * d.z, d.y, background.sin * d.x + background.cos * d.z);
    let level = length(own.xz);
    let around = select(0.0, atan2(own.x, -own.z), level > 0.0);
    let uv = vec2f(0.5 + 0.15915494 * around, 0.31830989 * atan2(level, own.y));
    let p = uv * vec2f(textureDimensions(background_map)) - 0.5;
    let low = vec2i(floor(p));
    let f = p - floor(p);
    let top = mix(background_texel(low.x, low.y), background_texel(low.x + 1, low.y), f.x);
    let bottom = mix(background_texel(low.x, low.y + 1), background_texel(low.x + 1, low.y + 1), f.x);
    return background.scale * mix(top, bottom, f.y);
}

// Where a ray of the eye looks into the map; w is the distance to the ground along it, 0 where it does not meet that.
fn background_found(origin: vec3f, direction: vec3f) -> vec4f {
    if background.radius > 0.0 {
        return ground_project(origin, direction, background.center, background.height, background.radius);
    }
    return vec4f(direction, 0.0);
}

// Along a ray of the eye, without the shadows of the scene.
fn background_seen(origin: vec3f, direction: vec3f) -> vec3f {
    let found = background_found(origin, direction);
    if background.mapped != 0u {
        return background_radiance(found.xyz);
    }
    return classical_radiance(found.xyz, 0.0);
}
