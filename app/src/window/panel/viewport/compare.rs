//! Two pictures in the viewport: wipe line, side by side, maps of where they differ.

use burnish_core::document::Side;
use burnish_core::measure::error_map::Metric;
use burnish_render::Frame;
use eframe::egui::{
    self, Align2, Color32, CursorIcon, Pos2, Rect, Response, Role, Sense, Stroke, TextureId, WidgetInfo, pos2, vec2,
};
use glam::{UVec2, Vec2, Vec3};

use super::overlay;
use crate::number::short;
use crate::window::compare::{Compare, CompareView, Legend, Pictures, SideScene, Source, value_at};
use crate::window::panel::Context;
use crate::window::preparations::{self, drawn_on_device};
use crate::window::reference::{Look, Subject};
use crate::window::stage::{Screen, Shown};

/// Physical pixels between two pictures side by side.
const GAP: f32 = 2.0;
/// Points to both sides of the line that take hold of it.
const GRIP: f32 = 6.0;

/// A side as it is drawn.
struct Drawn {
    texture: Option<TextureId>,
    /// Part of the texture that is the picture.
    part: Vec2,
    label: String,
}

/// Pixels of a picture in a viewport of so many.
pub fn size(view: Option<CompareView>, whole: UVec2) -> UVec2 {
    match view {
        Some(CompareView::SideBySide) => UVec2::new((whole.x.saturating_sub(GAP as u32) / 2).max(1), whole.y),
        _ => whole,
    }
}

/// Where the picture of a side is.
pub fn side_rect(view: Option<CompareView>, rect: Rect, side: Side, scale: f32) -> Rect {
    if view != Some(CompareView::SideBySide) {
        return rect;
    }
    let whole = UVec2::new((rect.width() * scale).round() as u32, (rect.height() * scale).round() as u32);
    let width = size(view, whole).x as f32 / scale;
    let left = if side == Side::A { rect.left() } else { rect.right() - width };
    Rect::from_min_size(pos2(left, rect.top()), vec2(width, rect.height()))
}

/// The side under a point of the window.
pub fn side_at(compare: &Compare, rect: Rect, point: Pos2) -> Side {
    let line = match compare.view() {
        Some(CompareView::Wipe) => rect.left() + compare.wipe * rect.width(),
        Some(CompareView::SideBySide) => rect.center().x,
        _ => f32::INFINITY,
    };
    if point.x < line { Side::A } else { Side::B }
}

/// Draws both sides, or the live picture and the reference, and what the view lays over them.
pub fn ui(ui: &mut egui::Ui, response: &Response, context: &mut Context<'_>, frame: &Frame) -> Shown {
    let Some(view) = context.compare.view() else { return Shown::default() };
    let rect = response.rect;
    if view == CompareView::Error {
        return error_ui(ui, rect, context, frame);
    }
    let scenes = Side::ALL.map(|side| {
        let scene = context.compare.sides.get(context.session, side);
        context.compare.light(side, &scene, context.stage.raster(), ui.ctx());
        scene
    });
    let turns = context.compare.turn(context.session);
    let [a, b] = Side::ALL.map(|side| {
        let scene = scenes[side as usize].clone();
        let own = Frame {
            settings: scene.document.lighting.settings(),
            lighting: preparations::lighting(&scene.layers, &context.compare.preparations[side as usize]),
            moving: frame.moving || !turns[side as usize],
            ..frame.clone()
        };
        let (shown, part) = side_picture(ui.ctx(), context, side, &scene, &own);
        if turns[side as usize] || shown.message.is_some() {
            context.compare.note(side, shown.settled);
        }
        let label = side_text(context, side, &scene);
        (shown.clone(), Drawn { texture: shown.texture, part, label })
    });
    let (shown_a, a) = a;
    let (shown_b, b) = b;
    let scale = ui.pixels_per_point();
    match view {
        CompareView::Wipe => wipe_ui(ui, rect, context, [&a, &b]),
        CompareView::SideBySide => {
            ui.painter().rect_filled(rect, 0.0, Color32::BLACK);
            for (side, drawn) in Side::ALL.into_iter().zip([&a, &b]) {
                let place = side_rect(Some(view), rect, side, scale);
                paint(ui, place, place, drawn);
                overlay::line_ui(ui, place, Align2::CENTER_BOTTOM, &drawn.label, "");
            }
        }
        CompareView::Difference | CompareView::Error => {
            paint(ui, rect, rect, &a);
            let pictures = difference_pictures(context, frame);
            map_ui(ui, rect, context, pictures);
        }
    }
    Shown {
        texture: shown_a.texture.or(shown_b.texture),
        settled: context.compare.is_settled() && !context.compare.maps.is_reading(),
        message: shown_a.message.or(shown_b.message),
        lost: shown_a.lost || shown_b.lost,
    }
}

/// The picture of a side, with the part of its texture that is the picture.
fn side_picture(
    ctx: &egui::Context,
    context: &mut Context<'_>,
    side: Side,
    scene: &SideScene,
    frame: &Frame,
) -> (Shown, Vec2) {
    let Context { session, stage, reference, compare, .. } = context;
    let screen = compare.screen(session, side);
    if !compare.is_traced(session, side) {
        return (stage.draw_on(screen, &scene.scene, frame), Vec2::ONE);
    }
    let mut subject = Subject::new(&scene.document, &scene.scene, &frame.camera, frame.size);
    if !session.document().compare.side(side).is_reference() {
        let preparations = &compare.preparations[side as usize];
        let Some(prepared) = preparations.prepared(&scene.layers) else {
            // Until all is prepared, classical light stands in.
            compare.stand_in(side, true);
            let preparations = &compare.preparations[side as usize];
            let message = preparations.fault().map(|fault| format!("Side {}: {fault}.", side.letter()));
            let shown = stage.draw_on(screen, &scene.scene, frame);
            return (Shown { message: shown.message.or(message), ..shown }, Vec2::ONE);
        };
        subject = subject.by_points(scene.layers.clone(), prepared);
    }
    compare.stand_in(side, false);
    let tracer = compare.tracer(reference, session, side);
    if let Some(secs) = tracer.rests_for() {
        ctx.request_repaint_after_secs(secs as f32);
    }
    if let Some(look) = tracer.look(subject, ctx) {
        let part = look.part();
        return (stage.show_on(screen, &look.picture, frame.display()), part);
    }
    let message = tracer.failure().map(|fault| format!("Side {} cannot be traced: {fault}.", side.letter()));
    (Shown { settled: true, message, ..Shown::default() }, Vec2::ONE)
}

/// What a side shows, in words.
fn side_text(context: &Context<'_>, side: Side, scene: &SideScene) -> String {
    let entry = context.session.document().compare.side(side);
    let state = context.session.document().snapshot_of(side).map_or("now", |snapshot| &snapshot.name);
    let state = if state == side.letter() { String::new() } else { format!(" {state},") };
    let timed = context.stage.status().is_some_and(|status| !status.fixed_clock);
    let method = match entry.is_reference() {
        true => context.compare.tracer_of(context.reference, context.session, side).text_of_look(timed),
        false if context.compare.is_traced(context.session, side) => scene.layers.first().method.info().title.into(),
        false => "live".into(),
    };
    let missing = if scene.missing > 0 { ", files are missing" } else { "" };
    format!("{}:{state} {method}{missing}", side.letter())
}

/// Paints a picture that fills `place`, of which `clip` is seen.
fn paint(ui: &egui::Ui, place: Rect, clip: Rect, drawn: &Drawn) {
    let painter = ui.painter_at(clip);
    match drawn.texture {
        Some(texture) => {
            let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(drawn.part.x, drawn.part.y));
            painter.image(texture, place, uv, Color32::WHITE);
        }
        None => _ = painter.rect_filled(place, 0.0, super::FLAT),
    }
}

fn wipe_ui(ui: &mut egui::Ui, rect: Rect, context: &mut Context<'_>, sides: [&Drawn; 2]) {
    let compare = &mut *context.compare;
    let x = |wipe: f32| rect.left() + wipe * rect.width();
    let grip = Rect::from_x_y_ranges(x(compare.wipe) - GRIP..=x(compare.wipe) + GRIP, rect.y_range());
    let handle = ui.interact(grip.intersect(rect), ui.scope_id().with("wipe"), Sense::drag());
    if let Some(pointer) = handle.interact_pointer_pos().filter(|_| handle.dragged()) {
        compare.wipe = ((pointer.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
    }
    // Whoever uses a keyboard or a screen reader sets it as a slider.
    let set = ui.input(|input| {
        let requests = input.accesskit_action_requests(handle.id, egui::accesskit::Action::SetValue);
        requests
            .filter_map(|request| match request.data {
                Some(egui::accesskit::ActionData::NumericValue(value)) => Some(value as f32),
                _ => None,
            })
            .last()
    });
    if let Some(value) = set {
        compare.wipe = value.clamp(0.0, 1.0);
    }
    let wipe = compare.wipe;
    handle.widget_info(|| WidgetInfo::slider(true, f64::from(wipe), "Wipe line"));
    let handle = handle.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    let line = x(wipe);
    let halves =
        [Rect::from_min_max(rect.min, pos2(line, rect.bottom())), Rect::from_min_max(pos2(line, rect.top()), rect.max)];
    for (half, drawn) in halves.into_iter().zip(sides) {
        paint(ui, rect, half, drawn);
    }
    let bright = handle.hovered() || handle.dragged();
    let color = if bright { Color32::WHITE } else { Color32::from_gray(225) };
    let painter = ui.painter_at(rect);
    painter.vline(line, rect.y_range(), Stroke::new(3.0, overlay::SHADE));
    painter.vline(line, rect.y_range(), Stroke::new(1.0, color));
    let knob = pos2(line, rect.center().y);
    painter.circle(knob, 9.0, overlay::SHADE, Stroke::new(1.5, color));
    for direction in [-1.0, 1.0] {
        let tip = knob + vec2(direction * 6.0, 0.0);
        let back = vec2(-direction * 3.0, 3.0);
        painter.line_segment([tip, tip + back], Stroke::new(1.5, color));
        painter.line_segment([tip, tip + vec2(back.x, -back.y)], Stroke::new(1.5, color));
    }
    for (half, (drawn, corner)) in
        halves.into_iter().zip(sides.into_iter().zip([Align2::RIGHT_BOTTOM, Align2::LEFT_BOTTOM]))
    {
        // A sliver has no room for words.
        if half.width() > 60.0 {
            overlay::line_ui(ui, half, corner, &drawn.label, "");
        }
    }
}

/// The pictures of both sides, once both are on the CPU.
fn difference_pictures(context: &mut Context<'_>, frame: &Frame) -> Option<Pictures> {
    let [a, b] = Side::ALL.map(|side| {
        let Context { session, stage, reference, compare, .. } = context;
        if compare.is_traced(session, side) {
            // What stands in for a side is not compared.
            let is_refined = compare.is_refined(session, side);
            return traced(compare.tracer_of(reference, session, side).latest().filter(|_| is_refined));
        }
        let settled = compare.is_side_settled(side);
        let screen = compare.screen(session, side);
        let picture = compare.maps.live(side, settled, || stage.read(screen, frame.size))?;
        Some(Source { picture, samples: None })
    });
    Some(Pictures { reference: a?, picture: b?, exposure_ev: frame.exposure_ev, metric: context.compare.metric })
}

fn traced(look: Option<&Look>) -> Option<Source> {
    let look = look.filter(|look| look.samples > 0)?;
    Some(Source { picture: look.picture.clone(), samples: Some(look.samples) })
}

/// The live picture with the map of its error against the reference.
fn error_ui(ui: &mut egui::Ui, rect: Rect, context: &mut Context<'_>, frame: &Frame) -> Shown {
    context.compare.turn(context.session);
    let Live { shown, part, picture } = live(ui.ctx(), context, frame);
    let Context { session, stage, reference, compare, .. } = context;
    compare.note(Side::B, shown.settled);
    let drawn = Drawn { texture: shown.texture, part, label: String::new() };
    paint(ui, rect, rect, &drawn);
    // On a processor that draws as well as traces the live picture goes first: without it there is no map.
    let waits = !shown.settled && stage.status().is_some_and(|status| status.software);
    let subject = Subject::new(session.document(), session.scene(), &frame.camera, frame.size);
    let truth = if waits { None } else { traced(reference.look(subject, ui.ctx())) };
    let failure = reference.failure().map(|fault| format!("The reference cannot be traced: {fault}."));
    if let Some(secs) = reference.rests_for() {
        ui.ctx().request_repaint_after_secs(secs as f32);
    }
    let pictures = truth.zip(picture).map(|(reference, picture)| Pictures {
        reference,
        picture,
        exposure_ev: frame.exposure_ev,
        metric: compare.metric,
    });
    let reading = compare.maps.is_reading();
    map_ui(ui, rect, context, pictures);
    Shown { settled: shown.settled && !reading, message: shown.message.or(failure), ..shown }
}

/// The live picture under a map.
struct Live {
    shown: Shown,
    /// Part of the texture that is the picture.
    part: Vec2,
    /// Its numbers, once they are on the processor.
    picture: Option<Source>,
}

/// Draws it: on the device, or where its methods draw.
fn live(ctx: &egui::Context, context: &mut Context<'_>, frame: &Frame) -> Live {
    let Context { session, stage, compare, preparations, .. } = context;
    let layers = session.layers();
    let prepared = if drawn_on_device(layers) { None } else { preparations.prepared(layers) };
    if let Some(prepared) = prepared {
        let subject = Subject::new(session.document(), session.scene(), &frame.camera, frame.size);
        let tracer = compare.second();
        let subject = subject.by_points(layers.clone(), prepared);
        if let Some(look) = tracer.look(subject, ctx) {
            let shown = stage.show_on(Screen::Main, &look.picture, frame.display());
            return Live { shown, part: look.part(), picture: traced(Some(look)) };
        }
        // Classical light stands in, and nothing is measured.
        let fault = tracer.failure().map(|fault| format!("The live picture cannot be drawn: {fault}."));
        let shown = stage.draw(session.scene(), &Frame { moving: true, ..frame.clone() });
        let settled = shown.texture.is_some() || shown.settled;
        let message = shown.message.clone().or(fault);
        return Live { shown: Shown { settled, message, ..shown }, part: Vec2::ONE, picture: None };
    }
    let shown = stage.draw(session.scene(), frame);
    let picture = compare.maps.live(Side::B, shown.settled, || stage.read(Screen::Main, frame.size));
    Live { shown, part: Vec2::ONE, picture: picture.map(|picture| Source { picture, samples: None }) }
}

/// The map, its legend, and the value under the pointer.
fn map_ui(ui: &mut egui::Ui, rect: Rect, context: &mut Context<'_>, pictures: Option<Pictures>) {
    let compare = &mut *context.compare;
    compare.maps.update(ui.ctx(), pictures);
    if let Some((map, texture)) = compare.maps.shown() {
        let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter_at(rect).image(texture.id(), rect, uv, Color32::WHITE);
        let pointer = ui.input(|input| input.pointer.hover_pos());
        if let Some(value) = pointer.and_then(|pointer| value_at(map, rect, pointer)) {
            let text = format!("{} {}", map.metric.title(), short(f64::from(value)));
            overlay::line_ui(ui, rect, Align2::LEFT_BOTTOM, &text, "The value under the pointer.");
        }
    }
    let legend = compare.maps.legend(compare.metric);
    let place =
        Align2::RIGHT_BOTTOM.align_size_within_rect(Legend::SIZE.min(rect.size() - vec2(16.0, 16.0)), rect.shrink(8.0));
    legend.ui(ui, place);
    let width = place.width() / Metric::ALL.len() as f32;
    for (index, metric) in Metric::ALL.into_iter().enumerate() {
        let at = pos2(place.left() + index as f32 * width, place.top() - 26.0);
        let button = Rect::from_min_size(at, vec2(width, 22.0));
        ui.painter().rect_filled(button, 0.0, Color32::from_black_alpha(190));
        let chosen = metric == compare.metric;
        ui.scope(|ui| {
            *ui.visuals_mut() = egui::Visuals::dark();
            ui.spacing_mut().button_padding.x = 1.0;
            let text = egui::RichText::new(metric.title()).size(11.0);
            let response = ui.put(button.shrink(1.0), egui::Button::selectable(chosen, text));
            let response = response.on_hover_text(metric.help());
            response.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, chosen, metric.title()));
            if response.clicked() && !chosen {
                compare.metric = metric;
                compare.maps.forget();
                ui.ctx().request_repaint();
            }
        });
    }
}

/// Radiance of the side under the pointer with a number for the picture that it is of; `at` is 0 to 1 from the side's top
/// left. Maps have their own number.
pub fn radiance(context: &mut Context<'_>, side: Side, at: Vec2) -> Option<Vec3> {
    let Context { session, stage, reference, compare, .. } = context;
    if compare.view().is_some_and(CompareView::has_map) {
        return None;
    }
    match compare.is_refined(session, side) {
        true => compare.tracer_of(reference, session, side).latest()?.radiance(at),
        false => stage.radiance(compare.screen(session, side), at),
    }
}

/// Another number for another picture of the side.
pub fn version(context: &Context<'_>, side: Side) -> u64 {
    if context.compare.view().is_some_and(CompareView::has_map) {
        return u64::MAX;
    }
    let traced = context.compare.is_refined(context.session, side);
    let look = context.compare.tracer_of(context.reference, context.session, side).latest().filter(|_| traced);
    let settled = u64::from(context.compare.is_side_settled(side));
    // One number for both sides: the pointer may cross the line.
    look.map_or(settled, Look::version) << 1 | side as u64
}
