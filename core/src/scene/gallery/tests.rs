use glam::{Vec2, Vec3};

use super::*;
use crate::{
    material::Reflectance,
    param::ParamKind,
    scene::{Image, Scene, Texels, fingerprint::Fingerprint},
    trace::{Accel, Ray},
};

#[test]
fn every_scene_of_the_list_opens_by_its_name_with_and_without_the_prefix() {
    assert!(!list().is_empty());
    for entry in list() {
        let scene = open(entry.name).unwrap();
        assert_eq!(scene.validate(), Ok(()), "{}", entry.name);
        assert!(!scene.instances.is_empty() && !scene.cameras.is_empty(), "{}", entry.name);
        assert_eq!(scene.name, entry.name);
        let prefixed = open(&format!("gallery:{}", entry.name)).unwrap();
        assert_eq!(prefixed.triangle_count(), scene.triangle_count());
        assert!(entry.params.iter().all(|spec| !spec.help.is_empty()));
    }
}

#[test]
fn errors_list_what_exists() {
    let message = |spec: &str| open(spec).unwrap_err().to_string();
    assert!(message("gallery:workbnch").starts_with("no gallery scene `workbnch`; there are: workbench, ball, "));
    assert!(message("gallery:").contains("workbench"));
    let unknown = message("gallery:workbench?rough=1");
    assert!(unknown.contains("`rough`") && unknown.contains("roughness, anisotropy"), "{unknown}");
    let range = message("workbench?roughness=2");
    assert!(range.contains("`2`") && range.contains("0 to 1"), "{range}");
    assert!(message("workbench?room=open").contains("walls, none"));
    assert!(message("workbench?roughness").contains("key=value"));
    assert!(message("workbench?roughness=0&roughness=1").contains("twice"));
    assert!(message("workbench?roughness=NaN").contains("NaN"));
}

#[test]
fn keys_change_the_workbench() {
    let plain = open("workbench").unwrap();
    let other = open("workbench?roughness=0.5&room=none&").unwrap();
    let ball = |scene: &Scene| scene.materials.iter().find(|m| m.name == "ball").unwrap().roughness;
    assert!((ball(&other) - 0.5).abs() < 1e-6 && ball(&plain) != ball(&other));
    assert!(other.instances.iter().all(|i| !i.name.starts_with("wall")));
    assert!(plain.instances.iter().any(|i| i.name == "wall-left"));
}

#[test]
fn the_workbench_has_its_slots_its_light_and_a_size_that_any_renderer_bears() {
    let scene = open("workbench").unwrap();
    for slot in ["ball", "core", "ring", "plinth", "floor", "wall-left", "wall-right", "wall-back", "window", "frame"] {
        assert_eq!(scene.materials.iter().filter(|m| m.name == slot).count(), 1, "{slot}");
    }
    assert!(scene.triangle_count() <= 60_000, "{}", scene.triangle_count());
    assert!(scene.materials.iter().any(|m| m.emission.max_element() > 1.0));
    assert!(matches!(scene.lights[0].kind, crate::scene::LightKind::Spot { .. }));
    assert!(["main", "close"].iter().all(|name| scene.cameras.iter().any(|c| c.name == *name)));
    let bounds = scene.bounds();
    assert!(bounds.radius() < 2.0 && bounds.min.y > -0.1, "{bounds:?}");
}

#[test]
fn the_studio_is_finite_and_bright_in_few_places() {
    let studio = studio();
    assert_eq!(studio.texels.len(), (studio.width * studio.height) as usize);
    assert!(studio.texels.iter().all(|t| t.is_finite() && t.min_element() >= 0.0));
    let luminance = |t: glam::Vec3| f64::from(t.dot(glam::Vec3::new(0.2126, 0.7152, 0.0722)));
    let (mut sum, mut weight, mut bright, mut peak) = (0.0, 0.0, 0.0, 0.0_f64);
    for (i, &texel) in studio.texels.iter().enumerate() {
        let row = i / studio.width as usize;
        let area = (std::f64::consts::PI * (row as f64 + 0.5) / f64::from(studio.height)).sin();
        sum += area * luminance(texel);
        weight += area;
        bright += if luminance(texel) > 1.0 { area } else { 0.0 };
        peak = peak.max(luminance(texel));
    }
    let (mean, share) = (sum / weight, bright / weight);
    assert!((0.5..1.0).contains(&mean), "mean {mean}");
    assert!((10.0..40.0).contains(&peak), "peak {peak}");
    assert!((0.05..0.25).contains(&share), "share of the sphere that is bright: {share}");
}

#[test]
fn the_key_light_of_the_studio_is_where_the_direction_convention_puts_it() {
    let studio = studio();
    let seen = |x: f32, y: f32, z: f32| {
        let d = glam::Vec3::new(x, y, z).normalize();
        let (u, v) = (0.5 + d.x.atan2(-d.z) / std::f32::consts::TAU, d.y.acos() / std::f32::consts::PI);
        let (column, row) = ((u * studio.width as f32) as usize, (v * studio.height as f32) as usize);
        studio.texels[row * studio.width as usize + column].y
    };
    // Left of the camera (-x), behind it (+z) and up; the fill is on the right, and before the camera hangs nothing.
    let (key, fill, before) = (seen(-0.62, 0.56, 0.54), seen(0.79, 0.34, 0.51), seen(-0.62, 0.56, -0.54));
    assert!(key > 3.0 * fill && fill > 1.0 && before < 0.5, "key {key}, fill {fill}, before the camera {before}");
}

/// Scenes whose light stays inside.
const CLOSED: [&str; 8] = ["room", "crate", "box-sphere", "statue", "fireballs", "corner", "cabin", "wall"];

/// Directions spread evenly over the sphere.
fn directions(count: usize) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |i| {
        let y = 1.0 - (2 * i + 1) as f32 / count as f32;
        let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
        let r = (1.0 - y * y).sqrt();
        Vec3::new(r * cos, y, r * sin)
    })
}

#[test]
fn no_ray_leaves_a_closed_room() {
    let variants = ["room?shape=l-shaped&body=blob&at=0.7,-0.65,0.7", "wall?thickness=0.001", "crate?body=bunny-like"];
    for spec in CLOSED.iter().chain(&variants) {
        let scene = open(spec).unwrap();
        let accel = Accel::new(&scene);
        let mut points = vec![Vec3::from(scene.cameras[0].world_from_view.translation)];
        // Around, in steps: from what the first rays meet, just before it.
        for direction in directions(64) {
            let ray = Ray { origin: points[0], direction, t_max: f32::INFINITY };
            points.extend(accel.closest(&ray, |_| true).map(|hit| points[0] + 0.999 * hit.t * direction));
        }
        assert_eq!(points.len(), 65, "{spec}: a ray from the camera leaves");
        for &origin in &points {
            for direction in directions(1024) {
                let ray = Ray { origin, direction, t_max: f32::INFINITY };
                assert!(accel.closest(&ray, |_| true).is_some(), "{spec}: a ray leaves from {origin} to {direction}");
            }
        }
    }
}

#[test]
fn no_front_face_is_seen_from_behind_inside_a_closed_room() {
    for spec in CLOSED {
        let scene = open(spec).unwrap();
        let accel = Accel::new(&scene);
        let camera = &scene.cameras[0];
        for i in 0..4096 {
            let at = Vec2::new((i % 64) as f32 + 0.5, (i / 64) as f32 + 0.5) / 64.0;
            let ray = camera.ray(at, 16.0 / 9.0);
            let ray = Ray { origin: ray.origin, direction: ray.direction, t_max: f32::INFINITY };
            let hit = accel.closest(&ray, |_| true).unwrap();
            let instance = &scene.instances[hit.instance as usize];
            let mesh = &scene.meshes[instance.mesh];
            let [a, b, c] = [0, 1, 2].map(|k| {
                let index = mesh.indices[3 * hit.triangle as usize + k] as usize;
                instance.world_from_local.transform_point3(mesh.positions[index])
            });
            let facing = (b - a).cross(c - a).dot(ray.direction);
            assert!(facing < 0.0, "{spec}: the back of `{}` is seen at {at}", instance.name);
        }
    }
}

#[test]
fn the_first_camera_sees_the_subject_large_and_whole() {
    for entry in list() {
        let scene = open(entry.name).unwrap();
        assert!(!scene.subject.is_empty(), "{}", entry.name);
        let accel = Accel::new(&scene);
        let (columns, rows) = (160, 90);
        let mut seen = 0;
        let mut at_edge = 0;
        for i in 0..columns * rows {
            let (x, y) = (i % columns, i / columns);
            let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / Vec2::new(columns as f32, rows as f32);
            let ray = scene.cameras[0].ray(at, 16.0 / 9.0);
            let ray = Ray { origin: ray.origin, direction: ray.direction, t_max: f32::INFINITY };
            let hit = accel.closest(&ray, |_| true);
            if hit.is_some_and(|hit| scene.subject.contains(&(hit.instance as usize))) {
                seen += 1;
                at_edge += usize::from(x == 0 || y == 0 || x == columns - 1 || y == rows - 1);
            }
        }
        let share = seen as f32 / (columns * rows) as f32;
        assert!((0.04..0.6).contains(&share), "{}: the subject fills {share} of the picture", entry.name);
        // The partition of `wall` goes through the picture.
        assert!(at_edge == 0 || entry.name == "wall", "{}: the subject is cut off", entry.name);
    }
}

#[test]
fn scenes_are_the_same_each_time_and_small_enough_to_trace_in_seconds() {
    for entry in list() {
        let scenes = [0, 1].map(|_| open(entry.name).unwrap());
        assert_eq!(Fingerprint::new(&scenes[0]), Fingerprint::new(&scenes[1]), "{}", entry.name);
        assert!(scenes[0].triangle_count() <= 90_000, "{}: {}", entry.name, scenes[0].triangle_count());
    }
}

#[test]
fn nothing_reflects_more_than_it_gets() {
    for entry in list() {
        let scene = open(entry.name).unwrap();
        for material in &scene.materials {
            assert!(material.base_color.max_element() <= 1.0, "{}: {}", entry.name, material.name);
            let white = material.base_color == Vec3::ONE && material.base_color_texture.is_none();
            assert!(!white, "{}: {} is perfectly white", entry.name, material.name);
        }
        let brightest = |image: &Image| match &image.texels {
            Texels::Unorm8(texels) => texels.chunks(4).map(|t| t[0].max(t[1]).max(t[2])).max().unwrap_or(0),
            Texels::Unorm16(_) => 0,
        };
        // An image that is multiplied with an albedo; that of the workbench's window glows.
        let albedos = scene.materials.iter().filter_map(|m| m.base_color_texture);
        assert!(albedos.into_iter().all(|t| brightest(&scene.images[t.image]) < 250), "{}", entry.name);
    }
}

#[test]
fn every_value_of_every_setting_makes_a_sound_scene() {
    for entry in list() {
        for spec in entry.params {
            let texts: Vec<String> = match spec.kind {
                ParamKind::Integer { min, max, .. } => vec![min.to_string(), max.to_string()],
                ParamKind::Number { min, max, .. } => vec![min.to_string(), max.to_string()],
                ParamKind::Choice { options, .. } => options.iter().map(|word| word.to_string()).collect(),
                ParamKind::Toggle { .. } => vec!["on".into(), "off".into()],
                ParamKind::Color { max, .. } => vec!["0,0,0".into(), format!("{max},{max},{max}")],
                ParamKind::Vector { min, max, .. } => {
                    [min, max].map(|v| v.map(|c| c.to_string()).join(",")).into_iter().collect()
                }
            };
            // Metals differ in nothing but their curves: a few are enough.
            for text in texts.iter().rev().take(12) {
                let scene = open(&format!("{}?{}={text}", entry.name, spec.key)).unwrap();
                assert_eq!(scene.validate(), Ok(()), "{} with {}={text}", entry.name, spec.key);
            }
        }
    }
}

#[test]
fn settings_out_of_range_are_refused_with_what_they_take() {
    let message = |spec: &str| open(spec).unwrap_err().to_string();
    assert!(message("room?at=0.9,0,0").contains("from -0.7,-0.7,-0.7 to 0.7,0.7,0.7"));
    assert!(message("room?at=0,0").contains("three numbers"));
    assert!(message("room?material=Unobtainium").contains("Au, "));
    assert!(message("room?body=cow").contains("ball, blob, bunny-like"));
    assert!(message("teapot?exponent=16").contains("32 to 512"));
    assert!(message("statue?roughness=-1").contains("0 to 1"));
    assert!(message("wall?thickness=0").contains("0.001 to 0.2"));
}

#[test]
fn settings_change_what_they_name() {
    let subject = |spec: &str| {
        let scene = open(spec).unwrap();
        let instance = scene.instances[scene.subject[0]].clone();
        (instance.name, Vec3::from(instance.world_from_local.translation), scene.materials[instance.material].clone())
    };
    let (name, at, material) = subject("room?body=bunny-like&material=Cu&roughness=0.4&at=0.1,0.2,-0.3");
    assert_eq!((name.as_str(), at, material.roughness), ("bunny-like", Vec3::new(0.1, 0.2, -0.3), 0.4));
    assert!(matches!(&material.reflectance, Reflectance::Preset { id, .. } if id == "Cu"));
    assert!(matches!(subject("ball?material=white").2.reflectance, Reflectance::BaseColor));
    assert_eq!(subject("teapot?exponent=64").2.exponent, 64.0);
    assert!(open("room?shape=l-shaped").unwrap().instances.len() > open("room").unwrap().instances.len());
}
