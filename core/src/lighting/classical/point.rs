//! The method on the processor: at points of surfaces, over cubes that the processor made.

use glam::{Vec2, Vec3};

use super::cubes::PreparedMaps;
use super::evaluate::facing;
use super::{FrameSettings, Lobes, MeanFresnel, environment};
use crate::lighting::{Prepared, ShadePoint, area};
use crate::param::Settings;
use crate::reference::SurfacePoint;

use super::Classical;

impl ShadePoint for Classical {
    fn radiance(&self, point: &SurfacePoint<'_>, prepared: &Prepared, settings: &Settings, random: [f32; 4]) -> Vec3 {
        let direct = point.emission() + point.punctual() + wide(point, Vec2::new(random[2], random[3]));
        let map = point.world().scene().environment.as_ref();
        let Some(maps) = map.and_then(|map| PreparedMaps::new(prepared, map)) else { return direct };
        let FrameSettings { samples, .. } = FrameSettings::new(settings);
        let lobes = Lobes { samples, rotation: Vec2::new(random[0], random[1]) };
        let surface = point.surface();
        let mean = MeanFresnel::of(surface.fresnel);
        let (base, coat, occlusion) = (point.base(), point.coat(), point.occlusion());
        direct + environment(&maps, &surface, mean, base, coat, point.to_viewer(), occlusion, lobes)
    }
}

/// Lights with an area: cosines, times the share of the light that is seen.
fn wide(point: &SurfacePoint<'_>, u: Vec2) -> Vec3 {
    let lights = &point.world().scene().lights;
    let (surface, position, normal) = (point.surface(), point.position(), point.geometric_normal());
    let [wo, coat_wo] = [point.base(), point.coat()].map(|frame| facing(frame.to_local(point.to_viewer())));
    let mut sum = Vec3::ZERO;
    for light in lights.iter().filter(|light| light.lights(point.instance() as usize)) {
        let Some((shape, radiance)) = area::light::shape(light, position) else { continue };
        let [base, coat] = [point.base(), point.coat()].map(|frame| shape.local(frame));
        let value = radiance * area::response(&surface, wo, &base, coat_wo, &coat, light.reflections);
        if value == Vec3::ZERO {
            continue;
        }
        let sees = |direction, distance| point.sees(direction, distance);
        sum += value * if light.shadows { area::light::visible(light, &shape, position, normal, u, sees) } else { 1.0 };
    }
    sum
}
