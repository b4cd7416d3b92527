//! The preparations of all methods that light a scene, one for each that looks up another.

use std::sync::Arc;

use burnish_core::lighting::prepared::Asked;
use burnish_core::lighting::{Layer, Layers, Prepared, Store};
use burnish_core::scene::Scene;
use eframe::egui;

use super::preparation::Preparation;

/// Preparations in the order of the layers that asked first.
pub struct Preparations {
    store: Store,
    each: Vec<(Asked, Preparation)>,
}

/// The graphics device draws the scene: one method lights it, and has a pass there.
pub fn drawn_on_device(layers: &Layers) -> bool {
    let device = burnish_render::draws(layers.first().method.info().id);
    device && (layers.is_single() || !layers.are_on_processor())
}

impl Preparations {
    /// Keeps preparations in a folder.
    pub fn new(store: Store) -> Preparations {
        Preparations { store, each: Vec::new() }
    }

    /// Follows the document: call it in every frame. `ctx` is repainted when something comes of it.
    pub fn follow(&mut self, layers: &Layers, scene: &Arc<Scene>, ctx: &egui::Context) {
        if drawn_on_device(layers) {
            // The device makes what it looks up.
            return self.forget();
        }
        let mut asked: Vec<Asked> = Vec::new();
        for layer in layers.iter() {
            let by = layer.asked();
            if asked.contains(&by) {
                continue;
            }
            // The scene's method keeps its stale preparation when a setting changes.
            let place = match asked.is_empty() {
                true => (!self.each.is_empty()).then_some(0),
                false => self.each.iter().position(|(known, _)| *known == by),
            };
            let place = place.unwrap_or_else(|| {
                self.each.push((by.clone(), Preparation::new(self.store.clone())));
                self.each.len() - 1
            });
            let (known, preparation) = &mut self.each[place];
            *known = by.clone();
            preparation.follow(layer.method, layer.settings.clone(), scene, ctx);
            asked.push(by);
        }
        self.each.retain(|(known, _)| asked.contains(known));
    }

    /// Gives back what is held, and ends what runs.
    pub fn forget(&mut self) {
        self.each.clear();
    }

    /// That of the scene's method; `None` where it needs none.
    pub fn first(&mut self) -> Option<&mut Preparation> {
        self.each.first_mut().map(|(_, preparation)| preparation)
    }

    /// What there is for each layer, perhaps stale; `None` until all have something.
    pub fn prepared(&self, layers: &Layers) -> Option<Vec<Arc<Prepared>>> {
        let of = |layer: &Layer| {
            let by = layer.asked();
            self.each.iter().find(|(known, _)| *known == by)?.1.prepared(layer.method)
        };
        layers.iter().map(of).collect()
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
    use burnish_core::lighting::{Method, classical};
    use burnish_core::param::Settings;
    use burnish_core::reference;
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
        assert!(drawn_on_device(&one) && preparations.first().is_none());
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
}
