// Rectangles and spheres of even radiance, reflected by linearly transformed cosines. Shapes and directions are local to
// the frame of a lobe, relative to the point. The pass supplies area_entry(index), the table of cosines.rs.

const AREA_NODES: u32 = 32u;
const AREA_NUMBERS: u32 = 4u;
const AREA_STRIDE: u32 = AREA_NODES * AREA_NODES * AREA_NUMBERS;
// sqrt(alpha_min), where the axis of the width starts.
const AREA_ROUGHNESS_MIN: f32 = 0.03162278;
// Most by which a small light is raised over what the cosines give.
const AREA_RATIO_MAX: f32 = 4.0;

// Parts of a streak of very unequal widths, from where it is cut, and the width of a part over its share of the slopes.
const AREA_PARTS: u32 = 8u;
const AREA_BENDING: f32 = 1.2;
const AREA_STREAK: f32 = 0.6;
const AREA_PART_WIDTH: f32 = 0.8;

// A clamped cosine under a matrix, see the Rust twin.
struct AreaCosines {
    azimuth: vec2f,
    sin: f32,
    cos: f32,
    along: f32,
    across: f32,
    shear: f32,
    skew: f32,
}

fn area_node(first: u32, row: u32, column: u32) -> vec4f {
    let at = first + (row * AREA_NODES + column) * AREA_NUMBERS;
    return vec4f(area_entry(at), area_entry(at + 1u), area_entry(at + 2u), area_entry(at + 3u));
}

// Lengths along and across, shear and turn, over alpha: bilinear between nodes.
fn area_lookup(mu: f32, alpha: f32, masking: u32) -> vec4f {
    let x = clamp(sqrt(max(1.0 - mu, 0.0)), 0.0, 1.0) * f32(AREA_NODES - 1u);
    let root = sqrt(clamp(alpha, GGX_ALPHA_MIN, 1.0));
    let y = clamp((root - AREA_ROUGHNESS_MIN) / (1.0 - AREA_ROUGHNESS_MIN), 0.0, 1.0) * f32(AREA_NODES - 1u);
    let column = min(u32(x), AREA_NODES - 2u);
    let row = min(u32(y), AREA_NODES - 2u);
    let first = masking * AREA_STRIDE;
    let s = x - f32(column);
    let near = mix(area_node(first, row, column), area_node(first, row, column + 1u), s);
    let far = mix(area_node(first, row + 1u, column), area_node(first, row + 1u, column + 1u), s);
    return mix(near, far, y - f32(row));
}

// The lobe toward wo for widths along local x and y.
fn area_cosines(wo: vec3f, alpha: vec2f, masking: u32) -> AreaCosines {
    let a = ggx_clamp_alpha(alpha);
    let sin_theta = length(wo.xy);
    var azimuth = vec2f(1.0, 0.0);
    if sin_theta > 1e-18 {
        azimuth = wo.xy / sin_theta;
    }
    let mu = clamp(wo.z, 0.0, 1.0);
    let p = length(azimuth * a);
    let q = a.x * a.y / p;
    let mixed = azimuth.x * azimuth.y * (a.y * a.y - a.x * a.x) / p;
    let node = area_lookup(mu, p, masking);
    var unit_across = node.y;
    if a.x != a.y {
        unit_across = area_lookup(mu, q, masking).y;
    }
    let s = sin(node.w * p);
    let c = cos(node.w * p);
    return AreaCosines(
        azimuth, sin_theta * c + wo.z * s, wo.z * c - sin_theta * s,
        node.x * p, unit_across * q, node.z * p, unit_across * mixed,
    );
}

// M^-1 v.
fn area_flatten(lobe: AreaCosines, v: vec3f) -> vec3f {
    let plane = vec2f(dot(lobe.azimuth, v.xy), lobe.azimuth.x * v.y - lobe.azimuth.y * v.x);
    let z = v.z * lobe.cos - plane.x * lobe.sin;
    let x = (plane.x * lobe.cos + v.z * lobe.sin - lobe.shear * z) / lobe.along;
    return vec3f(x, (plane.y - lobe.skew * x) / lobe.across, z);
}

// M o.
fn area_shape(lobe: AreaCosines, o: vec3f) -> vec3f {
    let x = lobe.along * o.x + lobe.shear * o.z;
    let y = lobe.skew * o.x + lobe.across * o.y;
    let plane = x * lobe.cos - o.z * lobe.sin;
    let turned = lobe.azimuth * plane + vec2f(-lobe.azimuth.y, lobe.azimuth.x) * y;
    return vec3f(turned, x * lobe.sin + o.z * lobe.cos);
}

// Share of the lobe above the horizon.
fn area_above_horizon(lobe: AreaCosines) -> f32 {
    let up = vec2f(lobe.along * lobe.sin, lobe.shear * lobe.sin + lobe.cos);
    return 0.5 + 0.5 * up.y / max(length(up), 1e-20);
}

// Density per steradian in a unit direction.
fn area_density(lobe: AreaCosines, w: vec3f) -> f32 {
    let o = area_flatten(lobe, w);
    let length2 = dot(o, o);
    return max(o.z, 0.0) * INV_PI / (lobe.along * lobe.across * length2 * length2);
}

// Unit, above the horizon by a hair at least.
fn area_above(v: vec3f) -> vec3f {
    let length2 = dot(v, v);
    if !(length2 > 1e-37) {
        return vec3f(0.0, 0.0, 1.0);
    }
    let unit = v / sqrt(length2);
    return normalize(vec3f(unit.xy, max(unit.z, 1e-4)));
}

// Into how many parts the lobe for such widths is cut.
fn area_part_count(alpha: vec2f) -> u32 {
    let a = ggx_clamp_alpha(alpha);
    let wide = max(a.x, a.y);
    return select(1u, AREA_PARTS, min(a.x, a.y) < wide * min(AREA_BENDING * wide, AREA_STREAK));
}

// Some of the microfacets, about a normal of their own; weight 0 where the viewer sees none.
struct AreaPart {
    frame: Frame,
    lobe: AreaCosines,
    weight: f32,
}

fn area_part(index: u32, wo: vec3f, alpha: vec2f, masking: u32) -> AreaPart {
    let a = ggx_clamp_alpha(alpha);
    let up = vec3f(0.0, 0.0, 1.0);
    if area_part_count(a) == 1u {
        let frame = Frame(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), up);
        return AreaPart(frame, area_cosines(wo, a, masking), 1.0);
    }
    let wide = max(a.x, a.y);
    let along = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), a.x > a.y);
    let t = f32(2u * index + 1u) / f32(AREA_PARTS) - 1.0;
    let rest = sqrt((1.0 - t) * (1.0 + t));
    let x = wide * t / rest;
    let tilt2 = 1.0 + x * x;
    let normal = along * x + up;
    let n = normal / sqrt(tilt2);
    let tangent = (along - up * x) / sqrt(tilt2);
    let frame = Frame(tangent, cross(n, tangent), n);
    let step = 2.0 / f32(AREA_PARTS) * wide / (rest * rest * rest);
    let widths = vec2f(AREA_PART_WIDTH * step / tilt2, min(a.x, a.y) / (rest * sqrt(tilt2)));
    return AreaPart(frame, area_cosines(frame_to_local(frame, wo), widths, masking), max(dot(wo, normal), 0.0));
}

// Irradiance vector of a polygon on cosines, before M: what of it is above the horizon of the frame, and there above that of
// the cosines. Edge by edge, last those that close it along the horizons.
fn area_filled(lobe: AreaCosines, frame: Frame, polygon: ptr<function, AreaPolygon>) -> vec3f {
    let count = (*polygon).count;
    var sum = vec3f(0.0);
    if count == 0u {
        return sum;
    }
    var near: AreaClip;
    var flat: AreaClip;
    var start = frame_to_local(frame, (*polygon).corners[count - 1u]);
    for (var i = 0u; i < count + 2u; i++) {
        near.start = near.leaves;
        near.end = near.enters;
        if i < count {
            near.start = start;
            near.end = frame_to_local(frame, (*polygon).corners[i]);
            start = near.end;
            area_clip(&near);
        }
        flat.start = area_flatten(lobe, near.start);
        flat.end = area_flatten(lobe, near.end);
        if i <= count {
            area_clip(&flat);
        } else {
            flat.start = flat.leaves;
            flat.end = flat.enters;
        }
        sum += area_edge(flat.start, flat.end);
    }
    return sum;
}

// How much of a lobe a polygon fills, and from where: unit, the mean direction of the light that is reflected, about.
struct AreaFilling {
    share: f32,
    // Of the cosines, in that direction, before the albedo.
    density: f32,
    wi: vec3f,
}

fn area_filling(wo: vec3f, alpha: vec2f, masking: u32, polygon: ptr<function, AreaPolygon>) -> AreaFilling {
    let count = area_part_count(alpha);
    var filled = 0.0;
    var whole = 0.0;
    var toward = vec3f(0.0);
    var wi = vec3f(0.0, 0.0, 1.0);
    var density = 0.0;
    // All parts twice, the density in the direction that the first time finds; one loop, since some drivers write out
    // every call where it stands.
    for (var i = 0u; i < 2u * count; i++) {
        if i == count {
            wi = area_above(toward);
        }
        let part = area_part(select(i - count, i, i < count), wo, alpha, masking);
        if part.weight <= 0.0 {
            continue;
        }
        if i >= count {
            density += part.weight * area_density(part.lobe, frame_to_local(part.frame, wi));
            continue;
        }
        let flux = area_filled(part.lobe, part.frame, polygon);
        filled += part.weight * flux.z * INV_PI;
        whole += part.weight * area_above_horizon(part.lobe);
        let shaped = area_shape(part.lobe, flux);
        let length2 = dot(shaped, shaped);
        if length2 > 1e-37 {
            toward += frame_to_world(part.frame, shaped * inverseSqrt(length2)) * (part.weight * flux.z);
        }
    }
    let inside = max(whole, 1e-20);
    return AreaFilling(clamp(filled / inside, 0.0, 1.0), density / inside, wi);
}

// Radiance for F = 1 by a lobe of this albedo, whose cosine at the half vector and BRDF toward the light are `facet`: the
// share, and for small lights the ratio of the lobe to the cosines.
fn area_reflected(filled: AreaFilling, albedo: f32, facet: vec2f) -> f32 {
    let expected = max(albedo * filled.density, 1e-20);
    let ratio = clamp(facet.y * filled.wi.z / expected, 0.0, AREA_RATIO_MAX);
    let left = (1.0 - filled.share) * (1.0 - filled.share);
    return filled.share * albedo * (1.0 + left * (ratio - 1.0));
}

// Cosine at the half vector of two directions.
fn area_half_cosine(wo: vec3f, wi: vec3f) -> f32 {
    let h = wo + wi;
    let length2 = dot(h, h);
    return select(wo.z, clamp(dot(wo, h) * inverseSqrt(length2), 0.0, 1.0), length2 > 1e-24);
}

// Radiance toward the viewer under a shape of radiance 1, unshadowed. Without `reflections` only the matte base is lit.
fn area_response(
    s: Surface, wo: vec3f, base: AreaShape, coat_wo: vec3f, coat: AreaShape, reflections: bool,
) -> vec3f {
    var value = vec3f(0.0);
    // The base, then the coat; one loop, see area_filling.
    for (var layer = 0u; layer < select(1u, 2u, s.coat > 0.0); layer++) {
        let is_coat = layer == 1u;
        var shape = base;
        var viewer = wo;
        var widths = s.alpha;
        if is_coat {
            shape = coat;
            viewer = coat_wo;
            widths = vec2f(s.coat_alpha);
        }
        var polygon = area_polygon(shape);
        let flux = area_flux(&polygon);
        let wi = area_above(flux);
        if is_coat {
            value *= coat_transmission(coat_wo, s.coat_alpha, s.coat, s.masking)
                * coat_transmission(wi, s.coat_alpha, s.coat, s.masking);
        }
        if polygon.count < 3u {
            continue;
        }
        if !is_coat {
            var spread = vec3f(0.0);
            if reflections {
                spread = layered_spread(s, wo, wi);
            } else if s.metallic < 1.0 {
                spread = (1.0 - s.metallic) * layered_matte(s, wo, wi);
            }
            value = spread * max(flux.z, 0.0);
        }
        if !reflections {
            continue;
        }
        let filled = area_filling(viewer, widths, s.masking, &polygon);
        let cos_theta = area_half_cosine(viewer, filled.wi);
        if is_coat {
            let facet = ggx_microfacet(coat_wo, filled.wi, widths, s.masking);
            let over = area_reflected(filled, 1.0 - ggx_loss(coat_wo, widths, s.masking), facet);
            value += s.coat * over * fresnel_schlick(vec3f(COAT_F0), 1.0, cos_theta).x;
        } else {
            let facet = layered_facet(s, wo, filled.wi);
            let glossy = area_reflected(filled, layered_lobe_albedo(s, wo), facet);
            value += glossy * layered_reflectance(s, cos_theta);
        }
    }
    return value;
}
