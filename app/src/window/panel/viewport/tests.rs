use burnish_core::document::{self, Document, VIEW_LABEL};
use burnish_core::lighting::Store;
use eframe::egui::{Event, Modifiers, MouseWheelUnit, PointerButton, Pos2, TouchPhase, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use super::*;
use crate::window::aids::Aids;
use crate::window::chart::Chart;
use crate::window::compare::Compare;
use crate::window::preferences::{Navigation, Preferences};
use crate::window::preparations::Preparations;
use crate::window::reference::Reference;
use crate::window::request::Requests;
use crate::window::scope::Scope;
use crate::window::stage::Stage;
use crate::window::thumbnails::Thumbnails;
use crate::window::user_lightings::UserLightings;
use crate::window::user_presets::UserPresets;

struct Bench {
    panel: ViewportPanel,
    session: Session,
    preferences: Preferences,
    stage: Stage,
    reference: Reference,
    compare: Compare,
    requests: Requests,
}

fn session() -> Session {
    Session::new(document::open("gallery:workbench").unwrap(), None)
}

fn bench() -> Harness<'static, Bench> {
    let bench = Bench {
        panel: ViewportPanel::default(),
        session: session(),
        preferences: Preferences::default(),
        stage: Stage::Flat,
        reference: Reference::default(),
        compare: Compare::new(Store::none()),
        requests: Requests::new(),
    };
    let show = |ui: &mut egui::Ui, bench: &mut Bench| {
        bench.session.now_secs = ui.input(|input| input.time);
        let Bench { panel, session, preferences, stage, reference, compare, requests } = bench;
        let (own, thumbnails) = (&mut UserPresets::default(), &mut Thumbnails::default());
        let (preparations, chart) = (&mut Preparations::new(Store::none()), &mut Chart::new(None));
        let lightings = &mut UserLightings::default();
        let (aids, scope) = (&mut Aids::default(), &mut Scope::default());
        panel.ui(
            ui,
            &mut Context {
                session,
                preferences,
                stage,
                reference,
                preparations,
                compare,
                chart,
                aids,
                scope,
                requests,
                own,
                lightings,
                thumbnails,
            },
        );
    };
    let mut harness = Harness::builder().with_size(vec2(600.0, 400.0)).build_ui_state(show, bench);
    harness.run_steps(2);
    harness
}

fn middle(bench: &Harness<Bench>) -> Pos2 {
    bench.get_by_label_contains("Viewport: workbench").rect().center()
}

/// Presses a button, moves by steps, lets go.
fn drag(bench: &mut Harness<Bench>, button: PointerButton, modifiers: Modifiers, by: Vec2) {
    let start = middle(bench);
    let press = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers };
    bench.event(Event::ModifiersChanged(modifiers));
    bench.event(Event::PointerMoved(start));
    bench.event(press(start, true));
    bench.run_steps(1);
    for step in 1..=4 {
        bench.event(Event::PointerMoved(start + by * (step as f32 / 4.0)));
        bench.run_steps(1);
    }
    bench.event(press(start + by, false));
    bench.event(Event::ModifiersChanged(Modifiers::NONE));
    bench.run_steps(2);
}

fn turn_wheel(bench: &mut Harness<Bench>, notches: f32, modifiers: Modifiers) {
    let at = middle(bench);
    bench.hover_at(at);
    bench.run_steps(1);
    bench.event(Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta: vec2(0.0, notches),
        phase: TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers,
    });
    bench.run_steps(2);
}

fn document(bench: &Harness<Bench>) -> Document {
    Document::clone(bench.state().session.document())
}

#[test]
fn a_left_drag_turns_the_camera_and_undo_brings_it_back() {
    let mut bench = bench();
    let before = document(&bench);
    drag(&mut bench, PointerButton::Primary, Modifiers::NONE, vec2(80.0, 20.0));
    let after = document(&bench);
    assert!(after.view.camera.yaw_deg < before.view.camera.yaw_deg);
    assert!(after.view.camera.pitch_deg > before.view.camera.pitch_deg);
    assert_eq!(after.view.camera.distance, before.view.camera.distance);
    assert_eq!(bench.state().session.history().past().len(), 1, "a drag is one step");
    assert_eq!(bench.state_mut().session.undo().as_deref(), Some(VIEW_LABEL));
    assert_eq!(document(&bench), before);
}

#[test]
fn shift_and_right_drag_turns_the_light_and_two_of_them_are_two_steps() {
    let mut bench = bench();
    let before = document(&bench);
    drag(&mut bench, PointerButton::Secondary, Modifiers::SHIFT, vec2(60.0, 0.0));
    drag(&mut bench, PointerButton::Secondary, Modifiers::SHIFT, vec2(60.0, 0.0));
    let after = document(&bench);
    assert!(after.environment.rotation_deg > before.environment.rotation_deg + 20.0);
    assert_eq!(after.view.camera, before.view.camera);
    assert_eq!(bench.state().session.history().past().len(), 2);
}

#[test]
fn buttons_follow_the_chosen_preset() {
    let mut bench = bench();
    bench.state_mut().preferences.navigation = Navigation::Blender;
    let before = document(&bench);
    drag(&mut bench, PointerButton::Primary, Modifiers::NONE, vec2(80.0, 20.0));
    assert_eq!(document(&bench), before, "the left button only selects in Blender");
    drag(&mut bench, PointerButton::Middle, Modifiers::SHIFT, vec2(80.0, 20.0));
    let after = document(&bench).view.camera;
    assert_ne!(after.target, before.view.camera.target);
    assert_eq!(after.yaw_deg, before.view.camera.yaw_deg);
}

#[test]
fn the_wheel_zooms_and_with_shift_exposes() {
    let mut bench = bench();
    let before = document(&bench).view;
    turn_wheel(&mut bench, 1.0, Modifiers::NONE);
    let nearer = document(&bench).view;
    assert!(nearer.camera.distance < before.camera.distance);
    assert_eq!(nearer.exposure_ev, before.exposure_ev);
    turn_wheel(&mut bench, 2.0, Modifiers::SHIFT);
    assert_eq!(document(&bench).view.exposure_ev, before.exposure_ev + 2.0 * navigation::EV_PER_NOTCH);
    assert_eq!(document(&bench).view.camera, nearer.camera);
}

#[test]
fn a_click_selects_what_is_there_and_names_it() {
    let mut bench = bench();
    let at = middle(&bench);
    bench.drag_at(at);
    bench.run_steps(1);
    bench.drop_at(at);
    bench.run_steps(2);
    let session = &bench.state().session;
    assert_eq!(session.selection.objects.len(), 1);
    let text = overlay::selection_text(session);
    assert!(text.contains(", material "), "{text}");
    bench.get_by_label(&text);
    assert!(session.history().past().is_empty(), "a click is no edit");
}

#[test]
fn a_preset_that_is_dropped_goes_on_the_material_under_it() {
    let mut bench = bench();
    let at = middle(&bench);
    bench.drag_at(at);
    bench.run_steps(1);
    egui::DragAndDrop::set_payload(&bench.ctx, DraggedPreset("Cu".into()));
    bench.hover_at(at + vec2(2.0, 0.0));
    bench.run_steps(1);
    bench.drop_at(at + vec2(2.0, 0.0));
    bench.run_steps(2);
    let bench = bench.state();
    let shown = bench.session.selection.material;
    let asked = bench.requests.iter().any(|request| {
        matches!(request, Request::AssignPreset { preset, materials } if preset == "Cu" && materials == &[shown])
    });
    assert!(asked, "{:?}", bench.requests);
}

#[test]
fn a_pick_selects_shift_adds_and_nothing_deselects() {
    let mut session = session();
    let keys = session.resolved().object_keys.clone();
    let at = |instance| Some(Picked { instance, position: glam::Vec3::ZERO, normal: glam::Vec3::Z });
    select(&mut session, at(0), false);
    assert_eq!(session.selection.objects, keys[..1]);
    assert_eq!(session.selection.material, session.scene().instances[0].material);
    select(&mut session, at(1), true);
    assert_eq!(session.selection.objects, keys[..2]);
    select(&mut session, at(0), true);
    assert_eq!(session.selection.objects, keys[1..2]);
    select(&mut session, None, true);
    assert_eq!(session.selection.objects.len(), 1);
    select(&mut session, None, false);
    assert!(session.selection.objects.is_empty());
}

#[test]
fn the_picture_says_what_it_shows() {
    let mut session = session();
    let all = session.scene().instances.len();
    assert_eq!(summary_text(&session), format!("Viewport: workbench, {all} objects"));
    let key = session.resolved().object_keys[0].clone();
    session.edit("Hide", "", |document| document.edit_object(&key, |object| object.hidden = true));
    assert!(summary_text(&session).contains(&format!("{} object", all - 1)));
}

/// Drags a handle by its name.
fn drag_handle(bench: &mut Harness<Bench>, name: &str, by: Vec2) {
    let start = bench.get_by_label(name).rect().center();
    let press = |pos, pressed| {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        Event::PointerButton { pos, button, pressed, modifiers }
    };
    bench.hover_at(start);
    bench.run_steps(1);
    bench.event(press(start, true));
    bench.run_steps(1);
    for step in 1..=4 {
        bench.hover_at(start + by * (step as f32 / 4.0));
        bench.run_steps(1);
    }
    bench.event(press(start + by, false));
    bench.run_steps(2);
}

#[test]
fn handles_move_turn_and_scale_an_object_in_one_step_each_and_leave_the_camera() {
    let mut bench = bench();
    // The ball, which is in the middle of the picture.
    let place = 0;
    let key = bench.state().session.resolved().object_keys[place].clone();
    let name = bench.state().session.scene().instances[place].name.clone();
    bench.state_mut().session.selection.objects = vec![key.clone()];
    let before = document(&bench);
    for (tool, handle, by) in [
        (Tool::Move, format!("Move {name} along y"), vec2(0.0, -40.0)),
        (Tool::Rotate, format!("Turn {name}"), vec2(0.0, -40.0)),
        (Tool::Scale, format!("Scale {name}"), vec2(60.0, 0.0)),
    ] {
        bench.state_mut().panel.tools.tool = tool;
        bench.run_steps(2);
        let steps = bench.state().session.history().past().len();
        drag_handle(&mut bench, &handle, by);
        assert_eq!(bench.state().session.history().past().len(), steps + 1, "{handle} is one step");
        assert_eq!(document(&bench).view, before.view, "{handle}");
    }
    let put = document(&bench).transform(&key);
    assert!(put.by[1] > 0.0 && put.by[0] == 0.0 && put.by[2] == 0.0, "{put:?}");
    assert!(put.scale[0] > 1.3 && put.scale[0] == put.scale[2], "{put:?}");
    for _ in 0..3 {
        bench.state_mut().session.undo();
    }
    assert_eq!(document(&bench), before);
}
