// What a pass that lights resolved surfaces knows of them.

fn surface_of(t: Texel, m: MaterialData) -> Surface {
    var s: Surface;
    s.base_color = t.base_color;
    s.metallic = t.metallic;
    s.alpha = t.alpha;
    s.lobe = m.flags >> MATERIAL_LOBE_SHIFT;
    s.exponent = t.exponent;
    s.dielectric_f0 = t.dielectric_f0;
    s.dielectric_f90 = t.dielectric_f90;
    s.coat = t.coat;
    s.coat_alpha = t.coat_alpha;
    s.masking = view.masking;
    s.multiple_scattering = view.multiple_scattering != 0u;
    if (m.flags & MATERIAL_PRESET) != 0u {
        s.fresnel = Fresnel(
            m.fresnel_form, m.fresnel_table, m.fresnel_f0, m.fresnel_c0, m.fresnel_c1, m.fresnel_c2, m.fresnel_c3,
        );
        s.fresnel_mean = m.fresnel_mean;
    } else {
        let none = vec3f(0.0);
        s.fresnel = Fresnel(FRESNEL_RESCALED, 0u, t.base_color, none, none, none, none);
        s.fresnel_mean = t.base_color + (1.0 - t.base_color) / 21.0;
    }
    return s;
}

// Largest radiance that a frame holds, where the device blends half floats only.
override frame_max: f32 = 3.0e38;

// True where the picture shows the light of a source, one of the CONTRIBUTION_ constants.
fn shows(source: u32) -> bool {
    return view.contribution == CONTRIBUTION_ALL || view.contribution == source;
}

// What turns the samples of a pixel in this frame.
fn sample_rotation(pixel: vec2u) -> vec2f {
    let hash = sampling_pcg(pixel.x + sampling_pcg(pixel.y + sampling_pcg(view.frame)));
    return vec2f(sampling_unit(hash), sampling_unit(sampling_pcg(hash)));
}
