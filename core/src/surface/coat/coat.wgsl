// A clear coat: colourless GGX reflection over another surface.

// Reflectance of index 1.5 at normal incidence (KHR_materials_clearcoat).
const COAT_F0: f32 = 0.04;

// The coat's reflection for weight 1: BRDF without the cosine.
fn coat_eval(wo: vec3f, wi: vec3f, alpha: f32, masking: u32) -> f32 {
    let facet = ggx_microfacet(wo, wi, vec2f(alpha), masking);
    return facet.y * fresnel_schlick(vec3f(COAT_F0), 1.0, facet.x).x;
}

// Share of the light that passes a coat of the given weight toward w; applies once toward wo, once toward wi.
fn coat_transmission(w: vec3f, alpha: f32, coat: f32, masking: u32) -> f32 {
    return 1.0 - coat * dielectric_albedo(w, vec2f(alpha), COAT_F0, 1.0, masking);
}
