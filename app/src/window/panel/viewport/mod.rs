//! The picture, and how the mouse moves it.

mod cameras;
mod compare;
mod gizmo;
mod lamps;
mod legend;
mod navigation;
mod overlay;
mod probes;
mod readout;
mod switch;
mod tools;

use burnish_core::color::tone::ToneMap;
use burnish_core::document::Side;
use burnish_core::scene::Picked;
use burnish_render::Frame;
use eframe::egui::emath::GuiRounding;
use eframe::egui::{
    self, Align2, Color32, Event, Modifiers, PointerButton, Rect, Response, Role, Sense, WidgetInfo, pos2,
};
use glam::UVec2;

use super::{Context, DraggedPreset};
use crate::window::commands::Command;
use crate::window::compare::CompareView;
use crate::window::preparations::{self, drawn_on_device, shows_sources};
use crate::window::reference::{Look, Subject};
use crate::window::request::Request;
use crate::window::session::Session;
use crate::window::stage::{Screen, Shown};
use gizmo::Sight;
use navigation::{BUTTONS, Feel, Gesture, Wheel};
use tools::Tools;

pub use navigation::summary;
pub use tools::Tool;

/// Seconds after a change during which another is expected: only quick frames are drawn.
const MOVING_SECS: f64 = 0.15;
/// Grey of a picture that is not there; a middle one, so that tests see text over it.
const FLAT: Color32 = Color32::from_gray(128);
/// What the numbers under the pointer are.
const READOUT_HELP: &str = "Scene-linear Rec.709 radiance under the pointer before exposure, and its luminance: in nit \
                            where lights are given in candela and lux, else in the units of the HDRI.";

/// The viewport.
pub struct ViewportPanel {
    gesture: Option<Gesture>,
    /// What the left button does.
    pub tools: Tools,
    /// Keys that were held when a button went down: they say what it does, also when they are let go first.
    held: Modifiers,
    /// Revision of the document that was drawn last, and when it changed.
    revision: u64,
    changed_secs: f64,
    /// Width by height.
    aspect: f32,
    readout: readout::Readout,
    outlines: overlay::Outlines,
    /// What the user was told, so that it is told once.
    told: Option<String>,
}

impl Default for ViewportPanel {
    fn default() -> Self {
        ViewportPanel {
            gesture: None,
            tools: Tools::default(),
            held: Modifiers::NONE,
            revision: 0,
            changed_secs: f64::NEG_INFINITY,
            aspect: 1.5,
            readout: Default::default(),
            outlines: Default::default(),
            told: None,
        }
    }
}

impl ViewportPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let scale = ui.pixels_per_point();
        let rect = ui.available_rect_before_wrap().round_to_pixels(scale);
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        let text = summary_text(context.session);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &text));
        let size = (rect.size() * scale).round();
        if size.x < 1.0 || size.y < 1.0 {
            return;
        }
        let half = context.compare.view() == Some(CompareView::SideBySide);
        self.aspect = if half { 0.5 } else { 1.0 } * size.x / size.y;
        if let Some(held) = ui.input(|input| input.events.iter().rev().find_map(pressed_with)) {
            self.held = held;
        }
        self.drag(&response, context);
        if response.contains_pointer() {
            wheel(Wheel::read(&ui.input(|input| input.events.clone())), context);
        }

        let moving = self.is_moving(context.session);
        let view = context.compare.view();
        let whole = UVec2::new(size.x as u32, size.y as u32);
        let mut frame = frame_of(context.session, compare::size(view, whole), moving);
        frame.mode = context.aids.mode;
        frame.lighting = preparations::lighting(context.session.layers(), context.preparations);
        if view.is_none() {
            frame.contribution = context.aids.contribution(context.session.scene());
        }
        self.click(&response, context, &frame);
        self.drop_preset(&response, context, &frame);
        // A click or a drop may have changed the scene: this frame shows it already.
        let shown = match view {
            Some(_) => {
                // The tracer draws a side or the reference.
                context.reference.draw_live(false);
                compare::ui(ui, &response, context, &frame)
            }
            None => single_ui(ui, rect, context, &frame),
        };
        self.overlay_ui(ui, &response, context, &frame, &shown);
        self.tell(&shown, context);
        if let Some(secs) = context.reference.rests_for().filter(|_| context.reference.is_on()) {
            ui.ctx().request_repaint_after_secs(secs as f32);
        }
        if moving {
            ui.ctx().request_repaint_after_secs(MOVING_SECS as f32);
        } else if !shown.settled {
            ui.ctx().request_repaint();
        }
    }

    /// Moves the camera.
    pub fn command(&mut self, command: Command, session: &mut Session) {
        cameras::command(command, session, self.aspect);
    }

    /// True while a hand moves something: the document changed just now.
    fn is_moving(&mut self, session: &Session) -> bool {
        if self.revision != session.revision {
            // The first picture of a document is no movement.
            let opened = session.revision == 0;
            self.revision = session.revision;
            self.changed_secs = if opened { f64::NEG_INFINITY } else { session.now_secs };
        }
        (0.0..MOVING_SECS).contains(&(session.now_secs - self.changed_secs))
    }

    fn drag(&mut self, response: &Response, context: &mut Context<'_>) {
        for button in BUTTONS {
            if response.drag_started_by(button) {
                let places = button == PointerButton::Primary && self.tools.tool.places_light();
                self.gesture = match places {
                    true => Some(Gesture::PlaceLight),
                    false => navigation::gesture(context.preferences.navigation, button, self.held),
                };
            }
        }
        let feel = Feel::new(context.preferences);
        let by = response.drag_delta();
        match self.gesture {
            Some(_) if by == egui::Vec2::ZERO => {}
            Some(Gesture::PlaceLight) => {
                if let Some(pointer) = response.interact_pointer_pos() {
                    self.place_light(response, context, pointer, by);
                }
            }
            Some(Gesture::TurnLight) => context.session.edit("Rotate environment", "", |document| {
                let turned = navigation::turned(document.environment.rotation_deg, by.x, feel);
                document.environment.rotation_deg = turned;
            }),
            Some(gesture) => cameras::move_camera(context.session, |camera| {
                navigation::drag_camera(camera, gesture, by, response.rect.height(), feel);
            }),
            None => {}
        }
        let ended = if response.drag_stopped() { self.gesture.take() } else { None };
        if matches!(ended, Some(Gesture::TurnLight | Gesture::PlaceLight)) {
            context.session.seal();
        }
    }

    /// Puts the selected light where its effect is wanted.
    fn place_light(&mut self, response: &Response, context: &mut Context<'_>, pointer: egui::Pos2, by: egui::Vec2) {
        let rect = picture_rect(response, context, pointer);
        let sight = Sight { camera: context.session.document().view.camera.camera(), rect };
        if let Err(obstacle) = self.tools.place_light(context.session, &sight, pointer, by) {
            context.requests.push(Request::Notice(obstacle.into()));
            self.gesture = None;
        }
    }

    /// Selects what was clicked; a double click brings it into view.
    fn click(&mut self, response: &Response, context: &mut Context<'_>, frame: &Frame) {
        if !response.clicked() {
            return;
        }
        let Some(pointer) = response.interact_pointer_pos() else { return };
        if self.tools.tool.places_light() {
            self.place_light(response, context, pointer, egui::Vec2::ZERO);
            return context.session.seal();
        }
        let at = overlay::relative(picture_rect(response, context, pointer), pointer);
        let picked = pick(context, frame, at);
        select(context.session, picked, self.held.shift);
        if response.double_clicked() && picked.is_some() {
            self.command(Command::Frame, context.session);
        }
    }

    /// Puts a dropped metal on the material under the pointer.
    fn drop_preset(&mut self, response: &Response, context: &mut Context<'_>, frame: &Frame) {
        let Some(dropped) = response.dnd_release_payload::<DraggedPreset>() else { return };
        let Some(pointer) = response.ctx.pointer_latest_pos() else { return };
        let at = overlay::relative(picture_rect(response, context, pointer), pointer);
        let picked = pick(context, frame, at);
        let Some(material) = picked.and_then(|picked| material_of(context.session, picked)) else {
            context.requests.push(Request::Notice("There is no object there: drop the preset on one.".into()));
            return;
        };
        context.requests.push(Request::AssignPreset { preset: dropped.0.clone(), materials: vec![material] });
        select(context.session, picked, false);
    }

    fn overlay_ui(
        &mut self,
        ui: &mut egui::Ui,
        response: &Response,
        context: &mut Context<'_>,
        frame: &Frame,
        shown: &Shown,
    ) {
        let rect = response.rect;
        let view = context.compare.view();
        for side in Side::ALL.into_iter().take(if view == Some(CompareView::SideBySide) { 2 } else { 1 }) {
            let place = compare::side_rect(view, rect, side, ui.pixels_per_point());
            let sight = Sight { camera: frame.camera.clone(), rect: place };
            overlay::selection_ui(ui, &sight, context.session, &mut self.outlines);
        }
        // Before what comes and goes: ids count the widgets before them, and a button whose id changes between press and
        // release hears no click.
        switch::ui(ui, rect, context);
        let below = switch::tools_ui(ui, rect, self.tools.tool, context.requests);
        let selected = overlay::selection_text(context.session);
        if !selected.is_empty() {
            overlay::line_ui(ui, rect.with_min_y(below - 4.0), Align2::LEFT_TOP, &selected, "");
        }
        if view != Some(CompareView::SideBySide) {
            self.tools.ui(ui, &Sight { camera: frame.camera.clone(), rect }, context);
        }
        let pointer = response.hover_pos().filter(|_| shown.texture.is_some() && self.gesture.is_none());
        match pointer {
            Some(pointer) if !frame.moving => {
                let at = overlay::relative(picture_rect(response, context, pointer), pointer);
                let picture = (context.session.revision, version(context, rect, pointer, shown));
                let now_secs = context.session.now_secs;
                match self.readout.update(pointer, picture, now_secs, || radiance(context, rect, pointer, at)) {
                    Ok(Some(radiance)) => {
                        let text = readout::text(radiance);
                        // Names of the sides stand at the bottom.
                        let above = if view.is_some() { 30.0 } else { 0.0 };
                        let place = rect.with_max_y(rect.bottom() - above);
                        overlay::line_ui(ui, place, Align2::LEFT_BOTTOM, &text, READOUT_HELP);
                    }
                    Ok(None) => {}
                    Err(secs) => ui.ctx().request_repaint_after_secs(secs as f32),
                }
            }
            _ => self.readout.clear(),
        }
        let honoured = view.is_none() && (context.reference.is_on() || shows_sources(context.session.layers()));
        if view.is_none_or(CompareView::has_sides) {
            legend::ui(ui, rect, context.aids, honoured);
        }
        if let Some(message) = &shown.message {
            overlay::message_ui(ui, rect, message);
        }
    }

    /// Says a fault once, not in every frame.
    fn tell(&mut self, shown: &Shown, context: &mut Context<'_>) {
        if shown.lost {
            context.requests.push(Request::WriteRecovery);
        }
        if self.told != shown.message {
            if let Some(message) = &shown.message {
                context.requests.push(Request::Error(message.clone()));
            }
            self.told.clone_from(&shown.message);
        }
    }
}

/// One picture that fills the viewport.
fn single_ui(ui: &egui::Ui, rect: Rect, context: &mut Context<'_>, frame: &Frame) -> Shown {
    let (shown, part) = picture(ui.ctx(), context, frame);
    match shown.texture {
        Some(texture) => {
            let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(part.x, part.y));
            ui.painter().image(texture, rect, uv, Color32::WHITE);
        }
        None => _ = ui.painter().rect_filled(rect, 0.0, FLAT),
    }
    shown
}

/// Where the picture under a point of the window is: one of two side by side.
fn picture_rect(response: &Response, context: &Context<'_>, point: egui::Pos2) -> Rect {
    let side = compare::side_at(context.compare, response.rect, point);
    compare::side_rect(context.compare.view(), response.rect, side, response.ctx.pixels_per_point())
}

/// Radiance under a point of the picture.
fn radiance(context: &mut Context<'_>, rect: Rect, point: egui::Pos2, at: glam::Vec2) -> Option<glam::Vec3> {
    if context.compare.view().is_some() {
        let side = compare::side_at(context.compare, rect, point);
        return compare::radiance(context, side, at);
    }
    match context.reference.shown() {
        Some(look) => look.radiance(at),
        None => context.stage.radiance(Screen::Main, at),
    }
}

/// Another number for another picture of the same document.
fn version(context: &Context<'_>, rect: Rect, point: egui::Pos2, shown: &Shown) -> u64 {
    match context.compare.view() {
        Some(_) => compare::version(context, compare::side_at(context.compare, rect, point)),
        None => context.reference.shown().map_or(u64::from(shown.settled), Look::version),
    }
}

/// The reference where there is something of it and it is wanted, else the live picture; with the part of the texture
/// that is the picture.
fn picture(ctx: &egui::Context, context: &mut Context<'_>, frame: &Frame) -> (Shown, glam::Vec2) {
    let Context { session, stage, reference, preparations, .. } = context;
    let scene = session.scene();
    let mut subject = Subject::new(session.document(), scene, &frame.camera, frame.size).showing(frame.contribution);
    let layers = session.layers();
    let on_device = drawn_on_device(layers);
    reference.draw_live(!reference.is_on() && !on_device);
    if !reference.is_on() {
        // Until all is prepared, classical light stands in.
        let prepared = if on_device { None } else { preparations.prepared(layers) };
        let Some(prepared) = prepared else { return (stage.draw(scene, frame), glam::Vec2::ONE) };
        subject = subject.by_points(layers.clone(), prepared);
    }
    if let Some(look) = reference.look(subject, ctx) {
        return (stage.show(&look.picture, frame.display()), look.part());
    }
    if let Some(fault) = reference.fault() {
        let shown = stage.draw(scene, frame);
        return (Shown { message: shown.message.or(Some(fault)), ..shown }, glam::Vec2::ONE);
    }
    // Quick frames only: whoever traces needs the processor, and wakes the window.
    let shown = stage.draw(scene, &Frame { moving: true, ..frame.clone() });
    (Shown { settled: shown.texture.is_some() || shown.settled, ..shown }, glam::Vec2::ONE)
}

/// The surface under a point of the picture. The live picture may be an older one while the reference is shown.
fn pick(context: &mut Context<'_>, frame: &Frame, at: glam::Vec2) -> Option<Picked> {
    let scene = context.session.scene();
    match context.reference.is_on() || context.compare.view().is_some() {
        true => scene.pick(frame.camera.ray(at, frame.size.x as f32 / frame.size.y.max(1) as f32)),
        false => context.stage.pick(scene, frame, at),
    }
}

/// Keys that are held while a button goes down.
fn pressed_with(event: &Event) -> Option<Modifiers> {
    match event {
        Event::PointerButton { pressed: true, modifiers, .. } => Some(*modifiers),
        _ => None,
    }
}

/// What the picture is of, for those who do not see it.
fn summary_text(session: &Session) -> String {
    let shown = session.scene().instances.iter().filter(|instance| instance.visible).count();
    format!("Viewport: {}, {shown} {}", session.title(), if shown == 1 { "object" } else { "objects" })
}

/// What to draw.
fn frame_of(session: &Session, size: UVec2, moving: bool) -> Frame {
    let document = session.document();
    Frame {
        size,
        camera: document.view.camera.camera(),
        settings: document.lighting.settings(),
        lighting: Default::default(),
        tone: document.view.tone.parse::<ToneMap>().unwrap_or_default(),
        exposure_ev: document.view.exposure_ev as f32,
        mode: Default::default(),
        contribution: Default::default(),
        moving,
    }
}

/// Zooms, or exposes with Shift.
fn wheel(wheel: Wheel, context: &mut Context<'_>) {
    let feel = Feel::new(context.preferences);
    let factor = wheel.distance_factor(feel);
    if factor != 1.0 {
        cameras::move_camera(context.session, |camera| camera.zoom(factor));
    }
    if wheel.exposure != 0.0 {
        context.session.edit("Exposure", "", |document| {
            let ev = document.view.exposure_ev + navigation::EV_PER_NOTCH * wheel.exposure;
            document.view.exposure_ev = ev.clamp(-16.0, 16.0);
        });
    }
}

/// Selects what was picked, or adds it; picking nothing deselects.
fn select(session: &mut Session, picked: Option<Picked>, add: bool) {
    let key = picked.and_then(|picked| session.resolved().object_keys.get(picked.instance).cloned());
    let material = picked.and_then(|picked| material_of(session, picked));
    session.selection.lights.clear();
    let objects = &mut session.selection.objects;
    match key {
        Some(key) if add && objects.contains(&key) => objects.retain(|other| *other != key),
        Some(key) if add => objects.push(key),
        Some(key) => *objects = vec![key],
        None if add => {}
        None => objects.clear(),
    }
    if let Some(material) = material {
        session.selection.material = material;
    }
}

/// The document's material of an instance.
fn material_of(session: &Session, picked: Picked) -> Option<usize> {
    let material = session.scene().instances.get(picked.instance)?.material;
    (material < session.document().materials.len()).then_some(material)
}

#[cfg(test)]
mod tests;
