// Adds one frame to the sum of the frames before it.

@group(0) @binding(0) var frame_texture: texture_2d<f32>;
@group(0) @binding(1) var sum_before: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    return textureLoad(sum_before, pixel, 0) + textureLoad(frame_texture, pixel, 0);
}
