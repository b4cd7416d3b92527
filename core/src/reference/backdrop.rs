//! What rays from the eye see that meet no surface, with the shadows of the scene on the ground of the background.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::lamps::{self, Receiver};
use super::lights::end_before;
use super::path::balance;
use super::sampler::PathSampler;
use super::shapes;
use super::world::World;
use crate::math::sampling::cosine_hemisphere;
use crate::scene::Light;
use crate::trace::Ray;

/// How far above the ground shadow rays start, as a share of the height of the map above it.
const LIFT: f32 = 1e-4;
/// Directions across and up by which the light of a lamp with a size is summed.
const GRID: u32 = 8;

/// The background along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// Without shadows.
    pub radiance: Vec3,
    /// What shadows take away, in the mean over many samples.
    pub shadow: Vec3,
    /// Rays that were cast.
    pub rays: u32,
}

/// Looks at the background along a ray.
///
/// The ground is a picture of one that all light reaches. Where surfaces block light it is darker by the blocked share of the
/// irradiance on an upward plane, per channel: `radiance blocked / all`. `all` is known, so that a sample of `blocked` is right
/// in the mean.
pub(super) fn look(world: &World, ray: &Ray, sampler: &mut PathSampler) -> Seen {
    let scene = world.scene();
    let background = &scene.background;
    let found = background.look(ray.origin, ray.direction);
    let radiance = match &background.map {
        Some(map) => map.radiance(found.direction),
        None => world.lights().sky(found.direction),
    };
    let catcher = background.ground.filter(|ground| ground.shadows);
    let Some((ground, point)) = catcher.zip(found.ground) else {
        return Seen { radiance, shadow: Vec3::ZERO, rays: 0 };
    };
    let point = point + LIFT * ground.height * Vec3::Y;
    let plane = Plane { world, point, salt: sampler.salt() };
    let ([a, b, x, y], [c, d, z, _]) = (sampler.next4(), sampler.next4());
    let all = world.lights().sky_up() + plane.lamps();
    let (from_sky, sky_rays) = plane.blocked_sky(Vec2::new(a, b), Vec2::new(c, d));
    let (from_lamps, lamp_rays) = plane.blocked_lamp(Vec3::new(x, y, z));
    let blocked = from_sky + from_lamps;
    let share = |blocked: f32, all: f32| if all > 0.0 { blocked / all } else { 0.0 };
    let share = Vec3::new(share(blocked.x, all.x), share(blocked.y, all.y), share(blocked.z, all.z));
    Seen { radiance, shadow: radiance * share, rays: sky_rays + lamp_rays }
}

/// A point of the ground.
struct Plane<'a> {
    world: &'a World,
    point: Vec3,
    salt: u32,
}

impl Plane<'_> {
    fn is_blocked(&self, direction: Vec3, distance: f32) -> bool {
        let ray = Ray { origin: self.point, direction, t_max: distance };
        self.world.occluded(&ray, self.salt)
    }

    /// Irradiance of the sky that surfaces block, by a direction toward its light and one by the cosine.
    fn blocked_sky(&self, for_light: Vec2, for_cosine: Vec2) -> (Vec3, u32) {
        let lights = self.world.lights();
        let (mut blocked, mut rays) = (Vec3::ZERO, 0);
        let mut add = |direction: Vec3, light: Vec3| {
            if light != Vec3::ZERO {
                rays += 1;
                if self.is_blocked(direction, f32::INFINITY) {
                    blocked += light;
                }
            }
        };
        if let Some((direction, radiance, pdf)) = lights.sample_sky(for_light)
            && direction.y > 0.0
        {
            add(direction, radiance * direction.y / (pdf + direction.y / PI));
        }
        // About z; any turn about it is as good.
        let drawn = cosine_hemisphere(for_cosine);
        let direction = Vec3::new(drawn.x, drawn.z, drawn.y);
        if direction.y > 0.0 {
            let (radiance, pdf) = lights.look(direction);
            add(direction, PI * radiance * balance(direction.y / PI, || pdf));
        }
        (blocked, rays)
    }

    /// Irradiance of all lamps, shadows left aside; those with a size by a grid of directions.
    fn lamps(&self) -> Vec3 {
        let of = |light: &Light| {
            if light.kind.is_sharp() {
                let lamp = lamps::at(light, self.point);
                return lamp.irradiance * lamp.direction.y.max(0.0);
            }
            let cell = |i: u32| Vec2::new((i % GRID) as f32 + 0.5, (i / GRID) as f32 + 0.5) / GRID as f32;
            let drawn = (0..GRID * GRID).filter_map(|i| shapes::sample(light, self.point, cell(i)));
            let sum: f32 = drawn.map(|drawn| drawn.direction.y.max(0.0) / drawn.pdf).sum();
            shapes::radiance(light) * sum / (GRID * GRID) as f32
        };
        self.world.scene().lights.iter().map(of).sum()
    }

    /// Irradiance of the lamps that surfaces block, by a direction to one of them.
    fn blocked_lamp(&self, u: Vec3) -> (Vec3, u32) {
        let lights = &self.world.scene().lights;
        let receiver = Receiver { position: self.point, instance: u32::MAX };
        let total = lamps::total(lights, receiver);
        let Some(lamp) = lamps::sample(lights, receiver, total, u) else { return (Vec3::ZERO, 0) };
        let light = lamp.weight * lamp.direction.y.max(0.0);
        if light == Vec3::ZERO || !lights[lamp.lamp].shadows {
            return (Vec3::ZERO, 0);
        }
        let blocked = self.is_blocked(lamp.direction, end_before(lamp.distance));
        (if blocked { light } else { Vec3::ZERO }, 1)
    }
}

#[cfg(test)]
#[path = "backdrop_tests.rs"]
mod tests;
