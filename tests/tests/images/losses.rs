//! What the window's viewport does when its device fails.

use std::sync::Arc;

use burnish::window::offscreen::Offscreen;
use burnish::window::{LossLog, Stage, Trial as Failure};
use burnish_core::color::tone::ToneMap;
use burnish_core::document::{self, Curves};
use burnish_core::lighting::classical::PARAMS;
use burnish_core::param::Settings;
use burnish_core::scene::Scene;
use burnish_render::Frame;
use burnish_tests::{Need, trial};
use glam::UVec2;
use libtest_mimic::Trial;

pub fn trials() -> Vec<Trial> {
    vec![
        trial("a view that failed is made anew, the third time within a minute it ends", &[Need::Gpu], three_failures),
        trial("a device that is gone asks for a new program", &[Need::Gpu], gone),
    ]
}

fn setup() -> (Offscreen, Arc<Scene>, Frame) {
    let size = UVec2::new(96, 64);
    let offscreen = Offscreen::new(size).expect("an adapter");
    let opened = document::open("gallery:workbench").expect("a gallery scene");
    let scene = document::resolve(&opened.document, &opened.sources, &mut Curves::default()).scene;
    let camera = scene.cameras.first().expect("a camera").clone();
    let (settings, tone) = (Settings::new(PARAMS), ToneMap::default());
    let frame = Frame {
        size,
        camera,
        settings,
        lighting: Default::default(),
        tone,
        exposure_ev: 0.0,
        mode: Default::default(),
        contribution: Default::default(),
        moving: true,
    };
    (offscreen, scene, frame)
}

/// The first frame of a window has no picture yet.
fn draw(stage: &mut Stage, scene: &Arc<Scene>, frame: &Frame) {
    stage.draw(scene, frame);
    let shown = stage.draw(scene, frame);
    assert!(shown.texture.is_some() && shown.message.is_none() && !shown.lost, "{shown:?}");
}

fn three_failures() {
    let (offscreen, scene, frame) = setup();
    let mut stage = offscreen.stage();
    for _ in 0..2 {
        draw(&mut stage, &scene, &frame);
        stage.inject(Failure::Call);
        let shown = stage.draw(&scene, &frame);
        assert!(shown.lost && !shown.settled && shown.message.is_some(), "{shown:?}");
    }
    draw(&mut stage, &scene, &frame);
    stage.inject(Failure::Call);
    let shown = stage.draw(&scene, &frame);
    assert_eq!((shown.lost, shown.message.as_deref()), (true, Some(LossLog::GIVEN_UP)));
    let shown = stage.draw(&scene, &frame);
    assert_eq!((shown.lost, shown.settled, shown.texture), (false, true, None));
    assert_eq!(shown.message.as_deref(), Some(LossLog::GIVEN_UP));
    assert_eq!(stage.wants_restart(), None);
}

fn gone() {
    let (offscreen, scene, frame) = setup();
    let mut stage = offscreen.stage();
    draw(&mut stage, &scene, &frame);
    stage.inject(Failure::Device);
    assert!(stage.draw(&scene, &frame).lost);
    let losses = stage.wants_restart().expect("a restart");
    assert_eq!(losses.to_string().split(',').count(), 1);
    assert!(stage.draw(&scene, &frame).settled, "nothing is drawn with a device that is gone");
}
