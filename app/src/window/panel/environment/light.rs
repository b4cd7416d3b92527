//! The HDRI and how its light is shown.

use burnish_core::color::tone::ToneMap;
use burnish_core::param::{Affects, ParamKind, ParamSpec, ParamValue};
use eframe::egui;

use super::{Context, number, row_ui};
use crate::window::files::typed_path;
use crate::window::request::{Purpose, Request};
use crate::window::session::Session;
use crate::window::widget::name_input;

const ROTATION: ParamSpec = ParamSpec {
    key: "rotation",
    label: "Rotation",
    unit: "deg",
    kind: ParamKind::Number { min: -180.0, max: 180.0, default: 0.0 },
    help: "Turns the environment counter-clockwise about the vertical axis; Shift+right drag in the viewport does it too.",
    affects: Affects::Frame,
};

const STRENGTH: ParamSpec = ParamSpec {
    key: "strength",
    label: "Strength",
    unit: "",
    kind: ParamKind::Number { min: 0.0, max: 1000.0, default: 1.0 },
    help: "Factor on the radiance of the environment, background included; lamps keep theirs.",
    affects: Affects::Frame,
};

const EXPOSURE: ParamSpec = ParamSpec {
    key: "exposure",
    label: "Exposure",
    unit: "EV",
    kind: ParamKind::Number { min: -16.0, max: 16.0, default: 0.0 },
    help: "Stops by which the picture is brightened before the tone map; Shift+wheel in the viewport does it too.",
    affects: Affects::Frame,
};

/// Titles of the tone maps in the order of their numbers.
const TITLES: &[&str] = &["None (clamp)", "Khronos PBR Neutral", "AgX", "ACES fit"];

const TONE: ParamSpec = ParamSpec {
    key: "tone",
    label: "Tone map",
    unit: "",
    kind: ParamKind::Choice { options: TITLES, default: 1 },
    help: "How linear light becomes what the screen shows. `None` is the one to measure by.",
    affects: Affects::Frame,
};

/// Which HDRI, and how it stands.
#[derive(Default)]
pub struct LightSection {
    path: String,
}

impl LightSection {
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        source_ui(ui, context.session);
        ui.horizontal(|ui| {
            if ui.button("Load HDRI...").on_hover_text("Pick an .hdr or .exr file to light the scene with.").clicked() {
                context.requests.push(Request::PickFile(Purpose::Environment));
            }
            let changed = context.session.document().environment.source.is_some();
            let clear = ui.add_enabled(changed, egui::Button::new("Clear HDRI"));
            let hover = "Go back to the environment of the model, or the built-in studio where it has none.";
            if clear.on_hover_text(hover).clicked() {
                context.session.edit("Clear HDRI", "", |document| document.environment.source = None);
            }
        });
        self.path_ui(ui, context);
        let environment = &context.session.document().environment;
        let (rotation, strength) = (environment.rotation_deg, environment.strength);
        let rotate = (&ROTATION, "Rotate environment");
        row_ui(ui, context.session, rotate, ParamValue::Number(rotation), |document, value| {
            document.environment.rotation_deg = number(value);
        });
        let strengthen = (&STRENGTH, "Environment strength");
        row_ui(ui, context.session, strengthen, ParamValue::Number(strength), |document, value| {
            document.environment.strength = number(value);
        });
    }

    /// The way around dialogs, which some systems do not have.
    fn path_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 50.0).max(40.0);
            let field =
                egui::TextEdit::singleline(&mut self.path).hint_text("path of an .hdr or .exr").desired_width(width);
            let field = ui.add(field).on_hover_text("Path of an HDRI; Enter loads it.");
            name_input(&field, "HDRI path", &self.path);
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            let named = !self.path.trim().is_empty();
            let button = ui.add_enabled(named, egui::Button::new("Load")).on_hover_text("Load the HDRI at this path.");
            if named && (button.clicked() || entered) {
                context.requests.push(Request::LoadEnvironment(typed_path(&self.path)));
            }
        });
    }
}

/// What lights the scene.
fn source_ui(ui: &mut egui::Ui, session: &Session) {
    let Some(map) = &session.scene().environment else {
        ui.weak("No environment");
        return;
    };
    let document = session.document();
    let from = match &document.environment.source {
        Some(path) => path.clone(),
        None if session.sources().models.get(&document.scene).is_some_and(|model| model.environment.is_some()) => {
            "It comes with the scene.".into()
        }
        None => "The built-in studio, since neither document nor scene has an environment.".into(),
    };
    let name = if map.name.is_empty() { "unnamed" } else { &map.name };
    ui.add(egui::Label::new(egui::RichText::new(name).strong()).truncate()).on_hover_text(from);
    let hover = "Equirectangular map of radiance. It is also the background of the picture.";
    ui.weak(format!("{} x {} pixels, also the background", map.width, map.height)).on_hover_text(hover);
}

/// Exposure and tone map.
pub fn tone_ui(ui: &mut egui::Ui, session: &mut Session) {
    let view = &session.document().view;
    let (exposure, tone) = (view.exposure_ev, view.tone.parse::<ToneMap>().unwrap_or_default());
    row_ui(ui, session, (&EXPOSURE, "Exposure"), ParamValue::Number(exposure), |document, value| {
        document.view.exposure_ev = number(value);
    });
    row_ui(ui, session, (&TONE, "Tone map"), ParamValue::Choice(tone.number() as usize), |document, value| {
        if let ParamValue::Choice(index) = value
            && let Some(tone) = ToneMap::ALL.get(index)
        {
            document.view.tone = tone.id().into();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tone_map_stands_in_the_list_under_its_number() {
        assert_eq!(TITLES.len(), ToneMap::ALL.len());
        for (place, tone) in ToneMap::ALL.into_iter().enumerate() {
            assert_eq!((TITLES[place], tone.number() as usize), (tone.title(), place));
        }
        assert_eq!(TONE.default(), ParamValue::Choice(ToneMap::default().number() as usize));
    }
}
