//! Signs on buttons, painted: the fonts have none.

use std::f32::consts::{PI, TAU};

use eframe::egui::{Color32, Painter, Pos2, Response, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};

/// A sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    /// An arrow that goes back: takes a change back.
    Reset,
    /// A favourite.
    Star,
    /// No favourite yet.
    StarOutline,
    /// An exclamation mark in a triangle: something speaks against it.
    Warning,
}

/// A button with a sign. `name` is read out and shown on hover.
pub fn icon_button(ui: &mut Ui, icon: Icon, size: Vec2, name: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Button, response.enabled(), name));
    let visuals = ui.style().interact(&response);
    if response.hovered() || response.has_focus() {
        ui.painter().rect(
            rect,
            visuals.corner_radius,
            visuals.weak_bg_fill,
            visuals.bg_stroke,
            eframe::egui::StrokeKind::Inside,
        );
    }
    paint(ui.painter(), icon, rect.center(), 0.32 * size.min_elem(), visuals.fg_stroke.color);
    response.on_hover_text(name)
}

/// Paints a sign of a radius in points.
pub fn paint(painter: &Painter, icon: Icon, center: Pos2, radius: f32, color: Color32) {
    match icon {
        Icon::Reset => reset(painter, center, radius, color),
        Icon::Star => star(painter, center, radius, color, Stroke::NONE),
        Icon::StarOutline => star(painter, center, radius, Color32::TRANSPARENT, Stroke::new(1.0, color)),
        Icon::Warning => warning(painter, center, radius, color),
    }
}

/// The mark stands out from the triangle: the sign reads without its colour.
fn warning(painter: &Painter, center: Pos2, radius: f32, color: Color32) {
    let corner = |x: f32, y: f32| center + radius * vec2(x, y);
    let triangle = vec![corner(0.0, -1.1), corner(1.15, 0.9), corner(-1.15, 0.9)];
    painter.add(Shape::convex_polygon(triangle, color, Stroke::new(0.22 * radius, Color32::from_black_alpha(160))));
    let bright = color.r() as u32 + color.g() as u32 > 300;
    let ink = if bright { Color32::BLACK } else { Color32::WHITE };
    let mark = Stroke::new(0.3 * radius, ink);
    painter.line_segment([corner(0.0, -0.4), corner(0.0, 0.25)], mark);
    painter.circle_filled(corner(0.0, 0.6), 0.18 * radius, ink);
}

/// Three quarters of a circle, counter-clockwise, with a head.
fn reset(painter: &Painter, center: Pos2, radius: f32, color: Color32) {
    let (from, to) = (-0.2 * PI, -1.75 * PI);
    let point = |angle: f32, radius: f32| center + radius * vec2(angle.cos(), angle.sin());
    let arc: Vec<Pos2> = (0..=20).map(|i| point(from + (to - from) * i as f32 / 20.0, radius)).collect();
    painter.add(Shape::line(arc, Stroke::new(1.4, color)));
    // The head stands where the arc begins, which is where the arrow points to.
    let along = 0.75;
    let head = vec![
        point(from - 0.55 * along, 1.0 * radius),
        point(from + 0.55, 1.55 * radius),
        point(from + 0.55, 0.45 * radius),
    ];
    painter.add(Shape::convex_polygon(head, color, Stroke::NONE));
}

fn star(painter: &Painter, center: Pos2, radius: f32, fill: Color32, stroke: Stroke) {
    let point = |i: usize| {
        let angle = -0.5 * PI + TAU * i as f32 / 10.0;
        let length = if i.is_multiple_of(2) { 1.25 * radius } else { 0.5 * radius };
        center + length * vec2(angle.cos(), angle.sin())
    };
    if fill != Color32::TRANSPARENT {
        // A star is not convex: one triangle for each point, and the middle.
        for tip in [0, 2, 4, 6, 8] {
            let triangle = vec![point(tip), point(tip + 1), point(tip + 9)];
            painter.add(Shape::convex_polygon(triangle, fill, Stroke::NONE));
        }
        painter.add(Shape::convex_polygon([1, 3, 5, 7, 9].map(point).to_vec(), fill, Stroke::NONE));
    }
    painter.add(Shape::closed_line((0..10).map(point).collect(), stroke));
}
