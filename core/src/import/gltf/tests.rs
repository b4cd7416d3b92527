use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use glam::{Mat3, Vec2, Vec3, Vec4};
use serde_json::{Value, json};

use crate::import::{ImportError, ImportOptions, Imported, ResolveError, Resolver, scene_from_bytes};
use crate::material::{AlphaMode, Filter, Wrap};
use crate::scene::{LightKind, Projection, Texels};

/// No files at all.
struct Nothing;

impl Resolver for Nothing {
    fn read(&self, uri: &str, _budget: u64) -> Result<Vec<u8>, ResolveError> {
        Err(ResolveError::Missing { uri: uri.into() })
    }
}

fn read(value: &Value) -> Result<Imported, ImportError> {
    scene_from_bytes(value.to_string().as_bytes(), "m.gltf", &Nothing, &ImportOptions::default())
}

fn refusal(value: &Value) -> String {
    read(value).unwrap_err().to_string()
}

fn data_uri(bytes: &[u8]) -> String {
    format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(bytes))
}

fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

/// A model of one mesh: a right triangle in the xy plane. Parts are changed by the tests.
fn triangle() -> Value {
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "n" }],
        "meshes": [{ "name": "body", "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "byteLength": 36, "uri": data_uri(&bytes_of(&[0., 0., 0., 1., 0., 0., 0., 1., 0.])) }],
    })
}

/// Adds a buffer with its view and an accessor over it; returns the accessor's index.
fn add(model: &mut Value, bytes: &[u8], mut accessor: Value) -> usize {
    let push = |list: &mut Value, item: Value| {
        let list = list.as_array_mut().unwrap();
        list.push(item);
        list.len() - 1
    };
    let buffer = push(&mut model["buffers"], json!({ "byteLength": bytes.len(), "uri": data_uri(bytes) }));
    let view = push(&mut model["bufferViews"], json!({ "buffer": buffer, "byteLength": bytes.len() }));
    accessor["bufferView"] = view.into();
    push(&mut model["accessors"], accessor)
}

fn attribute(model: &mut Value, name: &str, accessor: usize) {
    model["meshes"][0]["primitives"][0]["attributes"][name] = accessor.into();
}

#[test]
fn a_triangle_without_anything_is_flat_and_of_white_metal() {
    let imported = read(&triangle()).unwrap();
    let scene = &imported.scene;
    assert_eq!((scene.triangle_count(), scene.name.as_str()), (1, "m"));
    assert_eq!(scene.meshes[0].normals, [Vec3::Z; 3]);
    assert_eq!(scene.instances[0].name, "n");
    let material = &scene.materials[scene.instances[0].material];
    assert_eq!((material.metallic, material.roughness, material.base_color), (1.0, 1.0, Vec3::ONE));
    assert!(imported.notices.is_empty(), "{:?}", imported.notices);
}

#[test]
fn strips_and_fans_keep_all_triangles_facing_one_way() {
    // A strip of four corners in zigzag and a fan around a corner, both of a quad that faces +z.
    for (mode, corners) in
        [(5, [[0., 0.], [1., 0.], [0., 1.], [1., 1.]]), (6, [[0., 0.], [1., 0.], [1., 1.], [0., 1.]])]
    {
        let mut model = triangle();
        let positions: Vec<f32> = corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]).collect();
        let accessor = json!({ "componentType": 5126, "type": "VEC3", "count": 4 });
        let index = add(&mut model, &bytes_of(&positions), accessor);
        attribute(&mut model, "POSITION", index);
        model["meshes"][0]["primitives"][0]["mode"] = mode.into();
        let mesh = &read(&model).unwrap().scene.meshes[0];
        assert_eq!(mesh.indices.len(), 6, "mode {mode}");
        assert!(mesh.normals.iter().all(|n| *n == Vec3::Z), "mode {mode}: {:?}", mesh.normals);
    }
}

#[test]
fn interleaved_and_normalised_attributes_are_read() {
    let mut model = triangle();
    // Per vertex: uv as normalised u16, then a colour as normalised u8, 8 bytes apart.
    let mut bytes = Vec::new();
    for (u, v) in [(0_u16, 0_u16), (65535, 0), (0, 32768)] {
        bytes.extend(u.to_le_bytes());
        bytes.extend(v.to_le_bytes());
        bytes.extend([255, 51, 0, 128]);
    }
    let uv = json!({ "componentType": 5123, "normalized": true, "type": "VEC2", "count": 3 });
    let uv = add(&mut model, &bytes, uv);
    let view = model["bufferViews"].as_array().unwrap().len() - 1;
    model["bufferViews"][view]["byteStride"] = 8.into();
    let mut colour = json!({ "componentType": 5121, "normalized": true, "type": "VEC4", "count": 3 });
    colour["bufferView"] = view.into();
    colour["byteOffset"] = 4.into();
    model["accessors"].as_array_mut().unwrap().push(colour);
    attribute(&mut model, "TEXCOORD_0", uv);
    attribute(&mut model, "COLOR_0", uv + 1);
    let mesh = &read(&model).unwrap().scene.meshes[0];
    assert_eq!(mesh.uvs[0][1], Vec2::X);
    assert!((mesh.uvs[0][2].y - 0.5).abs() < 1e-4);
    assert!(mesh.colors[0].abs_diff_eq(Vec4::new(1.0, 0.2, 0.0, 128.0 / 255.0), 1e-6), "{}", mesh.colors[0]);
}

#[test]
fn every_component_type_of_indices_and_signed_normals_is_read() {
    for (kind, bytes) in
        [(5121, vec![2_u8, 1, 0]), (5123, vec![2, 0, 1, 0, 0, 0]), (5125, vec![2, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0])]
    {
        let mut model = triangle();
        let indices = add(&mut model, &bytes, json!({ "componentType": kind, "type": "SCALAR", "count": 3 }));
        model["meshes"][0]["primitives"][0]["indices"] = indices.into();
        let normals = json!({ "componentType": 5120, "normalized": true, "type": "VEC3", "count": 3 });
        let normals = add(&mut model, &[0, 0, 0x81, 0, 0, 0x80, 0, 0, 0x81], normals);
        attribute(&mut model, "NORMAL", normals);
        let mesh = &read(&model).unwrap().scene.meshes[0];
        assert_eq!(mesh.indices, [2, 1, 0]);
        assert_eq!(mesh.normals, [-Vec3::Z; 3]);
    }
}

#[test]
fn a_sparse_part_replaces_elements_of_a_view_or_of_zeros() {
    for with_view in [true, false] {
        let mut model = triangle();
        let place =
            add(&mut model, &1_u16.to_le_bytes(), json!({ "componentType": 5123, "type": "SCALAR", "count": 1 }));
        add(&mut model, &bytes_of(&[5., 6., 7.]), json!({ "componentType": 5126, "type": "VEC3", "count": 1 }));
        model["accessors"][0]["sparse"] = json!({
            "count": 1,
            "indices": { "bufferView": place, "componentType": 5123 },
            "values": { "bufferView": place + 1 },
        });
        if !with_view {
            model["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        }
        let positions = &read(&model).unwrap().scene.meshes[0].positions;
        let last = if with_view { Vec3::Y } else { Vec3::ZERO };
        assert_eq!(positions[..], [Vec3::ZERO, Vec3::new(5.0, 6.0, 7.0), last]);
    }
}

#[test]
fn transforms_multiply_down_the_hierarchy_with_mirroring() {
    let mut model = triangle();
    let half = 0.5_f32.sqrt();
    model["nodes"] = json!([
        { "children": [1], "translation": [1, 2, 3], "rotation": [0, 0, half, half] },
        { "children": [2], "scale": [-2, 1, 1] },
        { "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1] },
    ]);
    let transform = read(&model).unwrap().scene.instances[0].world_from_local;
    assert!(transform.matrix3.determinant() < 0.0);
    // x = 10, mirrored and doubled to -20, turned by a quarter to y = -20, moved.
    assert!(transform.transform_point3(Vec3::ZERO).abs_diff_eq(Vec3::new(1.0, -18.0, 3.0), 1e-5));
}

#[test]
fn the_scene_is_the_chosen_one_then_the_first_then_all_roots() {
    let mut model = triangle();
    model["nodes"] = json!([{ "mesh": 0, "name": "a" }, { "children": [2] }, { "mesh": 0, "name": "b" }]);
    model["scenes"] = json!([{ "nodes": [0] }, { "nodes": [1] }]);
    let names =
        |model: &Value| -> Vec<String> { read(model).unwrap().scene.instances.into_iter().map(|i| i.name).collect() };
    model["scene"] = 1.into();
    assert_eq!(names(&model), ["b"]);
    model.as_object_mut().unwrap().remove("scene");
    assert_eq!(names(&model), ["a"]);
    model.as_object_mut().unwrap().remove("scenes");
    assert_eq!(names(&model), ["a", "b"]);
    // The mesh is stored once.
    assert_eq!(read(&model).unwrap().scene.meshes.len(), 1);
}

#[test]
fn lights_and_cameras_come_to_world_space_without_scale() {
    let mut model = triangle();
    let half = 0.5_f32.sqrt();
    // A quarter turn about x brings -z to +y.
    let turned = json!({ "rotation": [half, 0, 0, half], "scale": [3, 3, 3], "translation": [0, 0, 5] });
    let mut nodes = vec![json!({ "mesh": 0 })];
    for light in 0..3 {
        let mut node = turned.clone();
        node["extensions"] = json!({ "KHR_lights_punctual": { "light": light } });
        nodes.push(node);
    }
    let mut node = turned.clone();
    node["camera"] = 0.into();
    nodes.push(node);
    model["nodes"] = nodes.into();
    model["scenes"] = json!([{ "nodes": [0, 1, 2, 3, 4] }]);
    model["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 }, "name": "eye" }]);
    model["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    model["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "spot", "color": [1, 0.5, 0], "intensity": 10, "range": 4, "spot": { "outerConeAngle": 0.5 } },
        { "type": "point" },
        { "type": "directional", "intensity": 2, "name": "sun" },
    ] } });
    let imported = read(&model).unwrap();
    let [spot, point, sun] = &imported.scene.lights[..] else { panic!() };
    assert_eq!(spot.kind, LightKind::Spot { inner_angle: 0.0, outer_angle: 0.5 });
    assert_eq!((spot.intensity, spot.range), (Vec3::new(10.0, 5.0, 0.0), 4.0));
    assert!(spot.direction.abs_diff_eq(Vec3::Y, 1e-6) && spot.position == Vec3::new(0.0, 0.0, 5.0));
    assert_eq!((point.kind, point.range), (LightKind::Point, f32::INFINITY));
    assert_eq!((sun.kind, sun.name.as_str(), sun.intensity), (LightKind::PARALLEL, "sun", Vec3::splat(2.0)));
    let camera = &imported.scene.cameras[0];
    assert_eq!(camera.projection, Projection::Perspective { yfov: 0.8, near: 0.1 });
    assert!((camera.world_from_view.matrix3.determinant() - 1.0).abs() < 1e-6);
    assert!(camera.world_from_view.transform_vector3(-Vec3::Z).abs_diff_eq(Vec3::Y, 1e-6));
    assert!(imported.notices.is_empty(), "{:?}", imported.notices);
}

/// A PNG of one texel in 16 bits a channel.
fn png() -> String {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let pixel = image::ImageBuffer::from_pixel(1, 1, image::Rgb([0_u16, 300, 65535]));
    image::DynamicImage::ImageRgb16(pixel).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    format!("data:image/png;base64,{}", BASE64_STANDARD.encode(bytes.into_inner()))
}

#[test]
fn every_field_of_a_material_arrives() {
    let mut model = triangle();
    model["images"] = json!([{ "uri": png() }]);
    model["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9986 }]);
    model["textures"] = json!([{ "source": 0, "sampler": 0 }, { "source": 0 }]);
    model["meshes"][0]["primitives"][0]["material"] = 0.into();
    let info = |index: u32| json!({ "index": index, "texCoord": 1 });
    model["materials"] = json!([{
        "name": "all",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
            "baseColorTexture": { "index": 0, "extensions": { "KHR_texture_transform": {
                "offset": [0.5, 0.25], "rotation": FRAC_PI_2, "scale": [2, 3], "texCoord": 1 } } },
            "metallicRoughnessTexture": info(1),
        },
        "normalTexture": { "index": 1, "scale": 0.7, "extensions": { "KHR_texture_transform": { "scale": [4, 4] } } },
        "occlusionTexture": { "index": 1, "strength": 0.8 },
        "emissiveFactor": [1, 0.5, 0], "emissiveTexture": info(1),
        "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "extensions": {
            "KHR_materials_unlit": {},
            "KHR_materials_ior": { "ior": 1.7 },
            "KHR_materials_emissive_strength": { "emissiveStrength": 4 },
            "KHR_materials_specular": { "specularFactor": 0.9, "specularTexture": info(1),
                "specularColorFactor": [2, 1, 1], "specularColorTexture": info(1) },
            "KHR_materials_clearcoat": { "clearcoatFactor": 0.3, "clearcoatTexture": info(1),
                "clearcoatRoughnessFactor": 0.2, "clearcoatRoughnessTexture": info(1),
                "clearcoatNormalTexture": { "index": 1, "scale": 0.1 } },
            "KHR_materials_anisotropy": { "anisotropyStrength": 0.4, "anisotropyRotation": 1.5,
                "anisotropyTexture": info(1) },
        },
    }]);
    let imported = read(&model).unwrap();
    let m = &imported.scene.materials[0];
    assert_eq!((m.base_color, m.opacity), (Vec3::new(0.1, 0.2, 0.3), 0.4));
    assert_eq!((m.metallic, m.roughness, m.normal_scale, m.occlusion_strength), (0.5, 0.6, 0.7, 0.8));
    assert_eq!((m.emission, m.alpha_mode), (Vec3::new(4.0, 2.0, 0.0), AlphaMode::Mask { cutoff: 0.25 }));
    assert!(m.double_sided && m.unlit);
    assert_eq!((m.ior, m.specular, m.specular_color), (1.7, 0.9, Vec3::new(2.0, 1.0, 1.0)));
    assert_eq!((m.coat, m.coat_roughness, m.coat_normal_scale), (0.3, 0.2, 0.1));
    assert_eq!((m.anisotropy, m.anisotropy_rotation), (0.4, 1.5));
    let infos = [m.metallic_roughness_texture, m.emission_texture, m.specular_texture, m.specular_color_texture];
    let more = [m.coat_texture, m.coat_roughness_texture, m.anisotropy_texture];
    assert!(infos.iter().chain(&more).all(|t| t.is_some_and(|t| t.uv_set == 1)));
    assert_eq!(m.normal_texture.unwrap().transform, Mat3::from_diagonal(Vec3::new(4.0, 4.0, 1.0)));
    assert!(m.occlusion_texture.is_some() && m.coat_normal_texture.is_some());

    let base = m.base_color_texture.unwrap();
    assert_eq!(base.uv_set, 1);
    // Scale, then a quarter turn that takes u to -v, then the offset.
    assert!((base.transform * Vec3::new(1.0, 0.0, 1.0)).abs_diff_eq(Vec3::new(0.5, -1.75, 1.0), 1e-6));
    assert!((base.transform * Vec3::new(0.0, 1.0, 1.0)).abs_diff_eq(Vec3::new(3.5, 0.25, 1.0), 1e-6));
    let s = base.sampler;
    assert_eq!((s.wrap_u, s.wrap_v, s.magnify), (Wrap::Clamp, Wrap::Mirror, Filter::Nearest));
    assert_eq!((s.minify, s.mip), (Filter::Nearest, Some(Filter::Linear)));
    assert!(matches!(&imported.scene.images[0].texels, Texels::Unorm16(t) if t[..] == [0, 300, 65535, 65535]));
}

#[test]
fn values_out_of_range_and_broken_textures_are_noticed_and_the_picture_comes_out() {
    let mut model = triangle();
    model["images"] = json!([{ "uri": "gone.png" }, { "uri": "data:image/png;base64,AAAA" }]);
    model["samplers"] = json!([{ "wrapS": 99 }]);
    model["textures"] = json!([{ "source": 0 }, { "source": 1 }, { "source": 7 }, {}]);
    model["materials"] = json!([{
        "pbrMetallicRoughness": { "roughnessFactor": 2, "metallicFactor": -1, "baseColorTexture": { "index": 0 },
            "metallicRoughnessTexture": { "index": 1 } },
        "emissiveTexture": { "index": 2 }, "occlusionTexture": { "index": 9 }, "normalTexture": { "index": 3 },
        "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": "much" } },
    }]);
    model["meshes"][0]["primitives"][0]["material"] = 0.into();
    let imported = read(&model).unwrap();
    let m = &imported.scene.materials[0];
    assert_eq!((m.roughness, m.metallic), (1.0, 0.0));
    let text: Vec<String> = imported.notices.iter().map(ToString::to_string).collect();
    let text = text.join("\n");
    for words in [
        "m.gltf: image 0 'gone.png': the texture is left out: gone.png does not exist",
        "image 1: the texture is left out: the content is unknown binary data, not a PNG or JPEG",
        "material 0, emissive texture: the texture is left out: image 7 does not exist",
        "material 0, occlusion texture: the texture is left out: texture 9 does not exist (there are 4)",
        "material 0, normal texture: the texture is left out: it names no PNG or JPEG",
        "roughnessFactor was 2; 1 is used",
        "metallicFactor was -1; 0 is used",
        "KHR_materials_clearcoat is left out",
    ] {
        assert!(text.contains(words), "{text}\nlacks {words}");
    }
}

#[test]
fn what_is_not_shown_is_noticed() {
    let mut model = triangle();
    let primitives = model["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives[0]["targets"] = json!([{ "POSITION": 0 }]);
    primitives.push(json!({ "mode": 1, "attributes": { "POSITION": 0 } }));
    primitives.push(json!({ "attributes": {} }));
    model["nodes"] = json!([{ "mesh": 0, "skin": 0 }, { "mesh": 0, "scale": [0, 0, 0] }]);
    model["scenes"] = json!([{ "nodes": [0, 1] }]);
    model["skins"] = json!([{ "joints": [0] }]);
    model["extensionsUsed"] = json!(["KHR_materials_pbrSpecularGlossiness", "EXT_other"]);
    let text: Vec<String> = read(&model).unwrap().notices.iter().map(ToString::to_string).collect();
    let text = text.join("\n");
    for words in [
        "mesh 0 'body', primitive 1: points and lines are not shown",
        "mesh 0 'body', primitive 2: a primitive without positions",
        "morph targets are not applied",
        "skins are not played; the model is shown at rest",
        "node 1: meshes whose transform cannot be inverted",
        "KHR_materials_pbrSpecularGlossiness",
        "the extension 'EXT_other' is not supported",
    ] {
        assert!(text.contains(words), "{text}\nlacks {words}");
    }
}

#[test]
fn spot_angles_are_brought_into_order() {
    let mut model = triangle();
    model["nodes"][0]["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
    for (spot, expected) in [
        (json!({ "innerConeAngle": 1.0, "outerConeAngle": 0.5 }), (0.499, 0.5)),
        (json!({ "outerConeAngle": 3.0 }), (0.0, FRAC_PI_2)),
        (json!(null), (0.0, FRAC_PI_4)),
    ] {
        model["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": spot }] } });
        let light = &read(&model).unwrap().scene.lights[0];
        let LightKind::Spot { inner_angle, outer_angle } = light.kind else { panic!() };
        assert!((inner_angle - expected.0).abs() < 1e-6 && outer_angle == expected.1, "{:?}", light.kind);
    }
}

#[test]
fn all_faults_of_a_model_are_listed_at_once() {
    let mut model = triangle();
    let positions =
        add(&mut model, &bytes_of(&[f32::NAN; 9]), json!({ "componentType": 5126, "type": "VEC3", "count": 3 }));
    let indices = add(&mut model, &[0, 1, 9], json!({ "componentType": 5121, "type": "SCALAR", "count": 3 }));
    let primitives = model["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({ "attributes": { "POSITION": positions } }));
    primitives.push(json!({ "attributes": { "POSITION": 0, "NORMAL": 77 }, "indices": indices }));
    let text = refusal(&model);
    for words in [
        "m.gltf: mesh 0 'body', primitive 1, accessor 1 (POSITION): element 0 is not finite, and so are 3 in all",
        "mesh 0 'body', primitive 2, accessor 77 (NORMAL): accessor 77 does not exist (there are 3)",
        "mesh 0 'body', primitive 2, accessor 2 (indices): vertex 9 does not exist (there are 3); export",
    ] {
        assert!(text.contains(words), "{text}\nlacks {words}");
    }
}
