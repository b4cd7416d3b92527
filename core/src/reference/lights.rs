//! All light of a scene, drawn on purpose: sky, glowing triangles, lamps.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::emitters::Emitters;
use super::lamps;
use super::sky::Sky;
use crate::scene::Scene;
use crate::trace::Hit;

/// Least chance of a kind of light, so that none is lost where the guess at its share is wrong.
const LEAST_CHANCE: f32 = 0.1;

/// The light of a scene.
#[derive(Clone, Debug)]
pub(super) struct Lights {
    sky: Option<Sky>,
    emitters: Arc<Emitters>,
}

/// Light that may come straight to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightSample {
    /// Unit, world.
    pub direction: Vec3,
    /// Where the ray ends.
    pub end: End,
    /// Radiance over density, or irradiance of a lamp over the chance to draw it.
    pub weight: Vec3,
    /// Density per steradian; infinite for lamps.
    pub pdf: f32,
}

/// Where a ray to a light ends.
#[derive(Clone, Copy, Debug)]
pub(super) enum End {
    /// After metres, infinite for light from far away.
    Distance(f32),
    /// On a triangle.
    Surface {
        /// World.
        point: Vec3,
        /// Largest absolute coordinate of the corners.
        extent: f32,
        /// Of the triangle, unit.
        normal: Vec3,
    },
}

/// Chances of the three kinds at a point.
#[derive(Clone, Copy, Debug)]
struct Kinds {
    sky: f32,
    emitters: f32,
    lamps: f32,
}

impl Lights {
    pub(super) fn new(scene: &Scene) -> Lights {
        Lights { sky: map(scene).map(Sky::new), emitters: Arc::new(Emitters::new(scene)) }
    }

    /// The same for an edited scene; what is unchanged is shared.
    pub(super) fn updated(&self, scene: &Scene) -> Lights {
        let sky = map(scene).map(|map| self.sky.as_ref().map_or_else(|| Sky::new(map), |sky| sky.updated(map)));
        Lights { sky, emitters: Arc::new(Emitters::new(scene)) }
    }

    /// Radiance of the sky.
    pub(super) fn sky(&self, direction: Vec3) -> Vec3 {
        self.sky.as_ref().map_or(Vec3::ZERO, |sky| sky.radiance(direction))
    }

    fn kinds(&self, scene: &Scene, position: Vec3) -> Kinds {
        let sky = self.sky.as_ref().filter(|sky| sky.is_sampled());
        let sky = sky.map_or(0.0, |sky| std::f32::consts::PI * sky.mean().element_sum() / 3.0);
        let emitters = if self.emitters.is_empty() { 0.0 } else { self.emitters.weight(position) };
        let lamps = if scene.lights.is_empty() { 0.0 } else { lamps::weight(&scene.lights, position) };
        let active = [sky, emitters, lamps].iter().filter(|weight| **weight > 0.0).count() as f32;
        let sum = sky + emitters + lamps;
        let chance = |weight: f32| {
            if weight > 0.0 { LEAST_CHANCE + (1.0 - active * LEAST_CHANCE) * weight / sum } else { 0.0 }
        };
        Kinds { sky: chance(sky), emitters: chance(emitters), lamps: chance(lamps) }
    }

    /// Light to a point; `u` in `[0, 1)^3`, its z chooses. `None` where none is found.
    pub(super) fn sample(&self, scene: &Scene, position: Vec3, u: Vec3) -> Option<LightSample> {
        let kinds = self.kinds(scene, position);
        let at = u.truncate();
        if u.z < kinds.sky {
            let sample = self.sky.as_ref()?.sample(at)?;
            let (direction, pdf) = (sample.direction, kinds.sky * sample.pdf);
            let weight = sample.radiance / pdf;
            return Some(LightSample { direction, end: End::Distance(f32::INFINITY), weight, pdf });
        }
        let rest = u.z - kinds.sky;
        if rest < kinds.emitters {
            return self.sample_emitters(scene, position, rest / kinds.emitters, at, kinds.emitters);
        }
        let u = ((rest - kinds.emitters) / kinds.lamps).min(1.0);
        let (light, chance) = lamps::choose(&scene.lights, position, u)?;
        let weight = light.irradiance / (chance * kinds.lamps);
        Some(LightSample { direction: light.direction, end: End::Distance(light.distance), weight, pdf: f32::INFINITY })
    }

    fn sample_emitters(
        &self,
        scene: &Scene,
        position: Vec3,
        choice: f32,
        at: Vec2,
        chance: f32,
    ) -> Option<LightSample> {
        let sample = self.emitters.sample(scene, position, Vec3::new(choice, at.x, at.y))?;
        let pdf = chance * sample.pdf;
        let direction = (sample.point - position).normalize();
        let end = End::Surface { point: sample.point, extent: sample.extent, normal: sample.normal };
        Some(LightSample { direction, end, weight: sample.radiance / pdf, pdf })
    }

    /// Radiance of the sky, and the density with which [`Lights::sample`] at `position` draws that direction.
    pub(super) fn look(&self, scene: &Scene, position: Vec3, direction: Vec3) -> (Vec3, f32) {
        let Some(sky) = &self.sky else { return (Vec3::ZERO, 0.0) };
        let (radiance, pdf) = sky.look(direction);
        (radiance, if pdf > 0.0 { pdf * self.kinds(scene, position).sky } else { 0.0 })
    }

    /// Density with which [`Lights::sample`] at `position` draws a point of a glowing triangle.
    pub(super) fn emitter_pdf(&self, scene: &Scene, position: Vec3, hit: &Hit, point: Vec3) -> f32 {
        if self.emitters.is_empty() {
            return 0.0;
        }
        self.kinds(scene, position).emitters * self.emitters.pdf(position, hit.instance, hit.triangle, point)
    }
}

/// The map of the sky, if it has texels.
fn map(scene: &Scene) -> Option<&Arc<crate::scene::Environment>> {
    scene.environment.as_ref().filter(|map| map.width > 0 && map.height > 0 && map.strength > 0.0)
}
