//! Exposure and tone map.

use std::f32::consts::PI;

use burnish_core::color::rgb::luminance;
use burnish_core::color::tone::ToneMap;
use burnish_core::param::{Affects, ParamKind, ParamSpec, ParamValue};
use burnish_core::scene::{LightKind, Scene};
use eframe::egui;
use glam::Vec3;

use super::{number, row_ui};
use crate::window::session::Session;

/// Exposures that a document takes, stops.
const RANGE_EV: f64 = 16.0;

const EXPOSURE: ParamSpec = ParamSpec {
    key: "exposure",
    label: "Exposure",
    unit: "EV",
    kind: ParamKind::Number { min: -RANGE_EV, max: RANGE_EV, default: 0.0 },
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

/// Exposure and tone map.
pub fn ui(ui: &mut egui::Ui, session: &mut Session) {
    let view = &session.document().view;
    let (exposure, tone) = (view.exposure_ev, view.tone.parse::<ToneMap>().unwrap_or_default());
    row_ui(ui, session, (&EXPOSURE, "Exposure"), ParamValue::Number(exposure), |document, value| {
        document.view.exposure_ev = number(value);
    });
    let hover = "Sets the exposure so that level ground under sky and sun looks as bright as it reflects: a grey card of 18 % \
                 is middle grey. Other lamps do not count.";
    if ui.button("Expose for sky and sun").on_hover_text(hover).clicked() {
        expose(session, "Exposure", "");
        session.seal();
    }
    row_ui(ui, session, (&TONE, "Tone map"), ParamValue::Choice(tone.number() as usize), |document, value| {
        if let ParamValue::Choice(index) = value
            && let Some(tone) = ToneMap::ALL.get(index)
        {
            document.view.tone = tone.id().into();
        }
    });
}

/// Sets the exposure for what shines from infinitely far away, as a part of the step `label` about `target`.
pub fn expose(session: &mut Session, label: &str, target: &str) {
    if let Some(ev) = exposure_ev(session.scene()) {
        session.edit(label, target, |document| document.view.exposure_ev = ev);
    }
}

/// Stops at which a white plane that faces up has luminance 1: log2 (pi / irradiance). `None` where nothing shines from above.
fn exposure_ev(scene: &Scene) -> Option<f64> {
    let sky = scene.environment.as_ref().map_or(Vec3::ZERO, |map| map.irradiance_up());
    let suns = scene.lights.iter().filter(|light| matches!(light.kind, LightKind::Directional { .. }));
    let suns: Vec3 = suns.map(|sun| sun.intensity * (-sun.direction.y).max(0.0)).sum();
    let irradiance = luminance(sky + suns);
    let ev = (f64::from(PI) / f64::from(irradiance)).log2();
    // A tenth of a stop is enough.
    (irradiance > 0.0 && ev.is_finite()).then(|| (10.0 * ev).round() / 10.0).map(|ev| ev.clamp(-RANGE_EV, RANGE_EV))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use burnish_core::scene::{Environment, Light};

    use super::*;

    #[test]
    fn every_tone_map_stands_in_the_list_under_its_number() {
        assert_eq!(TITLES.len(), ToneMap::ALL.len());
        for (place, tone) in ToneMap::ALL.into_iter().enumerate() {
            assert_eq!((TITLES[place], tone.number() as usize), (tone.title(), place));
        }
        assert_eq!(TONE.default(), ParamValue::Choice(ToneMap::default().number() as usize));
    }

    #[test]
    fn even_light_of_1_nit_needs_no_exposure_and_a_sun_darkens() {
        let even = Arc::new(Environment::new("even", 8, 4, vec![Vec3::ONE; 32]));
        let mut scene = Scene { environment: Some(even), ..Scene::default() };
        assert_eq!(exposure_ev(&scene), Some(0.0));
        let kind = LightKind::Directional { angular_radius: 0.005 };
        let sun = Light { kind, direction: Vec3::NEG_Y, intensity: Vec3::splat(7.0 * PI), ..Light::default() };
        scene.lights.push(sun);
        assert_eq!(exposure_ev(&scene), Some(-3.0));
        assert_eq!(exposure_ev(&Scene::default()), None);
    }
}
