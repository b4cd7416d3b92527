//! Colours: a swatch, a hex field, and the channels below.

use burnish_core::color::rgb;
use burnish_core::param::{ParamKind, ParamSpec, ParamValue};
use eframe::egui::{self, Color32, DragValue, Response, vec2};
use glam::{DVec3, Vec3};

use super::number::FIELD_WIDTH;
use super::row::{RESET_WIDTH, name_input};
use super::{Change, ParamEdit};

/// Swatch and hex field.
pub(super) fn color_ui(
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
pub(super) fn channels_ui(ui: &mut egui::Ui, spec: &ParamSpec, color: [f64; 3], hover: &str, edit: &mut ParamEdit) {
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
            // Channels beyond the range that nobody touched stay.
            let clamped = |i: usize| if new[i] == color[i] { new[i] } else { new[i].clamp(0.0, max) };
            edit.change = Some(Change::Set(ParamValue::Color([0, 1, 2].map(clamped))));
        }
    });
}

/// `#rrggbb`, sRGB-encoded, of a linear colour.
pub(super) fn hex(linear: [f64; 3]) -> String {
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
fn parse_hex(text: &str, short: bool) -> Option<[f64; 3]> {
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
}
