//! A preset as a ball with its name.

use eframe::egui::{self, Color32, FontId, Response, Sense, Stroke, StrokeKind, TextureId, WidgetInfo, vec2};

use super::item::Item;
use crate::window::icon::{self, Icon};
use crate::window::widget::screen_color;

/// Points of the ball.
const BALL: f32 = 60.0;
/// Points of a tile.
const TILE: egui::Vec2 = vec2(72.0, 82.0);

/// How a tile is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Look {
    /// The inspector's material has it.
    pub in_use: bool,
    /// Its origin is told.
    pub selected: bool,
    /// It has a star.
    pub favourite: bool,
}

/// A button that can be dragged. Its name is that of the preset. `ball` is called where it is seen only.
pub fn tile_ui(ui: &mut egui::Ui, item: &Item, ball: impl FnOnce() -> Option<TextureId>, look: Look) -> Response {
    let (rect, response) = ui.allocate_exact_size(TILE, Sense::click_and_drag());
    response
        .widget_info(|| WidgetInfo::selected(egui::accesskit::Role::Button, ui.is_enabled(), look.in_use, item.name()));
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let ball = ball();
    let visuals = ui.style().interact_selectable(&response, look.selected);
    let painter = ui.painter();
    if look.selected || response.hovered() || response.has_focus() {
        painter.rect_filled(rect, 4.0, visuals.weak_bg_fill);
    }
    if look.in_use || response.has_focus() {
        let stroke = if look.in_use { ui.visuals().selection.stroke } else { visuals.bg_stroke };
        painter.rect_stroke(rect, 4.0, Stroke::new(1.5, stroke.color), StrokeKind::Inside);
    }
    let place = egui::Rect::from_center_size(rect.center_top() + vec2(0.0, 4.0 + 0.5 * BALL), vec2(BALL, BALL));
    ball_ui(painter, place, item, ball);
    if look.favourite {
        icon::paint(painter, Icon::Star, rect.right_top() + vec2(-9.0, 9.0), 5.5, ui.visuals().warn_fg_color);
    }
    if item.warning().is_some() {
        icon::paint(painter, Icon::Warning, rect.left_top() + vec2(10.0, 10.0), 6.0, ui.visuals().warn_fg_color);
    }
    let text = egui::WidgetText::from(item.name()).into_galley(
        ui,
        Some(egui::TextWrapMode::Truncate),
        TILE.x - 6.0,
        FontId::proportional(11.0),
    );
    let at = egui::pos2(rect.center().x - 0.5 * text.size().x, place.bottom() + 2.0);
    painter.galley(at, text, visuals.text_color());
    if response.dragged()
        && let Some(pointer) = ui.pointer_interact_pos()
    {
        let layer = egui::LayerId::new(egui::Order::Tooltip, response.id.with("dragged"));
        let above = ui.ctx().layer_painter(layer);
        ball_ui(&above, egui::Rect::from_center_size(pointer, vec2(48.0, 48.0)), item, ball);
    }
    response
}

/// The rendered ball, or a flat one until there is one.
fn ball_ui(painter: &egui::Painter, place: egui::Rect, item: &Item, ball: Option<TextureId>) {
    match ball {
        Some(texture) => {
            let all = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            painter.image(texture, place, all, Color32::WHITE);
        }
        None => _ = painter.circle_filled(place.center(), 0.47 * place.width(), screen_color(item.color)),
    }
}
