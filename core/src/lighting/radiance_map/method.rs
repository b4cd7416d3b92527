//! The method: sums over the directions of the map and over directions drawn from the surface, weighed against each other.

use std::sync::Arc;

use glam::{UVec3, Vec3};
use half::f16;

use super::bake::{GROUPS, age};
use super::directions::{Directions, Spread};
use super::near::{self, Grid, Near, SET};
use super::run::run;
use super::settings::{self, DRAFT_DIRECTIONS, Look, PARAMS, baked_directions};
use super::shards;
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
