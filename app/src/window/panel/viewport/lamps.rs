//! Marks of the lights in the picture: where they stand, how large they are, where they shine. A click selects one.

use burnish_core::document::{LightEntry, Shape};
use eframe::egui::{self, Color32, Pos2, Rect, Role, Sense, Stroke, Vec2, WidgetInfo};
use glam::Vec3;

use super::gizmo::Sight;
use super::overlay::SHADE;
use crate::window::lights;
use crate::window::session::Session;

/// Radius of a mark, points.
const MARK: f32 = 5.0;
/// Points that take hold of it.
const GRIP: f32 = 18.0;
/// Points between the edges of the picture and the arrow toward a light beyond it: at the left and above are buttons.
const BESIDE: Vec2 = Vec2::new(98.0, 46.0);
const EDGE: f32 = 16.0;
/// Size of the arrow.
const ARROW: f32 = 9.0;
/// Sides of a circle.
const AROUND: usize = 32;
/// Length of the line that shows where a light without a size shines, points.
const AIM: f32 = 46.0;

/// Shows the marks of all lights with a place, and of selected suns.
pub fn ui(ui: &mut egui::Ui, sight: &Sight, session: &mut Session) {
    let mut clicked = None;
    let free = Rect::from_min_max(sight.rect.min + BESIDE, sight.rect.max - Vec2::splat(EDGE));
    for (place, light) in lights::entries(session).iter().enumerate() {
        let chosen = session.selection.lights.contains(&light.name);
        if !light.shape.has_place() && !chosen {
            continue;
        }
        let color = mark_color(ui, light, chosen);
        if let Some((at, toward)) = sight.beyond(light.place(), free).filter(|_| chosen && light.shape.has_place()) {
            arrow_ui(ui, sight, at, toward, color, &light.name);
        }
        let Some(at) = sight.project(light.place()).filter(|at| sight.rect.contains(*at)) else { continue };
        let painter = ui.painter_at(sight.rect);
        let stroke = |width: f32, color: Color32| Stroke::new(width, color);
        for line in outline(sight, light) {
            painter.line(line.clone(), stroke(3.0, SHADE));
            painter.line(line, stroke(1.5, color));
        }
        painter.circle(at, MARK, if light.muted { SHADE } else { color }, stroke(1.5, SHADE));
        let id = ui.scope_id().with(("lamp", place));
        let grip = ui.interact(Rect::from_center_size(at, Vec2::splat(GRIP)), id, Sense::click());
        let name = &light.name;
        grip.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, format!("Mark of {name}")));
        let grip = grip.on_hover_text(format!("{name}, {}", light.shape.title().to_lowercase()));
        if grip.clicked() {
            clicked = Some((name.clone(), ui.input(|input| input.modifiers.shift)));
        }
    }
    if let Some((name, add)) = clicked {
        lights::select(session, &name, add);
    }
}

/// Shows where a selected light is that is not in the picture.
fn arrow_ui(ui: &egui::Ui, sight: &Sight, at: Pos2, toward: Vec2, color: Color32, name: &str) {
    let across = Vec2::new(-toward.y, toward.x);
    let corners = vec![at + ARROW * toward, at - 0.6 * ARROW * (toward - across), at - 0.6 * ARROW * (toward + across)];
    let painter = ui.painter_at(sight.rect);
    painter.add(egui::Shape::convex_polygon(corners, color, Stroke::new(1.5, SHADE)));
    let grip = ui.interact(
        Rect::from_center_size(at, Vec2::splat(GRIP)),
        ui.scope_id().with(("beyond", name)),
        Sense::hover(),
    );
    grip.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("{name} is out of the picture")));
    grip.on_hover_text(format!("{name} is out of the picture this way."));
}

fn mark_color(ui: &egui::Ui, light: &LightEntry, chosen: bool) -> Color32 {
    match (chosen, light.muted) {
        (true, _) => ui.visuals().selection.bg_fill.gamma_multiply(1.6),
        (false, true) => Color32::from_gray(120),
        (false, false) => Color32::from_rgb(240, 228, 66),
    }
}

/// Lines of its size and of where it shines, as far as they are before the camera.
fn outline(sight: &Sight, light: &LightEntry) -> Vec<Vec<Pos2>> {
    let (place, turn) = (light.place(), light.rotation());
    let (x, y, aim) = (turn * Vec3::X, turn * Vec3::Y, light.direction());
    let line = |points: &[Vec3]| points.iter().map(|point| sight.project(*point)).collect::<Option<Vec<Pos2>>>();
    let circle = |center: Vec3, u: Vec3, v: Vec3| -> Vec<Vec3> {
        let turn = |i: usize| (std::f32::consts::TAU * i as f32 / AROUND as f32).sin_cos();
        (0..=AROUND).map(turn).map(|(sin, cos)| center + cos * u + sin * v).collect()
    };
    let aim_length = AIM * sight.metres_per_point(place).unwrap_or(0.0);
    let arrow = line(&[place, place + aim_length * aim]);
    let lines = match light.shape {
        Shape::Point => vec![],
        Shape::Sun { .. } => vec![arrow],
        Shape::Spot { outer_deg, .. } => {
            let end = place + aim_length * aim;
            let radius = aim_length * outer_deg.clamp(0.0, 80.0).to_radians().tan() as f32;
            let rim = circle(end, radius * x, radius * y);
            let edges = [0, AROUND / 4, AROUND / 2, 3 * AROUND / 4].map(|i| line(&[place, rim[i]]));
            edges.into_iter().chain([line(&rim)]).collect()
        }
        Shape::Rectangle { width, height } => {
            let (u, v) = (0.5 * width as f32 * x, 0.5 * height as f32 * y);
            vec![line(&[place - u - v, place + u - v, place + u + v, place - u + v, place - u - v]), arrow]
        }
        Shape::Sphere { radius } => {
            let back = sight.toward_eye(place);
            let u = back.any_orthonormal_vector() * radius as f32;
            vec![line(&circle(place, u, back.cross(u)))]
        }
    };
    lines.into_iter().flatten().collect()
}
