//! The default scene: a shader ball on a plinth in the corner of a small room, which is open above and to the camera.
//!
//! The ball has what metals want to be seen on: large curved and flat patches, edges of several radii, convex and
//! concave, thick rims, and an inside that shows how light gets in. Its tangents go around its axis, as on a turned
//! part. The room has a warm, a cool and a neutral side, a window that glows and a spot light that casts shadows.

mod ball;
mod room;

use glam::Vec3;

use super::{GalleryScene, number};
use crate::{
    param::{Affects, ParamKind, ParamSpec, Settings},
    scene::{Camera, Light, LightKind, Scene},
};

/// Entry in the list of scenes.
pub const SCENE: GalleryScene = GalleryScene {
    name: "workbench",
    title: "A shader ball on a plinth in a small coloured room with a window",
    params: PARAMS,
    build,
};

const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        key: "roughness",
        label: "Roughness",
        unit: "",
        kind: ParamKind::Number { min: 0.0, max: 1.0, default: 0.22 },
        help: "Roughness of the ball's outer shell: 0 is a mirror, 0.2 polished, 0.5 satin.",
        affects: Affects::Prepare,
    },
    ParamSpec {
        key: "anisotropy",
        label: "Anisotropy",
        unit: "",
        kind: ParamKind::Number { min: 0.0, max: 1.0, default: 0.0 },
        help: "Strength of brushing around the axis of the ball's outer shell.",
        affects: Affects::Prepare,
    },
    ParamSpec {
        key: "room",
        label: "Room",
        unit: "",
        kind: ParamKind::Choice { options: &["walls", "none"], default: 0 },
        help: "The walls with their window, or only the ball on its plinth and the floor.",
        affects: Affects::Prepare,
    },
];

fn build(settings: &Settings) -> Scene {
    let mut scene = Scene { name: SCENE.name.into(), ..Scene::default() };
    ball::add_parts(&mut scene, number(settings, "roughness"), number(settings, "anisotropy"));
    room::add_floor(&mut scene);
    if settings.text("room").as_deref() != Some("none") {
        room::add_walls(&mut scene);
    }
    scene.lights.push(spot());
    scene.cameras.push(Camera::look_at(
        "main",
        Vec3::new(0.2, 0.58, 1.45),
        Vec3::new(0.01, 0.275, 0.0),
        28.5_f32.to_radians(),
    ));
    scene.cameras.push(Camera::look_at(
        "close",
        Vec3::new(0.3, 0.6, 0.72),
        Vec3::new(0.0, 0.37, 0.02),
        34.0_f32.to_radians(),
    ));
    scene
}

/// A lamp above the left wall, in front of the ball. At the ball, 1.7 m away, it gives 5 lx: about as much light as
/// the studio, so that its shadows show beside it.
fn spot() -> Light {
    let position = Vec3::new(-0.95, 1.5, 0.9);
    Light {
        name: "spot".into(),
        position,
        direction: (Vec3::new(0.02, 0.2, -0.05) - position).normalize(),
        intensity: Vec3::new(13.0, 11.8, 10.0),
        range: f32::INFINITY,
        kind: LightKind::Spot { inner_angle: 0.3, outer_angle: 0.5 },
        ..Light::default()
    }
}
