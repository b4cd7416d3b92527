//! A studio by numbers: a backdrop, and softboxes that are painted into the environment.

use burnish_core::document::{MadeEntry, SoftBoxEntry, StudioEntry};
use burnish_core::param::ParamKind::{self, Color, Number, Toggle};
use burnish_core::param::{ParamSpec, ParamValue};
use burnish_core::scene::environment::Shape;
use eframe::egui::{self, Role, WidgetInfo};

use super::{number, row_ui};
use crate::window::panel::row::spec;
use crate::window::session::Session;
use crate::window::widget::{columns, name_ui, typed_ui};

const fn backdrop(key: &'static str, label: &'static str, default: [f64; 3], help: &'static str) -> ParamSpec {
    spec(key, label, "nit", Color { max: 10.0, default }, help)
}

const fn degrees(
    key: &'static str,
    label: &'static str,
    [min, max, default]: [f64; 3],
    help: &'static str,
) -> ParamSpec {
    spec(key, label, "deg", Number { min, max, default }, help)
}

const TOP: ParamSpec = backdrop("top", "Above", [0.05; 3], "Radiance of the backdrop at the zenith.");
const HORIZON: ParamSpec = backdrop("horizon", "Horizon", [0.15; 3], "Radiance of the backdrop at eye level.");
const BOTTOM: ParamSpec = backdrop("bottom", "Below", [0.1; 3], "Radiance of the backdrop at the nadir.");

const AZIMUTH: ParamSpec =
    degrees("azimuth", "Box azimuth", [-180.0, 180.0, -45.0], "Of its middle from the front toward +x.");
const ELEVATION: ParamSpec =
    degrees("elevation", "Box elevation", [-90.0, 90.0, 35.0], "Of its middle above the horizon.");
const WIDTH: ParamSpec = degrees("width", "Box width", [0.5, 170.0, 40.0], "Full angle across.");
const HEIGHT: ParamSpec = degrees("height", "Box height", [0.5, 170.0, 55.0], "Full angle up.");
const ROLL: ParamSpec =
    degrees("roll", "Box roll", [-180.0, 180.0, 0.0], "Counter-clockwise as seen from the middle of the studio.");
const RADIANCE: ParamSpec = spec(
    "radiance",
    "Box radiance",
    "nit",
    Number { min: 0.0, max: 10_000.0, default: 10.0 },
    "Luminance in its middle.",
);
const WARM: ParamSpec = spec("warm", "Box by temperature", "", Toggle { default: false }, "The colour of a hot body.");
const KELVIN: ParamSpec = spec(
    "kelvin",
    "Box temperature",
    "K",
    Number { min: 1000.0, max: 40_000.0, default: 5600.0 },
    "3200 a bulb, 5600 a flash, 6500 daylight.",
);
const COLOR: ParamSpec =
    spec("color", "Box color", "", Color { max: 1.0, default: [1.0; 3] }, "Linear factors on its radiance.");
const SOFTNESS: ParamSpec = spec(
    "softness",
    "Box softness",
    "",
    Number { min: 0.0, max: 1.0, default: 0.1 },
    "Width of the soft edge as a share of the way to the middle.",
);
const RIGHT: ParamSpec = spec(
    "gradient-right",
    "Gradient right",
    "",
    Number { min: -1.0, max: 1.0, default: 0.0 },
    "Change of radiance from the middle to the right edge as a share of it.",
);
const UP: ParamSpec = spec(
    "gradient-up",
    "Gradient up",
    "",
    Number { min: -1.0, max: 1.0, default: 0.0 },
    "Change of radiance from the middle to the upper edge as a share of it.",
);
const SHAPES: &[&str] = &["Rectangle", "Disc"];
const SHAPE: ParamSpec =
    spec("shape", "Box shape", "", ParamKind::Choice { options: SHAPES, default: 0 }, "Outline of the softbox.");

/// Changes the studio of the document as the step `label`.
pub fn edit(session: &mut Session, label: &str, change: impl FnOnce(&mut StudioEntry)) {
    session.edit(label, "", |document| {
        if let Some(MadeEntry::Studio(studio)) = &mut document.environment.made {
            change(studio);
        }
    });
}

/// Rows of the studio; `chosen` is the softbox that is edited.
pub fn ui(ui: &mut egui::Ui, session: &mut Session, studio: &StudioEntry, chosen: &mut usize) {
    let mut row = |spec: &ParamSpec, color: [f64; 3], set: fn(&mut StudioEntry, [f64; 3])| {
        row_ui(ui, session, (spec, spec.label), ParamValue::Color(color), |document, value| {
            if let (Some(MadeEntry::Studio(studio)), ParamValue::Color(color)) = (&mut document.environment.made, value)
            {
                set(studio, color);
            }
        });
    };
    row(&TOP, studio.top, |studio, color| studio.top = color);
    row(&HORIZON, studio.horizon, |studio, color| studio.horizon = color);
    row(&BOTTOM, studio.bottom, |studio, color| studio.bottom = color);
    list_ui(ui, session, studio, chosen);
    if let Some(lamp) = studio.boxes.get(*chosen) {
        ui.push_id(*chosen, |ui| box_ui(ui, session, lamp, *chosen));
    }
}

/// The softboxes, and what is done with them.
fn list_ui(ui: &mut egui::Ui, session: &mut Session, studio: &StudioEntry, chosen: &mut usize) {
    *chosen = (*chosen).min(studio.boxes.len().saturating_sub(1));
    ui.horizontal_wrapped(|ui| {
        for (place, lamp) in studio.boxes.iter().enumerate() {
            let name = title(lamp, place);
            let response = ui.selectable_label(place == *chosen, &name).on_hover_text("Edit this softbox.");
            response.widget_info(|| {
                WidgetInfo::selected(Role::ListItem, true, place == *chosen, format!("Softbox {name}"))
            });
            if response.clicked() {
                *chosen = place;
            }
        }
    });
    let count = studio.boxes.len();
    ui.horizontal_wrapped(|ui| {
        let mut step = None;
        if ui.button("Add softbox").on_hover_text("A new one where there is room.").clicked() {
            let lamp = SoftBoxEntry { name: free_name(studio), ..SoftBoxEntry::default() };
            step = Some(("Add softbox", Some(beside(studio, lamp))));
        }
        let current = studio.boxes.get(*chosen);
        let button =
            |ui: &mut egui::Ui, text: &str| ui.add_enabled(current.is_some(), egui::Button::new(text)).clicked();
        if button(ui, "Duplicate softbox") {
            let copy = current.cloned().map(|lamp| SoftBoxEntry {
                name: free_name(studio),
                azimuth_deg: -lamp.azimuth_deg,
                roll_deg: -lamp.roll_deg,
                gradient: [-lamp.gradient[0], lamp.gradient[1]],
                ..lamp
            });
            step = Some(("Duplicate softbox", copy.map(|lamp| beside(studio, lamp))));
        }
        if button(ui, "Delete softbox") {
            step = Some(("Delete softbox", None));
        }
        let Some((label, added)) = step else { return };
        session.seal();
        let place = *chosen;
        let is_added = added.is_some();
        edit(session, label, |studio| match added {
            Some(lamp) => studio.boxes.push(lamp),
            None if place < studio.boxes.len() => _ = studio.boxes.remove(place),
            None => {}
        });
        session.seal();
        if is_added {
            *chosen = count;
        }
    });
}

/// Its name, or its number.
pub fn title(lamp: &SoftBoxEntry, place: usize) -> String {
    if lamp.name.is_empty() { format!("box {}", place + 1) } else { lamp.name.clone() }
}

/// The softbox, turned until it is not over another.
fn beside(studio: &StudioEntry, mut lamp: SoftBoxEntry) -> SoftBoxEntry {
    let near = |azimuth: f64, other: &SoftBoxEntry| {
        let apart = (azimuth - other.azimuth_deg + 180.0).rem_euclid(360.0) - 180.0;
        apart.abs() < 15.0 && (lamp.elevation_deg - other.elevation_deg).abs() < 15.0
    };
    let turned = |step: u32| (lamp.azimuth_deg + 30.0 * f64::from(step) + 180.0).rem_euclid(360.0) - 180.0;
    let free = (0..12).map(turned).find(|azimuth| !studio.boxes.iter().any(|other| near(*azimuth, other)));
    lamp.azimuth_deg = free.unwrap_or(lamp.azimuth_deg);
    lamp
}

fn free_name(studio: &StudioEntry) -> String {
    let taken = |name: &str| studio.boxes.iter().any(|lamp| lamp.name == name);
    (studio.boxes.len() + 1..).map(|number| format!("box {number}")).find(|name| !taken(name)).unwrap_or_default()
}

fn box_ui(ui: &mut egui::Ui, session: &mut Session, lamp: &SoftBoxEntry, place: usize) {
    rename_ui(ui, session, lamp, place);
    let mut row = |spec: &ParamSpec, value: ParamValue, set: fn(&mut SoftBoxEntry, ParamValue)| {
        row_ui(ui, session, (spec, spec.label), value, |document, value| {
            if let Some(MadeEntry::Studio(studio)) = &mut document.environment.made
                && let Some(lamp) = studio.boxes.get_mut(place)
            {
                set(lamp, value);
            }
        });
    };
    let shape = ParamValue::Choice(usize::from(lamp.shape == Shape::Disc));
    row(&SHAPE, shape, |lamp, value| {
        lamp.shape = if value == ParamValue::Choice(1) { Shape::Disc } else { Shape::Rectangle };
    });
    row(&AZIMUTH, ParamValue::Number(lamp.azimuth_deg), |lamp, value| lamp.azimuth_deg = number(value));
    row(&ELEVATION, ParamValue::Number(lamp.elevation_deg), |lamp, value| lamp.elevation_deg = number(value));
    row(&WIDTH, ParamValue::Number(lamp.width_deg), |lamp, value| lamp.width_deg = number(value));
    row(&HEIGHT, ParamValue::Number(lamp.height_deg), |lamp, value| lamp.height_deg = number(value));
    row(&ROLL, ParamValue::Number(lamp.roll_deg), |lamp, value| lamp.roll_deg = number(value));
    row(&RADIANCE, ParamValue::Number(lamp.radiance), |lamp, value| lamp.radiance = number(value));
    row(&WARM, ParamValue::Toggle(lamp.kelvin.is_some()), |lamp, value| {
        lamp.kelvin = (value == ParamValue::Toggle(true)).then_some(5600.0);
    });
    match lamp.kelvin {
        Some(kelvin) => {
            row(&KELVIN, ParamValue::Number(kelvin), |lamp, value| lamp.kelvin = Some(number(value)));
        }
        None => row(&COLOR, ParamValue::Color(lamp.color), |lamp, value| {
            if let ParamValue::Color(color) = value {
                lamp.color = color;
            }
        }),
    }
    row(&SOFTNESS, ParamValue::Number(lamp.softness), |lamp, value| lamp.softness = number(value));
    row(&RIGHT, ParamValue::Number(lamp.gradient[0]), |lamp, value| lamp.gradient[0] = number(value));
    row(&UP, ParamValue::Number(lamp.gradient[1]), |lamp, value| lamp.gradient[1] = number(value));
}

/// Its name; what is typed counts when the field is left.
fn rename_ui(ui: &mut egui::Ui, session: &mut Session, lamp: &SoftBoxEntry, place: usize) {
    ui.horizontal(|ui| {
        let [names, controls] = columns(ui);
        name_ui(ui, "Box name", false, names);
        if let Some(typed) = typed_ui(ui, "Box name", &lamp.name, controls) {
            edit(session, "Rename softbox", |studio| {
                if let Some(lamp) = studio.boxes.get_mut(place) {
                    lamp.name = typed;
                }
            });
            session.seal();
        }
    });
}
