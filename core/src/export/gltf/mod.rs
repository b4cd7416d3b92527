//! Scenes as GLB (glTF 2.0, one file): meshes, materials with the extensions that the importer reads, lamps, cameras.
//!
//! Khronos, glTF 2.0 specification; extensions KHR_lights_punctual, KHR_materials_anisotropy, KHR_materials_clearcoat,
//! KHR_materials_emissive_strength, KHR_materials_ior, KHR_materials_specular, KHR_materials_unlit, KHR_texture_transform.

mod buffer;
mod light;
mod material;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use glam::{Affine3A, Mat3, Mat4, Vec3};
use serde_json::{Map, Value, json};

use super::{Loss, Report};
use crate::file::FileError;
use crate::scene::{Camera, Projection, Scene};
use buffer::Buffer;
use material::is_opaque_metal;

/// A file with what it cannot hold.
#[derive(Clone, Debug)]
pub struct Encoded {
    /// The bytes of a `.glb`.
    pub glb: Vec<u8>,
    /// What differs from the scene; no files are named.
    pub report: Report,
}

/// What is being written.
struct Writer<'a> {
    scene: &'a Scene,
    buffer: Buffer,
    report: Report,
    extensions: BTreeSet<&'static str>,
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    samplers: Vec<Value>,
    textures: Vec<Value>,
}

/// A valid scene as GLB. The environment, which glTF has no place for, is a note. Fails for what passes 4 GiB.
pub fn encode(scene: &Scene) -> Result<Encoded, FileError> {
    let mut writer = Writer {
        scene,
        buffer: Buffer::default(),
        report: Report::default(),
        extensions: BTreeSet::new(),
        nodes: Vec::new(),
        meshes: Vec::new(),
        samplers: Vec::new(),
        textures: Vec::new(),
    };
    let materials = writer.materials();
    let images = writer.images()?;
    writer.instances();
    let lights = writer.lights();
    let cameras = writer.cameras();
    if let Some(map) = &scene.environment {
        let degrees = map.rotation.to_degrees();
        let turned = format!(", turned by {degrees} degrees counter-clockwise about +y");
        let turned = if degrees == 0.0 { "" } else { &turned };
        let what = format!("glTF has no environments; use the map beside the file{turned}");
        writer.report.note("environment", Loss::Dropped, what);
    }
    writer.finish(materials, images, lights, cameras)
}

impl Writer<'_> {
    /// A node for each visible instance. Meshes of glTF carry their material: one for each pair.
    fn instances(&mut self) {
        let scene = self.scene;
        let mut attributes: BTreeMap<usize, (Value, usize)> = BTreeMap::new();
        let mut meshes: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        for (i, instance) in scene.instances.iter().enumerate() {
            if !instance.visible {
                let element = format!("object {i} '{}'", instance.name);
                self.report.note(element, Loss::Dropped, "it is hidden, and glTF has no hidden objects");
                continue;
            }
            let mesh = &scene.meshes[instance.mesh];
            let buffer = &mut self.buffer;
            let (mut attributes, indices) =
                attributes.entry(instance.mesh).or_insert_with(|| buffer.mesh(mesh)).clone();
            // A curve knows nothing of the colours of vertices; the colour that stands for it would be tinted.
            if is_opaque_metal(&scene.materials[instance.material])
                && let Some(attributes) = attributes.as_object_mut()
            {
                attributes.remove("COLOR_0");
            }
            let list = &mut self.meshes;
            let index = *meshes.entry((instance.mesh, instance.material)).or_insert_with(|| {
                let primitive = json!({ "attributes": attributes, "indices": indices, "material": instance.material });
                list.push(json!({ "name": mesh.name, "primitives": [primitive] }));
                list.len() - 1
            });
            let mut node = node(&instance.name, &instance.world_from_local);
            node.insert("mesh".into(), index.into());
            self.nodes.push(node.into());
        }
    }

    fn lights(&mut self) -> Vec<Value> {
        let mut list = Vec::new();
        for light in &self.scene.lights {
            self.extensions.insert("KHR_lights_punctual");
            let mut node = node(&light.name, &Affine3A::from_mat3_translation(facing(light.direction), light.position));
            node.insert("extensions".into(), json!({ "KHR_lights_punctual": { "light": list.len() } }));
            self.nodes.push(node.into());
            let element = format!("light {} '{}'", list.len(), light.name);
            list.push(light::punctual(light, &element, &mut self.report));
        }
        list
    }

    fn cameras(&mut self) -> Vec<Value> {
        let mut list = Vec::new();
        for camera in &self.scene.cameras {
            let mut node = node(&camera.name, &camera.world_from_view);
            node.insert("camera".into(), list.len().into());
            self.nodes.push(node.into());
            list.push(projection(camera));
        }
        list
    }

    fn finish(
        self,
        materials: Vec<Value>,
        images: Vec<Value>,
        lights: Vec<Value>,
        cameras: Vec<Value>,
    ) -> Result<Encoded, FileError> {
        let nodes: Vec<usize> = (0..self.nodes.len()).collect();
        let mut root = json!({
            "asset": { "version": "2.0", "generator": concat!("Burnish ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "name": self.scene.name, "nodes": nodes }],
        });
        if !lights.is_empty() {
            root["extensions"] = json!({ "KHR_lights_punctual": { "lights": lights } });
        }
        let used: Vec<Value> = self.extensions.into_iter().map(Value::from).collect();
        let (accessors, views, bytes) = self.buffer.into_parts();
        let buffers = if bytes.is_empty() { Vec::new() } else { vec![json!({ "byteLength": bytes.len() })] };
        // Empty lists are not allowed.
        for (key, list) in [
            ("extensionsUsed", used),
            ("nodes", self.nodes),
            ("meshes", self.meshes),
            ("materials", materials),
            ("textures", self.textures),
            ("samplers", self.samplers),
            ("images", images),
            ("cameras", cameras),
            ("accessors", accessors),
            ("bufferViews", views),
            ("buffers", buffers),
        ] {
            if !list.is_empty() {
                root[key] = list.into();
            }
        }
        Ok(Encoded { glb: buffer::glb(&root, bytes)?, report: self.report })
    }
}

/// A node with a name and a place.
fn node(name: &str, world_from_local: &Affine3A) -> Map<String, Value> {
    let mut node = Map::new();
    node.insert("name".into(), name.into());
    if *world_from_local != Affine3A::IDENTITY {
        node.insert("matrix".into(), json!(Mat4::from(*world_from_local).to_cols_array()));
    }
    node
}

/// A rotation whose -z is the direction.
fn facing(direction: Vec3) -> Mat3 {
    let z = -direction.try_normalize().unwrap_or(Vec3::NEG_Z);
    let x = z.any_orthonormal_vector();
    Mat3::from_cols(x, z.cross(x), z)
}

fn projection(camera: &Camera) -> Value {
    match camera.projection {
        Projection::Perspective { yfov, near } => json!({
            "name": camera.name, "type": "perspective", "perspective": { "yfov": yfov, "znear": near },
        }),
        Projection::Orthographic { ymag, near, far } => json!({
            "name": camera.name, "type": "orthographic",
            "orthographic": { "xmag": ymag, "ymag": ymag, "znear": near, "zfar": far },
        }),
    }
}
