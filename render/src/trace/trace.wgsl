// Rays against the triangles of a scene: `trace_closest` and `trace_occluded`, see README.md. Whoever joins this declares
// `trace_words`, the buffer of a `TraceTree`.

/// Where things are in the buffer, and how long they are: vectors of four words.
const TRACE_HEADER: u32 = 3u;
const TRACE_NODE: u32 = 14u;
const TRACE_CHILDREN: u32 = 12u;
const TRACE_INSTANCE: u32 = 9u;
const TRACE_TRIANGLE: u32 = 3u;

/// References of nodes.
const TRACE_NONE: u32 = 0xffffffffu;
const TRACE_LEAF: u32 = 0x80000000u;
const TRACE_PLACE: u32 = 0x1fffffffu;
const TRACE_COUNT_SHIFT: u32 = 29u;

/// Children that can wait; a `TraceTree` needs no more.
const TRACE_STACK: u32 = 128u;

/// The bits of infinity, and of the greatest number below it.
const TRACE_INFINITY: u32 = 0x7f800000u;
const TRACE_GREATEST: u32 = 0x7f7fffffu;
/// The least number of full precision.
const TRACE_LEAST: f32 = 1.17549435e-38;

/// A key of a child: the bits of the distance at which the ray enters its box, its place in the node in the last three.
/// Whole numbers are in the order of the distances; without three bits they are a little less, which loses nothing.
const TRACE_LANE: u32 = 7u;
const TRACE_DISTANCE: u32 = 0x7ffffff8u;

/// Children that wait: key and node.
var<private> trace_stack: array<vec2u, TRACE_STACK>;
var<private> trace_height: u32;
/// Where the triangle of the last hit is.
var<private> trace_met: u32;

/// A ray made ready for the boxes of one tree.
struct TraceSlabs {
    /// Per axis: which of the two planes of a box the ray meets first.
    near: vec3u,
    near_origin: vec3f,
    far_origin: vec3f,
    inverse: vec3f,
}

/// A ray made ready for the triangles of one mesh.
struct TraceShear {
    /// The axis along which the direction is longest.
    axis: u32,
    /// From here on the axes are turned so that this one is z.
    origin: vec3f,
    /// Direction along x and y for one step of z, and the parameter of the ray for such a step.
    shear: vec3f,
}

/// A triangle that may be hit.
struct TraceMet {
    met: bool,
    t: f32,
    /// Weights of the second and third corner.
    barycentric: vec2f,
}

/// The nearest hit; of several at the same distance that of the first instance and triangle.
fn trace_closest(ray: RayData) -> HitData {
    return trace_walk(ray, false);
}

/// True when there is a hit.
fn trace_occluded(ray: RayData) -> bool {
    return trace_walk(ray, true).instance != HIT_NONE;
}

fn trace_walk(ray: RayData, any_will_do: bool) -> HitData {
    var hit = HitData(0.0, HIT_NONE, 0u, 0u, vec2f(0.0), 0u, 0u);
    let header = trace_words[0];
    if header.x == 0u || !trace_makes_sense(ray) {
        return hit;
    }
    trace_zero = header.w;
    trace_height = 0u;
    hit.t = bitcast<f32>(min(bitcast<u32>(ray.t_max), TRACE_GREATEST));
    let low = bitcast<vec4f>(trace_words[1]);
    let world = trace_slabs(ray.origin, ray.direction, low.xyz, bitcast<vec3f>(trace_words[2].xyz), low.w);
    var slabs = world;
    var shear = TraceShear();
    var current = 0u;
    // The instance in whose mesh the ray is, and how many children wait outside.
    var instance = TRACE_NONE;
    var outside = 0u;
    // Ends: a child waits at most once, as it has one parent.
    loop {
        var next = TRACE_NONE;
        if (current & TRACE_LEAF) == 0u {
            next = trace_nearest(current, slabs, hit.t);
        } else if instance == TRACE_NONE {
            let base = header.y + (current & TRACE_PLACE) * TRACE_INSTANCE;
            let placed = trace_words[base + 3u];
            let least = trace_words[base + 4u];
            let most = bitcast<vec4f>(trace_words[base + 5u]);
            let translation = bitcast<vec3f>(placed.xyz);
            let columns = trace_columns(base);
            let left = trace_columns(base + 6u);
            let moved = trace_rounded_sum(ray.origin, -translation);
            let moved_left = trace_left_of_sum(ray.origin, -translation, moved);
            let origin = trace_transformed(columns, left, moved, moved_left);
            let direction = trace_transformed(columns, left, ray.direction, vec3f(0.0));
            slabs = trace_slabs(origin, direction, bitcast<vec3f>(least.xyz), most.xyz, most.w);
            shear = trace_shear(origin, direction);
            instance = least.w;
            outside = trace_height;
            next = placed.w;
        } else {
            let first = current & TRACE_PLACE;
            let more = (current & ~TRACE_LEAF) >> TRACE_COUNT_SHIFT;
            for (var i = first; i <= first + more; i++) {
                let base = header.z + i * TRACE_TRIANGLE;
                let met = trace_triangle(base, shear, hit.t);
                if !met.met {
                    continue;
                }
                let triangle = trace_words[base].w;
                let before = instance < hit.instance || (instance == hit.instance && triangle < hit.triangle);
                if met.t < hit.t || (hit.instance != HIT_NONE && before) {
                    hit = HitData(met.t, instance, triangle, 0u, met.barycentric, 0u, 0u);
                    trace_met = base;
                }
            }
            if any_will_do && hit.instance != HIT_NONE {
                break;
            }
        }
        while next == TRACE_NONE {
            if instance != TRACE_NONE && trace_height == outside {
                instance = TRACE_NONE;
                slabs = world;
            }
            if trace_height == 0u {
                break;
            }
            trace_height -= 1u;
            let waiting = trace_stack[trace_height];
            if (waiting.x & TRACE_DISTANCE) <= bitcast<u32>(hit.t) {
                next = trace_child(waiting);
            }
        }
        if next == TRACE_NONE {
            break;
        }
        current = next;
    }
    return hit;
}

/// Normal of the triangle of the last hit, in the space of its mesh, of any length, on the side where corners run counter-clockwise.
fn trace_met_normal() -> vec3f {
    let a = bitcast<vec3f>(trace_words[trace_met].xyz);
    return cross(
        bitcast<vec3f>(trace_words[trace_met + 1u].xyz) - a, bitcast<vec3f>(trace_words[trace_met + 2u].xyz) - a,
    );
}

/// Comparisons of numbers that are none are not defined, those of their bits are.
fn trace_makes_sense(ray: RayData) -> bool {
    let end = bitcast<u32>(ray.t_max);
    let sizes = max(bitcast<vec3u>(ray.origin) & vec3u(~TRACE_LEAF), bitcast<vec3u>(ray.direction) & vec3u(~TRACE_LEAF));
    let there = bitcast<vec3u>(ray.direction) & vec3u(TRACE_INFINITY);
    return end != 0u && end <= TRACE_INFINITY && all(sizes < vec3u(TRACE_INFINITY)) && any(there != vec3u(0u));
}

fn trace_columns(base: u32) -> mat3x3f {
    return mat3x3f(
        bitcast<vec3f>(trace_words[base].xyz),
        bitcast<vec3f>(trace_words[base + 1u].xyz),
        bitcast<vec3f>(trace_words[base + 2u].xyz),
    );
}

fn trace_rounded_sum(a: vec3f, b: vec3f) -> vec3f {
    return trace_rounded(a + b);
}

/// For a tree within a box, its boxes grown by `slack` times the distance to the farthest corner.
fn trace_slabs(origin: vec3f, direction: vec3f, low: vec3f, high: vec3f, slack: f32) -> TraceSlabs {
    let reaches = max(abs(low - origin), abs(high - origin));
    let reach = max(reaches.x, max(reaches.y, reaches.z));
    // Twice: an axis is sheared by no more than the depth. At least one step of the numbers there.
    let shift = abs(origin) * 1.1920929e-7 + 2.0 * slack * reach;
    let near = bitcast<vec3u>(direction) >> vec3u(31u);
    let backward = near == vec3u(1u);
    // Stands in for the inverse of a zero, so that no product is beyond the greatest number.
    let greatest = 1e37 / max(reach, 1.0);
    let usable = abs(direction) * greatest > vec3f(1.0);
    let capped = select(vec3f(greatest), vec3f(-greatest), backward);
    let inverse = select(capped, 1.0 / select(vec3f(1.0), direction, usable), usable);
    let less = origin - shift;
    let more = origin + shift;
    return TraceSlabs(near, select(more, less, backward), select(less, more, backward), inverse);
}

/// The nearest child of a node that the ray meets with `0 <= t <= limit`; the others wait, nearer ones less long.
fn trace_nearest(place: u32, slabs: TraceSlabs, limit: f32) -> u32 {
    let base = TRACE_HEADER + place * TRACE_NODE;
    var a = trace_keys(base, 0u, slabs, limit);
    var b = trace_keys(base, 1u, slabs, limit);
    // A network that sorts eight keys in six steps, of Knuth 1973, The Art of Computer Programming, volume 3, section
    // 5.3.4: (0,2)(1,3)(4,6)(5,7), (0,4)(1,5)(2,6)(3,7), (0,1)(2,3)(4,5)(6,7), (2,4)(3,5), (1,4)(3,6), (1,2)(3,4)(5,6).
    a = vec4u(min(a.xy, a.zw), max(a.xy, a.zw));
    b = vec4u(min(b.xy, b.zw), max(b.xy, b.zw));
    let near = min(a, b);
    let far = max(a, b);
    a = vec4u(min(near.xz, near.yw), max(near.xz, near.yw)).xzyw;
    b = vec4u(min(far.xz, far.yw), max(far.xz, far.yw)).xzyw;
    let low = min(a.zw, b.xy);
    let high = max(a.zw, b.xy);
    let one = min(a.y, high.x);
    let four = max(a.y, high.x);
    let three = min(low.y, b.z);
    let six = max(low.y, b.z);
    trace_wait(b.w, place);
    trace_wait(max(high.y, six), place);
    trace_wait(min(high.y, six), place);
    trace_wait(max(three, four), place);
    trace_wait(min(three, four), place);
    trace_wait(max(one, low.x), place);
    trace_wait(min(one, low.x), place);
    if a.x == TRACE_NONE {
        return TRACE_NONE;
    }
    return trace_child(vec2u(a.x, place));
}

/// Keys of the children in half of a node; none for those that the ray misses.
fn trace_keys(base: u32, half: u32, slabs: TraceSlabs, limit: f32) -> vec4u {
    // Ize 2013, Robust BVH Ray Traversal: with this factor on the far distance rounding loses no box. Twice that of the
    // processor: division may be farther from the quotient.
    let far = 1.00000096;
    let near_planes = vec3u(base + half) + vec3u(0u, 4u, 8u) + 2u * slabs.near;
    let far_planes = vec3u(base + half + 2u) + vec3u(0u, 4u, 8u) - 2u * slabs.near;
    let near_x = (bitcast<vec4f>(trace_words[near_planes.x]) - slabs.near_origin.x) * slabs.inverse.x;
    let near_y = (bitcast<vec4f>(trace_words[near_planes.y]) - slabs.near_origin.y) * slabs.inverse.y;
    let near_z = (bitcast<vec4f>(trace_words[near_planes.z]) - slabs.near_origin.z) * slabs.inverse.z;
    let far_x = (bitcast<vec4f>(trace_words[far_planes.x]) - slabs.far_origin.x) * (slabs.inverse.x * far);
    let far_y = (bitcast<vec4f>(trace_words[far_planes.y]) - slabs.far_origin.y) * (slabs.inverse.y * far);
    let far_z = (bitcast<vec4f>(trace_words[far_planes.z]) - slabs.far_origin.z) * (slabs.inverse.z * far);
    let enter = max(max(near_x, near_y), max(near_z, vec4f(0.0)));
    let leave = min(min(far_x, far_y), min(far_z, vec4f(limit)));
    let there = trace_words[base + TRACE_CHILDREN + half] != vec4u(TRACE_NONE);
    let lanes = vec4u(0u, 1u, 2u, 3u) + 4u * half;
    return select(vec4u(TRACE_NONE), (bitcast<vec4u>(enter) & vec4u(TRACE_DISTANCE)) | lanes, (enter <= leave) & there);
}

fn trace_wait(key: u32, place: u32) {
    if key != TRACE_NONE {
        trace_stack[trace_height] = vec2u(key, place);
        trace_height += 1u;
    }
}

/// The reference that a key stands for.
fn trace_child(waiting: vec2u) -> u32 {
    let lane = waiting.x & TRACE_LANE;
    return trace_words[TRACE_HEADER + waiting.y * TRACE_NODE + TRACE_CHILDREN + (lane >> 2u)][lane & 3u];
}

fn trace_turned(v: vec3f, axis: u32) -> vec3f {
    return select(select(v.yzx, v.zxy, axis == 1u), v, axis == 2u);
}

fn trace_shear(origin: vec3f, direction: vec3f) -> TraceShear {
    let size = abs(direction);
    var axis = select(0u, 1u, size.y > size.x);
    axis = select(axis, 2u, size.z > max(size.x, size.y));
    let turned = trace_turned(direction, axis);
    return TraceShear(axis, trace_turned(origin, axis), trace_divided(vec3f(turned.xy, 1.0), turned.z));
}

/// Meets a triangle with `0 <= t <= limit`.
///
/// Woop, Benthin and Wald 2013, Watertight Ray/Triangle Intersection, as on the processor: core/src/trace/triangle.rs
/// explains the steps, which are the same in the same order.
fn trace_triangle(base: u32, shear: TraceShear, limit: f32) -> TraceMet {
    let a = trace_turned(bitcast<vec3f>(trace_words[base].xyz), shear.axis) - shear.origin;
    let b = trace_turned(bitcast<vec3f>(trace_words[base + 1u].xyz), shear.axis) - shear.origin;
    let c = trace_turned(bitcast<vec3f>(trace_words[base + 2u].xyz), shear.axis) - shear.origin;
    let depth = vec3f(a.z, b.z, c.z);
    let across = vec3f(a.x, b.x, c.x) - trace_rounded(shear.shear.x * depth);
    let along = vec3f(a.y, b.y, c.y) - trace_rounded(shear.shear.y * depth);

    // Twice the area between the origin and the edge opposite to each corner.
    let first = trace_rounded(across.zxy * along.yzx);
    let second = trace_rounded(along.zxy * across.yzx);
    var weights = first - second;
    if first.x == second.x {
        weights.x = trace_difference(across.z, along.y, along.z, across.y);
    }
    if first.y == second.y {
        weights.y = trace_difference(across.x, along.z, along.x, across.z);
    }
    if first.z == second.z {
        weights.z = trace_difference(across.y, along.x, along.y, across.x);
    }
    let least = min(weights.x, min(weights.y, weights.z));
    let most = max(weights.x, max(weights.y, weights.z));
    let sum = weights.x + weights.y + weights.z;
    // A sum of zero: the triangle is seen from its edge.
    if (least < 0.0 && most > 0.0) || abs(sum) < TRACE_LEAST {
        return TraceMet(false, 0.0, vec2f(0.0));
    }
    weights *= 1.0 / sum;
    let parts = trace_rounded(weights * depth);
    let t = (parts.x + parts.y + parts.z) * shear.shear.z;
    return TraceMet(t >= 0.0 && t <= limit, t, weights.yz);
}
