//! Where rays from the eye meet surfaces: the processor's G-buffer, for methods that shade point by point.

use glam::{UVec2, Vec2, Vec3};

use super::backdrop;
use super::bsdf::{Bsdf, BsdfSample};
use super::lamps::{self, Receiver};
use super::lights::{Kind, Lights, Rates};
use super::path::{balance, casts_shadows, received, shadow_ray};
use super::point::{Point, Triangle};
use super::sampler::PathSampler;
use super::texture::lookup;
use super::waves::Waves;
use super::world::{Sight, World};
use super::{PathSample, View};
use crate::math::frame::Frame;
use crate::math::sampling::{pcg, unit};
use crate::surface::layered::Surface;
use crate::trace::{Hit, Ray, offset};

/// A ray from the eye with the random numbers of its sample.
#[derive(Clone, Debug)]
pub struct Eye<'a> {
    world: &'a World,
    ray: Ray,
    hit: Option<Hit>,
    sampler: PathSampler,
}

/// A visible surface at a point, with its textures looked up, seen from where the ray came from.
#[derive(Clone, Debug)]
pub struct SurfacePoint<'a> {
    world: &'a World,
    point: Point<'a>,
    hit: &'a Hit,
    to_viewer: Vec3,
    salt: u32,
}

/// A direction drawn from a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// World, unit.
    pub direction: Vec3,
    /// BSDF times cosine over the density: what radiance from there is multiplied by.
    pub weight: Vec3,
    /// Per steradian; infinite for a mirror.
    pub pdf: f32,
}

impl<'a> Eye<'a> {
    /// Sends ray number `index` through a place in a pixel, as [`World::sample`] does.
    pub fn new(world: &'a World, view: &View, pixel: UVec2, index: u32) -> Eye<'a> {
        let mut sampler = PathSampler::new(view.seed, pixel, index);
        let [x, y, ..] = sampler.next4();
        let size = view.size.as_vec2();
        let start = view.camera.ray((pixel.as_vec2() + Vec2::new(x, y)) / size, size.x / size.y);
        let ray = Ray { origin: start.origin, direction: start.direction, t_max: f32::INFINITY };
        let hit = world.closest(&ray, Sight::Eye, sampler.salt());
        Eye { world, ray, hit, sampler }
    }

    /// The same along a ray from elsewhere, which meets what light does: the numbers of a sample are those of [`World::along_apart`].
    pub fn along(world: &'a World, origin: Vec3, direction: Vec3, pixel: UVec2, index: u32) -> Eye<'a> {
        let sampler = PathSampler::new(0, pixel, index);
        let ray = Ray { origin, direction, t_max: f32::INFINITY };
        let hit = world.closest(&ray, Sight::Light, sampler.salt());
        Eye { world, ray, hit, sampler }
    }

    /// The surface that it meets; `None` where it sees the sky.
    pub fn point(&self) -> Option<SurfacePoint<'_>> {
        let hit = self.hit.as_ref()?;
        let to_viewer = -self.ray.direction;
        let point = Point::new(self.world, hit, to_viewer, Waves::Rgb);
        Some(SurfacePoint { world: self.world, point, hit, to_viewer, salt: self.sampler.salt() })
    }

    /// The next four numbers of this sample in `[0, 1)`.
    pub fn random(&mut self) -> [f32; 4] {
        self.sampler.next4()
    }

    /// Radiance of the sky from a direction (world, unit), whether it is seen or not.
    pub fn sky(&self, direction: Vec3) -> Vec3 {
        self.world.lights().sky(direction)
    }

    /// Radiance of the lamps that the eye sees as shapes along the ray, before the surface that it meets.
    pub fn lamps_seen(&self) -> Vec3 {
        let distance = self.hit.as_ref().map_or(f32::INFINITY, |hit| hit.t);
        let met = Lights::met(self.world.scene(), self.ray.origin, self.ray.direction);
        met.filter(|met| met.light.camera && met.is_open(distance)).map(|met| met.radiance).sum()
    }

    /// The background along the ray, and lamps before it.
    pub fn miss(&self) -> PathSample {
        let seen = backdrop::look(self.world, &self.ray, &mut self.sampler.clone());
        let radiance = seen.radiance - seen.shadow + self.lamps_seen();
        PathSample { radiance, clamped: Vec3::ZERO, first: None, rays: 1 + seen.rays }
    }
}

/// How a surface reflects toward the viewer, for many directions.
#[derive(Clone, Debug)]
pub struct Reflecting<'a>(Bsdf<'a>);

impl Reflecting<'_> {
    /// Response to light from a direction (world, unit): BSDF times cosine; and the density with which [`Reflecting::drawn`] draws the direction, per
    /// steradian. A mirror has neither.
    pub fn response_and_density(&self, direction: Vec3) -> (Vec3, f32) {
        self.0.eval(direction)
    }

    /// A direction drawn by how the surface reflects; `u` in `[0, 1)^3`. `None` where it reflects nothing there.
    pub fn drawn(&self, u: Vec3) -> Option<Drawn> {
        let BsdfSample { wi, weight, pdf } = self.0.sample(u)?;
        Some(Drawn { direction: wi, weight, pdf })
    }
}

impl SurfacePoint<'_> {
    /// The scene, ready for rays.
    pub fn world(&self) -> &World {
        self.world
    }

    /// World, metres.
    pub fn position(&self) -> Vec3 {
        self.point.position
    }

    /// Shading normal of the base, world, unit.
    pub fn normal(&self) -> Vec3 {
        self.point.base.n
    }

    /// Normal of the triangle on the viewer's side, world, unit.
    pub fn geometric_normal(&self) -> Vec3 {
        self.point.geometric
    }

    /// Frame of the base, x along the axis of anisotropy.
    pub fn base(&self) -> &Frame {
        &self.point.base
    }

    /// Frame of the coat.
    pub fn coat(&self) -> &Frame {
        &self.point.coat
    }

    /// To the viewer, world, unit.
    pub fn to_viewer(&self) -> Vec3 {
        self.to_viewer
    }

    /// The line of sight mirrored by the shading normal, world, unit.
    pub fn mirrored(&self) -> Vec3 {
        (-self.to_viewer).reflect(self.normal()).normalize_or(self.normal())
    }

    /// What the surface is made of.
    pub fn surface(&self) -> Surface<'_> {
        self.point.surface(self.world)
    }

    /// Share of even light that the surface sends back toward the eye, about.
    pub fn albedo(&self) -> Vec3 {
        self.bsdf().albedo()
    }

    /// Index into `Scene::instances`.
    pub fn instance(&self) -> u32 {
        self.hit.instance
    }

    /// Index into `Scene::materials`.
    pub fn material(&self) -> u32 {
        self.point.material
    }

    /// Radiance that the surface gives off by itself toward the viewer, through its coat.
    pub fn emission(&self) -> Vec3 {
        self.bsdf().passed() * self.point.emission
    }

    /// Response to light from a direction (world, unit): BSDF times cosine.
    pub fn response(&self, direction: Vec3) -> Vec3 {
        self.bsdf().eval(direction).0
    }

    /// How it reflects toward the viewer.
    pub fn reflecting(&self) -> Reflecting<'_> {
        Reflecting(self.bsdf())
    }

    /// The viewer sees the back of a surface that has none: nothing comes from there.
    pub fn is_behind(&self) -> bool {
        !self.point.front && !self.world.is_two_sided(self.hit.instance)
    }

    /// What a ray from the point meets in a direction (world, unit), as light does. `index` sets its random numbers apart.
    pub fn toward(&self, direction: Vec3, index: u32) -> Eye<'_> {
        let origin = offset(self.point.position, self.point.rounding, self.point.geometric, direction);
        let ray = Ray { origin, direction, t_max: f32::INFINITY };
        let sampler = PathSampler::new(index, UVec2::new(direction.x.to_bits(), direction.y.to_bits()), 0);
        let hit = self.world.closest(&ray, Sight::Light, sampler.salt());
        Eye { world: self.world, ray, hit, sampler }
    }

    /// Nothing lies on the way from the point in a direction (world, unit), over `distance` metres.
    pub fn sees(&self, direction: Vec3, distance: f32) -> bool {
        let origin = offset(self.point.position, self.point.rounding, self.point.geometric, direction);
        !self.world.occluded(&Ray { origin, direction, t_max: distance * (1.0 - 1e-4) }, self.salt)
    }

    /// Direct light of the lamps of all kinds, of one drawn by `random` and of those that a direction from the surface meets,
    /// with their shadows; and the rays that were cast.
    pub fn lamps(&self, random: [f32; 4]) -> (Vec3, u32) {
        let [x, y, z, w] = random;
        let (world, receiver, bsdf) = (self.world, self.receiver(), self.bsdf());
        let scene = world.scene();
        let rates = Rates::of_lamps(scene, receiver);
        let (mut light, mut rays) = (Vec3::ZERO, 0);
        let drawn = world.lights().sample(scene, receiver, Kind::Lamps, &rates, Vec3::new(x, y, z));
        if let Some(sample) = drawn {
            let one = received(world, &bsdf, &sample) * sample.weight;
            if one != Vec3::ZERO {
                let shadows = casts_shadows(world, &sample);
                rays += u32::from(shadows);
                let is_dark = shadows && world.occluded(&shadow_ray(&self.point, &sample), self.salt);
                light += if is_dark { Vec3::ZERO } else { one };
            }
        }
        if scene.lights.iter().all(|lamp| lamp.kind.is_sharp()) {
            return (light, rays);
        }
        // Numbers of its own for the surface, made of those for the light.
        let again = |v: f32, i: u32| unit(pcg(pcg(v.to_bits()).wrapping_add(pcg(w.to_bits().wrapping_add(i)))));
        let u = Vec3::new(again(x, 1), again(y, 2), again(z, 3));
        let Some(drawn) = bsdf.sample(u) else { return (light, rays) };
        let origin = offset(self.point.position, self.point.rounding, self.point.geometric, drawn.wi);
        let ray = Ray { origin, direction: drawn.wi, t_max: f32::INFINITY };
        let mut met = Lights::met(scene, origin, drawn.wi).filter(|met| met.light.reflections).peekable();
        if met.peek().is_none() {
            return (light, rays);
        }
        rays += 1;
        let distance = world.closest(&ray, Sight::Light, self.salt).map_or(f32::INFINITY, |hit| hit.t);
        for met in met.filter(|met| met.light.lights(receiver.instance as usize)) {
            if !met.light.shadows || met.is_open(distance) {
                let weight = balance(drawn.pdf, || Lights::lamp_pdf(&rates, receiver, &met, drawn.wi));
                light += weight * drawn.weight * met.radiance;
            }
        }
        (light, rays)
    }

    /// Direct light of all sharp lamps (points, spots, suns without an angle), each with its shadow.
    pub fn punctual(&self) -> Vec3 {
        let scene = self.world.scene();
        let lights = scene.lights.iter().filter(|l| l.kind.is_sharp() && l.lights(self.hit.instance as usize));
        let bsdf = self.bsdf();
        let lit = lights.map(|light| {
            let lamp = lamps::at(light, self.point.position);
            let response =
                if light.reflections { bsdf.eval(lamp.direction).0 } else { bsdf.eval_matte(lamp.direction) };
            let is_seen =
                |value: Vec3| value != Vec3::ZERO && (!light.shadows || self.sees(lamp.direction, lamp.distance));
            let value = response * lamp.irradiance;
            if is_seen(value) { value } else { Vec3::ZERO }
        });
        lit.sum()
    }

    /// Share of even light that the model's occlusion texture leaves, 0 to 1. Paths need none.
    pub fn occlusion(&self) -> f32 {
        let material = self.world.material(self.hit.instance);
        let at = Triangle::new(self.world, self.hit).coordinates();
        let texel = lookup(self.world.scene(), material.occlusion_texture, &at, false);
        texel.map_or(1.0, |texel| 1.0 + material.occlusion_strength * (texel.x - 1.0))
    }

    /// Direct light of the environment as if nothing stood in its way, of a direction to its light and one of the surface:
    /// `random` are for these.
    pub fn environment(&self, [for_light, for_surface]: [[f32; 4]; 2]) -> Vec3 {
        let (lights, scene, bsdf) = (self.world.lights(), self.world.scene(), self.bsdf());
        let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        let drawn = lights.sample(scene, self.receiver(), Kind::Sky, &Rates::ONE_EACH, three(for_light));
        let mut light = drawn.map_or(Vec3::ZERO, |drawn| {
            let (value, pdf) = bsdf.eval(drawn.direction);
            value * drawn.weight * drawn.pdf / (drawn.pdf + pdf)
        });
        if let Some(drawn) = bsdf.sample(three(for_surface)) {
            let (radiance, pdf) = lights.look(drawn.wi);
            light += drawn.weight * radiance * balance(drawn.pdf, || pdf);
        }
        light
    }

    fn receiver(&self) -> Receiver {
        Receiver { position: self.point.position, instance: self.hit.instance }
    }

    fn bsdf(&self) -> Bsdf<'_> {
        Bsdf::new(self.world, &self.point, self.to_viewer)
    }
}
