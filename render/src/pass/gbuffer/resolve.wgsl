// From a vertex to a resolved surface: transforms, textures, tangent frame. Used by the G-buffer and the forward pass.

@group(0) @binding(0) var<uniform> view: ViewData;
@group(0) @binding(1) var<storage, read> instances: array<InstanceData>;
@group(0) @binding(2) var<storage, read> materials: array<MaterialData>;

@group(1) @binding(0) var texture0: texture_2d<f32>;
@group(1) @binding(1) var texture1: texture_2d<f32>;
@group(1) @binding(2) var texture2: texture_2d<f32>;
@group(1) @binding(3) var texture3: texture_2d<f32>;
@group(1) @binding(4) var texture4: texture_2d<f32>;
@group(1) @binding(5) var texture5: texture_2d<f32>;
@group(1) @binding(6) var texture6: texture_2d<f32>;
@group(1) @binding(7) var texture7: texture_2d<f32>;
@group(1) @binding(8) var texture8: texture_2d<f32>;
@group(1) @binding(9) var texture9: texture_2d<f32>;
@group(1) @binding(10) var texture10: texture_2d<f32>;
@group(1) @binding(11) var sampler0: sampler;
@group(1) @binding(12) var sampler1: sampler;
@group(1) @binding(13) var sampler2: sampler;
@group(1) @binding(14) var sampler3: sampler;
@group(1) @binding(15) var sampler4: sampler;
@group(1) @binding(16) var sampler5: sampler;
@group(1) @binding(17) var sampler6: sampler;
@group(1) @binding(18) var sampler7: sampler;
@group(1) @binding(19) var sampler8: sampler;
@group(1) @binding(20) var sampler9: sampler;
@group(1) @binding(21) var sampler10: sampler;

struct VertexIn {
    @builtin(instance_index) instance: u32,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv0: vec2f,
    @location(4) uv1: vec2f,
    @location(5) color: vec4f,
}

struct VertexOut {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv0: vec2f,
    @location(4) uv1: vec2f,
    @location(5) color: vec4f,
    @location(6) @interpolate(flat) instance: u32,
}

@vertex
fn vertex(in: VertexIn) -> VertexOut {
    let instance = instances[in.instance];
    let world = instance.world_from_local * vec4f(in.position, 1.0);
    let normals = mat3x3f(instance.normal0.xyz, instance.normal1.xyz, instance.normal2.xyz);
    var out: VertexOut;
    out.clip = view.clip_from_world * world;
    out.position = world.xyz;
    out.normal = normals * in.normal;
    let tangent = (instance.world_from_local * vec4f(in.tangent.xyz, 0.0)).xyz;
    // A mirrored instance turns the bitangent round.
    out.tangent = vec4f(tangent, in.tangent.w * instance.normal0.w);
    out.uv0 = in.uv0;
    out.uv1 = in.uv1;
    out.color = in.color;
    out.instance = in.instance;
    return out;
}

// Texture coordinates of a slot with their screen derivatives, taken where control flow is still uniform.
struct Coordinates {
    uv0: vec2f, dx0: vec2f, dy0: vec2f,
    uv1: vec2f, dx1: vec2f, dy1: vec2f,
}

struct Footprint { uv: vec2f, dx: vec2f, dy: vec2f }

fn footprint(c: Coordinates, slot: TextureSlot) -> Footprint {
    let second = slot.uv_set == 1u;
    let m = mat2x2f(slot.matrix.xy, slot.matrix.zw);
    return Footprint(
        m * select(c.uv0, c.uv1, second) + slot.offset,
        m * select(c.dx0, c.dx1, second),
        m * select(c.dy0, c.dy1, second),
    );
}

// A direction of usable length, else the fallback.
fn safe_normalize(v: vec3f, fallback: vec3f) -> vec3f {
    let squared = dot(v, v);
    return select(fallback, v * inverseSqrt(squared), squared > 1e-30);
}

fn perturbed(texel: vec3f, scale: f32, n: vec3f, t: vec3f, b: vec3f) -> vec3f {
    let local = texel * 2.0 - 1.0;
    return safe_normalize(t * (local.x * scale) + b * (local.y * scale) + n * local.z, n);
}

// Every texture of a material, or the neutral value where it has none.
struct Samples {
    base_color: vec4f,
    roughness: f32,
    metallic: f32,
    normal: vec3f,
    occlusion: f32,
    emission: vec3f,
    specular: f32,
    specular_color: vec3f,
    coat: f32,
    coat_roughness: f32,
    coat_normal: vec3f,
    anisotropy: vec3f,
}

fn sample_textures(material: u32, c: Coordinates) -> Samples {
    var s: Samples;
    s.base_color = vec4f(1.0);
    s.roughness = 1.0;
    s.metallic = 1.0;
    s.normal = vec3f(0.5, 0.5, 1.0);
    s.occlusion = 1.0;
    s.emission = vec3f(1.0);
    s.specular = 1.0;
    s.specular_color = vec3f(1.0);
    s.coat = 1.0;
    s.coat_roughness = 1.0;
    s.coat_normal = vec3f(0.5, 0.5, 1.0);
    // Direction (1, 0), full strength.
    s.anisotropy = vec3f(1.0, 0.5, 1.0);
    if materials[material].textures[TEXTURE_BASE_COLOR].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_BASE_COLOR]);
        s.base_color = textureSampleGrad(texture0, sampler0, f.uv, f.dx, f.dy);
    }
    if materials[material].textures[TEXTURE_METALLIC_ROUGHNESS].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_METALLIC_ROUGHNESS]);
        let texel = textureSampleGrad(texture1, sampler1, f.uv, f.dx, f.dy);
        s.roughness = texel.g;
        s.metallic = texel.b;
    }
    if materials[material].textures[TEXTURE_NORMAL].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_NORMAL]);
        s.normal = textureSampleGrad(texture2, sampler2, f.uv, f.dx, f.dy).xyz;
    }
    if materials[material].textures[TEXTURE_OCCLUSION].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_OCCLUSION]);
        s.occlusion = textureSampleGrad(texture3, sampler3, f.uv, f.dx, f.dy).r;
    }
    if materials[material].textures[TEXTURE_EMISSION].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_EMISSION]);
        s.emission = textureSampleGrad(texture4, sampler4, f.uv, f.dx, f.dy).rgb;
    }
    if materials[material].textures[TEXTURE_SPECULAR].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_SPECULAR]);
        s.specular = textureSampleGrad(texture5, sampler5, f.uv, f.dx, f.dy).a;
    }
    if materials[material].textures[TEXTURE_SPECULAR_COLOR].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_SPECULAR_COLOR]);
        s.specular_color = textureSampleGrad(texture6, sampler6, f.uv, f.dx, f.dy).rgb;
    }
    if materials[material].textures[TEXTURE_COAT].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_COAT]);
        s.coat = textureSampleGrad(texture7, sampler7, f.uv, f.dx, f.dy).r;
    }
    if materials[material].textures[TEXTURE_COAT_ROUGHNESS].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_COAT_ROUGHNESS]);
        s.coat_roughness = textureSampleGrad(texture8, sampler8, f.uv, f.dx, f.dy).g;
    }
    if materials[material].textures[TEXTURE_COAT_NORMAL].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_COAT_NORMAL]);
        s.coat_normal = textureSampleGrad(texture9, sampler9, f.uv, f.dx, f.dy).xyz;
    }
    if materials[material].textures[TEXTURE_ANISOTROPY].present != 0u {
        let f = footprint(c, materials[material].textures[TEXTURE_ANISOTROPY]);
        s.anisotropy = textureSampleGrad(texture10, sampler10, f.uv, f.dx, f.dy).xyz;
    }
    return s;
}

// Without it no material has bumps, and their code is left out.
override bumpy: bool = true;

// Bumps in the frame of the object, in metres, so that they move with it; the gradient is in the world. The frame is
// what is left of the transform without scale and shear.
fn bumps_at(in: VertexOut, m: MaterialData, footprint: f32) -> MicroNormal {
    let world_from_local = instances[in.instance].world_from_local;
    let axis = safe_normalize(world_from_local[0].xyz, vec3f(1.0, 0.0, 0.0));
    let own = frame_with_tangent(axis, world_from_local[1].xyz);
    let p = frame_to_local(own, in.position - world_from_local[3].xyz);
    var bumps = micro_normal_eval(m.micro_normal, p, m.micro_size, footprint);
    bumps.gradient = frame_to_world(own, bumps.gradient);
    return bumps;
}

// Must be called in uniform control flow: it takes derivatives.
fn resolve(in: VertexOut, front_facing: bool) -> Texel {
    let c = Coordinates(
        in.uv0, dpdx(in.uv0), dpdy(in.uv0),
        in.uv1, dpdx(in.uv1), dpdy(in.uv1),
    );
    let face = cross(dpdx(in.position), dpdy(in.position));
    let material = instances[in.instance].material;
    let m = materials[material];
    let s = sample_textures(material, c);
    let to_viewer = view.viewer.xyz - in.position * view.viewer.w;

    // The frame of the front. Seen from behind, the bent normal turns round as a whole: a bump is a dent there.
    let side = select(-1.0, 1.0, front_facing);
    let n = safe_normalize(in.normal, vec3f(0.0, 1.0, 0.0));
    let frame = frame_with_tangent(n, in.tangent.xyz);
    let t = frame.t;
    let b = frame.b * in.tangent.w;

    var texel: Texel;
    texel.id = in.instance + 1u;
    texel.normal = side * perturbed(s.normal, m.normal_scale, n, t, b);
    texel.coat_normal = side * perturbed(s.coat_normal, m.coat_normal_scale, n, t, b);
    let geometric = safe_normalize(face, side * n);
    texel.geometric_normal = select(-geometric, geometric, dot(geometric, to_viewer) >= 0.0);
    // The coat lies smooth over the bumps.
    var lost = 0.0;
    if bumpy {
        let bumps = bumps_at(in, m, sqrt(length(face)));
        texel.normal = micro_normal_bent(texel.normal, texel.geometric_normal, side * m.micro_depth * bumps.gradient);
        lost = bumps.lost;
    }

    let turn = vec2f(cos(m.anisotropy_rotation), sin(m.anisotropy_rotation));
    let direction = s.anisotropy.xy * 2.0 - 1.0;
    let axis = vec2f(direction.x * turn.x - direction.y * turn.y, direction.x * turn.y + direction.y * turn.x);
    let along = t * axis.x + b * axis.y;
    texel.tangent = frame_with_tangent(texel.normal, along).t;

    let base = m.base_color * in.color.rgb * s.base_color.rgb;
    texel.opacity = m.opacity * in.color.a * s.base_color.a;
    let roughness = clamp(m.roughness * s.roughness, 0.0, 1.0);
    let strength = clamp(m.anisotropy * s.anisotropy.z, 0.0, 1.0);
    let alpha = roughness * roughness;
    texel.alpha = max(vec2f(mix(alpha, 1.0, strength * strength), alpha), vec2f(GGX_ALPHA_MIN));
    texel.exponent = m.exponent;
    let is_ggx = (m.flags >> MATERIAL_LOBE_SHIFT) == LAYERED_GGX;
    if !is_ggx {
        texel.alpha = vec2f(blinn_phong_alpha(m.exponent));
    }
    if lost > 0.0 {
        texel.alpha = micro_normal_widened(texel.alpha, m.micro_depth, lost);
        texel.exponent = select(blinn_phong_exponent(texel.alpha.x), 0.0, is_ggx);
    }
    texel.metallic = select(clamp(m.metallic * s.metallic, 0.0, 1.0), 1.0, (m.flags & MATERIAL_PRESET) != 0u);
    texel.base_color = clamp(base, vec3f(0.0), vec3f(1.0));
    texel.occlusion = 1.0 + m.occlusion_strength * (s.occlusion - 1.0);
    texel.emission = m.emission * s.emission;
    texel.coat = clamp(m.coat * s.coat, 0.0, 1.0);
    let coat_roughness = clamp(m.coat_roughness * s.coat_roughness, 0.0, 1.0);
    texel.coat_alpha = max(coat_roughness * coat_roughness, GGX_ALPHA_MIN);
    let weight = clamp(m.specular * s.specular, 0.0, 1.0);
    texel.dielectric_f0 = dielectric_f0(m.ior, weight, m.specular_color * s.specular_color);
    texel.dielectric_f90 = weight;
    if (m.flags & MATERIAL_UNLIT) != 0u {
        texel.emission = base;
        texel.base_color = vec3f(0.0);
        texel.metallic = 0.0;
        texel.coat = 0.0;
        texel.dielectric_f0 = vec3f(0.0);
        texel.dielectric_f90 = 0.0;
    }
    return texel;
}

// Opacity below the cutoff of a masked material.
fn cut_away(texel: Texel, instance: u32) -> bool {
    let m = materials[instances[instance].material];
    return (m.flags & MATERIAL_MASK) != 0u && texel.opacity < m.alpha_cutoff;
}
