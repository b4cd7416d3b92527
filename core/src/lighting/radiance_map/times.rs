//! What the parts of a frame cost on the processor, and what other ways of looking up would.

use std::hint::black_box;
use std::time::Instant;

use glam::UVec2;
use rayon::prelude::*;

use super::map::{Map, in_floats};
use super::method::{Effort, RadianceMap, reflected};
use super::near::{Filter, Near, SET, weights};
use crate::lighting::{Drawing, Prepared};
use crate::measure::median;
use crate::param::Settings;
use crate::reference::{Eye, SurfacePoint, View, World};

/// Seconds of a frame of one sample a pixel, on the current rayon pool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameTimes {
    /// Whole.
    pub frame: f64,
    /// Finding the place whose set lights a point.
    pub query: f64,
    /// The mean light of the set.
    pub filter: f64,
    /// What the surface makes of it, with rays of smooth surfaces.
    pub shading: f64,
    /// [`Self::query`] if the eight nearest places were searched for each point.
    pub searched: f64,
    /// [`Self::filter`] by a box.
    pub boxed: f64,
    /// [`Self::filter`] of light in floats.
    pub floats: f64,
}

impl FrameTimes {
    /// Lines of sight, lamps with their shadows, and what else is in a frame.
    pub fn rest(&self) -> f64 {
        self.frame - self.query - self.filter - self.shading
    }
}

/// What a stage does at a point.
type Stage<'a> = &'a (dyn Fn(&SurfacePoint<'_>, [f32; 4]) -> f32 + Sync);

/// Times the frames of a view. Every part is the difference of two frames that do more and less; all take turns, so that a busy machine slows all
/// alike, and the median of the rounds counts, at least one. `None` where there is no map.
pub fn frame_times(
    world: &World,
    prepared: &Prepared,
    settings: &Settings,
    view: &View,
    rounds: usize,
) -> Option<FrameTimes> {
    let map = &Map::of(prepared, settings)?;
    let filter = map.look.filter;
    let wide = in_floats(prepared)?;
    let wide = &Map::of(&wide, settings)?;
    let drawing = Drawing::new(&RadianceMap, world, prepared, settings)?;
    let set = |point: &SurfacePoint<'_>| map.near.set(point.position(), point.normal()).unwrap_or_default();
    let weighed = |point: &SurfacePoint<'_>, set: &[u32], filter: Filter| {
        weights(&map.near, set, point.position(), point.normal(), filter)
    };
    let mean = |map: &Map<'_>, point: &SurfacePoint<'_>, filter: Filter| {
        let set = set(point);
        map.mean(set, weighed(point, set, filter))[0].x
    };
    let searched = |near: &Near<'_>, point: &SurfacePoint<'_>| near.nearest(point.position(), point.normal(), SET);
    let stages: [Stage<'_>; 7] = [
        &|_, _| 0.0,
        &|point, _| set(point).iter().sum::<u32>() as f32,
        &|point, _| searched(&map.near, point).iter().sum::<u32>() as f32,
        &|point, _| mean(map, point, filter),
        &|point, _| mean(map, point, Filter { box_shaped: true, ..filter }),
        &|point, _| mean(wide, point, filter),
        &|point, random| reflected(map, point, Effort::of(map), random, 0).x,
    ];
    let of_pixels = |stage: &(dyn Fn(UVec2) -> f32 + Sync)| {
        let start = Instant::now();
        let of_row = |y: u32| (0..view.size.x).map(|x| stage(UVec2::new(x, y))).sum::<f32>();
        black_box((0..view.size.y).into_par_iter().map(of_row).sum::<f32>());
        start.elapsed().as_secs_f64()
    };
    let of_points = |stage: Stage<'_>| {
        of_pixels(&|pixel| {
            let mut eye = Eye::new(world, view, pixel, 0);
            let random = eye.random();
            eye.point().map_or(0.0, |point| stage(&point, random))
        })
    };
    let mut times = vec![Vec::new(); stages.len() + 1];
    for _ in 0..rounds.max(1) {
        for (stage, times) in stages.iter().zip(&mut times) {
            times.push(of_points(*stage));
        }
        times[stages.len()].push(of_pixels(&|pixel| drawing.sample(view, pixel, 0).radiance.x));
    }
    let medians: Vec<f64> = times.iter_mut().map(|times| median(times)).collect();
    let [points, one, eight, hat, boxed, floats, shaded, frame] = medians.try_into().ok()?;
    Some(FrameTimes {
        frame,
        query: one - points,
        filter: hat - one,
        shading: shaded - hat,
        searched: eight - points,
        boxed: boxed - one,
        floats: floats - one,
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use super::*;
    use crate::job::Handle;
    use crate::lighting::Method;
    use crate::lighting::radiance_map::PARAMS;
    use crate::reference::Options;
    use crate::scene::gallery;

    #[test]
    fn the_parts_are_of_one_frame_and_floats_have_the_light_of_halves() {
        let scene = Arc::new(gallery::open("room?roughness=0.6").unwrap());
        let world = World::new(&scene, Options::default());
        let mut settings = Settings::new(PARAMS);
        for (key, value) in [("points", "1000"), ("paths", "1"), ("directions", "18")] {
            settings.set(key, value).unwrap();
        }
        let prepared = RadianceMap.prepare(&world, &settings, &Handle::default()).unwrap();
        let view = View { camera: scene.cameras[0].clone(), size: UVec2::splat(24), seed: 0 };
        let times = frame_times(&world, &prepared, &settings, &view, 1).unwrap();
        assert!(times.frame > 0.0 && times.frame.is_finite());
        let sum = times.query + times.filter + times.shading + times.rest();
        assert!((sum - times.frame).abs() < 1e-9);
        let wide = in_floats(&prepared).unwrap();
        assert!(wide.bytes() > prepared.bytes() * 3 / 2);
        let of = |prepared| Map::of(prepared, &settings).unwrap().arriving(Vec3::new(0.0, -1.0, 0.3), Vec3::Y);
        assert!(of(&prepared).iter().any(|light| *light != Vec3::ZERO) && of(&prepared) == of(&wide));
        assert!(frame_times(&world, &Prepared::nothing(), &settings, &view, 1).is_none());
    }
}
