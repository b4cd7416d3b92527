//! Where two states of a document differ, one line for each setting, and how one takes it over from the other.

mod copy;

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::{BackgroundEntry, Document, EnvironmentEntry, MaterialEntry};
use crate::lighting;
use crate::material::{Material, params};
use crate::param::{self, ParamSpec, ParamValue};
use crate::reference;

/// What a line is about.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// A part of a material, by the material's name.
    Material(String, Part),
    /// The material of an object, by the object's key.
    Assignment(String),
    /// Name and visibility of an object, by its key.
    Object(String),
    /// A light, by its name.
    Light(String),
    /// A probe, by its name.
    Probe(String),
    /// The HDRI.
    Map,
    /// How far the environment is turned.
    Rotation,
    /// Factor on the radiance of the environment.
    Strength,
    /// Colour of the environment.
    Tint,
    /// The map by numbers.
    Made,
    /// What the eye sees behind everything: colour, blur, ground.
    Background,
    /// Whether the sun of the environment is a light.
    Sun,
    /// The lighting method.
    Method,
    /// A setting of the lighting method, by its key.
    Lighting(String),
    /// The method of an object that another one lights, by the object's key.
    Override(String),
    /// A setting of the reference, by its key.
    Reference(String),
    /// The point of view.
    Camera,
    /// The exposure.
    Exposure,
    /// The tone map.
    Tone,
}

/// A part of a material.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// The material as a whole: only one of the states has it.
    Whole,
    /// Its metal.
    Metal,
    /// The Fresnel form of its metal.
    Form,
    /// A factor by its key.
    Factor(String),
    /// What is in a texture slot, by the key of the role.
    Texture(String),
}

/// A setting in which two states differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Which one.
    pub place: Place,
    /// What it belongs to, for people.
    pub group: String,
    /// Its name, for people.
    pub label: String,
    /// The values of A and B, for people.
    pub values: [String; 2],
}

/// What a place holds: the stored value, `None` for none, and how it reads.
type Held = (Option<Value>, String);

/// All places where two states differ, by group. `materials` are those of the two resolved scenes: what a factor is where
/// nothing is stored.
pub fn differences(states: [&Document; 2], materials: [&[Material]; 2]) -> Vec<Difference> {
    let [a, b] = [0, 1].map(|side| places(states[side], materials[side]));
    let all: BTreeSet<&Place> = a.keys().chain(b.keys()).collect();
    let mut list = Vec::new();
    for place in all {
        let absent = |side: usize| (None, unset(place, states[side], materials[side]));
        let held =
            [a.get(place).cloned().unwrap_or_else(|| absent(0)), b.get(place).cloned().unwrap_or_else(|| absent(1))];
        // A stored value may be what the other has anyway.
        if held[0].0 == held[1].0 || held[0].1 == held[1].1 && !matches!(place, Place::Camera) {
            continue;
        }
        let both_have = |name: &str| states.iter().all(|state| state.materials.iter().any(|entry| entry.name == name));
        if let Place::Material(name, part) = place
            && both_have(name) == (*part == Part::Whole)
        {
            continue;
        }
        let [(_, a), (_, b)] = held;
        list.push(Difference { place: place.clone(), group: group(place), label: label(place), values: [a, b] });
    }
    list
}

/// Everything that is stored in a state.
fn places(document: &Document, materials: &[Material]) -> BTreeMap<Place, Held> {
    let mut all = BTreeMap::new();
    for (index, entry) in document.materials.iter().enumerate() {
        for (part, held) in parts(document, entry, materials.get(index)) {
            all.insert(Place::Material(entry.name.clone(), part), held);
        }
    }
    let text = |text: &str| (Some(Value::from(text)), text.to_string());
    for assignment in &document.assignments {
        all.insert(Place::Assignment(assignment.object.clone()), text(&assignment.material));
    }
    for object in &document.objects {
        let name = object.name.as_deref().unwrap_or(&object.key);
        let moved = if object.transform.is_some() { ", moved" } else { "" };
        let words = format!("{name}, {}{moved}", if object.hidden { "hidden" } else { "visible" });
        all.insert(Place::Object(object.key.clone()), (serde_json::to_value(object).ok(), words));
    }
    for light in document.lights.iter().flatten() {
        let state = if light.muted { ", muted" } else { "" };
        let words = format!("{} {} {}{state}", light.shape.title(), digits(light.power), light.unit().symbol());
        all.insert(Place::Light(light.name.clone()), (serde_json::to_value(light).ok(), words));
    }
    for probe in &document.probes {
        let words = match probe.position {
            Some(position) => format!("{} at {} m", probe.source().id(), position.map(digits).join(" ")),
            None => format!("{} in the middle", probe.source().id()),
        };
        all.insert(Place::Probe(probe.name.clone()), (serde_json::to_value(probe).ok(), words));
    }
    let environment = &document.environment;
    if let Some(source) = &environment.source {
        all.insert(Place::Map, (Some(Value::from(source.as_str())), file_name(source)));
    }
    let number = |value: f64, unit: &str| (Some(Value::from(value)), format!("{}{unit}", digits(value)));
    all.insert(Place::Rotation, number(environment.rotation_deg, " deg"));
    all.insert(Place::Strength, number(environment.strength, ""));
    let [r, g, b] = environment.tint.map(digits);
    all.insert(Place::Tint, (serde_json::to_value(environment.tint).ok(), format!("{r} {g} {b}")));
    if let Some(made) = &environment.made {
        let value = serde_json::to_value(made).ok();
        let words = value.as_ref().map(Value::to_string).unwrap_or_default();
        all.insert(Place::Made, (value, words));
    }
    all.insert(Place::Background, background(environment));
    let (split, strength) = (environment.sun_split, environment.sun_strength);
    let words = if split { "a light" } else { "in the map" };
    let words = if strength == 1.0 { words.into() } else { format!("{words}, times {}", digits(strength)) };
    all.insert(Place::Sun, (serde_json::to_value((split, strength)).ok(), words));
    let lighting = &document.lighting;
    all.insert(Place::Method, text(&lighting.method));
    for (key, value) in &lighting.settings {
        let words = words_of(lighting.live_method().info().params, key, value);
        all.insert(Place::Lighting(key.clone()), (Some(value.clone()), words));
    }
    for (key, entry) in &lighting.overrides {
        let settings = entry.settings.iter().map(|(key, value)| format!(", {key} {value}"));
        let words = entry.method.clone() + &settings.collect::<String>();
        all.insert(Place::Override(key.clone()), (serde_json::to_value(entry).ok(), words));
    }
    for (key, value) in &lighting.reference {
        let words = words_of(reference::PARAMS, key, value);
        all.insert(Place::Reference(key.clone()), (Some(value.clone()), words));
    }
    let view = &document.view;
    all.insert(Place::Camera, (serde_json::to_value(&view.camera).ok(), camera_words(&view.camera)));
    all.insert(Place::Exposure, number(view.exposure_ev, " EV"));
    all.insert(Place::Tone, text(&view.tone));
    all
}

fn background(environment: &EnvironmentEntry) -> Held {
    let EnvironmentEntry { background, background_blur_deg: blur, ground, .. } = environment;
    let value = serde_json::to_value((background, blur, ground)).ok();
    let mut words = match background {
        BackgroundEntry::Environment => "environment".to_string(),
        BackgroundEntry::Color(color) => color.map(digits).join(" "),
        BackgroundEntry::Unknown(value) => value.to_string(),
    };
    if *blur > 0.0 {
        words += &format!(", blurred {} deg", digits(*blur));
    }
    if let Some(ground) = ground {
        let shadows = if ground.shadows { " with shadows" } else { "" };
        words += &format!(", ground {} m below, {} m wide{shadows}", digits(ground.height), digits(ground.radius));
    }
    (value, words)
}

fn parts(document: &Document, entry: &MaterialEntry, material: Option<&Material>) -> Vec<(Part, Held)> {
    let mut parts = vec![(Part::Whole, (serde_json::to_value(entry).ok(), "is there".to_string()))];
    if let Some(used) = &entry.preset {
        let metal = document.metal(&used.id);
        let name = metal.map_or_else(|| used.id.clone(), |metal| metal.name.clone());
        // Two documents may mean different metals by one id.
        let stored = document.presets.iter().find(|own| own.id == used.id);
        let value = stored.and_then(|own| serde_json::to_value(&**own).ok());
        parts.push((Part::Metal, (Some(value.unwrap_or_else(|| Value::from(used.id.as_str()))), name)));
        if let Some(form) = &used.fresnel {
            parts.push((Part::Form, (Some(Value::from(form.as_str())), form.clone())));
        }
    }
    for (key, value) in &entry.values {
        let words = match (entry.value(key), param::find(params::PARAMS, key)) {
            (Some(value), Ok(spec)) => words(spec, value),
            _ => value.to_string(),
        };
        // What is stored counts by what it does: the source may have the same value.
        let found = material.and_then(|material| params::get(material, key)).filter(|_| entry.value(key).is_none());
        let words = found.and_then(|v| Some(self::words(param::find(params::PARAMS, key).ok()?, v))).unwrap_or(words);
        parts.push((Part::Factor(key.clone()), (Some(value.clone()), words)));
    }
    for (role, choice) in &entry.textures {
        let words = match choice {
            super::TextureChoice::None => "none".into(),
            super::TextureChoice::File(path) => file_name(path),
            super::TextureChoice::Image(index) => format!("image {index} of the model"),
        };
        parts.push((Part::Texture(role.clone()), (serde_json::to_value(choice).ok(), words)));
    }
    parts
}

/// How a place reads where nothing is stored.
fn unset(place: &Place, document: &Document, materials: &[Material]) -> String {
    let default = |specs: &[ParamSpec], key: &str| param::find(specs, key).map(|spec| words(spec, spec.default()));
    match place {
        Place::Material(name, Part::Factor(key)) => {
            let index = document.materials.iter().position(|entry| entry.name == *name);
            let value = index.and_then(|index| params::get(materials.get(index)?, key));
            let spec = param::find(params::PARAMS, key).ok();
            value.zip(spec).map_or_else(|| "as the model".into(), |(value, spec)| words(spec, value))
        }
        Place::Material(_, Part::Whole) => "is not there".into(),
        Place::Material(_, Part::Metal) => "none".into(),
        Place::Material(_, Part::Form) => "as the scene".into(),
        Place::Material(_, Part::Texture(_)) | Place::Assignment(_) | Place::Map | Place::Made => "as the model".into(),
        Place::Object(key) => format!("{key}, visible"),
        Place::Override(_) => "as the scene".into(),
        Place::Probe(_) => "is not there".into(),
        Place::Light(_) if document.lights.is_some() => "is not there".into(),
        Place::Light(_) => "as the model".into(),
        Place::Lighting(key) => default(document.lighting.live_method().info().params, key).unwrap_or_default(),
        Place::Reference(key) => default(reference::PARAMS, key).unwrap_or_default(),
        Place::Rotation | Place::Strength | Place::Tint | Place::Background | Place::Sun => String::new(),
        Place::Method | Place::Camera | Place::Exposure | Place::Tone => String::new(),
    }
}

fn group(place: &Place) -> String {
    match place {
        Place::Material(name, _) => format!("Material {name}"),
        Place::Assignment(_) | Place::Object(_) => "Objects".into(),
        Place::Light(_) => "Lights".into(),
        Place::Probe(_) => "Probes".into(),
        Place::Map | Place::Rotation | Place::Strength | Place::Tint => "Environment".into(),
        Place::Made | Place::Background | Place::Sun => "Environment".into(),
        Place::Method | Place::Lighting(_) | Place::Override(_) => "Lighting".into(),
        Place::Reference(_) => "Reference".into(),
        Place::Camera | Place::Exposure | Place::Tone => "View".into(),
    }
}

fn label(place: &Place) -> String {
    let of = |specs: &[ParamSpec], key: &str| param::find(specs, key).map_or(key.into(), |spec| spec.label.to_string());
    match place {
        Place::Material(_, Part::Whole) => "Material".into(),
        Place::Material(_, Part::Metal) => "Metal".into(),
        Place::Material(_, Part::Form) => "Fresnel form".into(),
        Place::Material(_, Part::Factor(key)) => of(params::PARAMS, key),
        Place::Material(_, Part::Texture(role)) => format!("Texture {role}"),
        Place::Assignment(object) => format!("Material of {object}"),
        Place::Object(key) => format!("Object {key}"),
        Place::Light(name) => format!("Light {name}"),
        Place::Probe(name) => format!("Probe {name}"),
        Place::Map => "HDRI".into(),
        Place::Rotation => "Rotation".into(),
        Place::Strength => "Strength".into(),
        Place::Tint => "Tint".into(),
        Place::Made => "Made map".into(),
        Place::Background => "Background".into(),
        Place::Sun => "Sun".into(),
        Place::Method => "Method".into(),
        Place::Lighting(key) => of(setting_of_any_method(key), key),
        Place::Override(object) => format!("Method of {object}"),
        Place::Reference(key) => of(reference::PARAMS, key),
        Place::Camera => "Camera".into(),
        Place::Exposure => "Exposure".into(),
        Place::Tone => "Tone map".into(),
    }
}

/// The settings of the first method that has one of this key.
fn setting_of_any_method(key: &str) -> &'static [ParamSpec] {
    let of = lighting::methods().into_iter().map(|method| method.info().params);
    of.into_iter().find(|specs| param::find(specs, key).is_ok()).unwrap_or_default()
}

fn words_of(specs: &[ParamSpec], key: &str, value: &Value) -> String {
    let read = param::find(specs, key).and_then(|spec| Ok(words(spec, spec.from_json(value)?)));
    read.unwrap_or_else(|_| value.to_string())
}

fn words(spec: &ParamSpec, value: ParamValue) -> String {
    let unit = if matches!(spec.unit.len(), 1..=4) { format!(" {}", spec.unit) } else { String::new() };
    match value {
        ParamValue::Number(number) => format!("{}{unit}", digits(number)),
        ParamValue::Integer(number) => format!("{number}{unit}"),
        ParamValue::Color([a, b, c]) | ParamValue::Vector([a, b, c]) => {
            format!("{} {} {}", digits(a), digits(b), digits(c))
        }
        ParamValue::Toggle(on) => if on { "on" } else { "off" }.into(),
        ParamValue::Choice(_) => spec.json(value).as_str().map(Into::into).unwrap_or_default(),
    }
}

/// At most four places, none that say nothing.
fn digits(value: f64) -> String {
    let rounded = (value * 1e4).round() / 1e4;
    if rounded == 0.0 && value != 0.0 { format!("{value:.1e}") } else { format!("{rounded}") }
}

fn camera_words(camera: &super::CameraEntry) -> String {
    let kind = if camera.orthographic { ", parallel" } else { "" };
    format!("{:.0}, {:.0} deg at {:.3} m{kind}", camera.yaw_deg, camera.pitch_deg, camera.distance)
}

fn file_name(path: &str) -> String {
    std::path::Path::new(path).file_name().map_or_else(|| path.into(), |name| name.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Assigned, Curves, DEFAULT_SCENE, Opened, Resolved, Side, open, resolve};
    use crate::material::preset;

    fn metal(id: &str) -> &'static preset::Preset {
        preset::library().iter().find(|metal| metal.id == id).unwrap()
    }

    /// What differs between the sides.
    fn list(opened: &Opened, document: &Document) -> Vec<Difference> {
        let states = Side::ALL.map(|side| document.of_side(side));
        let scenes: [Resolved; 2] =
            [0, 1].map(|side: usize| resolve(&states[side], &opened.sources, &mut Curves::default()));
        differences([&states[0], &states[1]], [&scenes[0].scene.materials, &scenes[1].scene.materials])
    }

    /// A stored, then everything that a line can be about is changed.
    fn edited() -> (Opened, Document) {
        let opened = open(DEFAULT_SCENE).unwrap();
        let mut document = opened.document.clone();
        document.assign_preset(0, metal("Au"), Assigned::KeepTextures);
        document.store_side(Side::A);
        document.assign_preset(0, &preset::Preset { id: "mine".into(), ..metal("Cu").clone() }, Assigned::KeepTextures);
        document.set_fresnel(0, Some("schlick"));
        document.set_value(1, "roughness", ParamValue::Number(0.77)).unwrap();
        document.set_texture(1, crate::material::TextureRole::Normal, Some(crate::document::TextureChoice::None));
        document.set_lighting("samples", ParamValue::Integer(64)).unwrap();
        document.set_reference("bounces", ParamValue::Integer(3)).unwrap();
        document.environment.rotation_deg = 30.0;
        document.environment.strength = 2.0;
        document.environment.source = Some("/maps/a.hdr".into());
        document.view.exposure_ev = 1.0;
        document.view.tone = "agx".into();
        document.view.camera.orbit(20.0, 0.0);
        let added = document.add_material("extra");
        document.assign_material(&["foot".into()], "extra");
        document.edit_object("ring", |entry| entry.hidden = true);
        document.add_probe(Vec::new());
        assert!(added > 0);
        (opened, document)
    }

    #[test]
    fn every_edit_is_one_line_with_the_values_of_both() {
        let (opened, document) = edited();
        let lines = list(&opened, &document);
        let named = |label: &str| lines.iter().find(|line| line.label == label).map(|line| line.values.clone());
        assert_eq!(named("Metal"), Some(["Gold".into(), metal("Cu").name.clone()]));
        assert_eq!(named("Fresnel form"), Some(["as the scene".into(), "schlick".into()]));
        let roughness = named("Roughness").unwrap();
        assert!(roughness[1] == "0.77" && roughness[0].parse::<f64>().is_ok(), "{roughness:?}");
        assert_eq!(named("Bounces"), Some(["64".into(), "3".into()]));
        assert_eq!(named("Rotation"), Some(["0 deg".into(), "30 deg".into()]));
        assert_eq!(named("HDRI"), Some(["as the model".into(), "a.hdr".into()]));
        assert_eq!(named("Material of foot"), Some(["as the model".into(), "extra".into()]));
        assert_eq!(named("Object ring"), Some(["ring, visible".into(), "ring, hidden".into()]));
        assert_eq!(lines.len(), 16, "{lines:#?}");
        let groups: BTreeSet<&str> = lines.iter().map(|line| line.group.as_str()).collect();
        assert_eq!(groups.len(), 9, "{groups:?}");
    }

    #[test]
    fn copying_every_line_makes_the_sides_equal_in_both_directions() {
        for to in Side::ALL {
            let (opened, mut document) = edited();
            let from = document.of_side(to.other());
            let lines = list(&opened, &document);
            for line in &lines {
                let before = list(&opened, &document);
                if before.iter().any(|left| left.place == line.place) {
                    document.copy_to_side(to, &line.place, &from);
                    let after = list(&opened, &document);
                    let left = after.iter().any(|left| left.place == line.place);
                    // A material that an object still has stays.
                    assert!(!left || line.label == "Material", "{line:?}");
                }
            }
            for line in list(&opened, &document) {
                document.copy_to_side(to, &line.place, &from);
            }
            assert_eq!(list(&opened, &document), [], "to {to:?}");
        }
    }

    #[test]
    fn a_stored_value_that_is_the_default_is_no_difference() {
        let opened = open(DEFAULT_SCENE).unwrap();
        let mut document = opened.document.clone();
        document.store_side(Side::A);
        let material = &resolve(&document, &opened.sources, &mut Curves::default()).scene.materials[0];
        document.set_value(0, "roughness", params::get(material, "roughness").unwrap()).unwrap();
        assert_eq!(list(&opened, &document), []);
    }
}
