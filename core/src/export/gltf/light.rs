//! Lights as KHR_lights_punctual: as they are, or the nearest kind without a size.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;
use serde_json::{Value, json};

use crate::export::{Loss, Report};
use crate::scene::{Light, LightKind};

/// The light's object in the file; what differs becomes notes on `element`.
pub(super) fn punctual(light: &Light, element: &str, report: &mut Report) -> Value {
    let light = &nearest(light, element, report);
    // Colours beyond 1 are allowed, but not what people expect.
    let intensity = light.intensity.max_element();
    let color = if intensity > 0.0 { light.intensity / intensity } else { Vec3::ONE };
    let mut json = json!({ "name": light.name, "color": color.to_array(), "intensity": intensity });
    json["type"] = light.kind.label().into();
    if let LightKind::Spot { inner_angle, outer_angle } = light.kind {
        json["spot"] = json!({ "innerConeAngle": inner_angle, "outerConeAngle": outer_angle });
    }
    if light.range.is_finite() && !matches!(light.kind, LightKind::Directional { .. }) {
        json["range"] = light.range.into();
    }
    json
}

/// The light without a size that gives the same far away: on the axis, where it has one.
fn nearest(light: &Light, element: &str, report: &mut Report) -> Light {
    let mut note = |loss, what: &str| report.note(element, loss, what);
    if !light.reflections {
        note(Loss::Dropped, "its absence from reflections");
    }
    if !light.shadows {
        note(Loss::Dropped, "its lack of shadows");
    }
    if !light.unlit.is_empty() {
        note(Loss::Dropped, "the list of objects that it does not light");
    }
    let (kind, factor) = match light.kind {
        LightKind::Point | LightKind::Spot { .. } => return light.clone(),
        LightKind::Directional { angular_radius } => {
            if angular_radius > 0.0 {
                note(Loss::Approximated, "its angle: parallel light of the same illuminance");
            }
            (LightKind::PARALLEL, 1.0)
        }
        LightKind::Rectangle { size, .. } => {
            note(Loss::Approximated, "its area: a spot of the same candela on the axis, by the square of the cosine");
            (LightKind::Spot { inner_angle: 0.0, outer_angle: FRAC_PI_2 }, size.x * size.y)
        }
        LightKind::Sphere { radius } => {
            note(Loss::Approximated, "its radius: a point of the same candela");
            (LightKind::Point, PI * radius * radius)
        }
    };
    Light { kind, intensity: light.intensity * factor, range: f32::INFINITY, ..light.clone() }
}
