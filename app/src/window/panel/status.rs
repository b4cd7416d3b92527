//! The status line: what the picture cost, how far it is, by what it was made.

use burnish_core::lighting::Cover;
use burnish_core::scene::Scene;
use eframe::egui::{self, Align, Layout, RichText};

use super::Context;
use crate::window::reference::{Look, percent};
use crate::window::session::Session;
use crate::window::stage::Status;

/// Jittered frames of a picture at rest.
const SHARP: u32 = 16;

/// The line.
#[derive(Default)]
pub struct StatusLine {}

impl StatusLine {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let status = context.stage.status();
        ui.horizontal(|ui| {
            let items = match context.reference.shown() {
                Some(look) if context.reference.is_on() => traced(look),
                Some(look) => [vec![refined(look)], traced(look)].concat(),
                None => status.map(picture).unwrap_or_default(),
            };
            let took = context.preparations.took().filter(|_| status.is_some_and(|status| !status.fixed_clock));
            let took = took.map(|took| (format!("prepared in {:.0} ms", took.as_secs_f64() * 1e3), PREPARED_HELP));
            for (text, hover) in items.into_iter().chain(took) {
                item_ui(ui, &text, hover);
            }
            item_ui(ui, &triangles(context.session.scene()), "Triangles of the visible objects.");
            let traced = context.reference.is_on() && context.reference.shown().is_some();
            let filled = match traced {
                true => "reference; all light: path traced".into(),
                false => filled_in(context.session),
            };
            item_ui(ui, &filled, FILLED_HELP);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let adapter = status.map_or("no adapter", |status| &status.adapter);
                let software = status.is_some_and(|status| status.software);
                let kind = if software { "Software rasterizer" } else { "Graphics adapter" };
                let label = egui::Label::new(RichText::new(adapter).small()).truncate();
                ui.add(label).on_hover_text(format!("{kind} that draws the picture: {adapter}"));
                let warnings = context.preparations.warnings().cloned();
                notices_ui(ui, &notices(context.session, status).into_iter().chain(warnings).collect::<Vec<_>>());
            });
        });
    }
}

const PREPARED_HELP: &str =
    "Time of what the method looks up: of the draft while something is dragged, of the whole when it rests.";

const FILLED_HELP: &str =
    "The lighting method, and by what each part of the light is computed. `nothing` is left black.";

fn item_ui(ui: &mut egui::Ui, text: &str, hover: &str) {
    ui.label(RichText::new(text).small()).on_hover_text(hover);
    ui.separator();
}

/// Cost and progress of the picture.
fn picture(status: &Status) -> Vec<(String, &'static str)> {
    let drawn = &status.drawn;
    if drawn.size.x == 0 {
        return vec![("no picture yet".into(), "Nothing was drawn so far.")];
    }
    let share = f64::from(drawn.size.x) / f64::from(status.size.x.max(1));
    let progress = match (drawn.settled, drawn.preparing) {
        (_, Some(share)) => format!("preparing light {:.0} %", 100.0 * share),
        (true, None) => "sharp".into(),
        (false, None) => format!("frame {} of {SHARP}", drawn.frames),
    };
    let mut items = vec![
        (format!("{:.0} ms", status.frame_ms), "Time of the last frame that showed a change, milliseconds."),
        (format!("{:.0} %", 100.0 * share), "Width of what was drawn as a part of the viewport's."),
        (progress, "Frames in the picture: it sharpens while nothing changes."),
    ];
    if status.fixed_clock {
        items.remove(0);
    }
    items
}

/// What is wrong with the reference, if anything is.
fn traced(look: &Look) -> Vec<(String, &'static str)> {
    let mut items = Vec::new();
    if look.clamped > 0.0 {
        let text = format!("clamp takes {} of the light", percent(look.clamped));
        items.push((text, "A clamped picture is no reference: set the clamp to 0 in the reference settings."));
    }
    if look.rejected > 0 {
        let text = format!("{} samples left out", look.rejected);
        items.push((text, "Samples that were not finite; they count as if they had not been drawn."));
    }
    items
}

/// How far a live picture of the processor is.
fn refined(look: &Look) -> (String, &'static str) {
    let text = if look.samples == 1 { "1 sample".into() } else { format!("{} samples", look.samples) };
    (text, "Samples of each pixel: the processor draws this picture and refines it while nothing changes.")
}

fn triangles(scene: &Scene) -> String {
    let visible = scene.instances.iter().filter(|instance| instance.visible);
    let count: usize = visible.filter_map(|i| scene.meshes.get(i.mesh)).map(|mesh| mesh.indices.len() / 3).sum();
    match count {
        0..10_000 => format!("{count} triangles"),
        10_000..10_000_000 => format!("{:.0}k triangles", count as f64 / 1e3),
        _ => format!("{:.1}M triangles", count as f64 / 1e6),
    }
}

/// What computes each part of the light.
fn filled_in(session: &Session) -> String {
    // Where the document names another, a notice says so.
    let info = session.document().lighting.live_method().info();
    let has_lamps = !session.scene().lights.is_empty();
    let terms = info.coverage.terms().into_iter().filter(|(term, ..)| *term != "emission");
    let words = terms.map(|(term, cover, filled_by)| match (term, cover) {
        ("lamps", _) if !has_lamps => "no lamps".into(),
        (_, Cover::None) => format!("{term}: {filled_by}"),
        _ => format!("{term}: {}", cover.word()),
    });
    let others = match session.layers().overridden() {
        0 => String::new(),
        1 => "; 1 object lit otherwise, drawn on the processor".into(),
        count => format!("; {count} objects lit otherwise, drawn on the processor"),
    };
    format!("{}; {}{others}", info.id, words.collect::<Vec<_>>().join("; "))
}

/// What the user should know about document and picture.
fn notices(session: &Session, status: Option<&Status>) -> Vec<String> {
    let resolved = session.resolved();
    let missing = resolved.missing.iter().map(|missing| format!("{}: {}", missing.path, missing.reason));
    let drawn = status.into_iter().flat_map(|status| status.drawn.notices.clone());
    missing.chain(resolved.notices.iter().cloned()).chain(drawn).collect()
}

fn notices_ui(ui: &mut egui::Ui, notices: &[String]) {
    let text = match notices.len() {
        0 => return,
        1 => "1 notice".to_string(),
        more => format!("{more} notices"),
    };
    ui.separator();
    ui.label(RichText::new(text).small().color(ui.visuals().warn_fg_color)).on_hover_text(notices.join("\n"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::document;
    use burnish_render::Drawn;
    use glam::UVec2;

    #[test]
    fn the_line_says_how_far_the_picture_is() {
        let mut status = Status { size: UVec2::new(800, 600), frame_ms: 41.6, ..Status::default() };
        assert_eq!(picture(&status)[0].0, "no picture yet");
        status.drawn = Drawn { size: UVec2::new(400, 300), frames: 1, ..Drawn::default() };
        let texts: Vec<String> = picture(&status).into_iter().map(|(text, _)| text).collect();
        assert_eq!(texts, ["42 ms", "50 %", "frame 1 of 16"]);
        status.drawn = Drawn { size: status.size, frames: 16, settled: true, ..Drawn::default() };
        assert_eq!(picture(&status)[2].0, "sharp");
    }

    #[test]
    fn what_is_missing_and_what_is_filled_in_is_told() {
        let session = Session::new(document::open("gallery:workbench").unwrap(), None);
        assert!(notices(&session, None).is_empty());
        assert!(
            filled_in(&session)
                .starts_with("classical; lamps: approximate; environment: approximate; indirect diffuse: nothing")
        );
        assert!(triangles(session.scene()).ends_with("triangles"));
        let gone = document::reload(document::Document::new("/nowhere/gone.glb".into()), &Default::default());
        assert_eq!(notices(&Session::new(gone, None), None).len(), 1);
    }
}
