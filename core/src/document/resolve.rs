//! From a document and its files to the scene that is drawn.

use std::borrow::Borrow;
use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

use super::maps::Maps;
use super::{
    Document, MaterialEntry, Missing, MissingKind, Sources, TextureChoice, material_keys, object_keys, placeholder,
    role_key, shining,
};
use crate::color::tone::ToneMap;
use crate::lighting::classical;
use crate::material::params::{self, Values};
use crate::material::preset::{Fits, FormChoice, Preset, Tolerance};
use crate::material::{Material, Reflectance, Sampler, TextureRef, TextureRole};
use crate::param::ParamSpec;
use crate::scene::{Environment, Image, Scene, gallery};
use crate::surface::fresnel::{Form, Fresnel};

/// Built once: it is the light of every document that names none.
static STUDIO: LazyLock<Arc<Environment>> = LazyLock::new(|| Arc::new(gallery::studio()));

/// Curves that are kept; a preset is often tried and taken back.
const KEPT: usize = 256;

/// Fresnel curves that were made, so that an edit integrates no spectrum again.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    /// The last used first.
    made: Vec<(Preset, Form, Arc<Fresnel>)>,
    /// Fits of metals that do not bring theirs, in the same order.
    fitted: Vec<(Preset, Arc<Fits>)>,
    /// Environments.
    maps: Maps,
}

impl Curves {
    /// The curve of a metal in a form.
    pub fn get(&mut self, metal: &Preset, choice: FormChoice) -> Arc<Fresnel> {
        let form = match choice {
            FormChoice::Of(form) => form,
            FormChoice::Cheapest(tolerance) => self.cheapest(metal, tolerance),
        };
        let place = self.made.iter().position(|(known, of, _)| *of == form && known == metal);
        let entry = match place {
            Some(place) => self.made.remove(place),
            None => (metal.clone(), form, Arc::new(metal.fresnel(form))),
        };
        let curve = entry.2.clone();
        self.made.insert(0, entry);
        self.made.truncate(KEPT);
        curve
    }

    fn cheapest(&mut self, metal: &Preset, tolerance: Tolerance) -> Form {
        if let Some(fits) = metal.stored_fits() {
            return fits.cheapest(tolerance).form;
        }
        let place = self.fitted.iter().position(|(known, _)| known == metal);
        let entry = match place {
            Some(place) => self.fitted.remove(place),
            None => (metal.clone(), Arc::new(Fits::new(metal))),
        };
        let form = entry.1.cheapest(tolerance).form;
        self.fitted.insert(0, entry);
        self.fitted.truncate(KEPT);
        form
    }

    /// A scene with every metal in one form; those that `metal` does not know stay as they are.
    pub fn in_form<M: Borrow<Preset>>(
        &mut self,
        scene: &Scene,
        choice: FormChoice,
        metal: impl Fn(&str) -> Option<M>,
    ) -> Arc<Scene> {
        let mut scene = Scene::clone(scene);
        for material in &mut scene.materials {
            if let Reflectance::Preset { id, fresnel } = &mut material.reflectance
                && let Some(metal) = metal(id)
            {
                *fresnel = self.get(metal.borrow(), choice);
            }
        }
        Arc::new(scene)
    }
}

impl Document {
    /// The form of a material's metal: its own where it names one that this version knows, else that of the lighting
    /// settings, whose tolerances count for both.
    pub fn form_choice(&self, own: Option<&str>) -> FormChoice {
        let settings = self.lighting.settings();
        let own = own.and_then(|id| FormChoice::read(id, classical::tolerance(&settings)).ok());
        own.unwrap_or_else(|| classical::form_choice(&settings))
    }
}

impl Document {
    /// A resolved scene with every metal in one form, whatever its material asks for: what the reference traces.
    pub fn in_form(&self, scene: &Scene, choice: FormChoice, curves: &mut Curves) -> Arc<Scene> {
        curves.in_form(scene, choice, |id| self.metal(id))
    }
}

/// A scene with what stands in for something else in it.
#[derive(Clone, Debug)]
pub struct Resolved {
    /// Its materials are those of the document, in the same order; its instances those of the model.
    pub scene: Arc<Scene>,
    /// Keys of the instances, in the same order.
    pub object_keys: Vec<String>,
    /// Materials before their changes: what a reset goes back to. In the order of the document's.
    pub base: Vec<Material>,
    /// What the document refers to and `sources` does not hold.
    pub missing: Vec<Missing>,
    /// What else could not be done as the document says.
    pub notices: Vec<String>,
}

/// Makes the scene that a document describes. Never fails: something stands in for what is missing.
pub fn resolve(document: &Document, sources: &Sources, curves: &mut Curves) -> Resolved {
    let mut missing = Vec::new();
    let absent = |kind, path: &str| Missing { kind, path: path.into(), reason: "it was not read".into() };
    let model = sources.models.get(&document.scene).cloned().unwrap_or_else(|| {
        missing.push(absent(MissingKind::Model, &document.scene));
        Arc::new(placeholder(document))
    });
    let mut scene = Scene::clone(&model);
    let mut notices = unknown_words(document);

    let mut images = Images { list: &mut scene.images, by_path: BTreeMap::new(), sources, missing: &mut missing };
    let model_keys = material_keys(&model);
    let (mut base, mut materials) = (Vec::new(), Vec::new());
    for entry in &document.materials {
        let place = entry.source.as_ref().and_then(|source| model_keys.iter().position(|key| key == source));
        let start = place.and_then(|place| model.materials.get(place)).cloned().unwrap_or_default();
        let mut material = Material { name: entry.name.clone(), ..start.clone() };
        params::apply(&mut material, &values(entry, &mut notices));
        set_textures(&mut material, entry, &mut images);
        set_reflectance(&mut material, entry, document, curves, &mut notices);
        base.push(start);
        materials.push(material);
    }
    let object_keys = object_keys(&model);
    place_objects(&mut scene, &object_keys, &model_keys, document, &mut materials);
    scene.materials = materials;
    if let Some(lights) = &document.lights {
        scene.lights = shining(lights, &object_keys);
    }
    notices.extend(super::probe::unknown(&document.probes, &object_keys));
    scene.probes.extend(document.probes.iter().filter_map(|probe| probe.probe(&object_keys)));
    if !document.subject.is_empty() {
        let chosen = |key: &String| document.subject.contains(key);
        scene.subject = (0..object_keys.len()).filter(|i| chosen(&object_keys[*i])).collect();
    }

    let map = document.environment.source.as_ref().and_then(|path| {
        let found = sources.environments.get(path).cloned();
        if found.is_none() {
            missing.push(absent(MissingKind::Environment, path));
        }
        found
    });
    let map = map.or_else(|| curves.maps.made(&document.environment, &mut notices));
    let map = map.or_else(|| scene.environment.clone()).unwrap_or_else(|| STUDIO.clone());
    curves.maps.place(&mut scene, &map, &document.environment, &mut notices);
    Resolved { scene: Arc::new(scene), object_keys, base, missing, notices }
}

/// What the document asks for by a name that this version does not know.
fn unknown_words(document: &Document) -> Vec<String> {
    let mut notices = Vec::new();
    let method = &document.lighting.method;
    if document.lighting.is_unknown() {
        notices.push(format!("method `{method}` is not in this version; {} is shown", classical::ID));
    }
    let tone = &document.view.tone;
    if tone.parse::<ToneMap>().is_err() {
        notices.push(format!("tone map `{tone}` is not in this version; {} is shown", ToneMap::default().id()));
    }
    notices
}

/// The changed factors of an entry; what cannot be read is noticed.
fn values(entry: &MaterialEntry, notices: &mut Vec<String>) -> Values {
    let mut values = Values::new();
    for (key, json) in &entry.values {
        let read = |spec: &'static ParamSpec| spec.from_json(json).map(|value| (spec.key, value));
        match crate::param::find(params::PARAMS, key).and_then(read) {
            Ok((key, value)) => _ = values.insert(key, value),
            Err(error) => notices.push(format!("material `{}`: {error}; it is left as it was", entry.name)),
        }
    }
    values
}

/// The images of the scene with those from files behind them.
struct Images<'a> {
    list: &'a mut Vec<Arc<Image>>,
    by_path: BTreeMap<String, usize>,
    sources: &'a Sources,
    missing: &'a mut Vec<Missing>,
}

impl Images<'_> {
    fn of_file(&mut self, path: &str) -> Option<usize> {
        if let Some(&index) = self.by_path.get(path) {
            return Some(index);
        }
        let Some(image) = self.sources.images.get(path) else {
            let missing = Missing { kind: MissingKind::Texture, path: path.into(), reason: "it was not read".into() };
            if !self.missing.contains(&missing) {
                self.missing.push(missing);
            }
            return None;
        };
        self.list.push(image.clone());
        self.by_path.insert(path.into(), self.list.len() - 1);
        Some(self.list.len() - 1)
    }
}

fn set_textures(material: &mut Material, entry: &MaterialEntry, images: &mut Images) {
    for role in TextureRole::ALL {
        let Some(choice) = entry.textures.get(&role_key(role)) else { continue };
        let slot = material.texture_mut(role);
        let image = match choice {
            TextureChoice::None => None,
            TextureChoice::File(path) => images.of_file(path),
            TextureChoice::Image(index) => Some(*index).filter(|index| *index < images.list.len()),
        };
        // A texture that takes the place of another keeps how it is laid over the surface.
        let laid = slot.unwrap_or(TextureRef {
            image: 0,
            sampler: Sampler { mip: Some(Default::default()), ..Sampler::default() },
            uv_set: 0,
            transform: glam::Mat3::IDENTITY,
        });
        *slot = image.map(|image| TextureRef { image, ..laid });
    }
}

fn set_reflectance(
    material: &mut Material,
    entry: &MaterialEntry,
    document: &Document,
    curves: &mut Curves,
    notices: &mut Vec<String>,
) {
    let Some(used) = &entry.preset else { return };
    let own = used.fresnel.as_deref();
    if let Some(Err(error)) = own.map(|id| FormChoice::read(id, Tolerance::default())) {
        notices.push(format!("material `{}`: {error}; that of the scene is used", entry.name));
    }
    let form = document.form_choice(own);
    match document.metal(&used.id).map(|metal| curves.get(metal, form)) {
        Some(fresnel) => material.reflectance = Reflectance::Preset { id: used.id.clone(), fresnel },
        None => notices.push(format!(
            "material `{}`: there is no metal `{}`; its base colour counts instead, pick another metal",
            entry.name, used.id
        )),
    }
}

/// Gives the instances their materials, names and visibility.
fn place_objects(
    scene: &mut Scene,
    keys: &[String],
    model_keys: &[String],
    document: &Document,
    materials: &mut Vec<Material>,
) {
    let by_source = |key: &String| document.materials.iter().position(|entry| entry.source.as_ref() == Some(key));
    let of_model: Vec<Option<usize>> = model_keys.iter().map(by_source).collect();
    let by_name: BTreeMap<&str, usize> =
        document.materials.iter().enumerate().map(|(index, entry)| (entry.name.as_str(), index)).collect();
    let assigned: BTreeMap<&str, usize> = (document.assignments.iter())
        .filter_map(|a| Some((a.object.as_str(), *by_name.get(a.material.as_str())?)))
        .collect();
    let objects: BTreeMap<&str, _> = document.objects.iter().map(|entry| (entry.key.as_str(), entry)).collect();
    let Scene { instances, meshes, .. } = scene;
    for (instance, key) in instances.iter_mut().zip(keys) {
        let own = of_model.get(instance.material).copied().flatten();
        let material = assigned.get(key.as_str()).copied().or(own);
        instance.material = material.unwrap_or_else(|| {
            // Only a document that was not synchronised with its model has no entry.
            materials.push(Material::default());
            materials.len() - 1
        });
        if let Some(entry) = objects.get(key.as_str()) {
            instance.visible = !entry.hidden;
            if let Some(transform) = &entry.transform {
                let center = instance.bounds(&meshes[instance.mesh]).center();
                instance.world_from_local = transform.place(instance.world_from_local, center);
            }
            if let Some(name) = &entry.name {
                instance.name = name.clone();
            }
        }
    }
}
