// Environment light from infinitely far away. The pass supplies
//   classical_radiance(direction, level)     cube of radiance, box-filtered mips
//   classical_dimmed(direction, level)       the same without the brightest texels, which are sources
//   classical_prefiltered(direction, level)  cube of GGX-filtered radiance, one width a level
//   classical_irradiance(direction)          integral of radiance times cosine
//   classical_source(index)                  a small bright source: direction; radiance times solid angle
// and ggx_albedo_entry, through which the tables of mean reflectance are read as well.

// How the reflection is computed.
struct ClassicalLobes {
    // 0 for the split sum, else visible normals drawn per pixel.
    samples: u32,
    // Number of bright sources.
    sources: u32,
    // Offset of the sample points, see sampling_spiral.
    rotation: vec2f,
    // Levels of the radiance and of the prefiltered cube.
    radiance_levels: f32,
    prefiltered_levels: f32,
    // Width from which a bright block is a point to a lobe.
    wide: f32,
}

// Level of the prefiltered cube for a roughness: fine steps where the lobe changes fast.
fn classical_level(roughness: f32, levels: f32) -> f32 {
    let r = clamp(roughness, 0.0, 1.0);
    return (levels - 1.0) * r * (2.0 - r);
}

// Its inverse: roughness that level `level` of `levels` is filtered for.
fn classical_roughness(level: f32, levels: f32) -> f32 {
    return 1.0 - sqrt(clamp(1.0 - level / max(levels - 1.0, 1.0), 0.0, 1.0));
}

// Solid angle of a texel of a cube with 2^(levels - 1) texels along an edge.
fn classical_texel(direction: vec3f, levels: f32) -> f32 {
    let m = max(abs(direction.x), max(abs(direction.y), abs(direction.z)));
    return 4.0 * m * m * m * exp2(-2.0 * (levels - 1.0));
}

// Level whose texels are as large as the share of one of n samples of that density, `blur` levels coarser.
fn classical_footprint(direction: vec3f, pdf: f32, n: u32, levels: f32, blur: f32) -> f32 {
    let ratio = 1.0 / (f32(n) * max(pdf, 1e-12) * classical_texel(direction, levels));
    return clamp(0.5 * log2(max(ratio, 1e-12)) + blur, 0.0, levels - 1.0);
}

// Neighbouring footprints overlap by this many levels, so that a lamp between two samples is not lost.
const CLASSICAL_OVERLAP: f32 = 1.0;

// Weight of a direction in the lobe of N = V = R, D(h) cos(theta_i), up to the factor that the sampler's mean cosine
// brings in: n samples of density D / 4 weigh sum(cos_i), a source of solid angle w weighs n w D cos_i / 4.
fn classical_source_weight(normal: vec3f, alpha: f32, direction: vec3f) -> f32 {
    let cos_i = dot(normal, direction);
    let h = direction - normal;
    // sin^2 and cos^2 of the half vector's angle.
    let d = 0.25 * dot(h, h) + alpha * alpha * 0.5 * (1.0 + cos_i);
    return max(cos_i, 0.0) * 0.25 * INV_PI * alpha * alpha / (d * d);
}

// Radiance filtered with the GGX lobe of N = V = R: weight D(h) cos(theta_i). `sources` small bright sources are left
// out of the map and added exactly: classical_source(i) is direction and, in the second row, radiance times solid angle.
fn classical_prefilter(normal: vec3f, alpha: f32, n: u32, levels: f32, sources: u32) -> vec3f {
    let frame = frame_new(normal);
    let a2 = alpha * alpha;
    var sum = vec3f(0.0);
    var weight = 0.0;
    for (var i = 0u; i < n; i++) {
        let u = sampling_spiral(i, n, vec2f(0.0, 0.5));
        // Half vectors with density D cos: tan^2 = alpha^2 v / (1 - v). The sine from v too: 1 - cos^2 would cancel.
        let sum2 = (1.0 - u.y) + a2 * u.y;
        let cos2 = (1.0 - u.y) / sum2;
        let sin2 = a2 * u.y / sum2;
        let cos_i = cos2 - sin2;
        if cos_i <= 0.0 {
            continue;
        }
        let h = vec3f(sqrt(sin2), 0.0, sqrt(cos2));
        let sin_i = 2.0 * h.x * h.z;
        let phi = 2.0 * PI * u.x;
        let wi = frame_to_world(frame, vec3f(sin_i * cos(phi), sin_i * sin(phi), cos_i));
        let pdf = 0.25 * ggx_distribution(h, vec2f(alpha));
        let level = classical_footprint(wi, pdf, n, levels, CLASSICAL_OVERLAP);
        sum += cos_i * classical_radiance(wi, level);
        weight += cos_i;
    }
    for (var i = 0u; i < sources; i++) {
        let source = classical_source(i);
        sum += f32(n) * classical_source_weight(normal, alpha, source[0]) * source[1];
    }
    return sum / max(weight, 1e-12);
}

// Isotropic width that stands for both where the direction of the grooves matters little.
fn classical_width(alpha: vec2f) -> f32 {
    return sqrt(0.5 * dot(alpha, alpha));
}

// Directional albedo of the lobe for the surface's metal; table 0 stands for a curve f0 + (1 - f0)(1 - x)^5.
fn classical_metal_albedo(s: Surface, table: u32, wo: vec3f) -> vec3f {
    let e = layered_lobe_albedo(s, wo);
    if table == 0u {
        return e * mix(s.fresnel.f0, vec3f(1.0), ggx_schlick_ratio(wo, s.alpha, s.masking));
    }
    let x = ggx_albedo_axis(sqrt(clamp(wo.z, 0.0, 1.0)), GGX_ALBEDO_MU);
    let y = ggx_albedo_axis_alpha(classical_width(s.alpha));
    let size = GGX_ALBEDO_MU * GGX_ALBEDO_ALPHA;
    let mean = vec3f(
        ggx_albedo_plane(table, x, y, GGX_ALBEDO_MU),
        ggx_albedo_plane(table + size, x, y, GGX_ALBEDO_MU),
        ggx_albedo_plane(table + 2u * size, x, y, GGX_ALBEDO_MU),
    );
    return e * mean;
}

// Normal bent toward the viewer in the plane in which an anisotropic lobe is wide, which stretches the one lookup of the
// split sum; across the narrow axis the reflection stays that of a mirror.
fn classical_bent_normal(base: Frame, wo_world: vec3f, alpha: vec2f) -> vec3f {
    let along = alpha.x >= alpha.y;
    let axis = select(base.t, base.b, along);
    let wide = max(alpha.x, alpha.y);
    let narrow = min(alpha.x, alpha.y);
    let side = cross(axis, wo_world);
    let toward = cross(side, axis);
    let length2 = dot(toward, toward);
    if length2 < 1e-8 || wide <= narrow {
        return base.n;
    }
    let amount = (1.0 - narrow / wide) * min(1.0, 4.0 * wide);
    return normalize(mix(base.n, toward * inverseSqrt(length2), 0.5 * amount));
}

// Reflection by one lookup: prefiltered radiance times albedo, the split sum.
fn classical_split_sum(s: Surface, table: u32, base: Frame, wo: vec3f, levels: f32) -> vec3f {
    let wo_world = frame_to_world(base, wo);
    let n = classical_bent_normal(base, wo_world, s.alpha);
    // Wide lobes lean toward the normal, where the cosine is larger. The weight was chosen by the error table.
    let lean = s.alpha.x * s.alpha.y;
    let direction = normalize(mix(reflect(-wo_world, n), n, lean));
    let roughness = sqrt(sqrt(s.alpha.x * s.alpha.y));
    var albedo = vec3f(0.0);
    if s.metallic > 0.0 {
        albedo += s.metallic * classical_metal_albedo(s, table, wo);
    }
    if s.metallic < 1.0 {
        let e = layered_lobe_albedo(s, wo);
        let ratio = ggx_schlick_ratio(wo, s.alpha, s.masking);
        albedo += (1.0 - s.metallic) * e * mix(s.dielectric_f0, vec3f(s.dielectric_f90), ratio);
    }
    return albedo * classical_prefiltered(direction, classical_level(roughness, levels));
}

// A direction drawn from the lobe; there is none where wi is not above the horizon.
struct ClassicalDrawn {
    wi: vec3f,
    // At the half vector.
    cos_theta: f32,
    pdf: f32,
    // BRDF for F = 1 times cosine over density.
    weight: f32,
}

fn classical_drawn(s: Surface, wo: vec3f, u: vec2f) -> ClassicalDrawn {
    if s.lobe == LAYERED_GGX {
        let wm = ggx_sample_wm(wo, s.alpha, u);
        let wi = reflect(-wo, wm);
        // What is left of the quotient, in which distribution and cosines cancel.
        let weight = ggx_shadowing_masking(wo, wi, s.alpha, s.masking) / max(ggx_masking(wo, s.alpha), 1e-12);
        return ClassicalDrawn(wi, dot(wi, wm), ggx_pdf(wo, wi, s.alpha), weight);
    }
    let wi = blinn_phong_sample_wi(wo, s.exponent, s.lobe, u);
    let facet = blinn_phong_facet(wo, wi, s.exponent, s.lobe);
    let pdf = blinn_phong_pdf(wo, wi, s.exponent, s.lobe);
    return ClassicalDrawn(wi, facet.x, pdf, facet.y * wi.z / max(pdf, 1e-12));
}

// Reflection by filtered importance sampling of the lobe. A wide lobe's samples would meet a lamp of a few texels or miss
// it: there the brightest texels are left out of the map and reflected one by one.
fn classical_sampled(s: Surface, base: Frame, wo: vec3f, lobes: ClassicalLobes) -> vec3f {
    let wide = min(s.alpha.x, s.alpha.y) >= lobes.wide;
    var sum = vec3f(0.0);
    for (var i = 0u; i < lobes.samples; i++) {
        let u = sampling_spiral(i, lobes.samples, lobes.rotation);
        let drawn = classical_drawn(s, wo, u);
        if drawn.wi.z <= 0.0 {
            continue;
        }
        let direction = frame_to_world(base, drawn.wi);
        let level = classical_footprint(direction, drawn.pdf, lobes.samples, lobes.radiance_levels, 0.0);
        var radiance: vec3f;
        if wide {
            radiance = classical_dimmed(direction, level);
        } else {
            radiance = classical_radiance(direction, level);
        }
        sum += drawn.weight * layered_reflectance(s, drawn.cos_theta) * radiance;
    }
    sum /= f32(lobes.samples);
    for (var i = 0u; wide && i < lobes.sources; i++) {
        let source = classical_source(i);
        let wi = frame_to_local(base, source[0]);
        if wi.z > 0.0 {
            let facet = layered_facet(s, wo, wi);
            sum += facet.y * wi.z * layered_reflectance(s, facet.x) * source[1];
        }
    }
    return sum;
}

// Light of the environment that the surface sends toward the viewer. `to_viewer` is a unit vector in world space.
fn classical_environment(
    s: Surface, table: u32, base: Frame, coat: Frame, to_viewer: vec3f, occlusion: f32,
    lobes: ClassicalLobes,
) -> vec3f {
    let wo = classical_facing(frame_to_local(base, to_viewer));
    let width = classical_width(s.alpha);
    let irradiance = occlusion * classical_irradiance(base.n) * INV_PI;

    var reflected: vec3f;
    if lobes.samples == 0u {
        reflected = classical_split_sum(s, table, base, wo, lobes.prefiltered_levels);
    } else {
        reflected = classical_sampled(s, base, wo, lobes);
    }
    var value = classical_occlusion(wo.z, width, occlusion) * reflected;
    if s.metallic > 0.0 && layered_scatters_again(s) {
        value += s.metallic * classical_multiple_albedo(s, wo) * irradiance;
    }
    if s.metallic < 1.0 {
        value += (1.0 - s.metallic) * layered_matte_albedo(s, wo) * irradiance;
    }
    if s.coat <= 0.0 {
        return value;
    }

    var top: Surface;
    top.alpha = vec2f(s.coat_alpha);
    top.lobe = LAYERED_GGX;
    top.dielectric_f0 = vec3f(COAT_F0);
    top.dielectric_f90 = 1.0;
    top.masking = s.masking;
    let coat_wo = classical_facing(frame_to_local(coat, to_viewer));
    var coat_light: vec3f;
    if lobes.samples == 0u {
        coat_light = classical_split_sum(top, 0u, coat, coat_wo, lobes.prefiltered_levels);
    } else {
        coat_light = classical_sampled(top, coat, coat_wo, lobes);
    }
    // Once on the way out; the way in is averaged over where the light comes from, close to the same for metals.
    let passed = coat_transmission(coat_wo, s.coat_alpha, s.coat, s.masking);
    return value * passed * passed + s.coat * classical_occlusion(coat_wo.z, s.coat_alpha, occlusion) * coat_light;
}

// A shading normal may look away from the viewer: bring the direction back above the horizon.
fn classical_facing(wo: vec3f) -> vec3f {
    return normalize(vec3f(wo.xy, max(wo.z, 1e-3)));
}

// Albedo of light that bounced more than once between microfacets.
fn classical_multiple_albedo(s: Surface, wo: vec3f) -> vec3f {
    return ggx_bounces(s.fresnel_mean, ggx_loss_mean(s.alpha, s.masking)) * ggx_loss(wo, s.alpha, s.masking);
}

// Share of a reflection that an ambient occlusion leaves: none is lost by a mirror, all of it by a matte surface.
// Lagarde and de Rousiers 2014, section 4.10.2.
fn classical_occlusion(mu: f32, alpha: f32, occlusion: f32) -> f32 {
    return clamp(pow(mu + occlusion, exp2(-16.0 * alpha - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
}
