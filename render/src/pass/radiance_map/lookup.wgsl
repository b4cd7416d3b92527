// Baked incident radiance: places near a point, directions in cells of the sphere, and the light that a surface makes of it. The pass supplies
//   radiance_map_position(place), radiance_map_normal(place)   of a place
//   radiance_map_start(cell)                                   first place of a cell of the grid
//   radiance_map_neighbour(index)                              sets of eight, one after another
//   radiance_map_direction(k)                                  of the map, and the area of its cell where a plane touches the sphere there
//   radiance_map_drawn(k)                                      a direction drawn in its cell, and its density
//   radiance_map_light(place, k)                               radiance of all groups
// and what the surface terms look up.

const RADIANCE_MAP_SET: u32 = 8u;
// Least cosine between the normals of places that light the same surface.
const RADIANCE_MAP_AGREEMENT: f32 = 0.5;
// Rings of cells around a point that are searched.
const RADIANCE_MAP_RINGS: i32 = 6;
// Bounces between smooth surfaces that are followed.
const RADIANCE_MAP_MIRRORS: u32 = 4u;

// What is the same for all points.
struct RadianceMapShape {
    low: vec3f,
    edge: f32,
    size: vec3u,
    places: u32,
    directions: u32,
    // Cosine of the angle beyond which a direction says nothing of another.
    reach: f32,
    smoothed: bool,
    box_shaped: bool,
    unguarded: bool,
}

// Places that light a point, with weights that sum to 1.
struct RadianceMapNear {
    places: array<u32, 8>,
    weights: array<f32, 8>,
}

// The nearest places so far: squared distances and places.
struct RadianceMapFound {
    distances: array<f32, 8>,
    places: array<u32, 8>,
    count: u32,
}

fn radiance_map_grid_cell(map: RadianceMapShape, position: vec3f) -> vec3u {
    let at = max(floor((position - map.low) / map.edge), vec3f(0.0));
    return min(vec3u(min(at, vec3f(65535.0))), map.size - 1u);
}

fn radiance_map_grid_index(map: RadianceMapShape, cell: vec3u) -> u32 {
    return (cell.z * map.size.y + cell.y) * map.size.x + cell.x;
}

// The `count` nearest places whose normals agree by a cosine, at most eight; fewer where there are not so many nearby.
fn radiance_map_nearest(
    map: RadianceMapShape, position: vec3f, normal: vec3f, agreement: f32, count: u32,
) -> RadianceMapFound {
    var found: RadianceMapFound;
    let middle = vec3i(radiance_map_grid_cell(map, position));
    for (var ring = 0; ring <= RADIANCE_MAP_RINGS; ring++) {
        // All within this are in the rings so far.
        let covered = map.edge * f32(ring - 1);
        if found.count == count && covered > 0.0 && found.distances[count - 1u] <= covered * covered {
            break;
        }
        let low = max(middle - ring, vec3i(0));
        let high = min(middle + ring, vec3i(map.size) - 1);
        for (var z = low.z; z <= high.z; z++) {
            for (var y = low.y; y <= high.y; y++) {
                let is_face = abs(z - middle.z) == ring || abs(y - middle.y) == ring;
                let across = select(2 * ring, 1, is_face || ring == 0);
                var x = select(middle.x - ring, low.x, is_face);
                while x <= high.x {
                    if x >= low.x {
                        let cell = radiance_map_grid_index(map, vec3u(vec3i(x, y, z)));
                        let end = radiance_map_start(cell + 1u);
                        for (var place = radiance_map_start(cell); place < end; place++) {
                            let apart = radiance_map_position(place) - position;
                            let distance2 = dot(apart, apart);
                            if found.count == count && distance2 >= found.distances[count - 1u] {
                                continue;
                            }
                            if dot(radiance_map_normal(place), normal) < agreement {
                                continue;
                            }
                            // Behind all that are no farther, so that of two at one distance the first comes first.
                            var at = min(found.count, count - 1u);
                            while at > 0u && (found.distances[at - 1u] > distance2
                                || (found.distances[at - 1u] == distance2 && found.places[at - 1u] > place)) {
                                found.distances[at] = found.distances[at - 1u];
                                found.places[at] = found.places[at - 1u];
                                at--;
                            }
                            found.distances[at] = distance2;
                            found.places[at] = place;
                            found.count = min(found.count + 1u, count);
                        }
                    }
                    x += across;
                }
            }
        }
    }
    return found;
}

// A place in the cell of a point, or in the next one that has some.
fn radiance_map_any(map: RadianceMapShape, position: vec3f) -> u32 {
    return min(radiance_map_start(radiance_map_grid_index(map, radiance_map_grid_cell(map, position))), map.places - 1u);
}

// The set of the nearest place, weighed by a hat over the distance, the agreement of normals and how near places are to the plane of the surface.
fn radiance_map_near(map: RadianceMapShape, position: vec3f, normal: vec3f) -> RadianceMapNear {
    var near: RadianceMapNear;
    var count = RADIANCE_MAP_SET;
    if map.unguarded {
        let found = radiance_map_nearest(map, position, normal, -2.0, RADIANCE_MAP_SET);
        near.places = found.places;
        count = found.count;
    } else {
        let found = radiance_map_nearest(map, position, normal, RADIANCE_MAP_AGREEMENT, 1u);
        var place = found.places[0];
        if found.count == 0u {
            place = radiance_map_any(map, position);
        }
        for (var i = 0u; i < RADIANCE_MAP_SET; i++) {
            near.places[i] = radiance_map_neighbour(RADIANCE_MAP_SET * place + i);
        }
    }
    var farthest = 0.0;
    var nearest = 0u;
    var distances: array<f32, 8>;
    for (var i = 0u; i < count; i++) {
        distances[i] = distance(radiance_map_position(near.places[i]), position);
        farthest = max(farthest, distances[i]);
        if distances[i] < distances[nearest] {
            nearest = i;
        }
    }
    // A little beyond the farthest, so that it counts.
    let reach = max(1.0001 * farthest, 1e-20);
    var sum = 0.0;
    for (var i = 0u; i < count; i++) {
        let place = near.places[i];
        var weight = 1.0;
        if !map.box_shaped {
            weight = max(1.0 - distances[i] / reach, 0.0);
        }
        if !map.unguarded {
            let cosine = dot(radiance_map_normal(place), normal);
            let off = abs(dot(radiance_map_position(place) - position, normal));
            weight *= max((cosine - RADIANCE_MAP_AGREEMENT) / (1.0 - RADIANCE_MAP_AGREEMENT), 0.0);
            weight *= max(1.0 - 2.0 * off / reach, 0.0);
        }
        near.weights[i] = weight;
        sum += weight;
    }
    for (var i = 0u; i < RADIANCE_MAP_SET; i++) {
        // None counts: the nearest.
        let alone = select(0.0, 1.0, i == nearest && count > 0u);
        near.weights[i] = select(alone, near.weights[i] / max(sum, 1e-12), sum > 1e-12);
    }
    return near;
}

// Radiance that arrives in the cell of a direction.
fn radiance_map_arriving(near: RadianceMapNear, k: u32) -> vec3f {
    var light = vec3f(0.0);
    for (var i = 0u; i < RADIANCE_MAP_SET; i++) {
        if near.weights[i] > 0.0 {
            light += near.weights[i] * radiance_map_light(near.places[i], k);
        }
    }
    return light;
}

// The direction in whose cell another one is.
fn radiance_map_in_cell(map: RadianceMapShape, direction: vec3f) -> u32 {
    var best = 0u;
    var most = -2.0;
    for (var k = 0u; k < map.directions; k++) {
        let cosine = dot(radiance_map_direction(k).xyz, direction);
        if cosine >= most {
            most = cosine;
            best = k;
        }
    }
    return best;
}

// Radiance from a direction: that of its cell, or a mean of the nearest by a hat over the cosine.
fn radiance_map_toward(map: RadianceMapShape, near: RadianceMapNear, direction: vec3f) -> vec3f {
    if !map.smoothed {
        return radiance_map_arriving(near, radiance_map_in_cell(map, direction));
    }
    var sum = vec3f(0.0);
    var weights = 0.0;
    for (var k = 0u; k < map.directions; k++) {
        let weight = dot(radiance_map_direction(k).xyz, direction) - map.reach;
        if weight > 0.0 {
            sum += weight * radiance_map_arriving(near, k);
            weights += weight;
        }
    }
    if weights > 0.0 {
        return sum / weights;
    }
    return radiance_map_arriving(near, radiance_map_in_cell(map, direction));
}

// Density of directions drawn in the cell k, in one of them.
fn radiance_map_pdf(k: u32, direction: vec3f) -> f32 {
    let own = radiance_map_direction(k);
    let range = 1.0 / max(dot(own.xyz, direction), 1e-3);
    return range * range * range / own.w;
}

// A surface seen from a direction, with the chances of its lobes, which sum to one or are all zero.
struct RadianceMapSeen {
    s: Surface,
    base: Frame,
    coat: Frame,
    // Of the triangle, on the viewer's side.
    geometric: vec3f,
    wo: vec3f,
    coat_wo: vec3f,
    // What passes the coat toward the viewer.
    passed: f32,
    base_is_mirror: bool,
    coat_is_mirror: bool,
    coat_chance: f32,
    glossy_chance: f32,
    spread_chance: f32,
}

fn radiance_map_seen(s: Surface, base: Frame, coat: Frame, geometric: vec3f, to_viewer: vec3f) -> RadianceMapSeen {
    var seen: RadianceMapSeen;
    seen.s = s;
    seen.base = base;
    seen.coat = coat;
    seen.geometric = geometric;
    seen.wo = classical_facing(frame_to_local(base, to_viewer));
    seen.coat_wo = classical_facing(frame_to_local(coat, to_viewer));
    seen.passed = coat_transmission(seen.coat_wo, s.coat_alpha, s.coat, s.masking);
    seen.base_is_mirror = max(s.alpha.x, s.alpha.y) < GGX_ALPHA_MIN;
    seen.coat_is_mirror = s.coat_alpha < GGX_ALPHA_MIN;
    let third = vec3f(1.0 / 3.0);
    var kept = 1.0;
    if !seen.base_is_mirror {
        kept = layered_lobe_albedo(s, seen.wo);
    }
    let glossy = seen.passed * dot(kept * layered_reflectance(s, seen.wo.z), third);
    var spread = vec3f(0.0);
    if s.metallic > 0.0 && layered_scatters_again(s) {
        spread += s.metallic * (1.0 - kept) * ggx_bounces(s.fresnel_mean, ggx_loss_mean(s.alpha, s.masking));
    }
    if s.metallic < 1.0 {
        spread += (1.0 - s.metallic) * layered_matte_albedo(s, seen.wo);
    }
    let spreads = seen.passed * dot(spread, third);
    let coated = 1.0 - seen.passed;
    let sum = coated + glossy + spreads;
    if sum > 0.0 {
        seen.coat_chance = coated / sum;
        seen.glossy_chance = glossy / sum;
        seen.spread_chance = spreads / sum;
    }
    return seen;
}

// Response with its cosine, and in w the density of radiance_map_lobe; mirrors have neither.
fn radiance_map_response(seen: RadianceMapSeen, wi: vec3f) -> vec4f {
    if dot(wi, seen.geometric) <= 0.0 {
        return vec4f(0.0);
    }
    let s = seen.s;
    let local = frame_to_local(seen.base, wi);
    var value = vec3f(0.0);
    var pdf = 0.0;
    if local.z > 0.0 {
        value = layered_spread(s, seen.wo, local);
        pdf = seen.spread_chance * local.z * INV_PI;
        if !seen.base_is_mirror {
            value += layered_glossy(s, seen.wo, local);
            if s.lobe == LAYERED_GGX {
                pdf += seen.glossy_chance * ggx_pdf(seen.wo, local, s.alpha);
            } else {
                pdf += seen.glossy_chance * blinn_phong_pdf(seen.wo, local, s.exponent, s.lobe);
            }
        }
        value *= local.z;
    }
    if s.coat > 0.0 {
        let coat_wi = frame_to_local(seen.coat, wi);
        value *= seen.passed * coat_transmission(coat_wi, s.coat_alpha, s.coat, s.masking);
        if !seen.coat_is_mirror {
            value += s.coat * coat_eval(seen.coat_wo, coat_wi, s.coat_alpha, s.masking) * max(coat_wi.z, 0.0);
            pdf += seen.coat_chance * ggx_pdf(seen.coat_wo, coat_wi, vec2f(s.coat_alpha));
        }
    }
    return vec4f(value, pdf);
}

// A direction drawn from the whole surface: its density, infinite for a mirror and 0 where there is none, and the response over it.
struct RadianceMapLobe {
    wi: vec3f,
    pdf: f32,
    weight: vec3f,
    is_mirror: bool,
}

fn radiance_map_mirrored(frame: Frame, wo: vec3f) -> vec3f {
    return normalize(frame_to_world(frame, vec3f(-wo.xy, wo.z)));
}

fn radiance_map_lobe(seen: RadianceMapSeen, u: vec3f) -> RadianceMapLobe {
    var lobe: RadianceMapLobe;
    let s = seen.s;
    if seen.coat_chance + seen.glossy_chance + seen.spread_chance <= 0.0 {
        return lobe;
    }
    if u.z < seen.glossy_chance {
        if seen.base_is_mirror {
            lobe.wi = radiance_map_mirrored(seen.base, seen.wo);
            let coat_wi = frame_to_local(seen.coat, lobe.wi);
            let passed = coat_transmission(coat_wi, s.coat_alpha, s.coat, s.masking);
            lobe.weight = seen.passed * passed * layered_reflectance(s, seen.wo.z) / seen.glossy_chance;
            lobe.is_mirror = true;
            lobe.pdf = select(0.0, 1.0, dot(lobe.wi, seen.geometric) > 0.0);
            return lobe;
        }
        lobe.wi = frame_to_world(seen.base, classical_drawn(s, seen.wo, u.xy).wi);
    } else if u.z < seen.glossy_chance + seen.spread_chance {
        lobe.wi = frame_to_world(seen.base, sampling_cosine_hemisphere(u.xy));
    } else {
        if seen.coat_is_mirror {
            lobe.wi = radiance_map_mirrored(seen.coat, seen.coat_wo);
            lobe.weight = s.coat * fresnel_schlick(vec3f(COAT_F0), 1.0, seen.coat_wo.z) / seen.coat_chance;
            lobe.is_mirror = true;
            lobe.pdf = select(0.0, 1.0, dot(lobe.wi, seen.geometric) > 0.0);
            return lobe;
        }
        let wm = ggx_sample_wm(seen.coat_wo, vec2f(s.coat_alpha), u.xy);
        lobe.wi = frame_to_world(seen.coat, reflect(-seen.coat_wo, wm));
    }
    lobe.wi = normalize(lobe.wi);
    let found = radiance_map_response(seen, lobe.wi);
    lobe.pdf = found.w;
    lobe.weight = found.xyz / max(found.w, 1e-30);
    return lobe;
}

// True where rays are traced instead: its lobe, or that of its coat, is narrower than `below`.
fn radiance_map_is_smooth(s: Surface, below: f32) -> bool {
    return sqrt(s.alpha.x * s.alpha.y) < below || (s.coat > 0.0 && s.coat_alpha < below);
}

// Numbers of their own for drawing number i.
fn radiance_map_numbers(random: vec4f, i: u32) -> vec3f {
    if i == 0u {
        return random.xyz;
    }
    let turn = vec3f(
        sampling_unit(sampling_pcg(3u * i)), sampling_unit(sampling_pcg(3u * i + 1u)),
        sampling_unit(sampling_pcg(3u * i + 2u)),
    );
    return fract(random.xyz + turn);
}

// Light that the surface sends to the viewer of what is known in cells, summed over these and over directions drawn from its lobes: Veach 1997, the
// balance heuristic.
fn radiance_map_reflected(
    map: RadianceMapShape, seen: RadianceMapSeen, position: vec3f, lobes: u32, random: vec4f,
) -> vec3f {
    let near = radiance_map_near(map, position, seen.base.n);
    var sum = vec3f(0.0);
    for (var k = 0u; k < map.directions; k++) {
        // In its cell, so that the sum is right in the mean.
        let drawn = radiance_map_drawn(k);
        let response = radiance_map_response(seen, drawn.xyz);
        if all(response.xyz == vec3f(0.0)) {
            continue;
        }
        var arriving: vec3f;
        if map.smoothed {
            arriving = radiance_map_toward(map, near, drawn.xyz);
        } else {
            arriving = radiance_map_arriving(near, k);
        }
        sum += response.xyz * arriving / (drawn.w + f32(lobes) * response.w);
    }
    for (var i = 0u; i < lobes; i++) {
        let drawn = radiance_map_lobe(seen, radiance_map_numbers(random, i));
        if drawn.pdf <= 0.0 {
            continue;
        }
        let arriving = radiance_map_toward(map, near, drawn.wi);
        if drawn.is_mirror {
            sum += drawn.weight * arriving / f32(lobes);
        } else {
            let own = radiance_map_pdf(radiance_map_in_cell(map, drawn.wi), drawn.wi);
            sum += drawn.weight * arriving * drawn.pdf / (own + f32(lobes) * drawn.pdf);
        }
    }
    return sum;
}
