// Structs shared with the CPU. Each has a repr(C) twin of the same name in types.rs; a test compares them.

const TEXTURE_COUNT: u32 = 11u;
const TEXTURE_BASE_COLOR: u32 = 0u;
const TEXTURE_METALLIC_ROUGHNESS: u32 = 1u;
const TEXTURE_NORMAL: u32 = 2u;
const TEXTURE_OCCLUSION: u32 = 3u;
const TEXTURE_EMISSION: u32 = 4u;
const TEXTURE_SPECULAR: u32 = 5u;
const TEXTURE_SPECULAR_COLOR: u32 = 6u;
const TEXTURE_COAT: u32 = 7u;
const TEXTURE_COAT_ROUGHNESS: u32 = 8u;
const TEXTURE_COAT_NORMAL: u32 = 9u;
const TEXTURE_ANISOTROPY: u32 = 10u;

const MATERIAL_PRESET: u32 = 1u;
const MATERIAL_UNLIT: u32 = 2u;
const MATERIAL_MASK: u32 = 4u;
const MATERIAL_BLEND: u32 = 8u;
// From here on the flags hold the number of the lobe.
const MATERIAL_LOBE_SHIFT: u32 = 8u;

const LIGHT_POINT: u32 = 0u;
const LIGHT_SPOT: u32 = 1u;
const LIGHT_DIRECTIONAL: u32 = 2u;
const LIGHT_RECTANGLE: u32 = 3u;
const LIGHT_SPHERE: u32 = 4u;
// Directional with an angle.
const LIGHT_SUN: u32 = 5u;
// Flags of a light: the eye sees it; it adds to specular lobes.
const LIGHT_CAMERA: u32 = 1u;
const LIGHT_REFLECTIONS: u32 = 2u;
// Whose light a picture shows; lights follow the first.
const CONTRIBUTION_ALL: u32 = 0u;
const CONTRIBUTION_ENVIRONMENT: u32 = 1u;
const CONTRIBUTION_EMISSION: u32 = 2u;
const CONTRIBUTION_LIGHT: u32 = 3u;
// A light without a shadow map has this first layer.
const SHADOW_NONE: u32 = 0xffffffffu;
// Instance of a ray that meets nothing.
const HIT_NONE: u32 = 0xffffffffu;

struct ViewData {
    clip_from_world: mat4x4f,
    world_from_clip: mat4x4f,
    // Homogeneous viewer: w = 1 a point, w = 0 the direction towards an orthographic viewer.
    viewer: vec4f,
    // Factor from a texel of the environment to radiance; number of levels of the radiance cube; rotation: cosine and sine.
    environment_scale: vec3f,
    environment_mips: f32,
    environment_cos: f32,
    environment_sin: f32,
    size: vec2f,
    light_count: u32,
    samples: u32,
    masking: u32,
    multiple_scattering: u32,
    // Index of the jittered frame, from 0: seeds the sample rotation.
    frame: u32,
    prefiltered_mips: f32,
    // Bright sources of the environment, and the width from which they are points to a lobe.
    source_count: u32,
    wide_alpha: f32,
    // One of the CONTRIBUTION_ constants.
    contribution: u32,
    // Words of a light in the list of the instances that it leaves out; 0 when all light everything.
    unlit_words: u32,
    // Lookups of a soft shadow: for what blocks, and for the share that is lit. Not constants: some drivers would write
    // each of them out.
    soft_searched: u32,
    soft_filtered: u32,
}

// What the eye sees behind everything.
struct BackgroundData {
    // Factor from a texel of its map to radiance.
    scale: vec3f,
    // 1 where it has a map of its own.
    mapped: u32,
    // Of the dome, in the world.
    center: vec3f,
    // Of the centre above the ground.
    height: f32,
    // Rotation of the map.
    cos: f32,
    sin: f32,
    // Of the dome, 0 for none.
    radius: f32,
    pad0: u32,
}

// How a picture is shown.
struct DisplayData {
    // From summed to exposed radiance.
    factor: f32,
    // One of the TONE_ constants.
    tone: u32,
    // One of the DISPLAY_ constants.
    mode: u32,
    // The same for the picture that fades out.
    before: f32,
}

// A small bright source of the environment, in its own frame.
struct SourceData {
    direction: vec3f,
    pad0: u32,
    // Radiance times solid angle, over the scale of the cubes.
    power: vec3f,
    pad1: u32,
}

// One step of building the cubes of an environment.
struct EnvironmentStep {
    // Levels of the radiance cube.
    levels: f32,
    // GGX width of the level that is written.
    alpha: f32,
    samples: u32,
    // Factor that brings the source into the range of half floats.
    scale: f32,
    // Sources to add to a filtered level.
    sources: u32,
    // Number of the first tile of 8 by 8 texels, or its place in the list.
    first_tile: u32,
    // 1 when only the listed tiles are written.
    listed: u32,
    // Rows of the equirectangular map.
    rows: u32,
}

struct TextureSlot {
    // Columns of the 2x2 part of the coordinate transform.
    matrix: vec4f,
    offset: vec2f,
    uv_set: u32,
    present: u32,
}

struct MaterialData {
    base_color: vec3f,
    opacity: f32,
    emission: vec3f,
    metallic: f32,
    specular_color: vec3f,
    specular: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    alpha_cutoff: f32,
    coat: f32,
    coat_roughness: f32,
    coat_normal_scale: f32,
    ior: f32,
    anisotropy: f32,
    anisotropy_rotation: f32,
    flags: u32,
    fresnel_form: u32,
    fresnel_f0: vec3f,
    // First entry of the spectral table.
    fresnel_table: u32,
    // Coefficients of the form.
    fresnel_c0: vec3f,
    // First entry of the split-sum table.
    albedo_table: u32,
    fresnel_c1: vec3f,
    // One of the MICRO_NORMAL_ kinds.
    micro_normal: u32,
    fresnel_c2: vec3f,
    // In metres.
    micro_size: f32,
    fresnel_c3: vec3f,
    // Root mean square slope.
    micro_depth: f32,
    fresnel_mean: vec3f,
    // Of the lobe, where it is not GGX.
    exponent: f32,
    textures: array<TextureSlot, 11>,
}

struct InstanceData {
    world_from_local: mat4x4f,
    // Inverse transpose of the linear part, columns; the w of the first is the sign of the determinant.
    normal0: vec4f,
    normal1: vec4f,
    normal2: vec4f,
    material: u32,
    // A bit for each probe that serves it.
    probes: u32,
    pad1: u32,
    pad2: u32,
}

// A probe, and what is known of its surroundings as a whole.
struct ProbeData {
    middle: vec3f,
    index: u32,
    low: vec3f,
    near: f32,
    high: vec3f,
    far: f32,
    radius: f32,
    scale: f32,
    face: u32,
    radiance_mips: f32,
    prefiltered_mips: f32,
    source_count: u32,
    wide_alpha: f32,
    // Of surfaces: 2 where what lies behind them is known.
    layers: u32,
}

const AREA_CUBE_FEW: u32 = 1u;
const AREA_CUBE_CORRECTED: u32 = 2u;
const AREA_CUBE_NORMALIZED: u32 = 4u;
const AREA_CUBE_MIDDLES: u32 = 8u;

// How the surroundings of a probe are looked up.
struct EffortData {
    solver: u32,
    refinements: u32,
    steps: u32,
    tolerance: f32,
    show: u32,
    // Of the method area-cube: texels along an edge, and AREA_CUBE_ flags.
    edge: u32,
    flags: u32,
    pad0: u32,
}

const MAP_SMOOTH: u32 = 1u;
const MAP_BOX: u32 = 2u;
const MAP_UNGUARDED: u32 = 4u;
const MAP_FLOATS: u32 = 8u;
const MAP_ALL: u32 = 0u;
const MAP_QUERY: u32 = 1u;
const MAP_SEARCH: u32 = 2u;
const MAP_FILTER: u32 = 3u;
const MAP_NOTHING: u32 = 4u;

// A baked radiance map in a list of words, and how it is looked up.
struct MapData {
    low: vec3f,
    // Of a cell of the grid, metres.
    edge: f32,
    size: vec3u,
    places: u32,
    directions: u32,
    reach: f32,
    // MAP_ flags.
    flags: u32,
    // Directions drawn from the surface.
    lobes: u32,
    // Factor on the light of a group, and the word where that begins.
    environment_color: vec3f,
    environment: u32,
    lamps_color: vec3f,
    lamps: u32,
    glow_color: vec3f,
    glow: u32,
    // From a number of each group to its radiance; 0 where it is dark or switched off.
    scales: vec3f,
    // Width of the lobe below which rays are sent.
    below: f32,
    // Words where things begin.
    starts: u32,
    neighbours: u32,
    positions: u32,
    normals: u32,
    drawn: u32,
    lists: u32,
    // What is done of a lookup: MAP_ALL, or a part to be timed.
    part: u32,
    pad0: u32,
}

// A material as rays find it, with the means of its textures.
struct MetData {
    base_color: vec3f,
    metallic: f32,
    emission: vec3f,
    dielectric_f90: f32,
    dielectric_f0: vec3f,
    coat: f32,
    alpha: vec2f,
    coat_alpha: f32,
    pad0: u32,
}

struct LightData {
    position: vec3f,
    kind: u32,
    direction: vec3f,
    // Cut-off distance in metres, 0 for none.
    range: f32,
    // Candela, lux, or nit of a light with an area, times colour.
    intensity: vec3f,
    // Cone: factor = clamp(cos * spot_scale + spot_offset).
    spot_scale: f32,
    // Unit, along a side of a rectangle; x of the cube of shadow maps.
    across: vec3f,
    spot_offset: f32,
    // Full sides of a rectangle; radius of a sphere, sine of a sun.
    size: vec2f,
    // First layer of the shadow array, or SHADOW_NONE: six for a point or a sphere, five for a rectangle.
    shadow_layer: u32,
    // World size of a shadow texel at distance 1, everywhere for directional lights.
    shadow_texel: f32,
    // LIGHT_ flags.
    flags: u32,
    // Metres of the near plane, or from near to far for directional lights.
    shadow_depth: f32,
    pad0: u32,
    pad1: u32,
}

// Points origin + t direction with 0 <= t < t_max.
struct RayData {
    origin: vec3f,
    t_max: f32,
    direction: vec3f,
    pad0: u32,
}

struct HitData {
    // Along the ray.
    t: f32,
    // Index into the scene, or HIT_NONE.
    instance: u32,
    // Place in its mesh.
    triangle: u32,
    pad0: u32,
    // Weights of the second and third corner.
    barycentric: vec2f,
    pad1: u32,
    pad2: u32,
}
