//! The method: sums over the directions of the map and over directions drawn from the surface, weighed against each other.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, PoisonError, RwLock};

use glam::{UVec3, Vec3};
use half::f16;

use super::bake::{Asked, GROUPS, age};
use super::directions::{Directions, FEWEST, Spread};
use super::near::{self, Filter, Grid, Near, SET};
use super::run::run;
use super::shards;
use crate::job::Handle;
use crate::lighting::classical;
use crate::lighting::{Cover, Coverage, Method, MethodError, MethodId, MethodInfo, Prepared, Reads, ShadePoint};
use crate::math::sampling::{pcg, unit};
use crate::param::{Affects, ParamKind, ParamSpec, ParamValue, Settings};
use crate::reference::{SurfacePoint, World};

/// Id of the method, as documents name it.
pub const ID: &str = "radiance-map";

/// The method as others see it.
#[derive(Debug)]
pub struct RadianceMap;

const POINTS: ParamSpec = ParamSpec {
    key: "points",
    label: "Points",
    unit: "",
    kind: ParamKind::Integer { min: 64, max: 4_000_000, default: 10_000 },
    help: "Places on surfaces of which light is kept, spread by area.",
    affects: Affects::Prepare,
};

const DIRECTIONS: ParamSpec = ParamSpec {
    key: "directions",
    label: "Directions",
    unit: "per point",
    kind: ParamKind::Integer { min: FEWEST as i64, max: 1024, default: 64 },
    help: "Directions from which light is kept, the same for all points.",
    affects: Affects::Prepare,
};

const PATHS: ParamSpec = ParamSpec {
    key: "paths",
    label: "Paths",
    unit: "per direction",
    kind: ParamKind::Integer { min: 1, max: 65_536, default: 8 },
    help: "Paths that are traced for each direction of each point.",
    affects: Affects::Prepare,
};

const SPREAD: ParamSpec = ParamSpec {
    key: "spread",
    label: "Spread",
    unit: "",
    kind: ParamKind::Choice { options: &Spread::IDS, default: 0 },
    help: "How directions are spread over the sphere.",
    affects: Affects::Prepare,
};

const SEED: ParamSpec = ParamSpec {
    key: "seed",
    label: "Seed",
    unit: "",
    kind: ParamKind::Integer { min: 0, max: u32::MAX as i64, default: 0 },
    help: "Chooses the random numbers of the paths.",
    affects: Affects::Prepare,
};

const LOBE_SAMPLES: ParamSpec = ParamSpec {
    key: "lobe-samples",
    label: "Lobe samples",
    unit: "per frame",
    kind: ParamKind::Integer { min: 0, max: 64, default: 1 },
    help: "Directions drawn from the surface beside those of the map: without them narrow highlights fall between these.",
    affects: Affects::Frame,
};

const TRACE_BELOW: ParamSpec = ParamSpec {
    key: "trace-below",
    label: "Trace below",
    unit: "roughness",
    kind: ParamKind::Number { min: 0.0, max: 1.0, default: 0.25 },
    help: "Smoother surfaces trace rays and take the map where these end.",
    affects: Affects::Frame,
};

const INTERPOLATION: ParamSpec = ParamSpec {
    key: "interpolation",
    label: "Interpolation",
    unit: "",
    kind: ParamKind::Choice { options: &["nearest", "smooth"], default: 0 },
    help: "How light is looked up between the directions of the map. smooth hides the cells in glossy metals, and takes light off \
           matt surfaces that face it.",
    affects: Affects::Frame,
};

const FILTER: ParamSpec = ParamSpec {
    key: "filter",
    label: "Filter",
    unit: "",
    kind: ParamKind::Choice { options: &["hat", "box"], default: 0 },
    help: "How places around a point are weighed: a hat over their distance, or all of them the same.",
    affects: Affects::Frame,
};

const GUARDS: ParamSpec = ParamSpec {
    key: "guards",
    label: "Guards",
    unit: "",
    kind: ParamKind::Choice { options: &["on", "off"], default: 0 },
    help: "Places whose surface faces elsewhere, or lies off the plane of a point, do not light it. off shows what leaks without.",
    affects: Affects::Frame,
};

const fn strength(key: &'static str, label: &'static str, help: &'static str) -> ParamSpec {
    ParamSpec {
        key,
        label,
        unit: "",
        kind: ParamKind::Number { min: 0.0, max: 1000.0, default: 1.0 },
        help,
        affects: Affects::Frame,
    }
}

const STRENGTHS: [ParamSpec; 3] = [
    strength("environment-strength", "Environment", "Factor on the light of the environment, without another bake."),
    strength(
        "lamps-strength",
        "Lamps",
        "Factor on the light of lamps that comes over other surfaces, without another bake.",
    ),
    strength("glow-strength", "Glow", "Factor on the light of what glows, without another bake."),
];

/// Settings of this method: the last are those of `classical`, but for its samples.
pub const PARAMS: &[ParamSpec] = &[
    POINTS,
    DIRECTIONS,
    PATHS,
    SPREAD,
    SEED,
    LOBE_SAMPLES,
    TRACE_BELOW,
    INTERPOLATION,
    FILTER,
    GUARDS,
    STRENGTHS[0],
    STRENGTHS[1],
    STRENGTHS[2],
    classical::PARAMS[1],
    classical::PARAMS[2],
    classical::PARAMS[3],
    classical::PARAMS[4],
    classical::PARAMS[5],
];

static INFO: MethodInfo = MethodInfo {
    id: MethodId(ID),
    title: "Radiance map",
    summary: "Light as it arrives at places on all surfaces, baked by the path tracer; any material can be edited under it.",
    params: PARAMS,
    coverage: Coverage {
        lamps: Cover::None,
        environment: Cover::Approximate,
        indirect_diffuse: Cover::Approximate,
        indirect_glossy: Cover::Approximate,
        emission: Cover::None,
    },
    reads: Reads::ALL,
    revision: 2,
};

impl Method for RadianceMap {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn prepare(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        let shard = run(world, settings, [1, 1], None, |_| (), job)?;
        let bake = shards::whole(&shard.about, &shard.blocks).map_err(MethodError::Unfit)?;
        Ok(bake.prepared)
    }

    fn drafts(&self) -> bool {
        true
    }

    /// With places and paths for a part of a second.
    fn draft(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        let coarse = |spec: &ParamSpec, most: u32| whole(settings, spec).min(most).to_string();
        let mut draft = settings.clone();
        for (spec, most) in [(&POINTS, DRAFT_POINTS), (&DIRECTIONS, DRAFT_DIRECTIONS), (&PATHS, 1)] {
            draft.set(spec.key, &coarse(spec, most)).map_err(|e| MethodError::Unfit(e.to_string()))?;
        }
        self.prepare(world, &draft, job)
    }

    fn outlives(&self) -> Reads {
        Reads { materials: true, ..Reads::NOTHING }
    }

    fn age(&self, then: &World, now: &World, settings: &Settings) -> Option<f32> {
        age(then, now, &directions(Spread::Fibonacci, DRAFT_DIRECTIONS), asked(settings).seed)
    }

    fn points(&self) -> Option<&dyn ShadePoint> {
        Some(self)
    }
}

/// What is baked, from settings made of [`PARAMS`].
pub(super) fn asked(settings: &Settings) -> Asked {
    let [points, paths, seed] = [POINTS, PATHS, SEED].map(|spec| whole(settings, &spec));
    Asked { points, paths, seed }
}

fn whole(settings: &Settings, spec: &ParamSpec) -> u32 {
    match settings.get(spec.key).unwrap_or(spec.default()) {
        ParamValue::Integer(number) => u32::try_from(number).unwrap_or(1),
        _ => 1,
    }
}

fn number(settings: &Settings, spec: &ParamSpec) -> f32 {
    match settings.get(spec.key).unwrap_or(spec.default()) {
        ParamValue::Number(number) => number as f32,
        _ => 1.0,
    }
}

fn is_choice(settings: &Settings, spec: &ParamSpec, place: usize) -> bool {
    settings.get(spec.key).unwrap_or(spec.default()) == ParamValue::Choice(place)
}

/// How a map is looked up, from settings made of [`PARAMS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Directions drawn from the surface.
    pub lobes: u32,
    /// Width of the lobe below which rays are traced.
    pub below: f32,
    /// Light is interpolated between directions.
    pub smooth: bool,
    /// Which places count.
    pub filter: Filter,
    /// Factors on the light of each of [`GROUPS`].
    pub strengths: [f32; 3],
}

impl Look {
    /// That of settings.
    pub fn new(settings: &Settings) -> Look {
        Look {
            lobes: whole(settings, &LOBE_SAMPLES),
            below: number(settings, &TRACE_BELOW).powi(2),
            smooth: is_choice(settings, &INTERPOLATION, 1),
            filter: filter(settings),
            strengths: STRENGTHS.map(|spec| number(settings, &spec)),
        }
    }
}

/// How places are weighed, from settings made of [`PARAMS`].
fn filter(settings: &Settings) -> Filter {
    Filter { box_shaped: is_choice(settings, &FILTER, 1), unguarded: is_choice(settings, &GUARDS, 1) }
}

/// Directions, made once for all who ask.
fn directions(spread: Spread, count: u32) -> Arc<Directions> {
    type Made = HashMap<(Spread, u32), Arc<Directions>>;
    static MADE: LazyLock<RwLock<Made>> = LazyLock::new(RwLock::default);
    let key = (spread, count);
    if let Some(made) = MADE.read().unwrap_or_else(PoisonError::into_inner).get(&key) {
        return made.clone();
    }
    let made = Arc::new(Directions::new(spread, count));
    MADE.write().unwrap_or_else(PoisonError::into_inner).entry(key).or_insert(made).clone()
}

/// Those of the texts of settings; `None` where these are not understood.
pub(super) fn directions_of_texts(spread: &str, count: &str) -> Option<Arc<Directions>> {
    let spread = Spread::IDS.iter().position(|id| *id == spread)?;
    let count: u32 = count.parse().ok()?;
    DIRECTIONS.accepts(ParamValue::Integer(count.into())).then(|| directions(Spread::ALL[spread], count))
}

/// Those of settings made of [`PARAMS`].
pub(super) fn asked_directions(settings: &Settings) -> Arc<Directions> {
    let spread = if is_choice(settings, &SPREAD, 1) { Spread::Halton } else { Spread::Fibonacci };
    directions(spread, whole(settings, &DIRECTIONS))
}

/// Those of a map; `None` where there is no map.
pub fn baked_directions(prepared: &Prepared) -> Option<Arc<Directions>> {
    let [spread, count] = *prepared.whole("directions") else { return None };
    Some(directions(*Spread::ALL.get(spread as usize)?, count))
}

/// What was baked, ready for lookups.
struct Map<'a> {
    near: Near<'a>,
    /// Light of each group with what it is multiplied by.
    groups: Vec<(&'a [f16], f32)>,
    directions: Arc<Directions>,
    look: Look,
}

impl<'a> Map<'a> {
    /// `None` where a preparation has no map.
    fn of(prepared: &'a Prepared, settings: &Settings) -> Option<Map<'a>> {
        let directions = baked_directions(prepared)?;
        let (positions, normals) = (prepared.floats("positions"), prepared.floats("normals"));
        let size = UVec3::from_slice(prepared.whole("cells").get(..3)?);
        let grid = Grid { low: prepared.vector("grid", 0), edge: prepared.vector("grid", 1).x, size };
        let (starts, neighbours) = (prepared.whole("starts"), prepared.whole("neighbours"));
        let places = positions.len() / 3;
        if places == 0 || normals.len() != positions.len() || neighbours.len() != SET * places {
            return None;
        }
        let mut groups = Vec::new();
        let look = Look::new(settings);
        for (name, strength) in GROUPS.iter().zip(look.strengths) {
            let light = prepared.halves(name);
            let scale = prepared.floats(&format!("{name} scale")).first().copied().unwrap_or(1.0);
            if light.len() == 3 * places * directions.len() {
                groups.push((light, scale * strength));
            } else if !light.is_empty() {
                return None;
            }
        }
        let near = Near::new(positions, normals, grid, starts, neighbours);
        Some(Map { near, groups, directions, look })
    }

    /// Radiance that arrives at a point from each direction.
    fn arriving(&self, position: Vec3, normal: Vec3) -> Vec<Vec3> {
        let count = self.directions.len();
        let mut light = vec![Vec3::ZERO; count];
        let searched;
        let set = if self.look.filter.unguarded {
            searched = self.near.nearest_of_all(position, SET);
            &searched
        } else {
            let Some(set) = self.near.set(position, normal) else { return light };
            set
        };
        for (weight, place) in near::weights(&self.near, set, position, normal, self.look.filter).into_iter().zip(set) {
            if weight <= 0.0 {
                continue;
            }
            for (halves, factor) in &self.groups {
                let first = 3 * count * *place as usize;
                let factor = weight * factor;
                for (sum, texel) in light.iter_mut().zip(halves[first..first + 3 * count].as_chunks::<3>().0) {
                    *sum += factor * Vec3::from_array(texel.map(f16::to_f32));
                }
            }
        }
        light
    }

    /// Radiance from a direction between those of the map: a mean of the nearest, by a hat over the angle that is zero where the cells next to the
    /// own end.
    fn toward(&self, light: &[Vec3], direction: Vec3) -> Vec3 {
        if !self.look.smooth {
            return light[self.directions.nearest(direction)];
        }
        let reach = self.directions.reach();
        let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
        for (k, light) in light.iter().enumerate() {
            let weight = (self.directions.get(k).dot(direction) - reach).max(0.0);
            sum += weight * *light;
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { light[self.directions.nearest(direction)] }
    }
}

/// Places and directions of a draft, at most.
const DRAFT_POINTS: u32 = 2000;
const DRAFT_DIRECTIONS: u32 = 32;

/// Bounces between smooth surfaces that are traced.
pub const MOST_MIRRORS: u32 = 4;

impl ShadePoint for RadianceMap {
    fn radiance(&self, point: &SurfacePoint<'_>, prepared: &Prepared, settings: &Settings, random: [f32; 4]) -> Vec3 {
        let Some(map) = Map::of(prepared, settings) else { return Vec3::ZERO };
        let effort = Effort { lobes: map.look.lobes, below: map.look.below };
        reflected(&map, point, effort, random, 0)
    }
}

/// How the light of a point is summed.
#[derive(Clone, Copy)]
struct Effort {
    /// Directions drawn from the surface.
    lobes: u32,
    /// Width of the lobe below which rays are traced.
    below: f32,
}

/// Light that the surface sends to the viewer of what arrives over other surfaces and from the environment.
fn reflected(map: &Map<'_>, point: &SurfacePoint<'_>, effort: Effort, random: [f32; 4], mirrors: u32) -> Vec3 {
    let surface = point.surface();
    let width = (surface.alpha.x * surface.alpha.y).sqrt();
    let is_smooth = width < effort.below || (surface.coat > 0.0 && surface.coat_alpha < effort.below);
    if is_smooth && mirrors < MOST_MIRRORS {
        return traced(map, point, effort, random, mirrors);
    }
    let light = map.arriving(point.position(), point.normal());
    let lobes = effort.lobes as f32;
    let directions = &map.directions;
    let mut sum = Vec3::ZERO;
    // In its cell, so that the sum is right in the mean.
    for (known, drawn) in light.iter().zip(directions.drawn_all(Vec3::new(random[0], random[1], random[2]))) {
        let (response, pdf) = point.response_and_density(drawn.direction);
        if response == Vec3::ZERO {
            continue;
        }
        let arriving = if map.look.smooth { map.toward(&light, drawn.direction) } else { *known };
        let pdf = if pdf.is_finite() { pdf } else { 0.0 };
        sum += response * arriving / (drawn.pdf + lobes * pdf);
    }
    for i in 0..effort.lobes {
        let Some(drawn) = point.drawn(numbers(random, i)) else { continue };
        let arriving = map.toward(&light, drawn.direction);
        if drawn.pdf.is_finite() {
            let cell = directions.nearest(drawn.direction);
            let own = directions.pdf(cell, drawn.direction);
            sum += drawn.weight * arriving * drawn.pdf / (own + lobes * drawn.pdf);
        } else {
            sum += drawn.weight * arriving / lobes;
        }
    }
    sum
}

/// The same by rays, which take the map where they end.
fn traced(map: &Map<'_>, point: &SurfacePoint<'_>, effort: Effort, random: [f32; 4], mirrors: u32) -> Vec3 {
    let rays = effort.lobes.max(1);
    let mut sum = Vec3::ZERO;
    for i in 0..rays {
        let Some(drawn) = point.drawn(numbers(random, i)) else { continue };
        let eye = point.toward(drawn.direction, pcg(random[3].to_bits().wrapping_add(i)));
        let light = match eye.point() {
            None => map.look.strengths[0] * point.sky(drawn.direction),
            Some(met) => {
                let again = numbers(random, i + 977);
                let random = [again.x, again.y, again.z, random[3]];
                // Lamps light it too; where it is seen from the eye the frame adds them.
                let lamps = met.lamps(random).0;
                map.look.strengths[2] * met.emission()
                    + map.look.strengths[1] * lamps
                    + reflected(map, &met, Effort { lobes: 0, ..effort }, random, mirrors + 1)
            }
        };
        sum += drawn.weight * light;
    }
    sum / rays as f32
}

/// Numbers of their own for drawing number `i`.
fn numbers(random: [f32; 4], i: u32) -> Vec3 {
    let turn = |axis: usize| unit(pcg(i.wrapping_mul(3).wrapping_add(axis as u32)));
    let shifted = |axis: usize| {
        if i == 0 { random[axis] } else { (random[axis] + turn(axis)).fract() }
    };
    Vec3::new(shifted(0), shifted(1), shifted(2))
}

#[cfg(test)]
#[path = "method_tests.rs"]
mod tests;
