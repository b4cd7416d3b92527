// How much each of several probes counts at a point, and how far away one sees the surroundings. The pass supplies
// probe_place(index), where a probe stands, and probe_inverse_depth(side, x, y), what is kept of a texel's distance.

const PROBE_BLEND: f32 = 0.5;
const PROBE_FADE: f32 = 0.2;
// Neighbouring depths whose ratio is above this belong to different surfaces.
const PROBE_JUMP: f32 = 1.15;
// Stands for all probes.
const PROBE_ALL: u32 = 32u;
// Stands for an infinite distance.
const PROBE_FAR: f32 = 1e30;

// Where a probe stands, and half the edges of the box in which it serves.
struct ProbePlace {
    middle: vec3f,
    half: vec3f,
}

fn probe_smooth(x: f32) -> f32 {
    let t = clamp(x, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

fn probe_inside(place: ProbePlace, position: vec3f) -> f32 {
    let share = abs(position - place.middle) / place.half;
    return probe_smooth((1.0 - max(share.x, max(share.y, share.z))) / PROBE_FADE);
}

fn probe_reach(place: ProbePlace, position: vec3f) -> f32 {
    let inside = probe_inside(place, position);
    if inside <= 0.0 {
        return PROBE_FAR;
    }
    return max(length(position - place.middle), 1e-6) / inside;
}

// Weight of probe `index` among those whose bits are set in `serving`; that of all of them together for PROBE_ALL.
fn probe_weight(index: u32, serving: u32, position: vec3f) -> f32 {
    var nearest = PROBE_FAR;
    var covered = 0.0;
    for (var bits = serving; bits != 0u; bits &= bits - 1u) {
        let place = probe_place(firstTrailingBit(bits));
        nearest = min(nearest, probe_reach(place, position));
        covered = max(covered, probe_inside(place, position));
    }
    if nearest >= PROBE_FAR {
        return 0.0;
    }
    if index == PROBE_ALL {
        return covered;
    }
    var sum = 0.0;
    var own = 0.0;
    for (var bits = serving; bits != 0u; bits &= bits - 1u) {
        let other = firstTrailingBit(bits);
        let share = probe_smooth(1.0 - (probe_reach(probe_place(other), position) / nearest - 1.0) / PROBE_BLEND);
        sum += share;
        if other == index {
            own = share;
        }
    }
    return covered * own / sum;
}

// Metres to the surface in a direction of the world, of a probe with `face` texels along an edge, at least 2; 0 for the sky. Between
// texels of one surface by their depths, at a jump that of the nearest texel.
fn probe_distance(face: u32, direction: vec3f) -> f32 {
    let on_face = cube_face_point(vec3f(direction.xy, -direction.z));
    let side = u32(on_face.x);
    let p = on_face.yz;
    let at = (0.5 * p + 0.5) * f32(face) - 0.5;
    let low = clamp(floor(at), vec2f(0.0), vec2f(f32(face) - 2.0));
    let t = at - low;
    let x = u32(low.x);
    let y = u32(low.y);
    let corners = vec4f(
        probe_inverse_depth(side, x, y), probe_inverse_depth(side, x + 1u, y),
        probe_inverse_depth(side, x, y + 1u), probe_inverse_depth(side, x + 1u, y + 1u),
    );
    let least = min(min(corners.x, corners.y), min(corners.z, corners.w));
    let most = max(max(corners.x, corners.y), max(corners.z, corners.w));
    var inverse: f32;
    if least > 0.0 && most <= PROBE_JUMP * least {
        let rows = corners.xz + (corners.yw - corners.xz) * t.x;
        inverse = rows.x + (rows.y - rows.x) * t.y;
    } else {
        let row = select(corners.xy, corners.zw, t.y >= 0.5);
        inverse = select(row.x, row.y, t.x >= 0.5);
    }
    return select(0.0, sqrt(1.0 + dot(p, p)) / inverse, inverse > 0.0);
}
