//! Environment maps, infinitely far away: prefiltered with the GGX lobe, or sampled per pixel.
//!
//! What the method is and where it is wrong stands in `README.md`. The renderer runs the WGSL twin over cube maps; the
//! Rust functions here take the maps as a trait, so that tests can put formulas in their place.

mod cubes;
mod evaluate;
pub mod exact;
mod point;
mod sources;
#[cfg(test)]
mod tests;

use std::sync::LazyLock;

use glam::Vec3;

use super::{Cover, Coverage, Method, MethodError, MethodId, MethodInfo, Prepared, Reads, ShadePoint};
use crate::job::Handle;
use crate::leaf::Leaf;
use crate::material::preset::{FormChoice, Tolerance};
use crate::param::{Affects, ParamKind, ParamSpec, ParamValue, Settings};
use crate::reference::{Contribution, World};
use crate::surface::fresnel::Fresnel;
use crate::surface::ggx::Masking;
use crate::surface::ggx::albedo::{ALBEDO_ALPHA, ALBEDO_MU, ALBEDO_ROOT_MIN};
use crate::surface::ggx::reflection::{CURVE_SIZE, CosineWeights, sample_curve};
use crate::surface::layered;

pub use cubes::{CubeSizes, IRRADIANCE_FACE, PreparedMaps, cube_scale, prepare as prepare_map};
pub use evaluate::{Lobes, Maps, MeanFresnel, OVERLAP, environment, footprint, prefilter};
pub(in crate::lighting) use evaluate::{facing, multiple_albedo, reflection_occlusion, width};
pub use sources::{PREFILTER_SOURCES, SHADING_SOURCES, Source, Split, split};

/// Id of the method, as documents name it.
pub const ID: &str = "classical";

/// The method as others see it.
#[derive(Debug)]
pub struct Classical;

static INFO: MethodInfo = MethodInfo {
    id: MethodId(ID),
    title: "Classical",
    summary: "Prefiltered or sampled environment maps, infinitely far away; lamps by shadow maps.",
    params: PARAMS,
    coverage: Coverage {
        lamps: Cover::Approximate,
        environment: Cover::Approximate,
        indirect_diffuse: Cover::None,
        indirect_glossy: Cover::None,
        emission: Cover::Exact,
    },
    // For pictures on the processor; the device makes cubes of its own.
    reads: Reads { sky: true, ..Reads::NOTHING },
    revision: 1,
};

impl Method for Classical {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn prepare(&self, world: &World, _: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        match &world.scene().environment {
            Some(map) if map.width > 0 && map.height > 0 => cubes::prepare(map, job),
            _ => Ok(Prepared::nothing()),
        }
    }

    fn points(&self) -> Option<&dyn ShadePoint> {
        Some(self)
    }
}

/// The WGSL twin.
pub static WGSL: Leaf = Leaf {
    name: "classical",
    source: include_str!("classical.wgsl"),
    needs: &[&layered::WGSL],
    externs: "
fn classical_radiance(direction: vec3f, level: f32) -> vec3f { return vec3f(1.0); }
fn classical_dimmed(direction: vec3f, level: f32) -> vec3f { return vec3f(1.0); }
fn classical_prefiltered(direction: vec3f, level: f32) -> vec3f { return vec3f(1.0); }
fn classical_irradiance(direction: vec3f) -> vec3f { return vec3f(PI); }
fn classical_source(index: u32) -> mat2x3f { return mat2x3f(vec3f(0.0, 1.0, 0.0), vec3f(1.0)); }
",
};

/// Samples per pixel and frame when nothing is set.
const SAMPLES: u32 = 16;

/// How microfacets mask each other: a property of the surface, shared by methods that draw the same one.
pub const MASKING: ParamSpec = ParamSpec {
    key: "masking",
    label: "Masking",
    unit: "",
    kind: ParamKind::Choice { options: &["correlated", "separable"], default: 0 },
    help: "Smith masking-shadowing: height-correlated, or the product of both sides.",
    affects: Affects::Frame,
};

/// Whether light bounces between microfacets; shared likewise.
pub const MULTIPLE_SCATTERING: ParamSpec = ParamSpec {
    key: "multiple-scattering",
    label: "Multiple scattering",
    unit: "",
    kind: ParamKind::Choice { options: &["on", "off"], default: 0 },
    help: "Light that bounces between microfacets (reciprocal Kulla-Conty form).",
    affects: Affects::Frame,
};

/// Settings of this method.
pub const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        key: "samples",
        label: "Samples",
        unit: "per pixel and frame",
        kind: ParamKind::Integer { min: 0, max: 1024, default: SAMPLES as i64 },
        help: "0 looks up the prefiltered map once (split sum); more draws that many visible normals per pixel and \
               reads the map at the level of each sample's footprint.",
        affects: Affects::Frame,
    },
    MASKING,
    MULTIPLE_SCATTERING,
    ParamSpec {
        key: "fresnel",
        label: "Fresnel form",
        unit: "",
        kind: ParamKind::Choice { options: &FormChoice::IDS, default: 0 },
        help: "Form in which metal presets are rendered; it is resolved into the materials before the scene is drawn. \
               cheapest: the cheapest form of each metal within the two tolerances; spectral: the truth.",
        affects: Affects::Materials,
    },
    ParamSpec {
        key: "fresnel-error",
        label: "Fresnel error",
        unit: "%",
        kind: ParamKind::Number { min: 0.0, max: 100.0, default: 1.0 },
        help: "Largest relative error over red, green, blue and angle that the cheapest form of a metal may have.",
        affects: Affects::Materials,
    },
    ParamSpec {
        key: "fresnel-delta-e",
        label: "Fresnel ΔE",
        unit: "CIEDE2000",
        kind: ParamKind::Number { min: 0.0, max: 100.0, default: 1.0 },
        help: "Largest colour difference on a ball that the cheapest form of a metal may have; 1 is about to be seen.",
        affects: Affects::Materials,
    },
];

/// What the cheapest Fresnel form may err by, from settings made of [`PARAMS`].
pub fn tolerance(settings: &Settings) -> Tolerance {
    let number = |key: &str, otherwise: f64| match settings.get(key) {
        Some(ParamValue::Number(v)) => v,
        _ => otherwise,
    };
    let or = Tolerance::default();
    let relative = 0.01 * number("fresnel-error", 100.0 * or.relative);
    Tolerance { relative, delta_e: number("fresnel-delta-e", or.delta_e) }
}

/// The Fresnel form that settings made of [`PARAMS`] choose.
pub fn form_choice(settings: &Settings) -> FormChoice {
    let tolerance = tolerance(settings);
    let text = settings.text("fresnel").unwrap_or_default();
    FormChoice::read(&text, tolerance).unwrap_or(FormChoice::Cheapest(tolerance))
}

/// The settings as a frame reads them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameSettings {
    /// Samples per pixel and frame, 0 for the split sum.
    pub samples: u32,
    /// Smith masking.
    pub masking: Masking,
    /// Light that bounces between microfacets.
    pub multiple_scattering: bool,
    /// Whose light the picture shows; no setting of the method.
    pub contribution: Contribution,
}

impl FrameSettings {
    /// Reads settings made of [`PARAMS`]; what is not there keeps its default.
    pub fn new(settings: &Settings) -> FrameSettings {
        let samples = match settings.get("samples") {
            Some(ParamValue::Integer(n)) => u32::try_from(n).unwrap_or(SAMPLES),
            _ => SAMPLES,
        };
        let masking = match settings.text("masking").as_deref() {
            Some("separable") => Masking::Separable,
            _ => Masking::Correlated,
        };
        let multiple_scattering = settings.text("multiple-scattering").as_deref() != Some("off");
        FrameSettings { samples, masking, multiple_scattering, contribution: Contribution::All }
    }
}

/// Level of the prefiltered cube for a roughness in [0, 1]: fine steps where the lobe changes fast.
pub fn level(roughness: f32, levels: f32) -> f32 {
    let r = roughness.clamp(0.0, 1.0);
    (levels - 1.0) * r * (2.0 - r)
}

/// Roughness that a level of the prefiltered cube is filtered for, the inverse of [`level`].
pub fn roughness(level: f32, levels: f32) -> f32 {
    1.0 - (1.0 - level / (levels - 1.0).max(1.0)).clamp(0.0, 1.0).sqrt()
}

/// Samples for a texel of a prefiltered level: coarse levels have few texels and wide lobes.
pub fn prefilter_samples(level: u32) -> u32 {
    64 << level.min(5)
}

/// Angle that a block of `block` texels of a map of `width` columns fills at the horizon, in radians.
pub fn block_angle(width: u32, block: u32) -> f32 {
    std::f32::consts::TAU * block as f32 / width.max(1) as f32
}

/// Width from which such a block is a point to the lobe of a pixel: one and a half blocks.
pub fn wide_alpha(width: u32, block: u32) -> f32 {
    1.5 * block_angle(width, block)
}

/// Edge in texels of the blocks that are [`split`] off for shading: a 256th of the map's width, 1.4 degrees.
pub fn shading_block(width: u32) -> u32 {
    (width / 256).max(1)
}

/// Nodes of the cosine weights behind [`mean_fresnel_table`], per masking.
static WEIGHTS: LazyLock<[Vec<CosineWeights>; 2]> = LazyLock::new(|| {
    let mut weights = [Vec::new(), Vec::new()];
    for j in 0..ALBEDO_ALPHA {
        for i in 0..ALBEDO_MU {
            let x = f64::from(i) / f64::from(ALBEDO_MU - 1);
            let y = f64::from(j) / f64::from(ALBEDO_ALPHA - 1);
            let root_min = f64::from(ALBEDO_ROOT_MIN);
            let alpha = (root_min + y * (1.0 - root_min)).powi(4);
            // The lowest node stands for grazing views, where the albedo itself is 0.
            let [correlated, separable] = CosineWeights::new((x * x).max(1e-6), alpha);
            weights[0].push(correlated);
            weights[1].push(separable);
        }
    }
    weights
});

/// A node of [`mean_fresnel_table`]: column `i` of row `j`.
fn mean_fresnel_node(curve: &[Vec3; CURVE_SIZE], masking: Masking, i: usize, j: usize) -> Vec3 {
    let weights = &WEIGHTS[masking as usize][j * ALBEDO_MU as usize + i];
    weights.albedo(curve) / weights.albedo(&[Vec3::ONE; CURVE_SIZE]).max(Vec3::splat(1e-12))
}

/// Mean of a Fresnel curve over the light that a GGX lobe reflects, as the split sum looks it up: three grids (R, G, B)
/// of `ALBEDO_ALPHA` rows of `ALBEDO_MU`, over the square root of the cosine and the fourth root of alpha as
/// the GGX albedo table lays out its Schlick ratio. Multiplied by the albedo for F = 1 it is the directional albedo.
pub fn mean_fresnel_table(fresnel: &Fresnel, masking: Masking) -> Vec<f32> {
    let curve = sample_curve(|x| fresnel.eval(x));
    let nodes = (0..ALBEDO_ALPHA as usize).flat_map(|j| (0..ALBEDO_MU as usize).map(move |i| (i, j)));
    let means: Vec<_> = nodes.map(|(i, j)| mean_fresnel_node(&curve, masking, i, j)).collect();
    (0..3).flat_map(|c| means.iter().map(move |mean| mean[c])).collect()
}
