//! What is seen behind everything, on the device against the processor.

use std::sync::Arc;

use burnish_core::scene::environment::blurred;
use burnish_core::scene::{Background, Environment, Ground, Scene, gallery};
use burnish_tests::{Need, trial};
use glam::Vec3;
use libtest_mimic::Trial;

use crate::processor::{assert_classical_same, sky};

/// Kinds of backgrounds by name.
type Kind = (&'static str, fn(&Environment) -> Background);

const KINDS: [Kind; 4] = [
    ("one colour", |_| Background::of_color(Vec3::new(0.1, 0.2, 0.7))),
    ("a blurred map", |map| Background { map: Some(Arc::new(blurred(map, 6.0))), ground: None }),
    ("a map on a ground", |_| Background { map: None, ground: Some(GROUND) }),
    ("a blurred map on a ground", |map| Background { map: Some(Arc::new(blurred(map, 6.0))), ground: Some(GROUND) }),
];

const GROUND: Ground = Ground { middle: Vec3::new(0.3, -1.0, 0.2), height: 1.6, radius: 12.0, shadows: false };

pub fn trials() -> Vec<Trial> {
    let each = KINDS.into_iter().map(|(name, make)| {
        let name = format!("a background is the same on device and processor: {name}");
        trial(name.leak(), &[Need::Gpu], move || assert_classical_same(scene(make), "0"))
    });
    each.collect()
}

/// A ball in a tinted sky that is turned.
fn scene(make: fn(&Environment) -> Background) -> Scene {
    let mut scene = gallery::open("ball?material=Cu&roughness=0.4").expect("in the gallery");
    let map = Environment { tint: Vec3::new(1.0, 0.7, 0.4), ..sky() };
    scene.background = make(&map);
    scene.environment = Some(Arc::new(map));
    scene
}
