//! Widgets made from declared settings: one row each, with unit, default marker and reset arrow.

mod choice;
mod color;
mod number;
mod row;
#[cfg(test)]
mod tests;

use burnish_core::param::{ParamKind, ParamSpec, ParamValue};
use eframe::egui::{self, Align, Layout, Response, vec2};

use color::{channels_ui, color_ui, hex};
use number::{LOGARITHMIC, far_above, number_ui, vector_ui};

pub use choice::{choice_ui, radio_ui};
pub use color::screen_color;
pub use row::{columns, name_input, name_ui, name_widget, reset_ui, typed_ui};

/// What someone did to a widget.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ParamEdit {
    /// The change, if there is one.
    pub change: Option<Change>,
    /// A drag or the typing ended: what follows is an edit of its own.
    pub ended: bool,
}

/// A change of a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Has this value now.
    Set(ParamValue),
    /// Goes back to the value that it has when nobody sets it.
    Reset,
}

impl ParamEdit {
    fn at_once(value: ParamValue) -> ParamEdit {
        ParamEdit { change: Some(Change::Set(value)), ended: true }
    }

    /// The value that the setting has now, if it changed; a reset goes back to its default.
    pub fn value(&self, spec: &ParamSpec) -> Option<ParamValue> {
        match self.change? {
            Change::Set(value) => Some(value),
            Change::Reset => Some(spec.default()),
        }
    }
}

/// A row for a setting: name, control, reset arrow. `base` is the value that a reset goes back to; a dot marks a
/// `value` that differs.
pub fn param_ui(ui: &mut egui::Ui, spec: &ParamSpec, value: ParamValue, base: ParamValue) -> ParamEdit {
    let hover = hover_text(spec, base);
    let mut edit = ParamEdit::default();
    ui.push_id(spec.key, |ui| {
        ui.horizontal(|ui| {
            let [names, controls] = columns(ui);
            let name = name_ui(ui, spec.label, value != base, names).on_hover_text(&hover);
            edit = control_ui(ui, spec, value, controls, &name, &hover);
            if reset_ui(ui, spec.label, value != base) {
                edit = ParamEdit { change: Some(Change::Reset), ended: true };
            }
        });
        if let ParamValue::Color(color) = value {
            channels_ui(ui, spec, color, &hover, &mut edit);
        }
    });
    edit
}

fn control_ui(
    ui: &mut egui::Ui,
    spec: &ParamSpec,
    value: ParamValue,
    width: f32,
    name: &Response,
    hover: &str,
) -> ParamEdit {
    match (spec.kind, value) {
        (ParamKind::Number { min, max, .. }, ParamValue::Number(number)) => {
            let small = matches!(spec.default(), ParamValue::Number(v) if far_above(max, v)) && max < LOGARITHMIC;
            let places = match min {
                // A range that begins at hundredths shows them.
                0.005..0.05 => 2,
                _ if max - min > 20.0 && !small => 1,
                _ => 3,
            };
            let (changed, ended) = number_ui(ui, (spec, min, max, places), number, width, name, hover);
            ParamEdit { change: changed.map(|v| Change::Set(ParamValue::Number(v))), ended }
        }
        (ParamKind::Integer { min, max, .. }, ParamValue::Integer(whole)) => {
            let range = (spec, min as f64, max as f64, 0);
            let (changed, ended) = number_ui(ui, range, whole as f64, width, name, hover);
            ParamEdit { change: changed.map(|v| Change::Set(ParamValue::Integer(v.round() as i64))), ended }
        }
        (ParamKind::Choice { options, .. }, ParamValue::Choice(index)) => {
            let picked = choice_ui(ui, spec.label, options, index, width, Some(name), hover);
            picked.map(|index| ParamEdit::at_once(ParamValue::Choice(index))).unwrap_or_default()
        }
        (ParamKind::Toggle { .. }, ParamValue::Toggle(mut on)) => {
            let place = vec2(width, ui.spacing().interact_size.y);
            let layout = Layout::left_to_right(Align::Center);
            let response = ui.allocate_ui_with_layout(place, layout, |ui| {
                ui.set_min_width(width);
                ui.checkbox(&mut on, "").labelled_by(name.id).on_hover_text(hover)
            });
            if response.inner.changed() { ParamEdit::at_once(ParamValue::Toggle(on)) } else { ParamEdit::default() }
        }
        (ParamKind::Color { .. }, ParamValue::Color(color)) => color_ui(ui, spec, color, width, name, hover),
        (ParamKind::Vector { min, max, .. }, ParamValue::Vector(vector)) => {
            vector_ui(ui, spec, [min, max], vector, width, hover)
        }
        // A value of another kind cannot be shown; the row says so instead of guessing.
        _ => {
            ui.weak("-");
            ParamEdit::default()
        }
    }
}

/// What a setting does, its unit, range and the value that a reset goes back to.
fn hover_text(spec: &ParamSpec, base: ParamValue) -> String {
    let unit = if spec.unit.is_empty() { String::new() } else { format!(", {}", spec.unit) };
    let base = match (spec.kind, base) {
        (ParamKind::Choice { options, .. }, ParamValue::Choice(i)) => options.get(i).unwrap_or(&"").to_string(),
        (_, ParamValue::Number(v)) => format!("{v}"),
        (_, ParamValue::Integer(v)) => format!("{v}"),
        (_, ParamValue::Toggle(on)) => if on { "on" } else { "off" }.into(),
        (_, ParamValue::Color([r, g, b])) => format!("{r:.3}, {g:.3}, {b:.3} ({})", hex([r, g, b])),
        (_, ParamValue::Vector([x, y, z])) => format!("{x}, {y}, {z}"),
        (_, ParamValue::Choice(i)) => i.to_string(),
    };
    format!("{}\nTakes {}{unit}. Unchanged: {base}.", spec.help, spec.kind)
}
