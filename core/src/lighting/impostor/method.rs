//! The method: the classical evaluation over the light of a probe, each lookup in the direction in which the probe sees what
//! its ray meets.

use std::borrow::Cow;

use glam::{Vec2, Vec3};

use super::study::apart;
use super::{Effort, Found, Show, Solver, error_shown, follow, level, shown};
use crate::job::Handle;
use crate::lighting::classical::{self, FrameSettings, Lobes, Maps, MeanFresnel, PreparedMaps, Source, environment};
use crate::lighting::probe::{self, Defaults, Probe, Probes, Sites};
use crate::lighting::{Cover, Coverage, Method, MethodError, MethodId, MethodInfo, Prepared, Reads, ShadePoint};
use crate::param::{Affects, ParamKind, ParamSpec, Settings};
use crate::reference::{SurfacePoint, World};
use crate::scene::Scene;

/// Id of the method, as documents name it.
pub const ID: &str = "impostor";

/// The method as others see it.
#[derive(Debug)]
pub struct Impostor;

const SOLVER: ParamSpec = ParamSpec {
    key: "solver",
    label: "Solver",
    unit: "",
    kind: ParamKind::Choice { options: &Solver::IDS, default: Solver::Secant as usize },
    help: "How the place that a reflection meets is searched. classical: not at all; sphere, box: a simple body stands for the \
           surroundings; march and pyramid find what the others lose at silhouettes.",
    affects: Affects::Frame,
};

const REFINEMENTS: ParamSpec = ParamSpec {
    key: "refinements",
    label: "Refinements",
    unit: "",
    kind: ParamKind::Integer { min: 0, max: 64, default: 2 },
    help: "Steps after the first guesses.",
    affects: Affects::Frame,
};

const STEPS: ParamSpec = ParamSpec {
    key: "steps",
    label: "Steps",
    unit: "",
    kind: ParamKind::Integer { min: 1, max: 256, default: 24 },
    help: "Places that march looks at along a ray; pyramid looks up four times as many at most, about a dozen in the mean.",
    affects: Affects::Frame,
};

const TOLERANCE: ParamSpec = ParamSpec {
    key: "tolerance",
    label: "Tolerance",
    unit: "",
    kind: ParamKind::Number { min: 1e-4, max: 10.0, default: 0.05 },
    help: "Share of its distance by which a place may miss the surface; beyond it the reflection is looked up as if it came \
           from infinitely far away.",
    affects: Affects::Frame,
};

const SHOW: ParamSpec = ParamSpec {
    key: "show",
    label: "Show",
    unit: "",
    kind: ParamKind::Choice { options: &Show::IDS, default: 0 },
    help: "The light, or of the mirror direction at each point: how many distances were looked up (red: 32), where the search \
           ended (blue before the surface, red behind it, green: missed), by how many degrees it is wrong (blue 0.01, red 100).",
    affects: Affects::Frame,
};

/// Texels of a probe; shared by methods that have probes.
pub const RESOLUTION: ParamSpec = ParamSpec {
    key: "resolution",
    label: "Resolution",
    unit: "texels",
    kind: ParamKind::Integer { min: 16, max: 1024, default: 128 },
    help: "Along the edge of a face of the probe.",
    affects: Affects::Prepare,
};

/// Paths of a probe; shared likewise.
pub const PATHS: ParamSpec = ParamSpec {
    key: "probe-paths",
    label: "Probe paths",
    unit: "per texel",
    kind: ParamKind::Integer { min: 1, max: 65_536, default: 32 },
    help: "Paths that are traced for a texel of the probe.",
    affects: Affects::Prepare,
};

const LAYERS: ParamSpec = ParamSpec {
    key: "layers",
    label: "Layers",
    unit: "",
    kind: ParamKind::Integer { min: 1, max: 2, default: 1 },
    help: "2 records what lies behind the surfaces that the probe sees too: a search that found nothing goes on there.",
    affects: Affects::Prepare,
};

/// Settings of this method: the last are those of `classical`.
pub const PARAMS: &[ParamSpec] = &[
    SOLVER,
    REFINEMENTS,
    STEPS,
    TOLERANCE,
    SHOW,
    RESOLUTION,
    PATHS,
    LAYERS,
    classical::PARAMS[0],
    classical::PARAMS[1],
    classical::PARAMS[2],
    classical::PARAMS[3],
    classical::PARAMS[4],
    classical::PARAMS[5],
];

static INFO: MethodInfo = MethodInfo {
    id: MethodId(ID),
    title: "Distance impostor",
    summary: "Reflections of the surroundings of one object, which sit where they belong: a traced cube map with distances.",
    params: PARAMS,
    coverage: Coverage {
        lamps: Cover::None,
        environment: Cover::Approximate,
        indirect_diffuse: Cover::Approximate,
        indirect_glossy: Cover::Approximate,
        emission: Cover::None,
    },
    reads: Reads { probes: true, ..Reads::ALL },
    revision: 4,
};

impl Method for Impostor {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn prepare(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        probe::prepare(world, &sites(world.scene(), settings), job)
    }

    fn drafts(&self) -> bool {
        true
    }

    fn draft(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        probe::prepare(world, &sites(world.scene(), settings).coarse(), job)
    }

    fn warnings(&self, scene: &Scene, prepared: &Prepared, settings: &Settings) -> Vec<String> {
        probe::warnings(scene, &sites(scene, settings), prepared)
    }

    fn seen<'a>(&self, scene: &'a Scene, settings: &Settings) -> Cow<'a, Scene> {
        Cow::Owned(probe::seen::read(scene, &sites(scene, settings)))
    }

    fn points(&self) -> Option<&dyn ShadePoint> {
        Some(self)
    }
}

/// The probes of a scene, from settings made of [`PARAMS`].
pub fn sites(scene: &Scene, settings: &Settings) -> Sites {
    let [face, paths, layers] = [RESOLUTION, PATHS, LAYERS].map(|spec| settings.whole(&spec));
    Sites::new(scene, Defaults { face, paths, layers })
}

/// How rays are followed, from settings made of [`PARAMS`].
pub fn effort(settings: &Settings) -> Effort {
    Effort {
        solver: Solver::ALL.get(settings.choice(&SOLVER)).copied().unwrap_or_default(),
        refinements: settings.whole(&REFINEMENTS),
        steps: settings.whole(&STEPS),
        tolerance: settings.number(&TOLERANCE),
    }
}

/// What is shown, from settings made of [`PARAMS`].
pub fn show(settings: &Settings) -> Show {
    Show::ALL.get(settings.choice(&SHOW)).copied().unwrap_or_default()
}

impl ShadePoint for Impostor {
    fn radiance(&self, point: &SurfacePoint<'_>, prepared: &Prepared, settings: &Settings, random: [f32; 4]) -> Vec3 {
        let (effort, show) = (effort(settings), show(settings));
        let FrameSettings { samples, .. } = FrameSettings::new(settings);
        let lobes = Lobes { samples, rotation: Vec2::new(random[0], random[1]) };
        Probes::of(prepared).shaded(point, random, |probe, x| {
            let behind = probe.behind().and_then(|behind| PreparedMaps::unturned(behind.maps));
            let maps = Localised { maps: PreparedMaps::unturned(probe.maps)?, behind, x, probe: *probe, effort };
            Some(match show {
                Show::Light => reflected(point, &maps, lobes),
                other => searched(point, &maps, other),
            })
        })
    }
}

fn reflected(point: &SurfacePoint<'_>, maps: &Localised<'_>, lobes: Lobes) -> Vec3 {
    let surface = point.surface();
    let mean = MeanFresnel::of(surface.fresnel);
    environment(maps, &surface, mean, point.base(), point.coat(), point.to_viewer(), point.occlusion(), lobes)
}

/// The colour of the search in the mirror direction.
fn searched(point: &SurfacePoint<'_>, maps: &Localised<'_>, show: Show) -> Vec3 {
    let r = point.mirrored();
    let (found, _) = maps.follow(r);
    if show != Show::Error {
        return shown(&found, show);
    }
    let served = maps.probe.maps.whole("served");
    let met = point.world().distance_past(point.position(), r, served);
    // The sky is seen in the same direction from everywhere.
    let wanted = met.map_or(r, |t| maps.x + t * r);
    error_shown(apart(wanted, found.direction(maps.x, r)))
}

/// The maps of a probe as a point beside its middle sees them.
struct Localised<'a> {
    maps: PreparedMaps<'a>,
    /// Of its second layer.
    behind: Option<PreparedMaps<'a>>,
    probe: Probe<'a>,
    /// From the middle of the probe.
    x: Vec3,
    effort: Effort,
}

impl<'a> Localised<'a> {
    fn follow(&self, direction: Vec3) -> (Found, usize) {
        follow(&self.probe, self.x, direction, &self.effort)
    }

    /// In which maps to look and where, and how much nearer than to the middle the place is: `t / distance`, 1 without a place.
    fn look(&self, direction: Vec3) -> (&PreparedMaps<'a>, Vec3, f32) {
        let (found, layer) = self.follow(direction);
        let distance = (self.x + found.t * direction).length();
        let nearer = if found.is_hit && distance > 0.0 { found.t / distance } else { 1.0 };
        let maps = self.behind.as_ref().filter(|_| layer == 1).unwrap_or(&self.maps);
        (maps, found.direction(self.x, direction), nearer)
    }
}

impl Maps for Localised<'_> {
    fn radiance(&self, direction: Vec3, at: f32) -> Vec3 {
        let (maps, seen, nearer) = self.look(direction);
        maps.radiance(seen, level(at, nearer, 1.0, self.maps.radiance_levels() - 1.0))
    }

    fn dimmed(&self, direction: Vec3, at: f32) -> Vec3 {
        let (maps, seen, nearer) = self.look(direction);
        maps.dimmed(seen, level(at, nearer, 1.0, self.maps.radiance_levels() - 1.0))
    }

    fn source_count(&self) -> usize {
        self.maps.source_count()
    }

    fn source(&self, index: usize) -> Source {
        let source = self.maps.source(index);
        let distance = self.probe.distances.distance(source.direction);
        if distance <= 0.0 || self.effort.solver == Solver::Classical {
            return source;
        }
        // As bright from every side, and larger from nearer.
        let toward = distance * source.direction - self.x;
        let ratio = distance / toward.length().max(0.05 * distance);
        let direction = toward.try_normalize().unwrap_or(source.direction);
        Source { direction, power: ratio * ratio * source.power }
    }

    fn wide_alpha(&self) -> f32 {
        self.maps.wide_alpha()
    }

    fn prefiltered(&self, direction: Vec3, at: f32) -> Vec3 {
        let (maps, seen, nearer) = self.look(direction);
        let levels = self.maps.prefiltered_levels();
        // The lobe covers so much less of the surface: a narrower one would from the middle.
        let alpha = classical::roughness(at, levels).powi(2) * nearer;
        maps.prefiltered(seen, classical::level(alpha.sqrt(), levels))
    }

    fn irradiance(&self, normal: Vec3) -> Vec3 {
        self.maps.irradiance(normal)
    }

    fn radiance_levels(&self) -> f32 {
        self.maps.radiance_levels()
    }

    fn prefiltered_levels(&self) -> f32 {
        self.maps.prefiltered_levels()
    }
}

#[cfg(test)]
#[path = "method_tests.rs"]
mod tests;
