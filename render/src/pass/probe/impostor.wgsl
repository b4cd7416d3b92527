// Adds to surfaces that a probe serves what its surroundings send.

// Without it lobes are looked up once, and the code that samples them is left out.
override sampled: bool = true;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = served(position);
    if at.weight <= 0.0 {
        discard;
    }
    let t = at.texel;
    let eye = to_viewer(at.point);
    if given.show != IMPOSTOR_SHOW_LIGHT {
        let found = follow(reflect(-eye, t.normal)).found;
        return vec4f(at.weight * impostor_shown(found, given.show), 0.0);
    }
    let m = materials[instances[t.id - 1u].material];
    let base = Frame(t.tangent, cross(t.normal, t.tangent), t.normal);
    let lobes = ClassicalLobes(
        select(0u, view.samples, sampled), probe.source_count, sample_rotation(vec2u(position.xy)), probe.radiance_mips,
        probe.prefiltered_mips, probe.wide_alpha,
    );
    let coat = frame_new(t.coat_normal);
    let value = classical_environment(surface_of(t, m), m.albedo_table, base, coat, eye, t.occlusion, lobes);
    return vec4f(min(at.weight * value, vec3f(frame_max)), 0.0);
}
