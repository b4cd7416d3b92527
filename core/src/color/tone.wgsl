// Display transforms and the sRGB transfer. Twin of tone.rs and of the transfer in rgb.rs.

const TONE_NONE: u32 = 0u;
const TONE_NEUTRAL: u32 = 1u;
const TONE_AGX: u32 = 2u;
const TONE_ACES: u32 = 3u;

// Larger values are taken for this one, so that no intermediate result overflows.
const MAX_LINEAR: f32 = 1e9;

// sRGB encoding of linear light, both in [0, 1]; values outside are clamped (IEC 61966-2-1).
fn srgb_from_linear(x: vec3f) -> vec3f {
    let v = clamp(x, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(v, vec3f(1.0 / 2.4)) - 0.055, 12.92 * v, v <= vec3f(0.0031308));
}

// Linear light of an sRGB encoding, both in [0, 1]; values outside are clamped.
fn linear_from_srgb(x: vec3f) -> vec3f {
    let v = clamp(x, vec3f(0.0), vec3f(1.0));
    return select(pow((v + 0.055) / 1.055, vec3f(2.4)), v / 12.92, v <= vec3f(0.04045));
}

// Khronos PBR Neutral; x >= 0.
fn tone_neutral(x: vec3f) -> vec3f {
    const f90 = 0.04;
    const start = 0.8 - f90;
    const desaturation = 0.15;
    let least = min(x.x, min(x.y, x.z));
    let offset = select(f90, least - 6.25 * least * least, least < 2.0 * f90);
    let color = x - offset;
    let peak = max(color.x, max(color.y, color.z));
    if peak < start {
        return color;
    }
    let room = 1.0 - start;
    let new_peak = 1.0 - room * room / (peak + room - start);
    let white = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(color * (new_peak / peak), vec3f(new_peak), white);
}

// Sigmoid of AgX over log2 of light, from 10 stops below middle grey (0.18) to 6.5 above.
fn agx_curve(x: vec3f) -> vec3f {
    let stops = log2(max(x, vec3f(1e-10))) + 2.4739312;
    let d = clamp((stops + 10.0) / 16.5, vec3f(0.0), vec3f(1.0)) - 0.6060606;
    let lower = d < vec3f(0.0);
    let scale = select(vec3f(69.86279), vec3f(59.507877), lower);
    let power = select(vec3f(3.25), vec3f(3.0), lower);
    return 0.5 + 2.0 * d * pow(1.0 + scale * pow(abs(d), power), -1.0 / power);
}

// AgX; x >= 0.
fn tone_agx(x: vec3f) -> vec3f {
    let inset = mat3x3f(
        0.84236416, 0.04232981, 0.04237768,
        0.0784229, 0.8785011, 0.07843735,
        0.07921294, 0.07916906, 0.87918497,
    );
    let outset = mat3x3f(
        1.1970423, -0.05290407, -0.05297886,
        -0.09801725, 1.1518605, -0.09803982,
        -0.09902501, -0.09895645, 1.1510187,
    );
    let code = clamp(outset * agx_curve(inset * x), vec3f(0.0), vec3f(1.0));
    return pow(code, vec3f(2.2));
}

// Fit of the ACES 1.0 output for sRGB; x >= 0.
fn tone_aces(x: vec3f) -> vec3f {
    let input = mat3x3f(0.59719, 0.076, 0.0284, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    let output = mat3x3f(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    let v = input * x;
    return output * ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.432951) + 0.238081));
}

// The light that the screen gives off, linear Rec.709 in [0, 1], before encoding.
fn tone_display_linear(kind: u32, linear: vec3f) -> vec3f {
    let x = clamp(linear, vec3f(0.0), vec3f(MAX_LINEAR));
    var shown = x;
    switch kind {
        case TONE_NEUTRAL: { shown = tone_neutral(x); }
        case TONE_AGX: { shown = tone_agx(x); }
        case TONE_ACES: { shown = tone_aces(x); }
        default: {}
    }
    return clamp(shown, vec3f(0.0), vec3f(1.0));
}

// Display-encoded sRGB in [0, 1] of exposed scene-linear Rec.709.
fn tone_map(kind: u32, linear: vec3f) -> vec3f {
    return srgb_from_linear(tone_display_linear(kind, linear));
}
