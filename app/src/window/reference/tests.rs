use std::time::{Duration, Instant};

use burnish_core::document;
use glam::Vec4;

use super::desk::QUIET;
use super::*;
use crate::window::session::Session;

/// Far longer than anything here takes.
const PATIENCE: Duration = Duration::from_secs(120);

fn session() -> Session {
    Session::new(document::open("gallery:workbench").unwrap(), None)
}

fn subject(session: &Session) -> Subject {
    let camera = session.document().view.camera.camera();
    Subject::new(session.document(), session.scene(), &camera, UVec2::new(40, 30))
}

/// Looks until something is so.
#[track_caller]
fn until(reference: &mut Reference, session: &Session, reached: impl Fn(&Reference) -> bool) {
    let (start, ctx) = (Instant::now(), egui::Context::default());
    loop {
        reference.look(subject(session), &ctx);
        reference.end_frame();
        if reached(reference) {
            return;
        }
        assert!(start.elapsed() < PATIENCE, "{}", reference.text(true));
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn samples(reference: &Reference) -> u32 {
    reference.shown().map_or(0, |look| look.samples)
}

fn on() -> Reference {
    let mut reference = Reference::default();
    reference.switch(true);
    reference
}

#[test]
fn it_refines_while_nothing_changes_and_an_edit_starts_it_anew() {
    let (mut reference, mut session) = (on(), session());
    until(&mut reference, &session, |reference| samples(reference) > 3);
    let picture = reference.shown().unwrap().picture.clone();
    assert!(picture.is_whole() && (picture.width, picture.height) == (40, 30));
    assert!(reference.text(true).starts_with("Reference: ") && reference.text(false).contains("noise"));
    session.edit("Exposure", "", |document| document.view.exposure_ev = 1.0);
    let ctx = egui::Context::default();
    assert!(reference.look(subject(&session), &ctx).is_some(), "exposure is a matter of the display");
    session.edit("Bounces", "", |document| {
        document.set_reference("bounces", burnish_core::param::ParamValue::Integer(1)).unwrap();
    });
    assert!(reference.look(subject(&session), &ctx).is_none(), "an old picture is not shown as the new one");
    until(&mut reference, &session, |reference| samples(reference) > 0);
    session.edit("Move camera", "", |document| document.view.camera.orbit(30.0, 0.0));
    assert!(reference.look(subject(&session), &ctx).is_none());
}

#[test]
fn wavelengths_are_traced_where_the_settings_ask_for_them() {
    let (mut reference, mut session) = (on(), session());
    until(&mut reference, &session, |reference| samples(reference) > 0);
    let rgb = reference.shown().unwrap().picture.clone();
    session.edit("Wavelengths", "", |document| {
        document.set_reference("spectral", burnish_core::param::ParamValue::Toggle(true)).unwrap();
    });
    until(&mut reference, &session, |reference| samples(reference) > 0);
    let spectral = reference.shown().unwrap().picture.clone();
    // Three wavelengths in a single sample are no grey: even a neutral pixel comes back coloured.
    let colored = |picture: &Picture| {
        let saturation = |t: &Vec4| (t.truncate().max_element() - t.truncate().min_element()) / t.truncate().length();
        picture.texels.iter().map(saturation).filter(|s| s.is_finite()).sum::<f32>()
    };
    assert!(colored(&spectral) > 1.5 * colored(&rgb), "{} {}", colored(&spectral), colored(&rgb));
}

#[test]
fn nothing_is_traced_for_nobody_and_what_was_traced_is_kept() {
    let (mut reference, session) = (on(), session());
    until(&mut reference, &session, |reference| samples(reference) > 3);
    let before = samples(&reference);
    reference.switch(false);
    reference.end_frame();
    let start = Instant::now();
    while reference.is_tracing() {
        assert!(start.elapsed() < PATIENCE, "it goes on");
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(reference.shown().is_none());
    reference.switch(true);
    assert!(reference.look(subject(&session), &egui::Context::default()).unwrap().samples >= before);
    until(&mut reference, &session, |reference| samples(reference) > before);
}

#[test]
fn input_lets_it_rest_for_a_while() {
    let (mut reference, session) = (on(), session());
    reference.note_input();
    assert!(reference.rests_for().is_some_and(|secs| secs <= QUIET.as_secs_f64()));
    let start = Instant::now();
    until(&mut reference, &session, |reference| samples(reference) > 0);
    assert!(start.elapsed() + Duration::from_millis(50) > QUIET, "{:?}", start.elapsed());
    assert_eq!(reference.rests_for(), None);
    reference.switch(false);
    // A frame that does not look at it.
    reference.end_frame();
    reference.note_input();
    assert_eq!(reference.rests_for(), None, "there is nothing to let rest");
}

#[test]
fn a_failure_is_told_and_the_next_edit_tries_again() {
    let (mut reference, mut session) = (on(), session());
    reference.inject_failure();
    until(&mut reference, &session, |reference| reference.fault().is_some());
    assert!(reference.fault().unwrap().contains("for trial") && reference.shown().is_none());
    session.edit("Move camera", "", |document| document.view.camera.orbit(30.0, 0.0));
    until(&mut reference, &session, |reference| samples(reference) > 0);
    assert_eq!(reference.fault(), None);
}

#[test]
fn a_scene_in_which_nothing_is_visible_shows_its_environment() {
    let (mut reference, mut session) = (on(), session());
    let keys = session.resolved().object_keys.clone();
    session.edit("Hide", "", |document| {
        keys.iter().for_each(|key| document.edit_object(key, |object| object.hidden = true));
    });
    until(&mut reference, &session, |reference| samples(reference) > 0);
    assert!(reference.shown().unwrap().picture.texels.iter().any(|texel| texel.x > 0.0));
}

#[test]
fn a_first_look_covers_the_view_and_tells_the_block_under_a_point() {
    let texels = (0..6).map(|i| Vec4::splat(i as f32)).collect();
    let picture = Arc::new(Picture { width: 3, height: 2, texels });
    let look = Look { picture, step: 8, size: UVec2::new(20, 12), ..Look::default() };
    assert_eq!(look.part(), Vec2::new(20.0 / 24.0, 12.0 / 16.0));
    assert_eq!(look.radiance(Vec2::ZERO), Some(Vec3::ZERO));
    assert_eq!(look.radiance(Vec2::new(0.5, 0.9)), Some(Vec3::splat(4.0)));
    assert_eq!(look.radiance(Vec2::ONE), Some(Vec3::splat(5.0)));
    assert_eq!(look.radiance(Vec2::new(1.1, 0.0)), None);
    assert_eq!(Look::default().radiance(Vec2::ZERO), None);
    assert_eq!(look.text(true), "first look, 1/8 of the resolution");
}

#[test]
fn large_views_are_traced_with_fewer_pixels_of_the_same_shape() {
    assert_eq!(limited(UVec2::new(1920, 1080)), UVec2::new(1920, 1080));
    let wide = limited(UVec2::new(7680, 4320));
    assert!(f64::from(wide.x) * f64::from(wide.y) <= MAX_PIXELS && wide.x > 2700, "{wide}");
    assert_eq!(limited(UVec2::new(16384, 1)), UVec2::new(16384, 1));
}

#[test]
fn numbers_are_short() {
    assert_eq!([0.25, 0.0312, 0.00512, 0.0002].map(percent), ["25 %", "3.1 %", "0.51 %", "0.020 %"]);
    assert_eq!([12.3, 600.0, 9000.0].map(duration), ["12 s", "10 min", "2.5 h"]);
}
