//! Pictures by a method on the processor: its points where rays from the eye meet surfaces, and what fills in the rest.

use glam::{UVec2, Vec3};

use super::method::{Cover, Method, ShadePoint};
use super::prepared::Prepared;
use crate::param::Settings;
use crate::reference::{Control, Eye, Film, FirstHit, Pass, PathSample, View, World, trace_with};

/// A method ready to draw a scene.
#[derive(Clone, Copy)]
pub struct Drawing<'a> {
    world: &'a World,
    points: &'a dyn ShadePoint,
    prepared: &'a Prepared,
    settings: &'a Settings,
    /// The frame adds these where the method leaves them out.
    adds_lamps: bool,
    adds_environment: bool,
    adds_emission: bool,
}

impl<'a> Drawing<'a> {
    /// `None` where the method does not draw on the processor by points.
    pub fn new(
        method: &'a dyn Method,
        world: &'a World,
        prepared: &'a Prepared,
        settings: &'a Settings,
    ) -> Option<Drawing<'a>> {
        let coverage = method.info().coverage;
        Some(Drawing {
            world,
            points: method.points()?,
            prepared,
            settings,
            adds_lamps: coverage.lamps == Cover::None,
            adds_environment: coverage.environment == Cover::None,
            adds_emission: coverage.emission == Cover::None,
        })
    }

    /// A sample of a pixel, which is counted from the top left: a pure function of view, pixel and `index`.
    pub fn sample(&self, view: &View, pixel: UVec2, index: u32) -> PathSample {
        let mut eye = Eye::new(self.world, view, pixel, index);
        let [for_method, for_lamps, for_sky, for_surface] = std::array::from_fn(|_| eye.random());
        let Some(point) = eye.point() else { return eye.miss() };
        let mut radiance = self.points.radiance(&point, self.prepared, self.settings, for_method);
        if self.adds_emission {
            radiance += point.emission();
        }
        if self.adds_environment {
            radiance += point.environment([for_sky, for_surface]);
        }
        let mut rays = 1;
        if self.adds_lamps {
            let (light, cast) = point.lamps(for_lamps);
            radiance += light;
            rays += cast;
        }
        let first = FirstHit {
            normal: point.normal(),
            albedo: point.albedo(),
            instance: point.instance(),
            material: point.material(),
        };
        PathSample { radiance, clamped: Vec3::ZERO, first: Some(first), rays }
    }

    /// Adds `samples` to every pixel of a film, see [`trace_with`].
    pub fn draw(&self, view: &View, film: &mut Film, samples: u32, control: &Control) -> Pass {
        trace_with(film, samples, control, |pixel, index| self.sample(view, pixel, index))
    }
}
