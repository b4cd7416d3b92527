use super::*;
use crate::scene::Scene;

/// What every scene promises its users: indices in range, attribute lists of one length, finite numbers.
fn assert_sound(scene: &Scene) {
    assert!(!scene.instances.is_empty() && !scene.cameras.is_empty(), "{}", scene.name);
    for instance in &scene.instances {
        assert!(instance.mesh < scene.meshes.len() && instance.material < scene.materials.len(), "{}", instance.name);
        assert!(instance.world_from_local.matrix3.determinant().abs() > 1e-9, "{}", instance.name);
    }
    for mesh in &scene.meshes {
        let count = mesh.positions.len();
        assert!(mesh.normals.len() == count && mesh.tangents.len() == count, "{}", mesh.name);
        assert!(mesh.uvs.iter().all(|uvs| uvs.len() == count), "{}", mesh.name);
        assert!(mesh.colors.is_empty() || mesh.colors.len() == count, "{}", mesh.name);
        assert!(mesh.indices.iter().all(|&i| (i as usize) < count), "{}", mesh.name);
        assert!(mesh.positions.iter().all(|p| p.is_finite()), "{}", mesh.name);
    }
}

#[test]
fn every_scene_of_the_list_opens_by_its_name_with_and_without_the_prefix() {
    assert!(!list().is_empty());
    for entry in list() {
        let scene = open(entry.name).unwrap();
        assert_sound(&scene);
        assert_eq!(scene.name, entry.name);
        let prefixed = open(&format!("gallery:{}", entry.name)).unwrap();
        assert_eq!(prefixed.triangle_count(), scene.triangle_count());
        assert!(entry.params.iter().all(|spec| !spec.help.is_empty()));
    }
}

#[test]
fn errors_list_what_exists() {
    let message = |spec: &str| open(spec).unwrap_err().to_string();
    assert_eq!(message("gallery:workbnch"), "no gallery scene `workbnch`; there are: workbench");
    assert!(message("gallery:").contains("workbench"));
    let unknown = message("gallery:workbench?rough=1");
    assert!(unknown.contains("`rough`") && unknown.contains("roughness, anisotropy"), "{unknown}");
    let range = message("workbench?roughness=2");
    assert!(range.contains("`2`") && range.contains("0 to 1"), "{range}");
    assert!(message("workbench?room=open").contains("closed, none"));
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
