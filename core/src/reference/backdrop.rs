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

/// Points along each side of a lamp with a size, by which its irradiance is known.
const SHAPE_POINTS: u32 = 6;

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
    let ([a, b, c, d], [x, y, z, _]) = (sampler.next4(), sampler.next4());
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

    /// The ground as it receives light: no instance, so that all lamps light it.
    fn receiver(&self) -> Receiver {
        Receiver { position: self.point, instance: u32::MAX }
    }

    /// Irradiance of all lamps, shadows left aside.
    fn lamps(&self) -> Vec3 {
        self.world.scene().lights.iter().map(|light| self.lamp(light)).sum()
    }

    /// Irradiance of a lamp; of one with a size by points spread evenly over what is seen of it.
    fn lamp(&self, light: &Light) -> Vec3 {
        if light.kind.is_sharp() {
            let lamp = lamps::at(light, self.point);
            return lamp.irradiance * lamp.direction.y.max(0.0);
        }
        let n = SHAPE_POINTS;
        let points = (0..n * n).map(|i| Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32);
        let drawn = points.filter_map(|u| shapes::sample(light, self.point, u));
        let sum: f32 = drawn.map(|drawn| drawn.direction.y.max(0.0) / drawn.pdf).filter(|v| v.is_finite()).sum();
        light.radiance() * sum / (n * n) as f32
    }

    /// Irradiance of the lamps that surfaces block, by one of them; its x and y are for the place on it.
    fn blocked_lamp(&self, u: Vec3) -> (Vec3, u32) {
        let (lights, receiver) = (&self.world.scene().lights, self.receiver());
        let total = lamps::total(lights, receiver);
        let Some(drawn) = lamps::sample(lights, receiver, total, u) else { return (Vec3::ZERO, 0) };
        let light = drawn.weight * drawn.direction.y.max(0.0);
        if light == Vec3::ZERO || !lights[drawn.lamp].shadows {
            return (Vec3::ZERO, 0);
        }
        let blocked = self.is_blocked(drawn.direction, end_before(drawn.distance));
        (if blocked { light } else { Vec3::ZERO }, 1)
    }
}

#[cfg(test)]
#[path = "backdrop_tests.rs"]
mod tests;
