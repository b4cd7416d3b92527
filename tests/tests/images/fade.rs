//! A picture at rest that is lit otherwise: it fades, without a jump.

use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::job::Handle;
use burnish_core::lighting::{Method, impostor};
use burnish_core::param::Settings;
use burnish_core::reference::{Options, World};
use burnish_core::scene::{Scene, gallery};
use burnish_render::readback::read_texture;
use burnish_render::{Frame, Gpu, Lighting, Viewport};
use burnish_tests::{Need, trial};
use glam::UVec2;
use libtest_mimic::Trial;

const SIZE: UVec2 = UVec2::new(60, 40);

pub fn trials() -> Vec<Trial> {
    vec![trial("a picture at rest fades into one that is lit otherwise", &[Need::Gpu], fade)]
}

fn fade() {
    let room = gallery::open("room").expect("in the gallery");
    let mut dark = room.clone();
    dark.materials.iter_mut().for_each(|material| material.emission *= 0.3);
    let mut settings = Settings::new(impostor::PARAMS);
    for (key, value) in [("resolution", "16"), ("probe-paths", "4"), ("samples", "0")] {
        settings.set(key, value).expect("a setting");
    }
    let lighting = |scene: &Scene| {
        let world = World::new(&Arc::new(scene.clone()), Options::new(&settings));
        let prepared = impostor::Impostor.prepare(&world, &settings, &Handle::default()).expect("a probe");
        Lighting::new(impostor::Impostor.info().id, Some(Arc::new(prepared)))
    };
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    let mut viewport = Viewport::new(&gpu);
    let scene = Arc::new(room);
    viewport.set_scene(&scene).unwrap_or_else(|e| panic!("{e}"));
    let frame = |lighting: Lighting| Frame {
        size: SIZE,
        camera: scene.cameras[0].clone(),
        settings: settings.clone(),
        lighting,
        tone: ToneMap::None,
        exposure_ev: -2.0,
        mode: Default::default(),
        contribution: Default::default(),
        moving: false,
    };
    // The mean of what the screen shows after every whole frame until the picture rests; the first is what it showed before.
    let mut means = |frame: &Frame| {
        let (mut list, mut frames) = (Vec::new(), u32::MAX);
        for _ in 0..5000 {
            let drawn = viewport.draw(frame).unwrap_or_else(|e| panic!("{e}"));
            if drawn.frames != frames && drawn.size == SIZE {
                frames = drawn.frames;
                let output = viewport.output().expect("a picture").texture();
                let bytes = read_texture(&gpu, output, 0, 0).unwrap_or_else(|e| panic!("{e}"));
                list.push(bytes.iter().map(|byte| f64::from(*byte)).sum::<f64>() / bytes.len() as f64);
            }
            if drawn.settled {
                return list;
            }
        }
        panic!("the picture does not settle");
    };
    let (bright, dim) = (frame(lighting(&scene)), frame(lighting(&dark)));
    let before = *means(&bright).last().expect("a picture");
    let fading = means(&dim);
    let after = *fading.last().expect("a picture");
    let whole = before - after;
    assert!(whole > 3.0, "the lamp lights what is mirrored: {before} {after}");
    assert!((fading[0] - before).abs() < 0.5, "it stays until there is another: {before} {fading:?}");
    assert!(fading.len() >= 10, "{fading:?}");
    for pair in fading.windows(2) {
        let step = pair[0] - pair[1];
        assert!(step > -0.1 * whole && step < 0.3 * whole, "a jump: {before} {fading:?} {after}");
    }
    // And it comes to rest on what it would have been without the other.
    let mut fresh = Viewport::new(&gpu);
    fresh.set_scene(&scene).unwrap_or_else(|e| panic!("{e}"));
    while !fresh.draw(&dim).unwrap_or_else(|e| panic!("{e}")).settled {}
    let bytes = |viewport: &Viewport| {
        let output = viewport.output().expect("a picture").texture();
        read_texture(&gpu, output, 0, 0).unwrap_or_else(|e| panic!("{e}"))
    };
    assert_eq!(bytes(&fresh), bytes(&viewport));
}
