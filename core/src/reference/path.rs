//! One path, from the eye to the light.

use glam::Vec3;

use super::backdrop;
use super::bsdf::Bsdf;
use super::lights::{End, Kind, LightSample, Rates};
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
    clamped: Vec3,
    rays: u32,
}

/// Where and how the last direction was drawn: what the light found at its end is weighed by.
#[derive(Clone, Copy)]
struct Drawn {
    position: Vec3,
    /// Per steradian; infinite from the eye and from mirrors.
    pdf: f32,
    /// Samples of light at that position.
    rates: Rates,
}

/// Follows a path along a ray from the eye.
pub(super) fn trace(world: &World, ray: Ray, sampler: PathSampler, waves: Waves) -> PathSample {
    let mut path = Path {
        world,
        sampler,
        waves,
        throughput: Vec3::ONE,
        surfaces: 0,
        radiance: Vec3::ZERO,
        clamped: Vec3::ZERO,
        rays: 0,
    };
    let first = path.follow(ray);
    PathSample { radiance: waves.to_rgb(path.radiance), clamped: waves.to_rgb(path.clamped), first, rays: path.rays }
}

impl Path<'_> {
    fn follow(&mut self, mut ray: Ray) -> Option<FirstHit> {
        let world = self.world;
        let mut first = None;
        let mut drawn = Drawn { position: ray.origin, pdf: f32::INFINITY, rates: Rates::NONE };
        loop {
            let sight = if self.surfaces == 0 { Sight::Eye } else { Sight::Light };
            let salt = self.sampler.salt().wrapping_add(self.surfaces);
            self.rays += 1;
            let Some(hit) = world.closest(&ray, sight, salt) else {
                if self.surfaces == 0 {
                    self.background(&ray)
                } else {
                    self.escape(&drawn, ray.direction)
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
                let pdf = || drawn.rates.of(Kind::Emitters) * world.lights().emitter_pdf(drawn.position, &hit, &point);
                self.add(balance(drawn.pdf, pdf) * bsdf.passed() * point.emission);
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
            if bsdf.has_density() {
                // What is seen straight, or in mirrors, is most of the picture: there it gets a sample of each kind.
                let each = !drawn.pdf.is_finite();
                rates = world.lights().rates(world.scene(), point.position, each);
                if each { self.light_of_each(&point, &bsdf, &rates) } else { self.light(&point, &bsdf, &rates, choice) }
            }
            let Some(sample) = bsdf.sample(Vec3::new(ux, uy, uz)) else { return first };
            self.throughput *= sample.weight;
            if !self.survives() {
                return first;
            }
            drawn = Drawn { position: point.position, pdf: sample.pdf, rates };
            let origin = offset(point.position, point.rounding, point.geometric, sample.wi);
            ray = Ray { origin, direction: sample.wi, t_max: f32::INFINITY };
        }
    }

    /// Adds what the eye sees behind everything.
    fn background(&mut self, ray: &Ray) {
        let seen = backdrop::look(self.world, ray, &mut self.sampler);
        self.rays += seen.rays;
        self.add(self.waves.of_rgb(seen.radiance));
        if seen.shadow != Vec3::ZERO {
            self.add(-self.waves.of_rgb(seen.shadow));
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
        self.add(self.waves.of_rgb(light));
    }

    /// Adds a sample of every kind of light.
    fn light_of_each(&mut self, point: &Point, bsdf: &Bsdf, rates: &Rates) {
        for kind in Kind::ALL {
            if rates.of(kind) > 0.0 {
                let [x, y, z, _] = self.sampler.next4();
                self.light_of(point, bsdf, kind, rates.of(kind), Vec3::new(x, y, z));
            }
        }
    }

    /// Adds a sample of light, of a kind by its rate.
    fn light(&mut self, point: &Point, bsdf: &Bsdf, rates: &Rates, choice: f32) {
        let [x, y, ..] = self.sampler.next4();
        if let Some((kind, z)) = rates.choose(choice) {
            self.light_of(point, bsdf, kind, rates.of(kind), Vec3::new(x, y, z));
        }
    }

    fn light_of(&mut self, point: &Point, bsdf: &Bsdf, kind: Kind, rate: f32, u: Vec3) {
        let world = self.world;
        let Some(sample) = world.lights().sample(world.scene(), point.position, kind, rate, u) else { return };
        let (value, pdf) = bsdf.eval(sample.direction);
        let mut light = value * self.waves.of_rgb(sample.weight);
        if sample.pdf.is_finite() {
            // The balance heuristic of Veach 1997, section 9.2.4.
            light *= sample.pdf / (sample.pdf + pdf);
        }
        // Also false for numbers that are none; those are to be found by the film.
        if light == Vec3::ZERO {
            return;
        }
        let ray = shadow_ray(point, &sample);
        let salt = self.sampler.salt().wrapping_sub(self.surfaces);
        self.rays += 1;
        if !world.occluded(&ray, salt) {
            self.add(light);
        }
    }

    /// Adds radiance that comes along the path, clamped after the first surface.
    fn add(&mut self, light: Vec3) {
        let light = self.throughput * light;
        let most = self.world.options().clamp;
        let largest = light.max_element();
        if self.surfaces > 1 && largest > most {
            let kept = light * (most / largest);
            self.clamped += light - kept;
            self.radiance += kept;
        } else {
            self.radiance += light;
        }
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

pub(super) fn shadow_ray(point: &Point, sample: &LightSample) -> Ray {
    let origin = offset(point.position, point.rounding, point.geometric, sample.direction);
    match sample.end {
        // A lamp that lies on a surface is not hidden by it.
        End::Distance(distance) => Ray { origin, direction: sample.direction, t_max: distance * (1.0 - 1e-4) },
        End::Surface { point: end, rounding, normal } => {
            let end = offset(end, rounding, normal, -sample.direction);
            let toward = end - origin;
            let t_max = toward.length();
            Ray { origin, direction: toward / t_max, t_max }
        }
    }
}
