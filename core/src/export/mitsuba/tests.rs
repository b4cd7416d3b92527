//! Exported scenes, read as text. Whether Mitsuba renders them alike is for the test `external`.

use std::fs;
use std::sync::Arc;

use glam::{Affine3A, Mat3, UVec2, Vec3, Vec4};

use super::*;
use crate::file::testing::Folder as Scratch;
use crate::material::preset::{self, FormChoice};
use crate::material::{AlphaMode, Material, Reflectance, Sampler, TextureRef};
use crate::scene::gallery::{self, shape};
use crate::scene::{Image, Instance, Light, LightKind, Texels};
use crate::surface::fresnel::Form;

/// A plate of one material, in an image-less scene unless images are added.
fn plate(material: Material) -> Scene {
    let mesh = shape::plane(1.0, 1.0);
    let instance =
        Instance { name: "plate".into(), mesh: 0, material: 0, world_from_local: Affine3A::IDENTITY, visible: true };
    let texels = Texels::Unorm8((0..16).flat_map(|i| [16 * i as u8, 128, 255, 255 * (i % 2) as u8]).collect());
    let image = Image { name: "checks".into(), width: 4, height: 4, texels };
    Scene {
        meshes: vec![mesh.into()],
        instances: vec![instance],
        materials: vec![material],
        images: vec![Arc::new(image)],
        ..Scene::default()
    }
}

fn texture() -> Option<TextureRef> {
    Some(TextureRef { image: 0, sampler: Sampler::default(), uv_set: 0, transform: Mat3::IDENTITY })
}

fn gold(form: Form) -> Reflectance {
    let fresnel = preset::find("Au").unwrap().fresnel(FormChoice::Of(form).form(&preset::find("Au").unwrap()));
    Reflectance::Preset { id: "Au".into(), fresnel: Arc::new(fresnel) }
}

/// Text of `scene.xml` and the report.
fn exported(scene: &Scene, spectral: bool) -> (String, Report) {
    let scratch = Scratch::new();
    let root = scratch.join("out");
    let camera = Camera::look_at("c", Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO, 0.6);
    let view = View { camera: &camera, size: UVec2::new(32, 16), samples: 4, bounces: 8 };
    let metal = |id: &str| preset::find(id).ok();
    let report = export(scene, &view, &Options { spectral, metal: &metal }, &root).unwrap();
    let text = fs::read_to_string(root.join(MAIN)).unwrap();
    check_shape(&text);
    for file in &report.files {
        assert!(fs::metadata(root.join(file)).unwrap().len() > 0, "{file}");
    }
    for name in text.split("name=\"filename\" value=\"").skip(1) {
        let name = name.split('"').next().unwrap();
        assert!(report.files.iter().any(|file| file == name), "{name} was not written");
    }
    (text, report)
}

/// Every element is closed, every id that is referred to exists, and none exists twice.
fn check_shape(text: &str) {
    let mut open = Vec::new();
    for tag in text.split('<').skip(1).filter(|tag| !tag.starts_with('!')) {
        let name = tag.trim_start_matches('/').split([' ', '>', '/']).next().unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "{tag}");
        } else if !tag.contains("/>") {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
    let ids = |before: &str| -> Vec<String> {
        text.lines()
            .filter(|line| line.trim_start().starts_with(before))
            .filter_map(|line| Some(line.split("id=\"").nth(1)?.split('"').next()?.to_string()))
            .collect()
    };
    let (mut made, used) = (ids("<bsdf"), ids("<ref"));
    assert!(used.iter().all(|id| made.contains(id)), "{used:?} {made:?}");
    let count = made.len();
    made.sort();
    made.dedup();
    assert_eq!(made.len(), count);
}

fn notes(report: &Report) -> String {
    report.notes.iter().map(|n| format!("{}: {} {}\n", n.element, n.loss.word(), n.what)).collect()
}

#[test]
fn every_gallery_scene_is_exported_whole() {
    assert!(!gallery::list().is_empty());
    for entry in gallery::list() {
        let mut scene = gallery::open(entry.name).unwrap();
        scene.environment = Some(Arc::new(gallery::studio()));
        let (text, report) = exported(&scene, false);
        let shapes = scene.instances.iter().filter(|i| i.visible).count();
        assert_eq!(text.matches("<shape").count(), shapes, "{}", entry.name);
        assert!(text.contains("envmap") && report.files.contains(&"textures/environment.exr".to_string()));
    }
}

#[test]
fn a_metal_of_effective_index_is_a_conductor_without_loss() {
    let metal = |roughness| Material {
        reflectance: gold(Form::EffectiveNk),
        roughness,
        double_sided: true,
        ..Material::default()
    };
    let (text, report) = exported(&plate(metal(0.5)), false);
    assert!(text.contains("roughconductor") && text.contains("name=\"alpha_v\" value=\"0.25\""), "{text}");
    assert_eq!(report.notes.iter().map(|n| n.element.as_str()).collect::<Vec<_>>(), ["rough metals"]);
    let (text, report) = exported(&plate(metal(0.02)), false);
    assert!(text.contains("type=\"conductor\"") && report.notes.is_empty(), "{text} {}", notes(&report));
    let (text, _) = exported(&plate(metal(0.5)), true);
    assert!(text.contains("<spectrum name=\"eta\" value=\"360:"), "{text}");
    let spectral = Material { reflectance: gold(Form::Spectral), ..metal(0.5) };
    assert!(notes(&exported(&plate(spectral), false).1).contains("by one index per channel"));
}

#[test]
fn a_base_colour_is_the_metal_of_principled() {
    let metal = Material { metallic: 1.0, roughness: 0.5, anisotropy: 0.5, ..Material::default() };
    let (text, report) = exported(&plate(metal.clone()), false);
    assert!(text.contains("type=\"principled\"") && text.contains("name=\"anisotropic\""), "{text}");
    assert!(!notes(&report).contains("material"), "{}", notes(&report));
    let strong = Material { anisotropy: 1.0, roughness: 0.2, ..metal };
    let (text, report) = exported(&plate(strong), false);
    assert!(text.contains("roughconductor") && notes(&report).contains("one index"), "{text}");
}

#[test]
fn an_exponent_is_a_width_of_beckmann() {
    let model = crate::material::ReflectionModel::ALL[1];
    for reflectance in [gold(Form::EffectiveNk), Reflectance::BaseColor] {
        let metal =
            Material { reflectance, metallic: 1.0, reflection_model: model, exponent: 6.0, ..Material::default() };
        let (text, report) = exported(&plate(metal), false);
        assert!(text.contains("beckmann") && text.contains("name=\"alpha_u\" value=\"0.5\""), "{text}");
        assert!(notes(&report).contains("Blinn-Phong"), "{}", notes(&report));
    }
}

#[test]
fn matte_is_diffuse_and_gloss_is_told_to_be_approximate() {
    let matte = Material { specular: 0.0, double_sided: true, base_color: Vec3::splat(0.5), ..Material::default() };
    let (text, report) = exported(&plate(matte.clone()), false);
    assert!(text.contains("<rgb name=\"reflectance\" value=\"0.5 0.5 0.5\"/>"), "{text}");
    assert!(report.notes.is_empty() && text.contains("twosided"));
    let glossy = Material { specular: 1.0, roughness: 0.5, ..matte };
    let (text, report) = exported(&plate(glossy), false);
    assert!(text.contains("roughplastic") && notes(&report).contains("roughplastic"), "{text}");
}

#[test]
fn textures_are_written_once_with_their_factors() {
    let material = Material {
        metallic: 0.8,
        base_color_texture: texture(),
        metallic_roughness_texture: texture(),
        normal_texture: texture(),
        emission_texture: texture(),
        emission: Vec3::new(3.0, 2.0, 1.0),
        alpha_mode: AlphaMode::Mask { cutoff: 0.5 },
        specular: 0.0,
        ..Material::default()
    };
    let (text, report) = exported(&plate(material), false);
    for part in ["normalmap", "mask", "volpath", "area", "blendbsdf"] {
        assert!(text.contains(&format!("type=\"{part}\"")), "{part}: {text}");
    }
    let pictures: Vec<_> = report.files.iter().filter(|f| f.starts_with("textures/")).collect();
    // The colour and the normal as they are; emission and mask with factors. Metal and roughness are the same everywhere.
    assert_eq!(pictures.iter().filter(|f| f.ends_with(".png")).count(), 2, "{pictures:?}");
    assert_eq!(pictures.len(), 4, "{pictures:?}");
    assert!(notes(&report).contains("cut at texels"), "{}", notes(&report));
}

#[test]
fn what_no_surface_model_holds_is_told() {
    let material = Material {
        reflectance: gold(Form::EffectiveNk),
        coat: 1.0,
        micro_normal: crate::surface::micro_normal::Kind::Hammered,
        ..Material::default()
    };
    let told = notes(&exported(&plate(material), false).1);
    for what in ["clear coat", "bumps", "backs of one-sided"] {
        assert!(told.contains(what), "{told}");
    }
}

#[test]
fn lights_with_an_area_are_shapes_that_face_as_they_shine() {
    let mut scene = plate(Material::default());
    let light = |kind| Light { position: Vec3::Y, direction: Vec3::NEG_Y, camera: true, kind, ..Light::default() };
    let rectangle = |size| LightKind::Rectangle { across: Vec3::X, size };
    scene.lights = vec![
        light(rectangle(glam::Vec2::new(2.0, 4.0))),
        light(LightKind::Sphere { radius: 0.25 }),
        light(rectangle(glam::Vec2::ZERO)),
        light(LightKind::Directional { angular_radius: 0.01 }),
    ];
    let (text, report) = exported(&scene, false);
    assert_eq!(text.matches("type=\"rectangle\"").count(), 1, "{text}");
    // Rows: its x is -across, its y up, its z the direction, then the centre.
    assert!(text.contains("value=\"-1 0 0 0 0 0 -1 1 0 -2 0 0 0 0 0 1\""), "{text}");
    assert!(text.contains("<float name=\"radius\" value=\"0.25\""), "{text}");
    assert_eq!(text.matches("type=\"area\"").count(), 2, "{text}");
    assert_eq!(notes(&report).matches("hides what is behind").count(), 2, "{}", notes(&report));
    assert_eq!(notes(&report).matches("its angle").count(), 1, "{}", notes(&report));
}

#[test]
fn lamps_keep_their_units_and_lose_their_range() {
    let mut scene = plate(Material::default());
    let light = |kind, range| Light {
        name: "l".into(),
        position: Vec3::Y,
        direction: Vec3::NEG_Y,
        intensity: Vec3::new(1.0, 2.0, 3.0),
        range,
        kind,
        ..Light::default()
    };
    let spot = LightKind::Spot { inner_angle: 0.2, outer_angle: 0.4 };
    scene.lights = vec![light(LightKind::Point, 5.0), light(spot, f32::INFINITY), light(LightKind::PARALLEL, 1.0)];
    let (text, report) = exported(&scene, false);
    for part in ["name=\"intensity\" value=\"1 2 3\"", "name=\"irradiance\" value=\"1 2 3\"", "type=\"spot\""] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(notes(&report).matches("its range").count(), 1, "{}", notes(&report));
}

#[test]
fn names_cannot_break_out() {
    let evil = "x\"/><shape type=\"sphere\"/><!-- $a ../../\u{0}\n";
    let mut scene = plate(Material { name: evil.into(), base_color_texture: texture(), ..Material::default() });
    Arc::make_mut(&mut scene.meshes[0]).name = evil.into();
    Arc::make_mut(&mut scene.images[0]).name = evil.into();
    scene.instances[0].name = evil.into();
    let (text, report) = exported(&scene, false);
    assert_eq!(text.matches("<shape").count(), 1);
    assert!(!text.contains('$') && !text.contains("..") && !text.contains("sphere\""), "{text}");
    assert!(report.files.iter().all(|file| !file.contains("..")), "{:?}", report.files);
}

#[test]
fn hidden_instances_and_holes_leave_nothing() {
    let mut scene =
        plate(Material { alpha_mode: AlphaMode::Mask { cutoff: 0.5 }, opacity: 0.2, ..Material::default() });
    assert_eq!(exported(&scene, false).0.matches("<shape").count(), 0);
    scene.materials[0].opacity = 1.0;
    assert_eq!(exported(&scene, false).0.matches("<shape").count(), 1);
    scene.instances[0].visible = false;
    assert_eq!(exported(&scene, false).0.matches("<shape").count(), 0);
}

#[test]
fn a_mesh_is_written_once_for_each_way_it_is_used() {
    let mut scene = plate(Material { reflectance: gold(Form::EffectiveNk), ..Material::default() });
    let again = |by| Instance { world_from_local: by, ..scene.instances[0].clone() };
    let moved = [
        again(Affine3A::from_translation(Vec3::X)),
        again(Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0))),
        again(Affine3A::from_scale(Vec3::new(1.0, -1.0, 1.0))),
    ];
    scene.instances.extend(moved);
    let (text, report) = exported(&scene, false);
    assert_eq!(text.matches("<shape").count(), 4);
    assert_eq!(report.files.iter().filter(|f| f.ends_with(".ply")).count(), 2, "{:?}", report.files);
    // Colours of vertices count under a base colour only.
    let mesh = Arc::make_mut(&mut scene.meshes[0]);
    mesh.colors = vec![Vec4::splat(0.5); mesh.positions.len()];
    assert!(!exported(&scene, false).0.contains("vertex_color"));
    scene.materials[0] = Material { specular: 0.0, ..Material::default() };
    assert!(exported(&scene, false).0.contains("vertex_color"));
}
