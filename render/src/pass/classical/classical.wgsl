// Lights the G-buffer and fills the rest with the environment.

@group(1) @binding(0) var words0: texture_2d<u32>;
@group(1) @binding(1) var words1: texture_2d<u32>;
@group(1) @binding(2) var words2: texture_2d<u32>;
@group(1) @binding(3) var words3: texture_2d<u32>;
@group(1) @binding(4) var depth: texture_depth_2d;

// One triangle over the whole target.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn unproject(pixel: vec2f, depth_value: f32) -> vec4f {
    let ndc = (pixel / view.size) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return view.world_from_clip * vec4f(ndc, depth_value, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let first = textureLoad(words0, pixel, 0);
    if first.x == 0u {
        let origin = background_origin(position.xy);
        let direction = background_direction(position.xy);
        var value = lamps_seen(origin, direction, 2.0 * FAR);
        if shows(CONTRIBUTION_ENVIRONMENT) {
            value += background_seen(origin, direction);
        }
        return vec4f(min(value, vec3f(frame_max)), 1.0);
    }
    let packed = Packed(
        first, textureLoad(words1, pixel, 0), textureLoad(words2, pixel, 0), textureLoad(words3, pixel, 0),
    );
    let world = unproject(position.xy, textureLoad(depth, pixel, 0));
    let point = world.xyz / world.w;
    let origin = background_origin(position.xy);
    let before = lamps_seen(origin, background_direction(position.xy), distance(origin, point));
    return vec4f(min(shade(texel_unpack(packed), point, pixel) + before, vec3f(frame_max)), 1.0);
}

// Where the ray of a pixel starts.
fn background_origin(pixel: vec2f) -> vec3f {
    if view.viewer.w == 0.0 {
        let near = unproject(pixel, 1.0);
        return near.xyz / near.w;
    }
    return view.viewer.xyz;
}

// Direction in which a pixel looks past everything.
fn background_direction(pixel: vec2f) -> vec3f {
    if view.viewer.w == 0.0 {
        return -normalize(view.viewer.xyz);
    }
    // Any depth in front of the viewer lies on the ray.
    let world = unproject(pixel, 0.5);
    return normalize(world.xyz / world.w - view.viewer.xyz);
}
