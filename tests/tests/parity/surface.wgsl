
// The surface of four vectors, see surface.rs.
fn parity_surface(a: vec4f, b: vec4f, c: vec4f, d: vec4f) -> Surface {
    let curve = u32(d.x);
    var s: Surface;
    s.base_color = a.xyz;
    s.metallic = a.w;
    s.alpha = b.xy;
    s.fresnel = parity_curve(curve);
    s.fresnel_mean = parity_curve_mean(curve);
    s.dielectric_f0 = c.xyz;
    s.dielectric_f90 = c.w;
    s.coat = b.z;
    s.coat_alpha = b.w;
    s.masking = u32(d.y) / 2u;
    s.multiple_scattering = u32(d.y) % 2u == 1u;
    s.lobe = u32(d.z);
    s.exponent = d.w;
    return s;
}
