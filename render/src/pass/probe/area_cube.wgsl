// Adds to surfaces that a probe serves the light of its coarse cube, whose texels are lights with an area.

@group(2) @binding(10) var<storage, read> cube_texels: array<vec4f>;
@group(2) @binding(11) var<storage, read> cube_tables: array<f32>;

// How the texel is found that a reflection meets, as the processor does it.
const AREA_CUBE_REFINEMENTS: u32 = 2u;
const AREA_CUBE_TOLERANCE: f32 = 0.05;

fn area_cube_entry(index: u32) -> f32 {
    return cube_tables[index];
}

fn area_cube_texel(index: u32) -> mat3x4f {
    // After the cubes with fewer texels along an edge: 6 n^2 for each n of 2, 4, 8 ... below this one.
    let first = 3u * (2u * (given.edge * given.edge - 4u) + index);
    return mat3x4f(cube_texels[first], cube_texels[first + 1u], cube_texels[first + 2u]);
}

// In which direction the probe sees what the reflection of a lobe of width `alpha` meets.
fn met(n: vec3f, eye: vec3f, alpha: f32) -> vec3f {
    // Wide lobes lean toward the normal, where the cosine is larger.
    let direction = normalize(mix(reflect(-eye, n), n, alpha * alpha));
    let two = ImpostorEffort(IMPOSTOR_SECANT, AREA_CUBE_REFINEMENTS, 1u, AREA_CUBE_TOLERANCE);
    return impostor_direction(impostor_solve(extent(), from_middle, direction, two), from_middle, direction);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = served(position);
    if at.weight <= 0.0 {
        discard;
    }
    let t = at.texel;
    let eye = to_viewer(at.point);
    let m = materials[instances[t.id - 1u].material];
    let s = surface_of(t, m);
    let base = Frame(t.tangent, cross(t.normal, t.tangent), t.normal);
    let coat = frame_new(t.coat_normal);
    let asked = AreaCubeAsked(
        given.edge, (given.flags & AREA_CUBE_FEW) != 0u, (given.flags & AREA_CUBE_CORRECTED) != 0u,
        (given.flags & AREA_CUBE_NORMALIZED) != 0u, (given.flags & AREA_CUBE_MIDDLES) != 0u,
    );
    var looked = AreaCubeLooked(from_middle, base.n, coat.n);
    if asked.few {
        looked.base = met(base.n, eye, sqrt(s.alpha.x * s.alpha.y));
        looked.coat = met(coat.n, eye, s.coat_alpha);
    }
    let value = area_cube_reflected(s, base, coat, eye, t.occlusion, looked, asked);
    return vec4f(min(at.weight * value, vec3f(frame_max)), 0.0);
}
