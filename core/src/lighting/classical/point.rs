//! The method on the processor: at points of surfaces, over cubes that the processor made.

use glam::{Vec2, Vec3};

use super::cubes::PreparedMaps;
use super::{FrameSettings, Lobes, MeanFresnel, environment};
use crate::lighting::{Prepared, ShadePoint};
use crate::param::Settings;
use crate::reference::SurfacePoint;

use super::Classical;

impl ShadePoint for Classical {
    fn radiance(&self, point: &SurfacePoint<'_>, prepared: &Prepared, settings: &Settings, random: [f32; 4]) -> Vec3 {
        // Lights with a size by sampling.
        let direct = point.emission() + point.punctual() + point.wide_lamps(random).0;
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
