//! Puts a scene together piece by piece.

use std::sync::Arc;

use burnish_core::{
    material::{Filter, Material, Sampler, TextureRef},
    scene::{Camera, Image, Instance, Light, LightKind, Mesh, Scene, Texels, gallery},
};
use glam::{Affine3A, Mat3, Vec3};

/// A scene in the making, lit by the studio.
pub struct Stage {
    scene: Scene,
}

impl Stage {
    /// An empty one.
    pub fn new(name: &str) -> Stage {
        let environment = Some(Arc::new(gallery::studio()));
        Stage { scene: Scene { name: name.into(), environment, ..Scene::default() } }
    }

    /// Dims the studio to a share of its light.
    pub fn dim(&mut self, strength: f32) {
        if let Some(environment) = &mut self.scene.environment {
            Arc::make_mut(environment).strength = strength;
        }
    }

    /// Adds a mesh for later placing.
    pub fn mesh(&mut self, mesh: Mesh) -> usize {
        self.scene.meshes.push(mesh.into());
        self.scene.meshes.len() - 1
    }

    /// Adds a material, named by its number.
    pub fn material(&mut self, material: Material) -> usize {
        let index = self.scene.materials.len();
        self.scene.materials.push(Material { name: format!("material {index}"), ..material });
        index
    }

    /// Adds a square image of `size` texels a side; `texel(x, y)` is RGBA as stored.
    pub fn image(&mut self, name: &str, size: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> usize {
        let texels = (0..size * size).flat_map(|i| texel(i % size, i / size)).collect();
        let image = Image { name: name.into(), width: size, height: size, texels: Texels::Unorm8(texels) };
        self.scene.images.push(Arc::new(image));
        self.scene.images.len() - 1
    }

    /// Places a mesh.
    pub fn place(&mut self, mesh: usize, material: usize, world_from_local: Affine3A) {
        let name = format!("instance {}", self.scene.instances.len());
        self.scene.instances.push(Instance { name, mesh, material, world_from_local, visible: true });
    }

    /// Adds a mesh and places it.
    pub fn put(&mut self, mesh: Mesh, material: usize, world_from_local: Affine3A) {
        let mesh = self.mesh(mesh);
        self.place(mesh, material, world_from_local);
    }

    /// Adds a lamp.
    pub fn light(&mut self, kind: LightKind, position: Vec3, direction: Vec3, intensity: Vec3) {
        let name = format!("light {}", self.scene.lights.len());
        let direction = direction.normalize();
        self.scene.lights.push(Light { name, position, direction, intensity, kind, ..Light::default() });
    }

    /// Adds white parallel light, in lux.
    pub fn sun(&mut self, direction: Vec3, illuminance: f32) {
        self.light(LightKind::PARALLEL, Vec3::ZERO, direction, Vec3::splat(illuminance));
    }

    /// The scene, seen from `eye` towards the origin; `yfov` in radians.
    pub fn finish(self, eye: Vec3, yfov: f32) -> Scene {
        self.finish_towards(eye, Vec3::ZERO, yfov)
    }

    /// The scene, seen from `eye` towards `target`.
    pub fn finish_towards(mut self, eye: Vec3, target: Vec3, yfov: f32) -> Scene {
        self.scene.cameras.push(Camera::look_at("main", eye, target, yfov));
        self.scene
    }
}

/// A metal by its reflectance at normal incidence.
pub fn metal(base_color: Vec3, roughness: f32) -> Material {
    Material { base_color, metallic: 1.0, roughness, ..Material::default() }
}

/// A repeating texture with all filters on.
pub fn texture(image: usize) -> TextureRef {
    let sampler = Sampler { mip: Some(Filter::Linear), ..Sampler::default() };
    TextureRef { image, sampler, uv_set: 0, transform: Mat3::IDENTITY }
}
