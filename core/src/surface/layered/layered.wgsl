// The whole surface: metal and dielectric mixed, under a coat.

const LAYERED_GGX: u32 = 0u;

// A shaded point with its textures looked up. A value, never stored in a buffer.
struct Surface {
    base_color: vec3f,
    metallic: f32,
    // Of GGX; of a Blinn-Phong lobe the width that stands for it.
    alpha: vec2f,
    // LAYERED_GGX or a variant of Blinn-Phong with its exponent.
    lobe: u32,
    exponent: f32,
    fresnel: Fresnel,
    fresnel_mean: vec3f,
    dielectric_f0: vec3f,
    dielectric_f90: f32,
    coat: f32,
    coat_alpha: f32,
    masking: u32,
    multiple_scattering: bool,
}

// The cosine at the half vector and the BRDF for F = 1.
fn layered_facet(s: Surface, wo: vec3f, wi: vec3f) -> vec2f {
    if s.lobe == LAYERED_GGX {
        return ggx_microfacet(wo, wi, s.alpha, s.masking);
    }
    return blinn_phong_facet(wo, wi, s.exponent, s.lobe);
}

// True where the metal returns light that scattered more than once.
fn layered_scatters_again(s: Surface) -> bool {
    return s.multiple_scattering && s.lobe == LAYERED_GGX;
}

// The dielectric's base: what the reflection leaves; older shaders add it whole and without 1 / pi.
fn layered_matte(s: Surface, wo: vec3f, wi: vec3f) -> vec3f {
    if s.lobe == LAYERED_GGX {
        return dielectric_base(wo, wi, s.alpha, s.dielectric_f0, s.dielectric_f90, s.base_color, s.masking);
    }
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return vec3f(0.0);
    }
    if s.lobe == BLINN_PHONG_UNNORMALIZED {
        return s.base_color;
    }
    // The mean leaves out what grazing light gets more by f90, so that the whole stays below one.
    let left_mean = 1.0 - layered_strongest(s) * blinn_phong_albedo_mean(s.exponent, s.lobe);
    return lambert_eval(s.base_color) * (layered_left(s, wo) * layered_left(s, wi) / max(left_mean, 1e-6));
}

fn layered_strongest(s: Surface) -> f32 {
    return max(s.dielectric_f0.x, max(s.dielectric_f0.y, s.dielectric_f0.z));
}

// Share of light that the lobe returns toward w when F = 1: exact for GGX, fitted for others.
fn layered_lobe_albedo(s: Surface, w: vec3f) -> f32 {
    if s.lobe == LAYERED_GGX {
        return 1.0 - ggx_loss(w, s.alpha, s.masking);
    }
    return blinn_phong_albedo(w.z, s.exponent, s.lobe);
}

// Share of the light from w that the dielectric's reflection leaves to its base, in [0, 1].
fn layered_left(s: Surface, w: vec3f) -> f32 {
    let mean = mix(layered_strongest(s), s.dielectric_f90, ggx_schlick_ratio(w, s.alpha, s.masking));
    return max(1.0 - layered_lobe_albedo(s, w) * mean, 0.0);
}

// Share of even light that the dielectric's base sends toward wo, about; older shaders count it without 1 / pi.
fn layered_matte_albedo(s: Surface, wo: vec3f) -> vec3f {
    if s.lobe == BLINN_PHONG_UNNORMALIZED {
        return PI * s.base_color;
    }
    return layered_left(s, wo) * s.base_color;
}

// What metal and dielectric below the coat reflect at once: BRDF without the cosine. They share width and so the
// microfacet term.
fn layered_glossy(s: Surface, wo: vec3f, wi: vec3f) -> vec3f {
    let facet = layered_facet(s, wo, wi);
    if facet.y <= 0.0 {
        return vec3f(0.0);
    }
    return facet.y * layered_reflectance(s, facet.x);
}

// Reflectance of metal and dielectric below the coat at the cosine to a (microfacet) normal.
fn layered_reflectance(s: Surface, cos_theta: f32) -> vec3f {
    var value = vec3f(0.0);
    if s.metallic > 0.0 {
        value += s.metallic * fresnel_eval(s.fresnel, cos_theta);
    }
    if s.metallic < 1.0 {
        value += (1.0 - s.metallic) * fresnel_schlick(s.dielectric_f0, s.dielectric_f90, cos_theta);
    }
    return value;
}

// What leaves in all directions: the matte base of the dielectric, and light that scattered more than once in the metal.
fn layered_spread(s: Surface, wo: vec3f, wi: vec3f) -> vec3f {
    var value = vec3f(0.0);
    if s.metallic > 0.0 && layered_scatters_again(s) {
        value += s.metallic * ggx_multiple(wo, wi, s.alpha, s.fresnel_mean, s.masking);
    }
    if s.metallic < 1.0 {
        value += (1.0 - s.metallic) * layered_matte(s, wo, wi);
    }
    return value;
}

// Metal and dielectric below the coat: BRDF without the cosine.
fn layered_base(s: Surface, wo: vec3f, wi: vec3f) -> vec3f {
    return layered_glossy(s, wo, wi) + layered_spread(s, wo, wi);
}

// Reflected radiance over incident radiance and solid angle: all lobes times their cosine. wo and wi are given in the
// frame of the base and in the frame of the coat.
fn layered_response(s: Surface, wo: vec3f, wi: vec3f, coat_wo: vec3f, coat_wi: vec3f) -> vec3f {
    var value = layered_base(s, wo, wi) * max(wi.z, 0.0);
    if s.coat > 0.0 {
        let passed = coat_transmission(coat_wo, s.coat_alpha, s.coat, s.masking)
            * coat_transmission(coat_wi, s.coat_alpha, s.coat, s.masking);
        value = value * passed + s.coat * coat_eval(coat_wo, coat_wi, s.coat_alpha, s.masking) * max(coat_wi.z, 0.0);
    }
    return value;
}
