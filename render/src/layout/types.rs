//! The `repr(C)` twins of `types.wgsl`, with their fields listed so that a test can compare offsets.

use burnish_core::material::TextureRole;
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, UVec3, Vec2, Vec3, Vec4};

/// A field of a shared struct.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Name in both languages.
    pub name: &'static str,
    /// Bytes from the start of the struct.
    pub offset: usize,
    /// Bytes.
    pub size: usize,
}

/// A struct that both languages declare.
#[derive(Debug, Clone, Copy)]
pub struct Struct {
    /// Name in both languages.
    pub name: &'static str,
    /// Bytes of the whole.
    pub size: usize,
    /// Fields in order.
    pub fields: &'static [Field],
}

macro_rules! shared {
    ($(#[$doc:meta])* pub struct $name:ident { $($field:ident: $kind:ty),* $(,)? }) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Pod, Zeroable)]
        pub struct $name { $(#[allow(missing_docs)] pub $field: $kind),* }

        impl $name {
            /// Layout for the comparison with WGSL.
            pub const LAYOUT: Struct = Struct {
                name: stringify!($name),
                size: size_of::<$name>(),
                fields: &[$(Field {
                    name: stringify!($field),
                    offset: std::mem::offset_of!($name, $field),
                    size: size_of::<$kind>(),
                }),*],
            };
        }
    };
}

/// Every shared struct.
pub const STRUCTS: &[Struct] = &[
    ViewData::LAYOUT,
    BackgroundData::LAYOUT,
    DisplayData::LAYOUT,
    SourceData::LAYOUT,
    EnvironmentStep::LAYOUT,
    TextureSlot::LAYOUT,
    MaterialData::LAYOUT,
    InstanceData::LAYOUT,
    ProbeData::LAYOUT,
    EffortData::LAYOUT,
    MapData::LAYOUT,
    MetData::LAYOUT,
    LightData::LAYOUT,
    RayData::LAYOUT,
    HitData::LAYOUT,
];

/// Every shared constant with its value.
pub const CONSTANTS: &[(&str, u32)] = &[
    ("TEXTURE_COUNT", TEXTURE_COUNT as u32),
    ("TEXTURE_BASE_COLOR", TextureRole::BaseColor as u32),
    ("TEXTURE_METALLIC_ROUGHNESS", TextureRole::MetallicRoughness as u32),
    ("TEXTURE_NORMAL", TextureRole::Normal as u32),
    ("TEXTURE_OCCLUSION", TextureRole::Occlusion as u32),
    ("TEXTURE_EMISSION", TextureRole::Emission as u32),
    ("TEXTURE_SPECULAR", TextureRole::Specular as u32),
    ("TEXTURE_SPECULAR_COLOR", TextureRole::SpecularColor as u32),
    ("TEXTURE_COAT", TextureRole::Coat as u32),
    ("TEXTURE_COAT_ROUGHNESS", TextureRole::CoatRoughness as u32),
    ("TEXTURE_COAT_NORMAL", TextureRole::CoatNormal as u32),
    ("TEXTURE_ANISOTROPY", TextureRole::Anisotropy as u32),
    ("MATERIAL_PRESET", MATERIAL_PRESET),
    ("MATERIAL_UNLIT", MATERIAL_UNLIT),
    ("MATERIAL_MASK", MATERIAL_MASK),
    ("MATERIAL_BLEND", MATERIAL_BLEND),
    ("MATERIAL_LOBE_SHIFT", MATERIAL_LOBE_SHIFT),
    ("LIGHT_POINT", LIGHT_POINT),
    ("LIGHT_SPOT", LIGHT_SPOT),
    ("LIGHT_DIRECTIONAL", LIGHT_DIRECTIONAL),
    ("LIGHT_RECTANGLE", LIGHT_RECTANGLE),
    ("LIGHT_SPHERE", LIGHT_SPHERE),
    ("LIGHT_SUN", LIGHT_SUN),
    ("LIGHT_CAMERA", LIGHT_CAMERA),
    ("LIGHT_REFLECTIONS", LIGHT_REFLECTIONS),
    ("CONTRIBUTION_ALL", CONTRIBUTION_ALL),
    ("CONTRIBUTION_ENVIRONMENT", CONTRIBUTION_ENVIRONMENT),
    ("CONTRIBUTION_EMISSION", CONTRIBUTION_EMISSION),
    ("CONTRIBUTION_LIGHT", CONTRIBUTION_LIGHT),
    ("SHADOW_NONE", SHADOW_NONE),
    ("AREA_CUBE_FEW", AREA_CUBE_FEW),
    ("AREA_CUBE_CORRECTED", AREA_CUBE_CORRECTED),
    ("AREA_CUBE_NORMALIZED", AREA_CUBE_NORMALIZED),
    ("AREA_CUBE_MIDDLES", AREA_CUBE_MIDDLES),
    ("MAP_SMOOTH", MAP_SMOOTH),
    ("MAP_BOX", MAP_BOX),
    ("MAP_UNGUARDED", MAP_UNGUARDED),
    ("MAP_FLOATS", MAP_FLOATS),
    ("MAP_ALL", MAP_ALL),
    ("MAP_QUERY", MAP_QUERY),
    ("MAP_SEARCH", MAP_SEARCH),
    ("MAP_FILTER", MAP_FILTER),
    ("MAP_NOTHING", MAP_NOTHING),
    ("HIT_NONE", HIT_NONE),
];

/// Textures of a material, in the order of the `TEXTURE_` constants of `types.wgsl`.
pub const TEXTURE_COUNT: usize = TextureRole::ALL.len();
/// The metal part follows a preset; base colour and metallic are bypassed.
pub const MATERIAL_PRESET: u32 = 1;
/// Shows the base colour as emission.
pub const MATERIAL_UNLIT: u32 = 2;
/// Cut at `alpha_cutoff`.
pub const MATERIAL_MASK: u32 = 4;
/// Blended.
pub const MATERIAL_BLEND: u32 = 8;
/// From here on the flags hold the number of the lobe, [`burnish_core::surface::layered::Lobe::numbers`].
pub const MATERIAL_LOBE_SHIFT: u32 = 8;
/// Kind of [`LightData`].
pub const LIGHT_POINT: u32 = 0;
/// Kind of [`LightData`].
pub const LIGHT_SPOT: u32 = 1;
/// Kind of [`LightData`].
pub const LIGHT_DIRECTIONAL: u32 = 2;
/// Kind of [`LightData`].
pub const LIGHT_RECTANGLE: u32 = 3;
/// Kind of [`LightData`].
pub const LIGHT_SPHERE: u32 = 4;
/// Kind of [`LightData`]: directional with an angle.
pub const LIGHT_SUN: u32 = 5;
/// Flag of [`LightData`]: the eye sees it.
pub const LIGHT_CAMERA: u32 = 1;
/// Flag of [`LightData`]: adds to specular lobes.
pub const LIGHT_REFLECTIONS: u32 = 2;
/// All light, in [`ViewData::contribution`].
pub const CONTRIBUTION_ALL: u32 = 0;
/// That of the environment alone.
pub const CONTRIBUTION_ENVIRONMENT: u32 = 1;
/// That of glowing materials alone.
pub const CONTRIBUTION_EMISSION: u32 = 2;
/// That of the first light; of the next one more.
pub const CONTRIBUTION_LIGHT: u32 = 3;
/// `shadow_layer` of a light without a shadow map.
pub const SHADOW_NONE: u32 = u32::MAX;
/// Instance of a ray that meets nothing.
pub const HIT_NONE: u32 = u32::MAX;

/// Light of a map is interpolated between directions.
pub const MAP_SMOOTH: u32 = 1;
/// Places of a map count the same.
pub const MAP_BOX: u32 = 2;
/// Places of a map count wherever they face.
pub const MAP_UNGUARDED: u32 = 4;
/// Light of a map is kept in floats.
pub const MAP_FLOATS: u32 = 8;

/// Part of a lookup that is done: all.
pub const MAP_ALL: u32 = 0;
/// The set of a point is found.
pub const MAP_QUERY: u32 = 1;
/// The nearest places are searched.
pub const MAP_SEARCH: u32 = 2;
/// The light of the set is summed.
pub const MAP_FILTER: u32 = 3;
/// Nothing is looked up.
pub const MAP_NOTHING: u32 = 4;

/// Flag of [`EffortData`]: lobes look at few texels.
pub const AREA_CUBE_FEW: u32 = 1;
/// Flag of [`EffortData`]: minds the angles of surfaces.
pub const AREA_CUBE_CORRECTED: u32 = 2;
/// Flag of [`EffortData`]: even light comes out even.
pub const AREA_CUBE_NORMALIZED: u32 = 4;
/// Flag of [`EffortData`]: lobes are taken at the middles of caps.
pub const AREA_CUBE_MIDDLES: u32 = 8;

shared! {
    /// What changes from frame to frame.
    pub struct ViewData {
        clip_from_world: Mat4,
        world_from_clip: Mat4,
        viewer: Vec4,
        environment_scale: Vec3,
        environment_mips: f32,
        environment_cos: f32,
        environment_sin: f32,
        size: Vec2,
        light_count: u32,
        samples: u32,
        masking: u32,
        multiple_scattering: u32,
        frame: u32,
        prefiltered_mips: f32,
        source_count: u32,
        wide_alpha: f32,
        contribution: u32,
        unlit_words: u32,
        soft_searched: u32,
        soft_filtered: u32,
    }
}

shared! {
    /// What the eye sees behind everything.
    pub struct BackgroundData {
        scale: Vec3,
        mapped: u32,
        center: Vec3,
        height: f32,
        cos: f32,
        sin: f32,
        radius: f32,
        pad0: u32,
    }
}

shared! {
    /// How a picture is shown.
    pub struct DisplayData {
        factor: f32,
        tone: u32,
        mode: u32,
        before: f32,
    }
}

shared! {
    /// A small bright source of the environment, in its own frame.
    pub struct SourceData {
        direction: Vec3,
        pad0: u32,
        power: Vec3,
        pad1: u32,
    }
}

shared! {
    /// One step of building the cubes of an environment.
    pub struct EnvironmentStep {
        levels: f32,
        alpha: f32,
        samples: u32,
        scale: f32,
        sources: u32,
        first_tile: u32,
        listed: u32,
        rows: u32,
    }
}

shared! {
    /// How one texture of a material is read.
    pub struct TextureSlot {
        matrix: Vec4,
        offset: Vec2,
        uv_set: u32,
        present: u32,
    }
}

shared! {
    /// Factors of a material.
    pub struct MaterialData {
        base_color: Vec3,
        opacity: f32,
        emission: Vec3,
        metallic: f32,
        specular_color: Vec3,
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
        fresnel_f0: Vec3,
        fresnel_table: u32,
        fresnel_c0: Vec3,
        albedo_table: u32,
        fresnel_c1: Vec3,
        micro_normal: u32,
        fresnel_c2: Vec3,
        micro_size: f32,
        fresnel_c3: Vec3,
        micro_depth: f32,
        fresnel_mean: Vec3,
        exponent: f32,
        textures: [TextureSlot; TEXTURE_COUNT],
    }
}

shared! {
    /// A placed mesh.
    pub struct InstanceData {
        world_from_local: Mat4,
        normal0: Vec4,
        normal1: Vec4,
        normal2: Vec4,
        material: u32,
        probes: u32,
        pad1: u32,
        pad2: u32,
    }
}

shared! {
    /// A probe, and what is known of its surroundings as a whole.
    pub struct ProbeData {
        middle: Vec3,
        index: u32,
        low: Vec3,
        near: f32,
        high: Vec3,
        far: f32,
        radius: f32,
        scale: f32,
        face: u32,
        radiance_mips: f32,
        prefiltered_mips: f32,
        source_count: u32,
        wide_alpha: f32,
        layers: u32,
    }
}

shared! {
    /// How the surroundings of a probe are looked up.
    pub struct EffortData {
        solver: u32,
        refinements: u32,
        steps: u32,
        tolerance: f32,
        show: u32,
        edge: u32,
        flags: u32,
        pad0: u32,
    }
}

shared! {
    /// A light.
    pub struct LightData {
        position: Vec3,
        kind: u32,
        direction: Vec3,
        range: f32,
        intensity: Vec3,
        spot_scale: f32,
        across: Vec3,
        spot_offset: f32,
        size: Vec2,
        shadow_layer: u32,
        shadow_texel: f32,
        flags: u32,
        shadow_depth: f32,
        pad0: u32,
        pad1: u32,
    }
}

shared! {
    /// A baked radiance map, and how it is looked up.
    pub struct MapData {
        low: Vec3,
        edge: f32,
        size: UVec3,
        places: u32,
        directions: u32,
        reach: f32,
        flags: u32,
        lobes: u32,
        environment_color: Vec3,
        environment: u32,
        lamps_color: Vec3,
        lamps: u32,
        glow_color: Vec3,
        glow: u32,
        scales: Vec3,
        below: f32,
        starts: u32,
        neighbours: u32,
        positions: u32,
        normals: u32,
        drawn: u32,
        lists: u32,
        part: u32,
        pad0: u32,
    }
}

shared! {
    /// A material as rays find it, as [`burnish_core::lighting::radiance_map::MetSurface`].
    pub struct MetData {
        base_color: Vec3,
        metallic: f32,
        emission: Vec3,
        dielectric_f90: f32,
        dielectric_f0: Vec3,
        coat: f32,
        alpha: Vec2,
        coat_alpha: f32,
        pad0: u32,
    }
}

shared! {
    /// A ray, as [`burnish_core::trace::Ray`].
    pub struct RayData {
        origin: Vec3,
        t_max: f32,
        direction: Vec3,
        pad0: u32,
    }
}

shared! {
    /// What a ray meets, as [`burnish_core::trace::Hit`]; [`HIT_NONE`] for an instance where that is nothing.
    pub struct HitData {
        t: f32,
        instance: u32,
        triangle: u32,
        pad0: u32,
        barycentric: Vec2,
        pad1: u32,
        pad2: u32,
    }
}
