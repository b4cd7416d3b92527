// A dielectric: GGX reflection over a matte base that receives what the reflection leaves.

// Reflectance at normal incidence by KHR_materials_ior and KHR_materials_specular; f90 is `specular`.
fn dielectric_f0(ior: f32, specular: f32, specular_color: vec3f) -> vec3f {
    let r = (ior - 1.0) / (ior + 1.0);
    return specular * min(r * r * specular_color, vec3f(1.0));
}

// Share of the light from cosine mu that the reflection takes, for the isotropic width alpha.
fn dielectric_albedo(mu: f32, alpha: f32, f0: f32, f90: f32, masking: u32) -> f32 {
    return ggx_albedo(mu, alpha, masking) * mix(f0, f90, ggx_albedo_schlick_ratio(mu, alpha, masking));
}

// Its cosine-weighted mean over the hemisphere.
fn dielectric_albedo_mean(alpha: f32, f0: f32, f90: f32, masking: u32) -> f32 {
    return f0 * ggx_albedo_mean(alpha, masking) + (f90 - f0) * ggx_albedo_schlick_mean(alpha, masking);
}

// The isotropic width whose albedo stands for both.
fn dielectric_width(alpha: vec2f) -> f32 {
    let a = ggx_clamp_alpha(alpha);
    return sqrt(0.5 * dot(a, a));
}

// Matte part below the reflection: BRDF without the cosine. The largest channel of f0 takes from all channels, so that
// a tinted reflection does not tint the base with the complement.
fn dielectric_base(wo: vec3f, wi: vec3f, alpha: vec2f, f0: vec3f, f90: f32, base_color: vec3f, masking: u32) -> vec3f {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return vec3f(0.0);
    }
    let width = dielectric_width(alpha);
    let strongest = max(f0.x, max(f0.y, f0.z));
    let left_o = 1.0 - dielectric_albedo(wo.z, width, strongest, f90, masking);
    let left_i = 1.0 - dielectric_albedo(wi.z, width, strongest, f90, masking);
    let left_mean = 1.0 - dielectric_albedo_mean(width, strongest, f90, masking);
    return lambert_eval(base_color) * (left_o * left_i / max(left_mean, 1e-6));
}

// Reflection and base: BRDF without the cosine.
fn dielectric_eval(wo: vec3f, wi: vec3f, alpha: vec2f, f0: vec3f, f90: f32, base_color: vec3f, masking: u32) -> vec3f {
    let half_vector = ggx_half(wo, wi, alpha, masking);
    let reflected = half_vector.w * fresnel_schlick(f0, f90, dot(wi, half_vector.xyz));
    return reflected + dielectric_base(wo, wi, alpha, f0, f90, base_color, masking);
}
