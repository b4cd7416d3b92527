// From cell to cell of a pyramid of bounds until a ray goes through a surface. The pass supplies pyramid_face(), the texels along an edge of
// the cube of distances, pyramid_corners(side, x, y), what is kept at the four corners of a quad, and pyramid_bounds(level, side, x, y),
// least and greatest over a cell of a level from 1 on.

// Neighbouring depths whose ratio is above this belong to different surfaces.
const PYRAMID_JUMP: f32 = 1.15;
// Most ways over faces.
const PYRAMID_WAYS: u32 = 12u;
// Most lookups for each step of a march.
const PYRAMID_LOOKUPS_PER_STEP: u32 = 4u;
// Levels below the highest at which a face is entered: the highest say little.
const PYRAMID_ENTRY: u32 = 3u;
// Depths below count as this.
const PYRAMID_DEPTH_MIN: f32 = 1e-20;
// Beyond every ray.
const PYRAMID_FAR: f32 = 3e38;

struct PyramidFound {
    t: f32,
    ratio: f32,
    lookups: u32,
    is_hit: bool,
}

// A straight way over a face: where it starts, in texels from the middle of the first, and how far it goes; the ray's inverse
// depth there, and how much it changes.
struct PyramidWay {
    at: vec2f,
    step: vec2f,
    inverse: f32,
    change: f32,
}

// The ray is before the surface that the middle sees; its ratio at the last place that was looked at. A hit is a share of a way
// or of a piece of it, below 0 for none.
struct PyramidState {
    is_under: bool,
    last: f32,
    lookups: u32,
    hit: f32,
    ratio: f32,
}

// A vector along the two edges and the axis of a face.
fn pyramid_on_axes(side: u32, d: vec3f) -> vec3f {
    switch side {
        case 0u: {
            return vec3f(-d.z, -d.y, d.x);
        }
        case 1u: {
            return vec3f(d.z, -d.y, -d.x);
        }
        case 2u: {
            return vec3f(d.x, d.z, d.y);
        }
        case 3u: {
            return vec3f(d.x, -d.z, -d.y);
        }
        case 4u: {
            return vec3f(d.x, -d.y, d.z);
        }
        default: {
            return vec3f(-d.x, -d.y, -d.z);
        }
    }
}

// Where a ray on the axes of a face leaves it.
fn pyramid_leaves(x: vec3f, r: vec3f) -> f32 {
    let beyond = vec4f(x.x, -x.x, x.y, -x.y) - x.z;
    let slope = vec4f(r.x, -r.x, r.y, -r.y) - r.z;
    let rises = slope > vec4f(0.0);
    let exits = select(vec4f(PYRAMID_FAR), -beyond / select(vec4f(1.0), slope, rises), rises);
    return min(min(exits.x, exits.y), min(exits.z, exits.w));
}

// The face beyond an edge.
fn pyramid_next_side(side: u32, on: vec3f, p: vec3f) -> u32 {
    let crosses_u = abs(on.x) >= abs(on.y);
    var axis = 0u;
    var sign = p.x;
    if (crosses_u && side < 2u) || (!crosses_u && (side == 2u || side == 3u)) {
        axis = 4u;
        sign = p.z;
    } else if !crosses_u {
        axis = 2u;
        sign = p.y;
    }
    return axis + select(0u, 1u, sign < 0.0);
}

fn pyramid_inverse(on: vec3f) -> f32 {
    return 1.0 / max(on.z, PYRAMID_DEPTH_MIN);
}

fn pyramid_at(on: vec3f) -> vec2f {
    let n = f32(pyramid_face());
    return clamp((0.5 * pyramid_inverse(on) * on.xy + 0.5) * n - 0.5, vec2f(-0.5), vec2f(n - 0.5));
}

// Where c + b s + a s^2 rises through 0; below 0 for nowhere.
fn pyramid_rising_root(c: f32, b: f32, a: f32) -> f32 {
    let root = b * b - 4.0 * a * c;
    let length = sqrt(max(root, 0.0));
    let over = select(length - b, -2.0 * c, b > 0.0);
    let under = select(2.0 * a, b + length, b > 0.0);
    if !(root >= 0.0 && abs(under) > PYRAMID_DEPTH_MIN) {
        return -1.0;
    }
    return over / under;
}

// A way past the middle between texels, as a share; 1 for none.
fn pyramid_middle(start: f32, step: f32) -> f32 {
    if step == 0.0 {
        return 1.0;
    }
    let cut = (0.5 - start) / step;
    return select(1.0, cut, cut > 0.0 && cut < 1.0);
}

// Where a piece of a ray goes through the surface over a quad. `at` and `step` are its start and length, from the first corner in
// quads, `ray` its inverse depths at both ends.
fn pyramid_cross(
    corners: vec4f, at: vec2f, step: vec2f, ray: vec2f, before: PyramidState, tolerance: f32,
) -> PyramidState {
    let least = min(min(corners.x, corners.y), min(corners.z, corners.w));
    let most = max(max(corners.x, corners.y), max(corners.z, corners.w));
    let is_smooth = least > 0.0 && most <= PYRAMID_JUMP * least;
    var cuts = vec2f(1.0);
    if !is_smooth {
        // At a jump each quarter is as far as its texel.
        cuts = vec2f(pyramid_middle(at.x, step.x), pyramid_middle(at.y, step.y));
    }
    var state = before;
    var low = 0.0;
    for (var piece = 0u; piece < 3u && low < 1.0; piece++) {
        var high = 1.0;
        if piece == 0u {
            high = min(cuts.x, cuts.y);
        } else if piece == 1u {
            high = max(cuts.x, cuts.y);
        }
        if !(high > low) {
            continue;
        }
        var surface: vec3f;
        if is_smooth {
            let u = corners.y - corners.x;
            let v = corners.z - corners.x;
            let twist = corners.x - corners.y - corners.z + corners.w;
            surface = vec3f(
                corners.x + u * at.x + v * at.y + twist * at.x * at.y,
                u * step.x + v * step.y + twist * (at.x * step.y + at.y * step.x),
                twist * step.x * step.y,
            );
        } else {
            let middle = at + 0.5 * (low + high) * step;
            let row = select(corners.xy, corners.zw, middle.y >= 0.5);
            surface = vec3f(select(row.x, row.y, middle.x >= 0.5), 0.0, 0.0);
        }
        let first = vec2f(surface.x + (surface.y + surface.z * low) * low, ray.x + (ray.y - ray.x) * low);
        let second = vec2f(surface.x + (surface.y + surface.z * high) * high, ray.x + (ray.y - ray.x) * high);
        if state.is_under && !(first.x < first.y) {
            let ratio = first.x / first.y;
            if ratio - 1.0 <= tolerance {
                state.hit = low;
                state.ratio = ratio;
                return state;
            }
            if 1.0 - state.last <= tolerance {
                state.hit = low;
                state.ratio = state.last;
                return state;
            }
        }
        let crosses = first.x < first.y && !(second.x < second.y);
        let root = pyramid_rising_root(surface.x - ray.x, surface.y - (ray.y - ray.x), surface.z);
        if crosses || (root > low && root < high) {
            let share = select(clamp(root, low, high), high, root < 0.0);
            state.hit = share;
            state.ratio = (surface.x + (surface.y + surface.z * share) * share) / (ray.x + (ray.y - ray.x) * share);
            return state;
        }
        state.is_under = second.x < second.y;
        state.last = second.x / second.y;
        low = high;
    }
    return state;
}

fn pyramid_exit(start: f32, step: f32, low: u32, high: u32, last: u32) -> f32 {
    if step > 0.0 && high <= last {
        return (f32(high) - start) / step;
    }
    if step < 0.0 && low > 0u {
        return (f32(low) - start) / step;
    }
    return 2.0;
}

// Follows a way over a face.
fn pyramid_follow(
    side: u32, way: PyramidWay, before: PyramidState, most_lookups: u32, tolerance: f32,
) -> PyramidState {
    let last = max(pyramid_face(), 2u) - 2u;
    // Levels until one cell has all quads.
    let top = select(0u, firstLeadingBit(max(last, 1u)) + 1u, last > 0u);
    var state = before;
    var share = 0.0;
    var quad = min(vec2u(max(floor(way.at), vec2f(0.0))), vec2u(last));
    var level = max(top, PYRAMID_ENTRY) - PYRAMID_ENTRY;
    while state.lookups < most_lookups {
        let low = (quad >> vec2u(level)) << vec2u(level);
        let high = low + vec2u(1u << level);
        let exit_x = pyramid_exit(way.at.x, way.step.x, low.x, high.x, last);
        let exit_y = pyramid_exit(way.at.y, way.step.y, low.y, high.y, last);
        let end = max(min(min(exit_x, exit_y), 1.0), share);
        let ray = way.inverse + vec2f(share, end) * way.change;
        state.lookups++;
        if level > 0u {
            let bounds = pyramid_bounds(level, side, quad.x >> level, quad.y >> level);
            let beyond = select(1.0, 1.0 + tolerance, state.is_under);
            if bounds.y < min(ray.x, ray.y) {
                state.is_under = true;
            } else if bounds.x > beyond * max(ray.x, ray.y) {
                state.is_under = false;
            } else {
                level--;
                continue;
            }
            state.last = 0.0;
        } else {
            let corners = pyramid_corners(side, quad.x, quad.y);
            let at = way.at + share * way.step - vec2f(quad);
            state = pyramid_cross(corners, at, (end - share) * way.step, ray, state, tolerance);
            if state.hit >= 0.0 {
                state.hit = share + (end - share) * state.hit;
                return state;
            }
        }
        if end >= 1.0 {
            break;
        }
        let along = min(vec2u(max(floor(way.at + end * way.step), vec2f(0.0))), vec2u(last));
        let over = select(max(low, vec2u(1u)) - 1u, high, way.step > vec2f(0.0));
        let kept = clamp(along, low, high - 1u);
        quad = select(vec2u(kept.x, over.y), vec2u(over.x, kept.y), exit_x <= exit_y);
        share = end;
        if level < top && any((quad >> vec2u(level + 1u)) != (low >> vec2u(level + 1u))) {
            level++;
        }
    }
    return state;
}

// The first place between `first` and `last` on the ray from `world_x` in the unit direction `world_r` where it goes through a surface, or jumps
// behind one that is as near as the tolerance. Between the two places of `gap` there is nothing.
fn pyramid_search(
    world_x: vec3f, world_r: vec3f, first: f32, last: f32, gap: vec2f, most_lookups: u32, tolerance: f32,
) -> PyramidFound {
    let x = vec3f(world_x.xy, -world_x.z);
    let r = vec3f(world_r.xy, -world_r.z);
    var state = PyramidState(false, 0.0, 0u, -1.0, 0.0);
    var t = first;
    var side = u32(cube_face_point(x + first * r).x);
    for (var i = 0u; i < PYRAMID_WAYS; i++) {
        let stop = select(last, min(gap.x, last), t < gap.x);
        let a = pyramid_on_axes(side, x);
        let b = pyramid_on_axes(side, r);
        let exit = max(pyramid_leaves(a, b), t);
        let end = min(exit, stop);
        if end > t {
            let on = array<vec3f, 2>(a + t * b, a + end * b);
            let inverse = pyramid_inverse(on[0]);
            let at = pyramid_at(on[0]);
            let way = PyramidWay(at, pyramid_at(on[1]) - at, inverse, pyramid_inverse(on[1]) - inverse);
            state = pyramid_follow(side, way, state, most_lookups, tolerance);
            if state.hit >= 0.0 {
                // Inverse depths are linear on the way, not depths.
                let share = state.hit * (way.inverse + way.change) / (way.inverse + state.hit * way.change);
                return PyramidFound(t + (end - t) * clamp(share, 0.0, 1.0), state.ratio, state.lookups, true);
            }
        }
        if exit < stop {
            side = pyramid_next_side(side, a + exit * b, x + exit * r);
            t = exit;
        } else if stop < last && gap.y < last {
            t = gap.y;
            side = u32(cube_face_point(x + t * r).x);
        } else {
            break;
        }
    }
    return PyramidFound(0.0, 0.0, state.lookups, false);
}
