// Exposure and display transform of a linear picture.

struct Display {
    // Factor on the picture: 2^EV over the number of summed frames.
    factor: f32,
    tone: u32,
    pad0: u32,
    pad1: u32,
}

@group(0) @binding(0) var<uniform> display: Display;
@group(0) @binding(1) var linear_texture: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let linear = textureLoad(linear_texture, vec2u(position.xy), 0).rgb;
    return vec4f(tone_map(display.tone, linear * display.factor), 1.0);
}
