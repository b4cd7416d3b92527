//! What casts shadows, in a form that can be compared: maps are kept while it stays the same.

use std::sync::Arc;

use burnish_core::material::{AlphaMode, Material, TextureRef};
use burnish_core::scene::{Image, Mesh, Scene};
use glam::Affine3A;

/// An instance that blocks light.
#[derive(Clone)]
pub struct Caster {
    mesh: Arc<Mesh>,
    world_from_local: Affine3A,
    mask: Option<Mask>,
}

/// What decides where a masked material has holes.
#[derive(Clone)]
struct Mask {
    cutoff: f32,
    opacity: f32,
    texture: Option<(TextureRef, Option<Arc<Image>>)>,
}

/// The casters of a scene: visible and not blended.
pub fn list(scene: &Scene) -> Vec<Caster> {
    let casters = scene.instances.iter().filter(|instance| instance.visible).filter_map(|instance| {
        let material = &scene.materials[instance.material];
        let mask = match material.alpha_mode {
            AlphaMode::Opaque => None,
            AlphaMode::Mask { cutoff } => Some(Mask::new(scene, material, cutoff)),
            AlphaMode::Blend => return None,
        };
        let mesh = scene.meshes[instance.mesh].clone();
        Some(Caster { mesh, world_from_local: instance.world_from_local, mask })
    });
    casters.collect()
}

impl Mask {
    fn new(scene: &Scene, material: &Material, cutoff: f32) -> Mask {
        let texture = material.base_color_texture.map(|t| (t, scene.images.get(t.image).cloned()));
        Mask { cutoff, opacity: material.opacity, texture }
    }
}

impl PartialEq for Caster {
    fn eq(&self, other: &Caster) -> bool {
        Arc::ptr_eq(&self.mesh, &other.mesh)
            && self.world_from_local == other.world_from_local
            && self.mask == other.mask
    }
}

impl PartialEq for Mask {
    fn eq(&self, other: &Mask) -> bool {
        let same_texture = match (&self.texture, &other.texture) {
            (None, None) => true,
            (Some((a, of_a)), Some((b, of_b))) => {
                let same_image = match (of_a, of_b) {
                    (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                    (None, None) => true,
                    _ => false,
                };
                // The place of an image in the list may change; the image counts.
                TextureRef { image: 0, ..*a } == TextureRef { image: 0, ..*b } && same_image
            }
            _ => false,
        };
        (self.cutoff, self.opacity) == (other.cutoff, other.opacity) && same_texture
    }
}
