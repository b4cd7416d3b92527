// One pixel of the G-buffer: what a surface is at a point, textures looked up, in four targets of four words.

struct Texel {
    // Instance index plus one; 0 is the background.
    id: u32,
    // Shading normal and tangent (the anisotropy axis), orthonormal, world space.
    normal: vec3f,
    tangent: vec3f,
    // Normal of the triangle, on the viewer's side.
    geometric_normal: vec3f,
    coat_normal: vec3f,
    base_color: vec3f,
    metallic: f32,
    // GGX width along tangent and bitangent.
    alpha: vec2f,
    // Of the lobe, where it is not GGX.
    exponent: f32,
    occlusion: f32,
    coat: f32,
    coat_alpha: f32,
    emission: vec3f,
    dielectric_f0: vec3f,
    dielectric_f90: f32,
    // Kept out of the targets: only the forward pass blends.
    opacity: f32,
}

struct Packed {
    @location(0) words0: vec4u,
    @location(1) words1: vec4u,
    @location(2) words2: vec4u,
    @location(3) words3: vec4u,
}

// Emission beyond a half float is clamped.
const EMISSION_MAX: f32 = 65504.0;

fn texel_pack(t: Texel) -> Packed {
    let emission = min(t.emission, vec3f(EMISSION_MAX));
    return Packed(
        vec4u(
            t.id,
            pack2x16snorm(oct_encode(t.normal)),
            pack2x16snorm(oct_encode(t.tangent)),
            pack2x16snorm(oct_encode(t.geometric_normal)),
        ),
        vec4u(
            pack2x16unorm(t.base_color.xy),
            pack2x16unorm(vec2f(t.base_color.z, t.metallic)),
            pack2x16unorm(t.alpha),
            pack2x16unorm(vec2f(t.occlusion, t.coat)),
        ),
        vec4u(
            pack2x16float(emission.xy),
            pack2x16float(vec2f(emission.z, t.coat_alpha)),
            pack2x16unorm(t.dielectric_f0.xy),
            pack2x16unorm(vec2f(t.dielectric_f0.z, t.dielectric_f90)),
        ),
        vec4u(pack2x16snorm(oct_encode(t.coat_normal)), bitcast<u32>(t.exponent), 0u, 0u),
    );
}

fn texel_unpack(p: Packed) -> Texel {
    let base_rg = unpack2x16unorm(p.words1.x);
    let base_b_metallic = unpack2x16unorm(p.words1.y);
    let occlusion_coat = unpack2x16unorm(p.words1.w);
    let emission_rg = unpack2x16float(p.words2.x);
    let emission_b_coat_alpha = unpack2x16float(p.words2.y);
    let f0_rg = unpack2x16unorm(p.words2.z);
    let f0_b_f90 = unpack2x16unorm(p.words2.w);
    var t: Texel;
    t.id = p.words0.x;
    t.normal = oct_decode(unpack2x16snorm(p.words0.y));
    t.tangent = oct_decode(unpack2x16snorm(p.words0.z));
    t.geometric_normal = oct_decode(unpack2x16snorm(p.words0.w));
    t.coat_normal = oct_decode(unpack2x16snorm(p.words3.x));
    t.base_color = vec3f(base_rg, base_b_metallic.x);
    t.metallic = base_b_metallic.y;
    t.alpha = unpack2x16unorm(p.words1.z);
    t.exponent = bitcast<f32>(p.words3.y);
    t.occlusion = occlusion_coat.x;
    t.coat = occlusion_coat.y;
    t.coat_alpha = emission_b_coat_alpha.y;
    t.emission = vec3f(emission_rg, emission_b_coat_alpha.x);
    t.dielectric_f0 = vec3f(f0_rg, f0_b_f90.x);
    t.dielectric_f90 = f0_b_f90.y;
    t.opacity = 1.0;
    return t;
}
