// What a screen shows of a picture: itself, false colours, marks where it is clipped. Twin of mod.rs.

const DISPLAY_PICTURE: u32 = 0u;
const DISPLAY_FALSE_COLOR: u32 = 1u;
const DISPLAY_CLIPPING: u32 = 2u;

const MIDDLE_GREY: f32 = 0.18;
const CLIP_OVER: f32 = 254.5 / 255.0;
const CLIP_UNDER: f32 = 0.5 / 255.0;

// The band of an exposed luminance, sRGB encoded.
fn false_color(exposed_luminance: f32) -> vec3f {
    // Stops about middle grey from which on a band holds, after the first.
    var from_stops = array<f32, 12>(-6.0, -5.0, -4.0, -3.0, -2.0, -1.0, -0.5, 0.5, 1.0, 2.0, 3.0, 4.0);
    var colors = array<vec3f, 12>(
        vec3f(0.13, 0.02, 0.30),
        vec3f(0.10, 0.08, 0.55),
        vec3f(0.05, 0.20, 0.75),
        vec3f(0.05, 0.33, 0.85),
        vec3f(0.10, 0.46, 0.88),
        vec3f(0.25, 0.57, 0.85),
        vec3f(0.63, 0.63, 0.63),
        vec3f(0.80, 0.68, 0.35),
        vec3f(0.93, 0.74, 0.10),
        vec3f(0.98, 0.83, 0.20),
        vec3f(1.0, 0.92, 0.45),
        vec3f(1.0, 1.0, 1.0),
    );
    var color = vec3f(0.0);
    for (var i = 0u; i < 12u; i++) {
        if exposed_luminance >= MIDDLE_GREY * exp2(from_stops[i]) {
            color = colors[i];
        }
    }
    return color;
}

// A display-encoded colour with a mark where channels are at an end of 8 bits.
fn clipping_mark(shown: vec3f) -> vec3f {
    let over = shown >= vec3f(CLIP_OVER);
    let under = shown < vec3f(CLIP_UNDER);
    if all(over) {
        return vec3f(0.835, 0.369, 0.0);
    }
    if any(over) {
        return vec3f(0.941, 0.894, 0.259);
    }
    if all(under) {
        return vec3f(0.0, 0.447, 0.698);
    }
    if any(under) {
        return vec3f(0.337, 0.706, 0.914);
    }
    return shown;
}

// What a screen shows of an exposed linear colour, sRGB encoded.
fn view_display(mode: u32, tone: u32, linear: vec3f) -> vec3f {
    switch mode {
        case DISPLAY_FALSE_COLOR: {
            return false_color(dot(linear, vec3f(0.2126, 0.7152, 0.0722)));
        }
        case DISPLAY_CLIPPING: {
            return clipping_mark(tone_map(tone, linear));
        }
        default: {
            return tone_map(tone, linear);
        }
    }
}
