//! One path, from the eye to the light.

use glam::Vec3;

use super::backdrop;
use super::bsdf::Bsdf;
use super::lamps::Receiver;
use super::lights::{End, Kind, LightSample, Lights, Rates, Source, end_before};
use super::point::Point;
use super::sampler::PathSampler;
use super::waves::Waves;
use super::world::{Sight, World};
use super::{FirstHit, PathSample};
use crate::trace::{Ray, offset};

/// Surfaces after which a path may end by chance.
const ROULETTE_FROM: u32 = 4;
/// Least chance to go on.
const SURVIVAL_MIN: f32 = 0.05;

/// A path under way.
struct Path<'a> {
    world: &'a World,
    sampler: PathSampler,
    waves: Waves,
    /// What light from here on is multiplied by.
    throughput: Vec3,
    /// Surfaces met so far.
    surfaces: u32,
    radiance: Vec3,
    /// The same by [`Source::kind`].
    by_source: [Vec3; 3],
    /// Which surfaces the first ray sees.
    sight: Sight,
    /// The first ray met no surface.
    escaped: bool,
    clamped: Vec3,
    rays: u32,
}

/// A path with its light apart by where that comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// Scene-linear radiance of the environment, of lamps, of what glows.
    pub by_source: [Vec3; 3],
    /// It met no surface: the environment's is seen straight.
    pub escaped: bool,
    /// The first surface was met from behind, where it has no back: nothing comes from there.
    pub from_behind: bool,
    /// Rays that were cast.
    pub rays: u32,
}

/// Where and how the last direction was drawn: what the light found at its end is weighed by.
#[derive(Clone, Copy)]
struct Drawn {
    /// None is the eye.
    receiver: Option<Receiver>,
    /// Per steradian; infinite from the eye and from mirrors.
    pdf: f32,
    /// Samples of light at that position.
    rates: Rates,
}

impl Drawn {
    const FROM_EYE: Drawn = Drawn { receiver: None, pdf: f32::INFINITY, rates: Rates::NONE };
}

/// A surface on the way, with the samples of light that it gets.
struct Lit<'a> {
    receiver: Receiver,
    point: &'a Point<'a>,
    bsdf: &'a Bsdf<'a>,
    rates: &'a Rates,
}

/// Follows a path along a ray from the eye.
pub(super) fn trace(world: &World, ray: Ray, sampler: PathSampler, waves: Waves) -> PathSample {
    let mut path = Path::new(world, sampler, waves);
    let first = path.follow(ray);
    PathSample { radiance: waves.to_rgb(path.radiance), clamped: waves.to_rgb(path.clamped), first, rays: path.rays }
}

/// The same with the light apart, along a ray from a surface, which meets the backs of others.
pub(super) fn trace_apart(world: &World, ray: Ray, sampler: PathSampler, waves: Waves) -> Apart {
    let mut path = Path { sight: Sight::Light, ..Path::new(world, sampler, waves) };
    let first = path.follow(ray);
    Apart {
        by_source: path.by_source.map(|light| waves.to_rgb(light)),
        escaped: path.escaped,
        from_behind: first.is_none() && !path.escaped,
        rays: path.rays,
    }
}

impl<'a> Path<'a> {
    fn new(world: &'a World, sampler: PathSampler, waves: Waves) -> Path<'a> {
        Path {
            world,
            sampler,
            waves,
            throughput: Vec3::ONE,
            surfaces: 0,
            radiance: Vec3::ZERO,
            by_source: [Vec3::ZERO; 3],
            sight: Sight::Eye,
            escaped: false,
            clamped: Vec3::ZERO,
            rays: 0,
        }
    }

    fn follow(&mut self, mut ray: Ray) -> Option<FirstHit> {
        let world = self.world;
        let mut first = None;
        let mut drawn = Drawn::FROM_EYE;
        loop {
            let sight = if self.surfaces == 0 { self.sight } else { Sight::Light };
            let salt = self.sampler.salt().wrapping_add(self.surfaces);
            self.rays += 1;
            let hit = world.closest(&ray, sight, salt);
            self.meet_lamps(&drawn, &ray, hit.as_ref().map_or(f32::INFINITY, |hit| hit.t));
            let Some(hit) = hit else {
                match self.surfaces {
                    0 => {
                        self.escaped = true;
                        self.background(&ray);
                    }
                    _ => self.escape(&drawn, ray.direction),
                }
                return first;
            };
            let to_viewer = -ray.direction;
            let point = Point::new(world, &hit, to_viewer, self.waves);
            if !point.front && !world.is_two_sided(hit.instance) {
                return first;
            }
            let bsdf = Bsdf::new(world, &point, to_viewer);
            if point.emission != Vec3::ZERO {
                let pdf = || {
                    let from = drawn.receiver.map_or(ray.origin, |receiver| receiver.position);
                    drawn.rates.of(Kind::Emitters) * world.lights().emitter_pdf(from, &hit, &point)
                };
                self.add(balance(drawn.pdf, pdf) * bsdf.passed() * point.emission, Source::Emission);
            }
            if self.surfaces == 0 {
                let (normal, albedo) = (point.base.n, self.waves.to_rgb(bsdf.albedo()));
                first = Some(FirstHit { normal, albedo, instance: hit.instance, material: point.material });
            }
            if self.surfaces == world.options().bounces {
                return first;
            }
            self.surfaces += 1;
            let [ux, uy, uz, choice] = self.sampler.next4();
            let mut rates = Rates::NONE;
            let receiver = Receiver { position: point.position, instance: hit.instance };
            if bsdf.has_density() {
                // What is seen straight, or in mirrors, is most of the picture: there it gets a sample of each kind.
                let each = !drawn.pdf.is_finite();
                rates = world.lights().rates(world.scene(), receiver, each);
                let at = Lit { receiver, point: &point, bsdf: &bsdf, rates: &rates };
                if each { self.light_of_each(&at) } else { self.light(&at, choice) }
            }
            let Some(sample) = bsdf.sample(Vec3::new(ux, uy, uz)) else { return first };
            self.throughput *= sample.weight;
            if !self.survives() {
                return first;
            }
            drawn = Drawn { receiver: Some(receiver), pdf: sample.pdf, rates };
            let origin = offset(point.position, point.rounding, point.geometric, sample.wi);
            ray = Ray { origin, direction: sample.wi, t_max: f32::INFINITY };
        }
    }

    /// Adds what the eye sees behind everything.
    fn background(&mut self, ray: &Ray) {
        let seen = backdrop::look(self.world, ray, &mut self.sampler);
        self.rays += seen.rays;
        self.add(self.waves.of_rgb(seen.radiance), Source::Environment);
        if seen.shadow != Vec3::ZERO {
            // Whatever the lights that are blocked: it is their absence from the picture of the ground.
            self.add(-self.waves.of_rgb(seen.shadow), Source::Environment);
        }
    }

    /// Adds the sky.
    fn escape(&mut self, drawn: &Drawn, direction: Vec3) {
        let lights = self.world.lights();
        let light = if drawn.pdf.is_finite() {
            let (light, pdf) = lights.look(direction);
            light * balance(drawn.pdf, || drawn.rates.of(Kind::Sky) * pdf)
        } else {
            lights.sky(direction)
        };
        self.add(self.waves.of_rgb(light), Source::Environment);
    }

    /// Adds the lamps with a size that the ray meets on its way to a surface after `distance` metres.
    fn meet_lamps(&mut self, drawn: &Drawn, ray: &Ray, distance: f32) {
        for met in Lights::met(self.world.scene(), ray.origin, ray.direction) {
            let light = match drawn.receiver {
                None => met.light.camera && met.is_open(distance),
                Some(Receiver { instance, .. }) => {
                    let is_open = !met.light.shadows || met.is_open(distance);
                    is_open && met.light.reflections && met.light.lights(instance as usize)
                }
            };
            if light {
                let pdf = || drawn.receiver.map_or(0.0, |at| Lights::lamp_pdf(&drawn.rates, at, &met, ray.direction));
                let weight = balance(drawn.pdf, pdf);
                self.add(weight * self.waves.of_rgb(met.radiance), Source::Lamp(met.lamp));
            }
        }
    }

    /// Adds a sample of every kind of light.
    fn light_of_each(&mut self, at: &Lit) {
        for kind in Kind::ALL {
            if at.rates.of(kind) > 0.0 {
                let [x, y, z, _] = self.sampler.next4();
                self.light_of(at, kind, Vec3::new(x, y, z));
            }
        }
    }

    /// Adds a sample of light, of a kind by its rate.
    fn light(&mut self, at: &Lit, choice: f32) {
        let [x, y, ..] = self.sampler.next4();
        if let Some((kind, z)) = at.rates.choose(choice) {
            self.light_of(at, kind, Vec3::new(x, y, z));
        }
    }

    fn light_of(&mut self, at: &Lit, kind: Kind, u: Vec3) {
        let world = self.world;
        let Some(sample) = world.lights().sample(world.scene(), at.receiver, kind, at.rates, u) else { return };
        let light = received(world, at.bsdf, &sample) * self.waves.of_rgb(sample.weight);
        // Also false for numbers that are none; those are to be found by the film.
        if light == Vec3::ZERO {
            return;
        }
        let salt = self.sampler.salt().wrapping_sub(self.surfaces);
        if casts_shadows(world, &sample) {
            self.rays += 1;
            if world.occluded(&shadow_ray(at.point, &sample), salt) {
                return;
            }
        }
        self.add(light, sample.source);
    }

    /// Adds radiance that comes along the path, clamped after the first surface, if the picture is to show its source.
    fn add(&mut self, light: Vec3, source: Source) {
        if !self.world.options().contribution.shows(source) {
            return;
        }
        let light = self.throughput * light;
        let most = self.world.options().clamp;
        let largest = light.max_element();
        let mut kept = light;
        if self.surfaces > 1 && largest > most {
            kept = light * (most / largest);
            self.clamped += light - kept;
        }
        self.radiance += kept;
        self.by_source[source.kind()] += kept;
    }

    /// Russian roulette by the throughput.
    fn survives(&mut self) -> bool {
        let largest = self.throughput.max_element();
        if largest <= 0.0 {
            return false;
        }
        if self.surfaces < ROULETTE_FROM {
            return true;
        }
        let chance = largest.clamp(SURVIVAL_MIN, 1.0);
        if chance < 1.0 {
            if self.sampler.independent() >= chance {
                return false;
            }
            self.throughput /= chance;
        }
        true
    }
}

/// Weight of light that was met with density `pdf` and might have been drawn with another: the balance heuristic.
pub(super) fn balance(pdf: f32, other: impl FnOnce() -> f32) -> f32 {
    if pdf.is_finite() { pdf / (pdf + other()) } else { 1.0 }
}

/// What a surface sends on of light that was drawn, over its density: the response with its cosine, and the weight of the
/// balance heuristic (Veach 1997, section 9.2.4) where a direction from the surface might have met it.
pub(super) fn received(world: &World, bsdf: &Bsdf, sample: &LightSample) -> Vec3 {
    let is_matte_only = sample.lamp(world.scene()).is_some_and(|lamp| !lamp.reflections);
    if is_matte_only {
        return bsdf.eval_matte(sample.direction);
    }
    let (value, pdf) = bsdf.eval(sample.direction);
    if sample.pdf.is_finite() { value * (sample.pdf / (sample.pdf + pdf)) } else { value }
}

/// Surfaces may stand in the way of the light.
pub(super) fn casts_shadows(world: &World, sample: &LightSample) -> bool {
    sample.lamp(world.scene()).is_none_or(|lamp| lamp.shadows)
}

pub(super) fn shadow_ray(point: &Point, sample: &LightSample) -> Ray {
    let origin = offset(point.position, point.rounding, point.geometric, sample.direction);
    match sample.end {
        End::Distance(distance) => Ray { origin, direction: sample.direction, t_max: end_before(distance) },
        End::Surface { point: end, rounding, normal } => {
            let end = offset(end, rounding, normal, -sample.direction);
            let toward = end - origin;
            let t_max = toward.length();
            Ray { origin, direction: toward / t_max, t_max }
        }
    }
}
