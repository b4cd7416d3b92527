//! Sliders and fields of numbers and vectors.

use burnish_core::param::{ParamSpec, ParamValue};
use eframe::egui::{self, DragValue, Response, Slider, SliderClamping, vec2};

use super::{Change, ParamEdit};

/// Points of a number field.
pub(super) const FIELD_WIDTH: f32 = 62.0;
/// Largest value from which a slider is logarithmic.
pub(super) const LOGARITHMIC: f64 = 1000.0;
/// Largest value over the default from which it is so too: the default would stand at the end of the rail.
const FAR_ABOVE_DEFAULT: f64 = 100.0;

/// Slider and field. Returns the new value, and whether the edit ended.
pub(super) fn number_ui(
    ui: &mut egui::Ui,
    (spec, min, max, places): (&ParamSpec, f64, f64, usize),
    number: f64,
    width: f32,
    name: &Response,
    hover: &str,
) -> (Option<f64>, bool) {
    let mut new = number;
    let gap = ui.spacing().item_spacing.x;
    ui.spacing_mut().slider_width = (width - FIELD_WIDTH - gap).max(24.0);
    let far = matches!(spec.default(), ParamValue::Number(v) if far_above(max, v));
    let logarithmic = min >= 0.0 && (max >= LOGARITHMIC || far);
    let slider = Slider::new(&mut new, min..=max)
        .show_value(false)
        .logarithmic(logarithmic)
        .smallest_positive(0.01)
        .step_by(if places == 0 { 1.0 } else { 0.0 })
        .clamping(SliderClamping::Edits);
    let slider = ui.add(slider).labelled_by(name.id).on_hover_text(hover);
    // Longer units stand in the hover text.
    let suffix = match spec.unit {
        "deg" => "°".into(),
        unit if matches!(unit.len(), 1..=3) => format!(" {unit}"),
        _ => String::new(),
    };
    let speed = if logarithmic { 0.01 * number.abs().max(1.0) } else { (max - min) / 250.0 };
    let field = DragValue::new(&mut new)
        .range(min..=max)
        .clamp_existing_to_range(false)
        .speed(if places == 0 { speed.max(0.1) } else { speed })
        .max_decimals(places)
        .suffix(suffix);
    let height = ui.spacing().interact_size.y;
    let field = ui.add_sized(vec2(FIELD_WIDTH, height), field).labelled_by(name.id).on_hover_text(hover);
    // A slider gives all digits of a double; nobody set more than the field shows.
    let scale = 10f64.powi(places as i32);
    let rounded = if max >= LOGARITHMIC { new } else { (new * scale).round() / scale };
    let changed = (slider.changed() || field.changed()).then_some(rounded.clamp(min, max));
    let ended = slider.drag_stopped() || field.drag_stopped() || field.lost_focus() || slider.lost_focus();
    (changed, ended)
}

pub(super) fn far_above(max: f64, default: f64) -> bool {
    default > 0.0 && max >= FAR_ABOVE_DEFAULT * default
}

/// Change of a component for each point of a drag: a part of its range, or of the number where the range is wide.
fn vector_speed(range: f64, value: f64) -> f64 {
    if range > 100.0 { 0.01 * value.abs().max(0.5) } else { 0.004 * range }
}

/// The coordinates of a vector side by side.
pub(super) fn vector_ui(
    ui: &mut egui::Ui,
    spec: &ParamSpec,
    [min, max]: [[f64; 3]; 2],
    vector: [f64; 3],
    width: f32,
    hover: &str,
) -> ParamEdit {
    let mut edit = ParamEdit::default();
    let (mut new, mut changed) = (vector, false);
    let size = vec2((width - 2.0 * ui.spacing().item_spacing.x) / 3.0, ui.spacing().interact_size.y);
    ui.horizontal(|ui| {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let field = DragValue::new(&mut new[axis])
                .range(min[axis]..=max[axis])
                .clamp_existing_to_range(false)
                .speed(vector_speed(max[axis] - min[axis], vector[axis]))
                .max_decimals(3);
            let field = ui.add_sized(size, field).on_hover_text(format!("{letter}. {hover}"));
            ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(format!("{} {letter}", spec.label)));
            edit.ended |= field.drag_stopped() || field.lost_focus();
            changed |= field.changed();
        }
    });
    if changed {
        edit.change = Some(Change::Set(ParamValue::Vector(new)));
    }
    edit
}
