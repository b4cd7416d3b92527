// A list of rays, one in each invocation.

@group(1) @binding(0) var<storage, read> rays: array<RayData>;
@group(1) @binding(1) var<storage, read_write> hits: array<HitData>;

@compute @workgroup_size(64)
fn closest(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&rays) {
        hits[id.x] = trace_closest(rays[id.x]);
    }
}

/// Writes instance 0 where there is a hit, whichever it is.
@compute @workgroup_size(64)
fn occluded(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&rays) {
        let instance = select(HIT_NONE, 0u, trace_occluded(rays[id.x]));
        hits[id.x] = HitData(0.0, instance, 0u, 0u, vec2f(0.0), 0u, 0u);
    }
}
