//! All light of a scene, drawn on purpose: sky, glowing triangles, lamps.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::emitters::Emitters;
use super::lamps;
use super::point::Point;
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
    /// Radiance over density and rate, or irradiance of a lamp over the rate at which it is drawn.
    pub weight: Vec3,
    /// Density per steradian times the rate; infinite for lamps.
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
        /// How far rounding may have moved it.
        rounding: Vec3,
        /// Of the triangle, unit.
        normal: Vec3,
    },
}

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Sky,
    Emitters,
    Lamps,
}

impl Kind {
    pub(super) const ALL: [Kind; 3] = [Kind::Sky, Kind::Emitters, Kind::Lamps];
}

/// How many samples each kind gets at a point, in the mean: one each or one in all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates([f32; 3]);

impl Rates {
    /// None at all.
    pub(super) const NONE: Rates = Rates([0.0; 3]);

    pub(super) fn of(&self, kind: Kind) -> f32 {
        self.0[kind as usize]
    }

    /// For rates that sum to one: a kind by its rate, and what is left of `u` in [0, 1).
    pub(super) fn choose(&self, u: f32) -> Option<(Kind, f32)> {
        let mut left = u;
        for kind in Kind::ALL {
            let rate = self.of(kind);
            if left < rate {
                return Some((kind, left / rate));
            }
            left -= rate;
        }
        None
    }
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

    /// Memory of what light is drawn by.
    pub(super) fn bytes(&self) -> usize {
        self.sky.as_ref().map_or(0, Sky::bytes) + self.emitters.bytes()
    }

    /// Radiance of the sky.
    pub(super) fn sky(&self, direction: Vec3) -> Vec3 {
        self.sky.as_ref().map_or(Vec3::ZERO, |sky| sky.radiance(direction))
    }

    /// The rates at a point: one sample of each kind that there is, or one by a guess at their irradiance.
    pub(super) fn rates(&self, scene: &Scene, position: Vec3, each: bool) -> Rates {
        let sky = self.sky.as_ref().filter(|sky| sky.is_sampled());
        let sky = sky.map_or(0.0, |sky| std::f32::consts::PI * sky.mean().element_sum() / 3.0);
        let emitters = if self.emitters.is_empty() { 0.0 } else { self.emitters.weight(position) };
        let lamps = if scene.lights.is_empty() { 0.0 } else { lamps::weight(&scene.lights, position) };
        let weights = [sky, emitters, lamps];
        if each {
            return Rates(weights.map(|weight| if weight > 0.0 { 1.0 } else { 0.0 }));
        }
        let active = weights.iter().filter(|weight| **weight > 0.0).count() as f32;
        let sum: f32 = weights.iter().sum();
        let chance = |weight: f32| {
            if weight > 0.0 { LEAST_CHANCE + (1.0 - active * LEAST_CHANCE) * weight / sum } else { 0.0 }
        };
        Rates(weights.map(chance))
    }

    /// Light of a kind to a point, for its rate; `u` in `[0, 1)^3`. `None` where none is found.
    pub(super) fn sample(&self, scene: &Scene, position: Vec3, kind: Kind, rate: f32, u: Vec3) -> Option<LightSample> {
        match kind {
            Kind::Sky => {
                let sample = self.sky.as_ref()?.sample(u.truncate())?;
                let (direction, pdf) = (sample.direction, rate * sample.pdf);
                let weight = sample.radiance / pdf;
                Some(LightSample { direction, end: End::Distance(f32::INFINITY), weight, pdf })
            }
            Kind::Emitters => self.sample_emitters(scene, position, rate, u),
            Kind::Lamps => {
                let (light, chance) = lamps::choose(&scene.lights, position, u.z)?;
                let weight = light.irradiance / (chance * rate);
                let end = End::Distance(light.distance);
                Some(LightSample { direction: light.direction, end, weight, pdf: f32::INFINITY })
            }
        }
    }

    fn sample_emitters(&self, scene: &Scene, position: Vec3, rate: f32, u: Vec3) -> Option<LightSample> {
        let sample = self.emitters.sample(scene, position, Vec3::new(u.z, u.x, u.y))?;
        let pdf = rate * sample.pdf;
        let direction = (sample.point - position).normalize();
        let end = End::Surface { point: sample.point, rounding: sample.rounding, normal: sample.normal };
        Some(LightSample { direction, end, weight: sample.radiance / pdf, pdf })
    }

    /// Irradiance of the sky on a plane that faces up, shadows left aside.
    pub(super) fn sky_up(&self) -> Vec3 {
        self.sky.as_ref().map_or(Vec3::ZERO, Sky::up)
    }

    /// A direction toward the sky with its radiance and density; `None` where the sky is not sampled.
    pub(super) fn sample_sky(&self, u: Vec2) -> Option<(Vec3, Vec3, f32)> {
        let sample = self.sky.as_ref()?.sample(u)?;
        Some((sample.direction, sample.radiance, sample.pdf))
    }

    /// Radiance of the sky, and the density with which it is sampled, before the rate.
    pub(super) fn look(&self, direction: Vec3) -> (Vec3, f32) {
        self.sky.as_ref().map_or((Vec3::ZERO, 0.0), |sky| sky.look(direction))
    }

    /// Density with which a hit of a glowing triangle is sampled at `position`, before the rate.
    pub(super) fn emitter_pdf(&self, position: Vec3, hit: &Hit, point: &Point) -> f32 {
        if self.emitters.is_empty() {
            return 0.0;
        }
        self.emitters.pdf(position, hit.instance, hit.triangle, point.position)
    }
}

/// The map of the sky, if it has texels.
fn map(scene: &Scene) -> Option<&Arc<crate::scene::Environment>> {
    scene.environment.as_ref().filter(|map| map.width > 0 && map.height > 0 && map.strength > 0.0)
}
