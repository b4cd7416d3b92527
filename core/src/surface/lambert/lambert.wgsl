// A perfectly matte surface.

// BRDF, without the cosine.
fn lambert_eval(albedo: vec3f) -> vec3f {
    return albedo * INV_PI;
}
