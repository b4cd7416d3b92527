// What shines as a point sees it, as a polygon, and the light of one. polygon.rs clips whole polygons; here edges are clipped
// one by one as they are summed, since software drivers take long for arrays.

const AREA_CORNERS_MAX: u32 = 16u;
// Sides of the polygon that stands for a sphere; its radius over that of the circle of equal area.
const AREA_SIDES: u32 = 12u;
const AREA_WIDENING: f32 = 1.0233267;
// Height over the horizon of the corners of the whole hemisphere.
const AREA_HORIZON: f32 = 1e-4;

const AREA_NOTHING: u32 = 0u;
const AREA_RECTANGLE: u32 = 1u;
const AREA_CAP: u32 = 2u;
const AREA_EVERYWHERE: u32 = 3u;

// What shines. Rectangle: its middle and half its sides, cross(across, up) pointing away from the point. Cap: unit axis,
// and the sine of half its angle.
struct AreaShape {
    center: vec3f,
    kind: u32,
    across: vec3f,
    sine: f32,
    up: vec3f,
}

struct AreaPolygon {
    corners: array<vec3f, AREA_CORNERS_MAX>,
    count: u32,
}

fn area_nothing() -> AreaShape {
    return AreaShape(vec3f(0.0), AREA_NOTHING, vec3f(0.0), 0.0, vec3f(0.0));
}

// Middle relative to the point, unit direction and side, full sizes.
fn area_rectangle(center: vec3f, direction: vec3f, across: vec3f, size: vec2f) -> AreaShape {
    if !(dot(center, direction) < 0.0) || !(min(size.x, size.y) > 0.0) {
        return area_nothing();
    }
    let up = cross(across, direction);
    return AreaShape(center, AREA_RECTANGLE, 0.5 * size.x * across, 0.0, 0.5 * size.y * up);
}

fn area_cap(axis: vec3f, sine: f32) -> AreaShape {
    return AreaShape(axis, AREA_CAP, vec3f(0.0), sine, vec3f(0.0));
}

fn area_sphere(center: vec3f, radius: f32) -> AreaShape {
    let distance = length(center);
    if !(radius > 0.0) {
        return area_nothing();
    }
    if distance <= radius {
        return AreaShape(vec3f(0.0), AREA_EVERYWHERE, vec3f(0.0), 1.0, vec3f(0.0));
    }
    return area_cap(center / distance, radius / distance);
}

fn area_local(shape: AreaShape, frame: Frame) -> AreaShape {
    let across = frame_to_local(frame, shape.across);
    let up = frame_to_local(frame, shape.up);
    return AreaShape(frame_to_local(frame, shape.center), shape.kind, across, shape.sine, up);
}

// Corner of a shape, counter-clockwise as the point sees it.
fn area_corner(shape: AreaShape, around: Frame, index: u32) -> vec3f {
    if shape.kind == AREA_RECTANGLE {
        let right = index == 1u || index == 2u;
        return shape.center + select(-shape.up, shape.up, index >= 2u) + select(-shape.across, shape.across, right);
    }
    let phi = 2.0 * PI * f32(index) / f32(select(4u, AREA_SIDES, shape.kind == AREA_CAP));
    let direction = vec2f(cos(phi), sin(phi));
    if shape.kind == AREA_CAP {
        let cosine = sqrt(max((1.0 - shape.sine) * (1.0 + shape.sine), 0.0));
        return frame_to_world(around, vec3f(direction * (AREA_WIDENING * shape.sine), cosine));
    }
    return vec3f(direction, AREA_HORIZON);
}

// What of a shape is above the horizon.
fn area_polygon(shape: AreaShape) -> AreaPolygon {
    var polygon: AreaPolygon;
    polygon.count = 0u;
    if shape.kind == AREA_NOTHING {
        return polygon;
    }
    let around = frame_new(shape.center);
    let count = select(4u, AREA_SIDES, shape.kind == AREA_CAP);
    var start = area_corner(shape, around, count - 1u);
    for (var i = 0u; i < count; i++) {
        let end = area_corner(shape, around, i);
        if (start.z > 0.0) != (end.z > 0.0) && polygon.count < AREA_CORNERS_MAX {
            polygon.corners[polygon.count] = area_crossing(start, end);
            polygon.count++;
        }
        if end.z > 0.0 && polygon.count < AREA_CORNERS_MAX {
            polygon.corners[polygon.count] = end;
            polygon.count++;
        }
        start = end;
    }
    return polygon;
}

// Where a line crosses the plane z = 0.
fn area_crossing(start: vec3f, end: vec3f) -> vec3f {
    let crossing = start + (end - start) * (start.z / (start.z - end.z));
    return vec3f(crossing.xy, 0.0);
}

// Of an edge what is above the plane z = 0, and where the outline leaves that and comes back: the edge that closes it.
struct AreaClip {
    start: vec3f,
    end: vec3f,
    leaves: vec3f,
    enters: vec3f,
}

// Leaves nothing of an edge below.
fn area_clip(clip: ptr<function, AreaClip>) {
    let start = (*clip).start;
    let end = (*clip).end;
    if start.z <= 0.0 && end.z <= 0.0 {
        (*clip).start = vec3f(0.0);
        (*clip).end = vec3f(0.0);
        return;
    }
    if start.z > 0.0 && end.z > 0.0 {
        return;
    }
    let crossing = area_crossing(start, end);
    if start.z > 0.0 {
        (*clip).end = crossing;
        (*clip).leaves = crossing;
    } else {
        (*clip).start = crossing;
        (*clip).enters = crossing;
    }
}

// Angle in [0, pi] whose sine and cosine are in this ratio; sine >= 0. Abramowitz and Stegun 1964, 4.4.49.
fn area_angle(sine: f32, cosine: f32) -> f32 {
    let x = min(sine, abs(cosine)) / max(max(sine, abs(cosine)), 1e-30);
    let x2 = x * x;
    let tail = 0.10656264 + x2 * (-0.07528964 + x2 * (0.042909613 + x2 * (-0.016165737 + x2 * 0.0028662257)));
    let acute = x * (1.0 + x2 * (-0.33333145 + x2 * (0.19993551 + x2 * (-0.142089 + x2 * tail))));
    let first = select(acute, 0.5 * PI - acute, sine > abs(cosine));
    return select(first, PI - first, cosine < 0.0);
}

// Share of an edge in the integral of the direction over the solid angle of a polygon.
fn area_edge(start: vec3f, end: vec3f) -> vec3f {
    // The cross product with the difference keeps the digits of short edges.
    let normal = cross(start, end - start);
    let sine = length(normal);
    return normal * (0.5 * area_angle(sine, dot(start, end)) / max(sine, 1e-30));
}

// Integral of the direction over the solid angle.
fn area_flux(polygon: ptr<function, AreaPolygon>) -> vec3f {
    let count = (*polygon).count;
    var sum = vec3f(0.0);
    if count == 0u {
        return sum;
    }
    var start = (*polygon).corners[count - 1u];
    for (var i = 0u; i < count; i++) {
        let end = (*polygon).corners[i];
        sum += area_edge(start, end);
        start = end;
    }
    return sum;
}
