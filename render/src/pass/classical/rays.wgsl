// Rays of the eye through pixels, for passes that cover the target.

// One triangle over the whole target.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn unproject(pixel: vec2f, depth_value: f32) -> vec4f {
    let ndc = (pixel / view.size) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return view.world_from_clip * vec4f(ndc, depth_value, 1.0);
}

// Where the ray of a pixel starts.
fn eye(pixel: vec2f) -> vec3f {
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
