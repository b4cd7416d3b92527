//! Where rays from the eye meet surfaces: the processor's G-buffer, for methods that shade point by point.

use glam::{UVec2, Vec2, Vec3};

use super::backdrop;
use super::bsdf::Bsdf;
use super::lamps;
use super::lights::{End, Kind};
use super::path::{balance, shadow_ray};
use super::point::{Point, Triangle};
use super::sampler::PathSampler;
use super::texture::lookup;
use super::waves::Waves;
use super::world::{Sight, World};
use super::{PathSample, View};
use crate::math::frame::Frame;
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

    /// The background along the ray.
    pub fn miss(&self) -> PathSample {
        let seen = backdrop::look(self.world, &self.ray, &mut self.sampler.clone());
        PathSample { radiance: seen.radiance - seen.shadow, clamped: Vec3::ZERO, first: None, rays: 1 + seen.rays }
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

    /// Nothing lies on the way from the point in a direction (world, unit), over `distance` metres.
    pub fn sees(&self, direction: Vec3, distance: f32) -> bool {
        let origin = offset(self.point.position, self.point.rounding, self.point.geometric, direction);
        !self.world.occluded(&Ray { origin, direction, t_max: distance * (1.0 - 1e-4) }, self.salt)
    }

    /// Radiance of the sky from a direction (world, unit), whether it is seen or not.
    pub fn sky(&self, direction: Vec3) -> Vec3 {
        self.world.lights().sky(direction)
    }

    /// Direct light of the lamps, of one drawn by `random`, with its shadow; and the rays that were cast.
    pub fn lamps(&self, random: [f32; 4]) -> (Vec3, u32) {
        let [x, y, z, _] = random;
        let (lights, scene) = (self.world.lights(), self.world.scene());
        let Some(sample) = lights.sample(scene, self.point.position, Kind::Lamps, 1.0, Vec3::new(x, y, z)) else {
            return (Vec3::ZERO, 0);
        };
        let light = self.response(sample.direction) * sample.weight;
        if light == Vec3::ZERO || !matches!(sample.end, End::Distance(_)) {
            return (Vec3::ZERO, 0);
        }
        let seen = !self.world.occluded(&shadow_ray(&self.point, &sample), self.salt);
        (if seen { light } else { Vec3::ZERO }, 1)
    }

    /// Direct light of all punctual lights, each with its shadow.
    pub fn punctual(&self) -> Vec3 {
        let lights = self.world.scene().lights.iter();
        let lit = lights.map(|light| lamps::at(light, self.point.position)).map(|lamp| {
            let light = self.response(lamp.direction) * lamp.irradiance;
            if light != Vec3::ZERO && self.sees(lamp.direction, lamp.distance) { light } else { Vec3::ZERO }
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
        let drawn = lights.sample(scene, self.point.position, Kind::Sky, 1.0, three(for_light));
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

    fn bsdf(&self) -> Bsdf<'_> {
        Bsdf::new(self.world, &self.point, self.to_viewer)
    }
}
