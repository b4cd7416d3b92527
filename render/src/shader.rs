//! The shaders of the passes: which leaves and which own files each is joined from, in order.

use burnish_core::color::tone;
use burnish_core::leaf::{self, Leaf};
use burnish_core::lighting::{area, area_cube, classical, impostor, probe};
use burnish_core::measure::view;
use burnish_core::scene::environment::ground;
use burnish_core::surface::{fresnel, layered, micro_normal};

/// A shader module, joined from leaves and the pass's own files.
pub struct Shader {
    /// Name for messages.
    pub name: &'static str,
    /// Leaves it uses; what they need comes along.
    pub leaves: &'static [&'static Leaf],
    /// Own files after the leaves.
    pub files: &'static [&'static str],
}

const TYPES: &str = include_str!("layout/types.wgsl");
const TEXEL: &str = include_str!("pass/gbuffer/texel.wgsl");
const RESOLVE: &str = include_str!("pass/gbuffer/resolve.wgsl");
const SURFACE: &str = include_str!("pass/classical/surface.wgsl");
const SHADE: &str = include_str!("pass/classical/shade.wgsl");
const LAMP: &str = include_str!("pass/classical/lamp.wgsl");
const LAMPS: &str = include_str!("pass/classical/lamps.wgsl");
const SOFT: &str = include_str!("pass/classical/soft.wgsl");
const RAYS: &str = include_str!("pass/classical/rays.wgsl");
const IMPOSTOR_LOOK: &str = include_str!("pass/probe/look.wgsl");
const BACKGROUND: &str = include_str!("pass/environment/background.wgsl");

/// Fills the G-buffer.
pub static GBUFFER: Shader = Shader {
    name: "gbuffer",
    leaves: &[&layered::WGSL, &micro_normal::WGSL],
    files: &[NO_TABLES, TYPES, TEXEL, RESOLVE, include_str!("pass/gbuffer/gbuffer.wgsl")],
};

/// Depth from a light.
pub static SHADOW: Shader = Shader {
    name: "shadow",
    leaves: &[&layered::WGSL, &micro_normal::WGSL],
    files: &[NO_TABLES, TYPES, TEXEL, RESOLVE, include_str!("pass/shadow/shadow.wgsl")],
};

/// Builds the cubes of an environment.
pub static ENVIRONMENT: Shader = Shader {
    name: "environment",
    leaves: &[&classical::WGSL],
    files: &[NO_TABLES, NO_CUBES, TYPES, include_str!("pass/environment/environment.wgsl")],
};

/// Lights the G-buffer.
pub static CLASSICAL: Shader = Shader {
    name: "classical",
    leaves: &[&classical::WGSL, &area::WGSL, &ground::LEAF, &probe::WGSL],
    files: &[
        TYPES,
        TEXEL,
        SCENE_BINDINGS,
        SURFACE,
        SHADE,
        LAMP,
        LAMPS,
        SOFT,
        BACKGROUND,
        GBUFFER_BINDINGS,
        RAYS,
        include_str!("pass/classical/classical.wgsl"),
    ],
};

/// Adds what the surroundings of a probe send.
pub static IMPOSTOR: Shader = Shader {
    name: "impostor",
    leaves: &[&classical::WGSL, &probe::WGSL, &impostor::WGSL],
    files: &[
        TYPES,
        TEXEL,
        SCENE_BINDINGS,
        SURFACE,
        GBUFFER_BINDINGS,
        RAYS,
        IMPOSTOR_LOOK,
        include_str!("pass/probe/impostor.wgsl"),
    ],
};

/// Adds the light of a probe's coarse cube.
pub static AREA_CUBE: Shader = Shader {
    name: "area_cube",
    leaves: &[&classical::WGSL, &probe::WGSL, &impostor::WGSL, &area_cube::WGSL],
    files: &[
        TYPES,
        TEXEL,
        SCENE_BINDINGS,
        SURFACE,
        GBUFFER_BINDINGS,
        RAYS,
        IMPOSTOR_LOOK,
        include_str!("pass/probe/area_cube.wgsl"),
    ],
};

/// Shows how far searches are off.
pub static IMPOSTOR_ERROR: Shader = Shader {
    name: "impostor error",
    leaves: &[&classical::WGSL, &probe::WGSL, &impostor::WGSL],
    files: &[
        TYPES,
        TEXEL,
        SCENE_BINDINGS,
        SURFACE,
        GBUFFER_BINDINGS,
        RAYS,
        IMPOSTOR_LOOK,
        "@group(3) @binding(1) var<storage, read> trace_words: array<vec4u>;",
        include_str!("trace/numbers.wgsl"),
        include_str!("trace/trace.wgsl"),
        include_str!("pass/probe/error.wgsl"),
    ],
};

/// Adds the light of a baked map.
pub static RADIANCE_MAP: Shader = Shader {
    name: "radiance map",
    leaves: &[&classical::WGSL],
    files: &[
        TYPES,
        TEXEL,
        SCENE_BINDINGS,
        SURFACE,
        GBUFFER_BINDINGS,
        RAYS,
        LAMP,
        include_str!("trace/numbers.wgsl"),
        include_str!("trace/trace.wgsl"),
        include_str!("pass/radiance_map/lookup.wgsl"),
        include_str!("pass/radiance_map/radiance_map.wgsl"),
    ],
};

/// Shadows on the ground of the background.
pub static CATCHER: Shader = Shader {
    name: "catcher",
    leaves: &[&classical::WGSL, &area::WGSL, &ground::LEAF, &probe::WGSL],
    files: &[
        TYPES,
        TEXEL,
        SCENE_BINDINGS,
        SURFACE,
        SHADE,
        LAMP,
        LAMPS,
        SOFT,
        BACKGROUND,
        RAYS,
        include_str!("pass/catcher/catcher.wgsl"),
    ],
};

/// Blended surfaces.
pub static FORWARD: Shader = Shader {
    name: "forward",
    leaves: &[&classical::WGSL, &area::WGSL, &micro_normal::WGSL, &probe::WGSL],
    files: &[TYPES, TEXEL, RESOLVE, SURFACE, SHADE, LAMP, LAMPS, SOFT, include_str!("pass/forward/forward.wgsl")],
};

/// Adds a frame to the sum.
pub static ACCUMULATE: Shader =
    Shader { name: "accumulate", leaves: &[], files: &[include_str!("pass/accumulate/accumulate.wgsl")] };

/// Shows a picture on a screen.
pub static DISPLAY: Shader = Shader {
    name: "display",
    leaves: &[&tone::LEAF, &view::LEAF],
    files: &[TYPES, include_str!("pass/display/display.wgsl")],
};

/// Looks for what rays meet.
pub static TRACE: Shader = Shader {
    name: "trace",
    leaves: &[],
    files: &[
        TYPES,
        TRACE_BINDING,
        include_str!("trace/numbers.wgsl"),
        include_str!("trace/trace.wgsl"),
        include_str!("trace/pass.wgsl"),
    ],
};

/// Times reflectance curves.
pub static TIMES: Shader =
    Shader { name: "times", leaves: &[&fresnel::WGSL], files: &[include_str!("times/times.wgsl")] };

/// Every shader of the renderer. Tests validate all of them without a device.
pub static ALL: &[&Shader] = &[
    &GBUFFER,
    &SHADOW,
    &ENVIRONMENT,
    &CLASSICAL,
    &IMPOSTOR,
    &IMPOSTOR_ERROR,
    &AREA_CUBE,
    &RADIANCE_MAP,
    &CATCHER,
    &FORWARD,
    &ACCUMULATE,
    &DISPLAY,
    &TRACE,
    &TIMES,
];

/// The bindings of `resolve.wgsl` for passes that draw no vertices.
const SCENE_BINDINGS: &str = "
@group(0) @binding(0) var<uniform> view: ViewData;
@group(0) @binding(1) var<storage, read> instances: array<InstanceData>;
@group(0) @binding(2) var<storage, read> materials: array<MaterialData>;
";

/// The G-buffer as textures.
const GBUFFER_BINDINGS: &str = "
@group(1) @binding(0) var words0: texture_2d<u32>;
@group(1) @binding(1) var words1: texture_2d<u32>;
@group(1) @binding(2) var words2: texture_2d<u32>;
@group(1) @binding(3) var words3: texture_2d<u32>;
@group(1) @binding(4) var depth: texture_depth_2d;
";

/// The buffer of a `TraceTree`.
const TRACE_BINDING: &str = "
@group(0) @binding(0) var<storage, read> trace_words: array<vec4u>;
";

/// Functions that leaves ask for and passes that do not light surfaces never call.
const NO_TABLES: &str = "
fn ggx_albedo_entry(index: u32) -> f32 { return 0.0; }
fn fresnel_table(table: u32, entry: u32) -> vec3f { return vec3f(0.0); }
";
const NO_CUBES: &str = "
fn classical_dimmed(direction: vec3f, level: f32) -> vec3f { return vec3f(0.0); }
fn classical_prefiltered(direction: vec3f, level: f32) -> vec3f { return vec3f(0.0); }
fn classical_irradiance(direction: vec3f) -> vec3f { return vec3f(0.0); }
";

impl Shader {
    /// The whole WGSL text.
    pub fn source(&self) -> String {
        let mut source = leaf::join(self.leaves);
        for file in self.files {
            source.push_str(file);
            source.push('\n');
        }
        source
    }

    /// Compiles it.
    pub fn module(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.source().into()),
        })
    }
}
