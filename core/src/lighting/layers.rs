//! Which method lights which objects: one for the scene, others for some of its instances.

use std::sync::Arc;

use super::drawing::Drawing;
use super::method::{Method, MethodError};
use super::prepared::{Asked, Prepared, Store, key};
use crate::job::Handle;
use crate::param::Settings;
use crate::reference::{Control, Film, Pass, View, World};

/// A method with its settings, and what it lights.
#[derive(Clone, Debug)]
pub struct Layer {
    /// The method.
    pub method: &'static dyn Method,
    /// Settings made of its list.
    pub settings: Settings,
    /// Indices into `Scene::instances`; of no meaning in the first layer, which lights the rest.
    pub instances: Vec<usize>,
}

/// What lights a scene: at least one layer, the first for all that no other names.
#[derive(Clone, Debug)]
pub struct Layers {
    first: Layer,
    others: Vec<Layer>,
}

impl Layer {
    /// What it looks up is made for this.
    pub fn asked(&self) -> Asked {
        Asked::by(self.method, &self.settings)
    }
}

impl PartialEq for Layer {
    fn eq(&self, other: &Layer) -> bool {
        self.method.info().id == other.method.info().id
            && self.settings == other.settings
            && self.instances == other.instances
    }
}

impl PartialEq for Layers {
    fn eq(&self, other: &Layers) -> bool {
        self.iter().eq(other.iter())
    }
}

impl Layers {
    /// One method for the whole scene.
    pub fn of(method: &'static dyn Method, settings: Settings) -> Layers {
        Layers { first: Layer { method, settings, instances: Vec::new() }, others: Vec::new() }
    }

    /// The same with another method for some instances. Where two name an instance the later counts.
    #[must_use]
    pub fn with(mut self, layer: Layer) -> Layers {
        self.others.push(layer);
        self
    }

    /// The one for the scene.
    pub fn first(&self) -> &Layer {
        &self.first
    }

    /// The first, then the others.
    pub fn iter(&self) -> impl Iterator<Item = &Layer> {
        std::iter::once(&self.first).chain(&self.others)
    }

    /// How many instances others than the first light.
    pub fn overridden(&self) -> usize {
        self.others.iter().map(|layer| layer.instances.len()).sum()
    }

    /// One method lights the whole scene.
    pub fn is_single(&self) -> bool {
        self.others.is_empty()
    }

    /// The processor can draw all of them.
    pub fn are_on_processor(&self) -> bool {
        self.iter().all(|layer| layer.method.is_on_processor())
    }

    /// The preparations of all, in order: read from a store, or made. The same is made once.
    pub fn prepare(&self, store: &Store, world: &World, job: &Handle) -> Result<Vec<Arc<Prepared>>, MethodError> {
        let mut made: Vec<(Asked, Arc<Prepared>)> = Vec::new();
        for layer in self.iter() {
            let asked = layer.asked();
            let known = made.iter().find(|(known, _)| *known == asked).map(|(_, prepared)| prepared.clone());
            let prepared = match known {
                Some(prepared) => prepared,
                None => {
                    let Layer { method, settings, .. } = layer;
                    let key = key(*method, settings, world.scene());
                    store.prepare(&key, *method, world, settings, job)?
                }
            };
            made.push((asked, prepared));
        }
        Ok(made.into_iter().map(|(_, prepared)| prepared).collect())
    }

    /// Prepares and draws: adds `samples` to every pixel of a film. `None` where the processor cannot draw them all.
    pub fn draw(
        &self,
        world: &World,
        store: &Store,
        view: &View,
        (film, samples): (&mut Film, u32),
        job: &Handle,
    ) -> Result<Option<Pass>, MethodError> {
        let prepared = self.prepare(store, world, job)?;
        let drawing = Drawing::of_layers(world, self, &prepared);
        Ok(drawing.map(|drawing| drawing.draw(view, film, samples, &Control::of_job(job))))
    }
}
