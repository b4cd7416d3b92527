// GGX microfacets: local frame with z = n, alpha = (along x, along y). The pass supplies ggx_albedo_entry(index).

// Below this width the surface is a mirror; evaluation stays at it.
const GGX_ALPHA_MIN: f32 = 1e-3;
// Smith masking: heights of both directions correlated, or independent.
const GGX_CORRELATED: u32 = 0u;
const GGX_SEPARABLE: u32 = 1u;
// Nodes of the albedo tables over the cosine and over either width.
const GGX_ALBEDO_MU: u32 = 24u;
const GGX_ALBEDO_ALPHA: u32 = 16u;
// The flat array: per masking the root of the loss over (width across, width along, cosine), the mean loss divided by
// the mean alpha^2 over both widths, Schlick ratio and mean Schlick albedo likewise; the last named runs fastest.
const GGX_ALBEDO_LOSS_MEAN: u32 = GGX_ALBEDO_MU * GGX_ALBEDO_ALPHA * GGX_ALBEDO_ALPHA;
const GGX_ALBEDO_SCHLICK: u32 = GGX_ALBEDO_LOSS_MEAN + GGX_ALBEDO_ALPHA * GGX_ALBEDO_ALPHA;
const GGX_ALBEDO_SCHLICK_MEAN: u32 = GGX_ALBEDO_SCHLICK + GGX_ALBEDO_MU * GGX_ALBEDO_ALPHA * GGX_ALBEDO_ALPHA;
const GGX_ALBEDO_STRIDE: u32 = GGX_ALBEDO_SCHLICK_MEAN + GGX_ALBEDO_ALPHA * GGX_ALBEDO_ALPHA;
// alpha_min^(1/4), where the alpha axis of the tables starts.
const GGX_ALBEDO_ROOT_MIN: f32 = 0.17782794;
// How far the slopes across the view are narrowed for the loss, those along it for the Schlick ratio.
const GGX_ALBEDO_LOSS_NARROWING: f32 = 0.42;
const GGX_ALBEDO_SCHLICK_NARROWING: f32 = 0.2;

fn ggx_clamp_alpha(alpha: vec2f) -> vec2f {
    return clamp(alpha, vec2f(GGX_ALPHA_MIN), vec2f(1.0));
}

// Density of microfacet normals per steradian and projected area.
fn ggx_distribution(wm: vec3f, alpha: vec2f) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let a = ggx_clamp_alpha(alpha);
    let area = a.x * a.y;
    let v = vec3f(wm.x * a.y, wm.y * a.x, wm.z * area);
    let w = area / dot(v, v);
    return area * w * w * INV_PI;
}

// |(alpha_t x, alpha_b y, z)|: sqrt(1 + alpha^2 tan^2) times the cosine, finite at grazing.
fn ggx_stretched(w: vec3f, alpha: vec2f) -> f32 {
    return length(vec3f(ggx_clamp_alpha(alpha) * w.xy, w.z));
}

// Smith's Lambda: hidden over visible area.
fn ggx_lambda(w: vec3f, alpha: vec2f) -> f32 {
    let z = max(abs(w.z), 1e-7);
    return 0.5 * (ggx_stretched(w, alpha) - abs(w.z)) / z;
}

// Visible fraction seen from w, 1 / (1 + Lambda).
fn ggx_masking(w: vec3f, alpha: vec2f) -> f32 {
    if w.z <= 0.0 {
        return 0.0;
    }
    return 2.0 * w.z / (w.z + ggx_stretched(w, alpha));
}

// Fraction visible from both sides, divided by 4 cos_o cos_i.
fn ggx_visibility(wo: vec3f, wi: vec3f, alpha: vec2f, masking: u32) -> f32 {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return 0.0;
    }
    let so = ggx_stretched(wo, alpha);
    let si = ggx_stretched(wi, alpha);
    let correlated = 2.0 * (wi.z * so + wo.z * si);
    let separable = (wo.z + so) * (wi.z + si);
    // The floor acts only where a cosine is below 1e-9.
    return 1.0 / max(select(correlated, separable, masking == GGX_SEPARABLE), 1e-12);
}

// Fraction visible from both sides.
fn ggx_shadowing_masking(wo: vec3f, wi: vec3f, alpha: vec2f, masking: u32) -> f32 {
    return 4.0 * max(wo.z, 0.0) * max(wi.z, 0.0) * ggx_visibility(wo, wi, alpha, masking);
}

// x: cosine at the microfacet that reflects wi to wo. y: D G / (4 cos_o cos_i), 0 where either is below the horizon.
fn ggx_microfacet(wo: vec3f, wi: vec3f, alpha: vec2f, masking: u32) -> vec2f {
    let h = wo + wi;
    let length2 = dot(h, h);
    if wo.z <= 0.0 || wi.z <= 0.0 || length2 < 1e-24 {
        return vec2f(0.0);
    }
    // The cosine is half the length of the sum of two unit vectors.
    let length = sqrt(length2);
    return vec2f(0.5 * length, ggx_distribution(h / length, alpha) * ggx_visibility(wo, wi, alpha, masking));
}

// Single-scattering BRDF, without the cosine.
fn ggx_eval(wo: vec3f, wi: vec3f, alpha: vec2f, fresnel: Fresnel, masking: u32) -> vec3f {
    let facet = ggx_microfacet(wo, wi, alpha, masking);
    if facet.y == 0.0 {
        return vec3f(0.0);
    }
    return facet.y * fresnel_eval(fresnel, facet.x);
}

// Microfacet normal visible from wo (spherical caps, Dupuy and Benyoub 2023).
fn ggx_sample_wm(wo: vec3f, alpha: vec2f, u: vec2f) -> vec3f {
    let a = ggx_clamp_alpha(alpha);
    let stretched = normalize(vec3f(a * wo.xy, wo.z));
    // The cap reaches from z = 1 down to -stretched.z. `below` is 1 - z, and h.z = z + stretched.z: no digit is lost.
    let below = u.y * (1.0 + stretched.z);
    let sin_theta = sqrt(clamp(below * (2.0 - below), 0.0, 1.0));
    let phi = 2.0 * PI * u.x;
    let h = vec3f(sin_theta * vec2f(cos(phi), sin(phi)) + stretched.xy, (1.0 - u.y) * (1.0 + stretched.z));
    return normalize(vec3f(a * h.xy, max(h.z, 1e-20)));
}

// Density of ggx_sample_wm per steradian of wm.
fn ggx_pdf_wm(wo: vec3f, wm: vec3f, alpha: vec2f) -> f32 {
    let toward = dot(wo, wm);
    if wo.z <= 0.0 || toward <= 0.0 {
        return 0.0;
    }
    return ggx_distribution(wm, alpha) * 2.0 * toward / (wo.z + ggx_stretched(wo, alpha));
}

// Density per steradian of wi when wo is reflected at ggx_sample_wm.
fn ggx_pdf(wo: vec3f, wi: vec3f, alpha: vec2f) -> f32 {
    let h = wo + wi;
    let length2 = dot(h, h);
    if wo.z <= 0.0 || wi.z <= 0.0 || length2 < 1e-24 {
        return 0.0;
    }
    return 0.5 * ggx_distribution(h / sqrt(length2), alpha) / (wo.z + ggx_stretched(wo, alpha));
}

// A place between two nodes of an axis: index and fraction; x in [0, 1] over `count` nodes.
struct GgxAxis {
    index: u32,
    fraction: f32,
}

fn ggx_albedo_axis(x: f32, count: u32) -> GgxAxis {
    let scaled = clamp(x, 0.0, 1.0) * f32(count - 1u);
    let index = min(u32(scaled), count - 2u);
    return GgxAxis(index, scaled - f32(index));
}

// A width on its axis.
fn ggx_albedo_axis_alpha(alpha: f32) -> GgxAxis {
    let root = sqrt(sqrt(clamp(alpha, GGX_ALPHA_MIN, 1.0)));
    return ggx_albedo_axis((root - GGX_ALBEDO_ROOT_MIN) / (1.0 - GGX_ALBEDO_ROOT_MIN), GGX_ALBEDO_ALPHA);
}

// Linear interpolation of the entries from `first`.
fn ggx_albedo_line(first: u32, x: GgxAxis) -> f32 {
    return mix(ggx_albedo_entry(first + x.index), ggx_albedo_entry(first + x.index + 1u), x.fraction);
}

// Bilinear interpolation of rows of `width` entries.
fn ggx_albedo_plane(first: u32, x: GgxAxis, y: GgxAxis, width: u32) -> f32 {
    let row = first + y.index * width;
    return mix(ggx_albedo_line(row, x), ggx_albedo_line(row + width, x), y.fraction);
}

// Trilinear interpolation of the table over both widths and the cosine that starts at `first`.
fn ggx_albedo_volume(first: u32, x: f32, along: f32, across: f32) -> f32 {
    let column = ggx_albedo_axis(x, GGX_ALBEDO_MU);
    let y = ggx_albedo_axis_alpha(along);
    let z = ggx_albedo_axis_alpha(across);
    let slab = first + z.index * GGX_ALBEDO_MU * GGX_ALBEDO_ALPHA;
    let next = slab + GGX_ALBEDO_MU * GGX_ALBEDO_ALPHA;
    let near = ggx_albedo_plane(slab, column, y, GGX_ALBEDO_MU);
    return mix(near, ggx_albedo_plane(next, column, y, GGX_ALBEDO_MU), z.fraction);
}

// Table over both widths that starts at `first`.
fn ggx_albedo_over_widths(first: u32, alpha: vec2f) -> f32 {
    return ggx_albedo_plane(first, ggx_albedo_axis_alpha(alpha.x), ggx_albedo_axis_alpha(alpha.y), GGX_ALBEDO_ALPHA);
}

// Loss at cosine mu for the widths in the plane of the view and across it.
fn ggx_loss_in_plane(mu: f32, along: f32, across: f32, masking: u32) -> f32 {
    let m = clamp(mu, 0.0, 1.0);
    // At small widths the loss is a function of mu / a: this axis follows it.
    let a = sqrt(0.5 * (along * along + across * across));
    let x = sqrt(m * (1.0 + a) / (m + a));
    let root = ggx_albedo_volume(masking * GGX_ALBEDO_STRIDE, x, along, across);
    return root * root;
}

// Widths along the plane of w and across it, for which the table is looked up.
fn ggx_toward(w: vec3f, alpha: vec2f, narrowing: vec2f) -> vec2f {
    let a = ggx_clamp_alpha(alpha);
    let a2 = a * a;
    let cos2 = 1.0 - w.x * w.x - w.y * w.y;
    let cos4 = cos2 * cos2;
    // The azimuth turns to the wider axis toward the normal, where it is undefined.
    let turned = w.x * w.x * (1.0 + cos2) * (1.0 + cos4);
    let c = clamp(turned + select(0.0, cos4 * cos4, a.x > a.y), 0.0, 1.0);
    let wide = vec2f(a2.y + (a2.x - a2.y) * c, a2.x + (a2.y - a2.x) * c);
    let narrow = a2.x * a2.y / wide.yx;
    return sqrt(mix(wide, narrow, narrowing));
}

// Energy that single scattering loses toward w when F = 1.
fn ggx_loss(w: vec3f, alpha: vec2f, masking: u32) -> f32 {
    let widths = ggx_toward(w, alpha, vec2f(0.0, GGX_ALBEDO_LOSS_NARROWING));
    return ggx_loss_in_plane(w.z, widths.x, widths.y, masking);
}

// Cosine-weighted mean of ggx_loss over the hemisphere.
fn ggx_loss_mean(alpha: vec2f, masking: u32) -> f32 {
    let a = ggx_clamp_alpha(alpha);
    let first = masking * GGX_ALBEDO_STRIDE + GGX_ALBEDO_LOSS_MEAN;
    return 0.5 * dot(a, a) * ggx_albedo_over_widths(first, a);
}

// Directional albedo of single scattering when F = 1, at cosine mu for the isotropic width alpha.
fn ggx_albedo(mu: f32, alpha: f32, masking: u32) -> f32 {
    let a = clamp(alpha, GGX_ALPHA_MIN, 1.0);
    return 1.0 - ggx_loss_in_plane(mu, a, a, masking);
}

// Its cosine-weighted mean.
fn ggx_albedo_mean(alpha: f32, masking: u32) -> f32 {
    return 1.0 - ggx_loss_mean(vec2f(alpha), masking);
}

// Mean of (1 - x)^5 over the light that is reflected toward w, x = cosine at the microfacet: with f0 and f90 the
// directional albedo is E mix(f0, f90, this).
fn ggx_schlick_ratio(w: vec3f, alpha: vec2f, masking: u32) -> f32 {
    let widths = ggx_toward(w, alpha, vec2f(GGX_ALBEDO_SCHLICK_NARROWING, 0.0));
    let first = masking * GGX_ALBEDO_STRIDE + GGX_ALBEDO_SCHLICK;
    return ggx_albedo_volume(first, sqrt(clamp(w.z, 0.0, 1.0)), widths.x, widths.y);
}

// Cosine-weighted mean over the hemisphere of E times ggx_schlick_ratio.
fn ggx_schlick_mean(alpha: vec2f, masking: u32) -> f32 {
    return ggx_albedo_over_widths(masking * GGX_ALBEDO_STRIDE + GGX_ALBEDO_SCHLICK_MEAN, alpha);
}

// What all bounces after the first keep of white light. A surface under even light returns this times its loss.
fn ggx_bounces(fresnel_mean: vec3f, loss_mean: f32) -> vec3f {
    let f = clamp(fresnel_mean, vec3f(0.0), vec3f(1.0));
    return f * f * (1.0 - loss_mean) / (1.0 - f * loss_mean);
}

// Light that leaves after more than one bounce: BRDF without the cosine, reciprocal.
fn ggx_multiple(wo: vec3f, wi: vec3f, alpha: vec2f, fresnel_mean: vec3f, masking: u32) -> vec3f {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return vec3f(0.0);
    }
    let mean = ggx_loss_mean(alpha, masking);
    let lost = ggx_loss(wo, alpha, masking) * ggx_loss(wi, alpha, masking);
    return ggx_bounces(fresnel_mean, mean) * (lost * INV_PI / mean);
}
