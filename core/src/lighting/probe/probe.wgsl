// How much each of several probes counts at a point. The pass supplies probe_place(index).

const PROBE_BLEND: f32 = 0.5;
const PROBE_FADE: f32 = 0.2;
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

// Weight of probe `index` among those whose bits are set in `serving`; that of all of them for an index beyond 31.
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
    if index > 31u {
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
