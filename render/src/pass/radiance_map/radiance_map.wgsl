// Adds to every surface the light of a baked map. Smooth surfaces send rays, and take the map where these end.

@group(2) @binding(0) var radiance_cube: texture_cube<f32>;
@group(2) @binding(1) var cube_sampler: sampler;
@group(2) @binding(2) var<storage, read> tables: array<f32>;
@group(2) @binding(3) var<storage, read> lights: array<LightData>;
@group(2) @binding(4) var<storage, read> unlit: array<u32>;
@group(2) @binding(5) var<storage, read> trace_words: array<vec4u>;
@group(2) @binding(6) var<storage, read> met: array<MetData>;
@group(2) @binding(7) var<storage, read> map_words: array<u32>;
@group(3) @binding(0) var<uniform> given: MapData;
// Directions of the map with the areas of their cells.
@group(3) @binding(1) var<uniform> map_directions: array<vec4f, 1024>;

// Without it no surface sends rays, and the code that follows them is left out.
override traced: bool = true;

// Share of its distance by which a ray starts beside its surface: depths are no more exact.
const MAP_LIFT: f32 = 1e-4;

// Frames that a still picture has.
const MAP_STILL: u32 = 16u;

fn ggx_albedo_entry(index: u32) -> f32 {
    return tables[index];
}

fn fresnel_table(table: u32, entry: u32) -> vec3f {
    let first = table + 3u * entry;
    return vec3f(tables[first], tables[first + 1u], tables[first + 2u]);
}

// The environment alone is asked for, by rays that leave the scene.
fn classical_radiance(direction: vec3f, level: f32) -> vec3f {
    let c = view.environment_cos;
    let s = view.environment_sin;
    let own = vec3f(c * direction.x - s * direction.z, direction.y, -(s * direction.x + c * direction.z));
    return view.environment_scale * textureSampleLevel(radiance_cube, cube_sampler, own, level).rgb;
}

fn classical_dimmed(direction: vec3f, level: f32) -> vec3f { return vec3f(0.0); }
fn classical_prefiltered(direction: vec3f, level: f32) -> vec3f { return vec3f(0.0); }
fn classical_irradiance(direction: vec3f) -> vec3f { return vec3f(0.0); }
fn classical_source(index: u32) -> mat2x3f { return mat2x3f(vec3f(0.0), vec3f(0.0)); }

fn map_vector(first: u32) -> vec3f {
    return bitcast<vec3f>(vec3u(map_words[first], map_words[first + 1u], map_words[first + 2u]));
}

fn radiance_map_position(place: u32) -> vec3f {
    return map_vector(given.positions + 3u * place);
}

fn radiance_map_normal(place: u32) -> vec3f {
    return map_vector(given.normals + 3u * place);
}

fn radiance_map_start(cell: u32) -> u32 {
    return map_words[given.starts + cell];
}

fn radiance_map_neighbour(index: u32) -> u32 {
    return map_words[given.neighbours + index];
}

// Which list of drawn directions a pixel has in a frame.
var<private> map_list: u32;

fn radiance_map_direction(k: u32) -> vec4f {
    return map_directions[k];
}

fn radiance_map_drawn(k: u32) -> vec4f {
    let first = given.drawn + 4u * (map_list * given.directions + k);
    return vec4f(map_vector(first), bitcast<f32>(map_words[first + 3u]));
}

// Three numbers of a list that begins at a word.
fn map_numbers(first: u32, number: u32) -> vec3f {
    if (given.flags & MAP_FLOATS) != 0u {
        return map_vector(first + 3u * number);
    }
    let half = 3u * number;
    let word = first + (half >> 1u);
    let a = unpack2x16float(map_words[word]);
    let b = unpack2x16float(map_words[word + 1u]);
    return select(vec3f(a, b.x), vec3f(a.y, b), (half & 1u) == 1u);
}

fn radiance_map_light(place: u32, k: u32) -> vec3f {
    let number = place * given.directions + k;
    var light = vec3f(0.0);
    // Those of no scale are dark, or switched off.
    if given.scales.x > 0.0 {
        light += given.scales.x * given.environment_color * map_numbers(given.environment, number);
    }
    if given.scales.y > 0.0 {
        light += given.scales.y * given.lamps_color * map_numbers(given.lamps, number);
    }
    if given.scales.z > 0.0 {
        light += given.scales.z * given.glow_color * map_numbers(given.glow, number);
    }
    return light;
}

fn shape() -> RadianceMapShape {
    return RadianceMapShape(
        given.low, given.edge, given.size, given.places, given.directions, given.reach,
        (given.flags & MAP_SMOOTH) != 0u, (given.flags & MAP_BOX) != 0u, (given.flags & MAP_UNGUARDED) != 0u,
    );
}

// A surface that a ray met: textures are not at hand, their means are.
fn met_surface(m: MaterialData, mean: MetData) -> Surface {
    var t: Texel;
    t.base_color = mean.base_color;
    t.metallic = mean.metallic;
    t.alpha = mean.alpha;
    t.exponent = m.exponent;
    t.dielectric_f0 = mean.dielectric_f0;
    t.dielectric_f90 = mean.dielectric_f90;
    t.coat = mean.coat;
    t.coat_alpha = mean.coat_alpha;
    return surface_of(t, m);
}

// Light of a lamp that a met surface sends back along the ray, with a shadow by a ray.
fn met_lamp(light: LightData, seen: RadianceMapSeen, position: vec3f, lift: f32, u: vec2f) -> vec3f {
    var lamp: Lamp;
    if light.kind == LIGHT_RECTANGLE {
        let side = cross(light.across, light.direction);
        let at = light.position + (u.x - 0.5) * light.size.x * light.across + (u.y - 0.5) * light.size.y * side;
        let range = max(distance(at, position), 1e-3);
        let direction = (at - position) / range;
        let area = light.size.x * light.size.y * max(-dot(direction, light.direction), 0.0);
        lamp = Lamp(direction, range, light.intensity * area / (range * range));
    } else if light.kind == LIGHT_SPHERE {
        let range = max(distance(light.position, position), light.size.x);
        let ratio = light.size.x / range;
        lamp = Lamp((light.position - position) / range, range - light.size.x, PI * ratio * ratio * light.intensity);
    } else if light.kind == LIGHT_SUN {
        lamp = Lamp(-light.direction, 1e30, light.intensity);
    } else {
        lamp = lamp_at(light, position);
        lamp.distance = select(lamp.distance, 1e30, light.kind == LIGHT_DIRECTIONAL);
    }
    let response = radiance_map_response(seen, lamp.direction).xyz;
    if all(lamp.irradiance * response <= vec3f(0.0)) {
        return vec3f(0.0);
    }
    let start = position + lift * seen.geometric;
    if trace_occluded(RayData(start, lamp.distance * 0.9999, lamp.direction, 0u)) {
        return vec3f(0.0);
    }
    return lamp.irradiance * response;
}

// Follows a ray from smooth surface to smooth surface, and takes the map at its end.
fn followed(first: RadianceMapSeen, point: vec3f, lift: f32, random: vec4f, ray: u32) -> vec3f {
    var seen = first;
    var position = point;
    var lifted = lift;
    var weight = vec3f(1.0);
    var sum = vec3f(0.0);
    for (var bounce = 0u; bounce <= RADIANCE_MAP_MIRRORS; bounce++) {
        if bounce == RADIANCE_MAP_MIRRORS || (bounce > 0u && !radiance_map_is_smooth(seen.s, given.below)) {
            return sum + weight * radiance_map_reflected(shape(), seen, position, 0u, random);
        }
        let drawn = radiance_map_lobe(seen, radiance_map_numbers(random, ray + 977u * bounce));
        if drawn.pdf <= 0.0 {
            return sum;
        }
        weight *= drawn.weight;
        let start = position + lifted * seen.geometric;
        let hit = trace_closest(RayData(start, 3.0e38, drawn.wi, 0u));
        if hit.instance == HIT_NONE {
            // As wide as the share of one of the rays of a still picture, so that few of them do not miss a sun.
            var level = classical_footprint(drawn.wi, drawn.pdf, MAP_STILL, view.environment_mips, 0.0);
            level = select(level, 0.0, drawn.is_mirror);
            return sum + weight * given.environment_color * classical_radiance(drawn.wi, level);
        }
        position = start + hit.t * drawn.wi;
        lifted = MAP_LIFT * hit.t;
        let instance = instances[hit.instance];
        let normals = mat3x3f(instance.normal0.xyz, instance.normal1.xyz, instance.normal2.xyz);
        let outward = normalize(normals * trace_met_normal());
        let geometric = select(outward, -outward, dot(outward, drawn.wi) > 0.0);
        let m = materials[instance.material];
        let mean = met[instance.material];
        let frame = frame_new(geometric);
        seen = radiance_map_seen(met_surface(m, mean), frame, frame, geometric, -drawn.wi);
        sum += weight * given.glow_color * seen.passed * mean.emission;
        if any(given.lamps_color > vec3f(0.0)) {
            for (var i = 0u; i < view.light_count; i++) {
                if lights_instance(i, hit.instance) {
                    let u = radiance_map_numbers(random, ray + 31u * i + 7u).xy;
                    sum += weight * given.lamps_color * met_lamp(lights[i], seen, position, lifted, u);
                }
            }
        }
    }
    return sum;
}

// What a part of a lookup finds, for measuring what it costs.
fn found_by_part(position: vec3f, normal: vec3f) -> vec3f {
    if given.part == MAP_NOTHING {
        return vec3f(0.0);
    }
    if given.part == MAP_QUERY {
        let place = radiance_map_nearest(shape(), position, normal, RADIANCE_MAP_AGREEMENT, 1u).places[0];
        return vec3f(f32(radiance_map_neighbour(RADIANCE_MAP_SET * place + 1u)));
    }
    if given.part == MAP_SEARCH {
        let found = radiance_map_nearest(shape(), position, normal, RADIANCE_MAP_AGREEMENT, RADIANCE_MAP_SET);
        return vec3f(f32(found.places[0] ^ found.places[7]));
    }
    let near = radiance_map_near(shape(), position, normal);
    var light = vec3f(0.0);
    for (var k = 0u; k < given.directions; k++) {
        light += radiance_map_arriving(near, k);
    }
    return light;
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let first = textureLoad(words0, pixel, 0);
    if first.x == 0u {
        discard;
    }
    let packed = Packed(
        first, textureLoad(words1, pixel, 0), textureLoad(words2, pixel, 0), textureLoad(words3, pixel, 0),
    );
    let t = texel_unpack(packed);
    let world = unproject(position.xy, textureLoad(depth, pixel, 0));
    let point = world.xyz / world.w;
    let to_viewer = normalize(view.viewer.xyz - point * view.viewer.w);
    let m = materials[instances[t.id - 1u].material];
    let base = Frame(t.tangent, cross(t.normal, t.tangent), t.normal);
    let seen = radiance_map_seen(surface_of(t, m), base, frame_new(t.coat_normal), t.geometric_normal, to_viewer);
    // In the frames of a picture it goes through lists far apart.
    map_list = (sampling_pcg(pixel.x + sampling_pcg(pixel.y)) + view.frame * 81u) % given.lists;
    let turn = sample_rotation(pixel);
    let more = sampling_pcg(bitcast<u32>(turn.x) ^ sampling_pcg(bitcast<u32>(turn.y)));
    let random = vec4f(turn, sampling_unit(more), sampling_unit(sampling_pcg(more)));
    var value = vec3f(0.0);
    if given.part != MAP_ALL {
        value = found_by_part(point, t.normal);
    } else if traced && radiance_map_is_smooth(seen.s, given.below) {
        let rays = max(given.lobes, 1u);
        let lift = MAP_LIFT * distance(view.viewer.xyz, point * view.viewer.w);
        for (var ray = 0u; ray < rays; ray++) {
            value += followed(seen, point, lift, random, ray) / f32(rays);
        }
    } else {
        value = radiance_map_reflected(shape(), seen, point, given.lobes, random);
    }
    return vec4f(min(value, vec3f(frame_max)), 0.0);
}
