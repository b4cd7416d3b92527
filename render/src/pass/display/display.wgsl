// From summed scene-linear frames to what a screen shows.

@group(0) @binding(0) var<uniform> display: DisplayData;
@group(0) @binding(1) var picture: texture_2d<f32>;
@group(0) @binding(2) var picture_before: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    var linear = display.factor * textureLoad(picture, vec2u(position.xy), 0).rgb;
    if display.before > 0.0 {
        linear += display.before * textureLoad(picture_before, vec2u(position.xy), 0).rgb;
    }
    return vec4f(view_display(display.mode, display.tone, linear), 1.0);
}
