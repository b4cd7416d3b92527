//! What a light is like: kind, strength, colour, place, size, what it shines on.

use std::ops::Deref;

use burnish_core::document::{LightEntry, Shape};
use burnish_core::param::{ParamKind, ParamSpec, ParamValue};
use burnish_core::scene::photometry::{EFFICACY, Unit};
use eframe::egui::{self, RichText};

use crate::number::short;
use crate::window::lights::{self, LightAct};
use crate::window::panel::row::{number, spec};
use crate::window::session::Session;
use crate::window::widget::{choice_ui, columns, name_ui, param_ui, typed_ui};

const fn range(min: f64, max: f64, default: f64) -> ParamKind {
    ParamKind::Number { min, max, default }
}

const fn toggle(default: bool) -> ParamKind {
    ParamKind::Toggle { default }
}

const COLOR: ParamSpec = spec(
    "color",
    "Light color",
    "",
    ParamKind::Color { max: 1.0, default: [1.0; 3] },
    "Linear factors on the light, beside its temperature.",
);
const WARM: ParamSpec = spec("warm", "By temperature", "", toggle(false), "The colour of a hot body.");
const KELVIN: ParamSpec = spec(
    "kelvin",
    "Temperature",
    "K",
    range(1000.0, 40_000.0, 6500.0),
    "2700 a bulb, 5600 a flash, 6500 daylight, 10 000 and more the blue sky. The power stays the same.",
);
const PLACE: ParamSpec = spec(
    "place",
    "Position",
    "m",
    ParamKind::Vector { min: [-1e6; 3], max: [1e6; 3], default: [0.0; 3] },
    "Where it stands.",
);
const YAW: ParamSpec =
    spec("yaw", "Yaw", "deg", range(-180.0, 180.0, 0.0), "About the vertical axis; at 0 it shines along -z.");
const PITCH: ParamSpec = spec("pitch", "Pitch", "deg", range(-90.0, 90.0, 0.0), "At -90 it shines straight down.");
const ROLL: ParamSpec =
    spec("roll", "Roll", "deg", range(-180.0, 180.0, 0.0), "About the direction in which it shines.");
const WIDTH: ParamSpec = spec("width", "Width", "m", range(0.0, 100.0, 1.0), "Of the rectangle.");
const HEIGHT: ParamSpec = spec("height", "Height", "m", range(0.0, 100.0, 1.0), "Of the rectangle.");
const RADIUS: ParamSpec = spec("radius", "Radius", "m", range(0.0, 100.0, 0.1), "Of the sphere.");
const ANGLE: ParamSpec = spec(
    "angle",
    "Angle",
    "deg",
    range(0.0, 90.0, 0.53),
    "Of its whole disc: 0.53 is the sun; wider makes softer shadows.",
);
const INNER: ParamSpec = spec("inner", "Inner cone", "deg", range(0.0, 90.0, 20.0), "Half angle of full strength.");
const OUTER: ParamSpec =
    spec("outer", "Outer cone", "deg", range(0.1, 90.0, 30.0), "Half angle beyond which it is dark.");
const RANGE: ParamSpec =
    spec("range", "Range", "m", range(0.0, 1000.0, 0.0), "Distance at which it is cut off smoothly; 0 for none.");
const CAMERA: ParamSpec =
    spec("camera", "Seen", "", toggle(true), "The light itself is seen in the picture, as a shape.");
const REFLECTIONS: ParamSpec = spec(
    "reflections",
    "In reflections",
    "",
    toggle(true),
    "It adds to highlights and mirrors. Without, metals see nothing of it; only diffuse surfaces do.",
);
const SHADOWS: ParamSpec = spec("shadows", "Shadows", "", toggle(true), "Objects stand in its way.");

/// A light that is edited, with its session.
struct Editor<'a> {
    session: &'a mut Session,
    light: LightEntry,
}

impl Deref for Editor<'_> {
    type Target = LightEntry;

    fn deref(&self) -> &LightEntry {
        &self.light
    }
}

/// Shows the light of a name.
pub fn ui(ui: &mut egui::Ui, session: &mut Session, name: &str) {
    let Some(light) = lights::entry(session, name) else { return };
    let mut editor = Editor { session, light };
    // Another light has other widgets.
    ui.push_id(name, |ui| {
        editor.name_ui(ui);
        editor.kind_ui(ui);
        editor.power_ui(ui);
        editor.color_ui(ui);
        editor.size_ui(ui);
        editor.place_ui(ui);
        editor.switches_ui(ui);
        editor.links_ui(ui);
    });
}

impl Editor<'_> {
    fn set(&mut self, label: &str, change: impl FnOnce(&mut LightEntry)) {
        lights::set(self.session, label, &self.light.name, change);
    }

    /// A row for a number or other value of the light.
    fn row(
        &mut self,
        ui: &mut egui::Ui,
        spec: &ParamSpec,
        value: ParamValue,
        change: impl FnOnce(&mut LightEntry, ParamValue),
    ) {
        let edit = param_ui(ui, spec, value, spec.default());
        if let Some(new) = edit.value(spec) {
            self.set(&format!("{} of light", spec.label), |light| change(light, new));
        }
        if edit.ended {
            self.session.seal();
        }
    }

    fn number_row(&mut self, ui: &mut egui::Ui, spec: &ParamSpec, value: f64, set: impl FnOnce(&mut LightEntry, f64)) {
        self.row(ui, spec, ParamValue::Number(value), |light, value| set(light, number(value)));
    }

    fn toggle_row(&mut self, ui: &mut egui::Ui, spec: &ParamSpec, on: bool, set: impl FnOnce(&mut LightEntry, bool)) {
        self.row(ui, spec, ParamValue::Toggle(on), |light, value| set(light, value == ParamValue::Toggle(true)));
    }

    fn name_ui(&mut self, ui: &mut egui::Ui) {
        for (label, text) in [("Light name", self.name.clone()), ("Group", self.group.clone())] {
            ui.horizontal(|ui| {
                let [names, controls] = columns(ui);
                name_ui(ui, label, false, names);
                if let Some(typed) = typed_ui(ui, label, &text, controls) {
                    self.call(label, &typed);
                }
            });
        }
    }

    /// Gives it another name or group.
    fn call(&mut self, label: &str, typed: &str) {
        let (name, model) = (self.light.name.clone(), lights::model(self.session));
        if label == "Group" {
            self.set("Group of light", |light| light.group = typed.into());
        } else {
            let mut new = name.clone();
            self.session.edit("Rename light", &name, |document| new = document.rename_light(&model, &name, typed));
            self.session.selection.lights = vec![new];
        }
        self.session.seal();
    }

    fn kind_ui(&mut self, ui: &mut egui::Ui) {
        let shapes = Shape::all(lights::radius(self.session));
        let titles = shapes.map(|shape| shape.title());
        let chosen = titles.iter().position(|title| *title == self.shape.title()).unwrap_or(0);
        ui.horizontal(|ui| {
            let [names, controls] = columns(ui);
            let name = name_ui(ui, "Kind", false, names);
            let hover = "Another kind lights the subject as much as this one.";
            if let Some(picked) = choice_ui(ui, "Kind", &titles, chosen, controls, Some(&name), hover)
                && picked != chosen
            {
                let distance = f64::from(self.place().distance(self.session.subject_bounds().center()));
                self.set("Kind of light", |light| light.set_shape(shapes[picked], distance));
                self.session.seal();
            }
        });
    }

    fn power_ui(&mut self, ui: &mut egui::Ui) {
        let (kind, unit) = (self.kind(), self.unit());
        let power = spec("power", "Power", unit.symbol(), range(0.0, 1e9, 1.0), "How strong the light is.");
        self.number_row(ui, &power, self.light.power, |light, power| light.power = power.max(0.0));
        let units: Vec<Unit> = Unit::of_kind(&kind).collect();
        let symbols: Vec<&str> = units.iter().map(|unit| unit.symbol()).collect();
        let chosen = units.iter().position(|known| *known == unit).unwrap_or(usize::MAX);
        ui.horizontal(|ui| {
            let [names, controls] = columns(ui);
            let name = name_ui(ui, "Unit", false, names);
            let hover = "lm: all its light. cd: along its axis. nit: luminance of its surface. lx: on a surface that faces \
                         the sun. W: all its light as power.";
            if let Some(picked) = choice_ui(ui, "Unit", &symbols, chosen, controls, Some(&name), hover) {
                self.set("Unit of light", |light| light.set_unit(units[picked]));
                self.session.seal();
            }
        });
        let others = units.iter().filter(|known| **known != unit);
        let same = others.filter_map(|other| {
            let value = unit.convert(self.light.power, *other, &kind)?;
            Some(format!("{} {}", short(value), other.symbol()))
        });
        let same = same.collect::<Vec<_>>().join(", ");
        if !same.is_empty() {
            ui.label(RichText::new(format!("= {same}")).small().weak())
                .on_hover_text(format!("The same light in other units. A watt is {EFFICACY} lumen."));
        }
        if chosen == usize::MAX {
            let text = "It has no area to give that off: give it a size, or another unit.";
            ui.label(RichText::new(text).small().color(ui.visuals().warn_fg_color));
        }
    }

    fn color_ui(&mut self, ui: &mut egui::Ui) {
        self.row(ui, &COLOR, ParamValue::Color(self.light.color), |light, value| {
            if let ParamValue::Color(color) = value {
                light.color = color;
            }
        });
        self.toggle_row(ui, &WARM, self.kelvin.is_some(), |light, on| light.kelvin = on.then_some(6500.0));
        if let Some(kelvin) = self.kelvin {
            self.number_row(ui, &KELVIN, kelvin, |light, kelvin| light.kelvin = Some(kelvin));
        }
    }

    fn size_ui(&mut self, ui: &mut egui::Ui) {
        match self.shape {
            Shape::Point => {}
            Shape::Spot { inner_deg, outer_deg } => {
                self.number_row(ui, &OUTER, outer_deg, |light, outer_deg| {
                    light.shape = Shape::Spot { inner_deg: inner_deg.min(outer_deg), outer_deg };
                });
                self.number_row(ui, &INNER, inner_deg, |light, inner_deg| {
                    light.shape = Shape::Spot { inner_deg, outer_deg: outer_deg.max(inner_deg) };
                });
            }
            Shape::Sun { angle_deg } => {
                self.number_row(ui, &ANGLE, angle_deg, |light, angle_deg| light.shape = Shape::Sun { angle_deg });
            }
            Shape::Rectangle { width, height } => {
                self.number_row(ui, &WIDTH, width, |light, width| light.shape = Shape::Rectangle { width, height });
                self.number_row(ui, &HEIGHT, height, |light, height| light.shape = Shape::Rectangle { width, height });
            }
            Shape::Sphere { radius } => {
                self.number_row(ui, &RADIUS, radius, |light, radius| light.shape = Shape::Sphere { radius });
            }
        }
        if matches!(self.shape, Shape::Point | Shape::Spot { .. }) {
            self.number_row(ui, &RANGE, self.range.unwrap_or(0.0), |light, range| {
                light.range = (range > 0.0).then_some(range);
            });
        }
    }

    fn place_ui(&mut self, ui: &mut egui::Ui) {
        if self.shape.has_place() {
            self.row(ui, &PLACE, ParamValue::Vector(self.position), |light, value| {
                if let ParamValue::Vector(position) = value {
                    light.position = position;
                }
            });
        }
        if !self.shape.has_aim() {
            return;
        }
        self.number_row(ui, &YAW, self.yaw_deg, |light, yaw| light.yaw_deg = yaw);
        self.number_row(ui, &PITCH, self.pitch_deg, |light, pitch| light.pitch_deg = pitch);
        if matches!(self.shape, Shape::Rectangle { .. }) {
            self.number_row(ui, &ROLL, self.roll_deg, |light, roll| light.roll_deg = roll);
        }
        let button = ui.button("Aim at subject").on_hover_text("It shines at the middle of what the picture is about.");
        if self.shape.has_place() && button.clicked() {
            lights::act(self.session, LightAct::Aim);
        }
    }

    fn switches_ui(&mut self, ui: &mut egui::Ui) {
        if self.shape.has_area() {
            self.toggle_row(ui, &CAMERA, self.camera, |light, on| light.camera = on);
        }
        self.toggle_row(ui, &REFLECTIONS, self.reflections, |light, on| light.reflections = on);
        self.toggle_row(ui, &SHADOWS, self.shadows, |light, on| light.shadows = on);
    }

    /// The objects that it does not light.
    fn links_ui(&mut self, ui: &mut egui::Ui) {
        let objects: Vec<(String, String)> = {
            let names = self.session.scene().instances.iter().map(|instance| instance.name.clone());
            self.session.resolved().object_keys.iter().cloned().zip(names).collect()
        };
        let title = match self.unlit.len() {
            0 => "Lights all objects".to_string(),
            1 => "Lights all objects but 1".into(),
            count => format!("Lights all objects but {count}"),
        };
        egui::CollapsingHeader::new(title).id_salt("links").default_open(false).show(ui, |ui| {
            egui::ScrollArea::vertical().max_height(160.0).show(ui, |ui| {
                for (key, name) in objects {
                    let mut lit = !self.unlit.contains(&key);
                    let check = ui.checkbox(&mut lit, &name);
                    if check.on_hover_text("The light shines on this object.").changed() {
                        self.set("Objects of light", |light| {
                            light.unlit.retain(|known| *known != key);
                            if !lit {
                                light.unlit.push(key);
                            }
                        });
                        self.session.seal();
                    }
                }
            });
        });
    }
}
