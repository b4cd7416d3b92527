//! A hash of what light sees of a scene: the key of everything that is computed from one and kept.
//!
//! Names for people are left out, and so are cameras; all else counts bit by bit. The bytes that are hashed depend on
//! neither the machine nor the run, and every list is preceded by its length, so that two scenes cannot be spelt alike.

use std::fmt;

use blake3::{Hash, Hasher};
use glam::{Affine3A, Vec3};
use rayon::prelude::*;

use super::{
    Background, Camera, Environment, Ground, Image, Instance, Light, LightKind, Mesh, Probe, Projection, Scene, Texels,
};
use crate::material::{AlphaMode, Material, Reflectance, Sampler, TextureRef};

/// Hashes of the parts of a scene, so that it can be told which of two differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fingerprint {
    /// Meshes and instances, with which material each has.
    pub geometry: Digest,
    /// Materials with their Fresnel curves and images.
    pub materials: Digest,
    /// Punctual lights.
    pub lights: Digest,
    /// The environment.
    pub environment: Digest,
    /// What only the eye sees of it; `None` where it sees the environment as it is.
    pub background: Option<Digest>,
}

/// 256 bits, written as hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Digest(Hash);

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.to_hex())
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Fingerprint {
    /// That of a scene. Takes about a second per gigabyte of meshes, images and environment, on one core.
    pub fn new(scene: &Scene) -> Fingerprint {
        // Taken apart, so that a new field cannot be forgotten.
        let Scene {
            name: _,
            meshes: _,
            instances: _,
            materials: _,
            images: _,
            lights: _,
            cameras: _,
            environment: _,
            background,
            subject: _,
            // Paths do not meet them.
            probes: _,
        } = scene;
        Fingerprint {
            geometry: geometry(scene),
            materials: materials(scene),
            lights: lights(scene),
            environment: environment(scene),
            background: (!background.is_plain()).then(|| digest(|h| h.background(background))),
        }
    }
}

/// The hash of meshes and instances.
pub fn geometry(scene: &Scene) -> Digest {
    digest(|h| {
        h.parts(&scene.meshes, |h, mesh| h.mesh(mesh));
        h.list(&scene.instances, Sponge::instance);
    })
}

/// The hash of materials and images.
pub fn materials(scene: &Scene) -> Digest {
    digest(|h| {
        h.list(&scene.materials, Sponge::material);
        h.parts(&scene.images, |h, image| h.image(image));
    })
}

/// The hash of the lights.
pub fn lights(scene: &Scene) -> Digest {
    digest(|h| h.list(&scene.lights, Sponge::light))
}

/// The hash of the probes.
pub fn probes(scene: &Scene) -> Digest {
    digest(|h| h.list(&scene.probes, Sponge::probe))
}

/// The hash of the environment.
pub fn environment(scene: &Scene) -> Digest {
    digest(|h| h.option(scene.environment.as_deref(), Sponge::environment))
}

/// The hash of the map of the environment, however it is turned and scaled.
pub fn sky(scene: &Scene) -> Digest {
    digest(|h| h.option(scene.environment.as_deref(), Sponge::map))
}

/// The hash of a point of view; its name is left out.
pub fn camera(camera: &Camera) -> Digest {
    digest(|h| {
        let Camera { name: _, world_from_view, projection } = camera;
        h.transform(world_from_view);
        match *projection {
            Projection::Perspective { yfov, near } => {
                h.word(0);
                h.floats(&[yfov, near]);
            }
            Projection::Orthographic { ymag, near, far } => {
                h.word(1);
                h.floats(&[ymag, near, far]);
            }
        }
    })
}

fn digest(absorb: impl FnOnce(&mut Sponge)) -> Digest {
    let mut sponge = Sponge(Hasher::new());
    absorb(&mut sponge);
    Digest(sponge.0.finalize())
}

/// Takes in values as little-endian bytes.
struct Sponge(Hasher);

impl Sponge {
    fn word(&mut self, value: u32) {
        self.0.update(&value.to_le_bytes());
    }

    fn count(&mut self, value: usize) {
        self.0.update(&(value as u64).to_le_bytes());
    }

    fn flag(&mut self, value: bool) {
        self.word(value.into());
    }

    fn floats(&mut self, values: &[f32]) {
        // In pieces: hashing many bytes at once is faster.
        let mut buffer = [0; 4096];
        for values in values.chunks(buffer.len() / 4) {
            for (bytes, value) in buffer.chunks_exact_mut(4).zip(values) {
                bytes.copy_from_slice(&value.to_le_bytes());
            }
            self.0.update(&buffer[..4 * values.len()]);
        }
    }

    fn color(&mut self, value: Vec3) {
        self.floats(&value.to_array());
    }

    fn transform(&mut self, value: &Affine3A) {
        self.floats(&value.to_cols_array());
    }

    fn list<T>(&mut self, items: &[T], absorb: impl Fn(&mut Sponge, &T)) {
        self.count(items.len());
        items.iter().for_each(|item| absorb(self, item));
    }

    /// A list of large items, which are hashed each by itself on several threads.
    fn parts<T: Sync>(&mut self, items: &[T], absorb: impl Fn(&mut Sponge, &T) + Sync) {
        let digests: Vec<Digest> = items.par_iter().map(|item| digest(|h| absorb(h, item))).collect();
        self.list(&digests, |h, Digest(hash)| _ = h.0.update(hash.as_bytes()));
    }

    fn option<T>(&mut self, item: Option<T>, absorb: impl Fn(&mut Sponge, T)) {
        self.flag(item.is_some());
        if let Some(item) = item {
            absorb(self, item);
        }
    }

    /// Vectors one after the other.
    fn vectors<T: bytemuck::Pod>(&mut self, values: &[T]) {
        self.count(values.len());
        self.floats(bytemuck::cast_slice(values));
    }

    fn mesh(&mut self, mesh: &Mesh) {
        let Mesh { name: _, positions, normals, tangents, uvs, colors, indices } = mesh;
        self.vectors(positions);
        self.vectors(normals);
        self.vectors(tangents);
        uvs.iter().for_each(|uvs| self.vectors(uvs));
        self.vectors(colors);
        self.list(indices, |h, index| h.word(*index));
    }

    fn instance(&mut self, instance: &Instance) {
        let Instance { name: _, mesh, material, world_from_local, visible } = instance;
        self.count(*mesh);
        self.count(*material);
        self.transform(world_from_local);
        self.flag(*visible);
    }

    fn image(&mut self, image: &Image) {
        let Image { name: _, width, height, texels } = image;
        self.word(*width);
        self.word(*height);
        match texels {
            Texels::Unorm8(values) => {
                self.word(8);
                self.count(values.len());
                self.0.update(values);
            }
            Texels::Unorm16(values) => {
                self.word(16);
                self.list(values, |h, value| _ = h.0.update(&value.to_le_bytes()));
            }
        }
    }

    fn light(&mut self, light: &Light) {
        let Light { name: _, position, direction, intensity, range, kind, camera, reflections, shadows, unlit } = light;
        [position, direction, intensity].into_iter().for_each(|v| self.color(*v));
        self.floats(&[*range]);
        match *kind {
            LightKind::Point => self.word(0),
            LightKind::Spot { inner_angle, outer_angle } => {
                self.word(1);
                self.floats(&[inner_angle, outer_angle]);
            }
            LightKind::Directional { angular_radius } => {
                self.word(2);
                self.floats(&[angular_radius]);
            }
            LightKind::Rectangle { across, size } => {
                self.word(3);
                self.color(across);
                self.floats(&size.to_array());
            }
            LightKind::Sphere { radius } => {
                self.word(4);
                self.floats(&[radius]);
            }
        }
        [camera, reflections, shadows].into_iter().for_each(|switch| self.flag(*switch));
        self.list(unlit, |h, instance| h.count(*instance));
    }

    fn probe(&mut self, probe: &Probe) {
        let Probe { name: _, position, extent, resolution, source, paths, serves } = probe;
        self.option(*position, Sponge::color);
        self.option(*extent, Sponge::color);
        self.option(*resolution, Sponge::word);
        self.option(*paths, Sponge::word);
        self.word(*source as u32);
        self.list(serves, |h, instance| h.count(*instance));
    }

    fn environment(&mut self, environment: &Environment) {
        self.map(environment);
        let Environment { rotation, strength, tint, .. } = environment;
        self.floats(&[*rotation, *strength]);
        // Hashes of maps without a tint are those of the time before there were tints.
        if *tint != Vec3::ONE {
            self.color(*tint);
        }
    }

    /// All but how it is turned, scaled and tinted.
    fn map(&mut self, environment: &Environment) {
        let Environment { name: _, width, height, texels, rotation: _, strength: _, tint: _ } = environment;
        self.word(*width);
        self.word(*height);
        self.vectors(texels);
    }

    fn background(&mut self, background: &Background) {
        let Background { map, ground } = background;
        self.option(map.as_deref(), Sponge::environment);
        self.option(ground.as_ref(), |h, ground| {
            let Ground { middle, height, radius, shadows } = ground;
            h.color(*middle);
            h.floats(&[*height, *radius]);
            h.flag(*shadows);
        });
    }

    fn material(&mut self, material: &Material) {
        // Taken apart, so that a new field cannot be forgotten.
        let Material {
            name: _,
            base_color,
            base_color_texture: _,
            opacity,
            metallic,
            roughness,
            metallic_roughness_texture: _,
            reflectance,
            normal_texture: _,
            normal_scale,
            occlusion_texture: _,
            occlusion_strength,
            emission,
            emission_texture: _,
            alpha_mode,
            double_sided,
            unlit,
            ior,
            specular,
            specular_texture: _,
            specular_color,
            specular_color_texture: _,
            coat,
            coat_texture: _,
            coat_roughness,
            coat_roughness_texture: _,
            coat_normal_texture: _,
            coat_normal_scale,
            anisotropy,
            anisotropy_rotation,
            anisotropy_texture: _,
            micro_normal,
            micro_size_mm,
            micro_depth,
            reflection_model,
            exponent,
        } = material;
        [base_color, emission, specular_color].into_iter().for_each(|color| self.color(*color));
        self.floats(&[*opacity, *metallic, *roughness, *normal_scale, *occlusion_strength, *ior, *specular]);
        self.floats(&[*coat, *coat_roughness, *coat_normal_scale, *anisotropy, *anisotropy_rotation]);
        self.floats(&[*micro_size_mm, *micro_depth, *exponent]);
        self.count(reflection_model.index());
        self.word(*micro_normal as u32);
        self.flag(*double_sided);
        self.flag(*unlit);
        match *alpha_mode {
            AlphaMode::Opaque => self.word(0),
            AlphaMode::Mask { cutoff } => {
                self.word(1);
                self.floats(&[cutoff]);
            }
            AlphaMode::Blend => self.word(2),
        }
        self.reflectance(reflectance);
        // All textures, each at the place of its role.
        self.list(&material.textures(), |h, texture| h.option(texture.as_ref(), Sponge::texture));
    }

    fn reflectance(&mut self, reflectance: &Reflectance) {
        use crate::surface::fresnel::Fresnel;
        match reflectance {
            Reflectance::BaseColor => self.word(0),
            // What the curve is called does not show.
            Reflectance::Preset { id: _, fresnel } => {
                self.word(1);
                self.word(fresnel.form());
                match &**fresnel {
                    Fresnel::Spectral { table } => self.vectors(&table[..]),
                    other => self.vectors(&other.coefficients()),
                }
            }
        }
    }

    fn texture(&mut self, texture: &TextureRef) {
        let TextureRef { image, sampler, uv_set, transform } = texture;
        let Sampler { wrap_u, wrap_v, magnify, minify, mip } = *sampler;
        self.count(*image);
        [wrap_u as u32, wrap_v as u32, magnify as u32, minify as u32, mip.map_or(u32::MAX, |f| f as u32)]
            .into_iter()
            .for_each(|word| self.word(word));
        self.word((*uv_set).into());
        self.floats(&transform.to_cols_array());
    }
}

#[cfg(test)]
#[path = "fingerprint_tests.rs"]
mod tests;
