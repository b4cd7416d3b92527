// A dielectric: GGX reflection over a matte base that receives what the reflection leaves.

// Reflectance at normal incidence by KHR_materials_ior and KHR_materials_specular; f90 is `specular`.
fn dielectric_f0(ior: f32, specular: f32, specular_color: vec3f) -> vec3f {
    let r = (ior - 1.0) / (ior + 1.0);
    return specular * min(r * r * specular_color, vec3f(1.0));
}

// Share of the light from w that the reflection takes.
fn dielectric_albedo(w: vec3f, alpha: vec2f, f0: f32, f90: f32, masking: u32) -> f32 {
    return (1.0 - ggx_loss(w, alpha, masking)) * mix(f0, f90, ggx_schlick_ratio(w, alpha, masking));
}

// Its cosine-weighted mean over the hemisphere.
fn dielectric_albedo_mean(alpha: vec2f, f0: f32, f90: f32, masking: u32) -> f32 {
    return f0 * (1.0 - ggx_loss_mean(alpha, masking)) + (f90 - f0) * ggx_schlick_mean(alpha, masking);
}

// Matte part below the reflection: BRDF without the cosine. The largest channel of f0 takes from all channels, so that
// a tinted reflection does not tint the base with the complement.
fn dielectric_base(wo: vec3f, wi: vec3f, alpha: vec2f, f0: vec3f, f90: f32, base_color: vec3f, masking: u32) -> vec3f {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return vec3f(0.0);
    }
    let strongest = max(f0.x, max(f0.y, f0.z));
    let left_o = 1.0 - dielectric_albedo(wo, alpha, strongest, f90, masking);
    let left_i = 1.0 - dielectric_albedo(wi, alpha, strongest, f90, masking);
    let left_mean = 1.0 - dielectric_albedo_mean(alpha, strongest, f90, masking);
    return lambert_eval(base_color) * (left_o * left_i / max(left_mean, 1e-6));
}

// Reflection and base: BRDF without the cosine.
fn dielectric_eval(wo: vec3f, wi: vec3f, alpha: vec2f, f0: vec3f, f90: f32, base_color: vec3f, masking: u32) -> vec3f {
    let facet = ggx_microfacet(wo, wi, alpha, masking);
    let reflected = facet.y * fresnel_schlick(f0, f90, facet.x);
    return reflected + dielectric_base(wo, wi, alpha, f0, f90, base_color, masking);
}
