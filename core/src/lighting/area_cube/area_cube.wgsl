// Localised glossy and diffuse lighting: texels of a coarse cube with distances as lights with an area. Positions are relative
// to the middle of the cube. The pass supplies area_cube_entry(index), the numbers of tables.rs, and area_cube_texel(index), the
// numbers of a texel as three vectors (place and spread, normal and cosine, radiance), by faces, rows, columns.

const AREA_CUBE_HEIGHTS: u32 = 33u;
const AREA_CUBE_SHARES: u32 = 9u;
const AREA_CUBE_WIDTHS: u32 = 16u;
const AREA_CUBE_CAPS: u32 = 17u;
const AREA_CUBE_OFFSETS: u32 = 25u;
const AREA_CUBE_NORMALS: u32 = AREA_CUBE_HEIGHTS * AREA_CUBE_SHARES;
const AREA_CUBE_STRIDE: u32 = AREA_CUBE_WIDTHS * AREA_CUBE_CAPS * AREA_CUBE_OFFSETS;
const AREA_CUBE_CHORD_MAX: f32 = 1.4142135;
const AREA_CUBE_NEIGHBOURS: u32 = 4u;
// Squared distances from which a direction can still be told.
const AREA_CUBE_NEAR: f32 = 1e-30;
const AREA_CUBE_WIDEST: f32 = 1e30;
// Weights below this are roundings: a lobe that none of the caps meets is dark.
const AREA_CUBE_LEAST: f32 = 1e-30;
// The least cosine toward the light of a cap that the horizon cuts.
const AREA_CUBE_HORIZON: f32 = 1e-4;

// A texel as a light, see the Rust twin: its middle or, of the sky, direction; sin^2 of its half angle times its squared
// distance, 0 of the sky; normal over the cosine toward the middle; cosine of its half angle; mean radiance.
struct AreaCubeTexel {
    place: vec3f,
    spread: f32,
    normal: vec3f,
    cosine: f32,
    radiance: vec3f,
}

// A texel as a point sees it; its solid angle over that of a hemisphere.
struct AreaCubeCap {
    direction: vec3f,
    share: f32,
}

struct AreaCubeAsked {
    // Texels along an edge of a face.
    edge: u32,
    few: bool,
    corrected: bool,
    normalized: bool,
    // Lobes are taken at the middles of caps.
    middles: bool,
}

// Where the surface is, and the unit directions in which the middle sees what the mirrored directions of base and coat meet.
struct AreaCubeLooked {
    x: vec3f,
    base: vec3f,
    coat: vec3f,
}

// Sums over caps: radiance toward the viewer for F = 1, the same of even light, and the light times (1 - cos)^5.
struct AreaCubeGathered {
    light: vec3f,
    weight: f32,
    schlick: f32,
}

fn area_cube_of(numbers: mat3x4f) -> AreaCubeTexel {
    return AreaCubeTexel(numbers[0].xyz, numbers[0].w, numbers[1].xyz, numbers[1].w, numbers[2].xyz);
}

fn area_cube_filled(cosine: f32, spread: f32) -> f32 {
    let t = min(spread, AREA_CUBE_WIDEST);
    let d = sqrt(cosine * cosine + t);
    return min(t / max(d * (d + cosine), 1e-30), 1.0);
}

// Steradians from `to` metres away of what fills `solid_angle` from `from` metres away.
fn area_cube_localised_solid_angle(solid_angle: f32, from_distance: f32, to_distance: f32) -> f32 {
    let w = clamp(solid_angle * (0.5 * INV_PI), 0.0, 1.0);
    if !(w > 0.0 && from_distance > 0.0) {
        return 0.0;
    }
    let ratio = min(from_distance / max(to_distance, 1e-37), 1e15);
    return 2.0 * PI * area_cube_filled(1.0 - w, w * (2.0 - w) * ratio * ratio);
}

fn area_cube_localised(texel: AreaCubeTexel, x: vec3f, corrected: bool) -> AreaCubeCap {
    if texel.spread <= 0.0 {
        return AreaCubeCap(texel.place, 1.0 - texel.cosine);
    }
    let v = texel.place - x;
    let length2 = dot(v, v);
    if length2 <= AREA_CUBE_NEAR {
        return AreaCubeCap(normalize(-texel.normal), 1.0);
    }
    let inverse = inverseSqrt(length2);
    let direction = v * inverse;
    let turned = select(1.0, max(-dot(texel.normal, direction), 0.0), corrected);
    return AreaCubeCap(direction, area_cube_filled(texel.cosine, texel.spread * turned * inverse * inverse));
}

// Node below and fraction for a place in [0, 1].
struct AreaCubeAxis {
    index: u32,
    t: f32,
}

fn area_cube_axis(x: f32, count: u32) -> AreaCubeAxis {
    let scaled = clamp(x, 0.0, 1.0) * f32(count - 1u);
    let index = min(u32(scaled), count - 2u);
    return AreaCubeAxis(index, scaled - f32(index));
}

fn area_cube_line(first: u32, t: f32) -> f32 {
    return mix(area_cube_entry(first), area_cube_entry(first + 1u), t);
}

// Irradiance over pi of a cap of radiance 1.
fn area_cube_lambert(share: f32, n_dot_l: f32) -> f32 {
    let sin2 = share * (2.0 - share);
    let sin_cap = sqrt(max(sin2, 0.0));
    if n_dot_l >= sin_cap {
        return sin2 * n_dot_l;
    }
    if n_dot_l <= -sin_cap {
        return 0.0;
    }
    let height = area_cube_axis(0.5 + 0.5 * n_dot_l / sin_cap, AREA_CUBE_HEIGHTS);
    let row = area_cube_axis(share, AREA_CUBE_SHARES);
    let first = row.index * AREA_CUBE_HEIGHTS + height.index;
    let near = area_cube_line(first, height.t);
    return sin2 * sin_cap * mix(near, area_cube_line(first + AREA_CUBE_HEIGHTS, height.t), row.t);
}

fn area_cube_packed(chord: f32, alpha: f32) -> f32 {
    return chord / (chord + alpha) * (1.0 + alpha / AREA_CUBE_CHORD_MAX);
}

// Mean of a distribution of normals, 0 GGX or 1 Blinn-Phong, over a cap of half vectors, over its peak.
fn area_cube_normals(kind: u32, alpha: f32, offset: f32, cap: f32) -> f32 {
    let a = clamp(alpha, GGX_ALPHA_MIN, 1.0);
    let x = area_cube_axis(area_cube_packed(offset, a), AREA_CUBE_OFFSETS);
    let y = area_cube_axis(area_cube_packed(cap, a), AREA_CUBE_CAPS);
    let root_alpha = sqrt(sqrt(a));
    let z = area_cube_axis((root_alpha - GGX_ALBEDO_ROOT_MIN) / (1.0 - GGX_ALBEDO_ROOT_MIN), AREA_CUBE_WIDTHS);
    let first = AREA_CUBE_NORMALS + kind * AREA_CUBE_STRIDE
        + (z.index * AREA_CUBE_CAPS + y.index) * AREA_CUBE_OFFSETS + x.index;
    let next = first + AREA_CUBE_CAPS * AREA_CUBE_OFFSETS;
    let near = mix(area_cube_line(first, x.t), area_cube_line(first + AREA_CUBE_OFFSETS, x.t), y.t);
    let far = mix(area_cube_line(next, x.t), area_cube_line(next + AREA_CUBE_OFFSETS, x.t), y.t);
    let root = mix(near, far, z.t);
    return root * root * (root * root);
}

// What a lobe sends toward wo of a cap of radiance 1 for F = 1, and (1 - cos)^5 at the half vector. `direction` is local.
fn area_cube_glossy(
    lobe: u32, exponent: f32, alpha: f32, masking: u32, wo: vec3f, direction: vec3f, share: f32, lit: f32,
    middle: bool,
) -> vec2f {
    if !(lit > 0.0 && share > 0.0) {
        return vec2f(0.0);
    }
    let sin_cap = sqrt(share * (2.0 - share));
    let seen = 0.5 + 0.5 * clamp(direction.z / sin_cap, -1.0, 1.0);
    let lifted = clamp(0.5 * lit / (share * (1.0 - 0.5 * share) * max(seen, 1e-6)), AREA_CUBE_HORIZON, 1.0);
    let z = select(lifted, direction.z, direction.z >= sin_cap);
    let plane2 = dot(direction.xy, direction.xy);
    var around = vec2f(1.0, 0.0);
    if plane2 > 1e-37 {
        around = direction.xy * inverseSqrt(plane2);
    }
    let wi = vec3f(around * sqrt(max(1.0 - z * z, 0.0)), z);

    let h = wo + wi;
    let h_length = length(h);
    let cos_theta = min(0.5 * h_length, 1.0);
    let offset = length(h.xy) / h_length * sqrt(2.0 / (1.0 + h.z / h_length));
    let chord = select(min(sqrt(0.5 * share / max(cos_theta, 1e-6)), AREA_CUBE_CHORD_MAX), 0.0, middle);
    var value: f32;
    if lobe == LAYERED_GGX {
        let a = ggx_clamp_alpha(vec2f(alpha));
        let mean = area_cube_normals(0u, a.x, offset, chord);
        value = mean / (a.x * a.x) * ggx_visibility(wo, wi, a, masking) * lit;
    } else {
        let mean = area_cube_normals(1u, blinn_phong_alpha(exponent), offset, chord);
        value = blinn_phong_normalizer(exponent, lobe) * mean * PI;
        if lobe == BLINN_PHONG_UNNORMALIZED {
            value *= 2.0 * share * seen;
        } else if lobe == BLINN_PHONG_MICROFACET {
            value *= 0.25 * lit / max(cos_theta * cos_theta, 1e-6);
        } else {
            value *= lit;
        }
    }
    let rest = 1.0 - cos_theta;
    return vec2f(value, rest * rest * (rest * rest) * rest);
}

// Number of the texel at a point of a face, as cube_face_point gives it.
fn area_cube_number(place: vec3f, edge: u32) -> u32 {
    let at = vec2u(clamp((0.5 * place.yz + 0.5) * f32(edge), vec2f(0.0), vec2f(f32(edge - 1u))));
    return (u32(place.x) * edge + at.y) * edge + at.x;
}

// Number of the texel in a direction of the world.
fn area_cube_texel_at(direction: vec3f, edge: u32) -> u32 {
    return area_cube_number(cube_face_point(vec3f(direction.xy, -direction.z)), edge);
}

// Number of the texel beyond the right, left, lower or upper edge of a texel.
fn area_cube_neighbour(index: u32, side: u32, edge: u32) -> u32 {
    let at = vec2f(f32(index % edge), f32(index / edge % edge)) + 0.5;
    let sign = select(1.0, -1.0, side % 2u == 1u);
    let to = select(vec2f(0.0, sign), vec2f(sign, 0.0), side < 2u);
    let next = clamp((at + to) / f32(edge) * 2.0 - 1.0, vec2f(-1.001), vec2f(1.001));
    return area_cube_number(cube_face_point(cube_direction(index / (edge * edge), next)), edge);
}

fn area_cube_add(sum: ptr<function, AreaCubeGathered>, radiance: vec3f, weight: f32, schlick: f32) {
    let light = weight * radiance;
    (*sum).light += light;
    (*sum).weight += weight;
    (*sum).schlick += schlick * (light.x + light.y + light.z);
}

fn area_cube_scaled(sum: AreaCubeGathered, albedo: f32, normalized: bool) -> vec3f {
    if !normalized {
        return sum.light;
    }
    return albedo / max(sum.weight, AREA_CUBE_LEAST) * sum.light;
}

// Cosine at the half vector at which Schlick's form has the mean over the light.
fn area_cube_cos_theta(sum: AreaCubeGathered) -> f32 {
    let light = sum.light.x + sum.light.y + sum.light.z;
    if light <= 0.0 {
        return 1.0;
    }
    return 1.0 - pow(clamp(sum.schlick / light, 0.0, 1.0), 0.2);
}

// Light of the surroundings that the surface sends toward the viewer, all lobes.
fn area_cube_reflected(
    s: Surface, base: Frame, coat: Frame, to_viewer: vec3f, occlusion: f32, looked: AreaCubeLooked, asked: AreaCubeAsked,
) -> vec3f {
    let wo = classical_facing(frame_to_local(base, to_viewer));
    let coat_wo = classical_facing(frame_to_local(coat, to_viewer));
    let alpha = sqrt(s.alpha.x * s.alpha.y);
    let scatters = s.metallic > 0.0 && layered_scatters_again(s);
    let is_lit = scatters || s.metallic < 1.0;
    var glossy = AreaCubeGathered(vec3f(0.0), 0.0, 0.0);
    var over = glossy;
    var matte = glossy;

    // Texels that matter to all: where lobes look at few, only what is matte.
    let all = select(0u, 6u * asked.edge * asked.edge, is_lit || !asked.few);
    let few = select(0u, AREA_CUBE_NEIGHBOURS + 1u, asked.few);
    let few_layers = select(few, 2u * few, s.coat > 0.0);
    let base_index = area_cube_texel_at(looked.base, asked.edge);
    let coat_index = area_cube_texel_at(looked.coat, asked.edge);
    // One loop, since some drivers write out every call where it stands.
    for (var i = 0u; i < all + few_layers; i++) {
        let is_few = i >= all;
        let is_coat = is_few && i - all >= few;
        var index = i;
        if is_few {
            index = select(base_index, coat_index, is_coat);
            let side = (i - all) % (AREA_CUBE_NEIGHBOURS + 1u);
            if side > 0u {
                index = area_cube_neighbour(index, side - 1u, asked.edge);
            }
        }
        let texel = area_cube_of(area_cube_texel(index));
        let cap = area_cube_localised(texel, looked.x, asked.corrected);
        if !is_coat {
            let local = frame_to_local(base, cap.direction);
            let lit = area_cube_lambert(cap.share, local.z);
            if !is_few {
                area_cube_add(&matte, texel.radiance, lit, 0.0);
            }
            if is_few == asked.few {
                let part = area_cube_glossy(s.lobe, s.exponent, alpha, s.masking, wo, local, cap.share, lit, asked.middles);
                area_cube_add(&glossy, texel.radiance, part.x, part.y);
            }
        }
        if s.coat > 0.0 && is_coat == asked.few {
            let local = frame_to_local(coat, cap.direction);
            let lit = area_cube_lambert(cap.share, local.z);
            let part = area_cube_glossy(LAYERED_GGX, 0.0, s.coat_alpha, s.masking, coat_wo, local, cap.share, lit, asked.middles);
            area_cube_add(&over, texel.radiance, part.x, part.y);
        }
    }

    let light = area_cube_scaled(glossy, layered_lobe_albedo(s, wo), asked.normalized);
    var value = classical_occlusion(wo.z, classical_width(s.alpha), occlusion)
        * layered_reflectance(s, area_cube_cos_theta(glossy)) * light;
    if is_lit {
        var albedo = vec3f(0.0);
        if scatters {
            albedo += s.metallic * classical_multiple_albedo(s, wo);
        }
        if s.metallic < 1.0 {
            albedo += (1.0 - s.metallic) * layered_matte_albedo(s, wo);
        }
        value += occlusion * albedo * area_cube_scaled(matte, 1.0, asked.normalized);
    }
    if s.coat <= 0.0 {
        return value;
    }
    let whole = 1.0 - ggx_loss(coat_wo, vec2f(s.coat_alpha), s.masking);
    let top = classical_occlusion(coat_wo.z, s.coat_alpha, occlusion)
        * fresnel_schlick(vec3f(COAT_F0), 1.0, area_cube_cos_theta(over)) * area_cube_scaled(over, whole, asked.normalized);
    let passed = coat_transmission(coat_wo, s.coat_alpha, s.coat, s.masking);
    return value * passed * passed + s.coat * top;
}
