//! A scene as every renderer sees it: flat, validated, in metres, radians and linear Rec.709.

mod camera;
pub mod environment;
pub mod fingerprint;
pub mod gallery;
mod light;
pub mod photometry;
mod pick;
mod probe;
mod validate;

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3, Vec4};

use crate::material::{Material, Reflectance};

pub use environment::{Background, Ground};
pub use light::{Light, LightKind};
pub use pick::{Picked, Ray};
pub use probe::{Probe, ProbeSource};
pub use validate::Fault;

/// Everything that a picture is made from.
///
/// Indices between the lists are in range; importers and the gallery guarantee it through [`Scene::validate`].
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name for people, usually the file's stem.
    pub name: String,
    /// Triangle meshes, one per primitive of the source; shared by the copies of a scene.
    pub meshes: Vec<Arc<Mesh>>,
    /// Placed meshes.
    pub instances: Vec<Instance>,
    /// Materials; never empty when there is an instance.
    pub materials: Vec<Material>,
    /// Decoded images, shared by the textures of the materials.
    pub images: Vec<Arc<Image>>,
    /// Lights other than the environment and glowing materials.
    pub lights: Vec<Light>,
    /// Cameras of the source.
    pub cameras: Vec<Camera>,
    /// Light from infinitely far away; `None` lets the caller choose.
    pub environment: Option<Arc<Environment>>,
    /// What the eye sees behind everything; the environment by default.
    pub background: Background,
    /// Indices of the instances that a picture is about, on which errors are reported; all when empty.
    pub subject: Vec<usize>,
    /// Places from which methods record the surroundings of objects; one in the middle of the subject when empty.
    pub probes: Vec<Probe>,
}

/// Indexed triangles in local space. Attribute lists are as long as `positions`, or empty where absent.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name for people.
    pub name: String,
    /// Metres.
    pub positions: Vec<Vec3>,
    /// Unit normals; never empty after import.
    pub normals: Vec<Vec3>,
    /// Unit tangents with the sign of the bitangent in w (`bitangent = w * cross(normal, tangent)`); never empty after
    /// import.
    pub tangents: Vec<Vec4>,
    /// Two texture coordinate sets, origin at the image's top left.
    pub uvs: [Vec<Vec2>; 2],
    /// Linear colour factors, straight alpha.
    pub colors: Vec<Vec4>,
    /// Three per triangle, counter-clockwise from the front.
    pub indices: Vec<u32>,
}

/// A mesh in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Name for people, the node's.
    pub name: String,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Any invertible affine transform; a negative determinant flips the winding.
    pub world_from_local: Affine3A,
    /// Drawn and casting shadows; a hidden one keeps its place in the list.
    pub visible: bool,
}

/// Pixels as the file stored them, without colour conversion. Row 0 is the top.
#[derive(Clone, Debug)]
pub struct Image {
    /// Name for people and messages.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// RGBA.
    pub texels: Texels,
}

/// RGBA texels, `4 * width * height` numbers.
#[derive(Clone, Debug)]
pub enum Texels {
    /// 8 bits a channel.
    Unorm8(Vec<u8>),
    /// 16 bits a channel.
    Unorm16(Vec<u16>),
}

/// A view of the scene: looks along local -z with +y up, as in glTF.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Name for people.
    pub name: String,
    /// Rotation and translation only.
    pub world_from_view: Affine3A,
    /// How depth becomes size.
    pub projection: Projection,
}

/// The projection of a [`Camera`]. A perspective view has no far plane: depth is reversed and infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Vertical field of view in radians; near plane in metres.
    Perspective {
        /// Full vertical angle.
        yfov: f32,
        /// Distance of the near plane.
        near: f32,
    },
    /// Half heights in metres.
    Orthographic {
        /// Half the height of the view.
        ymag: f32,
        /// Distance of the near plane.
        near: f32,
        /// Distance of the far plane.
        far: f32,
    },
}

/// An equirectangular map of radiance from infinitely far away.
///
/// Direction `(x, y, z)` is seen at `u = 1/2 + atan2(x, -z) / 2pi`, `v = acos(y) / pi` (v = 0 is up, the centre of the
/// image is -z), after the direction was turned by `-rotation` about +y.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Name for people.
    pub name: String,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Linear Rec.709 radiance, row 0 at the top; finite and not negative. Shared by turned and scaled copies.
    pub texels: Arc<[Vec3]>,
    /// Radians counter-clockwise about +y.
    pub rotation: f32,
    /// Factor on the radiance.
    pub strength: f32,
    /// Linear Rec.709 factor on the radiance, white (1, 1, 1) for none; finite and not negative.
    pub tint: Vec3,
}

/// An axis-aligned box, empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least corner.
    pub min: Vec3,
    /// Greatest corner.
    pub max: Vec3,
}

impl Bounds {
    /// The box that contains nothing.
    pub const EMPTY: Bounds = Bounds { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box around this one and `point`.
    pub fn including(self, point: Vec3) -> Bounds {
        Bounds { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The smallest box around both.
    pub fn joined(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True when no point is inside.
    pub fn is_empty(self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Middle of the box; the origin when empty.
    pub fn center(self) -> Vec3 {
        if self.is_empty() { Vec3::ZERO } else { 0.5 * (self.min + self.max) }
    }

    /// Half the diagonal; 0 when empty.
    pub fn radius(self) -> f32 {
        if self.is_empty() { 0.0 } else { 0.5 * (self.max - self.min).length() }
    }
}

impl Instance {
    /// Box around it in world space; `mesh` is its own. Visits every vertex.
    pub fn bounds(&self, mesh: &Mesh) -> Bounds {
        let place = |p: &Vec3| self.world_from_local.transform_point3(*p);
        mesh.positions.iter().map(place).fold(Bounds::EMPTY, Bounds::including)
    }
}

impl Scene {
    /// Box around all instances, hidden ones included, in world space.
    pub fn bounds(&self) -> Bounds {
        self.instances
            .iter()
            .fold(Bounds::EMPTY, |bounds, instance| bounds.joined(instance.bounds(&self.meshes[instance.mesh])))
    }

    /// Box around what a picture is about: the visible instances of the subject, of all where that has none.
    pub fn subject_bounds(&self) -> Bounds {
        let visible = |index: &usize| self.instances.get(*index).is_some_and(|instance| instance.visible);
        let around =
            |indices: &mut dyn Iterator<Item = usize>| self.bounds_of(&indices.filter(visible).collect::<Vec<_>>());
        let subject = around(&mut self.subject.iter().copied());
        if subject.is_empty() { around(&mut (0..self.instances.len())) } else { subject }
    }

    /// The instances that a probe serves where it names none: the subject; where that is everything or nothing, the largest metal
    /// object. Empty where there is no surrounding.
    pub fn served(&self) -> Vec<usize> {
        let seen: Vec<usize> = (0..self.instances.len()).filter(|i| self.instances[*i].visible).collect();
        let subject: Vec<usize> = seen.iter().copied().filter(|i| self.subject.contains(i)).collect();
        let served = match subject.len() {
            0 => self.largest_metal(&seen).into_iter().collect(),
            all if all == seen.len() => self.largest_metal(&seen).into_iter().collect(),
            _ => subject,
        };
        if served.len() == seen.len() { Vec::new() } else { served }
    }

    fn largest_metal(&self, among: &[usize]) -> Option<usize> {
        let is_metal = |i: &usize| {
            let material = &self.materials[self.instances[*i].material];
            matches!(material.reflectance, Reflectance::Preset { .. }) || material.metallic >= 0.5
        };
        let size = |i: &usize| self.bounds_of(&[*i]).radius();
        among.iter().copied().filter(is_metal).max_by(|a, b| size(a).total_cmp(&size(b)))
    }

    /// Box around some instances, in world space; indices out of range count for nothing.
    pub fn bounds_of(&self, instances: &[usize]) -> Bounds {
        let boxes = instances.iter().filter_map(|i| self.instances.get(*i));
        boxes.map(|instance| instance.bounds(&self.meshes[instance.mesh])).fold(Bounds::EMPTY, Bounds::joined)
    }

    /// Triangles of all instances.
    pub fn triangle_count(&self) -> usize {
        self.instances.iter().map(|i| self.meshes[i.mesh].indices.len() / 3).sum()
    }
}
