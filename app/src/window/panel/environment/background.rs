//! What is seen behind the scene: the environment or a colour, sharp or blurred, on a ground.

use burnish_core::document::{BackgroundEntry, GroundEntry};
use burnish_core::param::ParamKind::{self, Color, Number, Toggle};
use burnish_core::param::{ParamSpec, ParamValue};
use burnish_core::scene::environment::BLUR_MAX_DEG;
use eframe::egui;

use super::{number, row_ui};
use crate::window::panel::row::spec;
use crate::window::session::Session;
use crate::window::widget::{Change, param_ui};

const KINDS: &[&str] = &["Environment", "Colour"];
const KIND: ParamSpec = spec(
    "background",
    "Background",
    "",
    ParamKind::Choice { options: KINDS, default: 0 },
    "What the eye sees where it meets no surface. Surfaces go on seeing the environment.",
);
const COLOR: ParamSpec = spec(
    "background-color",
    "Background color",
    "nit",
    Color { max: 10.0, default: [0.0; 3] },
    "Radiance behind everything; black hides the environment.",
);
const BLUR: ParamSpec = spec(
    "background-blur",
    "Background blur",
    "deg",
    Number { min: 0.0, max: BLUR_MAX_DEG, default: 0.0 },
    "Angle at which the lobe that blurs it falls to a half. Light and reflections stay sharp.",
);
const GROUND: ParamSpec = spec(
    "ground",
    "Ground",
    "",
    Toggle { default: false },
    "Lays the environment on a flat ground under the scene and a dome around it, so that objects stand in it.",
);
const HEIGHT: ParamSpec = spec(
    "ground-height",
    "Height of map",
    "m",
    Number { min: 0.05, max: 100.0, default: 1.6 },
    "How high above the ground the camera of the map stood: the larger, the larger its ground.",
);
const RADIUS: ParamSpec = spec(
    "ground-radius",
    "Radius of dome",
    "m",
    Number { min: 0.5, max: 1000.0, default: 20.0 },
    "How far away the surroundings are; more than the height.",
);
const LEVEL: ParamSpec = spec(
    "ground-level",
    "Level",
    "m",
    Number { min: -1000.0, max: 1000.0, default: 0.0 },
    "Height of the ground; under the lowest point of the scene unless it is set.",
);
const SHADOWS: ParamSpec = spec(
    "ground-shadows",
    "Catch shadows",
    "",
    Toggle { default: true },
    "The scene darkens the ground where it stands in the light.",
);

/// Rows of the background.
pub fn ui(ui: &mut egui::Ui, session: &mut Session) {
    let environment = session.document().environment.clone();
    let chosen = usize::from(matches!(environment.background, BackgroundEntry::Color(_)));
    row_ui(ui, session, (&KIND, "Background"), ParamValue::Choice(chosen), |document, value| {
        document.environment.background = match value {
            ParamValue::Choice(1) => BackgroundEntry::Color([0.18; 3]),
            _ => BackgroundEntry::Environment,
        };
    });
    match environment.background {
        BackgroundEntry::Color(color) => {
            row_ui(ui, session, (&COLOR, "Background color"), ParamValue::Color(color), |document, value| {
                if let ParamValue::Color(color) = value {
                    document.environment.background = BackgroundEntry::Color(color);
                }
            });
        }
        _ => {
            let blur = ParamValue::Number(environment.background_blur_deg);
            row_ui(ui, session, (&BLUR, "Background blur"), blur, |document, value| {
                document.environment.background_blur_deg = number(value);
            });
        }
    }
    row_ui(ui, session, (&GROUND, "Ground"), ParamValue::Toggle(environment.ground.is_some()), |document, value| {
        document.environment.ground = (value == ParamValue::Toggle(true)).then(GroundEntry::default);
    });
    if let Some(ground) = &environment.ground {
        ground_ui(ui, session, ground);
    }
}

fn ground_ui(ui: &mut egui::Ui, session: &mut Session, ground: &GroundEntry) {
    let mut row = |ui: &mut egui::Ui, spec: &ParamSpec, value: ParamValue, set: fn(&mut GroundEntry, ParamValue)| {
        row_ui(ui, session, (spec, spec.label), value, |document, value| {
            if let Some(ground) = &mut document.environment.ground {
                set(ground, value);
                // The dome is wider than its middle is high.
                ground.radius = ground.radius.max(1.01 * ground.height);
            }
        });
    };
    row(ui, &HEIGHT, ParamValue::Number(ground.height), |ground, value| ground.height = number(value));
    row(ui, &RADIUS, ParamValue::Number(ground.radius), |ground, value| ground.radius = number(value));
    row(ui, &SHADOWS, ParamValue::Toggle(ground.shadows), |ground, value| {
        ground.shadows = value == ParamValue::Toggle(true);
    });
    // What counts as unchanged, and what is far, is up to the scene.
    let bounds = session.bounds();
    let (base, reach) = match bounds.is_empty() {
        true => (0.0, 1.0),
        false => (f64::from(bounds.min.y), 4.0 * f64::from(bounds.radius()).clamp(1e-3, 1e5)),
    };
    let level = ground.level.unwrap_or(base);
    let kind = Number { min: base - reach, max: base + reach, default: base };
    let spec = ParamSpec { kind, ..LEVEL };
    let edit = param_ui(ui, &spec, ParamValue::Number(level), ParamValue::Number(base));
    let new = match edit.change {
        Some(Change::Set(value)) => Some(Some(number(value))),
        Some(Change::Reset) => Some(None),
        None => None,
    };
    if let Some(new) = new {
        session.edit(LEVEL.label, "", |document| {
            if let Some(ground) = &mut document.environment.ground {
                ground.level = new;
            }
        });
    }
    if edit.ended {
        session.seal();
    }
}
