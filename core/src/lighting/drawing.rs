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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{UVec2, Vec3};

    use super::*;
    use crate::lighting::{Coverage, MethodId, MethodInfo, Reads};
    use crate::reference::{Options, SurfacePoint, trace};
    use crate::scene::{Environment, Light, LightKind, gallery};

    /// Leaves all light to the frame.
    #[derive(Debug)]
    struct Nothing;

    static INFO: MethodInfo = MethodInfo {
        id: MethodId("nothing"),
        title: "Nothing",
        summary: "",
        params: &[],
        coverage: Coverage {
            lamps: Cover::None,
            environment: Cover::None,
            indirect_diffuse: Cover::None,
            indirect_glossy: Cover::None,
            emission: Cover::None,
        },
        reads: Reads::NOTHING,
        revision: 1,
    };

    impl Method for Nothing {
        fn info(&self) -> &'static MethodInfo {
            &INFO
        }

        fn points(&self) -> Option<&dyn ShadePoint> {
            Some(self)
        }
    }

    impl ShadePoint for Nothing {
        fn radiance(&self, _: &SurfacePoint<'_>, _: &Prepared, _: &Settings, _: [f32; 4]) -> Vec3 {
            Vec3::ZERO
        }
    }

    #[test]
    fn what_the_frame_fills_in_is_the_direct_light_of_a_convex_body() {
        let mut scene = gallery::open("ball?material=Cu&roughness=0.35").unwrap();
        let texels = (0..32 * 16).map(|i| Vec3::new(0.2, 0.3, 0.4) * (1.0 + (i % 32) as f32 / 8.0)).collect();
        scene.environment = Some(Arc::new(Environment::new("slope", 32, 16, texels)));
        scene.materials[0].emission = Vec3::new(0.05, 0.1, 0.2);
        scene.materials[0].coat = 0.5;
        scene.lights.push(Light {
            name: "lamp".into(),
            position: Vec3::new(2.0, 2.0, 2.0),
            direction: Vec3::NEG_Y,
            intensity: Vec3::splat(9.0),
            range: f32::INFINITY,
            kind: LightKind::Point,
        });
        let world = World::new(&Arc::new(scene), Options { bounces: 1, ..Options::default() });
        let camera = world.scene().cameras[0].clone();
        let view = View { camera, size: UVec2::new(24, 16), seed: 1 };
        let (prepared, settings) = (Prepared::nothing(), Settings::new(&[]));
        let drawing = Drawing::new(&Nothing, &world, &prepared, &settings).unwrap();
        let [mut drawn, mut traced] = [Film::new(view.size), Film::new(view.size)];
        assert_eq!(drawing.draw(&view, &mut drawn, 256, &Control::default()), Pass::Whole);
        assert_eq!(trace(&world, &View { seed: 2, ..view }, &mut traced, 256, &Control::default()), Pass::Whole);
        let mean = |film: &Film| film.picture().texels.iter().map(|t| t.truncate()).sum::<Vec3>() / (24.0 * 16.0);
        let ratio = mean(&drawn) / mean(&traced);
        assert!((ratio - 1.0).abs().max_element() < 0.01, "{ratio}");
        assert_eq!((drawn.rejected(), traced.rejected()), (0, 0));
    }
}
