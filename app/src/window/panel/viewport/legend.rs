//! What the colours of the picture stand for: bands of false colour, marks of clipping, the light that is shown.

use burnish_core::measure::view::{BANDS, DisplayMode, OVER_ALL, OVER_SOME, UNDER_ALL, UNDER_SOME};
use eframe::egui::{self, Align2, Color32, FontId, Rect, Role, Sense, WidgetInfo, pos2, vec2};
use glam::Vec3;

use super::overlay;
use crate::window::aids::{Aids, Source};

/// Points of a line, and of its patch of colour.
const LINE: egui::Vec2 = vec2(126.0, 15.0);
const PATCH: f32 = 22.0;
const MARGIN: f32 = 6.0;

/// Shows the legend of the mode at the lower right of the picture, and whose light it is where that is `honoured`.
pub fn ui(ui: &mut egui::Ui, rect: Rect, aids: &Aids, honoured: bool) {
    let lines = lines(aids.mode);
    if !lines.is_empty() {
        let size = vec2(LINE.x, LINE.y * lines.len() as f32) + egui::Vec2::splat(2.0 * MARGIN);
        let place = Align2::RIGHT_BOTTOM.align_size_within_rect(size, rect.shrink(8.0));
        lines_ui(ui, place, &lines, aids.mode.title());
    }
    if honoured && *aids.source() != Source::All {
        let text = format!("Shown light: {}", aids.source().title());
        overlay::line_ui(
            ui,
            rect,
            Align2::CENTER_BOTTOM,
            &text,
            "`Show light of` in the Lights panel brings all light back.",
        );
    }
}

/// Colours, sRGB encoded, with what they stand for; the brightest first.
fn lines(mode: DisplayMode) -> Vec<(Vec3, &'static str)> {
    match mode {
        DisplayMode::Picture => Vec::new(),
        DisplayMode::FalseColor => BANDS.iter().rev().map(|band| (band.color, band.label)).collect(),
        DisplayMode::Clipping => vec![
            (OVER_ALL, "all too bright"),
            (OVER_SOME, "some too bright"),
            (UNDER_SOME, "some black"),
            (UNDER_ALL, "all black"),
        ],
    }
}

fn lines_ui(ui: &mut egui::Ui, place: Rect, lines: &[(Vec3, &str)], title: &str) {
    let painter = ui.painter_at(place);
    painter.rect_filled(place, 4.0, Color32::from_black_alpha(190));
    for (row, (color, label)) in lines.iter().enumerate() {
        let corner = place.min + vec2(MARGIN, MARGIN + LINE.y * row as f32);
        let [r, g, b] = color.to_array().map(|v| (255.0 * v).round() as u8);
        let patch = Rect::from_min_size(corner, vec2(PATCH, LINE.y));
        painter.rect_filled(patch, 0.0, Color32::from_rgb(r, g, b));
        let at = pos2(patch.right() + 6.0, patch.center().y);
        painter.text(at, Align2::LEFT_CENTER, label, FontId::proportional(11.5), Color32::from_gray(235));
    }
    let response = ui.interact(place, ui.scope_id().with("legend"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("Legend: {title}")));
    if lines.len() == BANDS.len() {
        response.on_hover_text("Stops of exposed luminance about middle grey (0.18), before the tone map.");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mode_but_the_picture_has_a_legend() {
        for mode in DisplayMode::ALL {
            assert_eq!(lines(mode).is_empty(), mode == DisplayMode::Picture, "{mode:?}");
        }
        assert_eq!(lines(DisplayMode::FalseColor).len(), BANDS.len());
    }
}
