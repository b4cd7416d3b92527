//! The lens, where the camera stands, and how the mouse moves it.

use burnish_core::document::{CameraEntry, VIEW_LABEL};
use burnish_core::param::{Affects, ParamKind, ParamSpec, ParamValue};
use eframe::egui;

use super::{number, row_ui};
use crate::window::panel::viewport::summary;
use crate::window::preferences::{Navigation, Preferences};
use crate::window::session::Session;
use crate::window::widget::{Change, param_ui};

/// Vertical angle of a new view, degrees, and its focal length: 12 mm / tan(17.5 deg).
const YFOV_DEG: f64 = 35.0;
const FOCAL_MM: f64 = 38.059;
/// Largest coordinate of the target that can be typed, meters: a field without bounds takes `inf`.
const FARTHEST_M: f64 = 1e9;

const FOCAL_LENGTH: ParamSpec = ParamSpec {
    key: "focal-length",
    label: "Focal length",
    unit: "mm",
    kind: ParamKind::Number { min: 4.0, max: 1000.0, default: FOCAL_MM },
    help: "Of a lens before a full-frame sensor (36 x 24 mm); the camera stays where it is.",
    affects: Affects::Frame,
};

const FIELD_OF_VIEW: ParamSpec = ParamSpec {
    key: "field-of-view",
    label: "Field of view",
    unit: "deg",
    kind: ParamKind::Number { min: 1.0, max: 170.0, default: YFOV_DEG },
    help: "Full vertical angle of the picture: the focal length in other words.",
    affects: Affects::Frame,
};

const ORTHOGRAPHIC: ParamSpec = ParamSpec {
    key: "orthographic",
    label: "Orthographic",
    unit: "",
    kind: ParamKind::Toggle { default: false },
    help: "Parallel projection that shows what the field of view covers at the target.",
    affects: Affects::Frame,
};

const DISTANCE: ParamSpec = ParamSpec {
    key: "distance",
    label: "Distance",
    unit: "m",
    kind: ParamKind::Number { min: 1e-3, max: 10_000.0, default: 1.0 },
    help: "From the target.",
    affects: Affects::Frame,
};

const SPEED: ParamSpec = ParamSpec {
    key: "speed",
    label: "Speed",
    unit: "",
    kind: ParamKind::Number { min: 0.1, max: 10.0, default: 1.0 },
    help: "Factor on how far a drag or a notch of the wheel goes.",
    affects: Affects::Frame,
};

const INVERT_ZOOM: ParamSpec = ParamSpec {
    key: "invert-zoom",
    label: "Invert zoom",
    unit: "",
    kind: ParamKind::Toggle { default: false },
    help: "Zooms the other way.",
    affects: Affects::Frame,
};

const PRESETS: [(Navigation, &str); 3] =
    [(Navigation::Burnish, "Burnish"), (Navigation::Blender, "Blender"), (Navigation::Maya, "Maya")];

type SetCamera = fn(&mut CameraEntry, ParamValue);

/// The camera of the view.
pub fn ui(ui: &mut egui::Ui, session: &mut Session) {
    let camera = session.document().view.camera.clone();
    let rows: [(&ParamSpec, ParamValue, SetCamera); 3] = [
        (&FOCAL_LENGTH, ParamValue::Number(camera.focal_length_mm()), |c, v| c.set_focal_length_mm(number(v))),
        (&FIELD_OF_VIEW, ParamValue::Number(camera.yfov_deg), |c, v| c.yfov_deg = number(v)),
        (&ORTHOGRAPHIC, ParamValue::Toggle(camera.orthographic), |c, v| c.orthographic = v == ParamValue::Toggle(true)),
    ];
    for (spec, value, set) in rows {
        row_ui(ui, session, (spec, VIEW_LABEL), value, |document, value| set(&mut document.view.camera, value));
    }
    // There is no natural distance: the one that is there counts as unchanged.
    let ParamKind::Number { min, max, .. } = DISTANCE.kind else { return };
    let kind = ParamKind::Number { min, max, default: camera.distance };
    let distance = ParamSpec { kind, ..DISTANCE };
    row_ui(ui, session, (&distance, VIEW_LABEL), ParamValue::Number(camera.distance), |document, value| {
        document.view.camera.distance = number(value);
    });
    target_ui(ui, session, &camera);
}

fn target_ui(ui: &mut egui::Ui, session: &mut Session, camera: &CameraEntry) {
    ui.horizontal(|ui| {
        ui.add_space(10.0);
        ui.label("Target").on_hover_text("The point that the camera turns about, in meters.");
        let mut target = camera.target;
        let mut changed = false;
        for (value, axis) in target.iter_mut().zip(["X", "Y", "Z"]) {
            let field = egui::DragValue::new(value)
                .range(-FARTHEST_M..=FARTHEST_M)
                .clamp_existing_to_range(false)
                .speed(0.005 * camera.distance.clamp(1e-3, 1e6))
                .max_decimals(3)
                .prefix(format!("{axis} "))
                .suffix(" m");
            let field = ui.add(field).on_hover_text(format!("{axis} of the target, meters; +Y is up."));
            ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(format!("Target {axis}")));
            changed |= field.changed();
        }
        if changed {
            session.edit(VIEW_LABEL, "", |document| document.view.camera.target = target);
        }
    });
}

/// Which buttons do what: the user's choice, not the document's.
pub fn navigation_ui(ui: &mut egui::Ui, preferences: &mut Preferences) {
    ui.horizontal_wrapped(|ui| {
        for (navigation, title) in PRESETS {
            let button = ui.selectable_label(preferences.navigation == navigation, title);
            if button.on_hover_text(summary(navigation)).clicked() {
                preferences.navigation = navigation;
            }
        }
    });
    ui.add(egui::Label::new(egui::RichText::new(summary(preferences.navigation)).weak()).wrap());
    let speed = ParamValue::Number(f64::from(preferences.navigation_speed));
    match param_ui(ui, &SPEED, speed, SPEED.default()).change {
        Some(Change::Set(value)) => preferences.navigation_speed = number(value) as f32,
        Some(Change::Reset) => preferences.navigation_speed = 1.0,
        None => {}
    }
    let invert = ParamValue::Toggle(preferences.invert_zoom);
    match param_ui(ui, &INVERT_ZOOM, invert, INVERT_ZOOM.default()).change {
        Some(Change::Set(value)) => preferences.invert_zoom = value == ParamValue::Toggle(true),
        Some(Change::Reset) => preferences.invert_zoom = false,
        None => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lens_and_angle_of_a_new_view_are_the_same_view() {
        let mut camera = CameraEntry { yfov_deg: YFOV_DEG, ..CameraEntry::default() };
        assert!((camera.focal_length_mm() - FOCAL_MM).abs() < 1e-3);
        camera.set_focal_length_mm(FOCAL_MM);
        assert!((camera.yfov_deg - YFOV_DEG).abs() < 1e-3);
        assert!((CameraEntry::default().yfov_deg - YFOV_DEG).abs() < 1e-3);
    }
}
