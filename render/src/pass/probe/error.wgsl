// Shows by how many degrees the search in the mirror direction is off what the ray meets.

// Share of its distance from the viewer by which a ray starts beside its surface: depths are no more exact.
const ERROR_LIFT: f32 = 1e-4;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = served(position);
    if at.weight <= 0.0 {
        discard;
    }
    let eye = to_viewer(at.point);
    let direction = reflect(-eye, at.texel.normal);
    let found = follow(direction).found;
    let start = at.point + ERROR_LIFT * length(view.viewer.xyz - at.point * view.viewer.w) * at.texel.normal;
    let hit = trace_closest(RayData(start, 3.0e38, direction, 0u));
    // The sky is seen in the same direction from everywhere.
    let wanted = select(direction, start + hit.t * direction - probe.middle, hit.instance != HIT_NONE);
    let seen = impostor_direction(found, from_middle, direction);
    let degrees = atan2(length(cross(seen, wanted)), dot(seen, wanted)) * 180.0 / PI;
    return vec4f(at.weight * impostor_error_shown(degrees), 0.0);
}
