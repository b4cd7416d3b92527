//! Paints a diagram and lets its marks be picked by pointer, key and label.

use eframe::egui::{
    self, Align2, Color32, FontId, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, WidgetInfo, pos2, vec2,
};

use super::diagram::{Diagram, Mark, power};
use crate::report::bench::{COLORS, MARKERS};
use crate::report::chart::Marker;

/// Room for the numbers left of the area, for titles above and below it.
const MARGINS: [f32; 4] = [46.0, 20.0, 18.0, 34.0];
/// Half the size of a mark's place, points.
const HALF: f32 = 7.0;

/// What stands at marks besides.
pub struct Notes<'a> {
    /// The mark that is picked.
    pub picked: Option<usize>,
    /// Letters of the sides that a mark is.
    pub sides: &'a [String],
    /// What the hover text tells of a mark.
    pub details: &'a dyn Fn(&Mark) -> String,
}

/// Paints the diagram; returns the mark that was clicked, and whether Shift was held.
pub fn ui(ui: &mut egui::Ui, diagram: &Diagram, height: f32, notes: &Notes<'_>) -> Option<(usize, bool)> {
    let (whole, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let [left, top, right, bottom] = MARGINS;
    let area = Rect::from_min_max(whole.min + vec2(left, top), whole.max - vec2(right, bottom));
    let painter = ui.painter_at(whole);
    axes(ui, &painter, diagram, area);
    let soft = ui.visuals().weak_text_color();
    let front = diagram.front.iter().map(|index| diagram.place(area, &diagram.marks[*index])).collect();
    painter.add(Shape::line(front, Stroke::new(1.4, soft)));
    let clicked = marks(ui, &painter, diagram, area, notes);
    settings(&painter, diagram, area, soft);
    clicked
}

/// Frame, grid, numbers, titles and the noise of the reference.
fn axes(ui: &egui::Ui, painter: &Painter, diagram: &Diagram, area: Rect) {
    let (soft, font) = (ui.visuals().weak_text_color(), FontId::proportional(11.0));
    let grid = Stroke::new(1.0, ui.visuals().widgets.noninteractive.bg_stroke.color);
    for value in &diagram.x.ticks {
        let at = diagram.at(area, *value, diagram.y.from);
        painter.vline(at.x, area.y_range(), grid);
        painter.text(at + vec2(0.0, 3.0), Align2::CENTER_TOP, power(*value), font.clone(), soft);
    }
    for value in &diagram.y.ticks {
        let at = diagram.at(area, diagram.x.from, *value);
        painter.hline(area.x_range(), at.y, grid);
        painter.text(at - vec2(4.0, 0.0), Align2::RIGHT_CENTER, power(*value), font.clone(), soft);
    }
    let ink = ui.visuals().text_color();
    let below = pos2(area.center().x, area.bottom() + 17.0);
    painter.text(below, Align2::CENTER_TOP, diagram.x.title, font.clone(), ink);
    painter.text(area.left_top() - vec2(40.0, 4.0), Align2::LEFT_BOTTOM, &diagram.title, font.clone(), ink);
    if diagram.floor > 0.0 {
        let line = diagram.at(area, diagram.x.from, diagram.floor);
        let band = Rect::from_min_max(line, area.max);
        painter.rect_filled(band, 0.0, soft.gamma_multiply(0.12));
        let ends = [line, pos2(area.right(), line.y)];
        painter.extend(Shape::dashed_line(&ends, Stroke::new(1.2, soft), 5.0, 4.0));
        let above = pos2(area.right() - 3.0, line.y - 2.0);
        painter.text(above, Align2::RIGHT_BOTTOM, "noise of the reference", font, soft);
    }
}

/// The marks with what they are to the pointer, the keyboard and screen readers.
fn marks(
    ui: &mut egui::Ui,
    painter: &Painter,
    diagram: &Diagram,
    area: Rect,
    notes: &Notes<'_>,
) -> Option<(usize, bool)> {
    let pointer = ui.input(|input| input.pointer.hover_pos());
    let under = pointer.and_then(|pointer| diagram.hit(area, pointer));
    let shift = ui.input(|input| input.modifiers.shift);
    let mut clicked = None;
    for (index, mark) in diagram.marks.iter().enumerate() {
        let at = diagram.place(area, mark);
        let place = Rect::from_center_size(at, vec2(2.0 * HALF, 2.0 * HALF));
        let response = ui.interact(place, ui.scope_id().with(("mark", index)), Sense::click());
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, notes.picked == Some(index), &mark.label));
        if response.clicked() {
            // Where marks lie on each other the nearest one is meant.
            let nearest = response.interact_pointer_pos().and_then(|point| diagram.hit(area, point));
            clicked = Some((nearest.unwrap_or(index), shift));
        }
        let lit = response.has_focus() || notes.picked == Some(index);
        if lit || under == Some(index) {
            let ink = ui.visuals().strong_text_color();
            painter.circle_stroke(at, HALF + 2.0, Stroke::new(if lit { 1.8 } else { 1.0 }, ink));
        }
        paint(painter, at, (mark.method, mark.hollow), ui.visuals());
        if let Some(letters) = notes.sides.get(index).filter(|letters| !letters.is_empty()) {
            let font = FontId::proportional(13.0);
            painter.text(at - vec2(8.0, 6.0), Align2::RIGHT_BOTTOM, letters, font, ui.visuals().strong_text_color());
        }
        if let Some(over) = under.and_then(|under| diagram.marks.get(under)).filter(|_| response.hovered()) {
            response.on_hover_text((notes.details)(over));
        }
    }
    clicked
}

/// What varies, beside the marks where there is room.
fn settings(painter: &Painter, diagram: &Diagram, area: Rect, color: Color32) {
    let font = FontId::proportional(10.5);
    let mut placed: Vec<Rect> = diagram
        .marks
        .iter()
        .map(|mark| Rect::from_center_size(diagram.place(area, mark), vec2(2.0 * HALF, 2.0 * HALF)))
        .collect();
    for mark in diagram.marks.iter().filter(|mark| !mark.settings.is_empty()) {
        let at = diagram.place(area, mark);
        let text = painter.layout_no_wrap(mark.settings.clone(), font.clone(), color);
        let size = text.size();
        let corners = [vec2(11.0, -size.y), vec2(11.0, 1.0), vec2(-11.0 - size.x, 1.0), vec2(-11.0 - size.x, -size.y)];
        let places = corners.into_iter().map(|corner| Rect::from_min_size(at + corner, size));
        let free = places.into_iter().find(|place| {
            area.contains_rect(*place) && placed.iter().all(|other| !other.intersects(place.shrink(1.0)))
        });
        if let Some(place) = free {
            painter.galley(place.min, text, color);
            placed.push(place);
        }
    }
}

/// The names of the methods with their marks.
pub fn legend(ui: &mut egui::Ui, diagram: &Diagram) {
    ui.horizontal_wrapped(|ui| {
        for (method, name) in diagram.methods.iter().enumerate() {
            let (place, _) = ui.allocate_exact_size(vec2(12.0, 14.0), Sense::hover());
            paint(ui.painter(), place.center(), (method, false), ui.visuals());
            ui.label(name);
            ui.add_space(6.0);
        }
    });
}

/// Colour of a method by its place.
fn color(method: usize, visuals: &egui::Visuals) -> Color32 {
    let [r, g, b] = match COLORS.get(method % MARKERS.len()) {
        Some(color) => *color,
        None => return visuals.text_color(),
    };
    Color32::from_rgb(r, g, b)
}

/// A mark of a method; a hollow one has no filling.
fn paint(painter: &Painter, at: Pos2, (method, hollow): (usize, bool), visuals: &egui::Visuals) {
    let color = color(method, visuals);
    let fill = if hollow { visuals.panel_fill } else { color };
    let stroke = Stroke::new(1.6, color);
    let closed = |points: &[[f32; 2]]| {
        let points = points.iter().map(|[x, y]| at + vec2(*x, *y)).collect();
        painter.add(Shape::convex_polygon(points, fill, stroke));
    };
    let lines = |ends: &[[f32; 2]]| {
        for [x, y] in ends {
            painter.line_segment([at - vec2(*x, *y), at + vec2(*x, *y)], stroke);
        }
    };
    match MARKERS[method % MARKERS.len()] {
        Marker::Circle => _ = painter.circle(at, 4.2, fill, stroke),
        Marker::Square => closed(&[[-3.8, -3.8], [3.8, -3.8], [3.8, 3.8], [-3.8, 3.8]]),
        Marker::Diamond => closed(&[[0.0, -5.0], [5.0, 0.0], [0.0, 5.0], [-5.0, 0.0]]),
        Marker::Up => closed(&[[0.0, -4.8], [4.6, 3.2], [-4.6, 3.2]]),
        Marker::Down => closed(&[[0.0, 4.8], [-4.6, -3.2], [4.6, -3.2]]),
        Marker::Cross => lines(&[[3.6, 3.6], [3.6, -3.6]]),
        Marker::Plus => lines(&[[4.6, 0.0], [0.0, 4.6]]),
        Marker::Star => lines(&[[4.6, 0.0], [2.3, 4.0], [2.3, -4.0]]),
    }
}
