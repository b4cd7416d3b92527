//! The method: sums over the directions of the map and over directions drawn from the surface, weighed against each other.

use glam::Vec3;

use super::bake::age;
use super::directions::{Directions, Spread};
use super::map::Map;
use super::rays;
use super::run::prepared;
use super::settings::{self, DRAFT_DIRECTIONS, PARAMS};
use crate::job::Handle;
use crate::lighting::{Cover, Coverage, Method, MethodError, MethodId, MethodInfo, Prepared, Reads, ShadePoint};
use crate::math::sampling::{pcg, unit};
use crate::param::Settings;
use crate::reference::{SurfacePoint, World};

/// Id of the method, as documents name it.
pub const ID: &str = "radiance-map";

/// The method as others see it.
#[derive(Debug)]
pub struct RadianceMap;

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
    revision: 3,
};

impl Method for RadianceMap {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn prepare(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        prepared(world, settings, job)
    }

    fn drafts(&self) -> bool {
        true
    }

    /// With places and paths for a part of a second.
    fn draft(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        let draft = settings::draft(settings).map_err(|e| MethodError::Unfit(e.to_string()))?;
        self.prepare(world, &draft, job)
    }

    fn outlives(&self) -> Reads {
        Reads { materials: true, ..Reads::NOTHING }
    }

    fn age(&self, then: &World, now: &World, settings: &Settings) -> Option<f32> {
        let few = settings::directions(Spread::Fibonacci, DRAFT_DIRECTIONS);
        age(then, now, &few, settings::asked(settings).seed)
    }

    fn points(&self) -> Option<&dyn ShadePoint> {
        Some(self)
    }
}

impl ShadePoint for RadianceMap {
    fn radiance(&self, point: &SurfacePoint<'_>, prepared: &Prepared, settings: &Settings, random: [f32; 4]) -> Vec3 {
        let Some(map) = Map::of(prepared, settings) else { return Vec3::ZERO };
        reflected(&map, point, Effort::of(&map), random, 0)
    }
}

/// How the light of a point is summed.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    /// Directions drawn from the surface.
    pub lobes: u32,
    /// Width of the lobe below which rays are traced.
    pub below: f32,
}

impl Effort {
    pub(super) fn of(map: &Map<'_>) -> Effort {
        Effort { lobes: map.look.lobes, below: map.look.below }
    }
}

/// Light that the surface sends to the viewer of what arrives over other surfaces and from the environment.
pub(super) fn reflected(
    map: &Map<'_>,
    point: &SurfacePoint<'_>,
    effort: Effort,
    random: [f32; 4],
    mirrors: u32,
) -> Vec3 {
    let surface = point.surface();
    let width = (surface.alpha.x * surface.alpha.y).sqrt();
    let is_smooth = width < effort.below || (surface.coat > 0.0 && surface.coat_alpha < effort.below);
    if is_smooth && mirrors < rays::MOST_MIRRORS {
        return rays::traced(map, point, effort, random, mirrors);
    }
    let light = map.arriving(point.position(), point.normal());
    let lobes = effort.lobes as f32;
    let directions = &map.directions;
    let reflecting = point.reflecting();
    let mut sum = Vec3::ZERO;
    // In its cell, so that the sum is right in the mean.
    for (known, drawn) in light.iter().zip(directions.drawn(list(random))) {
        let (response, pdf) = reflecting.response_and_density(drawn.direction);
        if response == Vec3::ZERO {
            continue;
        }
        let arriving = if map.look.smooth { map.toward(&light, drawn.direction) } else { *known };
        let pdf = if pdf.is_finite() { pdf } else { 0.0 };
        sum += response * arriving / (drawn.pdf + lobes * pdf);
    }
    for i in 0..effort.lobes {
        let Some(drawn) = reflecting.drawn(numbers(random, i)) else { continue };
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

/// The list of drawn directions that is used.
pub(super) fn list([x, y, z, _]: [f32; 4]) -> u32 {
    Directions::list_of(Vec3::new(x, y, z))
}

/// Numbers of their own for drawing number `i`.
pub(super) fn numbers(random: [f32; 4], i: u32) -> Vec3 {
    let turn = |axis: usize| unit(pcg(i.wrapping_mul(3).wrapping_add(axis as u32)));
    let shifted = |axis: usize| {
        if i == 0 { random[axis] } else { (random[axis] + turn(axis)).fract() }
    };
    Vec3::new(shifted(0), shifted(1), shifted(2))
}

#[cfg(test)]
#[path = "method_tests.rs"]
mod tests;
