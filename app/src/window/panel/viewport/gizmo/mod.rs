//! Handles in the picture that move, turn and scale what is selected.

mod drag;
mod sight;

use std::f32::consts::TAU;

use eframe::egui::{
    self, Color32, CursorIcon, Id, Pos2, Rect, Response, Role, Sense, Stroke, Vec2, WidgetInfo, pos2, vec2,
};
use glam::Vec3;

pub use drag::{Change, Mode};
pub use sight::Sight;

use super::overlay::SHADE;
use drag::{Drag, Handle};

/// Length of an axis and radius of a ring, points.
const REACH: f32 = 70.0;
/// Radius of the ring in the plane of the screen.
const OUTER: f32 = 86.0;
/// Edge of the squares that take hold of a handle.
const GRIP: f32 = 16.0;
/// Squares along an axis.
const ALONG: usize = 4;
/// Sides of a ring, and squares along it.
const AROUND: usize = 48;
/// Colours of the axes, to be told apart by everyone (Okabe and Ito), and of the middle.
const AXES: [Color32; 3] =
    [Color32::from_rgb(213, 94, 0), Color32::from_rgb(0, 158, 115), Color32::from_rgb(86, 180, 233)];
const MIDDLE: Color32 = Color32::from_gray(235);

/// The handles; they remember the drag that goes on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gizmo {
    drag: Option<Drag>,
}

/// What came of the handles in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moved {
    /// A drag began: what is changed is to be remembered.
    pub began: bool,
    /// What it did since.
    pub change: Option<Change>,
    /// It is over.
    pub ended: bool,
}

/// A handle as it is drawn: a line or ring through these points.
struct Shape {
    handle: Handle,
    points: Vec<Pos2>,
    grips: Vec<Pos2>,
    color: Color32,
}

impl Gizmo {
    /// Draws the handles at a place of the world and drags them; `of` names what they hold. Call it after the widget of the
    /// picture: the handles lie above it.
    pub fn ui(&mut self, ui: &mut egui::Ui, sight: &Sight, mode: Mode, at: Vec3, of: &str) -> Moved {
        let mut moved = Moved::default();
        let Some(shapes) = shapes(sight, mode, at) else {
            moved.ended = self.drag.take().is_some();
            return moved;
        };
        let held = self.drag.map(|drag| drag.handle);
        for shape in &shapes {
            let responses = grips_ui(ui, sight.rect, shape, mode, of);
            let hovered = responses.iter().any(Response::hovered);
            draw(ui, sight.rect, shape, mode, held == Some(shape.handle) || (held.is_none() && hovered));
            for response in responses {
                let started =
                    response.drag_started().then(|| response.ctx.input(|i| i.pointer.press_origin())).flatten();
                if let Some(from) = started {
                    let snaps = false;
                    self.drag = Some(Drag { mode, handle: shape.handle, origin: at, from, snaps });
                    moved.began = true;
                }
                if response.drag_stopped() {
                    moved.ended = true;
                }
                if let (Some(drag), Some(to)) = (self.drag, response.interact_pointer_pos())
                    && (response.dragged() || response.drag_stopped())
                {
                    let snaps = ui.input(|input| input.modifiers.command);
                    moved.change = Drag { snaps, ..drag }.to(sight, to);
                }
            }
        }
        if moved.ended {
            self.drag = None;
        }
        moved
    }
}

/// What stands around a place; `None` where it is not in the picture.
fn shapes(sight: &Sight, mode: Mode, at: Vec3) -> Option<Vec<Shape>> {
    let center = sight.project(at).filter(|center| sight.rect.contains(*center))?;
    let metres = sight.metres_per_point(at)?;
    let reach = REACH * metres;
    let mut shapes = Vec::new();
    for (axis, color) in AXES.into_iter().enumerate() {
        let handle = Handle::Axis(axis);
        let (points, grips) = match mode {
            Mode::Rotate => {
                let (u, v) = (Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]);
                let eye = sight.toward_eye(at);
                let ring: Vec<Vec3> = (0..=AROUND)
                    .map(|i| {
                        let (sin, cos) = (TAU * i as f32 / AROUND as f32).sin_cos();
                        reach * (cos * u + sin * v)
                    })
                    .collect();
                let points: Option<Vec<Pos2>> = ring.iter().map(|p| sight.project(at + *p)).collect();
                let points = points?;
                // Only the half before its middle is held.
                let near = ring.iter().zip(&points).take(AROUND).filter(|(p, _)| p.dot(eye) >= -1e-3 * reach);
                let grips = near.map(|(_, point)| *point).collect();
                (points, grips)
            }
            Mode::Move | Mode::Scale => {
                let tip = sight.project(at + reach * Vec3::AXES[axis])?;
                // One that is seen end on is not drawn.
                if (tip - center).length() < 0.15 * REACH {
                    continue;
                }
                let grips = (1..=ALONG).rev().map(|i| center + (tip - center) * (i as f32 / ALONG as f32)).collect();
                (vec![center + (tip - center) * 0.15, tip], grips)
            }
        };
        shapes.push(Shape { handle, points, grips, color });
    }
    // A turn in the plane of the screen has a ring around the others: in the middle a pointer has no direction.
    let points = match mode {
        Mode::Rotate => (0..=AROUND).map(|i| center + OUTER * Vec2::angled(TAU * i as f32 / AROUND as f32)).collect(),
        Mode::Move | Mode::Scale => vec![center],
    };
    let grips = points.iter().copied().take(AROUND).collect();
    shapes.push(Shape { handle: Handle::Center, points, grips, color: MIDDLE });
    Some(shapes)
}

/// The squares that take hold of a handle; the first has its name.
fn grips_ui(ui: &mut egui::Ui, rect: Rect, shape: &Shape, mode: Mode, of: &str) -> Vec<Response> {
    let id: Id = ui.scope_id().with(("gizmo", mode, shape.handle));
    let grips = shape.grips.iter().enumerate().map(|(place, at)| {
        let square = Rect::from_center_size(*at, Vec2::splat(GRIP)).intersect(rect);
        let response = ui.interact(square, id.with(place), Sense::drag());
        if place == 0 {
            let name = handle_name(mode, shape.handle, of);
            response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, &name));
        }
        response.on_hover_and_drag_cursor(CursorIcon::Move)
    });
    grips.collect()
}

fn handle_name(mode: Mode, handle: Handle, of: &str) -> String {
    let axis = |axis: usize| ["x", "y", "z"][axis.min(2)];
    match (mode, handle) {
        (Mode::Move, Handle::Axis(i)) => format!("Move {of} along {}", axis(i)),
        (Mode::Move, Handle::Center) => format!("Move {of}"),
        (Mode::Rotate, Handle::Axis(i)) => format!("Turn {of} about {}", axis(i)),
        (Mode::Rotate, Handle::Center) => format!("Turn {of}"),
        (Mode::Scale, Handle::Axis(i)) => format!("Scale {of} along {}", axis(i)),
        (Mode::Scale, Handle::Center) => format!("Scale {of}"),
    }
}

fn draw(ui: &egui::Ui, rect: Rect, shape: &Shape, mode: Mode, bright: bool) {
    let painter = ui.painter_at(rect);
    let color = if bright { Color32::WHITE } else { shape.color };
    let Some(&last) = shape.points.last() else { return };
    if shape.points.len() == 1 {
        painter.circle(last, 6.0, SHADE, Stroke::new(2.0, color));
        return;
    }
    // Dark below light: to be seen on any picture.
    painter.line(shape.points.clone(), Stroke::new(4.0, SHADE));
    painter.line(shape.points.clone(), Stroke::new(2.0, color));
    match mode {
        Mode::Rotate => {}
        Mode::Scale => _ = painter.rect_filled(Rect::from_center_size(last, vec2(10.0, 10.0)), 1.0, color),
        Mode::Move => {
            let along = (last - shape.points[0]).normalized();
            let across = along.rot90() * 5.0;
            let tip = last + along * 8.0;
            let points = vec![tip, pos2(last.x + across.x, last.y + across.y), last - across];
            painter.add(egui::Shape::convex_polygon(points, color, Stroke::NONE));
        }
    }
}
