//! A sky by numbers.

use burnish_core::document::{MadeEntry, SkyEntry};
use burnish_core::param::ParamKind::{Color, Number, Toggle};
use burnish_core::param::{ParamSpec, ParamValue};
use burnish_core::scene::environment::TURBIDITY;
use eframe::egui;

use super::{light, number, row_ui};
use crate::window::panel::row::spec;
use crate::window::session::Session;

const ELEVATION: ParamSpec = spec(
    "sun-elevation",
    "Sun elevation",
    "deg",
    Number { min: 0.0, max: 90.0, default: 40.0 },
    "Of the sun above the horizon.",
);
const AZIMUTH: ParamSpec = spec(
    "sun-azimuth",
    "Sun azimuth",
    "deg",
    Number { min: -180.0, max: 180.0, default: 45.0 },
    "Of the sun from the front toward +x.",
);
const HAZE: ParamSpec = spec(
    "turbidity",
    "Turbidity",
    "",
    Number { min: *TURBIDITY.start(), max: *TURBIDITY.end(), default: 3.0 },
    "2 is clear air, 10 haze.",
);
const SUN: ParamSpec = spec(
    "sun",
    "Sun",
    "",
    Toggle { default: true },
    "The sun as a light of its own; without it the sky alone shines, as in the shadow of a house.",
);
const GROUND: ParamSpec = spec(
    "sky-ground",
    "Ground color",
    "",
    Color { max: 1.0, default: [0.2; 3] },
    "Reflectance of the ground below the horizon.",
);

/// Rows of the sky.
pub fn ui(ui: &mut egui::Ui, session: &mut Session, sky: &SkyEntry) {
    let mut row = |spec: &ParamSpec, value: ParamValue, set: fn(&mut SkyEntry, ParamValue)| {
        row_ui(ui, session, (spec, spec.label), value, |document, value| {
            if let Some(MadeEntry::Sky(sky)) = &mut document.environment.made {
                set(sky, value);
            }
        });
    };
    row(&ELEVATION, ParamValue::Number(sky.elevation_deg), |sky, value| sky.elevation_deg = number(value));
    row(&AZIMUTH, ParamValue::Number(sky.azimuth_deg), |sky, value| sky.azimuth_deg = number(value));
    row(&HAZE, ParamValue::Number(sky.turbidity), |sky, value| sky.turbidity = number(value));
    row(&GROUND, ParamValue::Color(sky.ground), |sky, value| {
        if let ParamValue::Color(color) = value {
            sky.ground = color;
        }
    });
    row(&SUN, ParamValue::Toggle(sky.sun), |sky, value| sky.sun = value == ParamValue::Toggle(true));
    if sky.sun {
        light::strength_ui(ui, session);
    }
}
