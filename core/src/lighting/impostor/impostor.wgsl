// Distance impostors: where a ray meets the surroundings that a cube of distances was taken of. Positions are relative to the
// middle of the cube. The pass supplies impostor_distance(direction), metres to the surface in a unit direction, 0 for the sky.

const IMPOSTOR_CLASSICAL: u32 = 0u;
const IMPOSTOR_SPHERE: u32 = 1u;
const IMPOSTOR_BOX: u32 = 2u;
const IMPOSTOR_PERPENDICULAR: u32 = 3u;
const IMPOSTOR_SECANT: u32 = 4u;
const IMPOSTOR_SECANT_FROM_POINT: u32 = 5u;
const IMPOSTOR_FALSE_POSITION: u32 = 6u;
const IMPOSTOR_MIXED: u32 = 7u;
const IMPOSTOR_MARCH: u32 = 8u;
const IMPOSTOR_PYRAMID: u32 = 9u;

// Differences of ratios below this say nothing about where they meet 1.
const IMPOSTOR_EPSILON: f32 = 1e-6;

// What is known of the surroundings as a whole, metres: the nearest and the farthest surface, the radius of the sphere and
// the corners of the box that stand for them.
struct ImpostorExtent {
    near: f32,
    far: f32,
    radius: f32,
    low: vec3f,
    high: vec3f,
}

struct ImpostorEffort {
    solver: u32,
    refinements: u32,
    steps: u32,
    tolerance: f32,
}

// A place on the ray; its distance from the middle over that of the surface in its direction, 0 before the sky.
struct ImpostorProbe {
    t: f32,
    ratio: f32,
}

struct ImpostorFound {
    t: f32,
    ratio: f32,
    lookups: u32,
    is_hit: bool,
}

fn impostor_miss() -> ImpostorFound {
    return ImpostorFound(0.0, 0.0, 0u, false);
}

fn impostor_probe(x: vec3f, r: vec3f, t: f32) -> ImpostorProbe {
    let p = x + t * r;
    let length = length(p);
    var direction = r;
    if length > 1e-20 {
        direction = p / length;
    }
    let distance = impostor_distance(direction);
    var ratio = 0.0;
    if distance > 0.0 {
        ratio = length / distance;
    }
    return ImpostorProbe(t, ratio);
}

// Distance of the surface in the direction of the ray; of the farthest where there is sky.
fn impostor_reach(extent: ImpostorExtent, r: vec3f) -> f32 {
    let distance = impostor_distance(r);
    return select(extent.far, distance, distance > 0.0);
}

// No surface is farther along the ray.
fn impostor_clamp(extent: ImpostorExtent, x: vec3f, t: f32) -> f32 {
    return clamp(t, 0.0, length(x) + extent.far);
}

// Where a line between a place before the surface and one behind it has the ratio 1.
fn impostor_between(under: ImpostorProbe, over: ImpostorProbe) -> f32 {
    let share = (1.0 - under.ratio) / max(over.ratio - under.ratio, 1e-20);
    return under.t + (over.t - under.t) * clamp(share, 0.0, 1.0);
}

// Secant steps, or false position, from a first place.
fn impostor_steps(extent: ImpostorExtent, x: vec3f, r: vec3f, effort: ImpostorEffort) -> ImpostorFound {
    let reach = impostor_reach(extent, r);
    let from_point = effort.solver == IMPOSTOR_SECANT_FROM_POINT || effort.solver == IMPOSTOR_FALSE_POSITION;
    let start = select(impostor_clamp(extent, x, reach - dot(x, r)), 0.0, from_point);
    let is_secant = effort.solver == IMPOSTOR_SECANT || effort.solver == IMPOSTOR_SECANT_FROM_POINT;
    var before = impostor_probe(x, r, start);
    if effort.solver == IMPOSTOR_PERPENDICULAR {
        return ImpostorFound(before.t, before.ratio, 2u, abs(before.ratio - 1.0) <= effort.tolerance);
    }
    var under = ImpostorProbe(0.0, 0.0);
    var over = ImpostorProbe(0.0, 0.0);
    var has_under = false;
    var has_over = false;
    if before.ratio < 1.0 {
        under = before;
        has_under = true;
    } else {
        over = before;
        has_over = true;
    }
    var last = impostor_probe(x, r, impostor_clamp(extent, x, start + reach * (1.0 - before.ratio)));
    var lookups = 3u;
    for (var i = 0u; i < effort.refinements; i++) {
        var next = last.t + reach * (1.0 - last.ratio);
        if is_secant {
            let difference = last.ratio - before.ratio;
            let missing = 1.0 - last.ratio;
            if !(abs(difference) > IMPOSTOR_EPSILON || abs(difference) > abs(missing)) || difference == 0.0 {
                break;
            }
            next = last.t + (last.t - before.t) * missing / difference;
        } else {
            if last.ratio < 1.0 {
                under = last;
                has_under = true;
            } else {
                over = last;
                has_over = true;
            }
            if has_under && has_over {
                next = impostor_between(under, over);
            }
        }
        before = last;
        last = impostor_probe(x, r, impostor_clamp(extent, x, next));
        lookups++;
    }
    return ImpostorFound(last.t, last.ratio, lookups, abs(last.ratio - 1.0) <= effort.tolerance);
}

// Where a ray from inside leaves the sphere or the box; below 0 from outside.
fn impostor_sphere(x: vec3f, r: vec3f, radius: f32) -> f32 {
    let b = dot(x, r);
    let c = dot(x, x) - radius * radius;
    return select(-1.0, sqrt(max(b * b - c, 0.0)) - b, c <= 0.0);
}

fn impostor_box(x: vec3f, r: vec3f, low: vec3f, high: vec3f) -> f32 {
    let inside = all(x >= low) && all(x <= high);
    let t = select(x - low, high - x, r > vec3f(0.0)) / max(abs(r), vec3f(1e-20));
    return select(-1.0, min(t.x, min(t.y, t.z)), inside);
}

fn impostor_proxy(t: f32) -> ImpostorFound {
    if t < 0.0 {
        return impostor_miss();
    }
    return ImpostorFound(t, 1.0, 0u, true);
}

// The part of the ray in which surfaces may be: from and to; empty where they are the other way round.
fn impostor_span(extent: ImpostorExtent, x: vec3f, r: vec3f) -> vec2f {
    let b = dot(x, r);
    let length2 = dot(x, x);
    let far = 1.001 * extent.far;
    let near = 0.999 * extent.near;
    let outer = b * b - length2 + far * far;
    if outer <= 0.0 {
        return vec2f(0.0, -1.0);
    }
    let entry = max(-sqrt(outer) - b, 0.0);
    let inner = sqrt(max(b * b - length2 + near * near, 0.0)) - b;
    return vec2f(select(entry, inner, length2 < near * near), sqrt(outer) - b);
}

// False position in a bracket that halves the miss of an end that stays; the nearest place and the number of lookups.
fn impostor_refine(
    x: vec3f, r: vec3f, under: ImpostorProbe, over: ImpostorProbe, refinements: u32,
) -> ImpostorProbe {
    var low = vec2f(under.t, 1.0 - under.ratio);
    var high = vec2f(over.t, over.ratio - 1.0);
    var best = under;
    if high.y < low.y {
        best = over;
    }
    var side = 0u;
    for (var i = 0u; i < refinements; i++) {
        let t = impostor_between(ImpostorProbe(low.x, 1.0 - low.y), ImpostorProbe(high.x, 1.0 + high.y));
        let probe = impostor_probe(x, r, t);
        if abs(probe.ratio - 1.0) < abs(best.ratio - 1.0) {
            best = probe;
        }
        if probe.ratio < 1.0 {
            low = vec2f(probe.t, 1.0 - probe.ratio);
            high.y *= select(1.0, 0.5, side == 1u);
            side = 1u;
        } else {
            high = vec2f(probe.t, probe.ratio - 1.0);
            low.y *= select(1.0, 0.5, side == 2u);
            side = 2u;
        }
    }
    return best;
}

// Steps even in the angle under which the middle sees them, until the ray goes through a surface.
fn impostor_march(extent: ImpostorExtent, x: vec3f, r: vec3f, effort: ImpostorEffort) -> ImpostorFound {
    let span = impostor_span(extent, x, r);
    if !(span.y > span.x) {
        return impostor_miss();
    }
    let foot = -dot(x, r);
    let height = max(length(x + foot * r), 1e-4 * extent.far);
    let first = atan((span.x - foot) / height);
    let last = atan((span.y - foot) / height);
    let steps = max(effort.steps, 1u);
    var before = impostor_probe(x, r, span.x);
    var lookups = 1u;
    for (var step = 1u; step <= steps; step++) {
        let angle = first + (last - first) * (f32(step) / f32(steps));
        var t = span.y;
        if step < steps {
            t = clamp(foot + height * tan(angle), span.x, span.y);
        }
        let probe = impostor_probe(x, r, t);
        lookups++;
        if before.ratio < 1.0 && probe.ratio >= 1.0 {
            let found = impostor_refine(x, r, before, probe, effort.refinements);
            lookups += effort.refinements;
            if abs(found.ratio - 1.0) <= effort.tolerance {
                return ImpostorFound(found.t, found.ratio, lookups, true);
            }
        }
        before = probe;
    }
    return ImpostorFound(0.0, 0.0, lookups, false);
}

// By the bounds of distances.
fn impostor_pyramid(extent: ImpostorExtent, x: vec3f, r: vec3f, effort: ImpostorEffort) -> ImpostorFound {
    let span = impostor_span(extent, x, r);
    if !(span.y > span.x) {
        return impostor_miss();
    }
    // From where to where the ray is nearer to the middle than anything else.
    let b = dot(x, r);
    let near = 0.999 * extent.near;
    let inner = b * b - dot(x, x) + near * near;
    let half = sqrt(max(inner, 0.0));
    let gap = select(vec2f(0.0), vec2f(-half - b, half - b), inner > 0.0);
    let most = PYRAMID_LOOKUPS_PER_STEP * max(effort.steps, 1u);
    let found = pyramid_search(x, r, span.x, span.y, gap, most, effort.tolerance);
    return ImpostorFound(found.t, found.ratio, found.lookups, found.is_hit);
}

// Follows the ray from `x` in the unit direction `r`.
fn impostor_solve(extent: ImpostorExtent, x: vec3f, r: vec3f, effort: ImpostorEffort) -> ImpostorFound {
    switch effort.solver {
        case IMPOSTOR_CLASSICAL: {
            return impostor_miss();
        }
        case IMPOSTOR_SPHERE: {
            return impostor_proxy(impostor_sphere(x, r, extent.radius));
        }
        case IMPOSTOR_BOX: {
            return impostor_proxy(impostor_box(x, r, extent.low, extent.high));
        }
        case IMPOSTOR_MARCH: {
            return impostor_march(extent, x, r, effort);
        }
        case IMPOSTOR_PYRAMID: {
            return impostor_pyramid(extent, x, r, effort);
        }
        default: {
            return impostor_steps(extent, x, r, effort);
        }
    }
}

// Unit direction in which the middle sees what the ray meets.
fn impostor_direction(found: ImpostorFound, x: vec3f, r: vec3f) -> vec3f {
    let p = x + found.t * r;
    let length2 = dot(p, p);
    if !found.is_hit || !(length2 > 0.0) {
        return r;
    }
    return p / sqrt(length2);
}

// Level of a prefiltered cube for a lobe that is seen from `t` metres away instead of from the middle.
fn impostor_level(level: f32, t: f32, distance: f32, last: f32) -> f32 {
    return clamp(level + log2(max(t, 1e-6) / max(distance, 1e-6)), 0.0, last);
}

const IMPOSTOR_SHOW_LIGHT: u32 = 0u;
const IMPOSTOR_SHOW_LOOKUPS: u32 = 1u;
const IMPOSTOR_SHOW_RATIO: u32 = 2u;
const IMPOSTOR_SHOW_ERROR: u32 = 3u;
const IMPOSTOR_MOST_LOOKUPS: f32 = 32.0;
const IMPOSTOR_MOST_RATIO: f32 = 0.1;

// A scale from blue over green to red, x from 0 to 1.
fn impostor_heat(x: f32) -> vec3f {
    let at = 4.0 * clamp(x, 0.0, 1.0);
    return clamp(1.5 - abs(at - vec3f(3.0, 2.0, 1.0)), vec3f(0.0), vec3f(1.0));
}

// The colour of a search by its lookups or where it ended.
fn impostor_shown(found: ImpostorFound, show: u32) -> vec3f {
    if show == IMPOSTOR_SHOW_LOOKUPS {
        return impostor_heat(f32(found.lookups) / IMPOSTOR_MOST_LOOKUPS);
    }
    if show == IMPOSTOR_SHOW_RATIO {
        let off = clamp((found.ratio - 1.0) / IMPOSTOR_MOST_RATIO, -1.0, 1.0);
        return vec3f(max(off, 0.0), select(1.0, 0.0, found.is_hit), max(-off, 0.0));
    }
    return vec3f(0.0);
}

// The colour of an error in direction, degrees.
fn impostor_error_shown(degrees: f32) -> vec3f {
    return impostor_heat((log2(max(degrees, 1e-9)) / log2(10.0) + 2.0) / 4.0);
}
