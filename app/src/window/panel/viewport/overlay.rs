//! What is drawn over the picture: names and corners of the selected objects, numbers, messages.

use std::sync::Arc;

use burnish_core::scene::{Instance, Mesh};
use eframe::egui::{self, Align2, Color32, FontId, Pos2, Rect, Stroke, pos2, vec2};
use glam::{Affine3A, Vec3};

use super::gizmo::Sight;
use crate::window::session::Session;

/// Length of the marks at the corners of a selected object, points.
const MARK: f32 = 14.0;
/// Directions in which a mesh is measured, and the vertices that are looked at.
const HULL: usize = 96;
const THINNED: usize = 20_000;
/// Behind text over the picture.
pub const SHADE: Color32 = Color32::from_black_alpha(150);

/// Points of selected meshes, so that a frame does not visit all their vertices.
#[derive(Default)]
pub struct Outlines(Vec<(Arc<Mesh>, Vec<Vec3>)>);

impl Outlines {
    fn of(&mut self, mesh: &Arc<Mesh>) -> &[Vec3] {
        let known = self.0.iter().position(|(known, _)| Arc::ptr_eq(known, mesh));
        let place = known.unwrap_or_else(|| {
            self.0.push((mesh.clone(), hull(&mesh.positions)));
            self.0.len() - 1
        });
        self.0.get(place).map_or(&[], |(_, points)| points)
    }
}

/// The points that lie farthest in many directions: what they enclose is nearly the mesh.
fn hull(positions: &[Vec3]) -> Vec<Vec3> {
    let directions = (0..HULL).map(|i| {
        // A spiral with equal areas between its turns.
        let y = 1.0 - (2.0 * i as f32 + 1.0) / HULL as f32;
        let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
        let r = (1.0 - y * y).sqrt();
        Vec3::new(r * cos, y, r * sin)
    });
    // Large meshes are thinned out: the marks need no more.
    let step = (positions.len() / THINNED).max(1);
    let thinned: Vec<Vec3> = positions.iter().copied().step_by(step).collect();
    let farthest = |d: Vec3| thinned.iter().copied().max_by(|a, b| a.dot(d).total_cmp(&b.dot(d)));
    directions.filter_map(farthest).collect()
}

/// Selected objects with their place in the scene.
fn selected(session: &Session) -> Vec<&Instance> {
    let keys = session.resolved().object_keys.iter();
    let pairs = keys.zip(&session.scene().instances);
    pairs.filter(|(key, _)| session.selection.objects.contains(key)).map(|(_, instance)| instance).collect()
}

/// Marks the corners of the selected objects.
pub fn selection_ui(ui: &egui::Ui, sight: &Sight, session: &Session, outlines: &mut Outlines) {
    let scene = session.scene();
    let chosen = selected(session);
    if chosen.is_empty() {
        outlines.0.clear();
    }
    let painter = ui.painter_at(sight.rect);
    let color = ui.visuals().selection.bg_fill.gamma_multiply(1.6);
    for instance in chosen.into_iter().filter(|instance| instance.visible) {
        let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
        let Some(outline) = project_all(outlines.of(mesh), instance.world_from_local, sight) else { continue };
        for (corner, x, y) in [
            (outline.left_top(), 1.0, 1.0),
            (outline.right_top(), -1.0, 1.0),
            (outline.left_bottom(), 1.0, -1.0),
            (outline.right_bottom(), -1.0, -1.0),
        ] {
            let mark = vec2(MARK.min(0.4 * outline.width()) * x, MARK.min(0.4 * outline.height()) * y);
            for (stroke, end) in [(vec2(mark.x, 0.0), corner), (vec2(0.0, mark.y), corner)] {
                // Dark below light: to be seen on any picture.
                painter.line_segment([end, end + stroke], Stroke::new(4.0, SHADE));
                painter.line_segment([end, end + stroke], Stroke::new(2.0, color));
            }
        }
    }
}

/// The rectangle around points as the camera sees them; `None` where one is behind the camera.
fn project_all(points: &[Vec3], world_from_local: Affine3A, sight: &Sight) -> Option<Rect> {
    let mut outline = Rect::NOTHING;
    for point in points {
        outline.extend_with(sight.project(world_from_local.transform_point3(*point))?);
    }
    outline.is_positive().then(|| outline.expand(3.0))
}

/// What is selected, in words; empty without a selection.
pub fn selection_text(session: &Session) -> String {
    let chosen = selected(session);
    let [first, rest @ ..] = chosen.as_slice() else { return String::new() };
    let material = session.scene().materials.get(first.material).map_or("", |material| material.name.as_str());
    let name = if first.name.is_empty() { "unnamed" } else { &first.name };
    match rest.len() {
        0 => format!("{name}, material {material}"),
        more => format!("{name} and {more} more"),
    }
}

/// A line of text in a corner of the picture.
pub fn line_ui(ui: &mut egui::Ui, rect: Rect, corner: Align2, text: &str, hover: &str) {
    let font = FontId::proportional(12.5);
    let galley = ui.painter().layout_no_wrap(text.into(), font, Color32::from_gray(235));
    let size = galley.size() + vec2(12.0, 6.0);
    let place = corner.align_size_within_rect(size, rect.shrink(8.0));
    ui.painter().rect_filled(place, 4.0, SHADE);
    let label = egui::Label::new(egui::RichText::new(text).size(12.5).color(Color32::from_gray(235)));
    let response = ui.put(place, label.selectable(false).truncate());
    if !hover.is_empty() {
        response.on_hover_text(hover);
    }
}

/// A message in the middle of the picture.
pub fn message_ui(ui: &mut egui::Ui, rect: Rect, text: &str) {
    let width = (rect.width() - 40.0).clamp(40.0, 520.0);
    let font = FontId::proportional(15.0);
    let galley = ui.painter().layout(text.into(), font, Color32::from_gray(235), width);
    let place = Align2::CENTER_CENTER.align_size_within_rect(galley.size(), rect);
    ui.painter().rect_filled(place.expand(12.0), 6.0, Color32::from_black_alpha(200));
    let label = egui::Label::new(egui::RichText::new(text).size(15.0).color(Color32::from_gray(235)));
    ui.put(place.expand2(vec2(2.0, 0.0)), label.selectable(false).wrap());
}

/// Where a point of the window lies in the picture, 0 to 1 from its top left.
pub fn relative(rect: Rect, pointer: Pos2) -> glam::Vec2 {
    let size = rect.size().max(pos2(1.0, 1.0).to_vec2());
    let at = (pointer - rect.min) / size;
    glam::Vec2::new(at.x, at.y)
}

#[cfg(test)]
mod tests {
    use burnish_core::scene::{Camera, Projection};

    use super::*;

    #[test]
    fn a_point_is_seen_where_its_ray_goes_through_the_picture() {
        let rect = Rect::from_min_size(pos2(30.0, 50.0), vec2(600.0, 400.0));
        let mut perspective = Camera::look_at("c", Vec3::new(1.0, 2.0, 4.0), Vec3::ZERO, 0.7);
        let orthographic = Projection::Orthographic { ymag: 2.0, near: -10.0, far: 10.0 };
        for projection in [perspective.projection, orthographic] {
            perspective.projection = projection;
            for at in [glam::Vec2::new(0.5, 0.5), glam::Vec2::new(0.1, 0.8)] {
                let ray = perspective.ray(at, rect.width() / rect.height());
                let sight = Sight { camera: perspective.clone(), rect };
                let seen = sight.project(ray.origin + 3.0 * ray.direction).unwrap();
                assert!((relative(rect, seen) - at).length() < 1e-4, "{at} {seen:?}");
            }
        }
    }

    #[test]
    fn what_reaches_behind_the_camera_has_no_outline() {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(100.0, 100.0));
        let camera = Camera::look_at("c", Vec3::new(0.0, 0.0, 0.5), Vec3::ZERO, 0.7);
        let corners: Vec<Vec3> =
            [-1.0, 1.0].into_iter().flat_map(|z| [Vec3::new(-1.0, -1.0, z), Vec3::new(1.0, 1.0, z)]).collect();
        let sight = |camera: Camera| Sight { camera, rect };
        assert_eq!(project_all(&corners, Affine3A::IDENTITY, &sight(camera)), None);
        let far = Camera::look_at("c", Vec3::new(0.0, 0.0, 9.0), Vec3::ZERO, 0.7);
        let outline = project_all(&corners, Affine3A::IDENTITY, &sight(far.clone())).unwrap();
        assert!(outline.contains(rect.center()) && rect.contains_rect(outline));
        assert_eq!(project_all(&[], Affine3A::IDENTITY, &sight(far)), None);
    }

    #[test]
    fn the_hull_of_a_ball_is_nearly_as_wide_as_the_ball() {
        let ball: Vec<Vec3> = (0..5000)
            .map(|i| {
                let y = 1.0 - (2.0 * i as f32 + 1.0) / 5000.0;
                let (sin, cos) = (i as f32 * 2.4).sin_cos();
                Vec3::new((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin)
            })
            .collect();
        let points = hull(&ball);
        let width = |d: Vec3| points.iter().map(|p| p.dot(d)).fold(f32::MIN, f32::max);
        for direction in [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.0, 0.8)] {
            assert!(width(direction) > 0.97, "{direction} {}", width(direction));
        }
        assert!(hull(&[]).is_empty());
    }
}
