//! Marks of probes in the picture: where they stand, in which box they serve, what they take the surroundings to be.

use burnish_core::lighting::Prepared;
use burnish_core::lighting::probe::{Probe, Probes, Site};
use eframe::egui::{self, Color32, Pos2, Stroke};
use glam::Vec3;

use super::gizmo::Sight;
use super::overlay::SHADE;
use crate::window::aids::ProbeMarks;
use crate::window::session::Session;

/// Points across a mark.
const MARK: f32 = 9.0;
const COLOR: Color32 = Color32::from_rgb(86, 180, 233);
const CHOSEN: Color32 = Color32::from_rgb(230, 159, 0);
/// Points of a probe's surroundings.
const DOTS: usize = 3000;
/// Half a box that is drawn; a larger one serves everywhere.
const EVERYWHERE: f32 = 1e8;

/// Shows the marks that are on.
pub fn ui(ui: &egui::Ui, sight: &Sight, session: &Session, marks: &ProbeMarks, prepared: Option<&Prepared>) {
    let method = session.document().lighting.live_method();
    if !(marks.places || marks.distances) || !method.info().reads.probes {
        return;
    }
    let sites = session.probe_sites();
    let chosen = sites.iter().position(|site| site.name == marks.chosen).unwrap_or(0);
    let painter = ui.painter_at(sight.rect);
    if let Some(probe) = prepared.filter(|_| marks.distances).and_then(|prepared| Probes::of(prepared).get(chosen)) {
        distances_ui(&painter, sight, &probe);
    }
    if marks.places {
        for (place, site) in sites.iter().enumerate() {
            site_ui(&painter, sight, site, place == chosen);
        }
    }
}

fn site_ui(painter: &egui::Painter, sight: &Sight, site: &Site, chosen: bool) {
    let color = if chosen { CHOSEN } else { COLOR };
    if let Some(at) = sight.project(site.middle) {
        // A cross in a circle: it stands in the middle of an object, and is seen through it.
        for stroke in [Stroke::new(4.0, SHADE), Stroke::new(1.5, color)] {
            painter.circle_stroke(at, MARK, stroke);
            painter.line_segment([at - egui::vec2(MARK, 0.0), at + egui::vec2(MARK, 0.0)], stroke);
            painter.line_segment([at - egui::vec2(0.0, MARK), at + egui::vec2(0.0, MARK)], stroke);
        }
    }
    if !chosen || site.half.max_element() > EVERYWHERE {
        return;
    }
    let corner = |bits: usize| {
        let sign = |axis: usize| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 };
        sight.project(site.middle + site.half * Vec3::new(sign(0), sign(1), sign(2)))
    };
    let edges = (0..8).flat_map(|from| (0..3).map(move |axis| (from, from | 1 << axis))).filter(|(a, b)| a != b);
    for (a, b) in edges {
        if let (Some(a), Some(b)) = (corner(a), corner(b)) {
            painter.line_segment([a, b], Stroke::new(1.0, color));
        }
    }
}

/// Points on the surfaces, near ones larger.
fn distances_ui(painter: &egui::Painter, sight: &Sight, probe: &Probe<'_>) {
    let mut dots: Vec<(Pos2, f32)> = Vec::with_capacity(DOTS);
    for i in 0..DOTS {
        let y = 1.0 - (2 * i + 1) as f32 / DOTS as f32;
        let (sin, cos) = (2.399_963 * i as f32).sin_cos();
        let level = (1.0 - y * y).sqrt();
        let direction = Vec3::new(level * cos, y, level * sin);
        let distance = probe.distances.distance(direction);
        let place = sight.project(probe.middle + distance * direction).filter(|_| distance > 0.0);
        dots.extend(place.filter(|place| sight.rect.contains(*place)).map(|place| (place, distance)));
    }
    for (place, distance) in dots {
        let radius = (1.5 * probe.extent.near / distance.max(1e-6)).clamp(0.8, 2.0);
        painter.circle_filled(place, radius, CHOSEN);
    }
}
