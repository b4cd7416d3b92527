// The whole surface: metal and dielectric mixed, under a coat.

// A shaded point with its textures looked up. A value, never stored in a buffer.
struct Surface {
    base_color: vec3f,
    metallic: f32,
    alpha: vec2f,
    fresnel: Fresnel,
    fresnel_mean: vec3f,
    dielectric_f0: vec3f,
    dielectric_f90: f32,
    coat: f32,
    coat_alpha: f32,
    masking: u32,
    multiple_scattering: bool,
}

// What metal and dielectric below the coat reflect at once: BRDF without the cosine. They share width and so the
// microfacet term.
fn layered_glossy(s: Surface, wo: vec3f, wi: vec3f) -> vec3f {
    let facet = ggx_microfacet(wo, wi, s.alpha, s.masking);
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
    if s.metallic > 0.0 && s.multiple_scattering {
        value += s.metallic * ggx_multiple(wo, wi, s.alpha, s.fresnel_mean, s.masking);
    }
    if s.metallic < 1.0 {
        value += (1.0 - s.metallic)
            * dielectric_base(wo, wi, s.alpha, s.dielectric_f0, s.dielectric_f90, s.base_color, s.masking);
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
