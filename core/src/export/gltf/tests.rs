use std::path::Path;

use serde_json::Value;

use super::*;
use crate::import::{FolderResolver, ImportOptions, Imported, scene_from_bytes};
use crate::material::{Material, Reflectance};
use crate::scene::{Light, LightKind, Texels, gallery};

fn read_back(glb: &[u8]) -> Imported {
    let folder = FolderResolver::beside(Path::new("./scene.glb")).unwrap();
    scene_from_bytes(glb, "scene.glb", &folder, &ImportOptions::default()).unwrap()
}

/// The JSON of a file, whose chunks are checked on the way.
fn parts(glb: &[u8]) -> (Value, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
    let json = word(12);
    assert!(json.is_multiple_of(4) && &glb[16..20] == b"JSON");
    let rest = &glb[20 + json..];
    assert!(&rest[4..8] == b"BIN\0" && (rest.len() - 8).is_multiple_of(4));
    (serde_json::from_slice(&glb[20..20 + json]).unwrap(), &rest[8..])
}

fn near(a: Vec3, b: Vec3) {
    assert!((a - b).abs().max_element() <= 1e-6 * b.abs().max_element().max(1e-6), "{a} for {b}");
}

fn same_material(a: &Material, b: &Material) {
    assert_eq!(a.name, b.name);
    let color = match &b.reflectance {
        Reflectance::Preset { fresnel, .. } => fresnel.f0().clamp(Vec3::ZERO, Vec3::ONE),
        Reflectance::BaseColor => b.base_color,
    };
    near(a.base_color, color);
    near(a.emission, b.emission);
    near(a.specular_color, b.specular_color);
    let numbers = |m: &Material| [m.roughness, m.opacity, m.ior, m.specular, m.coat, m.coat_roughness, m.anisotropy];
    assert_eq!(numbers(a), numbers(b), "{}", a.name);
    assert_eq!((a.alpha_mode, a.double_sided, a.unlit), (b.alpha_mode, b.double_sided, b.unlit));
    let (textures, others) = (a.textures(), b.textures());
    let is_metal = matches!(b.reflectance, Reflectance::Preset { .. });
    for (found, wanted) in textures.iter().zip(&others).skip(usize::from(is_metal)) {
        assert_eq!(found.is_some(), wanted.is_some());
        let (Some(found), Some(wanted)) = (found, wanted) else { continue };
        assert_eq!((found.image, found.sampler, found.uv_set), (wanted.image, wanted.sampler, wanted.uv_set));
        let largest = wanted.transform.to_cols_array().into_iter().fold(1.0f32, |a, b| a.max(b.abs()));
        assert!((found.transform - wanted.transform).to_cols_array().iter().all(|d| d.abs() <= 1e-6 * largest));
    }
}

#[test]
fn every_scene_of_the_gallery_comes_back_as_it_was() {
    for entry in gallery::list() {
        let scene = gallery::open(entry.name).unwrap();
        let Encoded { glb, report } = encode(&scene).unwrap();
        let Imported { scene: back, notices } = read_back(&glb);
        assert!(notices.is_empty(), "{}: {notices:?}", entry.name);
        assert_eq!(back.instances.len(), scene.instances.len(), "{}", entry.name);
        for (a, b) in back.instances.iter().zip(&scene.instances) {
            assert_eq!((&a.name, a.material, a.world_from_local), (&b.name, b.material, b.world_from_local));
            let (mesh, other) = (&back.meshes[a.mesh], &scene.meshes[b.mesh]);
            assert_eq!((&mesh.positions, &mesh.indices), (&other.positions, &other.indices), "{}", b.name);
            let colors = if is_opaque_metal(&scene.materials[b.material]) { &Vec::new() } else { &other.colors };
            assert_eq!((&mesh.uvs, &mesh.colors), (&other.uvs, colors), "{}", b.name);
            let off = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
            assert!(off(&mesh.normals, &other.normals) < 1e-6 && mesh.normals.len() == other.normals.len());
            assert_eq!(mesh.tangents.len(), other.tangents.len());
        }
        scene.materials.iter().zip(&back.materials).for_each(|(b, a)| same_material(a, b));
        for (a, b) in back.lights.iter().zip(&scene.lights) {
            near(a.intensity, b.intensity);
            near(a.position, b.position);
            assert!((a.kind == b.kind && a.range == b.range) && a.direction.distance(b.direction) < 1e-6);
        }
        assert_eq!((back.lights.len(), back.cameras.len()), (scene.lights.len(), scene.cameras.len()));
        for (a, b) in back.cameras.iter().zip(&scene.cameras) {
            assert_eq!((&a.name, a.projection), (&b.name, b.projection));
            assert!(a.world_from_view.abs_diff_eq(b.world_from_view, 1e-6));
        }
        for (a, b) in back.images.iter().zip(&scene.images) {
            assert!((a.width, a.height) == (b.width, b.height) && a.name.contains(&b.name));
            match (&a.texels, &b.texels) {
                (Texels::Unorm8(a), Texels::Unorm8(b)) => assert!(a == b),
                (Texels::Unorm16(a), Texels::Unorm16(b)) => assert!(a == b),
                _ => panic!("another depth"),
            }
        }
        let is_told = |word: &str| report.notes.iter().any(|note| note.what.contains(word));
        let has_metal = scene.materials.iter().any(|m| matches!(m.reflectance, Reflectance::Preset { .. }));
        assert_eq!(is_told("curve of"), has_metal, "{}", entry.name);
        assert_eq!(is_told("environments"), scene.environment.is_some());
    }
}

#[test]
fn chunks_and_views_are_aligned_and_only_what_is_used_is_declared() {
    let scene = gallery::open("workbench").unwrap();
    let glb = encode(&scene).unwrap().glb;
    let (json, bytes) = parts(&glb);
    assert_eq!(json["buffers"][0]["byteLength"].as_u64().unwrap() as usize, bytes.len());
    for view in json["bufferViews"].as_array().unwrap() {
        let (start, length) = (view["byteOffset"].as_u64().unwrap(), view["byteLength"].as_u64().unwrap());
        assert!(start.is_multiple_of(4) && (start + length) as usize <= bytes.len());
    }
    let text = json.to_string();
    let used = json["extensionsUsed"].as_array().unwrap();
    for name in used {
        assert!(text.matches(name.as_str().unwrap()).count() > 1, "{name} is used");
    }
    assert!(text.contains("KHR_materials_clearcoat") && used.contains(&"KHR_materials_clearcoat".into()));
    assert!(json.get("skins").is_none() && json["asset"]["version"] == "2.0");
}

#[test]
fn punctual_lights_keep_intensity_range_and_cone() {
    let intensity = Vec3::new(0.37, 812.5, 21.0);
    let light = |kind, range| Light {
        name: "l".into(),
        position: Vec3::new(0.3, -2.0, 7.0),
        direction: Vec3::new(0.48, -0.6, 0.64),
        intensity,
        range,
        kind,
        ..Light::default()
    };
    let spot = LightKind::Spot { inner_angle: 0.2, outer_angle: 0.9 };
    let kinds = [(LightKind::Point, 5.0), (spot, f32::INFINITY), (LightKind::PARALLEL, f32::INFINITY)];
    let mut scene = gallery::open("workbench").unwrap();
    scene.lights = kinds.map(|(kind, range)| light(kind, range)).to_vec();
    let Encoded { glb, report } = encode(&scene).unwrap();
    assert!(!report.notes.iter().any(|note| note.element.starts_with("light")), "{:?}", report.notes);
    let back = read_back(&glb).scene.lights;
    assert_eq!(back.len(), 3);
    for (a, b) in back.iter().zip(&scene.lights) {
        assert!((a.intensity / b.intensity - 1.0).abs().max_element() < 1e-5, "{a:?}");
        assert!(a.direction.distance(b.direction) < 1e-6, "{a:?}");
        assert_eq!((a.kind, a.range), (b.kind, b.range));
        assert_eq!((&a.name, a.camera, a.reflections, a.shadows), (&b.name, false, true, true));
    }
}

#[test]
fn lights_with_a_size_become_the_nearest_without_and_are_told() {
    let mut scene = gallery::open("workbench").unwrap();
    let light = |kind| Light { intensity: Vec3::splat(100.0), kind, ..Light::default() };
    let rectangle = LightKind::Rectangle { across: Vec3::X, size: glam::Vec2::new(0.5, 0.4) };
    let sun = LightKind::Directional { angular_radius: 0.005 };
    scene.lights = vec![light(rectangle), light(LightKind::Sphere { radius: 0.1 }), light(sun)];
    scene.lights[2].unlit = vec![1];
    let Encoded { glb, report } = encode(&scene).unwrap();
    let back = read_back(&glb).scene.lights;
    near(back[0].intensity, Vec3::splat(20.0));
    near(back[1].intensity, Vec3::splat(std::f32::consts::PI));
    near(back[2].intensity, Vec3::splat(100.0));
    assert!(matches!(back[0].kind, LightKind::Spot { .. }));
    assert_eq!((back[1].kind, back[2].kind), (LightKind::Point, LightKind::PARALLEL));
    let told = |i: usize| report.notes.iter().filter(|n| n.element.starts_with(&format!("light {i}"))).count();
    assert_eq!([0, 1, 2].map(told), [1, 1, 2]);
}

#[test]
fn what_cannot_be_held_is_noted() {
    let mut scene = gallery::open("workbench").unwrap();
    scene.instances[2].visible = false;
    scene.materials[0].micro_normal = crate::surface::micro_normal::Kind::Hammered;
    let Encoded { glb, report } = encode(&scene).unwrap();
    let told: Vec<&str> = report.notes.iter().map(|note| note.what.as_str()).collect();
    assert!(told.iter().any(|what| what.contains("hidden")) && told.contains(&"procedural bumps"), "{told:?}");
    assert_eq!(read_back(&glb).scene.instances.len(), scene.instances.len() - 1);
}

#[test]
fn a_turned_and_scaled_texture_keeps_its_transform_and_a_sheared_one_is_told() {
    let turned = Mat3::from_translation(glam::Vec2::new(0.3, -2.0))
        * Mat3::from_angle(-0.7)
        * Mat3::from_scale(glam::Vec2::new(2.0, 3.0));
    let mut scene = gallery::open("room").unwrap();
    let slot = scene.materials.iter().position(|m| m.base_color_texture.is_some()).unwrap();
    let with = |scene: &mut Scene, transform| {
        if let Some(texture) = &mut scene.materials[slot].base_color_texture {
            texture.transform = transform;
        }
        encode(scene).unwrap()
    };
    let Encoded { glb, report } = with(&mut scene, turned);
    let back = read_back(&glb).scene.materials[slot].base_color_texture.unwrap().transform;
    assert!(back.abs_diff_eq(turned, 1e-5) && !report.notes.iter().any(|note| note.what.contains("shear")));
    let mut sheared = turned;
    sheared.y_axis.x += 1.0;
    assert!(with(&mut scene, sheared).report.notes.iter().any(|note| note.what.contains("shear")));
}
