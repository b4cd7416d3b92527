//! Where the selected object stands, in numbers.

use burnish_core::document::TransformEntry;
use burnish_core::param::{Affects, ParamKind, ParamSpec, ParamValue};
use eframe::egui;

use crate::window::panel::row::row_ui;
use crate::window::session::Session;

const fn vector(
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    range: [f64; 3],
    help: &'static str,
) -> ParamSpec {
    let [min, max, default] = range;
    let kind = ParamKind::Vector { min: [min; 3], max: [max; 3], default: [default; 3] };
    ParamSpec { key, label, unit, kind, help, affects: Affects::Frame }
}

const MOVE: ParamSpec =
    vector("move", "Move", "m", [-1e6, 1e6, 0.0], "How far the object stands from its place in the model.");
const ROTATE: ParamSpec = vector(
    "rotate",
    "Turn",
    "deg",
    [-360.0, 360.0, 0.0],
    "Turns the object about the middle of its box: about z, then x, then y.",
);
const SCALE: ParamSpec =
    vector("scale", "Scale", "", [-1e4, 1e4, 1.0], "Factors along the axes of the world, about the middle of its box.");

/// Shows it where one object is selected.
pub fn ui(ui: &mut egui::Ui, session: &mut Session) {
    let [key] = session.selection.objects.as_slice() else { return };
    let key = key.clone();
    egui::CollapsingHeader::new("Placement").default_open(false).show_unindented(ui, |ui| {
        let now = session.document().transform(&key);
        for (spec, label, get) in [
            (&MOVE, "Move object", (|t| &mut t.by) as fn(&mut TransformEntry) -> &mut [f64; 3]),
            (&ROTATE, "Turn object", |t| &mut t.rotate_deg),
            (&SCALE, "Scale object", |t| &mut t.scale),
        ] {
            let value = *get(&mut now.clone());
            row_ui(ui, session, (spec, label), ParamValue::Vector(value), |document, value| {
                if let ParamValue::Vector(value) = value {
                    let mut changed = now.clone();
                    *get(&mut changed) = value;
                    document.set_transform(&key, changed);
                }
            });
        }
    });
}
