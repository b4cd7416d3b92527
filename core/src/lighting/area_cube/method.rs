//! The method: the texels of a probe, coarse, as lights of the objects that it serves.

use std::borrow::Cow;

use glam::Vec3;
use rayon::prelude::*;

use super::{Asked, EDGES, Looked, NUMBERS, Texel, Texels, downsample, reflected};
use crate::job::Handle;
use crate::lighting::classical::{self, Maps, PreparedMaps};
use crate::lighting::impostor::{self, Effort, Solver};
use crate::lighting::probe::{self, Probe, Probes, Sites};
use crate::lighting::{Cover, Coverage, Method, MethodError, MethodId, MethodInfo, Prepared, Reads, ShadePoint};
use crate::math::frame::Frame;
use crate::param::{Affects, ParamKind, ParamSpec, Settings};
use crate::reference::{SurfacePoint, World};
use crate::scene::Scene;

/// Id of the method, as documents name it.
pub const ID: &str = "area-cube";

/// The method as others see it.
#[derive(Debug)]
pub struct AreaCube;

const TEXELS: ParamSpec = ParamSpec {
    key: "texels",
    label: "Texels",
    unit: "along an edge",
    kind: ParamKind::Choice { options: &["2", "4", "8", "16"], default: 1 },
    help: "Of a face of the coarse cube: each of its texels is a light.",
    affects: Affects::Frame,
};

const SUM: ParamSpec = ParamSpec {
    key: "sum",
    label: "Sum",
    unit: "",
    kind: ParamKind::Choice { options: &["all", "few"], default: 0 },
    help: "What a glossy lobe looks at: all texels, or the one that its reflection meets and the four beside it. Matte light \
           is always that of all.",
    affects: Affects::Frame,
};

const CORRECTION: ParamSpec = ParamSpec {
    key: "correction",
    label: "Correction",
    unit: "",
    kind: ParamKind::Choice { options: &["on", "off"], default: 0 },
    help: "Minds under which angle a surface is seen from the point and from the probe; without it walls are too bright.",
    affects: Affects::Frame,
};

const NORMALIZATION: ParamSpec = ParamSpec {
    key: "normalization",
    label: "Normalisation",
    unit: "",
    kind: ParamKind::Choice { options: &["on", "off"], default: 0 },
    help: "Makes even light come out as bright as the surface reflects it, wherever the point is.",
    affects: Affects::Frame,
};

const CAPS: ParamSpec = ParamSpec {
    key: "caps",
    label: "Caps",
    unit: "",
    kind: ParamKind::Choice { options: &["table", "middle"], default: 0 },
    help: "What a glossy lobe is over a texel: its mean, from a table, or its value at the middle, which shows the lights one \
           by one.",
    affects: Affects::Frame,
};

/// Settings of this method: resolution and paths of its probes are those of `impostor`, the last those of `classical`.
pub const PARAMS: &[ParamSpec] = &[
    TEXELS,
    SUM,
    CORRECTION,
    NORMALIZATION,
    CAPS,
    impostor::RESOLUTION,
    impostor::PATHS,
    classical::PARAMS[1],
    classical::PARAMS[2],
    classical::PARAMS[3],
    classical::PARAMS[4],
    classical::PARAMS[5],
];

static INFO: MethodInfo = MethodInfo {
    id: MethodId(ID),
    title: "Localised area cube",
    summary: "Glossy and diffuse light of near surroundings: the texels of a coarse probe as lights with an area.",
    params: PARAMS,
    coverage: Coverage {
        lamps: Cover::None,
        environment: Cover::Approximate,
        indirect_diffuse: Cover::Approximate,
        indirect_glossy: Cover::Approximate,
        emission: Cover::None,
    },
    reads: Reads { probes: true, ..Reads::ALL },
    revision: 2,
};

/// The array of a probe that holds its coarse cubes, those of all [`EDGES`].
pub const ARRAY: &str = "area-cube";
/// Most parts along an edge into which a texel is cut to take its means.
const PARTS_MAX: u32 = 64;

impl Method for AreaCube {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn prepare(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        record(world, &impostor::sites(world.scene(), settings), job)
    }

    fn drafts(&self) -> bool {
        true
    }

    fn draft(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        record(world, &impostor::sites(world.scene(), settings).coarse(), job)
    }

    fn warnings(&self, scene: &Scene, prepared: &Prepared, settings: &Settings) -> Vec<String> {
        probe::warnings(scene, &impostor::sites(scene, settings), prepared)
    }

    fn seen<'a>(&self, scene: &'a Scene, settings: &Settings) -> Cow<'a, Scene> {
        Cow::Owned(probe::seen::read(scene, &impostor::sites(scene, settings)))
    }

    fn points(&self) -> Option<&dyn ShadePoint> {
        Some(self)
    }
}

/// The probes with their coarse cubes.
fn record(world: &World, sites: &Sites, job: &Handle) -> Result<Prepared, MethodError> {
    let recorded = probe::prepare(world, sites, job)?;
    let mut coarse = Probes::of(&recorded).iter().map(|probe| coarse(&probe)).collect::<Vec<_>>().into_iter();
    Ok(recorded.map_parts(|part| part.with(ARRAY, coarse.next().unwrap_or_default())))
}

/// The coarse cubes of a probe, one after the other.
fn coarse(probe: &Probe<'_>) -> Vec<f32> {
    let Some(maps) = PreparedMaps::unturned(probe.maps) else { return Vec::new() };
    let face = probe.maps.whole("face").first().copied().unwrap_or(1);
    let cubes = EDGES.par_iter().map(|edge| {
        let parts = face.div_ceil(*edge).clamp(2, PARTS_MAX);
        // The level with about one texel for each part.
        let finest = (maps.radiance_levels() - 1.0).exp2();
        let level = (finest / (edge * parts) as f32).log2().max(0.0);
        let texels = downsample(*edge, parts, &|d| maps.radiance(d, level), &|d| probe.distances.distance(d));
        texels.iter().flat_map(Texel::to_array).collect::<Vec<f32>>()
    });
    debug_assert_eq!(Texel::default().to_array().len(), NUMBERS);
    cubes.collect::<Vec<_>>().concat()
}

/// Texels along an edge of a face, from settings made of [`PARAMS`].
pub fn edge(settings: &Settings) -> u32 {
    EDGES.get(settings.choice(&TEXELS)).copied().unwrap_or(EDGES[1])
}

/// What is asked of them, likewise.
pub fn asked(settings: &Settings) -> Asked {
    let is_off = |spec: &ParamSpec| settings.text(spec.key).as_deref() == Some("off");
    Asked {
        few: settings.text(SUM.key).as_deref() == Some("few"),
        corrected: !is_off(&CORRECTION),
        normalized: !is_off(&NORMALIZATION),
        middles: settings.text(CAPS.key).as_deref() == Some("middle"),
    }
}

/// How the texel is found that a reflection meets: a texel is large, two steps are enough; the tolerance is that of `impostor`.
const EFFORT: Effort = Effort { solver: Solver::Secant, refinements: 2, steps: 1, tolerance: 0.05 };

/// In which direction the probe sees what the reflection of a lobe of width `alpha` meets.
fn met(probe: &Probe<'_>, x: Vec3, frame: &Frame, to_viewer: Vec3, alpha: f32) -> Vec3 {
    let n = frame.n;
    let mirrored = 2.0 * n.dot(to_viewer) * n - to_viewer;
    // Wide lobes lean toward the normal, where the cosine is larger: as the one lookup of `classical`.
    let direction = mirrored.lerp(n, alpha * alpha).normalize_or(n);
    impostor::solve(&probe.distances, &probe.extent, x, direction, &EFFORT).direction(x, direction)
}

impl ShadePoint for AreaCube {
    fn radiance(&self, point: &SurfacePoint<'_>, prepared: &Prepared, settings: &Settings, random: [f32; 4]) -> Vec3 {
        let (edge, asked) = (edge(settings), asked(settings));
        let surface = point.surface();
        let (base, coat, to_viewer) = (point.base(), point.coat(), point.to_viewer());
        Probes::of(prepared).shaded(point, random, |probe, x| {
            let texels = Texels::of(probe.maps.floats(ARRAY), edge)?;
            let mut at = Looked { x, base: base.n, coat: coat.n };
            if asked.few {
                at.base = met(probe, x, base, to_viewer, (surface.alpha.x * surface.alpha.y).sqrt());
                at.coat = met(probe, x, coat, to_viewer, surface.coat_alpha);
            }
            Some(reflected(&texels, &surface, base, coat, to_viewer, point.occlusion(), &at, asked))
        })
    }
}

#[cfg(test)]
#[path = "method_tests.rs"]
mod tests;
