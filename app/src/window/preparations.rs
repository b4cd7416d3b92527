//! The preparations of all methods that light a scene, one for each that looks up another.

use std::sync::Arc;
use std::time::Duration;

use burnish_core::job::Handle;
use burnish_core::lighting::prepared::Asked;
use burnish_core::lighting::probe::Raster;
use burnish_core::lighting::{Layer, Layers, MethodError, Prepared, Store, classical};
use burnish_core::reference::{Options, World};
use burnish_core::scene::Scene;
use burnish_render::{DeviceRaster, Lighting, Passes};
use eframe::egui;

use super::preparation::Preparation;

/// Preparations in the order of the layers that asked first.
pub struct Preparations {
    store: Store,
    always_anew: bool,
    raster: Option<Arc<dyn Raster>>,
    each: Vec<(Asked, Preparation)>,
}

/// The graphics device makes what it looks up by itself.
pub fn prepared_on_device(layers: &Layers) -> bool {
    drawn_on_device(layers) && layers.first().method.info().id.0 == classical::ID
}

/// Its picture can show the light of one source.
pub fn shows_sources(layers: &Layers) -> bool {
    prepared_on_device(layers)
}

/// What lights the frames of a device, `classical` until all is prepared.
pub fn lighting(layers: &Layers, preparations: &Preparations) -> Lighting {
    let prepared = if prepared_on_device(layers) { None } else { preparations.prepared(layers) };
    let first = prepared.and_then(|prepared| prepared.into_iter().next());
    Lighting::new(layers.first().method.info().id, first)
}

/// The same for one picture on the device of some passes: waits until it is prepared. `classical` where the processor draws.
pub fn lighting_now(
    layers: &Layers,
    scene: &Arc<Scene>,
    (passes, store): (&Arc<Passes>, &Store),
    job: &Handle,
) -> Result<Lighting, MethodError> {
    if prepared_on_device(layers) || !drawn_on_device(layers) {
        return Ok(Lighting::default());
    }
    let Layer { method, settings, .. } = layers.first();
    let raster = Arc::new(DeviceRaster::new(passes));
    let world = World::new(scene, Options::new(settings)).with_raster(Some(raster));
    let prepared = layers.prepare(store, &world, job)?;
    Ok(Lighting::new(method.info().id, prepared.into_iter().next()))
}

/// The graphics device draws the scene: one method lights it, and has a pass there.
pub fn drawn_on_device(layers: &Layers) -> bool {
    let device = burnish_render::draws(layers.first().method.info().id);
    device && (layers.is_single() || !layers.are_on_processor())
}

impl Preparations {
    /// Keeps preparations in a folder.
    pub fn new(store: Store) -> Preparations {
        Preparations { store, always_anew: false, raster: None, each: Vec::new() }
    }

    /// The same, but they are made anew after every edit, see [`Preparation::always_anew`].
    #[must_use]
    pub fn always_anew(self) -> Preparations {
        Preparations { always_anew: true, ..self }
    }

    /// Lets someone draw what probes see, from the next preparation on.
    pub fn draw_probes_by(&mut self, raster: Option<Arc<dyn Raster>>) {
        self.raster = raster;
    }

    /// Follows the document: call it in every frame. `ctx` is repainted when something comes of it.
    pub fn follow(&mut self, layers: &Layers, scene: &Arc<Scene>, ctx: &egui::Context) {
        if prepared_on_device(layers) {
            return self.forget();
        }
        let mut asked: Vec<Asked> = Vec::new();
        for layer in layers.iter() {
            let by = layer.asked();
            if asked.contains(&by) {
                continue;
            }
            let known = self.each.iter().position(|(known, _)| *known == by);
            // The scene's method keeps its stale preparation when a setting changes.
            let stale = (asked.is_empty() && !self.each.is_empty()).then_some(0);
            let place = known.or(stale).unwrap_or_else(|| {
                let preparation = Preparation::new(self.store.clone());
                let preparation = if self.always_anew { preparation.always_anew() } else { preparation };
                self.each.push((by.clone(), preparation));
                self.each.len() - 1
            });
            // In the order of those who asked; what nobody asked for comes last.
            self.each.swap(asked.len(), place);
            let (known, preparation) = &mut self.each[asked.len()];
            known.clone_from(&by);
            preparation.draw_probes_by(self.raster.clone());
            preparation.follow(layer.method, layer.settings.clone(), scene, ctx);
            asked.push(by);
        }
        self.each.truncate(asked.len());
    }

    /// Gives back what is held, and ends what runs.
    pub fn forget(&mut self) {
        self.each.clear();
    }

    /// All of them, that of the scene's method first; none where the device draws the scene.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Preparation> {
        self.each.iter_mut().map(|(_, preparation)| preparation)
    }

    /// What there is for each layer, perhaps stale; `None` until all have something.
    pub fn prepared(&self, layers: &Layers) -> Option<Vec<Arc<Prepared>>> {
        let of = |layer: &Layer| {
            let by = layer.asked();
            self.each.iter().find(|(known, _)| *known == by)?.1.prepared(layer.method)
        };
        layers.iter().map(of).collect()
    }

    /// Where what there is fails, for people.
    pub fn warnings(&self) -> impl Iterator<Item = &String> {
        self.each.iter().flat_map(|(_, preparation)| preparation.warnings())
    }

    /// Time of what the scene's method has in use, where it took some.
    pub fn took(&self) -> Option<Duration> {
        self.each.first().and_then(|(_, preparation)| preparation.cost()).map(|(_, took)| took)
    }

    /// Another thread works on one.
    pub fn is_busy(&self) -> bool {
        self.each.iter().any(|(_, preparation)| preparation.is_busy())
    }

    /// Why one could not be made.
    pub fn fault(&self) -> Option<&str> {
        self.each.iter().find_map(|(_, preparation)| preparation.fault())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::lighting::{Coverage, Method, MethodId, MethodInfo, Reads, ShadePoint};
    use burnish_core::param::{Affects, ParamKind, ParamSpec, Settings};
    use burnish_core::reference::{self, SurfacePoint};
    use burnish_core::scene::{Environment, gallery};
    use glam::Vec3;

    #[test]
    fn layers_that_look_up_the_same_share_it_and_one_layer_on_the_device_needs_none() {
        let mut scene = gallery::open("ball").unwrap();
        scene.environment = Some(Arc::new(Environment::new("grey", 8, 4, vec![Vec3::splat(0.5); 32])));
        let scene = Arc::new(scene);
        let classical: &'static dyn Method = &classical::Classical;
        let layer = |method: &'static dyn Method, samples| {
            let mut settings = Settings::new(method.info().params);
            settings.set("samples", samples).unwrap();
            Layer { method, settings, instances: vec![0] }
        };
        let one = Layers::of(classical, Settings::new(classical.info().params));
        let ctx = egui::Context::default();
        let mut preparations = Preparations::new(Store::none());
        preparations.follow(&one, &scene, &ctx);
        assert!(drawn_on_device(&one) && preparations.each.is_empty());
        let mixed = one.with(layer(classical, "64")).with(layer(&reference::Reference, "1"));
        assert!(!drawn_on_device(&mixed));
        while preparations.prepared(&mixed).is_none() {
            preparations.follow(&mixed, &scene, &ctx);
            std::thread::yield_now();
        }
        let prepared = preparations.prepared(&mixed).unwrap();
        assert!(Arc::ptr_eq(&prepared[0], &prepared[1]) && !prepared[0].is_nothing() && prepared[2].is_nothing());
        assert_eq!(preparations.each.len(), 2);
    }

    /// Depends on a setting.
    #[derive(Debug)]
    struct Sized;

    static PARAMS: &[ParamSpec] = &[ParamSpec {
        key: "size",
        label: "Size",
        unit: "",
        kind: ParamKind::Integer { min: 1, max: 9, default: 1 },
        help: "How many.",
        affects: Affects::Prepare,
    }];

    static INFO: MethodInfo = MethodInfo {
        id: MethodId("sized"),
        title: "Sized",
        summary: "",
        params: PARAMS,
        coverage: Coverage::NONE,
        reads: Reads { environment: true, ..Reads::NOTHING },
        revision: 1,
    };

    impl Method for Sized {
        fn info(&self) -> &'static MethodInfo {
            &INFO
        }

        fn prepare(&self, _: &World, settings: &Settings, _: &Handle) -> Result<Prepared, MethodError> {
            let size = settings.text("size").and_then(|text| text.parse::<u32>().ok()).unwrap_or(0);
            Ok(Prepared::nothing().with("size", vec![size]))
        }

        fn points(&self) -> Option<&dyn ShadePoint> {
            Some(self)
        }
    }

    impl ShadePoint for Sized {
        fn radiance(&self, _: &SurfacePoint<'_>, _: &Prepared, _: &Settings, _: [f32; 4]) -> Vec3 {
            Vec3::ZERO
        }
    }

    #[test]
    fn one_that_two_layers_come_to_share_leaves_no_orphan_at_work() {
        let settings = |size: &str| {
            let mut settings = Settings::new(PARAMS);
            settings.set("size", size).unwrap();
            settings
        };
        let layer = |size| Layer { method: &Sized, settings: settings(size), instances: vec![0] };
        let (scene, ctx) = (Arc::new(gallery::open("ball").unwrap()), egui::Context::default());
        let mut preparations = Preparations::new(Store::none());
        let mut settle = |layers: &Layers| {
            preparations.follow(layers, &scene, &ctx);
            // At once: what runs now must be polled later on.
            preparations.follow(layers, &scene, &ctx);
            let start = std::time::Instant::now();
            while preparations.is_busy() {
                assert!(start.elapsed().as_secs() < 60, "an orphan is at work");
                preparations.follow(layers, &scene, &ctx);
                std::thread::yield_now();
            }
            let sizes = preparations.prepared(layers).unwrap().iter().map(|p| p.whole("size")[0]).collect::<Vec<_>>();
            (sizes, preparations.each.len())
        };
        let two = Layers::of(&Sized, settings("1")).with(layer("2"));
        assert_eq!(settle(&two), (vec![1, 2], 2));
        assert_eq!(settle(&Layers::of(&Sized, settings("2")).with(layer("2"))), (vec![2, 2], 1));
        assert_eq!(settle(&two), (vec![1, 2], 2));
        assert_eq!(settle(&Layers::of(&Sized, settings("2")).with(layer("1"))), (vec![2, 1], 2), "they change places");
    }
}
