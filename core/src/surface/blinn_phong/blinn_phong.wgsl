// Blinn-Phong: a power of the cosine at the half vector. Local frame with z = n; exponents are held in range.

const BLINN_PHONG_EXPONENT_MAX: f32 = 1e5;
// Least cosine by which the unnormalised variant divides.
const BLINN_PHONG_COS_MIN: f32 = 1e-6;
// Variants. 0 stands for GGX where a surface chooses.
const BLINN_PHONG_EXACT: u32 = 1u;
const BLINN_PHONG_APPROXIMATE: u32 = 2u;
const BLINN_PHONG_UNNORMALIZED: u32 = 3u;
const BLINN_PHONG_MICROFACET: u32 = 4u;

fn blinn_phong_clamp_exponent(exponent: f32) -> f32 {
    return clamp(exponent, 0.0, BLINN_PHONG_EXPONENT_MAX);
}

// GGX width with the same density of normals at the peak.
fn blinn_phong_alpha(exponent: f32) -> f32 {
    return sqrt(2.0 / (blinn_phong_clamp_exponent(exponent) + 2.0));
}

// Its inverse.
fn blinn_phong_exponent(alpha: f32) -> f32 {
    // The floor lies beyond the largest exponent.
    return blinn_phong_clamp_exponent(2.0 / max(alpha * alpha, 1e-9) - 2.0);
}

// ln(1 - x) for x in [0, 1): the built-in logarithm of a number near one may have no digits.
fn blinn_phong_log_rest(x: f32) -> f32 {
    if x > 0.5 {
        return log(1.0 - x);
    }
    // -2 atanh(x / (2 - x)); the first term left out is 1e-7 of the sum.
    let t = x / (2.0 - x);
    let t2 = t * t;
    let sum = 1.0 / 3.0 + t2 * (1.0 / 5.0 + t2 * (1.0 / 7.0 + t2 * (1.0 / 9.0 + t2 * (1.0 / 11.0))));
    return -2.0 * t * (1.0 + t2 * sum);
}

// 1 - exp(-x) for x >= 0, likewise.
fn blinn_phong_exp_rest(x: f32) -> f32 {
    if x > 0.5 {
        return 1.0 - exp(-x);
    }
    let tail = 1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0 * (1.0 - x / 7.0)));
    return x * (1.0 - x / 2.0 * (1.0 - x / 3.0 * tail));
}

// cos^s of the angle between wm and the normal; 0 below the horizon.
fn blinn_phong_power(wm: vec3f, exponent: f32) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let sin2 = dot(wm.xy, wm.xy);
    var log_cos2: f32;
    if sin2 < 0.5 {
        log_cos2 = blinn_phong_log_rest(sin2);
    } else {
        // Some devices take the smallest numbers for 0, whose logarithm would be infinite.
        log_cos2 = 2.0 * log(max(wm.z, 1e-30));
    }
    return exp(0.5 * blinn_phong_clamp_exponent(exponent) * log_cos2);
}

// What the power is multiplied with in a variant that depends on nothing but the exponent.
fn blinn_phong_normalizer(exponent: f32, variant: u32) -> f32 {
    let s = blinn_phong_clamp_exponent(exponent);
    let eighth = 0.125 * INV_PI;
    switch variant {
        case BLINN_PHONG_APPROXIMATE: { return eighth * (s + 8.0); }
        case BLINN_PHONG_UNNORMALIZED: { return 1.0; }
        case BLINN_PHONG_MICROFACET: { return 0.5 * INV_PI * (s + 2.0); }
        default: { return eighth * (s + 2.0) * (s + 4.0) / (exp2(-0.5 * s) + s); }
    }
}

// Half vector and, as w, the cosine at it; all 0 where a direction is below the horizon or the two are opposite.
fn blinn_phong_half_vector(wo: vec3f, wi: vec3f) -> vec4f {
    let h = wo + wi;
    let length2 = dot(h, h);
    if wo.z <= 0.0 || wi.z <= 0.0 || length2 < 1e-24 {
        return vec4f(0.0);
    }
    let length = sqrt(length2);
    return vec4f(h / length, 0.5 * length);
}

// The cosine at the half vector, which is the argument of Fresnel, and the BRDF for F = 1.
fn blinn_phong_facet(wo: vec3f, wi: vec3f, exponent: f32, variant: u32) -> vec2f {
    let half = blinn_phong_half_vector(wo, wi);
    if half.w == 0.0 {
        return vec2f(0.0);
    }
    var value = blinn_phong_normalizer(exponent, variant) * blinn_phong_power(half.xyz, exponent);
    if variant == BLINN_PHONG_UNNORMALIZED {
        value /= max(wi.z, BLINN_PHONG_COS_MIN);
    } else if variant == BLINN_PHONG_MICROFACET {
        value *= 0.25 / (half.w * half.w);
    }
    return vec2f(half.w, value);
}

// Albedo of microfacets at normal incidence.
fn blinn_phong_microfacet_peak(s: f32) -> f32 {
    let half_ln2 = 0.34657359;
    // (1 - 2^(-s/2)) / s, which is ln(2) / 2 at 0.
    var ratio = half_ln2;
    if s > 1e-3 {
        ratio = blinn_phong_exp_rest(half_ln2 * s) / s;
    }
    return 2.0 - exp2(-0.5 * s) - (s + 2.0) * ratio;
}

// Share of light that the lobe returns toward the cosine mu when F = 1: fits.
fn blinn_phong_albedo(mu: f32, exponent: f32, variant: u32) -> f32 {
    let m = clamp(mu, 0.0, 1.0);
    let s = blinn_phong_clamp_exponent(exponent);
    let edge = exp2(-0.5 * s);
    if variant == BLINN_PHONG_UNNORMALIZED {
        let flat_part = pow(0.434 / sqrt(s + 0.753), 1.4175);
        let steep = pow(1.0 - 0.5 * edge, 1.4175);
        let root = flat_part + pow(m, 1.4686) * max(steep - flat_part, 0.0);
        return 8.0 * PI / (s + 2.0) * pow(root, 1.0 / 1.4175);
    }
    if variant == BLINN_PHONG_MICROFACET {
        let x = m * sqrt(s + 1.984);
        let dip = pow(1.0 - m, 0.694) * x / (0.4125 * x * x * x + 3.518 * x + 0.819);
        return 1.0 - dip - (1.0 - blinn_phong_microfacet_peak(s)) * pow(m, 0.748);
    }
    let x = m * sqrt(s + 0.167);
    let bend = s / (s + 0.95) * (1.0 - exp(-1.307 * x - 0.148 * x * x)) * (1.0 + 0.28 * m);
    let exact = (1.0 + m * m * (s - 1.0 + edge) + (1.0 - m * m) * bend) / (s + edge);
    return exact * blinn_phong_normalizer(s, variant) / blinn_phong_normalizer(s, BLINN_PHONG_EXACT);
}

// Cosine-weighted mean of blinn_phong_albedo over the hemisphere; 0 for the unnormalised variant.
fn blinn_phong_albedo_mean(exponent: f32, variant: u32) -> f32 {
    let s = blinn_phong_clamp_exponent(exponent);
    switch variant {
        case BLINN_PHONG_APPROXIMATE: { return 0.5 * (s + 8.0) / (s + 4.0); }
        case BLINN_PHONG_UNNORMALIZED: { return 0.0; }
        case BLINN_PHONG_MICROFACET: { return (s + 2.56) / (s + 6.27); }
        default: { return 0.5 * (s + 2.0) / (s + exp2(-0.5 * s)); }
    }
}

// BRDF with the reflectance at the half vector, without the cosine.
fn blinn_phong_eval(wo: vec3f, wi: vec3f, exponent: f32, variant: u32, fresnel: Fresnel) -> vec3f {
    let facet = blinn_phong_facet(wo, wi, exponent, variant);
    if facet.y == 0.0 {
        return vec3f(0.0);
    }
    return facet.y * fresnel_eval(fresnel, facet.x);
}

// Chance that blinn_phong_sample_wi draws by the cosine.
fn blinn_phong_cosine_share(exponent: f32, variant: u32) -> f32 {
    if variant == BLINN_PHONG_UNNORMALIZED || variant == BLINN_PHONG_MICROFACET {
        return 0.0;
    }
    return exp2(-0.125 * blinn_phong_clamp_exponent(exponent));
}

// Half vector with density (s + 2) / (2 pi) cos^(s + 1).
fn blinn_phong_sample_wm(exponent: f32, u: vec2f) -> vec3f {
    let log_cos2 = 2.0 * blinn_phong_log_rest(u.y) / (blinn_phong_clamp_exponent(exponent) + 2.0);
    let phi = 2.0 * PI * u.x;
    return vec3f(sqrt(blinn_phong_exp_rest(-log_cos2)) * vec2f(cos(phi), sin(phi)), exp(0.5 * log_cos2));
}

// Direction of light, by reflection at such a half vector or by the cosine; not above the horizon where there is none.
fn blinn_phong_sample_wi(wo: vec3f, exponent: f32, variant: u32, u: vec2f) -> vec3f {
    let none = vec3f(0.0, 0.0, -1.0);
    if wo.z <= 0.0 {
        return none;
    }
    let share = blinn_phong_cosine_share(exponent, variant);
    if u.y < share {
        return sampling_cosine_hemisphere(vec2f(u.x, u.y / share));
    }
    // The rest of the square, stretched; rounding must not bring it to one.
    let rest = min((u.y - share) / (1.0 - share), 0.99999994);
    let wm = blinn_phong_sample_wm(exponent, vec2f(u.x, rest));
    let toward = dot(wo, wm);
    if toward <= 0.0 {
        return none;
    }
    return normalize(2.0 * toward * wm - wo);
}

// Density of blinn_phong_sample_wi per steradian.
fn blinn_phong_pdf(wo: vec3f, wi: vec3f, exponent: f32, variant: u32) -> f32 {
    let half = blinn_phong_half_vector(wo, wi);
    if half.w == 0.0 {
        return 0.0;
    }
    let share = blinn_phong_cosine_share(exponent, variant);
    let s = blinn_phong_clamp_exponent(exponent);
    let density = 0.5 * INV_PI * (s + 2.0) * blinn_phong_power(half.xyz, s) * half.z;
    return (1.0 - share) * 0.25 * density / half.w + share * INV_PI * wi.z;
}
