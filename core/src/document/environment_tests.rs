use std::sync::Arc;

use glam::Vec3;
use serde_json::json;

use super::*;
use crate::document::{Curves, Document, Sources, resolve};
use crate::scene::{LightKind, Scene};

fn entry(value: Value) -> EnvironmentEntry {
    serde_json::from_value(value).unwrap()
}

fn resolved(environment: EnvironmentEntry, curves: &mut Curves) -> (Arc<Scene>, Vec<String>) {
    let document = Document { environment, ..Document::default() };
    let resolved = resolve(&document, &Sources::default(), curves);
    (resolved.scene, resolved.notices)
}

#[test]
fn an_entry_of_before_is_read_and_written_as_it_was() {
    let old = json!({ "rotation_deg": 30.0, "strength": 2.0, "later": 7 });
    let read = entry(old.clone());
    assert_eq!((read.tint, read.background_blur_deg, read.sun_split), ([1.0; 3], 0.0, false));
    assert_eq!(serde_json::to_value(&read).unwrap(), old);
    assert_eq!(entry(json!({})), EnvironmentEntry::default());
}

#[test]
fn entries_are_read_as_they_were_written_with_what_is_not_known() {
    let written = json!({
        "rotation_deg": 0.0, "strength": 1.0, "tint": [1.0, 0.5, 0.25], "background": { "color": [0.0, 0.0, 0.1] },
        "background_blur_deg": 5.0, "sun_split": true, "sun_strength": 4.0,
        "ground": { "height": 2.0, "radius": 30.0, "level": 0.5, "shadows": false, "later": 1 },
        "made": { "studio": { "top": [1.0, 1.0, 1.0], "horizon": [0.0, 0.0, 0.0], "bottom": [0.0, 0.0, 0.0],
            "rows": 64, "later": 2, "boxes": [{
                "name": "key", "azimuth_deg": 1.0, "elevation_deg": 2.0, "width_deg": 3.0, "height_deg": 4.0,
                "roll_deg": 5.0, "radiance": 6.0, "kelvin": 3200.0, "color": [1.0, 1.0, 1.0], "softness": 0.5,
                "gradient": [0.1, 0.2], "shape": "disc", "later": 3 }] } }
    });
    assert_eq!(serde_json::to_value(entry(written.clone())).unwrap(), written);
    for later in [json!({ "nebula": { "stars": 9 } }), json!({ "sky": { "turbidity": "thick" } })] {
        let written = json!({ "rotation_deg": 0.0, "strength": 1.0, "made": later, "background": "stars" });
        let read = entry(written.clone());
        assert!(matches!(read.made, Some(MadeEntry::Unknown(_))));
        assert_eq!(serde_json::to_value(&read).unwrap(), written);
        let (_, notices) = resolved(read, &mut Curves::default());
        assert!(notices.iter().any(|n| n.contains("cannot make")) && notices.iter().any(|n| n.contains("stars")));
    }
}

#[test]
fn numbers_out_of_range_are_named() {
    let wrong = [
        (json!({ "strength": -1.0 }), "environment.strength"),
        (json!({ "tint": [1.0, -1.0, 1.0] }), "environment.tint"),
        (json!({ "background_blur_deg": 91.0 }), "background_blur_deg"),
        (json!({ "sun_strength": -1.0 }), "environment.sun_strength"),
        (json!({ "ground": { "height": 5.0, "radius": 5.0 } }), "ground.radius"),
        (json!({ "made": { "sky": { "turbidity": 1.0 } } }), "made.sky.turbidity"),
        (json!({ "made": { "studio": { "boxes": [{ "softness": 2.0 }] } } }), "boxes.softness"),
    ];
    for (value, field) in wrong {
        let error = entry(value).check("").unwrap_err();
        assert!(error.contains(field), "{error}");
    }
    let whole = json!({ "made": { "sky": {} }, "ground": {}, "background": { "color": [0.0, 0.0, 0.0] } });
    assert_eq!(entry(whole).check(""), Ok(()));
    assert_eq!(entry(json!({ "made": { "studio": {} } })).check(""), Ok(()));
}

#[test]
fn tint_strength_and_rotation_reach_environment_background_and_sun_alike() {
    let mut curves = Curves::default();
    let sky = json!({ "sky": { "rows": 32 } });
    let plain = resolved(entry(json!({ "made": sky.clone() })), &mut curves).0;
    let changed = json!({ "made": sky, "tint": [1.0, 0.5, 0.25], "strength": 2.0, "rotation_deg": 90.0,
        "background_blur_deg": 10.0 });
    let scene = resolved(entry(changed), &mut curves).0;
    let (map, soft) = (scene.environment.as_ref().unwrap(), scene.background.map.as_ref().unwrap());
    assert_eq!(map.scale(), 2.0 * Vec3::new(1.0, 0.5, 0.25));
    assert_eq!((soft.scale(), soft.rotation), (map.scale(), map.rotation));
    let (before, after) = (plain.lights.last().unwrap(), scene.lights.last().unwrap());
    assert!((after.intensity - before.intensity * map.scale()).length() < 1e-3 * before.intensity.length());
    let turned = glam::Quat::from_rotation_y(std::f32::consts::FRAC_PI_2) * before.direction;
    assert!((after.direction - turned).length() < 1e-5, "{} {turned}", after.direction);
    assert!(matches!(after.kind, LightKind::Directional { angular_radius } if angular_radius > 0.004));
    // A blurred background has the sun in it.
    assert!(before.camera && !after.camera);
}

#[test]
fn maps_are_made_once() {
    let mut curves = Curves::default();
    let studio = json!({ "made": { "studio": { "rows": 32 } }, "background_blur_deg": 20.0, "sun_split": true });
    let texels = |scene: &Scene| {
        let soft = scene.background.map.as_ref().unwrap();
        (scene.environment.as_ref().unwrap().texels.clone(), soft.texels.clone())
    };
    let (first, notices) = resolved(entry(studio.clone()), &mut curves);
    assert!(notices.iter().any(|n| n.contains("no sun")), "{notices:?}");
    let mut turned = entry(studio);
    turned.rotation_deg = 50.0;
    let second = resolved(turned, &mut curves).0;
    let ((a, b), (c, d)) = (texels(&first), texels(&second));
    assert!(Arc::ptr_eq(&a, &c) && Arc::ptr_eq(&b, &d));
}

#[test]
fn a_sun_is_split_out_and_a_ground_lies_under_the_scene() {
    let mut map = Environment::new("noon", 128, 64, vec![Vec3::ONE; 128 * 64]);
    let mut texels = map.texels.to_vec();
    texels[20 * 128 + 64] = Vec3::splat(6e4);
    map.texels = texels.into();
    let mut sources = Sources::default();
    sources.environments.insert("noon.hdr".into(), Arc::new(map));
    let environment = entry(json!({ "source": "noon.hdr", "sun_split": true, "ground": {} }));
    let document = Document { environment, ..Document::default() };
    let scene = resolve(&document, &sources, &mut Curves::default()).scene;
    let sun = scene.lights.last().unwrap();
    assert_eq!(sun.name, "Sun of noon");
    assert!(scene.environment.as_ref().unwrap().texels.iter().all(|t| t.max_element() < 1.01));
    let ground = scene.background.ground.unwrap();
    assert!(ground.shadows && (ground.middle.y - scene.bounds().min.y).abs() < 1e-6);
    let mut brighter = Document::clone(&document);
    brighter.environment.sun_strength = 8.0;
    let again = resolve(&brighter, &sources, &mut Curves::default()).scene;
    assert!((again.lights.last().unwrap().intensity - 8.0 * sun.intensity).length() < 1e-5 * sun.intensity.length());
    assert_eq!(again.environment.as_ref().map(|map| map.scale()), scene.environment.as_ref().map(|map| map.scale()));
}
