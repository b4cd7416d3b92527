//! The environment as a small map, with handles for what was put into it.

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use burnish_core::color::tone::{ToneMap, exposure_factor, tone_map};
use burnish_core::document::{MadeEntry, SkyEntry, SoftBoxEntry};
use burnish_core::scene::Environment;
use eframe::egui::{
    self, Color32, ColorImage, Pos2, Rect, Role, Sense, Stroke, TextureHandle, Vec2, WidgetInfo, pos2, vec2,
};
use glam::Vec3;

use super::studio;
use crate::window::session::Session;

/// Pixels of the map.
const SIZE: [usize; 2] = [256, 128];
/// Points that take hold of a handle.
const GRIP: f32 = 18.0;
/// Points of the outline of a softbox.
const OUTLINE: usize = 48;

/// What the picture of the map was made of.
#[derive(Clone, PartialEq)]
struct Key {
    texels: usize,
    scale: [f32; 3],
    tone: ToneMap,
    exposure_ev: f32,
}

/// The map.
#[derive(Default)]
pub struct MapView {
    picture: Option<(Key, Arc<Environment>, TextureHandle)>,
}

impl MapView {
    /// Shows the environment that lights the scene; a drag of a handle moves a softbox or the sun.
    pub fn ui(&mut self, ui: &mut egui::Ui, session: &mut Session, chosen: &mut usize) {
        let Some(map) = session.scene().environment.clone() else { return };
        let width = ui.available_width().clamp(8.0, 420.0);
        let (rect, response) = ui.allocate_exact_size(vec2(width, 0.5 * width), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Map of the environment"));
        let view = &session.document().view;
        let (tone, exposure_ev) = (view.tone.parse().unwrap_or_default(), view.exposure_ev as f32);
        let texture = self.texture(ui.ctx(), &map, tone, exposure_ev);
        ui.painter().image(texture, rect, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
        response.on_hover_text(
            "The environment as someone in the middle sees it: the front (+z, where the camera mostly is) in the middle, \
             above at the top. It is not turned by the rotation.",
        );
        match session.document().environment.made.clone().filter(|_| session.document().environment.source.is_none()) {
            Some(MadeEntry::Studio(entry)) => {
                for (place, lamp) in entry.boxes.iter().enumerate() {
                    box_ui(ui, rect, session, (lamp, place), chosen);
                }
            }
            Some(MadeEntry::Sky(sky)) => sun_ui(ui, rect, session, &sky),
            _ => {}
        }
    }

    fn texture(
        &mut self,
        ctx: &egui::Context,
        map: &Arc<Environment>,
        tone: ToneMap,
        exposure_ev: f32,
    ) -> egui::TextureId {
        let key = Key { texels: map.texels.as_ptr() as usize, scale: map.scale().to_array(), tone, exposure_ev };
        if self.picture.as_ref().is_none_or(|(known, ..)| *known != key) {
            let image = image(map, tone, exposure_ev);
            let texture = ctx.load_texture("environment map", image, egui::TextureOptions::LINEAR);
            // The map is held, so that no other has its address.
            self.picture = Some((key, map.clone(), texture));
        }
        self.picture.as_ref().map_or(egui::TextureId::default(), |(.., texture)| texture.id())
    }
}

/// The map as the screen shows it; each pixel a mean of four points.
fn image(map: &Environment, tone: ToneMap, exposure_ev: f32) -> ColorImage {
    let factor = exposure_factor(exposure_ev);
    let pixel = |i: usize| {
        let (x, y) = ((i % SIZE[0]) as f32, (i / SIZE[0]) as f32);
        let at = |dx: f32, dy: f32| {
            let u = (x + dx) / SIZE[0] as f32 + 0.5;
            map.radiance_at(glam::Vec2::new(u - u.floor(), (y + dy) / SIZE[1] as f32))
        };
        let mean = 0.25 * (at(0.25, 0.25) + at(0.75, 0.25) + at(0.25, 0.75) + at(0.75, 0.75));
        let [r, g, b] = tone_map(tone, factor * mean).to_array().map(|v| (255.0 * v).round() as u8);
        Color32::from_rgb(r, g, b)
    };
    ColorImage::new(SIZE, (0..SIZE[0] * SIZE[1]).map(pixel).collect())
}

/// Where a direction, in the map's own frame, is in the rectangle.
fn place_of(rect: Rect, d: Vec3) -> Pos2 {
    let azimuth = d.x.atan2(d.z);
    let share = vec2(0.5 - azimuth / TAU, d.y.clamp(-1.0, 1.0).acos() / PI);
    rect.min + share * rect.size()
}

/// Where an azimuth and an elevation are, degrees; straight above, too, at its azimuth.
fn place_at(rect: Rect, azimuth_deg: f64, elevation_deg: f64) -> Pos2 {
    let turns = (0.5 - azimuth_deg / 360.0).rem_euclid(1.0);
    rect.min + vec2(turns as f32, (0.5 - elevation_deg / 180.0) as f32) * rect.size()
}

/// Azimuth and elevation at a point of the rectangle, degrees to a tenth.
fn angles_of(rect: Rect, at: Pos2) -> [f64; 2] {
    let share = (at - rect.min) / rect.size();
    let tidy = |v: f32| f64::from((10.0 * v).round() / 10.0);
    [tidy((0.5 - share.x.clamp(0.0, 1.0)) * 360.0), tidy((0.5 - share.y.clamp(0.0, 1.0)) * 180.0)]
}

fn box_ui(ui: &egui::Ui, rect: Rect, session: &mut Session, (lamp, place): (&SoftBoxEntry, usize), chosen: &mut usize) {
    let shape = lamp.shape();
    let at = place_at(rect, lamp.azimuth_deg, lamp.elevation_deg);
    let ink = if place == *chosen { ui.visuals().selection.bg_fill.gamma_multiply(1.6) } else { Color32::GRAY };
    let painter = ui.painter_at(rect);
    let outline: Vec<Pos2> = shape.outline(OUTLINE).into_iter().map(|d| place_of(rect, d)).collect();
    for (i, from) in outline.iter().enumerate() {
        let to = outline[(i + 1) % outline.len()];
        // Not across the map, where it ends at both sides.
        if (to.x - from.x).abs() < 0.5 * rect.width() {
            painter.line_segment([*from, to], Stroke::new(1.5, ink));
        }
    }
    let name = studio::title(lamp, place);
    let grip = handle_ui(ui, rect, (at, ink), place, &format!("Handle of softbox {name}"));
    if grip.clicked() || grip.drag_started() {
        *chosen = place;
    }
    let moved = grip.interact_pointer_pos().filter(|_| grip.dragged() && grip.drag_delta() != Vec2::ZERO);
    if let Some(pointer) = moved {
        let [azimuth, elevation] = angles_of(rect, pointer);
        studio::edit(session, "Move softbox", |studio| {
            if let Some(lamp) = studio.boxes.get_mut(place) {
                (lamp.azimuth_deg, lamp.elevation_deg) = (azimuth, elevation);
            }
        });
    }
    if grip.drag_stopped() {
        session.seal();
    }
}

fn sun_ui(ui: &egui::Ui, rect: Rect, session: &mut Session, sky: &SkyEntry) {
    let at = place_at(rect, sky.azimuth_deg, sky.elevation_deg);
    let ink = Color32::from_rgb(240, 228, 66);
    let grip = handle_ui(ui, rect, (at, ink), 0, "Handle of the sun");
    let moved = grip.interact_pointer_pos().filter(|_| grip.dragged() && grip.drag_delta() != Vec2::ZERO);
    if let Some(pointer) = moved {
        let [azimuth, elevation] = angles_of(rect, pointer);
        session.edit("Move sun", "", |document| {
            if let Some(MadeEntry::Sky(sky)) = &mut document.environment.made {
                (sky.azimuth_deg, sky.elevation_deg) = (azimuth, elevation.clamp(0.0, 90.0));
            }
        });
    }
    if grip.drag_stopped() {
        session.seal();
    }
}

/// A dot that is dragged; `number` tells it from others.
fn handle_ui(ui: &egui::Ui, rect: Rect, (at, ink): (Pos2, Color32), number: usize, name: &str) -> egui::Response {
    ui.painter_at(rect).circle(at, 4.0, ink, Stroke::new(1.5, Color32::from_black_alpha(160)));
    let place = Rect::from_center_size(at, Vec2::splat(GRIP)).intersect(rect);
    let grip = ui.interact(place, ui.scope_id().with(("handle", number)), Sense::click_and_drag());
    grip.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    grip.on_hover_and_drag_cursor(egui::CursorIcon::Move)
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::scene::environment::direction;

    const RECT: Rect = Rect { min: pos2(10.0, 20.0), max: pos2(410.0, 220.0) };

    #[test]
    fn a_handle_lies_where_the_map_shows_its_direction() {
        // One bright texel, found again in the picture of the map.
        for (x, y) in [(3, 4), (20, 9), (31, 2)] {
            let mut texels = vec![Vec3::ZERO; 32 * 16];
            texels[y * 32 + x] = Vec3::ONE;
            let map = Environment::new("dot", 32, 16, texels);
            let d = map.texel_direction(x as u32, y as u32, glam::Vec2::splat(0.5));
            let image = image(&map, ToneMap::None, 0.0);
            let brightest = (0..image.pixels.len()).max_by_key(|i| image.pixels[*i].r()).unwrap();
            let share = vec2((brightest % SIZE[0]) as f32 + 0.5, (brightest / SIZE[0]) as f32 + 0.5)
                / vec2(SIZE[0] as f32, SIZE[1] as f32);
            let seen = RECT.min + share * RECT.size();
            assert!((place_of(RECT, d) - seen).length() < 8.0, "{:?} {seen:?}", place_of(RECT, d));
        }
    }

    #[test]
    fn angles_and_places_are_inverse_to_each_other() {
        for (azimuth, elevation) in [(0.0, 0.0), (-45.0, 35.0), (120.0, -60.0)] {
            let d = direction(f32::to_radians(azimuth), f32::to_radians(elevation));
            let at = place_at(RECT, azimuth.into(), elevation.into());
            assert!((at - place_of(RECT, d)).length() < 1e-2);
            let [a, e] = angles_of(RECT, place_of(RECT, d));
            assert!((a - f64::from(azimuth)).abs() < 0.11 && (e - f64::from(elevation)).abs() < 0.11, "{a} {e}");
        }
    }
}
