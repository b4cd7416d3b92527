//! Accessors, node graphs, geometry, materials and pictures.

use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::sources::{PNG, notices, percent, read, refused, refused_bytes, triangle};

/// Adds a buffer, a view and an accessor over `bytes`.
fn add(model: &mut Value, bytes: &[u8], mut accessor: Value) -> usize {
    let buffer = model["buffers"].as_array().expect("a list").len();
    let push = |list: &mut Value, item: Value| list.as_array_mut().expect("a list").push(item);
    push(&mut model["buffers"], json!({ "byteLength": bytes.len(), "uri": percent(bytes) }));
    push(&mut model["bufferViews"], json!({ "buffer": buffer, "byteLength": bytes.len() }));
    accessor["bufferView"] = buffer.into();
    push(&mut model["accessors"], accessor);
    buffer
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()).collect()
}

const AT: &str = "mesh 0 'body', primitive 0, accessor 0 (POSITION)";

#[test]
fn accessors_past_their_view_their_buffer_or_all_memory_are_refused() {
    let mut model = triangle();
    model["accessors"][0]["count"] = 1000.into();
    refused(&model, &[AT, "1000 elements from byte 0 pass the end of buffer view 0 (36 bytes)"]);
    model["accessors"][0]["count"] = (1_u64 << 61).into();
    refused(&model, &[AT, "asks for 2305843009213693952 vertices"]);
    model["accessors"][0]["count"] = 0.into();
    refused(&model, &[AT, "states 0 elements"]);
    for offset in [1_u64 << 32, u64::MAX, u64::MAX - 35] {
        let mut model = triangle();
        model["accessors"][0]["byteOffset"] = offset.into();
        refused(&model, &[AT, "pass the end of buffer view 0"]);
        let mut model = triangle();
        model["bufferViews"][0]["byteOffset"] = offset.into();
        refused(&model, &[AT, "buffer view 0", "pass the end of buffer 0 (36 bytes)"]);
    }
    let mut model = triangle();
    model["bufferViews"][0]["byteStride"] = 4.into();
    refused(&model, &[AT, "a stride of 4 for elements of 12 bytes"]);
    model["bufferViews"][0]["byteStride"] = u32::MAX.into();
    refused(&model, &[AT, "pass the end"]);
    let mut model = triangle();
    model["accessors"][0]["bufferView"] = 5.into();
    refused(&model, &[AT, "buffer view 5 does not exist (there are 1)"]);
    model["accessors"][0]["type"] = "VEC2".into();
    refused(&model, &[AT, "has 2 numbers in an element, expected 3"]);
}

#[test]
fn sparse_indices_outside_their_accessor_are_refused() {
    let mut model = triangle();
    let place = add(&mut model, &4_000_000_000_u32.to_le_bytes(), json!({}));
    model["accessors"].as_array_mut().expect("a list").pop();
    model["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": place, "componentType": 5125 }, "values": { "bufferView": 0 },
    });
    refused(&model, &[AT, "sparse part: element 4000000000 does not exist (there are 3)"]);
    model["accessors"][0]["sparse"]["count"] = 4.into();
    refused(&model, &[AT, "sparse part: replaces 4 of 3 elements"]);
}

#[test]
fn indices_past_the_vertices_are_refused() {
    let mut model = triangle();
    let indices = add(&mut model, &[0, 1, 3], json!({ "componentType": 5121, "type": "SCALAR", "count": 3 }));
    model["meshes"][0]["primitives"][0]["indices"] = indices.into();
    refused(&model, &["mesh 0 'body', primitive 0, accessor 1 (indices)", "vertex 3 does not exist (there are 3)"]);
}

#[test]
fn numbers_that_are_not_finite_are_refused_in_every_attribute_and_matrix() {
    for value in [f32::NAN, f32::INFINITY] {
        for (name, kind, width) in [
            ("POSITION", "VEC3", 3),
            ("NORMAL", "VEC3", 3),
            ("TANGENT", "VEC4", 4),
            ("TEXCOORD_0", "VEC2", 2),
            ("COLOR_0", "VEC4", 4),
        ] {
            let mut model = triangle();
            let mut numbers = vec![1.0; 3 * width];
            numbers[width] = value;
            let accessor =
                add(&mut model, &floats(&numbers), json!({ "componentType": 5126, "type": kind, "count": 3 }));
            model["meshes"][0]["primitives"][0]["attributes"][name] = accessor.into();
            refused(&model, &["mesh 0 'body', primitive 0, accessor 1", name, "element 1 is not finite"]);
        }
    }
    let mut model = triangle();
    model["nodes"][0]["translation"] = json!([1e39, 0, 0]);
    refused(&model, &["JSON", "number out of range at line 1 column"]);
    let large = json!([1e30, 1e30, 1e30]);
    model["nodes"] = json!([{ "scale": large, "children": [1] }, { "scale": large, "mesh": 0 }]);
    refused(&model, &["node 1", "passes the range of 32-bit numbers"]);
    let mut model = triangle();
    model["nodes"][0]["matrix"] = json!([1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    refused(&model, &["node 0", "not affine"]);
    let mut model = triangle();
    model["nodes"][0]["rotation"] = json!([0, 0, 0, 0]);
    refused(&model, &["node 0", "the rotation is zero"]);
}

#[test]
fn node_graphs_with_cycles_diamonds_or_endless_depth_are_refused_quickly() {
    let start = Instant::now();
    let mut model = triangle();
    model["nodes"] = json!([{ "children": [1] }, { "children": [0], "name": "again" }]);
    refused(&model, &["node 0", "is reached twice"]);
    model["nodes"] = json!([{ "children": [0] }]);
    refused(&model, &["node 0", "is reached twice"]);

    // Each of 41 nodes names the next one twice: 2^40 paths.
    let diamond: Vec<Value> =
        (0..41).map(|i| if i < 40 { json!({ "children": [i + 1, i + 1] }) } else { json!({ "mesh": 0 }) }).collect();
    model["nodes"] = diamond.into();
    refused(&model, &["node", "is reached twice"]);

    let chain: Vec<Value> =
        (0..200_000).map(|i| if i < 199_999 { json!({ "children": [i + 1] }) } else { json!({ "mesh": 0 }) }).collect();
    model["nodes"] = chain.into();
    refused(&model, &["node 1024", "asks for 1025 levels of nodes; the limit is 1024"]);

    model["nodes"] = json!([{ "children": [7] }]);
    refused(&model, &["nodes", "node 7 does not exist (there are 1)"]);
    model["scene"] = 3.into();
    refused(&model, &["scene", "scene 3 does not exist (there are 1)"]);
    // Parsing 200 000 nodes takes a second or two on a busy machine; a walk of 2^40 paths never ends.
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
}

#[test]
fn one_large_mesh_under_many_primitives_meets_the_budget() {
    let mut model = triangle();
    // Zeros without a view cost the file nothing.
    model["accessors"] = json!([{ "componentType": 5126, "type": "VEC3", "count": 20_000_000 }]);
    let primitive = json!({ "attributes": { "POSITION": 0 }, "mode": 0 });
    model["meshes"][0]["primitives"] = vec![primitive; 1000].into();
    // Points are not even read.
    refused(&model, &["scene", "there are no triangles to show (points and lines are not shown)"]);
    let primitive = json!({ "attributes": { "POSITION": 0 }, "indices": 0 });
    model["meshes"][0]["primitives"] = vec![primitive; 4].into();
    refused(
        &model,
        &["mesh 0 'body', primitive 3, accessor 0 (POSITION)", "asks for 80000000 vertices; the limit is 60000000"],
    );
}

#[test]
fn degenerate_geometry_is_shown_without_nan_and_noticed() {
    let mut model = triangle();
    let flat = add(&mut model, &floats(&[1.0; 9]), json!({ "componentType": 5126, "type": "VEC3", "count": 3 }));
    let zero = add(&mut model, &floats(&[0.0; 9]), json!({ "componentType": 5126, "type": "VEC3", "count": 3 }));
    let along = add(
        &mut model,
        &floats(&[0., 0., 1., 1., 0., 0., 1., 1., 0., 0., 1., 1.]),
        json!({ "componentType": 5126, "type": "VEC4", "count": 3 }),
    );
    let normal = add(
        &mut model,
        &floats(&[0., 0., 1., 0., 0., 1., 0., 0., 1.]),
        json!({ "componentType": 5126, "type": "VEC3", "count": 3 }),
    );
    model["meshes"][0]["primitives"] = json!([
        { "attributes": { "POSITION": 0, "NORMAL": zero } },
        { "attributes": { "POSITION": flat } },
        { "attributes": { "POSITION": 0, "NORMAL": normal, "TANGENT": along } },
    ]);
    model["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "scale": [-1, 2, 3] }, { "mesh": 0, "scale": [1, 0, 1] }]);
    model["scenes"] = json!([{ "nodes": [0, 1, 2] }]);
    let notices = notices(model.to_string().as_bytes(), "m.gltf").join("\n");
    for words in [
        "primitive 0: normals of length 0 were replaced by those of their triangles (3 times)",
        "primitive 1: triangles have no area",
        "primitive 2: tangents of length 0 or along the normal were replaced (3 times)",
        "node 2: meshes whose transform cannot be inverted",
    ] {
        assert!(notices.contains(words), "{notices}\nlacks {words}");
    }
}

#[test]
fn extents_that_f32_cannot_hold_are_refused_and_odd_ones_noticed() {
    let scaled = |scale: f64, offset: f64| {
        let mut model = triangle();
        model["nodes"][0]["scale"] = json!([scale, scale, scale]);
        model["nodes"][0]["translation"] = json!([offset, 0, 0]);
        model
    };
    refused(&scaled(1e13, 0.0), &["scene", "reaches", "m is the limit"]);
    refused(&scaled(1.0, 3e38), &["scene", "reaches"]);
    for (scale, offset, words) in [
        (1e10, 0.0, "is its unit the metre?"),
        (1e-12, 0.0, "is its unit the metre?"),
        (1.0, 1e7, "lies 10000000 m from the origin"),
    ] {
        let notices = notices(scaled(scale, offset).to_string().as_bytes(), "m.gltf");
        assert!(notices.iter().any(|n| n.starts_with("m.gltf: scene: ") && n.contains(words)), "{notices:?}");
    }
}

#[test]
fn files_without_triangles_are_refused_with_the_reason() {
    refused(&json!({ "asset": { "version": "2.0" } }), &["scene", "there are no triangles to show"]);
    refused_bytes(b"", "m.obj", &["file", "the content is empty"]);
    refused_bytes(b"# nothing\n", "m.obj", &["file", "has no faces"]);
    refused_bytes(b"v 0 0 0\nv 1 0 0\nl 1 2\np 1\n", "m.obj", &["file", "has no faces"]);
}

#[test]
fn obj_statements_that_do_not_hold_are_refused_with_their_line() {
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (line, words) in [
        ("f 0 1 2", "index 0: indices count from 1"),
        ("f 1 2 -30", "vertex -30 counts back past the first of 3"),
        ("f 1 2 999", "vertex 999 does not exist (there are 3)"),
        ("f 1 2 100000000000000000000", "is not an index"),
        ("f 1/9223372036854775807 2 3", "texture coordinate 9223372036854775807 does not exist"),
        ("f 1/-9223372036854775808 2 3", "counts back past the first of 0"),
        ("f 1 2", "a face needs three corners"),
        ("f 1/1/1/1 2 3", "a corner with more than three parts"),
        ("v nan inf 0", "'nan' is not a finite"),
        ("v 1e39 0 0", "'1e39' is not a finite"),
        ("v 1,5 0 0", "'1,5' is not a number"),
        ("v 1 2", "too few or too many numbers"),
        ("v 1 2 3 0", "the weight is 0"),
        ("vn 0 0", "too few or too many numbers"),
    ] {
        refused_bytes(format!("{corners}{line}\nf 1 2 3\n").as_bytes(), "m.obj", &["line 4", words]);
    }
}

#[test]
fn odd_but_readable_obj_text_is_read_in_bounded_time() {
    let start = Instant::now();
    let mut text = b"# caf\xe9 \xff\nmtllib gone.mtl\no \xe9\n".to_vec();
    text.extend(b"f 1 2 3\n");
    text.extend(b"v 0 0 0\r\nv\t1\t0 \\\n0\nv 0 1 0\n");
    text.extend(format!("# {}\n", "x".repeat(10_000_000)).bytes());
    text.extend(b"f 1 1 1\n");
    text.extend(format!("f{}\n", " 1 2 3".repeat(33_333)).bytes());
    let imported = read(&text, "m.obj").expect("the model is shown");
    assert_eq!(imported.scene.triangle_count(), 1 + 1 + 99_997);
    let notices: Vec<String> = imported.notices.iter().map(ToString::to_string).collect();
    assert!(notices[0].contains("m.obj: mtllib 'gone.mtl': the materials are left out"), "{notices:?}");
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
}

#[test]
fn material_values_out_of_range_are_clamped_with_a_notice() {
    for (field, value) in [("roughnessFactor", 2.0), ("roughnessFactor", -1.0), ("metallicFactor", 1.5)] {
        let mut model = triangle();
        model["materials"] = json!([{ "name": "skin", "pbrMetallicRoughness": { field: value } }]);
        model["meshes"][0]["primitives"][0]["material"] = 0.into();
        let notices = notices(model.to_string().as_bytes(), "m.gltf");
        assert!(notices[0].starts_with(&format!("m.gltf: material 0 'skin': {field} was ")), "{notices:?}");
    }
    let mut model = triangle();
    model["materials"] =
        json!([{ "emissiveFactor": [1, -1, 0], "extensions": { "KHR_materials_ior": { "ior": -2 } } }]);
    model["meshes"][0]["primitives"][0]["material"] = 0.into();
    let notices = notices(model.to_string().as_bytes(), "m.gltf").join("\n");
    assert!(notices.contains("emissiveFactor was") && notices.contains("ior was -2; 1 is used"), "{notices}");
    model["meshes"][0]["primitives"][0]["material"] = 4.into();
    refused(&model, &["mesh 0 'body', primitive 0", "material 4 does not exist (there are 1)"]);
}

#[test]
fn textures_that_lead_nowhere_are_left_out_with_a_notice() {
    let mut model = triangle();
    // A header of a 60 000 x 60 000 PNG: signature, then IHDR with its checksum.
    let mut bomb = b"\x89PNG\r\n\x1a\n\x00\x00\x00\x0dIHDR".to_vec();
    bomb.extend(60_000_u32.to_be_bytes());
    bomb.extend(60_000_u32.to_be_bytes());
    bomb.extend([8, 6, 0, 0, 0]);
    bomb.extend(checksum(&bomb[12..]).to_be_bytes());
    bomb.extend(b"\x00\x00\x00\x00IDAT");
    bomb.extend(checksum(b"IDAT").to_be_bytes());
    bomb.extend(b"\x00\x00\x00\x00IEND\xae\x42\x60\x82");
    let bomb = percent(&bomb).replace("application/octet-stream", "image/png");
    model["images"] = json!([{ "uri": bomb }, { "uri": "data:image/ktx2,%abKTX%2020%bb" }, { "uri": "../up.png" }, {}]);
    model["textures"] =
        json!([{ "source": 0 }, { "source": 1 }, { "source": 2 }, { "source": 3 }, { "source": 9, "sampler": 9 }]);
    model["samplers"] = json!([{ "minFilter": 99 }]);
    model["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 4, "texCoord": 7 } }, "normalTexture": { "index": 99 },
    }]);
    model["meshes"][0]["primitives"][0]["material"] = 0.into();
    let notices = notices(model.to_string().as_bytes(), "m.gltf").join("\n");
    for words in [
        "m.gltf: image 0: the texture is left out: asks for 3600000000 pixels; the limit is 268435456",
        "image 1: the texture is left out: data URI: media type 'image/ktx2'",
        "image 2 '../up.png': the texture is left out",
        "image 3: the texture is left out: has neither a URI nor a buffer view",
        "material 0, base colour texture: the texture is left out: image 9 does not exist",
        "material 0, normal texture: the texture is left out: texture 99 does not exist (there are 5)",
    ] {
        assert!(notices.contains(words), "{notices}\nlacks {words}");
    }
}

/// CRC-32 of PNG.
fn checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |mut crc, byte| {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { 0xEDB8_8320 ^ (crc >> 1) } else { crc >> 1 };
        }
        crc
    })
}

#[test]
fn a_texture_that_asks_for_odd_coordinates_or_samplers_is_shown_with_a_notice() {
    let mut model = triangle();
    model["images"] = json!([{ "uri": percent(PNG) }]);
    model["samplers"] = json!([{ "wrapS": 99, "minFilter": 99 }]);
    model["textures"] = json!([{ "source": 0, "sampler": 0 }, { "source": 0, "sampler": 5 }]);
    model["materials"] = json!([{
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "texCoord": 7 } },
        "emissiveTexture": { "index": 1 },
    }]);
    model["meshes"][0]["primitives"][0]["material"] = 0.into();
    let notices = notices(model.to_string().as_bytes(), "m.gltf").join("\n");
    for words in [
        "material 0, base colour texture: TEXCOORD_7 is not read",
        "material 0, base colour texture: sampler 0 has an unknown filter or wrap mode",
        "material 0, emissive texture: sampler 5 does not exist; the default is used",
        "mesh 0 'body', primitive 0: a texture asks for TEXCOORD_0, which the primitive lacks",
    ] {
        assert!(notices.contains(words), "{notices}\nlacks {words}");
    }
}

#[test]
fn a_picture_with_a_wrong_checksum_or_cut_short_is_left_out_with_a_notice() {
    let mut wrong = PNG.to_vec();
    wrong[30] ^= 1;
    for bytes in [wrong.as_slice(), &PNG[..40], b"\xff\xd8\xff\xe0\x00\x10JFIF"] {
        let mut model = triangle();
        model["images"] = json!([{ "uri": percent(bytes) }]);
        model["textures"] = json!([{ "source": 0 }]);
        let notices = notices(model.to_string().as_bytes(), "m.gltf");
        assert!(notices[0].starts_with("m.gltf: image 0: the texture is left out: "), "{notices:?}");
    }
}

#[test]
fn a_mesh_placed_too_often_is_refused() {
    let mut model = triangle();
    model["nodes"] = vec![json!({ "mesh": 0 }); 50].into();
    model["scenes"] = json!([{ "nodes": (0..50).collect::<Vec<_>>() }]);
    for (budget, words) in [
        (
            burnish_core::import::Budget { instances: 49, ..Default::default() },
            "asks for 50 instances; the limit is 49",
        ),
        (burnish_core::import::Budget { placed_triangles: 49, ..Default::default() }, "asks for 50 placed triangles"),
        (burnish_core::import::Budget { nodes: 49, ..Default::default() }, "asks for 50 nodes"),
        (burnish_core::import::Budget { json_bytes: 99, ..Default::default() }, "bytes of JSON; the limit is 99"),
    ] {
        let options = burnish_core::import::ImportOptions { budget, ..Default::default() };
        let bytes = model.to_string();
        let error =
            burnish_core::import::scene_from_bytes(bytes.as_bytes(), "m.gltf", &crate::sources::Nothing, &options);
        let text = error.expect_err("over the budget").to_string();
        assert!(text.starts_with("m.gltf: ") && text.contains(words), "{text}");
    }
}
