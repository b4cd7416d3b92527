//! All light of a scene, drawn on purpose: sky, glowing triangles, lamps.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::emitters::Emitters;
use super::lamps::{self, Receiver};
use super::point::Point;
use super::shapes;
use super::sky::Sky;
use crate::scene::{Light, Scene};
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
    /// Density per steradian times the rate; infinite for sharp lamps.
    pub pdf: f32,
    /// Where it comes from.
    pub source: Source,
}

impl LightSample {
    /// The lamp that it comes from, if it does.
    pub(super) fn lamp<'a>(&self, scene: &'a Scene) -> Option<&'a Light> {
        let Source::Lamp(lamp) = self.source else { return None };
        scene.lights.get(lamp)
    }
}

/// Where light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Environment,
    Emission,
    /// Index into `Scene::lights`.
    Lamp(usize),
}

impl Source {
    /// Number of its kind: the environment, lamps, what glows.
    pub(super) fn kind(self) -> usize {
        match self {
            Source::Environment => 0,
            Source::Lamp(_) => 1,
            Source::Emission => 2,
        }
    }
}

/// A lamp with a size that a ray meets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met<'a> {
    /// Index into `Scene::lights`.
    pub lamp: usize,
    /// The lamp.
    pub light: &'a Light,
    /// Metres along the ray; infinite for suns.
    pub distance: f32,
    /// Along the ray, not zero.
    pub radiance: Vec3,
}

impl Met<'_> {
    /// No surface after `distance` metres stands in its way: as near to the lamp as rays to lamps go.
    pub(super) fn is_open(&self, distance: f32) -> bool {
        end_before(self.distance) < distance || distance.is_infinite()
    }
}

/// Where a ray to a lamp ends: a lamp that lies on a surface is not hidden by it.
pub(super) fn end_before(distance: f32) -> f32 {
    distance * (1.0 - 1e-4)
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
pub(super) struct Rates {
    of_kinds: [f32; 3],
    /// By which a lamp is chosen, [`lamps::total`].
    lamps: f32,
}

impl Rates {
    /// None at all.
    pub(super) const NONE: Rates = Rates { of_kinds: [0.0; 3], lamps: 0.0 };

    /// One of each, for light that does not need to know the lamps.
    pub(super) const ONE_EACH: Rates = Rates { of_kinds: [1.0; 3], lamps: 0.0 };

    /// One of the lamps.
    pub(super) fn of_lamps(scene: &Scene, receiver: Receiver) -> Rates {
        Rates { of_kinds: [0.0, 0.0, 1.0], lamps: lamps::total(&scene.lights, receiver) }
    }

    pub(super) fn of(&self, kind: Kind) -> f32 {
        self.of_kinds[kind as usize]
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

    /// The sky is drawn by where it is bright.
    pub(super) fn draws_sky(&self) -> bool {
        self.sky.as_ref().is_some_and(|sky| sky.is_sampled())
    }

    /// A direction of the sky with its radiance, drawn with the density of [`Lights::look`].
    pub(super) fn sky_drawn(&self, u: Vec2) -> Option<(Vec3, Vec3)> {
        let sample = self.sky.as_ref()?.sample(u)?;
        Some((sample.direction, sample.radiance))
    }

    /// The rates at a point: one sample of each kind that there is, or one by a guess at their irradiance.
    pub(super) fn rates(&self, scene: &Scene, receiver: Receiver, each: bool) -> Rates {
        let sky = self.sky.as_ref().filter(|sky| sky.is_sampled());
        let sky = sky.map_or(0.0, |sky| std::f32::consts::PI * sky.mean().element_sum() / 3.0);
        let emitters = if self.emitters.is_empty() { 0.0 } else { self.emitters.weight(receiver.position) };
        let lamps = lamps::total(&scene.lights, receiver);
        let weights = [sky, emitters, lamps / 3.0];
        if each {
            return Rates { of_kinds: weights.map(|weight| if weight > 0.0 { 1.0 } else { 0.0 }), lamps };
        }
        let active = weights.iter().filter(|weight| **weight > 0.0).count() as f32;
        let sum: f32 = weights.iter().sum();
        let chance = |weight: f32| {
            if weight > 0.0 { LEAST_CHANCE + (1.0 - active * LEAST_CHANCE) * weight / sum } else { 0.0 }
        };
        Rates { of_kinds: weights.map(chance), lamps }
    }

    /// Light of a kind to a point, for its rate; `u` in `[0, 1)^3`. `None` where none is found.
    pub(super) fn sample(
        &self,
        scene: &Scene,
        receiver: Receiver,
        kind: Kind,
        rates: &Rates,
        u: Vec3,
    ) -> Option<LightSample> {
        let rate = rates.of(kind);
        match kind {
            Kind::Sky => {
                let sample = self.sky.as_ref()?.sample(u.truncate())?;
                let (direction, pdf) = (sample.direction, rate * sample.pdf);
                let weight = sample.radiance / pdf;
                let (end, source) = (End::Distance(f32::INFINITY), Source::Environment);
                Some(LightSample { direction, end, weight, pdf, source })
            }
            Kind::Emitters => self.sample_emitters(scene, receiver.position, rate, u),
            Kind::Lamps => {
                let drawn = lamps::sample(&scene.lights, receiver, rates.lamps, u)?;
                let (weight, pdf) = (drawn.weight / rate, drawn.pdf * rate);
                let (end, source) = (End::Distance(drawn.distance), Source::Lamp(drawn.lamp));
                Some(LightSample { direction: drawn.direction, end, weight, pdf, source })
            }
        }
    }

    fn sample_emitters(&self, scene: &Scene, position: Vec3, rate: f32, u: Vec3) -> Option<LightSample> {
        let sample = self.emitters.sample(scene, position, Vec3::new(u.z, u.x, u.y))?;
        let pdf = rate * sample.pdf;
        let direction = (sample.point - position).normalize();
        let end = End::Surface { point: sample.point, rounding: sample.rounding, normal: sample.normal };
        Some(LightSample { direction, end, weight: sample.radiance / pdf, pdf, source: Source::Emission })
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

    /// The lamps with a size that a ray meets, behind surfaces too.
    pub(super) fn met(scene: &Scene, origin: Vec3, direction: Vec3) -> impl Iterator<Item = Met<'_>> {
        scene.lights.iter().enumerate().filter_map(move |(lamp, light)| {
            let distance = shapes::meet(light, origin, direction)?;
            let radiance = light.radiance();
            (radiance != Vec3::ZERO).then_some(Met { lamp, light, distance, radiance })
        })
    }

    /// Density with which a lamp is sampled that a ray from a receiver meets, with the rate.
    pub(super) fn lamp_pdf(rates: &Rates, receiver: Receiver, met: &Met<'_>, direction: Vec3) -> f32 {
        rates.of(Kind::Lamps) * lamps::pdf(met.light, receiver, rates.lamps, direction, met.distance)
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
