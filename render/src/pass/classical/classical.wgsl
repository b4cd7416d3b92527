// Lights the G-buffer and fills the rest with the environment.

// llvmpipe compiles a fragment shader twice, once for blocks that a triangle covers and is seen in wholly, unless it may
// discard. Compiling takes it far longer than drawing.
override discards: bool = false;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let first = textureLoad(words0, pixel, 0);
    if discards && first.x == 0xffffffffu {
        // No instance has this number.
        discard;
    }
    if first.x == 0u {
        let direction = background_direction(position.xy);
        var value = lamps_seen(eye(position.xy), direction, 2.0 * FAR);
        if shows(CONTRIBUTION_ENVIRONMENT) {
            // Where there is no surface, the second words are what the catcher wrote.
            let blocked = bitcast<vec3f>(textureLoad(words1, pixel, 0).xyz);
            value += background_seen(eye(position.xy), direction) * (1.0 - blocked);
        }
        return vec4f(min(value, vec3f(frame_max)), 1.0);
    }
    let packed = Packed(
        first, textureLoad(words1, pixel, 0), textureLoad(words2, pixel, 0), textureLoad(words3, pixel, 0),
    );
    let world = unproject(position.xy, textureLoad(depth, pixel, 0));
    let point = world.xyz / world.w;
    let origin = eye(position.xy);
    let before = lamps_seen(origin, background_direction(position.xy), distance(origin, point));
    return vec4f(min(shade(texel_unpack(packed), point, pixel) + before, vec3f(frame_max)), 1.0);
}
