//! Pictures by a method on the processor: its points where rays from the eye meet surfaces, and what fills in the rest.

use std::sync::Arc;

use glam::{UVec2, Vec3};

use super::layers::Layers;
use super::method::{Cover, Method, ShadePoint};
use super::prepared::Prepared;
use crate::param::Settings;
use crate::reference::{Control, Eye, Film, FirstHit, Pass, PathSample, View, World, trace_with};

/// Methods ready to draw a scene.
#[derive(Clone)]
pub struct Drawing<'a> {
    world: &'a World,
    lit: Vec<Lit<'a>>,
    /// Which of them lights an instance; the first lights those beyond the list.
    of_instance: Vec<u32>,
}

/// A method with what it looks up.
#[derive(Clone, Copy)]
struct Lit<'a> {
    /// `None` follows paths.
    points: Option<&'a dyn ShadePoint>,
    prepared: &'a Prepared,
    settings: &'a Settings,
    /// The frame adds these where the method leaves them out.
    adds_lamps: bool,
    adds_environment: bool,
    adds_emission: bool,
}

impl<'a> Lit<'a> {
    fn new(method: &'a dyn Method, prepared: &'a Prepared, settings: &'a Settings) -> Option<Lit<'a>> {
        let coverage = method.info().coverage;
        method.is_on_processor().then_some(Lit {
            points: method.points(),
            prepared,
            settings,
            adds_lamps: coverage.lamps == Cover::None,
            adds_environment: coverage.environment == Cover::None,
            adds_emission: coverage.emission == Cover::None,
        })
    }
}

impl<'a> Drawing<'a> {
    /// `None` where the method does not draw on the processor.
    pub fn new(
        method: &'a dyn Method,
        world: &'a World,
        prepared: &'a Prepared,
        settings: &'a Settings,
    ) -> Option<Drawing<'a>> {
        let lit = vec![Lit::new(method, prepared, settings)?];
        Some(Drawing { world, lit, of_instance: Vec::new() })
    }

    /// By several methods, with the preparation of each; `None` where one of them does not draw on the processor.
    pub fn of_layers(world: &'a World, layers: &'a Layers, prepared: &'a [Arc<Prepared>]) -> Option<Drawing<'a>> {
        let each = layers.iter().zip(prepared);
        let lit = each.map(|(layer, prepared)| Lit::new(layer.method, prepared, &layer.settings));
        let lit: Vec<Lit<'a>> = lit.collect::<Option<_>>()?;
        let mut of_instance = vec![0; if layers.is_single() { 0 } else { world.scene().instances.len() }];
        for (number, layer) in layers.iter().enumerate().skip(1) {
            for &instance in &layer.instances {
                if let Some(place) = of_instance.get_mut(instance) {
                    *place = number as u32;
                }
            }
        }
        (!lit.is_empty()).then_some(Drawing { world, lit, of_instance })
    }

    /// A sample of a pixel, which is counted from the top left: a pure function of view, pixel and `index`.
    pub fn sample(&self, view: &View, pixel: UVec2, index: u32) -> PathSample {
        let mut eye = Eye::new(self.world, view, pixel, index);
        let [for_method, for_lamps, for_sky, for_surface] = std::array::from_fn(|_| eye.random());
        let Some(point) = eye.point() else { return eye.miss() };
        let lit = self.lit[self.of_instance.get(point.instance() as usize).map_or(0, |place| *place as usize)];
        let Some(points) = lit.points else { return self.world.sample(view, pixel, index) };
        let mut radiance = points.radiance(&point, lit.prepared, lit.settings, for_method) + eye.lamps_seen();
        if lit.adds_emission {
            radiance += point.emission();
        }
        if lit.adds_environment {
            radiance += point.environment([for_sky, for_surface]);
        }
        let mut rays = 1;
        if lit.adds_lamps {
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
    use crate::job::Handle;
    use crate::lighting::{Coverage, Layer, MethodId, MethodInfo, Reads, Store, classical};
    use crate::reference::{self, Options, SurfacePoint, trace};
    use crate::scene::{Environment, Light, LightKind, gallery};

    /// Leaves all light to the frame.
    #[derive(Debug)]
    struct Nothing;

    static INFO: MethodInfo = MethodInfo {
        id: MethodId("nothing"),
        title: "Nothing",
        summary: "",
        params: &[],
        coverage: Coverage::NONE,
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
            ..Default::default()
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

    #[test]
    fn instances_are_lit_by_the_method_that_is_meant_for_them() {
        let mut scene = gallery::open("box-sphere").unwrap();
        scene.environment = Some(Arc::new(Environment::new("grey", 8, 4, vec![Vec3::splat(0.5); 32])));
        let world = World::new(&Arc::new(scene), Options { bounces: 4, ..Options::default() });
        let camera = world.scene().cameras[0].clone();
        let view = View { camera, size: UVec2::new(24, 16), seed: 1 };
        let (classical, paths) = (&classical::Classical, &reference::Reference);
        let [of_classical, of_paths] =
            [classical as &'static dyn Method, paths].map(|m| Layers::of(m, Settings::new(m.info().params)));
        let subject = world.scene().subject.clone();
        let settings = Settings::new(reference::PARAMS);
        let mixed = of_classical.clone().with(Layer { method: paths, settings, instances: subject.clone() });
        let pictures = [&of_classical, &of_paths, &mixed].map(|layers| {
            let prepared = layers.prepare(&Store::none(), &world, &Handle::default()).unwrap();
            let drawing = Drawing::of_layers(&world, layers, &prepared).unwrap();
            let mut samples = Vec::new();
            for i in 0..24 * 16 {
                samples.push(drawing.sample(&view, UVec2::new(i % 24, i / 24), 0));
            }
            samples
        });
        let [classical, paths, mixed] = pictures;
        let is_of_subject =
            |sample: &PathSample| sample.first.is_some_and(|f| subject.contains(&(f.instance as usize)));
        assert!(paths.iter().any(is_of_subject) && !paths.iter().all(is_of_subject));
        for (i, sample) in mixed.iter().enumerate() {
            let expected = if is_of_subject(sample) { &paths[i] } else { &classical[i] };
            assert_eq!(sample.radiance, expected.radiance, "pixel {i}");
        }
    }
}
