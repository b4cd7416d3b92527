//! Widgets made from declared settings: one row each, with unit, default marker and reset arrow.

use burnish_core::color::rgb;
use burnish_core::param::{ParamKind, ParamSpec, ParamValue};
use eframe::egui::{
    self, Align, Color32, DragValue, Layout, Response, Sense, Slider, SliderClamping, WidgetInfo, vec2,
};
use glam::{DVec3, Vec3};

use super::icon::{Icon, icon_button};

/// Part of a row that the name takes.
const NAME_SHARE: f32 = 0.36;
/// Points of a number field.
const FIELD_WIDTH: f32 = 62.0;
/// Points of a list that drops down; more is scrolled.
const LIST_HEIGHT: f32 = 360.0;
/// Points of the reset arrow.
const RESET_WIDTH: f32 = 18.0;
/// Largest value from which a slider is logarithmic.
const LOGARITHMIC: f64 = 1000.0;
/// Largest value over the default from which it is so too: the default would stand at the end of the rail.
const FAR_ABOVE_DEFAULT: f64 = 100.0;

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

/// Widths of names and of controls in rows like those of [`param_ui`].
pub fn columns(ui: &egui::Ui) -> [f32; 2] {
    let gap = ui.spacing().item_spacing.x;
    let both = ui.available_width() - RESET_WIDTH - gap;
    [both * NAME_SHARE, (both - both * NAME_SHARE - gap).max(40.0)]
}

/// Name of a row with a dot in front of what was changed. Its text names the control.
pub fn name_ui(ui: &mut egui::Ui, name: &str, changed: bool, width: f32) -> Response {
    let height = ui.spacing().interact_size.y;
    let inner = ui.allocate_ui_with_layout(vec2(width, height), Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(width);
        ui.spacing_mut().item_spacing.x = 4.0;
        let (dot, _) = ui.allocate_exact_size(vec2(6.0, height), Sense::hover());
        if changed {
            ui.painter().circle_filled(dot.center(), 2.5, ui.visuals().hyperlink_color);
        }
        let text = if changed { egui::RichText::new(name).strong() } else { name.into() };
        ui.add(egui::Label::new(text).truncate().selectable(false))
    });
    // The rectangle of the whole place, the identity of the text.
    Response { rect: inner.response.rect, ..inner.inner }
}

/// The arrow that takes a change back; it keeps its place where there is none.
pub fn reset_ui(ui: &mut egui::Ui, label: &str, changed: bool) -> bool {
    let size = vec2(RESET_WIDTH, ui.spacing().interact_size.y);
    if !changed {
        ui.allocate_exact_size(size, Sense::hover());
        return false;
    }
    icon_button(ui, Icon::Reset, size, &format!("Reset {label}")).clicked()
}

/// Gives a button whose text is short a name that can be read out.
pub fn name_widget(response: &Response, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::Button, response.enabled(), name));
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

/// Slider and field. Returns the new value, and whether the edit ended.
fn number_ui(
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
    let suffix = if matches!(spec.unit.len(), 1..=3) { format!(" {}", spec.unit) } else { String::new() };
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

fn far_above(max: f64, default: f64) -> bool {
    default > 0.0 && max >= FAR_ABOVE_DEFAULT * default
}

/// A list to choose from. Returns the index when another was picked. `name` is the text beside it; without one the list
/// is called `label`.
pub fn choice_ui<T: AsRef<str>>(
    ui: &mut egui::Ui,
    label: &str,
    options: &[T],
    index: usize,
    width: f32,
    name: Option<&Response>,
    hover: &str,
) -> Option<usize> {
    let mut picked = None;
    let shown = options.get(index).map_or("choose...", AsRef::as_ref);
    let mut list_ui = |ui: &mut egui::Ui| {
        // A long word is cut at the end of the list's place, not at the end of the panel.
        ui.set_max_width(width);
        let list = egui::ComboBox::from_id_salt(label).width(width).height(LIST_HEIGHT).selected_text(shown).truncate();
        list.show_ui(ui, |ui| {
            for (place, option) in options.iter().enumerate() {
                if ui.selectable_label(place == index, option.as_ref()).clicked() && place != index {
                    picked = Some(place);
                }
            }
        })
    };
    let list = ui.scope(|ui| list_ui(ui)).inner;
    match name {
        Some(name) => _ = list.response.labelled_by(name.id).on_hover_text(hover),
        None => {
            list.response.widget_info(|| {
                let mut info = WidgetInfo::labeled(egui::accesskit::Role::ComboBox, true, label);
                info.current_text_value = Some(shown.into());
                info
            });
            list.response.on_hover_text(hover);
        }
    }
    picked
}

/// Swatch and hex field.
fn color_ui(
    ui: &mut egui::Ui,
    spec: &ParamSpec,
    color: [f64; 3],
    width: f32,
    name: &Response,
    hover: &str,
) -> ParamEdit {
    let mut edit = ParamEdit::default();
    let mut rgb = color.map(|v| v as f32);
    let swatch = ui.color_edit_button_rgb(&mut rgb).labelled_by(name.id).on_hover_text(hover);
    if swatch.changed() {
        edit.change = Some(Change::Set(ParamValue::Color(rgb.map(rounded))));
    }
    ui.weak("sRGB");
    let used = swatch.rect.width() + 34.0 + 2.0 * ui.spacing().item_spacing.x;
    let id = ui.scope_id().with("hex");
    let buffer = ui.data(|data| data.get_temp::<String>(id));
    let mut text = buffer.clone().unwrap_or_else(|| hex(color));
    let field = egui::TextEdit::singleline(&mut text).desired_width((width - used).max(54.0)).char_limit(7);
    let field = ui.add(field).on_hover_text("sRGB-encoded, such as #ffd700");
    name_input(&field, &format!("{} hex", spec.label), &text);
    if field.changed()
        && let Some(color) = parse_hex(&text, !field.has_focus())
    {
        edit.change = Some(Change::Set(ParamValue::Color(color)));
    }
    if field.lost_focus() {
        if let Some(color) = parse_hex(&text, true).filter(|_| buffer.is_some()) {
            edit.change = Some(Change::Set(ParamValue::Color(color)));
        }
        edit.ended = true;
    }
    // Asked before: inside, the context is locked.
    let typing = field.has_focus() && (buffer.is_some() || field.changed());
    ui.data_mut(|data| match typing {
        true => _ = data.insert_temp(id, text),
        false => data.remove::<String>(id),
    });
    edit
}

/// The channels as numbers, under the row of a colour.
fn channels_ui(ui: &mut egui::Ui, spec: &ParamSpec, color: [f64; 3], hover: &str, edit: &mut ParamEdit) {
    let ParamKind::Color { max, .. } = spec.kind else { return };
    ui.horizontal(|ui| {
        ui.add_space(12.0);
        ui.weak("linear");
        let (mut new, mut changed) = (color, false);
        let gap = ui.spacing().item_spacing.x;
        let width = ((ui.available_width() - RESET_WIDTH - 3.0 * gap) / 3.0).clamp(30.0, FIELD_WIDTH);
        for (channel, (prefix, word)) in new.iter_mut().zip([("R ", "red"), ("G ", "green"), ("B ", "blue")]) {
            let field = DragValue::new(channel)
                .range(0.0..=max)
                .clamp_existing_to_range(false)
                .speed(0.004 * max)
                .max_decimals(3)
                .prefix(prefix);
            let height = ui.spacing().interact_size.y;
            let field = ui.add_sized(vec2(width, height), field).on_hover_text(format!("{word}, linear. {hover}"));
            ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(format!("{} {word}", spec.label)));
            edit.ended |= field.drag_stopped() || field.lost_focus();
            changed |= field.changed();
        }
        if changed {
            edit.change = Some(Change::Set(ParamValue::Color(new.map(|v| v.clamp(0.0, max)))));
        }
    });
}

/// The coordinates of a vector side by side.
fn vector_ui(
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
                .speed(0.004 * (max[axis] - min[axis]))
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

/// Gives a text field a name that can be read out.
pub fn name_input(response: &Response, name: &str, text: &str) {
    response.widget_info(|| {
        let mut info = WidgetInfo::text_edit(response.enabled(), text, text, "");
        info.label = Some(name.into());
        info
    });
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

/// `#rrggbb`, sRGB-encoded, of a linear colour.
pub fn hex(linear: [f64; 3]) -> String {
    let [r, g, b] = bytes(linear);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// How a linear colour looks on the screen.
pub fn screen_color(linear: Vec3) -> Color32 {
    let [r, g, b] = bytes(linear.as_dvec3().to_array());
    Color32::from_rgb(r, g, b)
}

fn bytes(linear: [f64; 3]) -> [u8; 3] {
    let encoded = rgb::srgb_from_linear(DVec3::from(linear).as_vec3().clamp(Vec3::ZERO, Vec3::ONE));
    encoded.to_array().map(|v| (v * 255.0).round() as u8)
}

/// The linear colour of `#rrggbb`; also of `#rgb` where `short`.
pub fn parse_hex(text: &str, short: bool) -> Option<[f64; 3]> {
    let digits: Vec<u32> =
        text.trim().trim_start_matches('#').chars().map(|c| c.to_digit(16)).collect::<Option<_>>()?;
    let bytes = match digits[..] {
        [a, b, c, d, e, f] => [16 * a + b, 16 * c + d, 16 * e + f],
        [r, g, b] if short => [17 * r, 17 * g, 17 * b],
        _ => return None,
    };
    Some(rgb::linear_from_srgb(Vec3::from(bytes.map(|v| v as f32 / 255.0))).to_array().map(rounded))
}

/// More than a screen shows, fewer digits than a float has.
fn rounded(v: f32) -> f64 {
    (f64::from(v) * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::params::PARAMS;
    use burnish_core::param;
    use egui::accesskit::Role;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    /// All factors of a material with their values, as an inspector shows them.
    fn rows() -> Harness<'static, Vec<ParamValue>> {
        let values = PARAMS.iter().map(ParamSpec::default).collect();
        let show = |ui: &mut egui::Ui, values: &mut Vec<ParamValue>| {
            for (spec, value) in PARAMS.iter().zip(values) {
                match param_ui(ui, spec, *value, spec.default()).change {
                    Some(Change::Set(new)) => *value = new,
                    Some(Change::Reset) => *value = spec.default(),
                    None => {}
                }
            }
        };
        Harness::builder().with_size(vec2(300.0, 800.0)).build_ui_state(show, values)
    }

    fn value(rows: &Harness<Vec<ParamValue>>, key: &str) -> ParamValue {
        PARAMS.iter().zip(rows.state()).find(|(spec, _)| spec.key == key).map(|(_, value)| *value).unwrap()
    }

    #[test]
    fn a_number_is_set_by_its_name_and_reset_by_its_arrow() {
        let mut rows = rows();
        assert!(rows.query_by_label("Reset Roughness").is_none());
        rows.get_by_role_and_label(Role::Slider, "Roughness").set_value_accesskit(0.8);
        rows.run();
        assert_eq!(value(&rows, "roughness"), ParamValue::Number(0.8));
        rows.get_by_role_and_label(Role::SpinButton, "Roughness").set_value_accesskit(0.25);
        rows.run();
        assert_eq!(value(&rows, "roughness"), ParamValue::Number(0.25));
        rows.get_by_label("Reset Roughness").click();
        rows.run();
        assert_eq!(value(&rows, "roughness"), ParamValue::Number(1.0));
    }

    #[test]
    fn colours_choices_and_toggles_are_set_by_their_names() {
        let mut rows = rows();
        rows.get_by_label("Base color hex").set_text_value_accesskit("#ff0000");
        rows.run();
        assert_eq!(value(&rows, "base-color"), ParamValue::Color([1.0, 0.0, 0.0]));
        rows.get_by_role_and_label(Role::SpinButton, "Base color green").set_value_accesskit(0.5);
        rows.run();
        assert_eq!(value(&rows, "base-color"), ParamValue::Color([1.0, 0.5, 0.0]));
        rows.get_by_role_and_label(Role::ColorWell, "Base color");
        rows.get_by_role_and_label(Role::CheckBox, "Double sided").click();
        rows.get_by_role_and_label(Role::ComboBox, "Alpha mode").click();
        rows.run();
        rows.get_by_label("blend").click();
        rows.run();
        assert_eq!(value(&rows, "double-sided"), ParamValue::Toggle(true));
        assert_eq!(value(&rows, "alpha-mode"), ParamValue::Choice(2));
    }

    #[test]
    fn a_drag_ends_once() {
        let mut ended = 0;
        let spec = param::find(PARAMS, "roughness").unwrap();
        let mut number = ParamValue::Number(0.5);
        let mut row = Harness::builder().with_size(vec2(300.0, 40.0)).build_ui(|ui| {
            let edit = param_ui(ui, spec, number, ParamValue::Number(1.0));
            if let Some(Change::Set(new)) = edit.change {
                number = new;
            }
            ended += usize::from(edit.ended);
        });
        let middle = row.get_by_role_and_label(Role::Slider, "Roughness").rect().center();
        row.hover_at(middle);
        row.drag_at(middle);
        row.run();
        row.hover_at(middle + vec2(20.0, 0.0));
        row.run();
        row.drop_at(middle + vec2(20.0, 0.0));
        row.run();
        drop(row);
        assert_eq!(ended, 1);
        assert_ne!(number, ParamValue::Number(0.5));
    }

    #[test]
    fn hex_colours_go_to_linear_and_back() {
        for text in ["#ffd700", "#000000", "#ffffff", "#010203", "#7f8081"] {
            assert_eq!(parse_hex(text, false).map(hex).as_deref(), Some(text));
        }
        assert_eq!(parse_hex("f80", true), parse_hex("#ff8800", false));
        for wrong in ["", "#", "#ff", "#ggg000", "#ff88001", "#f80"] {
            assert_eq!(parse_hex(wrong, false), None, "{wrong}");
        }
    }

    #[test]
    fn the_hover_text_tells_unit_range_and_what_a_reset_goes_back_to() {
        let spec = param::find(PARAMS, "anisotropy-rotation").unwrap();
        let text = hover_text(spec, ParamValue::Number(30.0));
        for part in [spec.help, "-180 to 180", "deg", "Unchanged: 30"] {
            assert!(text.contains(part), "{text}");
        }
    }
}
